//! How custom passes are recorded.

use super::asked_names::AskedNames;
use super::custom_image::{CustomImage, named_buffer};
use super::eye_target::eye_of;
use super::fragments::COUNTED;
use crate::base::convert;
use crate::commands::{TransferSide, barriers, copy_between, fill};
use crate::gpu::Gpu;
use crate::prepare::{Frame, part};
use ash::vk;
use framewright_graph::frame::{Eye, EyeForm, ParamValue, Stereo};
use framewright_graph::plan::{self, Access, BufferAccess, Queue};
use framewright_graph::vulkan::{Accesses, FillValue, Stages, name_of};

/// Records a custom pass, outside of rendering scopes. The pass's images and buffers go by the names that the Plan gives
/// them, and are in the state that the Plan says.
///
/// No method fails at once: the first misuse is kept, what follows is ignored, and [`crate::Executor::frame`] returns it
/// as [`crate::Error::Recording`].
pub struct CustomRecorder<'f> {
    frame: &'f Frame<'f>,
    commands: vk::CommandBuffer,
    pass: &'f plan::Pass,
    queue: Queue,
    recorded: u32,
    /// Whether the program has the command buffer.
    has_raw: bool,
    /// Whether a query is open in it.
    has_query: bool,
    misuse: Option<String>,
    asked: AskedNames,
}

/// The image or buffer that a name stands for, as the pass accesses it.
enum NamedResource<'f> {
    Image(&'f Access),
    Buffer(&'f BufferAccess),
}

impl NamedResource<'_> {
    fn accesses(&self) -> Accesses {
        match self {
            NamedResource::Image(it) => it.accesses,
            NamedResource::Buffer(it) => it.accesses,
        }
    }

    fn stages(&self) -> Stages {
        match self {
            NamedResource::Image(it) => it.stages,
            NamedResource::Buffer(it) => it.stages,
        }
    }
}

impl<'f> CustomRecorder<'f> {
    /// `queue`: that of the pass's step; `has_query`: whether a query is open.
    pub(crate) fn new(
        frame: &'f Frame<'f>,
        commands: vk::CommandBuffer,
        pass: &'f plan::Pass,
        (queue, has_query): (Queue, bool),
    ) -> CustomRecorder<'f> {
        CustomRecorder {
            frame,
            commands,
            pass,
            queue,
            recorded: 0,
            has_raw: false,
            has_query,
            misuse: None,
            asked: AskedNames::default(),
        }
    }

    /// The queue of the Plan that runs the pass: that for graphics, or that for compute if the pipeline says `queue: Any`.
    #[must_use]
    pub fn queue(&self) -> Queue {
        self.queue
    }

    /// The queue family that the command buffer is for.
    #[must_use]
    pub fn queue_family(&self) -> u32 {
        self.frame.gpu.queues.families.family(self.queue).index
    }

    /// The pass's name.
    #[must_use]
    pub fn pass(&self) -> &str {
        &self.pass.name
    }

    /// The view that the pass draws for; `None` if the Plan has none.
    #[must_use]
    pub fn view(&self) -> Option<&plan::View> {
        let view = self.pass.view?;
        self.frame.plan.views.get(view.0 as usize)
    }

    /// The eye that the pass is recorded for, where that is done for one after the other; `None`: there is one, or it is recorded for
    /// [both](CustomRecorder::both_eyes), or for what both share.
    #[must_use]
    pub fn eye(&self) -> Option<Eye> {
        eye_of(self.frame.plan, self.pass)
    }

    /// How the pass is recorded for both eyes at once: `both_eyes` of the pipeline, where the frame is drawn so. Images of each eye then
    /// hold both eyes' parts ([`CustomImage::eyes`]), and [`CustomRecorder::fill`] and [`CustomRecorder::copy`] reach both. `None`: it is for
    /// one eye, or touches nothing that is an eye's own.
    #[must_use]
    pub fn both_eyes(&self) -> Option<(Stereo, EyeForm)> {
        let plan = self.frame.plan;
        plan.both_eyes(self.pass).map(|form| (plan.stereo, form))
    }

    /// The number of the frame, as [`Executor::submit`](crate::Executor::submit) returns it.
    #[must_use]
    pub fn frame(&self) -> u64 {
        self.frame.told
    }

    /// By how many texels to the right and down what the pass's view shows is shifted in this frame.
    #[must_use]
    pub fn jitter(&self) -> [f64; 2] {
        let jitter = self.view().and_then(|view| view.jitter.as_ref());
        jitter.map_or([0.0; 2], |jitter| jitter.offset(self.frame.told))
    }

    /// A parameter that the pipeline gives the pass.
    #[must_use]
    pub fn param(&self, name: &str) -> Option<ParamValue> {
        self.pass.params.iter().find(|param| *param.name == *name).map(|param| self.frame.clock.resolved(&param.value))
    }

    /// The images and buffers that the pass reads by transfer, in the pipeline's order.
    pub fn sources(&self) -> impl Iterator<Item = &str> {
        self.named(Accesses::TRANSFER_READ)
    }

    /// The images and buffers that the pass writes by transfer, in the pipeline's order.
    pub fn targets(&self) -> impl Iterator<Item = &str> {
        self.named(Accesses::TRANSFER_WRITE)
    }

    fn named(&self, accesses: Accesses) -> impl Iterator<Item = &str> {
        self.resources().filter(move |(_, it)| it.accesses().contains(accesses)).map(|(name, _)| name)
    }

    /// The images, then the buffers of the pass, by the Plan's names.
    fn resources(&self) -> impl Iterator<Item = (&'f str, NamedResource<'f>)> + use<'f> {
        let (plan, pass) = (self.frame.plan, self.pass);
        let image = |it: &'f Access| (&*plan.image(it.image).name, NamedResource::Image(it));
        let buffer = |it: &'f BufferAccess| (&*plan.buffers[it.buffer.0 as usize].name, NamedResource::Buffer(it));
        pass.accesses.iter().map(image).chain(pass.buffers.iter().map(buffer))
    }

    /// Sets all that the pass may write of an image or buffer to a value that its format holds. Where the pass declares the use, it names
    /// `CLEAR`.
    pub fn fill(&mut self, target: &str, value: FillValue) {
        let Some(named) = self.find(target, Accesses::TRANSFER_WRITE, Stages::CLEAR) else { return };
        let format = match named {
            NamedResource::Image(access) => Some(self.frame.plan.image(access.image).format),
            NamedResource::Buffer(_) => None,
        };
        if let Some(what) = value.problem(format) {
            return self.misused(|| format!("`{target}` is filled with {what}"));
        }
        fill(self.frame.gpu, self.commands, self.side(&named), convert::clear(format, value));
        self.recorded += 1;
    }

    /// Copies the first mip level that the pass may read of one image or buffer to that of another. Between images formats,
    /// extents and rotations must agree; between buffers the shorter says how much; beside a buffer texels follow each other
    /// without gaps. Where the pass declares the uses, they name `COPY`.
    pub fn copy(&mut self, source: &str, target: &str) {
        let from = self.find(source, Accesses::TRANSFER_READ, Stages::COPY);
        let (Some(from), Some(to)) = (from, self.find(target, Accesses::TRANSFER_WRITE, Stages::COPY)) else { return };
        if !self.agree(&from, &to) {
            return self.misused(|| format!("`{source}` and `{target}` differ in format, extent or rotation"));
        }
        copy_between(self.frame.gpu, self.commands, self.side(&from), self.side(&to));
        self.recorded += 1;
    }

    /// An image of the pass, by the Plan's name or the shader's, for commands of the program's own.
    #[must_use]
    pub fn image(&self, name: &str) -> Option<CustomImage> {
        self.asked.note(name, CustomImage::of(self.frame, self.pass, name))
    }

    /// A buffer of the pass, by the Plan's name or the shader's, for commands of the program's own.
    #[must_use]
    pub fn buffer(&self, name: &str) -> Option<vk::Buffer> {
        self.asked.note(name, named_buffer(self.frame, self.pass, name))
    }

    /// The command buffer, recording outside of rendering scopes, for commands of the program's own. To record is unsafe:
    /// they may touch the pass's images and buffers, as the Plan says, and the program's own resources, and nothing else. A rendering scope
    /// that is left open is a finding of the validation layer, which [names the pass](crate::Message::at).
    #[must_use]
    pub fn raw(&mut self) -> vk::CommandBuffer {
        self.recorded += 1;
        self.has_raw = true;
        self.commands
    }

    /// Executes secondary command buffers, one after the other, which were begun with an inheritance info of its defaults: no rendering scope
    /// and no query is open. They were recorded on any thread, during the frame or before it. While the frame's
    /// [fragments are counted](crate::ExecutorOptions::fragment_counts) a query is open on queues that draw, and to execute any is a misuse.
    ///
    /// # Safety
    /// They are of this device and of [`CustomRecorder::queue_family`], recorded and ended, and touch what the pass names, as the Plan says,
    /// and the program's own resources. No other thread uses them or their pools meanwhile. They live, and aren't recorded anew, until each
    /// frame was waited for that executes them. One that is executed again before that, as by the next of several frames in flight or by the
    /// same pass of the other eye, was begun with `SIMULTANEOUS_USE`.
    pub unsafe fn execute(&mut self, secondary: &[vk::CommandBuffer]) {
        if secondary.is_empty() {
            return;
        }
        if self.has_query {
            return self.misused(|| COUNTED.to_owned());
        }
        let commands = self.raw();
        // SAFETY: the command buffer is being recorded outside a scope, and the caller's word.
        unsafe { self.frame.gpu.raw.cmd_execute_commands(commands, secondary) };
    }

    /// The image or buffer that the pass names by this name, for these accesses in one stage; a misuse if there is none.
    fn find(&mut self, name: &str, accesses: Accesses, stage: Stages) -> Option<NamedResource<'f>> {
        if self.misuse.is_some() {
            return None;
        }
        let mut named = self.resources().filter(|(known, it)| *known == name && it.accesses().contains(accesses));
        let found = named.next().map(|(_, it)| it);
        let verb = if accesses == Accesses::TRANSFER_READ { "reads" } else { "writes" };
        match &found {
            None => self.misused(|| format!("the pass {verb} no `{name}` by transfer")),
            Some(it) if !it.stages().intersects(stage | Stages::ALL_COMMANDS) => {
                let (stage, declared) = (name_of(&stage), name_of(&it.stages()));
                self.misused(|| format!("the pass declares to use `{name}` in {declared}, and {verb} it in {stage}"));
                return None;
            }
            Some(_) => {}
        }
        found
    }

    fn side(&self, named: &NamedResource<'_>) -> TransferSide {
        match named {
            NamedResource::Image(access) => {
                let extent = self.frame.extent(access.image, access.range.base_mip);
                TransferSide::Image(self.frame.image_side(access.image, access.range, extent, access.layout))
            }
            NamedResource::Buffer(access) => {
                let bytes = self.frame.plan.buffers[access.buffer.0 as usize].bytes;
                TransferSide::Buffer { buffer: self.frame.buffer(access.buffer).raw, bytes }
            }
        }
    }

    /// Whether one may be copied to the other.
    fn agree(&self, from: &NamedResource<'_>, to: &NamedResource<'_>) -> bool {
        let plan = self.frame.plan;
        let texels = |access: &Access| {
            let image = plan.image(access.image);
            let range = part(image, access.range);
            (
                image.format,
                image.samples,
                self.frame.extent(access.image, access.range.base_mip),
                range.layers,
                range.aspects,
            )
        };
        let rotation = |access: &Access| plan.image(access.image).rotation;
        let fits = |access: &Access, buffer: &BufferAccess| {
            let (format, samples, extent, layers, aspects) = texels(access);
            let sides = extent.iter().fold(u64::from(layers), |all, side| all.saturating_mul(u64::from(*side)));
            let needed = sides.saturating_mul(crate::commands::plane_bytes(format, aspects));
            samples == 1 && needed <= plan.buffers[buffer.buffer.0 as usize].bytes
        };
        match (from, to) {
            (NamedResource::Image(from), NamedResource::Image(to)) => {
                texels(from) == texels(to) && rotation(from) == rotation(to)
            }
            (NamedResource::Image(image), NamedResource::Buffer(buffer))
            | (NamedResource::Buffer(buffer), NamedResource::Image(image)) => fits(image, buffer),
            (NamedResource::Buffer(_), NamedResource::Buffer(_)) => true,
        }
    }

    fn misused(&mut self, what: impl FnOnce() -> String) {
        self.misuse.get_or_insert_with(what);
    }

    /// The images and buffers of the Plan that were asked for, and that the pass doesn't name.
    pub(super) fn asked(&self) -> Vec<String> {
        self.asked.of(self.frame.plan, self.pass)
    }

    /// How many commands were recorded, or the first misuse. To record nothing is one where the pass writes: those who read
    /// that would read what the memory held before.
    pub(crate) fn finish(self) -> Result<u32, String> {
        if self.has_raw {
            no_scope(self.frame.gpu, self.commands);
        }
        let unwritten = self.resources().find(|(_, it)| self.recorded == 0 && !it.accesses().writes().is_empty());
        let unwritten = unwritten.map(|(name, ..)| format!("nothing was recorded, and the pass writes `{name}`"));
        self.misuse.or(unwritten).map_or(Ok(self.recorded), Err)
    }
}

/// Under the validation layer, has it look whether a rendering scope is open. The barrier is wrong in a scope, and makes nothing wait: no
/// stage comes after it.
fn no_scope(gpu: &Gpu, commands: vk::CommandBuffer) {
    if gpu.instance.validation.is_none() {
        return;
    }
    let after_copies = vk::MemoryBarrier2::default().src_stage_mask(vk::PipelineStageFlags2::COPY);
    barriers(gpu, commands, &[after_copies], &[]);
}
