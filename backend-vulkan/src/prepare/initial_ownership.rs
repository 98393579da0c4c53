//! Initial queue ownership: which queue has the images and buffers that outlive the frame when the first frame begins.
//!
//! Contents come from the graphics queue. What another queue uses first must be handed to it; and where the frame begins by
//! acquiring an image from the queue on which the frame before would have released it, somebody has to release it.

use super::descriptions::part;
use super::uses::ResourceUses;
use framewright_graph::plan::{ImageBarrier, ImageId, Plan, Queue, Resource};
use framewright_graph::vulkan::{Layout, Sharing, Subresources};
use std::collections::HashSet;

/// A part of an image that one queue at a time may use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct InitialOwner<'p> {
    pub(crate) image: ImageId,
    pub(crate) range: Subresources,
    /// The layout in which the first frame finds it.
    pub(crate) layout: Layout,
    /// Whose it must be before the first frame.
    pub(crate) owner: Queue,
    /// The Plan's barrier that acquires it, whose other half must come before the first frame.
    pub(crate) acquired: Option<&'p ImageBarrier>,
}

/// The parts of images for which `relies` says that the first frame relies on their contents, in the order in which it
/// touches them.
pub(crate) fn initial_owners<'p>(plan: &'p Plan, relies: impl Fn(ImageId) -> bool) -> Vec<InitialOwner<'p>> {
    let exclusive = |id: ImageId| plan.image(id).sharing == Sharing::Exclusive && relies(id);
    let mut touched: HashSet<(u32, u32, u32, u32)> = HashSet::new();
    let mut owners = Vec::new();
    let mut touch = |image: ImageId, range: Subresources, owner: Queue, acquired: Option<&'p ImageBarrier>| {
        if !exclusive(image) {
            return;
        }
        let range = part(plan.image(image), range);
        let mut first = false;
        for plane in (0..u32::BITS).filter(|bit| range.aspects.bits() >> bit & 1 != 0) {
            for mip in range.base_mip..range.base_mip + range.mips {
                for layer in range.base_layer..range.base_layer + range.layers {
                    first |= touched.insert((image.0, plane, mip, layer));
                }
            }
        }
        if first {
            let states = plan.image(image).role.states();
            let layout = states.map_or(Layout::Undefined, |[before, _]| before.layout);
            owners.push(InitialOwner { image, range, layout, owner, acquired });
        }
    };
    for step in &plan.steps {
        for barrier in &step.image_barriers {
            match barrier.ownership {
                Some([from, _]) if barrier.old_layout != Layout::Undefined => {
                    touch(barrier.image, barrier.range, from, Some(barrier));
                }
                _ => touch(barrier.image, barrier.range, step.queue, None),
            }
        }
        for (resource, range) in step.work.used() {
            if let (Resource::Image(image), Some(range)) = (resource, range) {
                touch(image, range, step.queue, None);
            }
        }
    }
    owners
}

/// The queue that has an image or buffer before the first frame, in the state that the Plan relies on; `None` if not one
/// queue has all of it, or it is on its way to another.
pub(crate) fn initial_queue(plan: &Plan, uses: &ResourceUses, resource: Resource) -> Option<Queue> {
    match resource {
        Resource::Image(id) => {
            let owners = initial_owners(plan, |it| it == id);
            let queue = owners.first().map_or(Queue::Graphics, |it| it.owner);
            owners.iter().all(|it| it.owner == queue && it.acquired.is_none()).then_some(queue)
        }
        Resource::Buffer(_) => {
            let first = uses.of(resource);
            Some(first.map_or(Queue::Graphics, |span| plan.steps[span.first.0 as usize].queue))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::frame::Cadence;
    use framewright_graph::plan::{
        Cause, DeviceUsed, Fill, FirstContents, Hazard, Image, Role, Side, Step, StepId, Totals, Work,
    };
    use framewright_graph::vulkan::{Accesses, FillValue, Format, Rotation, Shape, Stages, State, Usage};

    const FORMAT: Format = Format::R32_UINT;
    const LAYOUT: Layout = Layout::General;

    /// A Plan whose one image has two mip levels and persists, and whose steps are these.
    fn plan(steps: Vec<Step>) -> Plan {
        let state = State { stages: Stages::COMPUTE_SHADER, accesses: Accesses::SHADER_STORAGE_READ, layout: LAYOUT };
        let role = Role::Persistent {
            becomes: 0,
            initial: FirstContents::Value(FillValue::Bits([0; 4])),
            before: state,
            after: state,
        };
        let image = Image {
            id: ImageId(0),
            name: "i".into(),
            cause: Cause::Written(None),
            format: FORMAT,
            chosen: None,
            shape: Shape::D2,
            extent: [2, 2, 1],
            allocated: None,
            rotation: Rotation::Identity,
            eyes: None,
            mips: 2,
            layers: 1,
            samples: 1,
            usage: Usage::STORAGE,
            sharing: Sharing::Exclusive,
            role,
        };
        Plan {
            format_version: framewright_graph::plan::FORMAT_VERSION,
            device: DeviceUsed { name: String::new(), exact_memory: true },
            settings: Vec::new(),
            changes: Vec::new(),
            decided: [].into(),
            extent: [2, 2],
            stereo: framewright_graph::frame::Stereo::Off,
            views: Vec::new(),
            images: vec![image],
            buffers: Vec::new(),
            heaps: Vec::new(),
            steps,
            outputs: Vec::new(),
            notes: Vec::new(),
            totals: Totals::default(),
        }
    }

    fn mip(level: u32) -> Subresources {
        Subresources { base_mip: level, mips: 1, ..Subresources::all(FORMAT, 2, 1) }
    }

    /// A fill on a queue that touches a mip level, after these barriers.
    fn step(queue: Queue, level: u32, image_barriers: Vec<ImageBarrier>) -> Step {
        let target = Side::Image { image: ImageId(0), range: mip(level), extent: [1; 3], layout: LAYOUT };
        let work = Work::Fill(Fill { name: None, cause: Cause::Written(None), target, value: FillValue::Bits([0; 4]) });
        let (waits, memory_barriers, releases) = (Vec::new(), Vec::new(), Vec::new());
        let outside = Vec::new();
        Step { queue, run: Cadence::Always, waits, memory_barriers, image_barriers, work, releases, outside }
    }

    fn barrier(level: u32, old_layout: Layout, ownership: Option<[Queue; 2]>) -> ImageBarrier {
        ImageBarrier {
            image: ImageId(0),
            range: mip(level),
            src_stages: Stages::empty(),
            src_accesses: Accesses::empty(),
            dst_stages: Stages::COMPUTE_SHADER,
            dst_accesses: Accesses::SHADER_STORAGE_READ,
            old_layout,
            new_layout: LAYOUT,
            ownership,
            hazard: Hazard::Ownership,
            after: None,
            needed_by: Some(StepId(0)),
        }
    }

    fn owners(plan: &Plan) -> Vec<(u32, Queue, bool)> {
        let owners = initial_owners(plan, |_| true);
        owners.iter().map(|it| (it.range.base_mip, it.owner, it.acquired.is_some())).collect()
    }

    #[test]
    fn each_part_belongs_to_the_queue_that_uses_it_first() {
        let steps = vec![
            step(Queue::Compute, 1, Vec::new()),
            step(Queue::Graphics, 0, vec![barrier(0, LAYOUT, None)]),
            step(Queue::Graphics, 1, vec![barrier(1, LAYOUT, Some([Queue::Compute, Queue::Graphics]))]),
        ];
        let plan = plan(steps);
        assert_eq!(owners(&plan), [(1, Queue::Compute, false), (0, Queue::Graphics, false)]);
        assert_eq!(
            initial_queue(&plan, &ResourceUses::new(&plan), Resource::Image(ImageId(0))),
            None,
            "two queues have it"
        );
    }

    #[test]
    fn what_the_first_frame_acquires_belongs_to_the_queue_that_would_have_released_it() {
        let steps = vec![step(Queue::Compute, 0, vec![barrier(0, LAYOUT, Some([Queue::Graphics, Queue::Compute]))])];
        let plan = plan(steps);
        assert_eq!(owners(&plan), [(0, Queue::Graphics, true)]);
        assert_eq!(
            initial_queue(&plan, &ResourceUses::new(&plan), Resource::Image(ImageId(0))),
            None,
            "it is on its way"
        );
    }

    #[test]
    fn what_nothing_touches_stays_with_graphics() {
        let plan = plan(Vec::new());
        assert_eq!(initial_queue(&plan, &ResourceUses::new(&plan), Resource::Image(ImageId(0))), Some(Queue::Graphics));
    }
}
