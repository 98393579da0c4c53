//! Passes that draw a view into images that are for another.

use crate::frame::{Draw, NoteKind, Remark, ViewIndex};
use crate::language::{Pass, Pipeline};
use std::sync::Arc;

/// Remarks on passes that draw the scene for one view into an image for another view, of another size: the camera's picture
/// is stretched over the image. This is allowed, and a full-screen pass that only copies means it.
pub(in crate::expand) fn remarks(pipeline: &Pipeline) -> Vec<Remark> {
    pipeline.passes.iter().filter(|pass| pass.off.is_none()).filter_map(|pass| remark(pipeline, pass)).collect()
}

fn remark(pipeline: &Pipeline, pass: &Pass) -> Option<Remark> {
    if !pass.work.draws(Draw::shows_scene) {
        return None;
    }
    let (own, own_extent) = view(pipeline, pass.view)?;
    let targets = pass.color.iter().map(|color| color.part).chain(pass.depth.as_ref().map(|depth| depth.part));
    targets.into_iter().find_map(|part| {
        let image = &pipeline.images[part.image.index.0 as usize];
        let (other, _) = view(pipeline, image.view).filter(|(_, extent)| *extent != own_extent)?;
        let text = format!(
            "draws view `{own}` into `{}`, which is for view `{other}` of another size: what the camera sees is stretched \
             over it; say `view: \"{own}\"` of the image too, or of neither",
            image.name.text
        );
        Some(Remark { kind: NoteKind::OtherView, subject: pass.name.text.clone(), span: part.image.span, text })
    })
}

/// Name and size of a view.
fn view(pipeline: &Pipeline, index: ViewIndex) -> Option<(Arc<str>, [u32; 2])> {
    pipeline.views.get(index.0 as usize).map(|view| (view.name.text.clone(), view.extent))
}
