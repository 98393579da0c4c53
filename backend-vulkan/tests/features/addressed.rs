//! Buffers of a program's that have addresses, and descriptor sets of its own: for what shaders follow beyond their bindings.

use ash::vk;
use framewright_vulkan::{Device, RawSet};

/// A buffer that the host writes and reads, and that has an address.
pub(crate) struct Addressed<'d> {
    device: &'d Device,
    pub(crate) raw: vk::Buffer,
    memory: vk::DeviceMemory,
    pub(crate) address: vk::DeviceAddress,
    bytes: u64,
}

impl<'d> Addressed<'d> {
    /// One that holds `contents`, and has room for `bytes` bytes.
    pub(crate) fn new(device: &'d Device, usage: vk::BufferUsageFlags, bytes: u64, contents: &[u8]) -> Addressed<'d> {
        let (instance, physical) = device.raw_physical();
        let raw = device.raw();
        let usage = usage | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let info = vk::BufferCreateInfo::default().size(bytes.max(contents.len() as u64)).usage(usage);
        // SAFETY: the device has addresses of buffers, and all that is pointed to outlives the calls.
        unsafe {
            let buffer = raw.create_buffer(&info, None).expect("a buffer");
            let needs = raw.get_buffer_memory_requirements(buffer);
            let types = instance.get_physical_device_memory_properties(physical);
            let wanted = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
            let ty = (0..)
                .zip(types.memory_types_as_slice())
                .find(|(number, ty)| needs.memory_type_bits & (1 << number) != 0 && ty.property_flags.contains(wanted));
            let mut flags = vk::MemoryAllocateFlagsInfo::default().flags(vk::MemoryAllocateFlags::DEVICE_ADDRESS);
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(ty.expect("memory of the host").0)
                .push_next(&mut flags);
            let memory = raw.allocate_memory(&info, None).expect("memory");
            raw.bind_buffer_memory(buffer, memory, 0).expect("bound");
            let address = address(device, buffer);
            let made = Addressed { device, raw: buffer, memory, address, bytes: info.allocation_size };
            let mapped = raw.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()).expect("mapped");
            std::ptr::copy_nonoverlapping(contents.as_ptr(), mapped.cast::<u8>(), contents.len());
            raw.unmap_memory(memory);
            made
        }
    }

    /// Its first words, once frames that write them were waited for.
    pub(crate) fn words(&self, count: usize) -> Vec<u32> {
        let raw = self.device.raw();
        assert!(4 * count as u64 <= self.bytes);
        // SAFETY: the memory has as many words, and nothing writes them now.
        unsafe {
            let mapped = raw.map_memory(self.memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()).expect("mapped");
            let words = std::slice::from_raw_parts(mapped.cast::<u32>(), count).to_vec();
            raw.unmap_memory(self.memory);
            words
        }
    }
}

impl Drop for Addressed<'_> {
    fn drop(&mut self) {
        // SAFETY: the frames were waited for.
        unsafe {
            self.device.raw().destroy_buffer(self.raw, None);
            self.device.raw().free_memory(self.memory, None);
        }
    }
}

/// The address of a buffer.
pub(crate) fn address(device: &Device, buffer: vk::Buffer) -> vk::DeviceAddress {
    let info = vk::BufferDeviceAddressInfo::default().buffer(buffer);
    // SAFETY: the buffer lives, and has an address.
    unsafe { device.raw().get_buffer_device_address(&info) }
}

/// A descriptor set with one descriptor of each of some types.
pub(crate) struct OwnSet<'d> {
    device: &'d Device,
    pub(crate) layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    pub(crate) set: vk::DescriptorSet,
}

impl<'d> OwnSet<'d> {
    pub(crate) fn new(device: &'d Device, types: &[vk::DescriptorType]) -> OwnSet<'d> {
        let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT | vk::ShaderStageFlags::COMPUTE;
        let binding = |(number, ty): (u32, &vk::DescriptorType)| {
            let plain = vk::DescriptorSetLayoutBinding::default().binding(number).descriptor_type(*ty);
            plain.descriptor_count(1).stage_flags(stages)
        };
        let bindings: Vec<_> = (0..).zip(types).map(binding).collect();
        let sizes: Vec<_> = types.iter().map(|ty| vk::DescriptorPoolSize { ty: *ty, descriptor_count: 1 }).collect();
        let raw = device.raw();
        // SAFETY: the device has these types, and all that is pointed to outlives the calls.
        unsafe {
            let layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let layout = raw.create_descriptor_set_layout(&layout, None).expect("a layout");
            let pool = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
            let pool = raw.create_descriptor_pool(&pool, None).expect("a pool");
            let layouts = [layout];
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            let set = raw.allocate_descriptor_sets(&info).expect("a set")[0];
            OwnSet { device, layout, pool, set }
        }
    }

    /// Has a binding hold a buffer.
    pub(crate) fn write_buffer(&self, binding: u32, ty: vk::DescriptorType, buffer: vk::Buffer) {
        let info = [vk::DescriptorBufferInfo::default().buffer(buffer).range(vk::WHOLE_SIZE)];
        let write = vk::WriteDescriptorSet::default().dst_set(self.set).dst_binding(binding).descriptor_type(ty);
        // SAFETY: nothing reads the set now.
        unsafe { self.device.raw().update_descriptor_sets(&[write.buffer_info(&info)], &[]) };
    }

    /// Has a binding hold an acceleration structure.
    pub(crate) fn write_structure(&self, binding: u32, structure: vk::AccelerationStructureKHR) {
        let structures = [structure];
        let mut info = vk::WriteDescriptorSetAccelerationStructureKHR::default().acceleration_structures(&structures);
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.set)
            .dst_binding(binding)
            .descriptor_type(vk::DescriptorType::ACCELERATION_STRUCTURE_KHR)
            .descriptor_count(1)
            .push_next(&mut info);
        // SAFETY: nothing reads the set now.
        unsafe { self.device.raw().update_descriptor_sets(&[write], &[]) };
    }

    pub(crate) fn set(&self) -> RawSet {
        // SAFETY: it fits, and lives longer than the executors of the tests.
        unsafe { RawSet::new(self.set) }
    }
}

impl Drop for OwnSet<'_> {
    fn drop(&mut self) {
        // SAFETY: the frames were waited for.
        unsafe {
            self.device.raw().destroy_descriptor_pool(self.pool, None);
            self.device.raw().destroy_descriptor_set_layout(self.layout, None);
        }
    }
}
