//! Exchange between frames: reading and writing images and buffers that outlive them, and importing the program's own.

use super::executor::Executor;
use crate::base::Error;
use crate::commands::{
    Readback, Texels, first_plane, level_bytes, mip_extent, plane_bytes, rotate_texels, write_buffer, write_image,
};
use crate::memory::{Image, RawBuffer};
use crate::prepare::{buffer_descriptor, descriptor, initial_queue};
use ash::vk::{self, Handle};
use framewright_graph::plan::{BufferId, ImageId, Queue, Resource, Role};
use framewright_graph::vulkan::{Aspects, Layout, State, Usage};

impl Executor {
    /// The output number `output` of the Plan, an image, as the last frame left it: colour or depth of its first mip level.
    /// Frames in flight are waited for.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such output or no frame yet, [`Error::OutOfMemory`], [`Error::DeviceLost`].
    pub fn read(&mut self, output: usize) -> Result<Texels, Error> {
        let bad = |what: &str| Error::BadResource { what: format!("output {output} can't be read: {what}") };
        match self.plan.outputs.get(output).ok_or_else(|| bad("the Plan has fewer"))?.resource {
            Resource::Image(image) => self.read_plane(image, first_plane(self.plan.image(image).format), 0),
            Resource::Buffer(_) => Err(bad("it is a buffer")),
        }
    }

    /// One plane of a mip level of the image `name`, which outlives the frame, as the last frame left it. Frames in flight
    /// are waited for.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such image, plane or level, or no frame yet; those of [`Executor::read`].
    pub fn read_image(&mut self, name: &str, plane: Aspects, mip: u32) -> Result<Texels, Error> {
        let image = self.image_named(name)?;
        self.read_plane(image, plane, mip)
    }

    /// The bytes of the buffer `name`, which outlives the frame, as the last frame left it. Frames in flight are waited for.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such buffer, or no frame yet; those of [`Executor::read`].
    pub fn read_buffer(&mut self, name: &str) -> Result<Vec<u8>, Error> {
        let id = self.buffer_named(name)?;
        let (frame, state, queue) = self.left(Resource::Buffer(id))?;
        self.wait_for_all()?;
        let buffer = self.prepared.physical.buffer(id, frame);
        let readback = Readback::of_buffer(&self.gpu, buffer.bytes)?;
        self.gpu.submit_once("reading a buffer back", queue, |commands| {
            readback.record_buffer(&self.gpu, commands, buffer, state);
        })?;
        readback.bytes()
    }

    fn read_plane(&mut self, id: ImageId, plane: Aspects, mip: u32) -> Result<Texels, Error> {
        let name = &*self.plan.image(id).name;
        if self.owners.iter().any(|(of, _)| of == name) {
            let what =
                format!("`{name}` can't be read: it is shown in a window; `read_back_image` has what a frame left");
            return Err(Error::BadResource { what });
        }
        self.check_part(id, plane, mip)?;
        let (frame, state, queue) = self.left(Resource::Image(id))?;
        self.wait_for_all()?;
        let image = self.prepared.physical.image(id, frame);
        let extent = self.prepared.physical.level(self.plan.image(id), mip, frame);
        let readback = Readback::of_image(&self.gpu, &image.descriptor, plane, (mip, extent))?;
        self.gpu.submit_once("reading an image back", queue, |commands| {
            readback.record_image(&self.gpu, commands, image, state);
        })?;
        readback.texels(&image.descriptor, self.plan.image(id).rotation)
    }

    /// The texels that frame `frame` left in the output number `output`, an image. The frame must have been waited for, no
    /// later one may have taken its place, and [`crate::ExecutorOptions::readback`] must be set.
    ///
    /// # Errors
    /// [`Error::BadResource`] if one of these isn't so.
    pub fn read_back_image(&mut self, frame: u64, output: usize) -> Result<Texels, Error> {
        let bad = || Error::BadResource { what: format!("output {output} of frame {frame} is no image that was kept") };
        let Some(Resource::Image(image)) = self.plan.outputs.get(output).map(|it| it.resource) else {
            return Err(bad());
        };
        let own = self.own(frame)?;
        self.wait_for_own(own)?;
        let descriptor = self.prepared.physical.image(image, own).descriptor;
        let rotation = self.plan.image(image).rotation;
        self.frames.readback(own, output).ok_or_else(bad)?.texels(&descriptor, rotation)
    }

    /// The bytes that frame `frame` left in the output number `output`, a buffer; else as [`Executor::read_back_image`].
    ///
    /// # Errors
    /// Those of [`Executor::read_back_image`].
    pub fn read_back_buffer(&mut self, frame: u64, output: usize) -> Result<Vec<u8>, Error> {
        let bad =
            || Error::BadResource { what: format!("output {output} of frame {frame} is no buffer that was kept") };
        let Some(Resource::Buffer(_)) = self.plan.outputs.get(output).map(|it| it.resource) else { return Err(bad()) };
        let own = self.own(frame)?;
        self.wait_for_own(own)?;
        self.frames.readback(own, output).ok_or_else(bad)?.bytes()
    }

    /// Sets one plane of a mip level of the image `name`, which outlives the frame, for the next frame to find: layer after
    /// layer, rows from the top, without padding, upright. Frames in flight are waited for.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such image, plane or level, if the number of bytes doesn't fit, or the Plan
    /// doesn't rely on its contents; [`Error::OutOfMemory`], [`Error::DeviceLost`].
    pub fn write_image(&mut self, name: &str, plane: Aspects, mip: u32, bytes: &[u8]) -> Result<(), Error> {
        let id = self.image_named(name)?;
        self.check_part(id, plane, mip)?;
        self.wait_for_all()?;
        self.ready()?;
        let bad = |what: String| Error::BadResource { what: format!("image `{name}` can't be written: {what}") };
        if self.plan.image(id).allocated.is_some() {
            return Err(bad("its size may change from frame to frame, and a frame writes it anew".to_owned()));
        }
        let (state, queue) = self.found(Resource::Image(id), name)?;
        let image = self.prepared.physical.image(id, self.frames.next());
        if !image.descriptor.usage.contains(Usage::TRANSFER_DST) {
            return Err(bad("nothing can be copied to it".to_owned()));
        }
        let sides = mip_extent(&image.descriptor, mip);
        let expected = level_bytes(&image.descriptor, plane, mip);
        if bytes.len() as u64 != expected {
            return Err(bad(format!("{} bytes were given, {expected} are needed", bytes.len())));
        }
        let rotation = self.plan.image(id).rotation;
        if !rotation.turns() {
            return write_image(&self.gpu, queue, image, (plane, mip), state, bytes);
        }
        let texel_bytes = usize::try_from(plane_bytes(image.descriptor.format, plane)).unwrap_or(1);
        let turned = rotate_texels::turned(bytes, rotation.extent([sides[0], sides[1]]), texel_bytes, rotation);
        write_image(&self.gpu, queue, image, (plane, mip), state, &turned)
    }

    /// Sets the buffer `name`, which outlives the frame, for the next frame to find: of [buffers in turn](Executor::import_buffers) the one
    /// whose turn it is. Frames in flight are waited for.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such buffer or it has another number of bytes; [`Error::OutOfMemory`],
    /// [`Error::DeviceLost`].
    pub fn write_buffer(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let id = self.buffer_named(name)?;
        self.wait_for_all()?;
        self.ready()?;
        // Reading goes on with the one that the last frame used.
        let of_last = self.prepared.physical.choice(Resource::Buffer(id));
        self.take_turn(id);
        let written = self.write_next(id, name, bytes);
        self.prepared.physical.choose(Resource::Buffer(id), of_last);
        written
    }

    /// Sets the buffer that stands for this one as they are chosen now.
    fn write_next(&self, id: BufferId, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let (state, queue) = self.found(Resource::Buffer(id), name)?;
        let buffer = self.prepared.physical.buffer(id, self.frames.next());
        if bytes.len() as u64 != buffer.bytes {
            let (given, held) = (bytes.len(), buffer.bytes);
            let what = format!("buffer `{name}` can't be written: {given} bytes were given, it holds {held}");
            return Err(Error::BadResource { what });
        }
        write_buffer(&self.gpu, queue, buffer, state, bytes)
    }

    /// Takes the program's own image for the external image `name`, from the next frame on. Nothing is waited for: frames in flight use the
    /// image before, and what was made for it is kept until they are done.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such external image.
    ///
    /// # Safety
    /// The image must have been made by this executor's device as the Plan describes it, its usage included, and be in the Plan's state
    /// `before` whenever a frame begins: synchronised with the queue of the first step that touches it, and after each frame brought from
    /// the state `after`. It must live as long as the executor, or until another one is imported and [`Executor::wait`] has waited for the
    /// last frame submitted before that import.
    pub unsafe fn import_image(&mut self, name: &str, image: vk::Image) -> Result<(), Error> {
        // SAFETY: the caller's promise.
        unsafe { self.import_images(name, &[image]) }
    }

    /// Takes several images of the program's own for the external image `name`, as those of a swapchain. Each frame uses the one that
    /// [`Submission::images`](crate::Submission) chooses, the first ones the first. What a frame needs is made once for each image:
    /// another choice costs nothing later. Nothing is waited for, as by [`Executor::import_image`].
    ///
    /// # Errors
    /// Those of [`Executor::import_image`]; [`Error::BadResource`] if there are no images.
    ///
    /// # Safety
    /// That of [`Executor::import_image`], for each image in the frames that use it.
    pub unsafe fn import_images(&mut self, name: &str, images: &[vk::Image]) -> Result<(), Error> {
        let id = self.image_named(name)?;
        self.may_import(&self.plan.image(id).role, name)?;
        if images.is_empty() {
            return Err(Error::BadResource { what: format!("no images were given for `{name}`") });
        }
        self.missing.retain(|missing| missing != name);
        let descriptor = descriptor(self.plan.image(id));
        // SAFETY: the caller's promise.
        let images: Vec<_> = images.iter().map(|raw| unsafe { Image::foreign(&self.gpu, &descriptor, *raw) }).collect();
        let now = images.iter().map(|image| image.raw.as_raw()).collect();
        let replaced = self.prepared.replace_images(id, images);
        let owners = self.owners.extract_if(.., |(of, _)| of == name).map(|(_, owner)| owner).collect();
        self.retired.keep(&self.frames, Resource::Image(id), replaced, owners);
        self.note_imported(Resource::Image(id), now);
        Ok(())
    }

    /// Takes the program's own buffer for the external buffer `name`, from the next frame on. Nothing is waited for, as by
    /// [`Executor::import_image`].
    ///
    /// # Errors
    /// Those of [`Executor::import_image`].
    ///
    /// # Safety
    /// That of [`Executor::import_image`].
    pub unsafe fn import_buffer(&mut self, name: &str, buffer: vk::Buffer) -> Result<(), Error> {
        // SAFETY: the caller's promise.
        unsafe { self.import_buffers(name, &[buffer]) }
    }

    /// Takes several buffers of the program's own for the external buffer `name`, which frames use in turn: the frame of number `n`, as
    /// [`Executor::submit`] returns it, uses the one of number `n % buffers.len()`, unless
    /// [`Submission::images`](crate::Submission) chooses another one. With as many as frames may be on their way, the program writes the
    /// one of the next frame ([`Executor::frames`]) as soon as the frame that used it last was waited for. Nothing is waited for here, as by
    /// [`Executor::import_image`].
    ///
    /// # Errors
    /// Those of [`Executor::import_image`]; [`Error::BadResource`] if there are no buffers.
    ///
    /// # Safety
    /// That of [`Executor::import_image`], for each buffer in the frames that use it.
    pub unsafe fn import_buffers(&mut self, name: &str, buffers: &[vk::Buffer]) -> Result<(), Error> {
        let id = self.buffer_named(name)?;
        let plan = &self.plan.buffers[id.0 as usize];
        self.may_import(&plan.role, name)?;
        if buffers.is_empty() {
            return Err(Error::BadResource { what: format!("no buffers were given for `{name}`") });
        }
        self.missing.retain(|missing| missing != name);
        let descriptor = buffer_descriptor(plan);
        // SAFETY: the caller's promise.
        let foreign = buffers.iter().map(|raw| unsafe { RawBuffer::foreign(&self.gpu, &descriptor, *raw) });
        let replaced = self.prepared.replace_buffers(id, foreign);
        self.retired.keep(&self.frames, Resource::Buffer(id), replaced, Vec::new());
        self.in_turn.retain(|(of, _)| *of != id);
        self.in_turn.push((id, buffers.len()));
        self.note_imported(Resource::Buffer(id), buffers.iter().map(|raw| raw.as_raw()).collect());
        Ok(())
    }

    /// Notes that the program imported these handles for an image or buffer.
    fn note_imported(&mut self, resource: Resource, now: Vec<u64>) {
        if let Some(import) = self.imports.iter_mut().find(|it| it.resource == resource) {
            import.ownership.imported(|raw| now.contains(&raw));
        }
    }

    /// Vulkan's image that stood for the image `name` in the last frame, for commands of the program's own; `None` if there
    /// is no such image. It may be in use until that frame was waited for, and is in the state that the Plan says.
    #[must_use]
    pub fn raw_image(&self, name: &str) -> Option<vk::Image> {
        let id = self.image_named(name).ok()?;
        Some(self.prepared.physical.image(id, self.frames.next().saturating_sub(1)).raw)
    }

    fn may_import(&self, role: &Role, name: &str) -> Result<(), Error> {
        match role {
            Role::External { .. } => Ok(()),
            Role::Transient(_) | Role::Persistent { .. } => {
                Err(Error::BadResource { what: format!("`{name}` is not the program's own, and can't be imported") })
            }
        }
    }

    fn image_named(&self, name: &str) -> Result<ImageId, Error> {
        let found = self.plan.images.iter().find(|it| *it.name == *name).map(|it| it.id);
        found.ok_or_else(|| Error::BadResource { what: format!("the Plan has no image `{name}`") })
    }

    fn buffer_named(&self, name: &str) -> Result<BufferId, Error> {
        let found = self.plan.buffers.iter().find(|it| *it.name == *name).map(|it| it.id);
        found.ok_or_else(|| Error::BadResource { what: format!("the Plan has no buffer `{name}`") })
    }

    /// One plane of one level of an image that can be copied to or from a buffer.
    fn check_part(&self, id: ImageId, plane: Aspects, mip: u32) -> Result<(), Error> {
        let image = self.plan.image(id);
        let bad = |what: &str| Err(Error::BadResource { what: format!("image `{}` {what}", image.name) });
        match () {
            () if image.samples > 1 => bad("has several samples and can't be read or written"),
            () if plane.bits().count_ones() != 1 || !image.format.aspects().contains(plane) => bad("has no such plane"),
            () if mip >= image.mips => bad("has fewer mip levels"),
            () => Ok(()),
        }
    }

    /// Which frame left it last, in what state, and on which queue.
    fn left(&self, resource: Resource) -> Result<(u64, State, Queue), Error> {
        let (name, role) = (self.plan.resource_name(resource), self.plan.role(resource));
        let bad = |what: &str| Error::BadResource { what: format!("`{name}` can't be read: {what}") };
        let drawn = self.frames.next().checked_sub(1);
        if self.is_outside(resource, drawn.unwrap_or(0)) {
            return Err(bad("it was given back to its outside owner; what is read back with a frame is kept"));
        }
        let frame = drawn.ok_or_else(|| bad("no frame was drawn yet"))?;
        match role {
            Role::Transient(_) => Err(bad("it is transient")),
            Role::Persistent { after, .. } | Role::External { after, .. } => {
                Ok((frame, *after, self.owner(resource).ok_or_else(|| bad("another queue takes it over"))?))
            }
        }
    }

    /// In what state the next frame finds it, and on which queue.
    fn found(&self, resource: Resource, name: &str) -> Result<(State, Queue), Error> {
        let bad = |what: &str| Error::BadResource { what: format!("`{name}` can't be written: {what}") };
        if self.is_outside(resource, self.frames.next()) {
            return Err(bad("its outside owner has it"));
        }
        let role = self.plan.role(resource);
        let is_image = matches!(resource, Resource::Image(_));
        let state = match role {
            Role::Transient(_) => return Err(bad("it is transient")),
            Role::External { before, .. } if is_image && before.layout == Layout::Undefined => {
                return Err(bad("the Plan doesn't rely on its contents"));
            }
            Role::Persistent { before, .. } => *before,
            Role::External { before, .. } if self.frames.next() == 0 => *before,
            Role::External { after, .. } => *after,
        };
        let first = self.frames.next() == 0;
        let queue = if first { initial_queue(&self.plan, &self.uses, resource) } else { self.owner(resource) };
        Ok((state, queue.ok_or_else(|| bad("another queue takes it over"))?))
    }

    /// The queue that has it between frames; `None` while it is handed over, and if no step touches it the first.
    pub(crate) fn owner(&self, resource: Resource) -> Option<Queue> {
        let Some(span) = self.uses.of(resource) else { return Some(Queue::Graphics) };
        let step = &self.plan.steps[span.last.0 as usize];
        let released = step.releases.iter().any(|barrier| Resource::Image(barrier.image) == resource);
        (!released).then_some(step.queue)
    }
}
