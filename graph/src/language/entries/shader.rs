//! The shader of a pass: GLSL by name, other languages by file and entry point, or a name for each stage.

use crate::base::Code;
use crate::fields;
use crate::ron::{FieldTable, Form, Leaf, Name, PlainForm, Reader, Shape, Table};
use crate::shader::{ShaderName, StageName};

fields! {
    /// Stages: those of a shader, each by a name of its own.
    /// ```ron
    /// (vertex: "mesh.spv:VSMain", fragment: "glow")
    /// ```
    struct StagesFields<'src> {
        /// The vertex stage; the usual one of what is drawn if left out.
        vertex: Option<Leaf<'src>> => STAGE,
        /// The fragment stage.
        fragment: Leaf<'src> => STAGE,
    }
}

/// The name of a stage, or of all stages.
pub(crate) const STAGE: Form = Form::Plain(PlainForm::Shader);

/// The shader of a draw.
pub(crate) const SHADER: Form = Form::Either(&[STAGE, Form::Fields(fields)]);

/// The fields of stages.
pub(crate) fn fields() -> Table {
    StagesFields::<'static>::table()
}

/// Names of files with entry points have at most so many bytes.
pub(crate) const LONGEST: usize = 256;

impl Reader {
    /// The shader of a draw.
    pub(crate) fn shader(&mut self, leaf: Leaf<'_>) -> Option<Name> {
        match leaf.shape() {
            Shape::Parentheses => self.stages(leaf),
            _ => self.stage(leaf),
        }
    }

    /// The stages of a shader, by names of their own.
    pub(crate) fn stages(&mut self, leaf: Leaf<'_>) -> Option<Name> {
        let StagesFields { vertex, fragment } = self.read(leaf, "stages")?;
        let vertex = vertex.map(|vertex| self.stage(vertex));
        let fragment = self.stage(fragment);
        let named = |name: Name| StageName::of_text(&name.text);
        let vertex = match vertex {
            Some(vertex) => Some(named(vertex?)),
            None => None,
        };
        let shader = ShaderName::Stages { vertex, fragment: named(fragment?) };
        Some(Name { text: shader.to_string().into(), span: leaf.span() })
    }

    /// The name of a stage, or of a shader that has its stages by one name: GLSL, or a file with its ending.
    pub(crate) fn stage(&mut self, leaf: Leaf<'_>) -> Option<Name> {
        let file =
            leaf.plain().filter(|text| matches!(leaf.shape(), Shape::Text) && StageName::of_text(text).is_file());
        let Some(text) = file else { return self.outside_name(leaf, "a shader") };
        let entry = match StageName::of_text(text) {
            StageName::File { entry: Some(entry), .. } => entry,
            StageName::File { entry: None, .. } | StageName::Glsl(_) => "main".into(),
        };
        if text.len() > LONGEST || text.contains(char::is_control) {
            let message =
                format!("this can't name a shader's file: names have up to {LONGEST} bytes, and no control characters");
            self.wrong(Code::NAME_FORM, leaf, message, "");
            return None;
        }
        if entry.is_empty() || entry.contains([' ', ',']) {
            let message = format!("`{entry}` can't be the name of an entry point");
            self.wrong(Code::NAME_FORM, leaf, message, "write it behind the file's name: `post.spv:PSMain`");
            return None;
        }
        Some(Name { text: text.into(), span: leaf.span() })
    }
}
