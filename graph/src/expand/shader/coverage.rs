//! What draws may leave as it was of what they draw into, as far as their shaders tell. `frame/coverage.rs` decides by it.
//!
//! A full-screen draw sets every texel unless something here says otherwise.

use crate::frame::Draw;
use crate::language;
use crate::shader::{ShaderInterface, UnsetOutput};
use std::sync::Arc;

/// Why a draw may leave texels of its targets as they were although it fills the screen, in words; `None`: it sets them all. An
/// output that some path leaves is told of elsewhere: it is written all the same, with an undefined value.
pub(in crate::expand) fn untouched(pass: &language::Pass, interface: Option<&ShaderInterface>) -> Option<Arc<str>> {
    let name = pass.shader().map_or("", |shader| &*shader.text);
    let full_screen = pass.work.draws(Draw::is_full_screen);
    let interface = interface.filter(|_| full_screen)?;
    let why = if leaves_out(interface) {
        let what = if interface.discards { "discards fragments" } else { "writes `gl_SampleMask`" };
        format!("shader `{name}` {what}{}", at(interface.leaves_out_at.as_deref()))
    } else if let Some(raster) = pass.raster.filter(|raster| raster.value.culls()) {
        format!("{} may leave its triangle out", raster.value)
    } else if pass.alpha_to_coverage.is_some() {
        "its alpha says which samples are covered".to_owned()
    } else if let Some(file) = &interface.own_vertices {
        format!("its vertex stage {file} is its own and may fill less than the screen")
    } else {
        return None;
    };
    Some(why.into())
}

/// The outputs that the targets of `pass` take, and that its shader doesn't set on every path.
pub(in crate::expand) fn unset<'i>(
    pass: &'i language::Pass,
    interface: &'i ShaderInterface,
) -> impl Iterator<Item = &'i UnsetOutput> {
    let taken = |location: Option<u32>| match location {
        Some(location) => (location as usize) < pass.color.len(),
        None => pass.depth.as_ref().is_some_and(|depth| depth.write),
    };
    interface.unset.iter().filter(move |unset| taken(unset.location))
}

/// Whether a fragment stage may leave out fragments or samples.
pub(in crate::expand) fn leaves_out(interface: &ShaderInterface) -> bool {
    interface.discards || interface.masks_samples
}

/// The place behind words, in brackets.
pub(in crate::expand) fn at(place: Option<&str>) -> String {
    place.map_or_else(String::new, |place| format!(" ({place})"))
}

/// Whether a draw tells the samples of a texel apart, or has edges although it fills the screen.
pub(in crate::expand) fn per_sample(draw: Draw, interface: Option<&ShaderInterface>) -> bool {
    interface.is_some_and(|it| it.per_sample || it.own_vertices.is_some() && draw.is_full_screen())
}
