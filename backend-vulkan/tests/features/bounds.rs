//! Devices that are opened without `robustBufferAccess`.

use crate::frames::{Small, Uses, draw, frame, library, on_each_driver, planned, texels};
use crate::testing::findings;
use framewright_graph::compile::Options;
use framewright_graph::frame::Draw;
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::ash::vk;
use framewright_vulkan::{BufferBounds, Device, DeviceChoice, DeviceOptions, Executor, ExecutorOptions};

/// The feature that some devices have without `robustBufferAccess` alone.
const AFTER_BIND: &str = "descriptorBindingStorageBufferUpdateAfterBind";

/// Whether the physical device has that feature at all, and together with `robustBufferAccess`.
fn has_after_bind(device: &Device) -> [bool; 2] {
    let (instance, physical) = device.raw_physical();
    let mut v1_2 = vk::PhysicalDeviceVulkan12Features::default();
    let mut properties = vk::PhysicalDeviceVulkan12Properties::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut v1_2);
    let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut properties);
    // SAFETY: the physical device belongs to the instance, and the chained structures outlive the calls.
    unsafe {
        instance.get_physical_device_features2(physical, &mut features);
        instance.get_physical_device_properties2(physical, &mut all);
    }
    let has = v1_2.descriptor_binding_storage_buffer_update_after_bind == vk::TRUE;
    [has, has && properties.robust_buffer_access_update_after_bind == vk::TRUE]
}

#[test]
fn do_11_the_program_opens_a_device_that_does_not_check_bounds() {
    on_each_driver(|checked| {
        // SAFETY: the frame below has no buffers.
        let bounds = unsafe { BufferBounds::unchecked() };
        let choice = DeviceChoice::Name(checked.summary().name.clone());
        let options = DeviceOptions { choice, validation: true, bounds, ..DeviceOptions::default() };
        let device = Device::open(&options).expect("the driver is there");
        assert_eq!([checked.checks_bounds(), device.checks_bounds()], [true, false]);
        let has = |device: &Device| device.profile().features.is_some_and(|all| all.iter().any(|it| it == AFTER_BIND));
        assert_eq!([has(&device), has(checked)], has_after_bind(checked));

        let mut small = Small::default();
        let numbers = small.image("numbers", Format::R32_UINT, [2, 2]);
        small.pass(draw("number", Draw::FullScreen).draws(numbers, Subresources::WHOLE, None));
        small.image_output(numbers);
        let plan = planned(&device, &small.frame, &Options::default());
        let executor = Executor::new(&device, &plan, &mut library(&[]), &ExecutorOptions::default());
        let mut executor = executor.expect("nothing of the Plan needs it");
        frame(&mut executor);
        assert_eq!(texels(&mut executor, "numbers", 0), [0, 1, 10, 11]);
        let messages = device.messages();
        drop((device, executor));
        assert_eq!(findings(&messages), []);
    });
}
