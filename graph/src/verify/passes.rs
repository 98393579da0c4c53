//! Whether each pass is well formed: its draws or dispatches, and its accesses.

use super::accesses::ATTACHMENT;
use super::barriers::possible;
use super::layouts::planes;
use super::structure::is_of_file;
use super::work::{Check, is_read_only, is_written};
use crate::frame::{Blend, BufferRole, Cascade, Draw, Groups, IndirectDraws};
use crate::plan::names::ShownText;
use crate::plan::{Access, Attachment, BindingKind, BufferAccess, Image, Pass, RenderScope};
use crate::shader::MOST_PARTS;
use crate::vulkan::{
    Accesses, Aspects, ColorComponents, CompareOp, Component, Dimension, Format, ImageShape, Layout, PrimitiveTopology,
    Sampler, Shape, Stages, StencilOp, name_of,
};

const STORAGE: Accesses = Accesses::SHADER_STORAGE_READ.union(Accesses::SHADER_STORAGE_WRITE);
const SHADER: Accesses = STORAGE.union(Accesses::SHADER_SAMPLED_READ).union(Accesses::INPUT_ATTACHMENT_READ);
const TRANSFER: Accesses = Accesses::TRANSFER_READ.union(Accesses::TRANSFER_WRITE);
const SHADERS: Stages = Stages::VERTEX_SHADER.union(Stages::FRAGMENT_SHADER);
const MEMORY: Accesses = Accesses::MEMORY_READ.union(Accesses::MEMORY_WRITE);
const TESTS: Stages = Stages::EARLY_FRAGMENT_TESTS.union(Stages::LATE_FRAGMENT_TESTS);

const NOT_WAITED: &str =
    "is used by commands that only the program knows, and not waited for in all stages and accesses";

/// Who records the commands of a pass.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum CommandSource {
    /// The backend, as the Plan says.
    Plan,
    /// The program: it may use any command for what the pass reads and writes, unless the pass declares the use.
    Program {
        /// Whether it records within a rendering scope.
        draws: bool,
    },
}

impl CommandSource {
    /// The stages that an access may name, if `stages` are those of the Plan's own commands; and the access without what stands for
    /// any command.
    fn known(self, stages: Stages, accesses: Accesses) -> (Stages, Accesses) {
        match self {
            CommandSource::Plan => (stages, accesses),
            CommandSource::Program { .. } => (Stages::ALL_COMMANDS, accesses - MEMORY),
        }
    }

    /// Whether an access waits, and is waited for, as widely as its commands may need.
    fn waits(self, stages: Stages, accesses: Accesses) -> bool {
        let made = accesses - MEMORY;
        let holds = |any: Accesses, some: bool| accesses.contains(any) == some;
        self == CommandSource::Plan
            || stages == Stages::ALL_COMMANDS
                && holds(Accesses::MEMORY_READ, made != made.writes())
                && holds(Accesses::MEMORY_WRITE, !made.writes().is_empty())
    }
}

impl<'p> Check<'_, 'p> {
    pub(super) fn draw(&mut self, scope: &RenderScope, pass: &'p Pass) {
        self.named(&pass.name);
        self.parts(pass);
        if pass.draw.is_none() || pass.groups.is_some() {
            self.wrong_pass(pass, "is in a rendering scope and draws nothing");
        }
        if let Some(cascade) = pass.draw.and_then(Draw::cascade)
            && !(cascade.index < cascade.of && cascade.of <= Cascade::MOST)
        {
            self.wrong_pass(pass, "draws a part of the shadows' reach that there isn't");
        }
        if pass.blend.len() != scope.color().len() {
            self.wrong_pass(pass, "doesn't say how each colour attachment is blended");
        }
        if !(pass.write_masks.is_empty() || pass.write_masks.len() == scope.color().len()) {
            self.wrong_pass(pass, "doesn't say which channels it writes of each colour attachment");
        }
        if pass.write_masks.iter().any(|mask| !ColorComponents::RGBA.contains(*mask)) {
            self.wrong_pass(pass, "writes a channel that there isn't");
        }
        if f32::from(pass.raster.line_width) < 1.0 {
            self.wrong_pass(pass, "draws lines that are narrower than a texel");
        }
        let topology = pass.raster.topology;
        if topology != PrimitiveTopology::TriangleList && pass.draw.is_some_and(Draw::is_full_screen) {
            self.wrong_pass(
                pass,
                "has another topology than triangles, and draws the triangle that covers the picture",
            );
        }
        let lists = [PrimitiveTopology::PointList, PrimitiveTopology::LineList, PrimitiveTopology::TriangleList];
        if pass.raster.primitive_restart && lists.contains(&topology) {
            self.wrong_pass(pass, "begins strips anew and draws none");
        }
        let second = pass.blend.iter().any(|blend| blend.takes_second_source());
        if second && listed_colors(scope, pass) > 1 {
            self.wrong_pass(pass, "blends with a second colour and draws into several colour attachments");
        }
        let covers = scope.samples > 1 && !scope.color().is_empty() && pass.redraws.is_none();
        if pass.alpha_to_coverage && !(covers && pass.discards) {
            self.wrong_pass(pass, "covers samples by alpha and can't, or doesn't say that fragments may be lost");
        }
        let local = scope.attachments.iter().any(|attachment| attachment.layout == Layout::RenderingLocalReadKhr);
        if pass.local_barrier && !local {
            self.wrong_pass(pass, "has a local barrier in a scope without local reads");
        }
        for (attachment, blend) in scope.color().iter().zip(&pass.blend) {
            let reads = *blend != Blend::Replace;
            let integer = self.plan.image(attachment.image).format.is_integer();
            self.demand(!(reads && integer), attachment.image, "has integers, which can't be blended");
            // A scope with local reads holds the attachments of passes that draw to different ones.
            let drawn = !local || !listed(pass, attachment).is_empty();
            if drawn {
                let read = if reads { Accesses::COLOR_ATTACHMENT_READ } else { Accesses::empty() };
                self.attached(pass, attachment, Accesses::COLOR_ATTACHMENT_WRITE | read);
            }
        }
        self.depth(scope, pass);
        self.stencil(scope, pass);
        let tests = if scope.depth().is_some() || scope.stencil().is_some() { TESTS } else { Stages::empty() };
        let graphics = SHADERS | tests | Stages::COLOR_ATTACHMENT_OUTPUT;
        let by = match pass.draw.is_some_and(Draw::is_custom) {
            true => CommandSource::Program { draws: true },
            false => CommandSource::Plan,
        };
        for access in &pass.accesses {
            self.access(access, by, graphics, ATTACHMENT | SHADER);
            let attached = scope.attachments.iter().any(|attachment| {
                (attachment.image, attachment.range, attachment.layout) == (access.image, access.range, access.layout)
            });
            let stray = access.accesses.intersects(ATTACHMENT) && !attached;
            self.demand(!stray, access.image, "is accessed as an attachment that its scope doesn't have");
        }
        let indexed = pass.buffers.iter().any(|access| access.role.is_some_and(BufferRole::is_index));
        if let (Some([count, _]), true) = (pass.draw.and_then(Draw::counts), indexed) {
            self.holds(pass, BufferRole::Index, u64::from(count) * 4);
        }
        if let Some(draws) = pass.draw.and_then(Draw::indirect) {
            self.indirect(pass, draws, if indexed { 20 } else { 16 });
        }
        self.buffers(pass, by, SHADERS | Stages::VERTEX_INPUT | Stages::DRAW_INDIRECT);
    }

    /// The commands of indirect draws, and the number of draws, lie within their buffers as Vulkan demands.
    fn indirect(&mut self, pass: &Pass, draws: IndirectDraws, bytes: u32) {
        let IndirectDraws { draws, offset, stride, count } = draws;
        let stride = stride.unwrap_or(bytes);
        let aligned = offset.is_multiple_of(4) && stride.is_multiple_of(4) && count.unwrap_or(0).is_multiple_of(4);
        if draws == 0 || !aligned || stride < bytes {
            self.wrong_pass(pass, "reads the counts of its draws where none can stand");
        }
        let between = u64::from(draws.saturating_sub(1)) * u64::from(stride);
        self.holds(pass, BufferRole::Indirect, offset.saturating_add(between).saturating_add(bytes.into()));
        if let Some(at) = count {
            self.holds(pass, BufferRole::Count, at.saturating_add(4));
        }
    }

    fn depth(&mut self, scope: &RenderScope, pass: &Pass) {
        let (state, attachment) = match (&pass.depth, scope.depth()) {
            (Some(state), Some(attachment)) => (state, attachment),
            (Some(_), None) => return self.wrong_pass(pass, "tests depth without a depth attachment"),
            (None, _) => return,
        };
        let tests = !matches!(state.test, CompareOp::Always | CompareOp::Never);
        self.plane(pass, attachment, tests, state.write);
    }

    fn stencil(&mut self, scope: &RenderScope, pass: &Pass) {
        let (state, attachment) = match (&pass.stencil, scope.stencil()) {
            (Some(state), Some(attachment)) => (state, attachment),
            (Some(_), None) => return self.wrong_pass(pass, "tests stencil without a stencil attachment"),
            (None, _) => return,
        };
        let tests = !matches!(state.test, CompareOp::Always | CompareOp::Never);
        let counts = !matches!(state.pass, StencilOp::Keep | StencilOp::Zero | StencilOp::Replace);
        self.plane(pass, attachment, tests || counts, state.pass != StencilOp::Keep);
    }

    /// Whether `pass` lists its accesses to the depth or stencil attachment.
    fn plane(&mut self, pass: &Pass, attachment: &Attachment, reads: bool, writes: bool) {
        let read = if reads { Accesses::DEPTH_STENCIL_ATTACHMENT_READ } else { Accesses::empty() };
        let write = if writes { Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE } else { Accesses::empty() };
        self.attached(pass, attachment, read | write);
        // It may be tested and written before the fragment shader and after it: an access in one isn't the whole.
        let same = |access: &&Access| access.image == attachment.image && access.range == attachment.range;
        let mut accesses = pass.accesses.iter().filter(same);
        let partial = accesses.any(|access| access.accesses.intersects(ATTACHMENT) && !access.stages.contains(TESTS));
        self.demand(!partial, attachment.image, "is tested in EARLY_FRAGMENT_TESTS and LATE_FRAGMENT_TESTS alike");
        let written = writes && is_read_only(attachment.layout);
        self.demand(!written, attachment.image, "is attached read-only and written");
    }

    /// Whether `pass` says that it makes these accesses to an attachment.
    fn attached(&mut self, pass: &Pass, attachment: &Attachment, wanted: Accesses) {
        let listed = listed(pass, attachment);
        if !listed.contains(wanted) {
            let what = format!("pass `{}` doesn't list its {}", ShownText(&pass.name), name_of(&(wanted - listed)));
            self.wrong(attachment.image, what);
        }
    }

    pub(super) fn dispatch(&mut self, pass: &'p Pass) {
        self.outside(pass);
        self.parts(pass);
        match pass.groups {
            None => self.wrong_pass(pass, "is a dispatch and doesn't say of how many workgroups"),
            Some(Groups::Indirect { offset }) => {
                if !offset.is_multiple_of(4) {
                    self.wrong_pass(pass, "reads its counts from an offset that is no multiple of 4");
                }
                self.holds(pass, BufferRole::Indirect, offset.saturating_add(12));
            }
            Some(Groups::Count(_) | Groups::Invocations(_)) => {}
        }
        for access in &pass.accesses {
            self.access(access, CommandSource::Plan, Stages::COMPUTE_SHADER, STORAGE | Accesses::SHADER_SAMPLED_READ);
        }
        self.buffers(pass, CommandSource::Plan, Stages::COMPUTE_SHADER | Stages::DRAW_INDIRECT);
    }

    pub(super) fn custom(&mut self, pass: &'p Pass) {
        self.outside(pass);
        if pass.groups.is_some() {
            self.wrong_pass(pass, "is recorded by the program and has workgroups");
        }
        self.queue_of_program(pass);
        let possible = possible(self.queue) & Stages::ALL_COMMANDS;
        let by = CommandSource::Program { draws: false };
        for access in &pass.accesses {
            self.access(access, by, possible, STORAGE | Accesses::SHADER_SAMPLED_READ | TRANSFER);
        }
        self.buffers(pass, by, possible);
    }

    /// A pass outside of rendering scopes.
    fn outside(&mut self, pass: &'p Pass) {
        self.named(&pass.name);
        let drawn = pass.draw.is_some() || !pass.blend.is_empty() || pass.depth.is_some() || pass.stencil.is_some();
        let drawn = drawn || pass.redraws.is_some() || !pass.raster.is_usual() || !pass.write_masks.is_empty();
        let covers = pass.discards || pass.covers || pass.untouched.is_some() || pass.alpha_to_coverage;
        if drawn || covers || pass.local_barrier || pass.merged.is_some() {
            self.wrong_pass(pass, "is no draw and has the state of one");
        }
    }

    fn access(&mut self, access: &Access, by: CommandSource, stages: Stages, accesses: Accesses) {
        self.stages_and_accesses(Some(access.image.0), access.stages, access.accesses);
        if access.declared {
            return self.declared_image(access, by);
        }
        let attached = access.accesses.intersects(ATTACHMENT);
        let local = access.accesses.intersects(Accesses::INPUT_ATTACHMENT_READ);
        let by = if attached || local { CommandSource::Plan } else { by };
        let (stages, made) = by.known(stages, access.accesses);
        if access.stages.is_empty() || made.is_empty() || !stages.contains(access.stages) {
            self.wrong(access.image, format!("is accessed in {}", name_of(&access.stages)));
        }
        self.demand(accesses.contains(made), access.image, "is accessed as a pass can't");
        self.demand(by.waits(access.stages, access.accesses), access.image, NOT_WAITED);
        let read_only = made.writes().is_empty();
        let sampled = Accesses::SHADER_SAMPLED_READ | Accesses::INPUT_ATTACHMENT_READ;
        let fits = match access.layout {
            Layout::General => true,
            layout if is_read_only(layout) => (Accesses::DEPTH_STENCIL_ATTACHMENT_READ | sampled).contains(made),
            layout if is_written(layout) => ATTACHMENT.contains(made),
            Layout::RenderingLocalReadKhr => (ATTACHMENT | Accesses::INPUT_ATTACHMENT_READ).contains(made),
            Layout::ShaderReadOnlyOptimal => sampled.contains(made),
            Layout::TransferSrcOptimal => made == Accesses::TRANSFER_READ,
            Layout::TransferDstOptimal => made == Accesses::TRANSFER_WRITE,
            _ => false,
        };
        let planes = planes(access.layout, self.plan.image(access.image).format.aspects());
        let what = if read_only { "can't be read so in its layout" } else { "can't be written so in its layout" };
        self.demand(fits && planes.contains(access.range.aspects), access.image, what);
        let fixed = is_of_file(self.plan.image(access.image));
        self.demand(read_only || !fixed, access.image, "is written, and its contents are a file's");
        self.binding(access);
    }

    /// Each shader access is bound with its own kind, and nothing else is bound.
    fn binding(&mut self, access: &Access) {
        let of_shader = access.accesses & SHADER;
        let Some(binding) = &access.binding else {
            self.demand(of_shader.is_empty(), access.image, "is accessed by a shader without such a binding");
            return;
        };
        let possible = match binding.kind {
            BindingKind::Sampled(_) => Accesses::SHADER_SAMPLED_READ,
            BindingKind::Storage => STORAGE,
            BindingKind::InputAttachment => Accesses::INPUT_ATTACHMENT_READ,
        };
        self.demand(!of_shader.is_empty(), access.image, "is bound without such an access");
        self.demand(possible.contains(of_shader), access.image, "is accessed by a shader without such a binding");
        let sampler = binding.kind.sampler();
        let linear = sampler.is_some_and(Sampler::is_linear);
        let Image { allocated, format, .. } = self.plan.image(access.image);
        let beyond = sampler.is_some_and(Sampler::reaches_out);
        self.demand(allocated.is_none() || !beyond, access.image, "is used in part and looked up beyond its edges");
        let of_stencil = access.range.aspects == Aspects::STENCIL;
        let seen = if of_stencil { Format::R8_UINT } else { *format };
        let unfit = sampler.is_some_and(|sampler| sampler.mistake(seen).is_some());
        self.demand(!unfit, access.image, "is sampled by a sampler that Vulkan rules out for its format");
        let integer = format.is_integer();
        self.demand(!(linear && integer), access.image, "has integers, which can't be filtered");
        let compares = sampler.is_some_and(|sampler| sampler.compare.is_some());
        let depth = format.is_depth() && access.range.aspects != Aspects::STENCIL;
        self.demand(!compares || depth, access.image, "is compared with a depth, and holds none");
        let declared = binding.texture.is_none_or(|texture| self.is_declared(access, texture));
        self.demand(declared, access.image, "isn't as its shader is made to declare it");
    }

    /// The most parts that a shader can be told of.
    fn parts(&mut self, pass: &'p Pass) {
        if self.plan.parts(pass).nth(MOST_PARTS).is_some() {
            self.wrong_pass(pass, "samples more images in part than shaders can be told of");
        }
    }

    /// Whether the part of an image that is sampled can be declared so.
    fn is_declared(&self, access: &Access, texture: ImageShape) -> bool {
        let image = self.plan.image(access.image);
        let shape = match texture.dimension {
            Dimension::D2 => image.shape != Shape::D3 && (texture.arrayed || access.range.layers == 1),
            Dimension::D3 => image.shape == Shape::D3 && !texture.arrayed,
            Dimension::Cube => {
                let cubes = access.range.layers / 6;
                image.shape == Shape::Cube && access.range.layers.is_multiple_of(6) && (texture.arrayed || cubes == 1)
            }
            Dimension::D1 | Dimension::Buffer => false,
        };
        let stencil = access.range.aspects == Aspects::STENCIL;
        let component = if stencil { Component::Uint } else { Component::of(image.format) };
        let sampled = access.accesses.contains(Accesses::SHADER_SAMPLED_READ);
        sampled && shape && texture.multisampled == (image.samples > 1) && texture.component == component
    }

    fn buffers(&mut self, pass: &Pass, by: CommandSource, stages: Stages) {
        for access in &pass.buffers {
            self.buffer(access, by, stages);
        }
    }

    fn buffer(&mut self, access: &BufferAccess, by: CommandSource, possible: Stages) {
        let resource = Some(self.plan.images.len() as u32 + access.buffer.0);
        self.stages_and_accesses(resource, access.stages, access.accesses);
        if access.declared {
            return self.declared_buffer(access, by);
        }
        let of = |on: bool, access: Accesses| if on { access } else { Accesses::empty() };
        let (stages, accesses) = match access.role {
            Some(BufferRole::Uniform) => (SHADERS | Stages::COMPUTE_SHADER, Accesses::UNIFORM_READ),
            Some(BufferRole::Storage { read, write }) => (
                SHADERS | Stages::COMPUTE_SHADER,
                of(read, Accesses::SHADER_STORAGE_READ) | of(write, Accesses::SHADER_STORAGE_WRITE),
            ),
            Some(BufferRole::Vertex) => (Stages::VERTEX_INPUT, Accesses::VERTEX_ATTRIBUTE_READ),
            Some(BufferRole::Index) => (Stages::VERTEX_INPUT, Accesses::INDEX_READ),
            Some(BufferRole::Indirect | BufferRole::Count) => (Stages::DRAW_INDIRECT, Accesses::INDIRECT_COMMAND_READ),
            None => (Stages::all(), access.accesses & TRANSFER),
        };
        let (possible, made) = by.known(stages & possible, access.accesses);
        if access.stages.is_empty() || !possible.contains(access.stages) {
            let what = format!("is accessed in {}", name_of(&access.stages));
            self.found.structure(Some(self.id), resource, what);
        }
        if made.is_empty() || made != accesses {
            let what = format!("is accessed by {}, which isn't what it is for", name_of(&access.accesses));
            self.found.structure(Some(self.id), resource, what);
        }
        if !by.waits(access.stages, access.accesses) {
            self.found.structure(Some(self.id), resource, NOT_WAITED);
        }
        let named = access.role.is_some_and(BufferRole::is_of_shaders);
        if named != access.binding.is_some() {
            self.found.structure(Some(self.id), resource, "has a shader's name exactly if a shader names it");
        }
    }

    /// Whether the pass has one buffer for this, with at least these bytes.
    fn holds(&mut self, pass: &Pass, role: BufferRole, bytes: u64) {
        let mut buffers = pass.buffers.iter().filter(|access| access.role == Some(role));
        match (buffers.next(), buffers.next()) {
            (Some(access), None) => {
                let has = self.plan.buffers[access.buffer.0 as usize].bytes;
                if has < bytes {
                    let resource = Some(self.plan.images.len() as u32 + access.buffer.0);
                    let what = format!("has {has} bytes, and pass `{}` reads {bytes}", ShownText(&pass.name));
                    self.found.structure(Some(self.id), resource, what);
                }
            }
            (None, _) => self.wrong_pass(pass, "has no buffer for its counts or indices"),
            (Some(_), Some(_)) => self.wrong_pass(pass, "has several buffers for its counts or indices"),
        }
    }
}

/// How many colour attachments a pass draws into.
fn listed_colors(scope: &RenderScope, pass: &Pass) -> usize {
    scope.color().iter().filter(|attachment| !listed(pass, attachment).is_empty()).count()
}

/// The accesses to an attachment that a pass lists.
fn listed(pass: &Pass, attachment: &Attachment) -> Accesses {
    pass.accesses
        .iter()
        .filter(|access| access.image == attachment.image && access.range == attachment.range)
        .fold(Accesses::empty(), |all, access| all | access.accesses & ATTACHMENT)
}
