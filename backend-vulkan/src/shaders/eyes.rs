//! Shaders that draw for both eyes at once: their texts are put between a few lines of their own, so that they need not know.
//!
//! `main` is renamed and called from a `main` that finds out first which eye is drawn for, and puts vertices in its half or layer
//! afterwards. shaders/include/stereo.glsl is what the texts in between see of it.

use super::compile::Stage;
use framewright_graph::interface::EyeSource;
use framewright_graph::view::EyeForm;

/// The variable that says which eye is drawn for: 0 the left one, 1 the right one.
pub(super) const EYE: &str = "framewright_eye";

/// How a stage draws for both eyes at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct BothEyes {
    pub(super) source: EyeSource,
    /// What it draws into.
    pub(super) form: EyeForm,
}

impl BothEyes {
    /// Macros that the text and all that it includes see.
    pub(super) fn macros(self, stage: Stage) -> Vec<(String, String)> {
        let mut macros = vec![("main", "framewright_main"), ("FRAMEWRIGHT_BOTH_EYES", "")];
        if self.form == EyeForm::Halves {
            macros.push(("FRAMEWRIGHT_HALVES", ""));
        }
        if stage == Stage::Vertex && self.counts_instances() {
            macros.push(("gl_InstanceIndex", "framewright_instance"));
        }
        macros.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect()
    }

    fn counts_instances(self) -> bool {
        matches!(self.source, EyeSource::InstanceBit | EyeSource::InstanceParity)
    }

    /// The text with what finds out the eye before it and behind it.
    pub(super) fn around(self, text: &str, stage: Stage) -> String {
        // Extensions come before everything else, and behind `#version`.
        let (version, rest) = text.split_at(behind_version(text));
        let line = version.lines().count() + 1;
        format!("{version}\n{}\n#line {line}\n{rest}\n{}", self.before(stage), self.behind(stage))
    }

    fn before(self, stage: Stage) -> String {
        let extension = match (self.source, self.form, stage) {
            (EyeSource::ViewIndex, ..) => "#extension GL_EXT_multiview : require\n",
            (_, EyeForm::Layers, Stage::Vertex) => "#extension GL_ARB_shader_viewport_layer_array : require\n",
            _ => "",
        };
        let instance =
            if stage == Stage::Vertex && self.counts_instances() { "int framewright_instance;\n" } else { "" };
        format!("{extension}int {EYE};\n{instance}")
    }

    fn behind(self, stage: Stage) -> String {
        let eye = match (self.source, stage) {
            (EyeSource::One(eye), _) => format!("{EYE} = {};", eye as u32),
            (EyeSource::ViewIndex, _) => format!("{EYE} = int(gl_ViewIndex);"),
            (_, Stage::Fragment) => format!("{EYE} = gl_ClipDistance[0] > 1.5 ? 1 : 0;"),
            (EyeSource::InstanceBit, _) => format!(
                "{EYE} = gl_InstanceIndex < 0 ? 1 : 0;\n    framewright_instance = gl_InstanceIndex & 0x7fffffff;"
            ),
            (EyeSource::InstanceParity, _) => {
                format!("{EYE} = gl_InstanceIndex & 1;\n    framewright_instance = int(uint(gl_InstanceIndex) >> 1);")
            }
        };
        let place = match (stage, self.form) {
            (Stage::Vertex, _) if !self.counts_instances() => "",
            (Stage::Vertex, EyeForm::Layers) => IN_ITS_LAYER,
            (Stage::Vertex, EyeForm::Halves) => IN_ITS_HALF,
            (Stage::Fragment | Stage::Compute, _) => "",
        };
        format!("#undef main\n#undef gl_InstanceIndex\nvoid main() {{\n    {eye}\n    framewright_main();\n{place}}}\n")
    }
}

/// Where the line behind `#version` begins, before which nothing but comments may stand; a text without one
/// is taken for one of 4.60.
fn behind_version(text: &str) -> usize {
    let mut rest = text.trim_start();
    loop {
        let behind = match (rest.strip_prefix("//"), rest.strip_prefix("/*")) {
            (Some(comment), _) => comment.split_once('\n'),
            (None, Some(comment)) => comment.split_once("*/"),
            (None, None) => break,
        };
        rest = behind.map_or("", |(_, rest)| rest.trim_start());
    }
    let is_version = rest.strip_prefix('#').is_some_and(|it| it.trim_start().starts_with("version"));
    let line = rest.find('\n').map_or(rest.len(), |end| end + 1);
    if is_version { text.len() - rest.len() + line } else { 0 }
}

const IN_ITS_LAYER: &str = "    gl_Layer = framewright_eye;
    gl_ClipDistance[0] = 1.0 + float(framewright_eye);
    gl_ClipDistance[1] = 1.0;
";

/// What lies to the right of the left eye's picture, or to the left of the right one's, is cut off; the rest fills half the width
/// of the upright picture.
const IN_ITS_HALF: &str = "#ifdef FRAMEWRIGHT_ROTATION
    const vec2 framewright_right = rotate_direction(vec2(1.0, 0.0));
#else
    const vec2 framewright_right = vec2(1.0, 0.0);
#endif
    const float framewright_across = dot(gl_Position.xy, framewright_right);
    const float framewright_side = framewright_eye == 0 ? -1.0 : 1.0;
    gl_ClipDistance[0] = 1.0 + float(framewright_eye);
    gl_ClipDistance[1] = gl_Position.w + framewright_side * framewright_across;
    gl_Position.xy += 0.5 * (framewright_side * gl_Position.w - framewright_across) * framewright_right;
";
