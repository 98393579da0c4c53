//! Renderers: a pipeline, and what was chosen for it.

use crate::adopt::FramewrightFeatures;
use crate::arguments::{
    FramewrightNames, Structure, free, from_0, handle, list, one_of, optional_text, output, reference, structure, text,
};
use crate::callback::Callback;
use crate::device::FramewrightDevice;
use crate::draws::ProgramDraws;
use crate::last_error::{self, call};
use crate::options::FramewrightRendererOptions;
use crate::scene::FramewrightScene;
use crate::status::{FramewrightStatus, Problem};
use framewright::graph::vulkan::Format;
use framewright::vulkan::ash::vk;
use framewright::{
    Facts, RawSet, Renderer, RendererOptions, Rotation, Scene, SceneDrawSource, ScopeFormats, Stereo, Texels,
};
use std::collections::BTreeSet;
use std::ffi::{CString, c_char, c_void};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

/// What became another one when a frame was prepared.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FramewrightChange {
    /// Nothing: nothing was planned.
    Nothing = 0,
    /// At most numbers in the Plan.
    Values = 1,
    /// The Plan: images that the program imported are to be imported again.
    Plan = 2,
}

/// A pipeline that is drawn frame after frame. One thread at a time uses it; it need not be the same one.
pub struct FramewrightRenderer(pub(crate) Mutex<State>);

/// What a renderer holds.
pub(crate) struct State {
    pub(crate) renderer: Renderer,
    pub(crate) scene: Option<Arc<Scene>>,
    /// The scene whose facts the Plan was made for.
    pub(crate) planned_scene: Option<Arc<Scene>>,
    /// The scene on the device, for the Plan that there is.
    pub(crate) objects: Option<SceneDrawSource>,
    /// What records custom passes.
    pub(crate) callback: Option<Callback>,
    /// The custom passes inside scopes whose draws come in secondary command buffers.
    pub(crate) secondary: BTreeSet<String>,
    /// What the program draws itself.
    pub(crate) draws: ProgramDraws,
    /// The most that changed since the program asked.
    pub(crate) unreported: FramewrightChange,
    /// What was read last.
    pub(crate) texels: Option<Texels>,
    /// The formats that were told, each once. The program has pointers to their lists.
    pub(crate) formats: Vec<ScopeFormats>,
    /// The text of an interface file, once it was told.
    pub(crate) interface: Option<CString>,
}

impl State {
    /// That of a renderer that has drawn nothing.
    pub(crate) fn of(renderer: Renderer, draws: ProgramDraws) -> State {
        State {
            renderer,
            scene: None,
            planned_scene: None,
            objects: None,
            callback: None,
            secondary: BTreeSet::new(),
            draws,
            unreported: FramewrightChange::Nothing,
            texels: None,
            formats: Vec::new(),
            interface: None,
        }
    }
}

/// What conditions of a pipeline ask for, for a program that knows its scene. 0 is false.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightFacts {
    /// sizeof(FramewrightFacts).
    pub struct_size: usize,
    /// Anything is drawn that hides all behind it.
    pub has_opaque: u32,
    /// Anything with holes that its alpha cuts is drawn.
    pub has_alpha_clip: u32,
    /// Anything transparent is drawn.
    pub has_transparent: u32,
    /// Anything fades by leaving out fragments.
    pub has_cross_fade: u32,
    /// Any light casts shadows, and there is something to cast them.
    pub casts_shadows: u32,
    /// How many cascades the sun's shadows need.
    pub shadow_cascades: u32,
    /// How many suns shine.
    pub suns: u32,
    /// How many point lights shine.
    pub point_lights: u32,
    /// How many objects there are.
    pub objects: u32,
    /// How many triangles all objects have.
    pub triangles: u64,
    /// The most radiance that a pixel can show before any effect, linear; finite.
    pub peak_radiance: f64,
    /// The farthest distance divided by the nearest one, which formats of depth follow; 0: not known.
    pub depth_range: f64,
    /// A length that is typical of the scene, metres; 0: 1.
    pub size: f64,
}

// SAFETY: it begins with its size, and has numbers alone.
unsafe impl Structure for FramewrightFacts {
    const NAME: &'static str = "FramewrightFacts";
    const DEFAULT: Self = FramewrightFacts {
        struct_size: 0,
        has_opaque: 0,
        has_alpha_clip: 0,
        has_transparent: 0,
        has_cross_fade: 0,
        casts_shadows: 0,
        shadow_cascades: 0,
        suns: 0,
        point_lights: 0,
        objects: 0,
        triangles: 0,
        peak_radiance: 0.0,
        depth_range: 0.0,
        size: 0.0,
    };
}

/// How a frame is drawn for two eyes.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum FramewrightStereo {
    /// For one eye.
    Off = 0,
    /// Two images, one after the other.
    MultiPass = 1,
    /// Halves of one image of twice the width.
    DoubleWide = 2,
    /// Layers of one image, or halves where vertex shaders can't choose a layer; each draw has twice the instances.
    Instanced = 3,
    /// Layers of one image, into all of which the device draws.
    Multiview = 4,
}

/// By how much the screen is turned that shows a picture, clockwise.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum FramewrightRotation {
    /// Not at all.
    Identity = 0,
    /// A quarter.
    Rotate90 = 1,
    /// A half.
    Rotate180 = 2,
    /// Three quarters.
    Rotate270 = 3,
}

/// What a renderer holds, for one user at a time.
///
/// # Safety
/// The pointer is NULL or leads to a renderer, which lives for `'a`.
pub(crate) unsafe fn locked<'a>(renderer: *const FramewrightRenderer) -> Result<MutexGuard<'a, State>, Problem> {
    // SAFETY: the caller's word.
    let renderer: &'a FramewrightRenderer = unsafe { reference(renderer, "renderer")? };
    renderer.0.try_lock().map_err(|error| match error {
        TryLockError::WouldBlock => {
            Problem::Misuse("the renderer is in use: by another thread, or by the call that calls back".to_owned())
        }
        TryLockError::Poisoned(_) => {
            Problem::Panic("an earlier call did, and the renderer can only be freed".to_owned())
        }
    })
}

/// Has a renderer do something, as [`call`] does.
///
/// # Safety
/// The pointer is NULL or leads to a renderer.
pub(crate) unsafe fn with(
    renderer: *mut FramewrightRenderer,
    body: impl FnOnce(&mut State) -> Result<(), Problem>,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| body(&mut *unsafe { locked(renderer)? }))
}

/// Reads the pipeline in the file `pipeline`; where there is none, the shipped one of that name. Until it is told otherwise, the frame
/// has 1280×720 texels, and the scene may hold everything. `options` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_open(
    device: *const FramewrightDevice,
    pipeline: *const c_char,
    options: *const FramewrightRendererOptions,
    renderer: *mut *mut FramewrightRenderer,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        handle(renderer, "renderer", || {
            let device = reference(device, "device")?;
            let pipeline = text(pipeline, "pipeline")?;
            made(device, options, |options| Renderer::open(&device.device, pipeline, options))
        })
    })
}

/// Does the same with a pipeline that the program carries within itself, the text `pipeline`, which messages call `name`. The files and shaders that
/// it names are shipped ones, or of the folders in `FramewrightRendererOptions.shaders`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_open_carried(
    device: *const FramewrightDevice,
    name: *const c_char,
    pipeline: *const c_char,
    options: *const FramewrightRendererOptions,
    renderer: *mut *mut FramewrightRenderer,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        handle(renderer, "renderer", || {
            let device = reference(device, "device")?;
            let (name, pipeline) = (text(name, "name")?, text(pipeline, "pipeline")?);
            made(device, options, |options| Renderer::carried(&device.device, name, pipeline, options))
        })
    })
}

/// A renderer that is made with options.
///
/// # Safety
/// The pointer is NULL or leads to options whose fields are as they say.
unsafe fn made(
    device: &FramewrightDevice,
    options: *const FramewrightRendererOptions,
    make: impl FnOnce(RendererOptions) -> Result<Renderer, framewright::Error>,
) -> Result<FramewrightRenderer, Problem> {
    // SAFETY: the caller's word.
    let (options, draws) = unsafe { structure(options, "options")?.read(device)? };
    Ok(FramewrightRenderer(Mutex::new(State::of(make(options)?, draws))))
}

/// Frees a renderer. Frames on their way are waited for.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_free(renderer: *mut FramewrightRenderer) {
    // SAFETY: the caller's word.
    unsafe { free(renderer) };
}

/// Gives a setting a value, which is stronger than presets and settings files: a number, `true`, `false` or a name, as text. NULL takes
/// it back. A value that isn't allowed changes nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set(
    renderer: *mut FramewrightRenderer,
    setting: *const c_char,
    value: *const c_char,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let setting = text(setting, "setting")?;
            match optional_text(value, "value")? {
                Some(value) => state.renderer.set(setting, value)?,
                None => state.renderer.unset(setting),
            }
            Ok(())
        })
    }
}

/// Puts a preset in force, in place of the one before; NULL: that of the settings files, if they name one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_preset(
    renderer: *mut FramewrightRenderer,
    preset: *const c_char,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe { with(renderer, |state| Ok(state.renderer.preset(optional_text(preset, "preset")?)?)) }
}

/// Sets width and height of the output.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_extent(
    renderer: *mut FramewrightRenderer,
    width: u32,
    height: u32,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe { with(renderer, |state| Ok(state.renderer.set_extent([width, height])?)) }
}

/// Has images of these names leave the frame beside its outputs, so that they can be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_dump(
    renderer: *mut FramewrightRenderer,
    images: *const *const c_char,
    count: usize,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let images = FramewrightNames { names: images, count }.texts("images")?;
            Ok(state.renderer.set_dump(&images)?)
        })
    }
}

/// Shows a scene, and tells its facts. Where the options have `draws`, they have `scene_draws` too, or it is refused. NULL: no scene, and it may hold
/// everything; passes that draw objects or the sky are the recorder's then, and without a recorder an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_scene(
    renderer: *mut FramewrightRenderer,
    scene: *const FramewrightScene,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    let scene = unsafe { scene.as_ref() }.map(|scene| scene.scene.clone());
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            if scene.is_some() && !state.draws.scene {
                return Err(Problem::Misuse(
                    "the options have `draws`: set `scene_draws` for a scene to draw the kinds that aren't listed"
                        .to_owned(),
                ));
            }
            state.renderer.set_facts(scene.as_ref().map(|scene| scene.facts()));
            state.scene = scene;
            Ok(())
        })
    }
}

/// Tells the facts of a scene that the program draws itself; NULL: it may hold everything.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_facts(
    renderer: *mut FramewrightRenderer,
    facts: *const FramewrightFacts,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let given = structure(facts, "facts")?;
            let known = Facts {
                has_opaque: given.has_opaque != 0,
                has_alpha_clip: given.has_alpha_clip != 0,
                has_transparent: given.has_transparent != 0,
                has_cross_fade: given.has_cross_fade != 0,
                casts_shadows: given.casts_shadows != 0,
                shadow_cascades: given.shadow_cascades,
                suns: given.suns,
                point_lights: given.point_lights,
                objects: given.objects,
                triangles: given.triangles,
                peak_radiance: from_0(given.peak_radiance, "peak_radiance")?,
                depth_range: Some(from_0(given.depth_range, "depth_range")?).filter(|range| *range > 0.0),
                exposure: 1.0,
                size: Some(from_0(given.size, "size")?).filter(|size| *size > 0.0).unwrap_or(Facts::UNKNOWN.size),
            };
            state.renderer.set_facts((!facts.is_null()).then_some(known));
            Ok(())
        })
    }
}

/// Says how the frame is drawn for two eyes: a FramewrightStereo. `FRAMEWRIGHT_STATUS_MACHINE`: the device can't.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_stereo(
    renderer: *mut FramewrightRenderer,
    stereo: u32,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let stereo = *one_of(&Stereo::ALL, stereo, "stereo")?;
            Ok(state.renderer.set_stereo(stereo)?)
        })
    }
}

/// Says by how much the screen is turned that shows the picture: a FramewrightRotation. What is read back is upright.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_rotation(
    renderer: *mut FramewrightRenderer,
    rotation: u32,
) -> FramewrightStatus {
    const ALL: [Rotation; 4] = [Rotation::Identity, Rotation::Rotate90, Rotation::Rotate180, Rotation::Rotate270];
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            state.renderer.set_rotation(*one_of(&ALL, rotation, "rotation")?);
            Ok(())
        })
    }
}

/// Tells the format of the images that the program shows the first output in, as those of a swapchain of its own: what the pipeline calls
/// `format: Output`. `VK_FORMAT_UNDEFINED`: the format that the pipeline has without a window.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_output_format(
    renderer: *mut FramewrightRenderer,
    format: vk::Format,
) -> FramewrightStatus {
    let known = || Format::ALL.iter().find(|known| known.vulkan() == format.as_raw()).copied();
    let unknown = || Problem::Misuse(format!("there is no `format` of the number {}", format.as_raw()));
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let none = format == vk::Format::UNDEFINED;
            state.renderer.set_output_format(if none { None } else { Some(known().ok_or_else(unknown)?) });
            Ok(())
        })
    }
}

/// Is told a feature that a plan uses: Vulkan's name of it, of the property where none switches it on, or of the extension where it has no
/// feature; and the first that uses it, in words. Both live until it returns.
pub type FramewrightFeature =
    Option<unsafe extern "C" fn(context: *mut c_void, name: *const c_char, used_by: *const c_char)>;

/// Tells each feature of a device that the next frame uses, for `framewright_features_open`. It begins with a plan, as a frame does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_features(
    renderer: *mut FramewrightRenderer,
    tell: FramewrightFeature,
    context: *mut c_void,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let tell = tell.ok_or_else(|| Problem::Misuse("`tell` is NULL".to_owned()))?;
            for used in state.renderer.features()? {
                let (name, by) = (last_error::text(used.name), last_error::text(&used.by));
                tell(context, name.as_ptr(), by.as_ptr());
            }
            Ok(())
        })
    }
}

/// Tells with which features and extensions a program makes a device of the same physical device for the next frame: those that
/// `framewright_renderer_features` tells, and no others. Freed by `framewright_features_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_device_features(
    renderer: *mut FramewrightRenderer,
    features: *mut *mut FramewrightFeatures,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            handle(features, "features", || Ok(FramewrightFeatures::new(state.renderer.device_features()?)))
        })
    }
}

/// Whether a file that was read is another one by now: 1, else 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_files_changed(
    renderer: *mut FramewrightRenderer,
    changed: *mut u32,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe { with(renderer, |state| output(changed, "changed", state.renderer.files_changed().into())) }
}

/// Reads the pipeline, its shaders and pictures anew, and plans. Mistakes in the files leave all as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_reload(renderer: *mut FramewrightRenderer) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            state.renderer.reload()?;
            state.planned_anew();
            Ok(())
        })
    }
}

/// Binds a descriptor set of the program's for all passes whose shaders read the set of this number, from the next frame on, with its
/// dynamic offsets: `offset_count` of them, in the order of bindings. NULL in place of `descriptors` lets go of the one before. It must
/// have the layout that the renderer was told, and live until the last frame is done that it was bound in. What shaders read of it must be
/// there, in the state that it says: no Plan knows of it, and the program makes the barriers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_bind_set(
    renderer: *mut FramewrightRenderer,
    set: u32,
    descriptors: vk::DescriptorSet,
    offsets: *const u32,
    offset_count: usize,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let offsets = list(offsets, offset_count, "offsets")?;
            if descriptors == vk::DescriptorSet::null() {
                state.renderer.unbind_set(set);
            } else {
                state.renderer.bind_set(set, RawSet::new(descriptors), offsets);
            }
            Ok(())
        })
    }
}
