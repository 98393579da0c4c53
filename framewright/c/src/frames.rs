//! Frames: planned, drawn, submitted among the program's own work, or recorded into its command buffers.

use crate::arguments::{Structure, list, optional_output, reference, structure, text};
use crate::callback::Callback;
use crate::draws::{ProgramDraws, draw_of};
use crate::renderer::{FramewrightChange, FramewrightRenderer, State, with};
use crate::status::{FramewrightStatus, Problem};
use framewright::vulkan::ash::vk;
use framewright::vulkan::{Error, Executor};
use framewright::{
    Change, CustomRecorder, DispatchRecorder, Draw, DrawKind, DrawSource, Recorder, SceneDrawSource, SecondaryRecorder,
    SemaphorePoint, Submission,
};
use std::collections::BTreeSet;
use std::ffi::c_char;
use std::ptr;
use std::sync::Arc;

/// An image or buffer of the program's that a frame uses.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightChoice {
    /// The name of the external image or buffer.
    pub name: *const c_char,
    /// The number of the one to use among those that were imported, from 0.
    pub image: usize,
}

/// A semaphore that a frame waits for or signals.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightSemaphore {
    /// The semaphore.
    pub semaphore: vk::Semaphore,
    /// The value of a timeline semaphore; it doesn't matter for a binary one.
    pub value: u64,
    /// The stages that wait, or that are waited for; 0: all.
    pub stages: vk::PipelineStageFlags2,
}

/// How a frame is submitted among the program's own work. 0 in a field is its default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightSubmission {
    /// sizeof(FramewrightSubmission).
    pub struct_size: usize,
    /// Images and buffers of the program's, for external ones of which several were imported. An image that isn't listed is that of the
    /// frame before; a buffer is the one whose turn it is.
    pub images: *const FramewrightChoice,
    /// How many.
    pub image_count: usize,
    /// What the frame waits for before it begins.
    pub waits: *const FramewrightSemaphore,
    /// How many.
    pub wait_count: usize,
    /// What it signals at its end.
    pub signals: *const FramewrightSemaphore,
    /// How many.
    pub signal_count: usize,
}

// SAFETY: it begins with its size, and has integers and pointers alone.
unsafe impl Structure for FramewrightSubmission {
    const NAME: &'static str = "FramewrightSubmission";
    const DEFAULT: Self = FramewrightSubmission {
        struct_size: 0,
        images: ptr::null(),
        image_count: 0,
        waits: ptr::null(),
        wait_count: 0,
        signals: ptr::null(),
        signal_count: 0,
    };
}

/// Draws the scene, and has the program record custom passes and what is its own to draw.
struct Source<'s> {
    scene: Option<&'s mut SceneDrawSource>,
    callback: Option<Callback>,
    draws: &'s ProgramDraws,
    secondary: &'s BTreeSet<String>,
}

/// Who records a pass.
enum RecordedBy<'s> {
    Program(Callback),
    Scene(&'s mut SceneDrawSource),
}

impl Source<'_> {
    /// Who records draws of this kind in `pass`: the program what is its own, and all that a recorder can draw if there is no scene.
    fn of(&mut self, kind: DrawKind, pass: &str, shader: &str) -> Result<RecordedBy<'_>, Error> {
        let own = self.draws.is_own(kind);
        match (&mut self.scene, self.callback) {
            (_, Some(callback)) if own => Ok(RecordedBy::Program(callback)),
            (_, None) if own => Err(no_recorder(pass, shader)),
            (Some(scene), _) => Ok(RecordedBy::Scene(scene)),
            (None, Some(callback)) if has_objects(kind) => Ok(RecordedBy::Program(callback)),
            (None, _) => Err(no_scene(pass)),
        }
    }
}

impl DrawSource for Source<'_> {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let kind = DrawKind::of(draw);
        match self.of(kind, recorder.pass(), recorder.shader())? {
            RecordedBy::Program(callback) => callback.inside(draw_of(kind), recorder),
            RecordedBy::Scene(scene) => scene.record(draw, recorder),
        }
    }

    fn dispatch(&mut self, recorder: &mut DispatchRecorder<'_>) -> Result<(), Error> {
        match self.of(DrawKind::Compute, recorder.pass(), recorder.shader())? {
            RecordedBy::Program(callback) => callback.compute(recorder),
            RecordedBy::Scene(scene) => scene.dispatch(recorder),
        }
    }

    fn has_secondary(&mut self, custom: &str) -> bool {
        self.callback.is_some() && self.secondary.contains(custom)
    }

    fn secondary(&mut self, custom: &str, recorder: &mut SecondaryRecorder<'_>) -> Result<u32, Error> {
        match &self.callback {
            Some(callback) => callback.secondary(custom, recorder),
            None => Err(no_recorder(recorder.pass(), custom)),
        }
    }

    fn custom(&mut self, custom: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        match &self.callback {
            Some(callback) => callback.outside(custom, recorder),
            None => Err(no_recorder(recorder.pass(), custom)),
        }
    }
}

/// Whether a recorder of the program's draws this where there is no scene. Of other kinds a scene brings along what their shaders see.
fn has_objects(kind: DrawKind) -> bool {
    match kind {
        DrawKind::Objects(_) | DrawKind::Casters(_) | DrawKind::Sky | DrawKind::Custom => true,
        DrawKind::FullScreen | DrawKind::Vertices | DrawKind::Compute => false,
    }
}

fn no_recorder(pass: &str, custom: &str) -> Error {
    Error::DrawSource { what: format!("pass `{pass}` asks for `{custom}`, and no recorder was set") }
}

fn no_scene(pass: &str) -> Error {
    Error::DrawSource { what: format!("pass `{pass}` draws a scene, and none was set") }
}

impl State {
    /// Plans the next frame, has the scene follow the Plan, and keeps what changed until the program asks.
    pub(crate) fn prepare(&mut self) -> Result<(), Problem> {
        let State { renderer, scene, planned_scene, objects, unreported, .. } = self;
        let device = renderer.device().clone();
        let prepared = renderer.prepare().map(|prepared| match prepared.change {
            Change::Nothing => FramewrightChange::Nothing,
            Change::Values => FramewrightChange::Values,
            _ => FramewrightChange::Plan,
        });
        if prepared.is_err() && renderer.plan().is_some() {
            // The renderer went back to the choices of that Plan, and so to the facts of its scene.
            scene.clone_from(planned_scene);
        }
        let change = prepared?;
        if scene.as_ref().map(Arc::as_ptr) != planned_scene.as_ref().map(Arc::as_ptr) {
            *objects = None;
            planned_scene.clone_from(scene);
        }
        let plan = renderer.prepare()?.plan;
        *unreported = change.max(*unreported);
        let kept = match (objects.take(), change) {
            (_, FramewrightChange::Plan) | (None, _) => None,
            (Some(objects), FramewrightChange::Nothing) => Some(objects),
            (Some(mut objects), FramewrightChange::Values) => {
                objects.change(plan)?;
                Some(objects)
            }
        };
        *objects = match (kept, scene) {
            (None, Some(scene)) => Some(SceneDrawSource::for_plan(&device, scene, plan.extent, plan)?),
            (kept, _) => kept,
        };
        Ok(())
    }

    /// The executor of the next frame, which the scene follows.
    pub(crate) fn executor(&mut self) -> Result<&mut Executor, Problem> {
        self.prepare()?;
        Ok(self.renderer.executor_mut()?)
    }

    /// Notes that the Plan is another one.
    pub(crate) fn planned_anew(&mut self) {
        self.objects = None;
        self.planned_scene.clone_from(&self.scene);
        self.unreported = FramewrightChange::Plan;
    }

    /// Has the executor draw the scene, and returns the frame's number.
    fn draw(
        &mut self,
        draw: impl FnOnce(&mut Executor, &mut dyn DrawSource) -> Result<u64, Error>,
    ) -> Result<u64, Problem> {
        self.prepare()?;
        let State { renderer, objects, callback, draws, secondary, .. } = self;
        let mut source = Source { scene: objects.as_mut(), callback: *callback, draws, secondary };
        Ok(draw(renderer.executor_mut()?, &mut source)?)
    }
}

/// # Safety
/// The pointer is NULL, or `count` choices stand there.
unsafe fn choices<'a>(choices: *const FramewrightChoice, count: usize) -> Result<Vec<(&'a str, usize)>, Problem> {
    // SAFETY: the caller's word.
    unsafe { list(choices, count, "images")?.iter().map(|it| Ok((text(it.name, "name")?, it.image))).collect() }
}

/// # Safety
/// The pointer is NULL, or `count` semaphores stand there.
unsafe fn points(
    semaphores: *const FramewrightSemaphore,
    count: usize,
    what: &str,
) -> Result<Vec<SemaphorePoint>, Problem> {
    let point = |it: &FramewrightSemaphore| {
        if it.semaphore == vk::Semaphore::null() {
            return Err(Problem::Misuse(format!("a semaphore of `{what}` is NULL")));
        }
        let all = SemaphorePoint::timeline(it.semaphore, it.value);
        Ok(if it.stages.is_empty() { all } else { SemaphorePoint { stages: it.stages, ..all } })
    };
    // SAFETY: the caller's word.
    unsafe { list(semaphores, count, what)? }.iter().map(point).collect()
}

/// Plans the next frame if anything changed; every frame begins with it. `change` is told the most that changed since the last call of this
/// function, by whatever call, unless it is NULL.
/// After an error the last good Plan stays, with the choices and the scene that it was made for.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_prepare(
    renderer: *mut FramewrightRenderer,
    change: *mut FramewrightChange,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            state.prepare()?;
            optional_output(change, std::mem::replace(&mut state.unreported, FramewrightChange::Nothing));
            Ok(())
        })
    }
}

/// Says that what passes with `run: WhenDirty("name")` write is out of date: they run in the next frame. A name that no pass of the Plan
/// waits for is `FRAMEWRIGHT_STATUS_MISUSE`. Where anything changed, it is planned first.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_dirty(
    renderer: *mut FramewrightRenderer,
    name: *const c_char,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let name = text(name, "name")?;
            state.prepare()?;
            Ok(state.renderer.set_dirty(name)?)
        })
    }
}

/// Has all passes run in the next frame, as in the first one, also those that run once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_run_all(renderer: *mut FramewrightRenderer) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            state.renderer.run_all();
            Ok(())
        })
    }
}

/// Gives the next frame a number, by which passes go that run every few frames. Frames are counted on from there; without this call they are
/// counted from 0. Where anything changed, it is planned first.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_frame_number(
    renderer: *mut FramewrightRenderer,
    number: u64,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            state.prepare()?;
            Ok(state.renderer.set_frame_number(number)?)
        })
    }
}

/// Sets the time of frames from the next one on, in seconds: `time` in parameters of passes. Without this call it is a sixtieth of the frame's
/// number. Where anything changed, it is planned first.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_time(
    renderer: *mut FramewrightRenderer,
    seconds: f64,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            state.prepare()?;
            Ok(state.renderer.set_time(seconds)?)
        })
    }
}

/// Draws a frame and waits until the device is done. `frame` is told its number, from 0, unless it is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_frame(
    renderer: *mut FramewrightRenderer,
    frame: *mut u64,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            optional_output(frame, state.draw(|executor, source| executor.frame(source))?);
            Ok(())
        })
    }
}

/// Records and submits a frame, which waits for semaphores of the program's and signals others. `among` may be NULL. If as many frames as
/// may be are on their way, the oldest is waited for first. Semaphores live until the frame was waited for; after an error nothing was
/// waited for and nothing is signalled, unless the device is lost. `frame` is told its number, unless it is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_submit(
    renderer: *mut FramewrightRenderer,
    among: *const FramewrightSubmission,
    frame: *mut u64,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let among = structure(among, "among")?;
            let images = choices(among.images, among.image_count)?;
            let waits = points(among.waits, among.wait_count, "waits")?;
            let signals = points(among.signals, among.signal_count, "signals")?;
            let among = Submission { images: &images, waits: &waits, signals: &signals };
            optional_output(frame, state.draw(|executor, source| executor.submit_with(source, &among))?);
            Ok(())
        })
    }
}

/// Waits until the device is done with a frame. A frame of an earlier Plan counts as done.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_wait(
    renderer: *mut FramewrightRenderer,
    frame: u64,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe { with(renderer, |state| Ok(state.renderer.wait(frame)?)) }
}

/// Records a frame into a command buffer of the program's, which the program submits. The command buffer is primary, of the family of the
/// device's queue for graphics, recording, and outside of a rendering scope. It is submitted once, to that queue, after the frames
/// before and before later ones, and has the timeline semaphore `done` signalled with a value then; or it is given to `framewright_renderer_discard`. It and
/// the semaphore live until the frame was waited for. Until the frame is submitted or discarded, nothing is set for the renderer, and no
/// function is called that waits or plans.
///
/// The commands find and leave images of the program's in the states that `framewright_renderer_states` tells, and change all state of the
/// command buffer. `images` are as in FramewrightSubmission. `frame` is told the frame's number, unless it is NULL. After an error the
/// command buffer must not be submitted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_record_into(
    renderer: *mut FramewrightRenderer,
    commands: vk::CommandBuffer,
    done: *const FramewrightSemaphore,
    images: *const FramewrightChoice,
    image_count: usize,
    frame: *mut u64,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            reference(done, "done")?;
            let done = points(done, 1, "done")?[0];
            if commands == vk::CommandBuffer::null() {
                return Err(Problem::Misuse("`commands` is NULL".to_owned()));
            }
            let images = choices(images, image_count)?;
            let drawn = state.draw(|executor, source| executor.record_into(commands, done, &images, source))?;
            optional_output(frame, drawn);
            Ok(())
        })
    }
}

/// Takes back a frame that was recorded into a command buffer, which was not and will not be submitted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_discard(
    renderer: *mut FramewrightRenderer,
    frame: u64,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            // A frame of an earlier executor went with it.
            if let Some(executor) = state.renderer.current_executor_mut() {
                executor.discard(frame);
            }
            Ok(())
        })
    }
}
