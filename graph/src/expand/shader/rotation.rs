//! Whether passes that draw can draw turned pictures, as far as their shaders tell.

use crate::frame::Work;
use crate::shader::{FileLanguage, ShaderInterface, UnturnedPart};
use std::sync::Arc;

/// Why the shader of a pass can't draw into an image that is turned, behind the name of the pass.
pub(in crate::expand) fn hindrance(work: &Work, interface: &ShaderInterface) -> Option<Arc<str>> {
    let (_, shader) = work.draw()?;
    let language = FileLanguage::of_shader(shader);
    let wrong: Vec<String> = interface.unturned.iter().map(|unturned| words(*unturned, language)).collect();
    (!wrong.is_empty()).then(|| format!("has the shader `{shader}`, which {}", wrong.join(" and ")).into())
}

fn words(unturned: UnturnedPart, language: Option<FileLanguage>) -> String {
    match (unturned, language) {
        (UnturnedPart::Vertices, _) => "places vertices without `rotate_clip()`".to_owned(),
        (UnturnedPart::FragCoord, _) => format!("reads `{}` without `frag_coord()`", FileLanguage::place(language)),
        (UnturnedPart::Derivatives, None) => "takes `dFdx` or `dFdy` without `ddx()` or `ddy()`".to_owned(),
        (UnturnedPart::Derivatives, Some(_)) => "takes derivatives".to_owned(),
    }
}
