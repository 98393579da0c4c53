//! Acceleration structures of a program's: two triangles, and two instances of them.

use crate::addressed::Addressed;
use ash::{khr, vk};
use framewright_vulkan::Device;

/// Corners of two triangles, of which the second one lies behind the first.
pub(crate) const TRIANGLES: [[[f32; 3]; 3]; 2] =
    [[[2.3, 1.7, 1.0], [25.6, 4.1, 1.0], [9.2, 20.8, 1.0]], [[10.1, 3.2, 2.0], [30.7, 10.4, 2.0], [6.3, 22.9, 2.0]]];
/// Where each instance stands.
pub(crate) const INSTANCES: [[f32; 3]; 2] = [[0.0, 0.0, 0.0], [14.0, 5.0, -0.5]];

/// All corners, one after the other.
pub(crate) fn corners() -> Vec<f32> {
    TRIANGLES.as_flattened().as_flattened().to_vec()
}

/// What a ray along z meets first that goes through the middle of a pixel: 0 is nothing; else 1 with the number of the triangle, and twice
/// that of the instance. No driver takes part in it.
pub(crate) fn met(x: u32, y: u32) -> u32 {
    let at = [x, y].map(|pixel| f64::from(pixel) + 0.5);
    let mut nearest = (f64::INFINITY, 0);
    for (instance, [right, down, deep]) in (0..).zip(INSTANCES.map(|place| place.map(f64::from))) {
        for (number, triangle) in (0..).zip(TRIANGLES) {
            let corners = triangle.map(|[x, y, z]| [f64::from(x) + right, f64::from(y) + down, f64::from(z) + deep]);
            let sides = [0, 1, 2].map(|corner| {
                let ([ax, ay, _], [bx, by, _]) = (corners[corner], corners[(corner + 1) % 3]);
                (bx - ax) * (at[1] - ay) - (by - ay) * (at[0] - ax)
            });
            // Nothing here depends on how a driver rounds.
            assert!(sides.iter().all(|side| side.abs() > 0.01), "{at:?} lies on an edge of {corners:?}");
            let inside = sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0);
            if inside && corners[0][2] < nearest.0 {
                nearest = (corners[0][2], 1 + number + 2 * instance);
            }
        }
    }
    nearest.1
}

/// What all pixels of an image meet.
pub(crate) fn picture([width, height]: [u32; 2]) -> Vec<u32> {
    (0..height).flat_map(|y| (0..width).map(move |x| met(x, y))).collect()
}

/// What a structure is made of.
#[derive(Clone, Copy)]
pub(crate) enum Made {
    /// The triangles whose corners lie at an address.
    Triangles(vk::DeviceAddress),
    /// The instances that lie at an address.
    Instances(vk::DeviceAddress),
}

/// The commands of acceleration structures.
pub(crate) struct Structures {
    functions: khr::acceleration_structure::Device,
}

impl Structures {
    /// Those of a device that has them.
    pub(crate) fn of(device: &Device) -> Option<Structures> {
        let features = device.profile().features.expect("they are known");
        let has = |name: &str| features.iter().any(|it| it == name);
        if !has("rayQuery") {
            return None;
        }
        assert!(has("accelerationStructure") && has("bufferDeviceAddress"), "{features:?}");
        let functions = khr::acceleration_structure::Device::new(device.raw_physical().0, device.raw());
        Some(Structures { functions })
    }

    /// Bytes of a structure, and those that its build works in.
    pub(crate) fn bytes(&self, made: Made) -> (u64, u64) {
        let geometry = [geometry(made)];
        let mut sizes = vk::AccelerationStructureBuildSizesInfoKHR::default();
        let info = build_info(made, &geometry);
        let on_device = vk::AccelerationStructureBuildTypeKHR::DEVICE;
        // SAFETY: the device has acceleration structures, and the counts are as many as there are geometries.
        unsafe { self.functions.get_acceleration_structure_build_sizes(on_device, &info, &[2], &mut sizes) };
        // The scratch memory begins at a multiple of what no device has more of.
        (sizes.acceleration_structure_size, sizes.build_scratch_size + SCRATCH_ALIGNMENT)
    }

    /// A structure in a buffer, which begins with it.
    pub(crate) fn make(&self, made: Made, buffer: vk::Buffer) -> vk::AccelerationStructureKHR {
        let info = vk::AccelerationStructureCreateInfoKHR::default()
            .buffer(buffer)
            .size(self.bytes(made).0)
            .ty(build_info(made, &[]).ty);
        // SAFETY: the buffer is for structures, and large enough.
        unsafe { self.functions.create_acceleration_structure(&info, None) }.expect("an acceleration structure")
    }

    pub(crate) fn destroy(&self, structure: vk::AccelerationStructureKHR) {
        // SAFETY: the frames were waited for.
        unsafe { self.functions.destroy_acceleration_structure(structure, None) };
    }

    pub(crate) fn address(&self, structure: vk::AccelerationStructureKHR) -> vk::DeviceAddress {
        let info = vk::AccelerationStructureDeviceAddressInfoKHR::default().acceleration_structure(structure);
        // SAFETY: the structure lives.
        unsafe { self.functions.get_acceleration_structure_device_address(&info) }
    }

    /// Records its build.
    pub(crate) fn build(
        &self,
        commands: vk::CommandBuffer,
        made: Made,
        structure: vk::AccelerationStructureKHR,
        scratch: vk::DeviceAddress,
    ) {
        let geometry = [geometry(made)];
        let scratch = scratch.next_multiple_of(SCRATCH_ALIGNMENT);
        let info = build_info(made, &geometry)
            .dst_acceleration_structure(structure)
            .scratch_data(vk::DeviceOrHostAddressKHR { device_address: scratch });
        let range = [vk::AccelerationStructureBuildRangeInfoKHR::default().primitive_count(2)];
        // SAFETY: the command buffer is recorded, outside of rendering scopes, and all that is built of and into lives.
        unsafe { self.functions.cmd_build_acceleration_structures(commands, &[info], &[&range]) };
    }
}

const SCRATCH_ALIGNMENT: u64 = 256;

fn geometry(made: Made) -> vk::AccelerationStructureGeometryKHR<'static> {
    let geometry = vk::AccelerationStructureGeometryKHR::default().flags(vk::GeometryFlagsKHR::OPAQUE);
    match made {
        Made::Triangles(address) => {
            let triangles = vk::AccelerationStructureGeometryTrianglesDataKHR::default()
                .vertex_format(vk::Format::R32G32B32_SFLOAT)
                .vertex_data(vk::DeviceOrHostAddressConstKHR { device_address: address })
                .vertex_stride(12)
                .max_vertex(5)
                .index_type(vk::IndexType::NONE_KHR);
            geometry
                .geometry_type(vk::GeometryTypeKHR::TRIANGLES)
                .geometry(vk::AccelerationStructureGeometryDataKHR { triangles })
        }
        Made::Instances(address) => {
            let instances = vk::AccelerationStructureGeometryInstancesDataKHR::default()
                .data(vk::DeviceOrHostAddressConstKHR { device_address: address });
            geometry
                .geometry_type(vk::GeometryTypeKHR::INSTANCES)
                .geometry(vk::AccelerationStructureGeometryDataKHR { instances })
        }
    }
}

fn build_info<'g>(
    made: Made,
    geometry: &'g [vk::AccelerationStructureGeometryKHR<'g>],
) -> vk::AccelerationStructureBuildGeometryInfoKHR<'g> {
    let ty = match made {
        Made::Triangles(_) => vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL,
        Made::Instances(_) => vk::AccelerationStructureTypeKHR::TOP_LEVEL,
    };
    vk::AccelerationStructureBuildGeometryInfoKHR::default()
        .ty(ty)
        .mode(vk::BuildAccelerationStructureModeKHR::BUILD)
        .geometries(geometry)
}

/// The instances, as a build reads them: each knows its number.
pub(crate) fn instances(bottom: vk::DeviceAddress) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (number, [x, y, z]) in (0_u32..).zip(INSTANCES) {
        let transform = [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, z];
        bytes.extend(transform.iter().flat_map(|it: &f32| it.to_ne_bytes()));
        bytes.extend((number | 0xff << 24).to_ne_bytes());
        bytes.extend(0_u32.to_ne_bytes());
        bytes.extend(bottom.to_ne_bytes());
    }
    bytes
}

/// Buffers that builds read have this usage.
pub(crate) const INPUT: vk::BufferUsageFlags = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR;

/// The instances of the triangles in a structure that the program has built by itself.
pub(crate) struct Scene<'d> {
    structures: &'d Structures,
    made: [vk::AccelerationStructureKHR; 2],
    _kept: Vec<Addressed<'d>>,
}

impl<'d> Scene<'d> {
    pub(crate) fn new(device: &'d Device, structures: &'d Structures) -> Scene<'d> {
        let corners: Vec<u8> = corners().iter().flat_map(|it| it.to_ne_bytes()).collect();
        let corners = Addressed::new(device, INPUT, 0, &corners);
        let stored = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE_KHR;
        let mut kept = Vec::new();
        let mut add = |made: Made| {
            let (bytes, scratch) = structures.bytes(made);
            let buffer = Addressed::new(device, stored, bytes, &[]);
            let scratch = Addressed::new(device, vk::BufferUsageFlags::STORAGE_BUFFER, scratch, &[]);
            let structure = structures.make(made, buffer.raw);
            submitted(device, |commands| structures.build(commands, made, structure, scratch.address));
            kept.push(buffer);
            structure
        };
        let bottom = add(Made::Triangles(corners.address));
        let instances = Addressed::new(device, INPUT, 0, &instances(structures.address(bottom)));
        let top = add(Made::Instances(instances.address));
        Scene { structures, made: [bottom, top], _kept: kept }
    }

    /// The structure that shaders trace.
    pub(crate) fn top(&self) -> vk::AccelerationStructureKHR {
        self.made[1]
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        self.made.iter().for_each(|it| self.structures.destroy(*it));
    }
}

/// Records commands of the program's, submits them, and waits.
fn submitted(device: &Device, record: impl FnOnce(vk::CommandBuffer)) {
    let raw = device.raw();
    let family = device.graphics_queue_family();
    // SAFETY: the device lives, its queue is nobody else's now, and what is recorded is waited for.
    unsafe {
        let pool = vk::CommandPoolCreateInfo::default().queue_family_index(family);
        let pool = raw.create_command_pool(&pool, None).expect("a pool");
        let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        let commands = raw.allocate_command_buffers(&info).expect("a command buffer");
        raw.begin_command_buffer(commands[0], &vk::CommandBufferBeginInfo::default()).expect("it begins");
        record(commands[0]);
        raw.end_command_buffer(commands[0]).expect("it ends");
        let queue = raw.get_device_queue(family, 0);
        let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
        raw.queue_submit(queue, &submit, vk::Fence::null()).expect("submitted");
        raw.queue_wait_idle(queue).expect("it is done");
        raw.destroy_command_pool(pool, None);
    }
}
