//! Halves of one image for two eyes: checks that the shader of a pass supports them, as far as the shader tells.

use super::resources::Resources;
use crate::base::{Code, Diagnostic};
use crate::frame::EyeForm;
use crate::language;
use crate::shader::{ShaderInterface, Unturned};

/// Reports a shader that reads `gl_FragCoord` without `frag_coord()`: in halves it isn't the place in one eye's picture.
pub(super) fn check(
    resources: &Resources<'_>,
    pass: &language::Pass,
    interface: &ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) {
    let targets = pass.color.iter().map(|target| target.part.image).chain(pass.depth.iter().map(|it| it.part.image));
    let halves = |image: &language::ImageRef| {
        resources.image(image.index).is_some_and(|image| image.image.eyes == Some(EyeForm::Halves))
    };
    let Some(target) = targets.into_iter().find(halves) else { return };
    let (Some(shader), true) = (pass.shader(), interface.unturned.contains(&Unturned::FragCoord)) else { return };
    let name = &resources.declared(target.index).name.text;
    let message = format!("shader `{}` reads `gl_FragCoord` without `frag_coord()`", shader.text);
    let wrong = Diagnostic::new(Code::EYE_HALF, shader.span, message);
    let wrong = wrong.label(target.span, format!("both eyes' pictures lie side by side in `{name}`"));
    errors.push(wrong.help("`frag_coord()` of `include/rotation.glsl` is the place in the eye's own picture"));
}
