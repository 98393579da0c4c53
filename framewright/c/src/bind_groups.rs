//! Bind groups: sets of a draw interface, filled with buffers and images of the program's.

use crate::arguments::{free, handle, list, reference};
use crate::device::FramewrightDevice;
use crate::draws::{FramewrightDrawInterface, interface};
use crate::last_error::call;
use crate::status::{FramewrightStatus, Problem};
use framewright::vulkan::ash::vk;
use framewright::{BindGroup, ProgramBuffer, ProgramView, Resource};

/// A set of a draw interface, filled. Any thread may use it, and several at once. It is freed whenever the program likes: frames on their way
/// keep what they need of it.
pub struct FramewrightBindGroup(pub(crate) BindGroup);

/// What is bound at a binding of a bind group: a buffer, or images.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightBinding {
    /// The number of the binding.
    pub binding: u32,
    /// For a uniform or storage block, its buffer; else NULL. `range` is a number of bytes, and not `VK_WHOLE_SIZE`.
    pub buffer: *const vk::DescriptorBufferInfo,
    /// For a sampled image, its view of the type 2D, its sampler and the layout that it is read in; for an array each of its elements; else NULL.
    pub images: *const vk::DescriptorImageInfo,
    /// How many images there are.
    pub image_count: usize,
}

/// Fills the set number `set` of the draw interface `brought` with `bindings`, each of its bindings once. `brought` is as one in
/// `FramewrightRendererOptions.draws`; kinds of draws that bring the same share bind groups.
///
/// Buffers, views and samplers are the program's, of this device, and made for what they are bound as. They live until the last frame is done
/// that was drawn with the group. No Plan knows of them: the program makes their barriers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_bind_group_open(
    device: *const FramewrightDevice,
    brought: *const FramewrightDrawInterface,
    set: u32,
    bindings: *const FramewrightBinding,
    binding_count: usize,
    group: *mut *mut FramewrightBindGroup,
) -> FramewrightStatus {
    let open = || {
        // SAFETY: the caller's word.
        let (device, interface, given) = unsafe {
            let device = reference(device, "device")?;
            let interface = interface(reference(brought, "brought")?, "brought")?;
            (device, interface, list(bindings, binding_count, "bindings")?)
        };
        // SAFETY: the caller's word.
        let views = given.iter().map(|it| unsafe { views(it) }).collect::<Result<Vec<_>, _>>()?;
        // SAFETY: the caller's word.
        let resources = given.iter().zip(&views).map(|(it, views)| unsafe { Ok((it.binding, resource(it, views)?)) });
        let resources = resources.collect::<Result<Vec<_>, Problem>>()?;
        Ok(FramewrightBindGroup(device.device.bind_group(&interface, set, &resources)?))
    };
    // SAFETY: the caller's word.
    call(|| unsafe { handle(group, "group", open) })
}

/// Frees a bind group. What was bound of it stays bound in the frames on their way.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_bind_group_free(group: *mut FramewrightBindGroup) {
    // SAFETY: the caller's word.
    unsafe { free(group) };
}

/// # Safety
/// The images are as the fields say.
unsafe fn views(given: &FramewrightBinding) -> Result<Vec<ProgramView>, Problem> {
    // SAFETY: the caller's word.
    let images = unsafe { list(given.images, given.image_count, "images")? };
    let view = |it: &vk::DescriptorImageInfo| {
        if it.image_layout == vk::ImageLayout::UNDEFINED || it.image_layout == vk::ImageLayout::PREINITIALIZED {
            let what =
                format!("`imageLayout` of an image at binding {} is none that an image is read in", given.binding);
            return Err(Problem::Misuse(what));
        }
        // SAFETY: the caller's word.
        Ok(unsafe { ProgramView::new(it.image_view, it.image_layout, it.sampler) })
    };
    images.iter().map(view).collect()
}

/// # Safety
/// The buffer is as the fields say.
unsafe fn resource<'v>(given: &FramewrightBinding, views: &'v [ProgramView]) -> Result<Resource<'v>, Problem> {
    let misuse = |what: &str| Err(Problem::Misuse(format!("binding {} has {what}", given.binding)));
    match (given.buffer.is_null(), views) {
        (true, []) => misuse("neither a `buffer` nor `images`"),
        (true, views) => Ok(Resource::ProgramViews(views)),
        (false, []) => {
            // SAFETY: the caller's word.
            let part = unsafe { reference(given.buffer, "buffer")? };
            // SAFETY: the caller's word.
            Ok(Resource::ProgramBuffer(unsafe { ProgramBuffer::new(part.buffer, part.offset, part.range) }))
        }
        (false, _) => misuse("a `buffer` and `images`"),
    }
}
