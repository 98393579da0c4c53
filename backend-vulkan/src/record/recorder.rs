//! How a draw source records its draws.

use super::asked_names::AskedNames;
use super::bound_sets::BoundSets;
use super::canvas::Canvas;
use super::custom_image::{CustomImage, named_buffer};
use super::eye_target::{EyeTarget, eye_of};
use super::frame_resources::HeldResources;
use super::index_type::IndexType;
use crate::base::numbers;
use crate::gpu::{ScopeFormats, VertexBinding};
use crate::pipeline::PARTS_STAGES;
use crate::prepare::{Frame, PassState, PreparedDraw};
use crate::resources::{BindGroup, Buffer, ProgramBuffer, RawSet};
use ash::vk;
use framewright_graph::frame::{Draw, Eye, EyeForm, ParamValue, Stereo};
use framewright_graph::plan;
use framewright_graph::shader::VertexRate;
use framewright_graph::vulkan::{CullMode, FrontFace, Rotation};
use std::ops::Range;

/// Records the draws of one pass.
///
/// No method fails at once: the first misuse is kept, what follows is ignored, and [`crate::Executor::frame`] returns it
/// as [`crate::Error::Recording`].
pub struct Recorder<'f> {
    canvas: Canvas<'f>,
    sets: BoundSets<'f>,
    pass: &'f PassState,
    has_pipeline: bool,
    plan: &'f plan::Pass,
    frame: &'f Frame<'f>,
    indices: Option<u64>,
    culled: u32,
    /// Whether the pass was looked through for bindings that its draws lack, and nothing was misused.
    ready: bool,
    misuse: Option<String>,
    asked: AskedNames,
}

impl<'f> Recorder<'f> {
    pub(super) fn new(
        canvas: Canvas<'f>,
        kept: &'f mut HeldResources,
        drawn: &'f PreparedDraw,
        plan: &'f plan::Pass,
        frame: &'f Frame<'f>,
        begun: Result<(), String>,
    ) -> Recorder<'f> {
        let (pass, has_pipeline, misuse) = (&drawn.state, drawn.pipeline.is_some(), begun.err());
        let sets = BoundSets::new(canvas.gpu, vk::PipelineBindPoint::GRAPHICS, &pass.supplied, kept, frame.sets);
        let asked = AskedNames::default();
        Recorder {
            canvas,
            sets,
            pass,
            has_pipeline,
            plan,
            frame,
            indices: None,
            culled: 0,
            ready: false,
            misuse,
            asked,
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

    /// The eye that the pass draws for, where it is drawn for one after the other; `None`: there is one, or [`Recorder::both_eyes`] are
    /// drawn for, or what both share.
    #[must_use]
    pub fn eye(&self) -> Option<Eye> {
        eye_of(self.frame.plan, self.plan)
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
    /// be called any more. Pipelines of the program's own must fit [`Recorder::formats`].
    #[must_use]
    pub fn raw(&mut self) -> vk::CommandBuffer {
        self.canvas.state.lose_track();
        self.canvas.commands
    }

    /// An image that the pass samples, reads or draws into, by the Plan's name or the shader's, for pipelines of the program's own. It is in
    /// the state that the Plan says, and the barriers for the pass are recorded. The program makes its own view of it, and makes it anew for
    /// each image that stands for the name: an image with a history is another one in the next frame.
    #[must_use]
    pub fn image(&self, name: &str) -> Option<CustomImage> {
        self.asked.note(name, CustomImage::of(self.frame, self.plan, name))
    }

    /// A buffer that the pass reads or writes, by the Plan's name or the shader's, for commands of the program's own. In a
    /// [custom pass](framewright_graph::frame::Draw::Custom) any command may read it: the barriers for the pass wait for all of them.
    #[must_use]
    pub fn buffer(&self, name: &str) -> Option<vk::Buffer> {
        self.asked.note(name, named_buffer(self.frame, self.plan, name))
    }

    /// A parameter that the pipeline gives the pass.
    #[must_use]
    pub fn param(&self, name: &str) -> Option<ParamValue> {
        self.plan.params.iter().find(|param| *param.name == *name).map(|param| self.frame.clock.resolved(&param.value))
    }

    /// What pipelines of the program's own must fit to be bound here, as the pass sees its scope: in a scope with local reads the colours of
    /// the scope aren't those of the pass ([`ScopeFormats::local`]). [`crate::Executor::formats`] tells it before the first frame.
    #[must_use]
    pub fn formats(&self) -> &ScopeFormats {
        &self.pass.formats
    }

    /// Width and height of the picture that is drawn, upright.
    #[must_use]
    pub fn extent(&self) -> [u32; 2] {
        self.canvas.target.upright()
    }

    /// The rotation of the picture in the attachments. Shaders that support rotation turn their own positions
    /// (`include/rotation.glsl`). Code that draws by [`Recorder::raw`] with a pipeline of its own must turn them itself.
    #[must_use]
    pub fn rotation(&self) -> Rotation {
        self.canvas.target.rotation
    }

    /// Width and height of the targets, of the turned picture; where they are for both eyes, of one eye's picture.
    #[must_use]
    pub fn target_extent(&self) -> [u32; 2] {
        self.canvas.target.extent
    }

    /// The number of the frame, as [`Executor::submit`](crate::Executor::submit) returns it: what moves and what is shifted
    /// from frame to frame goes by it.
    #[must_use]
    pub fn frame(&self) -> u64 {
        self.frame.told
    }

    /// The queue family that the command buffer is for: that of graphics.
    #[must_use]
    pub fn queue_family(&self) -> u32 {
        self.canvas.gpu.queues.families.graphics.index
    }

    /// Binds a group to the set number `set`, from 1 on.
    pub fn bind_group(&mut self, set: u32, group: &BindGroup) {
        if !self.has_pipeline {
            let shader = &self.plan.shader;
            return self.misused(|| format!("a bind group without pipeline: there is no shader `{shader}`"));
        }
        let bound = self.sets.bind(self.canvas.commands, set, group);
        self.note(bound);
    }

    /// Binds a set that the program makes itself to its number, for the draws of this pass from now on, with its dynamic offsets. One that
    /// the pass's shader doesn't read is left out. What [`crate::Executor::bind_set`] bound is bound already.
    pub fn bind_set(&mut self, number: u32, set: RawSet, offsets: &[u32]) {
        let bound = self.sets.bind_raw(self.canvas.commands, number, set, offsets);
        self.note(bound);
    }

    /// Binds the first vertex buffer, from its beginning on.
    pub fn bind_vertex_buffer(&mut self, buffer: &Buffer) {
        self.bind_vertex_buffer_at(0, buffer, 0);
    }

    /// Binds the vertex buffer `number` of the draw interface, from an offset in bytes on, which is a multiple of 4. One whose number the
    /// device has no binding of is left out: no pipeline reads it.
    pub fn bind_vertex_buffer_at(&mut self, number: u32, buffer: &Buffer, offset: u64) {
        if !self.may_bind(buffer, vk::BufferUsageFlags::VERTEX_BUFFER) {
            return self.misused(|| "the buffer was not made for vertices, or not by this device".to_owned());
        }
        let Some(bytes) = buffer.bytes().checked_sub(offset).filter(|_| offset.is_multiple_of(4)) else {
            let held = buffer.bytes();
            return self.misused(|| {
                format!("vertices from byte {offset} of a buffer on, which holds {held}; offsets are multiples of 4")
            });
        };
        self.bind_vertices(number, buffer.0.raw, offset, bytes);
    }

    /// Binds a part of a buffer of the program's own as the vertex buffer `number` of the draw interface. Its offset is a multiple of 4. The
    /// buffer was made for vertices.
    pub fn bind_program_vertices(&mut self, number: u32, part: ProgramBuffer) {
        match part.checked(4) {
            Ok((buffer, offset, bytes)) => self.bind_vertices(number, buffer, offset, bytes),
            Err(why) => self.misused(|| format!("vertex buffer {number}: {why}")),
        }
    }

    /// Binds `bytes` bytes of a buffer for vertices from `offset` on.
    fn bind_vertices(&mut self, number: u32, buffer: vk::Buffer, offset: u64, bytes: u64) {
        if number >= self.pass.brought_buffers.max(1) {
            return self.misused(|| format!("the draw interface has no vertex buffer {number}"));
        }
        let bound = &mut self.sets.held.vertices;
        bound.retain(|(known, _)| *known != number);
        bound.push((number, bytes));
        if number >= self.canvas.gpu.limits.max_vertex_input_bindings {
            return;
        }
        // SAFETY: the command buffer is being recorded, the buffer was made for vertices, and the device has such a binding.
        unsafe { self.canvas.gpu.raw.cmd_bind_vertex_buffers(self.canvas.commands, number, &[buffer], &[offset]) };
    }

    /// Binds the indices.
    pub fn bind_index_buffer(&mut self, buffer: &Buffer, ty: IndexType) {
        if !self.may_bind(buffer, vk::BufferUsageFlags::INDEX_BUFFER) {
            return self.misused(|| "the buffer was not made for indices, or not by this device".to_owned());
        }
        self.bind_indices(buffer.0.raw, 0, buffer.bytes(), ty);
    }

    /// Binds a part of a buffer of the program's own as the indices. Its offset is a multiple of an index's bytes. The buffer was made for
    /// indices.
    pub fn bind_program_indices(&mut self, part: ProgramBuffer, ty: IndexType) {
        match part.checked(ty.bytes()) {
            Ok((buffer, offset, bytes)) => self.bind_indices(buffer, offset, bytes, ty),
            Err(why) => self.misused(|| format!("the index buffer: {why}")),
        }
    }

    /// Binds `bytes` bytes of a buffer for indices from `offset` on.
    fn bind_indices(&mut self, buffer: vk::Buffer, offset: u64, bytes: u64, ty: IndexType) {
        self.indices = Some(bytes / ty.bytes());
        let ty = ty.vulkan();
        // SAFETY: the command buffer is being recorded, and the buffer was made for indices.
        unsafe { self.canvas.gpu.raw.cmd_bind_index_buffer(self.canvas.commands, buffer, offset, ty) };
    }

    /// Sets push constants from byte `offset` on, for the draws of this pass from now on: as the draw interface tells them. Both are multiples
    /// of 4. Where no stage of the pass reads any they are left out.
    pub fn push_constants(&mut self, offset: u32, bytes: &[u8]) {
        let most = self.pass.pushed_bytes;
        let whole = offset.is_multiple_of(4) && bytes.len().is_multiple_of(4);
        let end = u64::from(offset) + bytes.len() as u64;
        if most == 0 || bytes.is_empty() {
            return;
        }
        if !whole || end > u64::from(most) {
            let length = bytes.len();
            return self.misused(|| {
                format!("{length} bytes of push constants from byte {offset} on: there are {most}, set by four")
            });
        }
        let words = (offset / 4) as usize..(offset / 4) as usize + bytes.len() / 4;
        let pushed = &mut self.sets.held.pushed;
        pushed.resize((most / 4) as usize, false);
        pushed[words].fill(true);
        let layout = self.pass.supplied.layout;
        // SAFETY: the command buffer is being recorded, and the bytes lie within the range that the layout has for these stages.
        unsafe { self.canvas.gpu.raw.cmd_push_constants(self.canvas.commands, layout, PARTS_STAGES, offset, bytes) };
    }

    /// Says which faces are left out from now on.
    pub fn set_cull_mode(&mut self, mode: CullMode) {
        self.canvas.set_cull_mode(mode);
    }

    /// Says which side is the front from now on, after the projection, which flips y.
    pub fn set_front_face(&mut self, face: FrontFace) {
        self.canvas.set_front_face(face);
    }

    /// How the pass draws for both eyes at once. Each draw of the recorder's own then draws for both eyes. Code that draws
    /// by [`Recorder::raw`] must do so itself: [`Recorder::eye_targets`] says where. `None`: the pass draws for one eye, or into images that both eyes share.
    /// Width, height, viewport and scissor are those of one eye's picture.
    #[must_use]
    pub fn both_eyes(&self) -> Option<(Stereo, EyeForm)> {
        self.canvas.target.eyes
    }

    /// Where each eye's picture lies in what the pass draws into, the left one's first, for pipelines of the program's own; `None` where
    /// [`Recorder::both_eyes`] is.
    #[must_use]
    pub fn eye_targets(&self) -> Option<[EyeTarget; 2]> {
        EyeTarget::of_both(self.canvas.target)
    }

    /// Says to which rectangle of the upright picture clip space is stretched from now on: its left and upper edge, then its
    /// width and height, in texels. At first it is all of the picture. Where instances draw into both eyes' halves it must be all
    /// of it.
    pub fn set_viewport(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        let rectangle = [x, y, width, height];
        if !rectangle.into_iter().all(f64::is_finite) || width <= 0.0 || height <= 0.0 {
            return self.misused(|| format!("a viewport of {width}×{height} at {x}, {y}"));
        }
        let set = self.canvas.set_viewport(rectangle);
        self.note(set);
    }

    /// Says in which rectangle of the upright picture texels may change from now on: its left and upper edge, then its width
    /// and height, in texels. What lies outside the picture is left out. At first it is all of the picture. Where instances draw
    /// into both eyes' halves it must be all of it.
    pub fn set_scissor(&mut self, corner: [u32; 2], size: [u32; 2]) {
        let upright = self.extent();
        let begin = [0, 1].map(|axis| corner[axis].min(upright[axis]));
        let end = [0, 1].map(|axis| corner[axis].saturating_add(size[axis]).min(upright[axis]));
        let set = self.canvas.set_scissor([begin[0], begin[1], end[0] - begin[0], end[1] - begin[1]].map(f64::from));
        self.note(set);
    }

    /// Draws consecutive vertices. `instances` begins at what shaders see as the first `gl_InstanceIndex`.
    pub fn draw(&mut self, vertices: Range<u32>, instances: Range<u32>) {
        if self.may_draw(Some(&vertices), &instances) {
            let count = vertices.end.saturating_sub(vertices.start);
            let drawn = self.canvas.for_eyes(instances, |device, commands, first, instances| {
                // SAFETY: everything that the pipeline reads is bound and large enough.
                unsafe { device.cmd_draw(commands, count, instances, vertices.start, first) };
            });
            self.note(drawn);
        }
    }

    /// Draws indexed vertices; `base_vertex` is added to each index.
    pub fn draw_indexed(&mut self, indices: Range<u32>, base_vertex: i32, instances: Range<u32>) {
        if self.indices.is_none_or(|held| held < u64::from(indices.end)) {
            return self.misused_indices(&indices);
        }
        if self.may_draw(None, &instances) {
            let count = indices.end.saturating_sub(indices.start);
            let drawn = self.canvas.for_eyes(instances, |device, commands, first, instances| {
                // SAFETY: everything that the pipeline reads is bound, the indices exist, and with robustBufferAccess an
                // index beyond the vertices reads no foreign memory, or the program has vouched for its files (`BufferBounds`, `adopt`).
                unsafe { device.cmd_draw_indexed(commands, count, instances, indices.start, base_vertex, first) };
            });
            self.note(drawn);
        }
    }

    #[cold]
    fn misused_indices(&mut self, indices: &Range<u32>) {
        let held = self.indices;
        self.misused(|| match held {
            None => "an indexed draw without index buffer".to_owned(),
            Some(held) => format!("indices {} lie beyond the index buffer, which holds {held}", numbers(indices)),
        });
    }

    /// Whether the buffer may be bound so; if it may, it is kept.
    fn may_bind(&mut self, buffer: &Buffer, usage: vk::BufferUsageFlags) -> bool {
        let may = buffer.0.usage.contains(usage) && buffer.0.is_of(self.canvas.gpu);
        if may {
            self.sets.held.buffers.hold(&buffer.0);
        }
        may
    }

    /// Whether everything that the pipeline reads is bound, and long enough for a draw of these vertices (`None`: indices choose them) and
    /// instances. What is bound once is bound for the rest of the pass.
    fn may_draw(&mut self, vertices: Option<&Range<u32>>, instances: &Range<u32>) -> bool {
        if !self.ready {
            self.look_for_missing();
            self.ready = self.misuse.is_none();
        }
        // The device keeps vertices that indices choose within their buffers.
        let may_lie_beyond = vertices.is_some() || self.pass.reads_by_instance;
        if self.ready
            && may_lie_beyond
            && let Some(misuse) = self.beyond(vertices, instances)
        {
            self.misused(|| misuse);
        }
        self.ready
    }

    /// What a draw would read beyond its vertex buffers, in words.
    fn beyond(&self, vertices: Option<&Range<u32>>, instances: &Range<u32>) -> Option<String> {
        if instances.is_empty() {
            return None;
        }
        self.pass.vertex_buffers.iter().find_map(|VertexBinding { binding, stride, rate }| {
            let (elements, what, range) = match (rate, vertices) {
                (VertexRate::Vertex, None) => return None,
                (VertexRate::Vertex, Some(vertices)) => (vertices.end, "vertices", vertices),
                (VertexRate::Instance { divisor }, _) if *divisor > 1 && instances.start > 0 => {
                    return Some(format!(
                        "instances {} of which several share an element of vertex buffer {binding}: those begin at 0",
                        numbers(instances)
                    ));
                }
                (VertexRate::Instance { divisor }, _) => (instances.end.div_ceil(*divisor), "instances", instances),
            };
            let reach = u64::from(elements) * u64::from(*stride);
            let held = self.bound_bytes(*binding)?;
            (!range.is_empty() && held < reach).then(|| match binding {
                0 => format!("{what} {} lie beyond the vertex buffer", numbers(range)),
                _ => format!("{what} {} lie beyond vertex buffer {binding}", numbers(range)),
            })
        })
    }

    /// The bytes of a vertex buffer that is bound, from where it is read on.
    fn bound_bytes(&self, number: u32) -> Option<u64> {
        self.sets.held.vertices.iter().find(|(known, _)| *known == number).map(|(_, bytes)| *bytes)
    }

    /// A draw is misuse as long as something is missing.
    fn look_for_missing(&mut self) {
        if let Some(missing) = self.sets.missing() {
            self.misused(|| format!("a draw without {missing}"));
        }
        if self.plan.draw.is_some_and(Draw::has_own_vertices) {
            self.misused(|| "a draw beside that of the pass's own vertices, which follows by itself".to_owned());
        }
        if !self.has_pipeline {
            let shader = &self.plan.shader;
            self.misused(|| format!("a draw without pipeline: there is no shader `{shader}`"));
        }
        let unbound = self.pass.vertex_buffers.iter().find(|buffer| self.bound_bytes(buffer.binding).is_none());
        let is_set = |word: u32| self.sets.held.pushed.get(word as usize).is_some_and(|set| *set);
        let unset = self.pass.pushed.iter().find(|it| !(it.offset / 4..it.end.div_ceil(4)).all(is_set));
        if let Some(name) = unset.map(|block| block.name.clone()) {
            self.misused(|| format!("a draw without all push constants of `{name}`"));
        }
        match unbound.map(|buffer| buffer.binding) {
            None => {}
            Some(0) => self.misused(|| "a draw without vertex buffer".to_owned()),
            Some(number) => self.misused(|| format!("a draw without vertex buffer {number}")),
        }
    }

    fn misused(&mut self, what: impl FnOnce() -> String) {
        self.ready = false;
        self.misuse.get_or_insert_with(what);
    }

    /// Keeps what was misused, if anything was.
    fn note(&mut self, result: Result<(), String>) {
        if let Err(what) = result {
            self.misused(|| what);
        }
    }

    /// What to draw the pass's own vertices on, with all bound that their shader reads of the draw source; else the first misuse.
    pub(super) fn bound(self) -> Result<Canvas<'f>, String> {
        let missing = self.sets.missing().map(|missing| format!("a draw without {missing}"));
        self.misuse.or(missing).map_or(Ok(self.canvas), Err)
    }

    /// The images and buffers of the Plan that were asked for, and that the pass doesn't name.
    pub(super) fn asked(&self) -> Vec<String> {
        self.asked.of(self.frame.plan, self.plan)
    }

    /// How many objects were left out, or the first misuse if there was any.
    pub(crate) fn finish(self) -> Result<u32, String> {
        self.misuse.map_or(Ok(self.culled), Err)
    }
}
