//! Whether uses that the program declares can be: the accesses in their stages, on their queue, in their layout.
//!
//! That barriers before and after cover the declared stages and accesses, and that the image is in the declared layout by then, is
//! found where those of all accesses are.

use super::accesses::{ATTACHMENT, buffer_usage};
use super::barriers::possible;
use super::layouts::planes;
use super::passes::CommandSource;
use super::structure::is_of_file;
use super::work::{Check, is_read_only, is_written};
use crate::frame::BufferRole;
use crate::plan::{Access, BufferAccess, Pass, Queue};
use crate::vulkan::{Accesses, Layout, Stages, name_of};

/// Accesses that are no command's, or say nothing of what it does.
const UNSAID: Accesses =
    Accesses::MEMORY_READ.union(Accesses::MEMORY_WRITE).union(Accesses::HOST_READ).union(Accesses::HOST_WRITE);

/// Accesses of buffers alone.
const OF_BUFFERS: Accesses = Accesses::UNIFORM_READ
    .union(Accesses::VERTEX_ATTRIBUTE_READ)
    .union(Accesses::INDEX_READ)
    .union(Accesses::INDIRECT_COMMAND_READ)
    .union(Accesses::SHADER_READ)
    .union(Accesses::ACCELERATION_STRUCTURE_READ_KHR)
    .union(Accesses::ACCELERATION_STRUCTURE_WRITE_KHR)
    .union(Accesses::SHADER_BINDING_TABLE_READ_KHR);

const STORAGE: Accesses = Accesses::SHADER_STORAGE_READ.union(Accesses::SHADER_STORAGE_WRITE);
const SAMPLED: Accesses = Accesses::SHADER_SAMPLED_READ.union(Accesses::INPUT_ATTACHMENT_READ);

/// The stages of commands within a rendering scope.
const DRAWN: Stages = Stages::DRAW_INDIRECT
    .union(Stages::VERTEX_INPUT)
    .union(Stages::VERTEX_SHADER)
    .union(Stages::TASK_SHADER_EXT)
    .union(Stages::MESH_SHADER_EXT)
    .union(Stages::FRAGMENT_SHADER)
    .union(Stages::ALL_COMMANDS);

impl Check<'_, '_> {
    /// A declared access to an image.
    pub(super) fn declared_image(&mut self, access: &Access, by: CommandSource) {
        let Access { image: id, accesses, layout, .. } = *access;
        let image = self.plan.image(id);
        if let Some(what) = self.misdeclared(access.stages, accesses, by) {
            self.wrong(id, what);
        }
        self.demand(!accesses.intersects(OF_BUFFERS), id, "is declared to be used as only buffers are");
        let draws = by == CommandSource::Program { draws: true };
        let attached = ATTACHMENT | Accesses::FRAGMENT_SHADING_RATE_ATTACHMENT_READ_KHR;
        self.demand(!draws || !accesses.intersects(attached), id, "is declared to be an attachment in a scope");
        let color = Accesses::COLOR_ATTACHMENT_READ | Accesses::COLOR_ATTACHMENT_WRITE;
        let depth = Accesses::DEPTH_STENCIL_ATTACHMENT_READ | Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE;
        let fits = match layout {
            Layout::General => true,
            layout if is_read_only(layout) => (SAMPLED | Accesses::DEPTH_STENCIL_ATTACHMENT_READ).contains(accesses),
            Layout::ColorAttachmentOptimal => color.contains(accesses),
            layout if is_written(layout) => depth.contains(accesses),
            Layout::ShaderReadOnlyOptimal => SAMPLED.contains(accesses),
            Layout::TransferSrcOptimal => accesses == Accesses::TRANSFER_READ,
            Layout::TransferDstOptimal => accesses == Accesses::TRANSFER_WRITE,
            Layout::FragmentShadingRateAttachmentOptimalKhr => {
                accesses == Accesses::FRAGMENT_SHADING_RATE_ATTACHMENT_READ_KHR
            }
            _ => false,
        };
        let there = planes(layout, image.format.aspects()).contains(access.range.aspects);
        self.demand(fits && there, id, "can't be used in its layout as its pass declares");
        self.demand(image.samples == 1 || !accesses.intersects(STORAGE), id, "has several samples and is storage");
        let writes = !accesses.writes().is_empty();
        self.demand(!writes || !is_of_file(image), id, "is written, and its contents are a file's");
        let sampled = access.binding.as_ref().is_some_and(|binding| binding.kind.sampler().is_some());
        self.demand(!writes || !sampled, id, "is sampled, and declared to be written");
    }

    /// A declared access to a buffer.
    pub(super) fn declared_buffer(&mut self, access: &BufferAccess, by: CommandSource) {
        let resource = Some(self.plan.images.len() as u32 + access.buffer.0);
        let accesses = access.accesses;
        if let Some(what) = self.misdeclared(access.stages, accesses, by) {
            self.found.structure(Some(self.id), resource, what);
        }
        if accesses.iter().any(|access| buffer_usage(access).is_empty()) {
            self.found.structure(Some(self.id), resource, "is declared to be used as only images are");
        }
        let writes = access.role.is_none_or(BufferRole::writes);
        if !writes && !accesses.writes().is_empty() {
            self.found.structure(Some(self.id), resource, "is read by its pass, and declared to be written");
        }
    }

    /// What a program records stays on the queue for graphics, unless it agrees to another one for compute and declares all that it does.
    pub(super) fn queue_of_program(&mut self, pass: &Pass) {
        let declared = pass.accesses.iter().all(|it| it.declared) && pass.buffers.iter().all(|it| it.declared);
        let agreed = self.queue == Queue::Compute && pass.any_queue && declared;
        if self.queue != Queue::Graphics && !agreed {
            let what =
                format!("is recorded by the program on {}, and doesn't say that it can be", name_of(&self.queue));
            self.wrong_pass(pass, &what);
        }
    }

    /// Why stages and accesses can't be declared.
    fn misdeclared(&self, stages: Stages, accesses: Accesses, by: CommandSource) -> Option<String> {
        let possible = match by {
            CommandSource::Plan => return Some("is used as its pass declares, and no program records that".to_owned()),
            CommandSource::Program { draws: false } => possible(self.queue) - Stages::HOST,
            CommandSource::Program { draws: true } => DRAWN,
        };
        let known = Stages::from_bits(stages.bits()).is_some() && Accesses::from_bits(accesses.bits()).is_some();
        if !known || stages.is_empty() || accesses.is_empty() || accesses.intersects(UNSAID) {
            return Some(format!("is declared to be used by {} in {}", name_of(&accesses), name_of(&stages)));
        }
        let foreign = stages - possible;
        (!foreign.is_empty())
            .then(|| format!("is declared to be used in {}, where its pass can't be", name_of(&foreign)))
    }
}
