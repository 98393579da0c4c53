//! Contents from outside: what persists begins with its initial value, and the host may write what outlives the frame.

use crate::base::{Error, convert};
use crate::commands::{
    TransferSide, UNUSED, WRITTEN, barriers, fill, image_side, level_bytes, memory_change, record_upload, staged,
    state_change,
};
use crate::gpu::{Gpu, QueueFamily};
use crate::memory::Image;
use crate::prepare::{
    InitialOwner, PhysicalResources, ResourceUses, StagedTexture, file_of, initial_owners, initial_queue,
};
use ash::vk;
use framewright_graph::plan::{self, BufferId, FirstContents, ImageId, Plan, Queue, Resource, Role};
use framewright_graph::vulkan::{Accesses, Aspects, FillValue, Layout, Stages, State, Subresources, Usage};
use std::sync::Arc;

/// Gives first contents to everything that outlives the frame and has none yet. Persistent images and buffers get their initial
/// value or the texels in `textures`, others are zero unless they were imported. Each is then in the state that the Plan relies on,
/// and belongs to the queue that uses it first.
pub(crate) fn initialise(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    uses: &ResourceUses,
    physical: &PhysicalResources,
    textures: &[StagedTexture],
) -> Result<(), Error> {
    let initial = |role: &Role, is_foreign: bool| match role {
        Role::Persistent { before, initial: FirstContents::Value(value), .. } => Some((*before, Some(*value))),
        Role::Persistent { before, initial: FirstContents::File(_), .. } => Some((*before, None)),
        Role::External { before, .. } if !is_foreign => Some((*before, Some(FillValue::Bits([0; 4])))),
        Role::Transient(_) | Role::External { .. } => None,
    };
    let of_image = |id: ImageId| {
        let found = initial(&plan.image(id).role, physical.image(id, 0).is_foreign());
        found.filter(|(before, _)| before.layout != Layout::Undefined && !physical.is_migrated(Resource::Image(id)))
    };
    let of_buffer = |id: BufferId| {
        let found = initial(&plan.buffers[id.0 as usize].role, physical.buffer(id, 0).is_foreign());
        found.filter(|_| !physical.is_migrated(Resource::Buffer(id)))
    };
    let owners = initial_owners(plan, |id| of_image(id).is_some());
    let transfers = OwnershipTransfers { gpu, physical, owners: &owners };
    let zero = plan.images.iter().filter(|image| of_image(image.id).is_some() && file_of(image).is_none());
    let zero = zero.filter(|image| image.format.is_compressed());
    let zero = zero.map(|image| zero_blocks(gpu, physical.image(image.id, 0), image.id));
    let zero = zero.collect::<Result<Vec<_>, _>>()?;
    for queue in [Queue::Graphics, Queue::Compute, Queue::Transfer] {
        let family = gpu.queues.families.family(queue);
        if queue != Queue::Graphics && family == gpu.queues.families.graphics {
            continue;
        }
        gpu.submit_once("preparing the first frame", queue, |commands| {
            let images = plan.images.iter().filter(|_| queue == Queue::Graphics);
            for (image, (before, initial)) in images.filter_map(|it| Some((it, of_image(it.id)?))) {
                let made = physical.image(image.id, 0);
                match (initial, textures.iter().chain(&zero).find(|it| it.image == image.id)) {
                    (_, Some(staged)) => {
                        record_upload(gpu, commands, made, (&staged.buffer, staged.mips), before.layout);
                    }
                    (Some(value), None) => set_image(gpu, commands, image, made, before, value),
                    (None, None) => {}
                }
            }
            for (buffer, (before, initial)) in plan.buffers.iter().filter_map(|it| Some((it, of_buffer(it.id)?))) {
                let first = initial_queue(plan, uses, Resource::Buffer(buffer.id)).unwrap_or(Queue::Graphics);
                if gpu.queues.families.family(first) == family {
                    let made = physical.buffer(buffer.id, 0);
                    let target = TransferSide::Buffer { buffer: made.raw, bytes: made.bytes };
                    fill(gpu, commands, target, convert::clear(None, initial.unwrap_or(FillValue::Bits([0; 4]))));
                    barriers(gpu, commands, &[memory_change(WRITTEN, before)], &[]);
                }
            }
            transfers.record(commands, family);
        })?;
    }
    Ok(())
}

/// Blocks for a whole compressed image, which can't be filled by a clear: black, or in ETC2 without alpha almost black.
fn zero_blocks(gpu: &Arc<Gpu>, made: &Image, image: ImageId) -> Result<StagedTexture, Error> {
    let mips = made.descriptor.mips;
    let levels = (0..mips).map(|mip| level_bytes(&made.descriptor, Aspects::COLOR, mip));
    let bytes = usize::try_from(levels.fold(0, u64::saturating_add)).unwrap_or(usize::MAX);
    // A block of zeros is none of ASTC; this one is black and transparent.
    let blocks = if made.descriptor.format.feature() == Some("textureCompressionASTC_LDR") {
        [0xFC, 0xFD, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 0, 0, 0, 0].repeat(bytes / 16)
    } else {
        vec![0; bytes]
    };
    Ok(StagedTexture { image, buffer: staged(gpu, "zero blocks", &blocks)?, mips })
}

/// Fills an image and brings it into the state `before`.
fn set_image(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    image: &plan::Image,
    made: &Image,
    before: State,
    initial: FillValue,
) {
    let whole = Subresources::all(image.format, image.mips, image.made_layers());
    let mut state = UNUSED;
    if made.descriptor.usage.contains(Usage::TRANSFER_DST) {
        barriers(gpu, commands, &[], &[state_change(made.raw, whole, UNUSED, WRITTEN)]);
        fill(
            gpu,
            commands,
            TransferSide::Image(image_side(made, whole, 0)),
            convert::clear(Some(image.format), initial),
        );
        state = WRITTEN;
    }
    barriers(gpu, commands, &[], &[state_change(made.raw, whole, state, before)]);
}

/// The handing over of images from the graphics queue, which set them, to those that use them first.
struct OwnershipTransfers<'h> {
    gpu: &'h Gpu,
    physical: &'h PhysicalResources,
    owners: &'h [InitialOwner<'h>],
}

impl OwnershipTransfers<'_> {
    /// Records the work of one family. The graphics family comes first.
    fn record(&self, commands: vk::CommandBuffer, here: QueueFamily) {
        let families = &self.gpu.queues.families;
        let graphics = families.graphics;
        let (mut released, mut acquired) = (Vec::new(), Vec::new());
        for it in self.owners {
            let owner = families.family(it.owner);
            if owner != graphics && (here == graphics || here == owner) {
                // Released by the one, acquired by the other.
                released.push(self.transfer(it, [graphics, owner], [None; 2]));
            }
        }
        for it in self.owners.iter().filter(|it| families.family(it.owner) == here) {
            let Some((barrier, [from, to])) = it.acquired.and_then(|it| Some((it, it.ownership?))) else { continue };
            let pair = [families.family(from), families.family(to)];
            if pair[0] != pair[1] {
                acquired.push(self.transfer(it, pair, [Some(barrier.old_layout), Some(barrier.new_layout)]));
            }
        }
        for image in released.into_iter().chain(acquired) {
            barriers(self.gpu, commands, &[], &[image]);
        }
    }

    /// One half of an ownership transfer; without layouts the image stays in its own.
    fn transfer(
        &self,
        part: &InitialOwner<'_>,
        [from, to]: [QueueFamily; 2],
        layouts: [Option<Layout>; 2],
    ) -> vk::ImageMemoryBarrier2<'static> {
        let all = State { stages: Stages::ALL_COMMANDS, accesses: Accesses::empty(), layout: part.layout };
        let [old, new] = layouts.map(|layout| State { layout: layout.unwrap_or(all.layout), ..all });
        let accesses = Accesses::MEMORY_READ | Accesses::MEMORY_WRITE;
        let (old, new) = (State { accesses, ..old }, State { accesses, ..new });
        let image = self.physical.image(part.image, 0).raw;
        state_change(image, part.range, old, new).src_queue_family_index(from.index).dst_queue_family_index(to.index)
    }
}
