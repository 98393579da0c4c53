//! Whether passes that draw can draw turned pictures, as far as their shaders tell.

use crate::frame::Work;
use crate::shader::{ShaderInterface, UnturnedPart};
use std::sync::Arc;

/// Why the shader of a pass can't draw into an image that is turned, behind the name of the pass.
pub(in crate::expand) fn hindrance(work: &Work, interface: &ShaderInterface) -> Option<Arc<str>> {
    let (_, shader) = work.draw()?;
    let wrong: Vec<&str> = interface.unturned.iter().map(|unturned| words(*unturned)).collect();
    (!wrong.is_empty()).then(|| format!("has the shader `{shader}`, which {}", wrong.join(" and ")).into())
}

fn words(unturned: UnturnedPart) -> &'static str {
    match unturned {
        UnturnedPart::Vertices => "places vertices without `rotate_clip()`",
        UnturnedPart::FragCoord => "reads `gl_FragCoord` without `frag_coord()`",
        UnturnedPart::Derivatives => "takes `dFdx` or `dFdy` without `ddx()` or `ddy()`",
    }
}
