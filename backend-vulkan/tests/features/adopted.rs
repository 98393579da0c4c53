//! Devices that the program made itself: adopted, drawn with, and left to the program (EM-2). Shaders are held to the features that it
//! switched on (EM-5).

use crate::frames::{
    Shaders, Small, Uses, draw, frame, indexing, lacks, library, on_each_driver, placeless, planned, texels,
};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame};
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::ash::{self, vk};
use framewright_vulkan::gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use framewright_vulkan::{AdoptedDevice, Device, DeviceFeatures, Error, Executor, ExecutorOptions};
use std::ffi::CStr;
use std::sync::{Arc, Mutex};

/// The features that the program switches on: by the structures of Vulkan's versions.
#[derive(Default)]
struct ByVersion {
    core: vk::PhysicalDeviceFeatures,
    v1_2: vk::PhysicalDeviceVulkan12Features<'static>,
    v1_3: vk::PhysicalDeviceVulkan13Features<'static>,
}

fn core() -> vk::PhysicalDeviceFeatures {
    vk::PhysicalDeviceFeatures::default()
        .robust_buffer_access(true)
        .independent_blend(true)
        .fragment_stores_and_atomics(true)
        .sample_rate_shading(true)
}

impl ByVersion {
    fn all() -> ByVersion {
        ByVersion {
            core: core(),
            v1_2: vk::PhysicalDeviceVulkan12Features::default()
                .timeline_semaphore(true)
                .host_query_reset(true)
                .separate_depth_stencil_layouts(true),
            v1_3: vk::PhysicalDeviceVulkan13Features::default()
                .dynamic_rendering(true)
                .synchronization2(true)
                .maintenance4(true)
                .shader_demote_to_helper_invocation(true)
                .shader_terminate_invocation(true),
        }
    }

    fn chain(&mut self) -> vk::PhysicalDeviceFeatures2<'_> {
        vk::PhysicalDeviceFeatures2::default().features(self.core).push_next(&mut self.v1_2).push_next(&mut self.v1_3)
    }
}

/// A device of the same instance, made as a program would: with one queue of the first family, which draws and computes.
fn made(like: &Device, features: &mut vk::PhysicalDeviceFeatures2<'_>) -> ash::Device {
    made_with(like, features, &[])
}

/// The same with extensions.
pub(crate) fn made_with(
    like: &Device,
    features: &mut vk::PhysicalDeviceFeatures2<'_>,
    extensions: &[&CStr],
) -> ash::Device {
    let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    let (instance, physical) = like.raw_physical();
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&[1.0])];
    let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&names);
    let info = info.push_next(features);
    // SAFETY: the physical device belongs to the instance, and has these extensions and features, which are chained.
    unsafe { instance.create_device(physical, &info, None) }.expect("a device")
}

/// Adopts a device of the instance of `like`.
fn adopted(
    like: &Device,
    raw: &ash::Device,
    features: &vk::PhysicalDeviceFeatures2<'_>,
    families: &[u32],
    allocator: Option<&Arc<Mutex<Allocator>>>,
) -> Result<Device, Error> {
    adopted_with(like, raw, features, &[], families, allocator)
}

/// The same of a device with extensions.
pub(crate) fn adopted_with(
    like: &Device,
    raw: &ash::Device,
    features: &vk::PhysicalDeviceFeatures2<'_>,
    extensions: &[&CStr],
    families: &[u32],
    allocator: Option<&Arc<Mutex<Allocator>>>,
) -> Result<Device, Error> {
    let (instance, physical) = like.raw_physical();
    // SAFETY: the device was made with a queue of this family.
    let queue = |family: &u32| (*family, unsafe { raw.get_device_queue(*family, 0) });
    let queues: Vec<(u32, vk::Queue)> = families.iter().map(queue).collect();
    let program = AdoptedDevice {
        instance,
        instance_extensions: &[ash::ext::debug_utils::NAME],
        physical,
        device: raw,
        device_extensions: extensions,
        features,
        queues: &queues,
        allocator: allocator.cloned(),
    };
    // SAFETY: all of it belongs together, and lives until the test is over.
    unsafe { Device::adopt(&program, None) }
}

/// One in each texel.
const WHOLE_ONE: &str = "#version 460
    layout(location = 0) out uint color;
    void main() { color = 1; }";

/// Draws a number into each texel.
fn numbers() -> Frame {
    let mut small = Small::default();
    let numbers = small.image("numbers", Format::R32_UINT, [2, 2]);
    small.pass(draw("number", Draw::FullScreen).draws(numbers, Subresources::WHOLE, None));
    small.image_output(numbers);
    small.frame
}

/// Draws with a device that the program made, which then destroys it: the layer would say if anything were left.
fn draws_with(like: &Device, features: &mut vk::PhysicalDeviceFeatures2<'_>) {
    let raw = made(like, features);
    let device = adopted(like, &raw, features, &[0], None).expect("it has all that is needed");
    let plan = planned(&device, &numbers(), &Options::default());
    let mut executor =
        Executor::new(&device, &plan, &mut library(&[]), &ExecutorOptions::default()).expect("an executor");
    for _ in 0..3 {
        frame(&mut executor);
    }
    assert_eq!(texels(&mut executor, "numbers", 0), [0, 1, 10, 11]);
    drop((device, executor));
    // SAFETY: the device is the program's again, and nothing made from it is left.
    unsafe {
        raw.device_wait_idle().expect("it lives");
        raw.destroy_device(None);
    }
}

#[test]
fn a_device_of_the_program_draws_and_stays_the_programs() {
    on_each_driver(|like| {
        draws_with(like, &mut ByVersion::all().chain());
        // A program vouches for its own indices.
        let mut features = ByVersion::all();
        features.core.robust_buffer_access = vk::FALSE;
        draws_with(like, &mut features.chain());
        // All that is used of the device, local reads too.
        let (instance, physical) = like.raw_physical();
        // SAFETY: the physical device belongs to the instance.
        let mut all = unsafe { DeviceFeatures::of(instance, physical) }.expect("a device that is enough");
        let extensions = all.extensions().to_vec();
        let mut chain = all.chain();
        let raw = made_with(like, &mut chain, &extensions);
        let device = adopted_with(like, &raw, &chain, &extensions, &[0], None).expect("it has all that is needed");
        let [ours, own] = [&device, like].map(Device::profile);
        assert_eq!((ours.features, ours.local_read), (own.features, own.local_read));
        drop(device);
        // SAFETY: the device is the program's again, and nothing made from it is left.
        unsafe { raw.destroy_device(None) };
        // The same by the structures of the extensions that the features come from.
        let mut timeline = vk::PhysicalDeviceTimelineSemaphoreFeatures::default().timeline_semaphore(true);
        let mut queries = vk::PhysicalDeviceHostQueryResetFeatures::default().host_query_reset(true);
        let mut layouts = vk::PhysicalDeviceSeparateDepthStencilLayoutsFeatures::default();
        layouts = layouts.separate_depth_stencil_layouts(true);
        let mut rendering = vk::PhysicalDeviceDynamicRenderingFeatures::default().dynamic_rendering(true);
        let mut barriers = vk::PhysicalDeviceSynchronization2Features::default().synchronization2(true);
        let mut needs = vk::PhysicalDeviceMaintenance4Features::default().maintenance4(true);
        let mut demote = vk::PhysicalDeviceShaderDemoteToHelperInvocationFeatures::default();
        demote = demote.shader_demote_to_helper_invocation(true);
        let mut terminate = vk::PhysicalDeviceShaderTerminateInvocationFeatures::default();
        terminate = terminate.shader_terminate_invocation(true);
        let features = vk::PhysicalDeviceFeatures2::default().features(core());
        let features = features.push_next(&mut timeline).push_next(&mut queries).push_next(&mut layouts);
        let features = features.push_next(&mut rendering).push_next(&mut barriers).push_next(&mut needs);
        draws_with(like, &mut features.push_next(&mut demote).push_next(&mut terminate));
    });
}

/// Chooses among the elements of an array: by a number that is the same for all pixels, or by another one in each.
const CHOOSES: Shaders = &[
    (
        "number.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D taps[2];
        layout(location = 0) out uint color;
        void main() { color = 0; for (int at = 0; at < 2; at++) { color += texelFetch(taps[at], ivec2(0), 0).r; } }",
    ),
    (
        "each.frag",
        "#version 460
        #extension GL_EXT_nonuniform_qualifier : require
        layout(set = 0, binding = 0) uniform usampler2D taps[2];
        layout(location = 0) out uint color;
        void main() { color = texelFetch(taps[nonuniformEXT(int(gl_FragCoord.x) % 2)], ivec2(0), 0).r; }",
    ),
];

#[test]
fn a_shader_that_needs_a_feature_which_is_not_switched_on_is_refused_with_its_name() {
    on_each_driver(|like| {
        let refused = |shader: &str, features: &mut vk::PhysicalDeviceFeatures2<'_>| {
            let raw = made(like, features);
            let device = adopted(like, &raw, features, &[0], None).expect("it has all that is needed");
            let mut small = Small::default();
            let [tap, numbers] = ["tap", "numbers"].map(|name| small.image(name, Format::R32_UINT, [2, 2]));
            small.pass(draw("tap", Draw::FullScreen).draws(tap, Subresources::WHOLE, None));
            let pass = ["taps[0]", "taps[1]"]
                .into_iter()
                .fold(draw(shader, Draw::FullScreen), |pass, name| pass.samples(name, tap, Subresources::WHOLE));
            small.pass(pass.draws(numbers, Subresources::WHOLE, None));
            small.image_output(numbers);
            let plan = planned(&device, &small.frame, &Options::default());
            let mut shaders = library(&[CHOOSES, &[("tap.frag", WHOLE_ONE)]].concat().leak()[..]);
            let executor = Executor::new(&device, &plan, &mut shaders, &ExecutorOptions::default());
            let said = executor.err().map(|error| placeless(&error.to_string())).unwrap_or_default();
            drop(device);
            // SAFETY: nothing made from it is left.
            unsafe { raw.destroy_device(None) };
            said
        };
        let [(dynamic, has_dynamic), (different, has_different)] = indexing(like);
        assert_eq!(refused("number", &mut ByVersion::all().chain()), lacks("number", dynamic));
        if !(has_dynamic && has_different) {
            eprintln!("SKIPPED: {} can't choose so", like.summary().name);
            return;
        }
        let with = |different: bool| {
            let mut features = ByVersion::all();
            features.core.shader_sampled_image_array_dynamic_indexing = vk::TRUE;
            features.v1_2.shader_sampled_image_array_non_uniform_indexing = different.into();
            features
        };
        assert_eq!(refused("number", &mut with(false).chain()), "");
        assert_eq!(refused("each", &mut with(false).chain()), lacks("each", different));
        assert_eq!(refused("each", &mut with(true).chain()), "");
    });
}

#[test]
fn memory_comes_from_the_programs_allocator_and_goes_back_to_it() {
    on_each_driver(|like| {
        let mut features = ByVersion::all();
        let mut features = features.chain();
        let raw = made(like, &mut features);
        let (instance, physical) = like.raw_physical();
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: raw.clone(),
            physical_device: physical,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: Default::default(),
        });
        let allocator = Arc::new(Mutex::new(allocator.expect("an allocator")));
        let allocations = || allocator.lock().expect("no thread panicked").generate_report().allocations.len();
        let device = adopted(like, &raw, &features, &[0], Some(&allocator)).expect("it has all that is needed");
        assert_eq!(allocations(), 0);
        let plan = planned(&device, &numbers(), &Options::default());
        let mut executor =
            Executor::new(&device, &plan, &mut library(&[]), &ExecutorOptions::default()).expect("an executor");
        frame(&mut executor);
        assert!(allocations() > 0);
        assert_eq!(device.memory_in_use().allocations, allocations());
        assert_eq!(texels(&mut executor, "numbers", 0), [0, 1, 10, 11]);
        drop((device, executor));
        assert_eq!(allocations(), 0);
        let allocator = Arc::into_inner(allocator).expect("the program's alone again");
        drop(allocator);
        // SAFETY: nothing made from the device is left.
        unsafe { raw.destroy_device(None) };
    });
}

#[test]
fn what_a_device_was_created_without_is_named() {
    on_each_driver(|like| {
        let mut all = ByVersion::all();
        let raw = made(like, &mut all.chain());
        let missing = |change: fn(&mut ByVersion), families: &[u32]| {
            let mut features = ByVersion::all();
            change(&mut features);
            match adopted(like, &raw, &features.chain(), families, None) {
                Err(Error::NotEnabled { missing, .. }) => missing,
                Err(error) => panic!("{error}"),
                Ok(_) => panic!("it was adopted"),
            }
        };
        let without = |it: &mut ByVersion| it.v1_3.synchronization2 = vk::FALSE;
        assert_eq!(missing(without, &[0]), ["the feature synchronization2"]);
        let without = |it: &mut ByVersion| {
            it.v1_2.timeline_semaphore = vk::FALSE;
            it.v1_3.maintenance4 = vk::FALSE;
            // Not every Plan uses it.
            it.core.independent_blend = vk::FALSE;
        };
        assert_eq!(missing(without, &[0]), ["the feature maintenance4", "the feature timelineSemaphore"]);
        assert_eq!(missing(|_| (), &[]), ["a queue for graphics and compute"]);
        let error = Error::NotEnabled { device: "GPU".to_owned(), missing: missing(|_| (), &[]) };
        assert_eq!(
            error.to_string(),
            "GPU was created without a queue for graphics and compute: add what it lacks where the device is created"
        );
        // SAFETY: nothing was made from it.
        unsafe { raw.destroy_device(None) };
    });
}
