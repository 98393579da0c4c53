//! A profile that was saved from a device takes the device's place: the same Plans, where the device is not.

use framewright_graph::base;
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{
    BufferDescriptor, ImageDescriptor, MemoryEstimate, MemoryNeeds, MemoryProvider, Profile,
};
use framewright_graph::plan::{DeviceUsed, Plan};
use framewright_graph::vulkan::{BufferUsage, Shape, Sharing, Usage};
use framewright_tests::render::device;
use framewright_tests::shipped::frames;
use framewright_tests::sweep;
use framewright_vulkan::Device;

/// Size of the frames that are planned most: usual, usual, and not usual at all.
const SIZES: [[u32; 2]; 3] = [[1280, 720], [1920, 1080], [333, 187]];

/// The device's profile, through the text that is saved.
fn saved(device: &Device) -> Profile {
    let text = device.profile().with_usual_needs(&mut device.memory()).to_ron().expect("it has a text form");
    Profile::from_ron(&text).expect("what is saved can be read")
}

/// Whether the memory of this device follows the model exactly, and not only for the images that the profile knows.
fn is_modelled(device: &Device) -> bool {
    device.summary().name.contains("llvmpipe")
}

#[test]
fn a_saved_profile_gives_the_plans_of_its_device() {
    let Some(device) = device().filter(|device| is_modelled(device)) else { return };
    let (live, saved) = (device.profile(), saved(device));
    let mut plans = 0;
    for size in SIZES {
        for shipped in sweep::of(&format!("frames at {size:?}"), frames(size).iter().collect(), 20) {
            for order in [Order::Default, Order::LowMemory] {
                let options = Options { order, ..Options::default() };
                let plan = |profile: &Profile, memory: &mut dyn MemoryProvider| -> Plan {
                    compile(&shipped.frame, profile, memory, &options)
                        .unwrap_or_else(|wrong| panic!("{}", base::render(&shipped.frame.sources, &wrong)))
                };
                let there = plan(&live, &mut device.memory());
                let here = plan(&saved, &mut MemoryEstimate(&saved));
                assert!(there.device.exact_memory && !here.device.exact_memory);
                let exact = DeviceUsed { exact_memory: true, ..here.device.clone() };
                assert_eq!(Plan { device: exact, ..here }, there, "{} at {size:?}", shipped.how);
                plans += 1;
            }
        }
    }
    assert!(plans > if sweep::is_long() { 200 } else { 30 }, "{plans} Plans");
}

/// Images and buffers of many kinds need what the saved profile says; those that it knows, to the byte on any device.
#[test]
fn a_saved_profile_knows_what_memory_the_device_asks_for() {
    let Some(device) = device() else { return };
    let saved = saved(device);
    let (mut there, mut here) = (device.memory(), MemoryEstimate(&saved));
    let mut known = 0;
    for needs in &saved.known_needs {
        for (usage, ([width, height], _)) in
            needs.usages.iter().flat_map(|it| needs.sizes.iter().map(move |size| (*it, size)))
        {
            let image = ImageDescriptor {
                format: needs.format,
                shape: Shape::D2,
                extent: [*width, *height, 1],
                mips: 1,
                layers: 1,
                samples: needs.samples,
                usage,
                sharing: Sharing::Exclusive,
            };
            assert_eq!(here.image(&image), there.image(&image), "{image:?}");
            known += 1;
        }
    }
    assert!(known > 500, "{known} images");
    if !is_modelled(device) {
        return;
    }
    for image in images(&saved) {
        let needs = there.image(&image);
        if needs.bytes == u64::MAX {
            continue;
        }
        let said = here.image(&image);
        // The model pads blocks as it pads texels, which is more than drivers do.
        if image.format.is_compressed() {
            assert!(said.bytes >= needs.bytes, "{image:?}");
        } else {
            assert_eq!(said, needs, "{image:?}");
        }
    }
    for bytes in [1, 100, 256, 1_000_001] {
        let buffer = BufferDescriptor { bytes, usage: BufferUsage::STORAGE_BUFFER, sharing: Sharing::Exclusive };
        let needs: MemoryNeeds = there.buffer(&buffer);
        assert_eq!(here.buffer(&buffer), needs, "{buffer:?}");
    }
}

/// Images of all formats, in random shapes and sizes.
fn images(profile: &Profile) -> impl Iterator<Item = ImageDescriptor> {
    let mut state = 12345_u64;
    let mut below = move |most: u32| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from((state >> 33) % u64::from(most)).unwrap_or(0)
    };
    let formats = profile.formats.iter().flat_map(|support| std::iter::repeat_n(support, 100));
    formats.map(move |support| {
        let shape = [Shape::D2, Shape::D3, Shape::Cube][below(3) as usize];
        let [width, height] = [1 + below(3000), 1 + below(3000)];
        let (extent, layers) = match shape {
            Shape::D2 => ([width, height, 1], 1 + below(4)),
            Shape::D3 => ([width, height, 1 + below(20)], 1),
            Shape::Cube => ([width, width, 1], 6),
        };
        let samples = if shape == Shape::D2 && below(2) == 0 { 4 } else { 1 };
        let levels = width.max(extent[1]).ilog2() + 1;
        ImageDescriptor {
            format: support.format,
            shape,
            extent,
            mips: if samples > 1 { 1 } else { 1 + below(levels) },
            layers,
            samples,
            usage: support.usage & (Usage::SAMPLED | Usage::TRANSFER_SRC),
            sharing: Sharing::Exclusive,
        }
    })
}
