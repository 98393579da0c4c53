//! Images of which a frame uses a part: how large it is, and who may see them.

use super::findings::Findings;
use crate::plan::{Image, Plan, Role};
use crate::vulkan::Shape;

/// Texels that a linear filter reads along an axis.
const FILTERED: u32 = 2;

/// Width, height and depth of a mip level: of its part in use, where a part is in use.
pub(super) fn mip_extent(image: &Image, mip: u32) -> [u32; 3] {
    let mut extent = image.extent.map(|texels| halved(texels, mip));
    for (side, made) in extent.iter_mut().zip(image.allocated.into_iter().flatten()) {
        *side = (*side).max(FILTERED.min(halved(made, mip)));
    }
    extent
}

/// The same of all that is allocated.
pub(super) fn made_extent(image: &Image, mip: u32) -> [u32; 3] {
    let [_, _, depth] = image.extent;
    let [width, height] = image.allocated.unwrap_or([image.extent[0], image.extent[1]]);
    [width, height, depth].map(|texels| halved(texels, mip))
}

fn halved(texels: u32, times: u32) -> u32 {
    texels.checked_shr(times).unwrap_or(0).max(1)
}

/// Whether what an image holds when the frame ends may have another size than what it holds now: an earlier frame made it.
pub(super) fn may_have_another_size(plan: &Plan, image: &Image) -> bool {
    image.allocated.is_some()
        && !matches!(image.role, Role::Transient(_))
        && !plan.steps.iter().any(|step| step.work.writes(image.id))
}

/// Checks an image of which a part is in use. A reader that isn't told which part it is would see texels that no pass wrote.
pub(super) fn check(image: &Image, [width, height]: [u32; 2], found: &mut Findings) {
    let mut wrong = |what: &str| found.structure(None, Some(image.id.0), what);
    if width < image.extent[0] || height < image.extent[1] {
        wrong("uses more than it has room for");
    }
    if image.shape != Shape::D2 {
        wrong("changes its size and is deep or a cube");
    }
    // What every frame finds in it again has the size of no frame.
    if matches!(image.role, Role::Persistent { becomes, .. } if becomes == image.id.0) {
        wrong("changes its size and is the same image in each frame");
    }
}
