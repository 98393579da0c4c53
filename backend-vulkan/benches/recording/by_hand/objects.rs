//! Objects, drawn one by one.

use super::memory::HostBuffer;
use super::{MATERIAL_SET, Made, bind_set};
use crate::workload::{FRAME_SET, Objects};
use ash::vk;
use framewright_vulkan::Device;

/// The buffers and sets of the objects.
pub(super) struct ObjectBuffers {
    vertices: HostBuffer,
    indices: HostBuffer,
    index_count: u32,
    /// Layouts of the sets from 1 on.
    pub(super) set_layouts: [vk::DescriptorSetLayout; 2],
    frame: vk::DescriptorSet,
    /// For each run of objects with one material: its set, and how many they are.
    runs: Vec<(vk::DescriptorSet, u32)>,
    _kept: Vec<HostBuffer>,
}

impl ObjectBuffers {
    pub(super) fn new(device: &Device, objects: &Objects, made: &mut Made) -> ObjectBuffers {
        use vk::BufferUsageFlags as Usage;
        let kinds = [vk::DescriptorType::STORAGE_BUFFER, vk::DescriptorType::UNIFORM_BUFFER];
        let set_layouts = kinds.map(|kind| {
            let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
            let binding = vk::DescriptorSetLayoutBinding::default().descriptor_type(kind).descriptor_count(1);
            let bindings = [binding.stage_flags(stages)];
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: the device lives.
            unsafe { device.raw().create_descriptor_set_layout(&info, None) }.expect("a set layout")
        });
        made.set_layouts.extend(set_layouts);
        let mut kept = Vec::new();
        let mut set = |kind: usize, contents: &[u8]| {
            let usage = [Usage::STORAGE_BUFFER, Usage::UNIFORM_BUFFER][kind];
            let buffer = HostBuffer::with(device, contents, usage);
            let set = super::passes::set(device, set_layouts[kind], &[kinds[kind]], made);
            let info = [vk::DescriptorBufferInfo { buffer: buffer.raw, offset: 0, range: vk::WHOLE_SIZE }];
            let write = vk::WriteDescriptorSet::default().dst_set(set).descriptor_type(kinds[kind]).buffer_info(&info);
            // SAFETY: the set is new, and the buffer is kept.
            unsafe { device.raw().update_descriptor_sets(&[write], &[]) };
            kept.push(buffer);
            set
        };
        let frame = set(0, &objects.places);
        let materials: Vec<_> = objects.materials.iter().map(|color| set(1, color)).collect();
        ObjectBuffers {
            vertices: HostBuffer::with(device, &objects.vertices, Usage::VERTEX_BUFFER),
            indices: HostBuffer::with(device, &objects.indices, Usage::INDEX_BUFFER),
            index_count: objects.index_count,
            set_layouts,
            frame,
            runs: objects.runs.iter().map(|(material, count)| (materials[*material], *count)).collect(),
            _kept: kept,
        }
    }

    pub(super) fn draw(&self, raw: &ash::Device, commands: vk::CommandBuffer, layout: vk::PipelineLayout) {
        let graphics = vk::PipelineBindPoint::GRAPHICS;
        // SAFETY: the command buffer is being recorded in a scope, with the pipeline of the objects.
        unsafe {
            bind_set(raw, commands, graphics, layout, FRAME_SET, self.frame);
            raw.cmd_bind_vertex_buffers(commands, 0, &[self.vertices.raw], &[0]);
            raw.cmd_bind_index_buffer(commands, self.indices.raw, 0, vk::IndexType::UINT32);
            let mut object = 0;
            for (material, count) in &self.runs {
                bind_set(raw, commands, graphics, layout, MATERIAL_SET, *material);
                for _ in 0..*count {
                    raw.cmd_draw_indexed(commands, self.index_count, 1, 0, 0, object);
                    object += 1;
                }
            }
        }
    }
}
