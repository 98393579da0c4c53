//! Whether passes that draw can draw turned pictures, as far as their shaders tell.

use crate::frame::Work;
use crate::shader::{ShaderInterface, shader_words};
use std::sync::Arc;

/// Why the shader of a pass can't draw into an image that is turned, behind the name of the pass.
pub(in crate::expand) fn hindrance(work: &Work, interface: &ShaderInterface) -> Option<Arc<str>> {
    let (_, shader) = work.draw()?;
    let wrong: Vec<String> = interface.unturned.iter().map(|part| shader_words::unturned(shader, *part)).collect();
    (!wrong.is_empty()).then(|| format!("has the shader `{shader}`, which {}", wrong.join(" and ")).into())
}
