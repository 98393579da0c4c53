//! Draws of the program's within a pass, and what is bound for them.

use crate::arguments::{bytes, list, one_of, reference};
use crate::bind_groups::FramewrightBindGroup;
use crate::last_error::call;
use crate::passes::{FramewrightPass, PassResources, resources};
use crate::status::{FramewrightStatus, Problem};
use framewright::vulkan::ash::vk;
use framewright::{CullMode, FrontFace, IndexType, ProgramBuffer, RawSet, Recorder};
use std::ffi::c_void;
use std::ops::Range;

/// Push constants of a pass have no more bytes on any device.
const MOST_PUSHED: usize = 1 << 16;

/// Has a pass do something, if it can.
///
/// # Safety
/// The pointer is NULL or leads to a pass whose callback hasn't returned.
unsafe fn with(
    pass: *const FramewrightPass<'_>,
    body: impl FnOnce(&dyn PassResources) -> Result<Result<(), &'static str>, Problem>,
) -> FramewrightStatus {
    call(|| {
        // SAFETY: the caller's word.
        let done = body(unsafe { resources(pass)? })?;
        done.map_err(|why| Problem::Misuse(why.to_owned()))
    })
}

/// Has the recorder of a pass do something, if it draws.
///
/// # Safety
/// That of [`with`].
unsafe fn draws(pass: *const FramewrightPass<'_>, mut record: impl FnMut(&mut Recorder<'_>)) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe { with(pass, |pass| Ok(pass.draws(&mut record))) }
}

fn range(first: u32, count: u32, what: &str) -> Result<Range<u32>, Problem> {
    let end = first.checked_add(count).ok_or_else(|| Problem::Misuse(format!("too many {what}")))?;
    Ok(first..end)
}

/// Binds a group for the draws of a pass from now on, or for a compute pass. One of another set, or of another draw interface, is the error of the
/// frame.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_bind_group(
    pass: *const FramewrightPass<'_>,
    set: u32,
    group: *const FramewrightBindGroup,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe { with(pass, |pass| Ok(pass.bind_group(set, &reference(group, "group")?.0))) }
}

/// Binds a descriptor set of the program's for the draws of a pass from now on, or for a compute pass, in place of the one of
/// `framewright_renderer_bind_set`. All else is as there. One that the pass's shader doesn't read is left out.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_bind_set(
    pass: *const FramewrightPass<'_>,
    set: u32,
    descriptors: vk::DescriptorSet,
    offsets: *const u32,
    offset_count: usize,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(pass, |pass| {
            let offsets = list(offsets, offset_count, "offsets")?;
            Ok(pass.bind_set(set, RawSet::new(descriptors), offsets))
        })
    }
}

/// Binds `byte_count` bytes of a buffer of the program's, from `offset` on, as the vertex buffer `number` of the draw interface. `offset` is a multiple
/// of 4. The buffer was made for vertices, holds that much, and lives until the last frame is done that reads it; the program makes its barriers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_bind_vertex_buffer(
    pass: *const FramewrightPass<'_>,
    number: u32,
    buffer: vk::Buffer,
    offset: u64,
    byte_count: u64,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        let part = ProgramBuffer::new(buffer, offset, byte_count);
        draws(pass, |recorder| recorder.bind_program_vertices(number, part))
    }
}

/// Binds `byte_count` bytes of a buffer of the program's, from `offset` on, as the indices: `VK_INDEX_TYPE_UINT16` or `VK_INDEX_TYPE_UINT32`, and
/// `offset` is a multiple of an index's bytes. All else is as for vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_bind_index_buffer(
    pass: *const FramewrightPass<'_>,
    buffer: vk::Buffer,
    offset: u64,
    byte_count: u64,
    type_of_index: vk::IndexType,
) -> FramewrightStatus {
    const ALL: [IndexType; 2] = [IndexType::U16, IndexType::U32];
    // SAFETY: the caller's word.
    unsafe {
        with(pass, |pass| {
            let number = u32::try_from(type_of_index.as_raw()).unwrap_or(u32::MAX);
            let ty = *one_of(&ALL, number, "type_of_index")?;
            let part = ProgramBuffer::new(buffer, offset, byte_count);
            Ok(pass.draws(&mut |recorder| recorder.bind_program_indices(part, ty)))
        })
    }
}

/// Sets push constants from byte `offset` on, for the draws of a pass from now on, as the draw interface tells them. Both numbers are multiples of 4.
/// Where no stage of the pass reads any they are left out.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_push_constants(
    pass: *const FramewrightPass<'_>,
    offset: u32,
    constants: *const c_void,
    byte_count: usize,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(pass, |pass| {
            let constants = bytes(constants, byte_count, MOST_PUSHED, "constants")?;
            Ok(pass.draws(&mut |recorder| recorder.push_constants(offset, constants)))
        })
    }
}

/// Says which faces are left out from now on, unless the pipeline says it of the pass: at first none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_set_cull_mode(
    pass: *const FramewrightPass<'_>,
    mode: vk::CullModeFlags,
) -> FramewrightStatus {
    const ALL: [CullMode; 4] = [CullMode::None, CullMode::Front, CullMode::Back, CullMode::FrontAndBack];
    // SAFETY: the caller's word.
    unsafe {
        with(pass, |pass| {
            let mode = *one_of(&ALL, mode.as_raw(), "mode")?;
            Ok(pass.draws(&mut |recorder| recorder.set_cull_mode(mode)))
        })
    }
}

/// Says which side is the front from now on, as seen in the picture: at first `VK_FRONT_FACE_COUNTER_CLOCKWISE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_set_front_face(
    pass: *const FramewrightPass<'_>,
    face: vk::FrontFace,
) -> FramewrightStatus {
    const ALL: [FrontFace; 2] = [FrontFace::CounterClockwise, FrontFace::Clockwise];
    // SAFETY: the caller's word.
    unsafe {
        with(pass, |pass| {
            let face = *one_of(&ALL, u32::try_from(face.as_raw()).unwrap_or(u32::MAX), "face")?;
            Ok(pass.draws(&mut |recorder| recorder.set_front_face(face)))
        })
    }
}

/// Says to which rectangle of the upright picture clip space is stretched from now on, in texels: at first to all of it. Where instances draw into both
/// eyes' halves it is all of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_set_viewport(
    pass: *const FramewrightPass<'_>,
    x: f64,
    y: f64,
    width: f64,
    height: f64,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe { draws(pass, |recorder| recorder.set_viewport([x, y], [width, height])) }
}

/// Says in which rectangle of the upright picture texels may change from now on: at first in all of it. What lies outside the picture is left out. Where
/// instances draw into both eyes' halves it is all of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_set_scissor(
    pass: *const FramewrightPass<'_>,
    x: u32,
    y: u32,
    width: u32,
    height: u32,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe { draws(pass, |recorder| recorder.set_scissor([x, y], [width, height])) }
}

/// Draws consecutive vertices of a pass inside a rendering scope whose shader is the pipeline's, for both eyes where the pass is for both.
/// Shaders see `first_instance` as their first `gl_InstanceIndex`. It records into `commands` of the pass, which one thread does at a time.
///
/// It draws with the pipeline of the pass, and with what the functions `framewright_pass_…` have bound. Once the program has bound anything itself in
/// `commands`, or has set push constants there, none of them is called for this pass any more. A draw that lacks what its shader reads (vertex buffers, bind
/// groups, push constants, a set of the program's), or that reads beyond a vertex buffer, is the error of the frame.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_draw(
    pass: *const FramewrightPass<'_>,
    first_vertex: u32,
    vertex_count: u32,
    first_instance: u32,
    instance_count: u32,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(pass, |pass| {
            let vertices = range(first_vertex, vertex_count, "vertices")?;
            let instances = range(first_instance, instance_count, "instances")?;
            Ok(pass.draws(&mut |recorder| recorder.draw(vertices.clone(), instances.clone())))
        })
    }
}

/// Draws indexed vertices; `base_vertex` is added to each index. Indices that aren't in the index buffer are the error of the frame. Vertices that
/// indices choose aren't checked: `robustBufferAccess` keeps them within the VkBuffer; without it the program vouches for them. All else is as for
/// `framewright_pass_draw`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_draw_indexed(
    pass: *const FramewrightPass<'_>,
    first_index: u32,
    index_count: u32,
    base_vertex: i32,
    first_instance: u32,
    instance_count: u32,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(pass, |pass| {
            let indices = range(first_index, index_count, "indices")?;
            let instances = range(first_instance, instance_count, "instances")?;
            let mut record = |recorder: &mut Recorder<'_>| {
                recorder.draw_indexed(indices.clone(), base_vertex, instances.clone());
            };
            Ok(pass.draws(&mut record))
        })
    }
}
