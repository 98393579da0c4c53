//! How a draw source records its draws.

mod area;

use super::state::CommandState;
use crate::gpu::Gpu;
use crate::prepare::{DrawTarget, PassState, PreparedDraw};
use crate::resources::{BindGroup, Buffer};
use ash::vk;
use framewright_graph::plan;
use framewright_graph::vulkan::Rotation;
use std::ops::Range;

/// The faces that are left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CullMode {
    /// None.
    None,
    /// Faces seen from the front.
    Front,
    /// Faces seen from behind.
    Back,
}

/// The direction in which the vertices of a face go round, seen from its front.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrontFace {
    /// Counter-clockwise, as in glTF.
    CounterClockwise,
    /// Clockwise: counter-clockwise mirrored.
    Clockwise,
}

/// The type of an index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum IndexType {
    /// Two bytes.
    U16,
    /// Four bytes.
    U32,
}

/// Records the draws of one pass.
///
/// No method fails at once: the first misuse is kept, what follows is ignored, and [`crate::Executor::frame`] returns it
/// as [`crate::Error::Recording`].
pub struct Recorder<'f> {
    gpu: &'f Gpu,
    commands: vk::CommandBuffer,
    state: &'f mut CommandState,
    kept: &'f mut HeldResources,
    pass: &'f PassState,
    has_pipeline: bool,
    plan: &'f plan::Pass,
    target: DrawTarget,
    frame: u64,
    vertices: Option<u64>,
    indices: Option<u64>,
    culled: u32,
    /// The rectangles of viewport and scissor, where they aren't all of the picture and each eye's half has its own.
    viewport: Option<[f64; 4]>,
    scissor: Option<[f64; 4]>,
    /// Whether the pass was looked through for bindings that its draws lack.
    looked: bool,
    misuse: Option<String>,
}

/// Resources of a frame's commands, kept until the device is done with them even if the draw source drops them.
#[derive(Default)]
pub(crate) struct HeldResources {
    groups: Vec<BindGroup>,
    buffers: Vec<Buffer>,
    /// By set from 1 on: whether the pass that is being recorded has all that it reads of it.
    bound: Vec<bool>,
}

impl HeldResources {
    /// Lets go of everything, and keeps the memory of the lists.
    pub(super) fn clear(&mut self) {
        self.groups.clear();
        self.buffers.clear();
    }
}

impl<'f> Recorder<'f> {
    pub(crate) fn new(
        (gpu, commands): (&'f Gpu, vk::CommandBuffer),
        (state, kept): (&'f mut CommandState, &'f mut HeldResources),
        drawn: &'f PreparedDraw,
        plan: &'f plan::Pass,
        target: DrawTarget,
        frame: u64,
    ) -> Recorder<'f> {
        let (pass, has_pipeline) = (&drawn.state, drawn.pipeline.is_some());
        kept.bound.clear();
        kept.bound.extend(pass.supplied.iter().map(|(_, needed)| !needed));
        let (vertices, indices, misuse) = (None, None, None);
        Recorder {
            gpu,
            commands,
            state,
            kept,
            pass,
            has_pipeline,
            plan,
            target,
            frame,
            vertices,
            indices,
            culled: 0,
            viewport: None,
            scissor: None,
            looked: false,
            misuse,
        }
    }

    /// The pass's name.
    #[must_use]
    pub fn pass(&self) -> &str {
        &self.plan.name
    }

    /// The view that the pass draws for, in the list of the Plan; `None` if the Plan has none.
    #[must_use]
    pub fn view(&self) -> Option<plan::ViewId> {
        self.plan.view
    }

    /// The name of the pass's shader. For custom draws it says what is drawn; if there is no shader of that name then no
    /// pipeline is bound, and only [`Recorder::raw`] can draw.
    #[must_use]
    pub fn shader(&self) -> &str {
        &self.plan.shader
    }

    /// Whether the shipped vertex shader of this kind of draw places the vertices. If not, it can't be told from the scene
    /// where they end up, and nothing that is drawn may be left out.
    #[must_use]
    pub fn has_usual_vertices(&self) -> bool {
        self.pass.usual_vertices
    }

    /// Counts objects that the draw source leaves out because nothing of them can be seen, for the report.
    pub fn count_culled(&mut self, objects: u32) {
        self.culled = self.culled.saturating_add(objects);
    }

    /// The command buffer, recording inside the pass's rendering scope, for commands of the program's own. To record is
    /// unsafe: nothing but the scope's attachments and the program's own resources may be touched, and the scope must be
    /// left open. What the recorder's own methods rely on (pipeline, sets, buffers) must be left bound, or no such method
    /// be called any more. A scope without colour attachments has one that is unused: pipelines of the program's own give it
    /// the format `UNDEFINED`.
    #[must_use]
    pub fn raw(&mut self) -> vk::CommandBuffer {
        self.state.lose_track();
        self.commands
    }

    /// Width and height of the picture that is drawn, upright.
    #[must_use]
    pub fn extent(&self) -> [u32; 2] {
        self.target.upright()
    }

    /// The rotation of the picture in the attachments. Shaders that support rotation turn their own positions
    /// (`include/rotation.glsl`). Code that draws by [`Recorder::raw`] with a pipeline of its own must turn them itself.
    #[must_use]
    pub fn rotation(&self) -> Rotation {
        self.target.rotation
    }

    /// Width and height of what is drawn into: of the turned picture.
    #[must_use]
    pub fn target_extent(&self) -> [u32; 2] {
        self.target.extent
    }

    /// The number of the frame, from 0: what moves and what is shifted from frame to frame goes by it.
    #[must_use]
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// Binds a group to the set number `set`, from 1 on.
    pub fn bind_group(&mut self, set: u32, group: &BindGroup) {
        if !group.0.set.is_of(self.gpu) {
            return self.misused(|| "the bind group belongs to another device".to_owned());
        }
        let index = (set as usize).wrapping_sub(1);
        match self.pass.supplied.get(index) {
            None => self.misused(|| format!("the draw interface has no set {set}")),
            Some((layout, _)) if *layout != group.0.set.layout => {
                self.misused(|| {
                    format!("the bind group was made for another set than {set}, or another draw interface")
                });
            }
            Some(_) => {
                self.kept.bound[index] = true;
                self.kept.groups.push(group.clone());
                let sets = [group.0.set.raw];
                // SAFETY: the set has the layout that the pipeline's layout has at this number.
                unsafe {
                    let graphics = vk::PipelineBindPoint::GRAPHICS;
                    let (device, layout) = (&self.gpu.raw, self.pass.layout);
                    device.cmd_bind_descriptor_sets(self.commands, graphics, layout, set, &sets, &[]);
                }
            }
        }
    }

    /// Binds the vertices.
    pub fn bind_vertex_buffer(&mut self, buffer: &Buffer) {
        if !self.may_bind(buffer, vk::BufferUsageFlags::VERTEX_BUFFER) {
            return self.misused(|| "the buffer was not made for vertices, or not by this device".to_owned());
        }
        self.vertices = Some(buffer.bytes());
        // SAFETY: the command buffer is being recorded, and the buffer was made for vertices.
        unsafe { self.gpu.raw.cmd_bind_vertex_buffers(self.commands, 0, &[buffer.0.raw], &[0]) };
    }

    /// Binds the indices.
    pub fn bind_index_buffer(&mut self, buffer: &Buffer, ty: IndexType) {
        if !self.may_bind(buffer, vk::BufferUsageFlags::INDEX_BUFFER) {
            return self.misused(|| "the buffer was not made for indices, or not by this device".to_owned());
        }
        let (ty, bytes) = match ty {
            IndexType::U16 => (vk::IndexType::UINT16, 2),
            IndexType::U32 => (vk::IndexType::UINT32, 4),
        };
        self.indices = Some(buffer.bytes() / bytes);
        // SAFETY: the command buffer is being recorded, and the buffer was made for indices.
        unsafe { self.gpu.raw.cmd_bind_index_buffer(self.commands, buffer.0.raw, 0, ty) };
    }

    /// Says which faces are left out from now on.
    pub fn set_cull_mode(&mut self, mode: CullMode) {
        if !self.state.needs_cull_mode(mode) {
            return;
        }
        let mode = match mode {
            CullMode::None => vk::CullModeFlags::NONE,
            CullMode::Front => vk::CullModeFlags::FRONT,
            CullMode::Back => vk::CullModeFlags::BACK,
        };
        // SAFETY: the command buffer is being recorded, and the state is dynamic in every pipeline.
        unsafe { self.gpu.raw.cmd_set_cull_mode(self.commands, mode) };
    }

    /// Says which side is the front from now on, after the projection, which flips y.
    pub fn set_front_face(&mut self, face: FrontFace) {
        if !self.state.needs_front_face(face) {
            return;
        }
        let face = match face {
            FrontFace::CounterClockwise => vk::FrontFace::COUNTER_CLOCKWISE,
            FrontFace::Clockwise => vk::FrontFace::CLOCKWISE,
        };
        // SAFETY: the command buffer is being recorded, and the state is dynamic in every pipeline.
        unsafe { self.gpu.raw.cmd_set_front_face(self.commands, face) };
    }

    /// Draws triangles of consecutive vertices. `instances` begins at what shaders see as the first `gl_InstanceIndex`.
    pub fn draw(&mut self, vertices: Range<u32>, instances: Range<u32>) {
        let stride = u64::from(self.pass.vertex_stride);
        let reach = u64::from(vertices.end) * stride;
        if stride > 0 && self.vertices.is_some_and(|bytes| bytes < reach) {
            return self.misused(|| format!("vertices {vertices:?} lie beyond the vertex buffer"));
        }
        if self.may_draw() {
            let count = vertices.end.saturating_sub(vertices.start);
            self.for_eyes(instances, |device, commands, first, instances| {
                // SAFETY: everything that the pipeline reads is bound and large enough.
                unsafe { device.cmd_draw(commands, count, instances, vertices.start, first) };
            });
        }
    }

    /// Draws triangles of indexed vertices; `base_vertex` is added to each index.
    pub fn draw_indexed(&mut self, indices: Range<u32>, base_vertex: i32, instances: Range<u32>) {
        match self.indices {
            None => return self.misused(|| "an indexed draw without index buffer".to_owned()),
            Some(held) if held < u64::from(indices.end) => {
                return self.misused(|| format!("indices {indices:?} lie beyond the index buffer, which holds {held}"));
            }
            Some(_) => {}
        }
        if self.may_draw() {
            let count = indices.end.saturating_sub(indices.start);
            self.for_eyes(instances, |device, commands, first, instances| {
                // SAFETY: everything that the pipeline reads is bound, the indices exist, and with robustBufferAccess an
                // index beyond the vertices reads no foreign memory.
                unsafe { device.cmd_draw_indexed(commands, count, instances, indices.start, base_vertex, first) };
            });
        }
    }

    /// Draws the vertices, or the indices, of the pass's own buffers, which were bound and are large enough.
    pub(crate) fn draw_own(&mut self, count: u32, instances: u32, indexed: bool) {
        if self.may_draw() {
            self.for_eyes(0..instances, |device, commands, first, instances| {
                // SAFETY: everything that the pipeline reads is bound, and with robustBufferAccess an index beyond the vertices
                // reads no foreign memory.
                unsafe {
                    if indexed {
                        device.cmd_draw_indexed(commands, count, instances, 0, 0, first);
                    } else {
                        device.cmd_draw(commands, count, instances, 0, first);
                    }
                }
            });
        }
    }

    /// Draws as often as `counts` says.
    pub(crate) fn draw_indirect(&mut self, counts: vk::Buffer, indexed: bool) {
        if self.may_draw() {
            // SAFETY: as above; the buffer holds one command.
            unsafe {
                if indexed {
                    self.gpu.raw.cmd_draw_indexed_indirect(self.commands, counts, 0, 1, 20);
                } else {
                    self.gpu.raw.cmd_draw_indirect(self.commands, counts, 0, 1, 16);
                }
            }
        }
    }

    /// Whether the buffer may be bound so; if it may, it is kept.
    fn may_bind(&mut self, buffer: &Buffer, usage: vk::BufferUsageFlags) -> bool {
        let may = buffer.0.usage.contains(usage) && buffer.0.is_of(self.gpu);
        if may {
            self.kept.buffers.push(buffer.clone());
        }
        may
    }

    /// Whether everything that the pipeline reads is bound. What is bound once is bound for the rest of the pass.
    fn may_draw(&mut self) -> bool {
        if !self.looked {
            self.look_for_missing();
            self.looked = true;
        }
        self.misuse.is_none()
    }

    /// A draw is misuse as long as something is missing.
    fn look_for_missing(&mut self) {
        if let Some(missing) = self.kept.bound.iter().position(|bound| !bound) {
            self.misused(|| format!("a draw without a bind group for set {}", missing + 1));
        }
        if !self.has_pipeline {
            let shader = &self.plan.shader;
            self.misused(|| format!("a draw without pipeline: there is no shader `{shader}`"));
        }
        if self.pass.vertex_stride > 0 && self.vertices.is_none() {
            self.misused(|| "a draw without vertex buffer".to_owned());
        }
    }

    fn misused(&mut self, what: impl FnOnce() -> String) {
        self.misuse.get_or_insert_with(what);
    }

    /// How many objects were left out, or the first misuse if there was any.
    pub(crate) fn finish(self) -> Result<u32, String> {
        self.misuse.map_or(Ok(self.culled), Err)
    }
}
