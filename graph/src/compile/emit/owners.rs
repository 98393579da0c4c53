//! Outside owners: what they give to the frame and get back.

use crate::plan::{Buffer, Image, Plan, Resource};
use crate::vulkan::OutsideOwner;

/// The images and buffers that have an outside owner.
pub(super) fn owned(images: &[Image], buffers: &[Buffer]) -> Vec<(Resource, OutsideOwner)> {
    let images = images.iter().filter_map(|it| Some((Resource::Image(it.id), it.role.owner()?)));
    images.chain(buffers.iter().filter_map(|it| Some((Resource::Buffer(it.id), it.role.owner()?)))).collect()
}

/// Adds the transfers from and to outside owners.
pub(super) fn hand_over(plan: &mut Plan, owned: &[(Resource, OutsideOwner)]) {
    for (resource, owner) in owned {
        // What has an outside owner stays on one queue: see `compile/queues/eligible_queues.rs`.
        let given = plan.set_owner(*resource, Some(*owner));
        debug_assert!(given.is_ok(), "one queue uses it: {given:?}");
    }
}
