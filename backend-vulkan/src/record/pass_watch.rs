//! Custom passes, held against what the pipeline says of them: what no pass of a step writes is copied before the step and after it, and
//! must be the same. What they don't name holds garbage meanwhile: a pass that reads it shows another picture. What they set all of holds
//! garbage before them, which must be gone.

use super::contents::{UntouchedTexels, difference};
use crate::base::{BrokenPromise, Clear, Error, convert};
use crate::commands::{TransferSide, barrier_call, copy_from_image, copy_to_image, fill, plane_bytes, to_host};
use crate::gpu::Gpu;
use crate::memory::{MemoryUse, RawBuffer};
use crate::prepare::{Frame, PartPromise, WatchedPart, WatchedStep, pattern};
use ash::vk;
use framewright_graph::frame::EyeForm;
use framewright_graph::plan::{Pass, Resource};
use framewright_graph::vulkan::{Aspects, BufferUsage, Layout, Usage};
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Texels of every format begin at a multiple of it: of their size, and of 4.
const ALIGNMENT: u64 = 48;

/// What garbage is in a buffer, in turn: harmless as a count and as an index.
const WORDS: [u32; 2] = [5, 11];

/// The watch over the custom passes of one frame in flight.
pub(crate) struct PassWatch {
    gpu: Arc<Gpu>,
    steps: Arc<[WatchedStep]>,
    /// By step of the list.
    copies: Vec<StepCopies>,
    /// The watched step whose commands are being recorded.
    open: Option<usize>,
    /// What the program asked a recorder for, and its pass doesn't name.
    asked: Vec<BrokenPromise>,
}

/// What a watched step's parts held.
#[derive(Default)]
struct StepCopies {
    buffer: Option<RawBuffer>,
    /// By part; empty if the frame didn't look at the step.
    places: Vec<CopyPlace>,
    /// Which garbage they held.
    turn: usize,
}

/// Where the copies of a part lie.
#[derive(Clone, Copy)]
struct CopyPlace {
    bytes: u64,
    /// What it held before the step.
    before: u64,
    /// What it was filled with for the step, if it was.
    garbage: Option<u64>,
    /// What it held after the step.
    after: u64,
}

impl PassWatch {
    /// A watch over these steps.
    pub(crate) fn new(gpu: &Arc<Gpu>, steps: &Arc<[WatchedStep]>) -> PassWatch {
        let copies = steps.iter().map(|_| StepCopies::default()).collect();
        PassWatch { gpu: gpu.clone(), steps: steps.clone(), copies, open: None, asked: Vec::new() }
    }

    /// Begins a frame. The one before must have been waited for.
    pub(super) fn begin_frame(&mut self) {
        self.copies.iter_mut().for_each(|copies| copies.places.clear());
        self.asked.clear();
        self.open = None;
    }

    /// Copies what the passes of a step must leave as it is, and fills what they don't name with garbage. The step's barriers were recorded,
    /// and its commands follow. Nothing if the step isn't watched.
    pub(super) fn begin(&mut self, frame: &Frame<'_>, commands: vk::CommandBuffer, step: usize) -> Result<(), Error> {
        let Some(number) = self.steps.iter().position(|watched| watched.step == step) else { return Ok(()) };
        let steps = self.steps.clone();
        let recorded = steps[number].recorded.fetch_add(1, Ordering::Relaxed);
        // To look takes barriers, which hide hazards from the validation layer: it has every second run of a step for itself. What runs once
        // is looked at then.
        let shared = self.gpu.instance.validation.is_some() && !steps[number].once;
        if shared && recorded.is_multiple_of(2) {
            return Ok(());
        }
        // Runs that follow each other, and are looked at, have different garbage.
        let looked = if shared { recorded / 2 } else { recorded };
        let turn = usize::from(!looked.is_multiple_of(2));
        let copies = &mut self.copies[number];
        copies.turn = turn;
        let end = copies.place(frame, &steps[number].parts);
        if copies.buffer.as_ref().is_none_or(|made| made.bytes < end) {
            let usage = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
            copies.buffer = Some(RawBuffer::new(&self.gpu, "watched", end, usage, MemoryUse::Readback)?);
        }
        let Some(buffer) = &copies.buffer else { return Ok(()) };
        let copying = Copying { frame, commands, buffer: buffer.raw };
        let parts = || steps[number].parts.iter().zip(&copies.places);
        let filled = || parts().filter(|(_, place)| place.garbage.is_some());
        copying.turn(&steps[number].parts, false);
        parts().for_each(|(part, place)| copying.take(part, place.before, place.bytes));
        copying.wait();
        filled().for_each(|(part, _)| copying.spoil(part, turn));
        copying.wait();
        for (part, place) in filled() {
            place.garbage.into_iter().for_each(|at| copying.take(part, at, place.bytes));
        }
        copying.turn(&steps[number].parts, true);
        self.open = Some(number);
        Ok(())
    }

    /// Copies the same again behind the commands of the step that was begun, and gives what was filled its contents back.
    pub(super) fn end(&mut self, frame: &Frame<'_>, commands: vk::CommandBuffer) {
        let Some(number) = self.open.take() else { return };
        let StepCopies { buffer: Some(buffer), places, .. } = &self.copies[number] else { return };
        let copying = Copying { frame, commands, buffer: buffer.raw };
        let parts = &self.steps[number].parts;
        copying.turn(parts, false);
        parts.iter().zip(places).for_each(|(part, place)| copying.take(part, place.after, place.bytes));
        copying.wait();
        let unnamed = |part: &WatchedPart| part.promise == PartPromise::Unnamed;
        for (part, place) in parts.iter().zip(places).filter(|(part, place)| place.garbage.is_some() && unnamed(part)) {
            copying.give_back(part, place.before, place.bytes);
        }
        copying.turn(parts, true);
        barrier_call(frame.gpu, commands, &[to_host()], &[]);
    }

    /// Notes that the program asked for images or buffers of the Plan that its pass doesn't name.
    pub(super) fn note_asked(&mut self, pass: &Pass, asked: Vec<String>) {
        for resource in asked {
            let done = "the program asked the recorder for it".to_owned();
            let passes = vec![(pass.name.to_string(), pass.cause.at().cloned())];
            self.asked.push(BrokenPromise { passes, resource, declared: None, done });
        }
    }

    /// What the passes of the frame did that they must not. The frame must have been waited for. `untouched`: what earlier frames left
    /// untouched.
    pub(crate) fn broken(&self, untouched: &mut UntouchedTexels) -> Result<Vec<BrokenPromise>, Error> {
        let mut broken = self.asked.clone();
        for (watched, StepCopies { buffer, places, turn }) in self.steps.iter().zip(&self.copies) {
            let Some(buffer) = buffer.as_ref().filter(|_| !places.is_empty()) else { continue };
            let bytes = buffer.contents(usize::try_from(buffer.bytes).unwrap_or(usize::MAX))?;
            for (number, (part, place)) in watched.parts.iter().zip(places).enumerate() {
                let held = |at: u64| {
                    let [at, length] = [at, place.bytes].map(|number| usize::try_from(number).unwrap_or(usize::MAX));
                    bytes.get(at..at.saturating_add(length)).unwrap_or_default()
                };
                let (expected, after) = (held(place.garbage.unwrap_or(place.before)), held(place.after));
                let done = match part.promise {
                    PartPromise::Unnamed | PartPromise::Read => difference(part, expected, after),
                    PartPromise::Replaced => untouched.look((watched.step, number), *turn, part, (expected, after)),
                };
                let (passes, resource, declared) = (watched.passes.clone(), part.name.clone(), part.said.clone());
                broken.extend(done.map(|done| BrokenPromise { passes, resource, declared, done }));
            }
        }
        Ok(broken)
    }
}

impl StepCopies {
    /// Places the copies of these parts, and returns where they end.
    fn place(&mut self, frame: &Frame<'_>, parts: &[WatchedPart]) -> u64 {
        self.places.clear();
        let mut end = 0_u64;
        for part in parts {
            let bytes = if may_be_copied(frame, part) { bytes(frame, part) } else { 0 };
            let mut next = || {
                let at = end;
                end = (end + bytes).next_multiple_of(ALIGNMENT);
                at
            };
            let (before, after, garbage) = (next(), next(), may_be_spoilt(frame, part).then(next));
            self.places.push(CopyPlace { bytes, before, garbage, after });
        }
        end.max(ALIGNMENT)
    }
}

/// How many bytes a part takes in a buffer.
fn bytes(frame: &Frame<'_>, part: &WatchedPart) -> u64 {
    match part.resource {
        Resource::Image(id) => {
            let image = frame.plan.image(id);
            let extent = EyeForm::extent(image.eyes, frame.extent(id, part.range.base_mip), image.rotation);
            let bytes = match part.range.aspects {
                Aspects::COLOR => image.format.bytes(extent),
                plane => extent
                    .iter()
                    .fold(plane_bytes(image.format, plane), |all, side| all.saturating_mul(u64::from(*side))),
            };
            bytes.saturating_mul(part.range.layers.into())
        }
        Resource::Buffer(buffer) => frame.buffer(buffer).bytes,
    }
}

/// Whether a part can be copied from. A buffer of the program's own is made as the Plan says, and no more.
fn may_be_copied(frame: &Frame<'_>, part: &WatchedPart) -> bool {
    match part.resource {
        // The program is told to make them so: `Executor::image_info`.
        Resource::Image(_) => true,
        Resource::Buffer(buffer) => {
            let planned = frame.plan.buffers[buffer.0 as usize].usage.contains(BufferUsage::TRANSFER_SRC);
            planned || !frame.buffer(buffer).is_foreign()
        }
    }
}

/// Whether a part is filled with garbage: its step doesn't read it, and it can be.
fn may_be_spoilt(frame: &Frame<'_>, part: &WatchedPart) -> bool {
    let fits = match part.resource {
        Resource::Image(image) => {
            let made = frame.image(image).descriptor;
            // Queues without graphics clear colours alone.
            let clears = part.range.aspects == Aspects::COLOR;
            made.usage.contains(Usage::TRANSFER_DST) && !made.format.is_compressed() && clears
        }
        Resource::Buffer(buffer) => {
            let made = frame.buffer(buffer);
            let planned = frame.plan.buffers[buffer.0 as usize].usage.contains(BufferUsage::TRANSFER_DST);
            if made.is_foreign() { planned } else { made.usage.contains(vk::BufferUsageFlags::TRANSFER_DST) }
        }
    };
    part.promise != PartPromise::Read && fits && may_be_copied(frame, part)
}

/// Copies between parts and a buffer. Images are in the layout `GENERAL` meanwhile.
struct Copying<'c> {
    frame: &'c Frame<'c>,
    commands: vk::CommandBuffer,
    buffer: vk::Buffer,
}

impl Copying<'_> {
    /// Waits for everything before.
    fn wait(&self) {
        let (all, any) = (vk::PipelineStageFlags2::ALL_COMMANDS, vk::AccessFlags2::MEMORY_WRITE);
        let barrier = vk::MemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(any)
            .dst_stage_mask(all)
            .dst_access_mask(any | vk::AccessFlags2::MEMORY_READ);
        barrier_call(self.frame.gpu, self.commands, &[barrier], &[]);
    }

    /// Waits, and brings images from the layouts of their step into `GENERAL`, or `back`.
    fn turn(&self, parts: &[WatchedPart], back: bool) {
        self.wait();
        let (all, any) = (vk::PipelineStageFlags2::ALL_COMMANDS, vk::AccessFlags2::MEMORY_WRITE);
        let turned = parts.iter().filter_map(|part| {
            let Resource::Image(image) = part.resource else { return None };
            let (own, general) = (convert::layout(part.layout), convert::layout(Layout::General));
            let (old, new) = if back { (general, own) } else { (own, general) };
            let barrier = vk::ImageMemoryBarrier2::default()
                .src_stage_mask(all)
                .src_access_mask(any)
                .dst_stage_mask(all)
                .dst_access_mask(any | vk::AccessFlags2::MEMORY_READ)
                .old_layout(old)
                .new_layout(new)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .image(self.frame.image(image).raw)
                .subresource_range(convert::range(part.range));
            (old != new).then_some(barrier)
        });
        let turned: Vec<_> = turned.collect();
        if !turned.is_empty() {
            barrier_call(self.frame.gpu, self.commands, &[], &turned);
            self.wait();
        }
    }

    fn side(&self, part: &WatchedPart) -> TransferSide {
        match part.resource {
            Resource::Image(image) => {
                let extent = self.frame.extent(image, part.range.base_mip);
                TransferSide::Image(self.frame.image_side(image, part.range, extent, Layout::General))
            }
            Resource::Buffer(buffer) => {
                let made = self.frame.buffer(buffer);
                TransferSide::Buffer { buffer: made.raw, bytes: made.bytes }
            }
        }
    }

    /// Copies a part to a place of the buffer, if it can be copied.
    fn take(&self, part: &WatchedPart, at: u64, bytes: u64) {
        if bytes == 0 {
            return;
        }
        match self.side(part) {
            TransferSide::Image(image) => copy_from_image(self.frame.gpu, self.commands, image, (self.buffer, at)),
            TransferSide::Buffer { buffer, .. } => self.copy((buffer, 0), (self.buffer, at), bytes),
        }
    }

    /// Copies a part from a place of the buffer.
    fn give_back(&self, part: &WatchedPart, at: u64, bytes: u64) {
        match self.side(part) {
            TransferSide::Image(image) => copy_to_image(self.frame.gpu, self.commands, (self.buffer, at), image),
            TransferSide::Buffer { buffer, .. } => self.copy((self.buffer, at), (buffer, 0), bytes),
        }
    }

    fn copy(&self, (from, from_at): (vk::Buffer, u64), (to, to_at): (vk::Buffer, u64), bytes: u64) {
        let regions = [vk::BufferCopy2::default().src_offset(from_at).dst_offset(to_at).size(bytes)];
        let info = vk::CopyBufferInfo2::default().src_buffer(from).dst_buffer(to).regions(&regions);
        // SAFETY: recording outside a scope; both buffers hold as many bytes from there on.
        unsafe { self.frame.gpu.raw.cmd_copy_buffer2(self.commands, &info) };
    }

    /// Fills a part with garbage. The second one of images is 0.
    fn spoil(&self, part: &WatchedPart, turn: usize) {
        let garbage = match part.format {
            None => Clear::Word(WORDS[turn]),
            Some(format) if turn == 0 => pattern(format),
            Some(_) => Clear::Color(vk::ClearColorValue::default()),
        };
        fill(self.frame.gpu, self.commands, self.side(part), garbage);
    }
}
