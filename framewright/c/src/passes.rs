//! Passes that the program records.

use crate::arguments::{output, reference, text};
use crate::last_error::call;
use crate::status::{FramewrightStatus, Problem};
use framewright::graph::frame::{Eye, EyeForm, ParamValue, Stereo};
use framewright::vulkan::ash::vk;
use framewright::{BindGroup, CustomImage, EyeTarget, RawSet, Recorder, ScopeFormats};
use std::ffi::{c_char, c_void};
use std::ptr;

/// What a pass draws that the program records.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum FramewrightDraw {
    /// What the program knows by the name behind `custom`; also what it records outside of rendering scopes.
    Custom = 0,
    /// Opaque objects.
    Opaque = 1,
    /// Objects with holes.
    Masked = 2,
    /// Objects that let light through.
    Transparent = 3,
    /// Opaque objects as the sun sees them.
    OpaqueCasters = 4,
    /// Objects with holes as the sun sees them.
    MaskedCasters = 5,
    /// The sky.
    Sky = 6,
    /// A full-screen pass whose shader reads what the program's draws bring along: three vertices and no buffer of them.
    FullScreen = 7,
    /// A pass's own vertices, whose shader reads what the program's draws bring along: the program only binds, and the draw follows by itself.
    Vertices = 8,
    /// A compute pass whose shader reads the same: the program only binds, `commands` is NULL, and the dispatch follows by itself.
    Compute = 9,
}

/// How one image holds both eyes' parts, the left one's first.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum FramewrightEyeForm {
    /// It doesn't: it is one picture.
    None = 0,
    /// In two layers.
    Layers = 1,
    /// Side by side.
    Halves = 2,
}

/// An eye.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum FramewrightEye {
    /// None of two: there is one, or both are meant.
    None = 0,
    /// The left one.
    Left = 1,
    /// The right one.
    Right = 2,
}

/// Where the picture of an eye lies in what a pass draws into.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightEyeTarget {
    /// The viewport of all of it.
    pub viewport: vk::Viewport,
    /// The scissor of the same: what lies outside is the other eye's.
    pub scissor: vk::Rect2D,
    /// The layer of the attachments. With a view mask the device chooses it, and `gl_ViewIndex` is its number; without one, a vertex shader
    /// does so (`gl_Layer`).
    pub layer: u32,
}

/// What pipelines of the program's own must fit to be bound in a pass within a rendering scope.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightFormats {
    /// Formats of the colour attachments.
    pub color: *const vk::Format,
    /// How many there are.
    pub color_count: u32,
    /// The format of the depth attachment; `VK_FORMAT_UNDEFINED` if there is none.
    pub depth: vk::Format,
    /// The format of the stencil attachment; `VK_FORMAT_UNDEFINED` if there is none.
    pub stencil: vk::Format,
    /// Samples of each attachment: a `VkSampleCountFlagBits`.
    pub samples: vk::SampleCountFlags,
    /// Views that are drawn at once, a bit for each; 0 where there are none.
    pub view_mask: u32,
    /// For each colour attachment the location at which the pass writes it (`VkRenderingAttachmentLocationInfoKHR`); NULL: its own number.
    pub locations: *const u32,
    /// For each colour attachment the number of its input attachment (`VkRenderingInputAttachmentIndexInfoKHR`); NULL: its own number.
    pub inputs: *const u32,
}

impl FramewrightFormats {
    /// Those that live as long as `formats`.
    pub(crate) fn of(formats: &ScopeFormats) -> FramewrightFormats {
        let local = formats.local.as_ref();
        FramewrightFormats {
            color: formats.color.as_ptr(),
            color_count: u32::try_from(formats.color.len()).unwrap_or(u32::MAX),
            depth: formats.depth,
            stencil: formats.stencil,
            samples: formats.samples,
            view_mask: formats.view_mask,
            locations: local.map_or(ptr::null(), |local| local.locations.as_ptr()),
            inputs: local.map_or(ptr::null(), |local| local.inputs.as_ptr()),
        }
    }
}

/// A pass that is to be recorded. It lives until its callback returns.
#[repr(C)]
pub struct FramewrightPass<'p> {
    /// The name of the pass.
    pub name: *const c_char,
    /// What the pipeline calls its work: the name behind `custom`. Of other draws, the name of their shader.
    pub custom: *const c_char,
    /// Where it is recorded. Its barriers are there already. NULL for a compute pass.
    pub commands: vk::CommandBuffer,
    /// Whether it stands inside a rendering scope with the pass's targets, which is left open; else it stands outside of one.
    pub in_scope: u32,
    /// Width of the targets; where the pass is for both eyes, of one eye's picture; 0 outside of a scope.
    pub width: u32,
    /// Height of the same; 0 outside of a scope.
    pub height: u32,
    /// The number of the frame, as `framewright_renderer_frame` returns it.
    pub frame: u64,
    /// Leads all functions of the name `framewright_pass_…` to the pass.
    pub resources: *const FramewrightResources<'p>,
    /// The queue family that the commands are for: that for graphics, or that for compute if the pipeline says `queue: Any`. For a compute pass, whose
    /// `commands` is NULL, it is `VK_QUEUE_FAMILY_IGNORED`.
    pub queue_family: u32,
    /// What it draws.
    pub draw: FramewrightDraw,
    /// The eye that it is recorded for, where it is recorded for each eye by itself.
    pub eye: FramewrightEye,
    /// The FramewrightStereo in which it is recorded for both eyes at once; `FRAMEWRIGHT_STEREO_OFF` if it isn't.
    pub both_eyes: u32,
    /// How images hold both eyes' parts, where it is recorded for both at once.
    pub eye_form: FramewrightEyeForm,
    /// Inside a scope for both eyes, where each eye's picture lies, the left one's first; else 0.
    pub eye_targets: [FramewrightEyeTarget; 2],
    /// Inside a scope, what pipelines of the program's must fit; NULL outside of one.
    pub formats: *const FramewrightFormats,
    /// For a pass of which `framewright_renderer_set_secondary` says that it has secondary command buffers, what they are begun with, beside
    /// `RENDER_PASS_CONTINUE`; `commands` then takes `vkCmdExecuteCommands` and nothing else. NULL for other passes.
    pub inheritance: *const vk::CommandBufferInheritanceRenderingInfo<'p>,
    /// The FramewrightRotation of the picture inside a scope: pipelines of the program's own turn what they draw.
    pub rotation: u32,
}

/// What a pass accesses.
pub struct FramewrightResources<'p>(pub(crate) &'p dyn PassResources);

/// What the program asks of a pass while it records it, on any of its threads.
pub(crate) trait PassResources: Sync {
    fn image(&self, name: &str) -> Option<CustomImage>;
    fn buffer(&self, name: &str) -> Option<vk::Buffer>;
    fn param(&self, name: &str) -> Option<ParamValue>;
    /// Whether images, buffers and parameters are told of; else they are the shader's alone.
    fn tells(&self) -> bool {
        true
    }
    /// Has the recorder of the pass record something; if it can't draw, says why.
    fn draws(&self, record: &mut dyn FnMut(&mut Recorder<'_>)) -> Result<(), &'static str>;
    /// Binds a group; if that can't be, says why.
    fn bind_group(&self, set: u32, group: &BindGroup) -> Result<(), &'static str> {
        self.draws(&mut |recorder| recorder.bind_group(set, group))
    }
    /// Binds a set of the program's; if that can't be, says why.
    fn bind_set(&self, number: u32, set: RawSet, offsets: &[u32]) -> Result<(), &'static str> {
        self.draws(&mut |recorder| recorder.bind_set(number, set, offsets))
    }
}

/// Records a pass: commands that touch what the pipeline says that the pass touches, and what is the program's own. Returns 0 if it
/// doesn't know the pass, which is an error of the frame. No function is called for the renderer meanwhile, and no
/// exception or longjmp leaves it.
pub type FramewrightRecord =
    Option<unsafe extern "C" fn(context: *mut c_void, pass: *const FramewrightPass<'_>) -> u32>;

/// An image that a pass accesses.
#[repr(C)]
pub struct FramewrightPassImage {
    /// Vulkan's image.
    pub image: vk::Image,
    /// The part that the pass may touch.
    pub range: vk::ImageSubresourceRange,
    /// Width in texels of its first mip level, as much as is in use.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Depth in texels: 1, but for a volume.
    pub depth: u32,
    /// The layout that it is in, and is left in.
    pub layout: vk::ImageLayout,
    /// How it holds both eyes' parts: in two layers, which are in `range`, or side by side, of which `width` and `height` are one's.
    pub eye_form: FramewrightEyeForm,
    /// The eye whose part alone is meant, of an image that holds both eyes'.
    pub eye: FramewrightEye,
}

pub(crate) const NO_EYES: [FramewrightEyeTarget; 2] = [FramewrightEyeTarget {
    viewport: vk::Viewport { x: 0.0, y: 0.0, width: 0.0, height: 0.0, min_depth: 0.0, max_depth: 0.0 },
    scissor: vk::Rect2D { offset: vk::Offset2D { x: 0, y: 0 }, extent: vk::Extent2D { width: 0, height: 0 } },
    layer: 0,
}; 2];

pub(crate) fn targets(eyes: Option<[EyeTarget; 2]>) -> [FramewrightEyeTarget; 2] {
    eyes.map_or(NO_EYES, |eyes| {
        eyes.map(|EyeTarget { viewport, scissor, layer, .. }| FramewrightEyeTarget { viewport, scissor, layer })
    })
}

pub(crate) fn eye(eye: Option<Eye>) -> FramewrightEye {
    match eye {
        None => FramewrightEye::None,
        Some(Eye::Left) => FramewrightEye::Left,
        Some(Eye::Right) => FramewrightEye::Right,
    }
}

fn form(form: Option<EyeForm>) -> FramewrightEyeForm {
    match form {
        None => FramewrightEyeForm::None,
        Some(EyeForm::Layers) => FramewrightEyeForm::Layers,
        Some(EyeForm::Halves) => FramewrightEyeForm::Halves,
    }
}

/// The number of a FramewrightStereo, and the form of images.
pub(crate) fn both(both: Option<(Stereo, EyeForm)>) -> (u32, FramewrightEyeForm) {
    let stereo = both.map_or(Stereo::Off, |(stereo, _)| stereo);
    (stereo as u32, form(both.map(|(_, form)| form)))
}

/// # Safety
/// The pointer is NULL or leads to a pass whose callback hasn't returned.
pub(crate) unsafe fn resources<'p>(pass: *const FramewrightPass<'p>) -> Result<&'p dyn PassResources, Problem> {
    // SAFETY: the caller's word.
    let resources = unsafe { reference(reference(pass, "pass")?.resources, "pass->resources")? };
    Ok(resources.0)
}

/// Why a pass tells nothing of what is called `name`: it lacks that, or it never tells.
fn untold(pass: &dyn PassResources, lacks: &str, name: &str) -> Problem {
    Problem::Misuse(if pass.tells() {
        format!("the pass {lacks} `{name}`")
    } else {
        format!("`{name}` isn't told: images, buffers and parameters of a compute pass are its shader's")
    })
}

/// Tells an image that a pass accesses, by the pipeline's name. Any thread may ask until the callback of the pass returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_image(
    pass: *const FramewrightPass<'_>,
    name: *const c_char,
    image: *mut FramewrightPassImage,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        let name = text(name, "name")?;
        let pass = resources(pass)?;
        let found = pass.image(name).ok_or_else(|| untold(pass, "accesses no image", name))?;
        let [width, height, depth] = found.extent;
        let range = vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::from_raw(found.range.aspects.bits()),
            base_mip_level: found.range.base_mip,
            level_count: found.range.mips,
            base_array_layer: found.range.base_layer,
            layer_count: found.range.layers,
        };
        let (image_of, layout) = (found.raw, found.layout);
        let (eye_form, eye) = (form(found.eyes), eye(found.eye));
        let found = FramewrightPassImage { image: image_of, range, width, height, depth, layout, eye_form, eye };
        output(image, "image", found)
    })
}

/// Tells a buffer that a pass accesses, by the pipeline's name. Any thread may ask until the callback of the pass returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_buffer(
    pass: *const FramewrightPass<'_>,
    name: *const c_char,
    buffer: *mut vk::Buffer,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        let name = text(name, "name")?;
        let pass = resources(pass)?;
        output(buffer, "buffer", pass.buffer(name).ok_or_else(|| untold(pass, "accesses no buffer", name))?)
    })
}

/// Tells the numbers of a parameter that the pipeline gives the pass: the components of a vector, the columns of a matrix one behind the other, 0 or 1
/// for a truth value. `count` is how many `numbers` has room for, and is told how many there are; if there are more, it is `FRAMEWRIGHT_STATUS_MISUSE`.
/// Images, buffers and parameters of a compute pass are its shader's: nothing is told of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_param(
    pass: *const FramewrightPass<'_>,
    name: *const c_char,
    numbers: *mut f64,
    count: *mut usize,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        let name = text(name, "name")?;
        let pass = resources(pass)?;
        let found = pass.param(name).ok_or_else(|| untold(pass, "has no parameter", name))?;
        let mut all = Vec::new();
        flatten(&found, &mut all);
        let room = *reference(count, "count")?;
        output(count, "count", all.len())?;
        if all.len() > room {
            let what = format!("`{name}` has {} numbers, and there is room for {room}", all.len());
            return Err(Problem::Misuse(what));
        }
        (0..).zip(all).try_for_each(|(at, number)| output(numbers.wrapping_add(at), "numbers", number))
    })
}

/// The numbers of a value one behind the other.
fn flatten(value: &ParamValue, all: &mut Vec<f64>) {
    match value {
        ParamValue::Bool(truth) => all.push(f64::from(u8::from(*truth))),
        ParamValue::Integer(number) => all.push(*number as f64),
        ParamValue::Number(number) => all.push(*number),
        // The recorder tells those of the frame as numbers.
        ParamValue::OfFrame(_) => all.push(0.0),
        ParamValue::List(parts) => parts.iter().for_each(|part| flatten(part, all)),
    }
}
