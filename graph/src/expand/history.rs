//! How far back history is kept: as far as a pass that runs reads it. An image or buffer whose earlier frames no pass reads
//! lives within the frame.

use super::accesses;
use super::resources::Resources;
use super::state::State;
use crate::frame::{Lifetime, Pass, Resource};

/// Shortens the history of images and buffers to the frames that are read.
pub(super) fn shorten(resources: &mut Resources<'_>, states: &[State]) {
    let mut images = vec![0_u32; resources.images.len()];
    let mut buffers = vec![0_u32; resources.buffers.len()];
    let looks_back = |pass: &&Pass| pass.accesses().any(|access| access.frames_ago() > 0);
    let looking_back = states.iter().flat_map(State::runs).filter(looks_back);
    for read in looking_back.flat_map(|pass| accesses::reads(resources, pass)) {
        let back = match read.resource {
            Resource::Image(index) => images.get_mut(index.0 as usize),
            Resource::Buffer(index) => buffers.get_mut(index.0 as usize),
        };
        if let Some(back) = back {
            *back = read.frames_ago.max(*back);
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
