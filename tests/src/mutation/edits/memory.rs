//! Memory: images and buffers placed on top of each other.

use super::Edit;
use crate::mutation::Kind;
use framewright_graph::plan::{Placement, Plan, Resource, Role};

fn placement(plan: &Plan, resource: Resource) -> Option<&Placement> {
    let role = match resource {
        Resource::Image(image) => &plan.image(image).role,
        Resource::Buffer(buffer) => &plan.buffers[buffer.0 as usize].role,
    };
    if let Role::Transient(placement) = role { Some(placement) } else { None }
}

/// Each transient image or buffer, moved onto others that live at the same time.
pub(super) fn allocations(plan: &Plan, edits: &mut Vec<Edit>) {
    let images = plan.images.iter().map(|image| (Resource::Image(image.id), image.name.clone()));
    let buffers = plan.buffers.iter().map(|buffer| (Resource::Buffer(buffer.id), buffer.name.clone()));
    let all: Vec<_> = images.chain(buffers).collect();
    for (moved, name) in &all {
        for (neighbour, other) in &all {
            let (Some(own), Some(there)) = (placement(plan, *moved), placement(plan, *neighbour)) else { continue };
            let together = own.lifetime[0] <= there.lifetime[1] && there.lifetime[0] <= own.lifetime[1];
            if moved == neighbour || !together || own.heap != there.heap || own.offset == there.offset {
                continue;
            }
            let (moved, offset, heap, end) = (*moved, there.offset, own.heap as usize, there.offset + own.bytes);
            let change = format!("`{name}` onto `{other}`");
            edits.push(Edit::new(Kind::AllocationShifted, change, move |plan| {
                let role = match moved {
                    Resource::Image(image) => &mut plan.images[image.0 as usize].role,
                    Resource::Buffer(buffer) => &mut plan.buffers[buffer.0 as usize].role,
                };
                if let Role::Transient(placement) = role {
                    placement.offset = offset;
                }
                plan.heaps[heap].bytes = plan.heaps[heap].bytes.max(end);
            }));
        }
    }
}
