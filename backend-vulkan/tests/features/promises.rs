//! A debug mode holds what custom passes do against what they declare (DO-8): each kind of lie is told, with the pass and what it declares,
//! and an honest program is left in peace.

use crate::frames::{
    Custom, Small, Uses, copy, draw, library, on_each_driver, on_each_driver_with, planned, texels, transfer, words,
};
use ash::vk;
use framewright_graph::compile::Options;
use framewright_graph::frame::{DeclaredUse, Draw, Frame, Resource, Work};
use framewright_graph::vulkan::{Accesses, FillValue, Format, Layout, Stages, State, Subresources};
use framewright_vulkan::{BrokenPromise, CustomRecorder, Device, Error, Executor, ExecutorOptions};
use std::cell::Cell;

const WHOLE: Subresources = Subresources::WHOLE;

const SHADERS: &[(&str, &str)] = &[(
    "show.frag",
    "#version 460
    layout(set = 0, binding = 0) uniform usampler2D source;
    layout(location = 0) out uint color;
    void main() { color = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r; }",
)];

/// What the pass `own` of [`frame`] does beside its work, which is to copy `seed` to `list`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lie {
    /// Nothing.
    None,
    /// Fills the buffer that it only reads.
    WritesWhatItReads,
    /// Clears an image that it doesn't name.
    WritesAnother,
    /// Copies an image that it doesn't name to what it writes.
    ReadsAnother,
    /// Asks for an image that it doesn't name.
    Asks,
}

/// `keep` reads the image `other`, and so gets hold of it; `own` copies `seed` to `list`; `show` shows `other`.
fn frame() -> Frame {
    let mut small = Small::default();
    let [seed, list, last] = ["seed", "list", "last"].map(|name| small.buffer(name, 8));
    let [other, shown] = ["other", "shown"].map(|name| small.image(name, Format::R32_UINT, [4, 2]));
    let [from, to, kept] = [seed, list, last].map(Resource::Buffer);
    let four = FillValue::Bits([4, 0, 0, 0]);
    small.pass(transfer("first", Work::Fill { value: four }, &[(from, WHOLE, true)]));
    small.pass(transfer(
        "paint",
        Work::Fill { value: FillValue::Bits([9, 0, 0, 0]) },
        &[(Resource::Image(other), WHOLE, true)],
    ));
    let custom = |name: &str, sides: &[(Resource, Subresources, bool)]| {
        transfer(name, Work::Custom { callback: name.into() }, sides)
    };
    let declared =
        |resource, accesses, layout| DeclaredUse::new(resource, State { stages: Stages::COPY, accesses, layout });
    let scratch = Resource::Buffer(small.buffer("scratch", 8));
    let mut keep = custom("keep", &[(Resource::Image(other), WHOLE, false), (scratch, WHOLE, true)]);
    keep.uses = vec![
        declared(Resource::Image(other), Accesses::TRANSFER_READ, Layout::General),
        declared(scratch, Accesses::TRANSFER_WRITE, Layout::Undefined),
    ];
    small.pass(keep);
    let mut own = custom("own", &[(from, WHOLE, false), (scratch, WHOLE, false), (to, WHOLE, true)]);
    own.uses = vec![
        declared(from, Accesses::TRANSFER_READ, Layout::Undefined),
        declared(scratch, Accesses::TRANSFER_READ, Layout::Undefined),
        declared(to, Accesses::TRANSFER_WRITE, Layout::Undefined),
    ];
    small.pass(own);
    small.pass(draw("show", Draw::FullScreen).samples("source", other, WHOLE).draws(shown, WHOLE, None));
    small.pass(copy("take", (to, WHOLE), (kept, WHOLE)));
    small.image_output(shown);
    small.buffer_output(last);
    small.frame
}

/// What two frames of a program leave, and the error of the second.
fn drawn(device: &Device, lie: Lie, check_uses: bool) -> (Result<(), Error>, Vec<u32>, Vec<u32>) {
    let plan = planned(device, &frame(), &Options { readable: check_uses, ..Options::default() });
    let options = ExecutorOptions { check_uses, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor");
    let kept = Cell::new(None);
    let mut record =
        Custom(|recorder: &mut CustomRecorder<'_>| {
            if recorder.pass() == "keep" {
                kept.set(recorder.image("other"));
                return recorder.copy("other", "scratch");
            }
            recorder.copy("seed", "list");
            let (raw, seed, list) = (device.raw(), recorder.buffer("seed"), recorder.buffer("list"));
            let (other, seed, list) = (kept.get().expect("kept"), seed.expect("named"), list.expect("named"));
            let layers = vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                layer_count: 1,
                ..Default::default()
            };
            let range = vk::ImageSubresourceRange {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                level_count: 1,
                layer_count: 1,
                ..Default::default()
            };
            let all = [vk::MemoryBarrier::default()
                .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
                .dst_access_mask(vk::AccessFlags::MEMORY_WRITE)];
            let commands = recorder.raw();
            // SAFETY: the images and buffers live. These are lies, which a software driver forgives.
            unsafe {
                let stage = vk::PipelineStageFlags::ALL_COMMANDS;
                raw.cmd_pipeline_barrier(commands, stage, stage, vk::DependencyFlags::empty(), &all, &[], &[]);
                match lie {
                    Lie::None => {}
                    Lie::WritesWhatItReads => raw.cmd_fill_buffer(commands, seed, 8, 4, 77),
                    Lie::WritesAnother => {
                        let three = vk::ClearColorValue { uint32: [3; 4] };
                        raw.cmd_clear_color_image(commands, other.raw, other.layout, &three, &[range]);
                    }
                    Lie::ReadsAnother => {
                        let region = vk::BufferImageCopy::default()
                            .image_subresource(layers)
                            .image_extent(vk::Extent3D { width: 4, height: 2, depth: 1 });
                        raw.cmd_copy_image_to_buffer(commands, other.raw, other.layout, list, &[region]);
                    }
                    Lie::Asks => assert!(recorder.image("other").is_none()),
                }
            }
        });
    executor.frame(&mut record).map(drop).unwrap_or_else(|error| assert!(lie != Lie::None, "{error}"));
    let second = executor.frame(&mut record).map(drop);
    (second, texels(&mut executor, "shown", 0), words(&mut executor, "last"))
}

/// What is told of the second frame of a program.
fn told(device: &Device, lie: Lie) -> Vec<BrokenPromise> {
    match drawn(device, lie, true).0 {
        Ok(()) => Vec::new(),
        Err(Error::BrokenPromises { promises }) => promises,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn do_8_an_honest_program_is_left_in_peace() {
    on_each_driver(|device| {
        for check_uses in [false, true] {
            let (done, shown, last) = drawn(device, Lie::None, check_uses);
            done.expect("nothing is wrong");
            assert_eq!((shown, last), (vec![9; 8], vec![4; 8]), "{check_uses}");
        }
    });
}

#[test]
fn do_8_what_a_pass_writes_and_does_not_declare_is_told() {
    on_each_driver_with(|device| {
        let said: Vec<String> = told(&device, Lie::WritesWhatItReads).iter().map(ToString::to_string).collect();
        let wanted = "pass `own` declares `seed` as COPY, TRANSFER_READ, and 1 of 32 bytes are others after it, the first is byte 8";
        assert!(said.iter().any(|it| it == wanted), "{said:?}");

        let said: Vec<String> = told(&device, Lie::WritesAnother).iter().map(ToString::to_string).collect();
        let wanted = "pass `own` doesn't name `other`, and 32 of 32 bytes of mip 0, layer 0 are others after it, the first is byte 0";
        assert!(said.iter().any(|it| it == wanted), "{said:?}");
        // It is given back what it held: the rest of the frame is as the pipeline says.
        assert_eq!(drawn(&device, Lie::WritesAnother, true).1, [9; 8]);
        assert_eq!(drawn(&device, Lie::WritesAnother, false).1, [3; 8]);
    });
}

#[test]
fn do_8_what_a_pass_reads_and_does_not_declare_is_garbage() {
    on_each_driver_with(|device| {
        assert_eq!(drawn(&device, Lie::ReadsAnother, false).2, [9; 8]);
        let (_, shown, last) = drawn(&device, Lie::ReadsAnother, true);
        assert_eq!(shown, [9; 8]);
        assert!(last.iter().all(|word| ![4, 9].contains(word)), "{last:?}");
    });
}

#[test]
fn do_8_what_a_program_asks_for_is_declared() {
    on_each_driver(|device| {
        let said = told(device, Lie::Asks);
        assert_eq!(said.len(), 1);
        assert_eq!(said[0].to_string(), "pass `own` doesn't name `other`, and the program asked the recorder for it");
    });
}

#[test]
fn a_plan_that_cannot_be_read_is_refused() {
    on_each_driver(|device| {
        let plan = planned(device, &frame(), &Options::default());
        let options = ExecutorOptions { check_uses: true, ..ExecutorOptions::default() };
        let made = Executor::new(device, &plan, &mut library(SHADERS), &options).map(drop);
        let said = made.expect_err("it can't be copied").to_string();
        assert!(said.contains("can't be watched: compile the Plan with `readable`"), "{said}");
    });
}
