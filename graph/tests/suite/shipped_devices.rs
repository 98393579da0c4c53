//! Frames on every shipped device, and on devices whose figures are at the ends of what is possible, or beyond.

use crate::testing::graphs;
use crate::testing::raster::forward;
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{KnownNeeds, MemoryEstimate, MemoryNeeds, Profile, SHIPPED_PROFILES};
use framewright_graph::frame::Frame;
use framewright_graph::plan::Queue;
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Usage;

fn shipped() -> impl Iterator<Item = (&'static str, Profile)> {
    SHIPPED_PROFILES.iter().map(|(name, text)| (*name, Profile::from_ron(text).expect("a profile")))
}

fn frames() -> [(&'static str, Frame); 5] {
    [
        ("8 samples", forward(8, true, true)),
        ("4 samples without tone mapping", forward(4, true, false)),
        ("1 sample", forward(1, false, true)),
        ("wide", graphs::wide(30)),
        ("chain", graphs::chain(30)),
    ]
}

#[test]
fn every_frame_has_a_right_plan_on_every_shipped_device_in_every_order() {
    for (device, profile) in shipped() {
        for (name, frame) in frames() {
            for order in [Order::Default, Order::File, Order::LowMemory, Order::Random(1), Order::Random(2)] {
                for queues in [true, false] {
                    let options = Options { order, queues, ..Options::default() };
                    let plan = compile(&frame, &profile, &mut MemoryEstimate(&profile), &options);
                    let plan = plan.unwrap_or_else(|wrong| panic!("{name} on {device}: {wrong:?}"));
                    assert_eq!(verify(&plan), [], "{name} on {device}, {options:?}\n{}", plan.tree());
                    let one = plan.steps.iter().all(|step| step.queue == Queue::Graphics);
                    let more = profile.queues.compute || profile.queues.transfer;
                    assert!(one || (queues && more), "{name} on {device}, {options:?}");
                }
            }
        }
    }
}

/// IQ-5: the most samples, up to those asked for, that the device has.
#[test]
fn samples_are_those_that_the_shipped_device_has() {
    for (device, most) in [
        ("lavapipe", 4),
        ("swiftshader", 4),
        ("nvidia-rtx-2080", 8),
        ("amd-rx-7800-xt", 8),
        ("intel-arc-a770", 8),
        ("mali-g78", 8),
        ("meta-quest-3", 4),
    ] {
        let (_, profile) = shipped().find(|(name, _)| *name == device).expect("it is shipped");
        let plan = compile(&forward(8, true, true), &profile, &mut MemoryEstimate(&profile), &Options::default());
        let plan = plan.expect("valid");
        assert_eq!(plan.images.iter().map(|image| image.samples).max(), Some(most), "{device}");
        assert_eq!(plan.notes.iter().any(|note| note.text.contains("samples instead of 8: ")), most < 8, "{device}");
    }
}

#[test]
fn images_that_stay_in_their_scope_take_lazily_allocated_memory_where_there_is_such() {
    for (device, profile) in shipped() {
        let plan = compile(&forward(4, true, true), &profile, &mut MemoryEstimate(&profile), &Options::default());
        let lazily = plan.expect("valid").heaps.iter().any(|heap| heap.lazily_allocated);
        assert_eq!(lazily, profile.lazily_allocated_memory, "{device}");
    }
}

/// Profiles that a program may build in memory, where nobody has checked them.
fn beyond() -> Vec<Profile> {
    let bare = || graphs::device();
    let needs = |bytes, alignment, type_bits| {
        let mut profile = bare();
        let usages = vec![
            Usage::SAMPLED | Usage::STORAGE,
            Usage::SAMPLED | Usage::COLOR_ATTACHMENT,
            Usage::COLOR_ATTACHMENT | Usage::TRANSIENT_ATTACHMENT,
        ];
        let known = |support: &framewright_graph::device::FormatSupport| KnownNeeds {
            format: support.format,
            samples: 1,
            usages: usages.clone(),
            sizes: vec![
                ([64, 64], MemoryNeeds { bytes, alignment, type_bits }),
                ([256, 256], MemoryNeeds { bytes, alignment, type_bits }),
            ],
        };
        profile.known_needs = profile.formats.iter().map(known).collect();
        profile
    };
    let with = |change: fn(&mut Profile)| {
        let mut profile = bare();
        change(&mut profile);
        profile
    };
    vec![
        with(|it| it.max_attachment_extent = 0),
        with(|it| it.max_color_attachments = 0),
        with(|it| (it.max_extent_3d, it.max_layers) = (0, 0)),
        with(|it| it.formats.clear()),
        with(|it| it.formats.iter_mut().for_each(|format| format.samples.clear())),
        with(|it| it.formats.iter_mut().for_each(|format| format.samples = vec![3, 0, u32::MAX])),
        with(|it| it.formats.iter_mut().for_each(|format| format.usage = Usage::empty())),
        with(|it| it.memory.alignment = 0),
        with(|it| it.memory.alignment = u64::MAX),
        with(|it| (it.memory.row_texels, it.memory.rows) = (0, 0)),
        with(|it| (it.memory.row_texels, it.memory.row_bytes, it.memory.rows) = (u32::MAX, u32::MAX, u32::MAX)),
        with(|it| it.memory.type_bits = 0),
        with(|it| it.memory.buffer_alignment = u64::MAX),
        needs(u64::MAX, 1, 1),
        needs(0, 0, 0),
        needs(1 << 62, 1 << 62, 1),
        needs(3, u64::MAX, u32::MAX),
    ]
}

#[test]
fn no_figure_of_a_device_makes_the_compiler_panic_or_its_plans_wrong() {
    let mut refused = 0;
    let mut large = forward(16, true, true);
    for image in &mut large.images {
        image.extent = [16384, 16384, 1];
    }
    for profile in beyond() {
        for frame in frames().into_iter().map(|(_, frame)| frame).chain([large.clone()]) {
            for order in [Order::Default, Order::LowMemory] {
                let options = Options { order, ..Options::default() };
                match compile(&frame, &profile, &mut MemoryEstimate(&profile), &options) {
                    Ok(plan) => drop(verify(&plan)),
                    Err(wrong) => {
                        assert!(wrong.iter().all(|it| !it.message.is_empty()) && !wrong.is_empty(), "{wrong:?}");
                        refused += 1;
                    }
                }
            }
        }
    }
    assert!(refused > 20, "{refused} were refused");
}
