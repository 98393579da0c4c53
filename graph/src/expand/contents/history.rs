//! How far back history is kept: as far as a pass that runs reads it. An image or buffer whose earlier frames no pass reads
//! lives within the frame.

use crate::expand::passes::State;
use crate::expand::resources::Resources;
use crate::frame::{Lifetime, Pass, Resource};

/// Shortens the history of images and buffers to the frames that are read.
pub(in crate::expand) fn shorten(resources: &mut Resources<'_>, states: &[State]) {
    let mut images = vec![0_u32; resources.images.len()];
    let mut buffers = vec![0_u32; resources.buffers.len()];
    for access in states.iter().flat_map(State::runs).flat_map(Pass::accesses) {
        let back = match access.resource() {
            Resource::Image(index) => images.get_mut(index.0 as usize),
            Resource::Buffer(index) => buffers.get_mut(index.0 as usize),
        };
        if let Some(back) = back {
            *back = access.frames_ago().max(*back);
        }
    }
    let images = resources.images.iter_mut().map(|it| it.as_mut().map(|it| &mut it.image.lifetime)).zip(images);
    let buffers = resources.buffers.iter_mut().map(|it| it.as_mut().map(|it| &mut it.lifetime)).zip(buffers);
    for (lifetime, back) in images.chain(buffers) {
        match (lifetime, back) {
            (Some(lifetime @ Lifetime::History { .. }), 0) => *lifetime = Lifetime::Transient,
            (Some(Lifetime::History { frames, .. }), back) => *frames = back,
            _ => {}
        }
    }
}
