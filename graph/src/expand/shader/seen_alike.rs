//! Draws of the file's own vertices for two eyes: what places them may be the same for both.

use crate::expand::resources::Resources;
use crate::frame::{Draw, NoteKind, Remark};
use crate::language;
use crate::shader::ShaderInterface;

/// Notes a pass that draws vertices of the file's own into an image of each eye, by a matrix that both eyes share. A buffer is there
/// once, so both see the same, without parallax.
pub(in crate::expand) fn note(
    resources: &Resources<'_>,
    pass: &language::Pass,
    interface: &ShaderInterface,
    remarks: &mut Vec<Remark>,
) {
    let own = pass.work.draws(Draw::has_own_vertices);
    let Some(block) = interface.sees_alike.first().filter(|_| own && is_for_each_eye(resources, pass)) else { return };
    let given = pass.uniform.iter().map(|it| &it.binding).chain(pass.storage.iter().map(|it| &it.binding));
    let span = given.into_iter().find(|name| *name.text == **block).map_or(pass.name.span, |name| name.span);
    let text = format!(
        "draws for each eye by `{block}`, which holds a matrix and is the same for both eyes: they see no parallax; let the buffer hold \
         a matrix for each, and choose by `eye_index` of `include/stereo.glsl`"
    );
    remarks.push(Remark { kind: NoteKind::SeenAlike, subject: pass.name.text.clone(), span, text });
}

/// Whether it draws into what each eye has of its own, for either eye alike.
fn is_for_each_eye(resources: &Resources<'_>, pass: &language::Pass) -> bool {
    let sees = resources.pipeline.views.get(pass.view.0 as usize).is_some_and(|view| view.eye.is_some());
    let targets = pass.color.iter().map(|it| &it.part).chain(pass.depth.iter().map(|it| &it.part));
    let mut targets = targets.filter(|part| part.eye.is_none());
    targets.any(|part| sees || resources.image(part.image.index).is_some_and(|image| image.image.eyes.is_some()))
}
