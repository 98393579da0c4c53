//! Shaders that draw for both eyes at once: their texts are put between a few lines of their own, so that they need not know.
//!
//! `main` is renamed and called from a `main` that finds out first which eye is drawn for, and puts vertices in its half or layer
//! afterwards. shaders/include/stereo.glsl is what the texts in between see of it.

use crate::base::{ShaderStage, StageFacts};
use framewright_graph::frame::EyeForm;
use framewright_graph::shader::EyeSource;
use rspirv::binary::Assemble;
use rspirv::dr::Builder;
use rspirv::spirv::{AddressingModel, Capability, ExecutionMode, ExecutionModel, FunctionControl, MemoryModel};

/// The variable that says which eye is drawn for: 0 the left one, 1 the right one.
pub(super) const EYE: &str = "framewright_eye";

/// The varying that hands the eye from the vertex stage, which knows it by the instance, to the fragment stage.
pub(super) const HANDED_ON: &str = "framewright_eye_of_triangle";

/// The location of that varying: the last of the 15 that Vulkan promises between stages. Shaders may take the locations below, and
/// so fit every way to draw for both eyes. (By "Required Limits" every device hands over 64 components,
/// `maxVertexOutputComponents` and `maxFragmentInputComponents`: 16 locations. `gl_Position` may take one.)
pub(super) const LOCATION: u32 = 14;

/// The first instance of a draw, as GLSL calls it, by itself and by its extension.
pub(super) const BASE_INSTANCE: [&str; 2] = ["gl_BaseInstance", "gl_BaseInstanceARB"];

/// Words of `include/stereo.hlsl` and `include/rotation.hlsl` that ask for the eye.
pub(super) const ASKING: [&str; 6] =
    ["eye_index", "scale_offset", "screen_uv", "screen_pos", "frag_coord", "FRAMEWRIGHT_BOTH_EYES"];

/// Why a shader's own clip distances aren't used in a draw for both halves.
pub(super) const NOT_AT_SEAM: &str = "it sets clip distances, and a draw for both halves of a picture cuts at their seam by one of its \
    own: choose `multi-pass`, or eyes in layers";

/// How a stage draws for both eyes at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct BothEyes {
    pub(super) source: EyeSource,
    /// Whether the eyes' pictures lie in layers or in halves of the image.
    pub(super) form: EyeForm,
}

impl BothEyes {
    /// Macros that the text and all that it includes see.
    pub(super) fn macros(self, stage: ShaderStage) -> Vec<(String, String)> {
        let mut macros = vec![("main", "framewright_main"), ("FRAMEWRIGHT_BOTH_EYES", "")];
        if self.form == EyeForm::Halves {
            macros.push(("FRAMEWRIGHT_HALVES", ""));
        }
        if stage.facts().places_vertices && self.counts_instances() {
            macros.push(("gl_InstanceIndex", "framewright_instance"));
        }
        macros.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect()
    }

    /// More macros of a stage that asks for the first instance of a draw: that of the eye, as it counts its own. A variable would ask for
    /// the first instance in all stages, and a macro isn't put into its own value again.
    pub(super) fn base_instance(self, stage: ShaderStage) -> impl Iterator<Item = (String, String)> {
        let own: fn(&str) -> String = match self.source {
            EyeSource::InstanceParity => |first| format!("int(uint({first}) >> 1)"),
            EyeSource::InstanceBit | EyeSource::ViewIndex | EyeSource::One(_) => {
                |first| format!("({first} & 0x7fffffff)")
            }
        };
        let counts = stage.facts().places_vertices && self.counts_instances();
        BASE_INSTANCE.into_iter().filter(move |_| counts).map(move |name| (name.to_owned(), own(name)))
    }

    /// Whether the vertex stage hands the eye to the fragment stage, at a location of its own.
    pub(super) fn counts_instances(self) -> bool {
        matches!(self.source, EyeSource::InstanceBit | EyeSource::InstanceParity)
    }

    /// Whether one draw fills both halves of a picture: clip distances cut what reaches over the seam.
    pub(super) fn cuts_at_seam(self) -> bool {
        self.form == EyeForm::Halves && self.source == EyeSource::InstanceParity
    }

    /// The text with what finds out the eye before it and behind it.
    pub(super) fn around(self, text: &str, stage: ShaderStage) -> String {
        self.wrapped(text, stage, |way| format!("layout(location = {LOCATION}) flat {way} int {HANDED_ON};\n"))
    }

    /// The same, with the eye at no location. It compiles where the text itself takes that location, for [`super::reflect`] to refuse.
    pub(super) fn around_without_location(self, text: &str, stage: ShaderStage) -> String {
        self.wrapped(text, stage, |_| format!("int {HANDED_ON};\n"))
    }

    fn wrapped(self, text: &str, stage: ShaderStage, handed_on: impl Fn(&str) -> String) -> String {
        // Extensions come before everything else, and behind `#version`.
        let (version, rest) = text.split_at(behind_version(text));
        let line = version.lines().count() + 1;
        format!("{version}\n{}\n#line {line}\n{rest}\n{}", self.before(stage, handed_on), self.behind(stage))
    }

    fn before(self, stage: ShaderStage, handed_on: impl Fn(&str) -> String) -> String {
        let StageFacts { places_vertices, writes_attachments, .. } = stage.facts();
        let extension = match (self.source, self.form) {
            (EyeSource::ViewIndex, _) => "#extension GL_EXT_multiview : require\n",
            (_, EyeForm::Layers) if places_vertices => "#extension GL_ARB_shader_viewport_layer_array : require\n",
            _ => "",
        };
        let instance = match self.counts_instances() {
            true if places_vertices => format!("int framewright_instance;\n{}", handed_on("out")),
            true if writes_attachments => handed_on("in"),
            _ => String::new(),
        };
        format!("{extension}int {EYE};\n{instance}")
    }

    fn behind(self, stage: ShaderStage) -> String {
        let StageFacts { places_vertices, .. } = stage.facts();
        let eye = match (self.source, places_vertices) {
            (EyeSource::One(eye), _) => format!("{EYE} = {};", eye as u32),
            (EyeSource::ViewIndex, _) => format!("{EYE} = int(gl_ViewIndex);"),
            (_, false) => format!("{EYE} = {HANDED_ON};"),
            (EyeSource::InstanceBit, _) => format!(
                "{EYE} = gl_InstanceIndex < 0 ? 1 : 0;\n    framewright_instance = gl_InstanceIndex & 0x7fffffff;"
            ),
            (EyeSource::InstanceParity, _) => {
                format!("{EYE} = gl_InstanceIndex & 1;\n    framewright_instance = int(uint(gl_InstanceIndex) >> 1);")
            }
        };
        let place = if places_vertices && self.counts_instances() { self.place() } else { String::new() };
        format!("#undef main\n#undef gl_InstanceIndex\nvoid main() {{\n    {eye}\n    framewright_main();\n{place}}}\n")
    }

    /// Puts a vertex in the half or layer of its eye.
    fn place(self) -> String {
        let place = match (self.form, self.source) {
            (EyeForm::Layers, _) => IN_ITS_LAYER.to_owned(),
            // Both halves are drawn by one draw, so no scissor can cut what reaches over the seam.
            (EyeForm::Halves, EyeSource::InstanceParity) => format!("{ACROSS}{CUT_AT_SEAM}{IN_ITS_HALF}"),
            // Each half has a draw of its own, and with it its viewport and scissor.
            (EyeForm::Halves, _) => String::new(),
        };
        format!("    {HANDED_ON} = {EYE};\n{place}")
    }
}

/// A fragment stage that does nothing.
pub(super) fn empty_fragment_stage() -> Vec<u32> {
    let mut module = Builder::new();
    module.set_version(1, 0);
    module.capability(Capability::Shader);
    module.memory_model(AddressingModel::Logical, MemoryModel::GLSL450);
    let void = module.type_void();
    let function = module.type_function(void, []);
    let main =
        module.begin_function(void, None, FunctionControl::NONE, function).expect("no function was begun before");
    module.begin_block(None).expect("a function was begun");
    module.ret().expect("a block was begun");
    module.end_function().expect("a function was begun");
    module.entry_point(ExecutionModel::Fragment, main, "main", []);
    module.execution_mode(main, ExecutionMode::OriginUpperLeft, []);
    module.module().assemble()
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
";

/// Where the vertex lies across the upright picture of its eye, and to which side that eye's half lies.
const ACROSS: &str = "#ifdef FRAMEWRIGHT_ROTATION
    const vec2 framewright_right = rotate_direction(vec2(1.0, 0.0));
#else
    const vec2 framewright_right = vec2(1.0, 0.0);
#endif
    const float framewright_across = dot(gl_Position.xy, framewright_right);
    const float framewright_side = framewright_eye == 0 ? -1.0 : 1.0;
";

/// Clip distance at the seam: cuts off all to the right of the left eye's picture, or to the left of the right one's.
const CUT_AT_SEAM: &str = "    gl_ClipDistance[0] = gl_Position.w + framewright_side * framewright_across;
";

/// The eye's picture fills half the width of the upright one.
const IN_ITS_HALF: &str =
    "    gl_Position.xy += 0.5 * (framewright_side * gl_Position.w - framewright_across) * framewright_right;
";
