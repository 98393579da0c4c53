//! A debug mode holds what custom passes do against what they declare (DO-8): each kind of lie is told, with the pass and what it declares,
//! and an honest program is left in peace.

use crate::frames::{
    Custom, Small, Uses, copy, draw, library, on_each_driver, on_each_driver_with, planned, texels, transfer, words,
};
use ash::vk;
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{Profile, Queues};
use framewright_graph::frame::{Cadence, DeclaredUse, Draw, Frame, Pass, Resource, Work};
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::{Accesses, FillValue, Format, Layout, Sharing, Stages, State, Subresources};
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
    /// Asks twice for an image that it doesn't name, and for what it names as the wrong kind.
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
    let (mut frames, shown, last) = drawn_in(device, (lie, check_uses), &Cadence::Always, 2);
    (frames.remove(1), shown, last)
}

/// What frames of a program leave whose pass `own` runs so, and the error of each.
fn drawn_in(
    device: &Device,
    (lie, check_uses): (Lie, bool),
    run: &Cadence,
    frames: usize,
) -> (Vec<Result<(), Error>>, Vec<u32>, Vec<u32>) {
    let mut all = frame();
    all.passes.iter_mut().filter(|pass| *pass.name == *"own").for_each(|pass| pass.run = run.clone());
    let plan = planned(device, &all, &Options { readable: check_uses, ..Options::default() });
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
                    Lie::Asks => {
                        assert!(recorder.image("other").is_none() && recorder.image("other").is_none());
                        assert!(recorder.image("list").is_none());
                    }
                }
            }
        });
    let drawn: Vec<_> = (0..frames).map(|_| executor.frame(&mut record).map(drop)).collect();
    drawn.iter().for_each(|done| assert!(lie != Lie::None || done.is_ok(), "{done:?}"));
    (drawn, texels(&mut executor, "shown", 0), words(&mut executor, "last"))
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

/// A pass that doesn't run in every frame is looked at in every second frame in which it runs, and one that runs once in that one.
#[test]
fn do_8_what_passes_write_that_run_now_and_then_is_told() {
    on_each_driver_with(|device| {
        let every = |count| Cadence::Every { count, at: 0 };
        for (run, frames, wanted) in
            [(Cadence::Once, 2, vec![0]), (every(2), 8, vec![2, 6]), (every(4), 16, vec![4, 12])]
        {
            let (drawn, ..) = drawn_in(&device, (Lie::WritesWhatItReads, true), &run, frames);
            let contents = |it: &BrokenPromise| it.to_string().contains("1 of 32 bytes are others after it");
            let told = |done: &Result<(), Error>| match done {
                Ok(()) => false,
                Err(Error::BrokenPromises { promises }) => promises.iter().any(contents),
                Err(error) => panic!("{error}"),
            };
            let told: Vec<_> = (0..frames).filter(|frame| told(&drawn[*frame])).collect();
            assert_eq!(told, wanted, "{run:?}");
        }
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

/// What an executor found and nobody has asked for, the one that goes on from it tells.
#[test]
fn do_8_what_nobody_waited_for_is_told_by_the_next_executor() {
    let mut small = Small::default();
    let (list, shown) = (small.buffer("list", 8), small.image("shown", Format::R32_UINT, [4, 2]));
    let own = Work::Custom { callback: "own".into() };
    small.pass(transfer("own", own, &[(Resource::Buffer(list), WHOLE, true)]));
    let nine = Work::Fill { value: FillValue::Bits([9, 0, 0, 0]) };
    small.pass(transfer("paint", nine, &[(Resource::Image(shown), WHOLE, true)]));
    small.image_output(shown);
    small.buffer_output(list);
    on_each_driver(|device| {
        let plan = planned(device, &small.frame, &Options { readable: true, ..Options::default() });
        let options = ExecutorOptions { check_uses: true, ..ExecutorOptions::default() };
        let made = || Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor");
        let recorded = |lies: bool| {
            Custom(move |recorder: &mut CustomRecorder<'_>| {
                assert!(!lies || recorder.image("shown").is_none());
                recorder.fill("list", FillValue::Bits([4, 0, 0, 0]));
            })
        };
        let (mut before, mut next) = (made(), made());
        before.submit(&mut recorded(true)).expect("on its way");
        next.migrate_from(before).expect("they are of one device");
        let told = next.frame(&mut recorded(false)).expect_err("it was not told yet").to_string();
        assert!(told.contains("pass `own` doesn't name `shown`"), "{told}");
        next.frame(&mut recorded(false)).expect("it was told");
    });
}

/// A pass declares that it sets all of an image and a buffer. It sets this many rows of the image, and words of the buffer. It runs in one
/// of `every` frames. Returns what is told of the first four frames in which it runs.
fn told_of_parts(device: &Device, [rows, words]: [u32; 2], every: u32) -> Vec<String> {
    let mut small = Small::default();
    let [mask, held, shown] = ["mask", "held", "shown"].map(|name| small.image(name, Format::R32_UINT, [4, 2]));
    let [list, held_list, last] = ["list", "held_list", "last"].map(|name| small.buffer(name, 8));
    let run = Cadence::every(every, 0);
    let own = Work::Custom { callback: "own".into() };
    let [image, buffer, kept] = [Resource::Image(mask), Resource::Buffer(list), Resource::Buffer(last)];
    let mut own = transfer("own", own, &[(image, WHOLE, true), (buffer, WHOLE, true)]);
    let accesses = Accesses::TRANSFER_WRITE;
    own.uses = vec![
        DeclaredUse::new(image, State { stages: Stages::CLEAR, accesses, layout: Layout::General }),
        DeclaredUse::new(buffer, State { stages: Stages::CLEAR, accesses, layout: Layout::Undefined }),
    ];
    // What runs in the same frames shares memory as ever: what the pass sets isn't kept.
    let held_buffer = Resource::Buffer(held_list);
    let hold = draw("show", Draw::FullScreen).samples("source", mask, WHOLE).draws(held, WHOLE, None);
    for pass in [own, hold, copy("hold", (buffer, WHOLE), (held_buffer, WHOLE))] {
        small.pass(Pass { run: run.clone(), ..pass });
    }
    let mut show = draw("show", Draw::FullScreen).samples("source", held, WHOLE).draws(shown, WHOLE, None);
    show.name = "show_held".into();
    small.pass(show);
    small.pass(copy("take", (held_buffer, WHOLE), (kept, WHOLE)));
    small.image_output(shown);
    small.buffer_output(last);
    let plan = planned(device, &small.frame, &Options { readable: true, ..Options::default() });
    let options = ExecutorOptions { check_uses: true, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor");
    let zeros = staged_zeros(device);
    let mut record = Custom(|recorder: &mut CustomRecorder<'_>| {
        let (image, buffer) = (recorder.image("mask").expect("named"), recorder.buffer("list").expect("named"));
        let (raw, commands) = (device.raw(), recorder.raw());
        let layers = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            layer_count: 1,
            ..Default::default()
        };
        let region = vk::BufferImageCopy::default().image_subresource(layers).image_extent(vk::Extent3D {
            width: 4,
            height: rows,
            depth: 1,
        });
        // SAFETY: recording outside of scopes, into what the pass writes.
        unsafe {
            raw.cmd_copy_buffer_to_image(commands, zeros.0, image.raw, image.layout, &[region]);
            // What garbage is, in turn, is no sign that nothing was set.
            raw.cmd_fill_buffer(commands, buffer, 0, u64::from(4 * words), 5);
        }
    });
    let mut said = Vec::new();
    for _ in 0..4 * every {
        match executor.frame(&mut record) {
            Ok(_) => {}
            Err(Error::BrokenPromises { promises }) => said.extend(promises.iter().map(ToString::to_string)),
            Err(error) => panic!("{error}"),
        }
    }
    drop(executor);
    // SAFETY: the frames were waited for.
    unsafe {
        device.raw().destroy_buffer(zeros.0, None);
        device.raw().free_memory(zeros.1, None);
    }
    said
}

/// A buffer of 32 bytes to copy from, all 0.
fn staged_zeros(device: &Device) -> (vk::Buffer, vk::DeviceMemory) {
    let raw = device.raw();
    let info = vk::BufferCreateInfo::default().size(32).usage(vk::BufferUsageFlags::TRANSFER_SRC);
    let (instance, physical) = device.raw_physical();
    // SAFETY: the device lives; buffer and memory are new, and the memory is large enough.
    unsafe {
        let buffer = raw.create_buffer(&info, None).expect("a buffer");
        let needs = raw.get_buffer_memory_requirements(buffer);
        let types = instance.get_physical_device_memory_properties(physical);
        let visible = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        let fits = |ty: &u32| {
            needs.memory_type_bits >> ty & 1 == 1 && types.memory_types[*ty as usize].property_flags.contains(visible)
        };
        let ty = (0..types.memory_type_count).find(fits).expect("memory that the host writes");
        let memory = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(ty);
        let memory = raw.allocate_memory(&memory, None).expect("memory");
        raw.bind_buffer_memory(buffer, memory, 0).expect("bound");
        let place = raw.map_memory(memory, 0, 32, vk::MemoryMapFlags::empty()).expect("mapped");
        place.cast::<u8>().write_bytes(0, 32);
        raw.unmap_memory(memory);
        (buffer, memory)
    }
}

#[test]
fn do_8_what_a_pass_declares_to_set_and_leaves_untouched_is_told() {
    on_each_driver_with(|device| {
        let of_contents = |counts, every| {
            let said = told_of_parts(&device, counts, every);
            said.into_iter().filter(|it| !it.contains("validation layer")).collect::<Vec<_>>()
        };
        assert_eq!(of_contents([2, 8], 1), [""; 0]);
        let image = "pass `own` declares `mask` as CLEAR, TRANSFER_WRITE, GENERAL, and 4 of 8 texels of mip 0, layer 0 are not set by \
                     it, the first is number 4";
        let buffer = "pass `own` declares `list` as CLEAR, TRANSFER_WRITE, and 1 of 8 words is not set by it, the first is number 7";
        for every in [1, 2, 4] {
            assert_eq!(of_contents([1, 7], every), [image, buffer], "{every}");
        }
    });
}

#[test]
fn a_plan_that_cannot_be_read_is_refused() {
    let mut small = Small::default();
    let [drawn, shown] = ["drawn", "shown"].map(|name| small.image(name, Format::R32_UINT, [4, 2]));
    let list = small.buffer("list", 8);
    small.pass(draw("number", Draw::FullScreen).draws(drawn, WHOLE, None));
    let own = Work::Custom { callback: "own".into() };
    small.pass(transfer("own", own, &[(Resource::Buffer(list), WHOLE, true)]));
    small.pass(draw("show", Draw::FullScreen).samples("source", drawn, WHOLE).draws(shown, WHOLE, None));
    small.buffer_output(list);
    small.image_output(shown);
    on_each_driver(|device| {
        let options = ExecutorOptions { check_uses: true, ..ExecutorOptions::default() };
        let made = |readable| {
            let order = Order::File;
            let plan = planned(device, &small.frame, &Options { readable, order, ..Options::default() });
            Executor::new(device, &plan, &mut library(SHADERS), &options).map(drop).map_err(|error| error.to_string())
        };
        assert_eq!(made(true), Ok(()));
        let said = made(false).expect_err("it can't be copied");
        assert!(said.contains("`drawn` can't be watched: compile the Plan with `readable`"), "{said}");
    });
}

/// What four frames of a program are told whose pass `own` runs on the queue for compute, beside draws, and copies `seed` to `list`. A lie is
/// that it writes `seed` too.
fn told_of_compute(device: &Device, sharing: Sharing, lies: bool) -> Vec<String> {
    let mut small = Small::default();
    let [seed, list, last] = ["seed", "list", "last"].map(|name| small.buffer(name, 8));
    let [large, shown] = ["large", "shown"].map(|name| small.image(name, Format::R32_UINT, [64, 64]));
    let [from, to, kept] = [seed, list, last].map(Resource::Buffer);
    let four = FillValue::Bits([4, 0, 0, 0]);
    small.pass(transfer("first", Work::Fill { value: four }, &[(from, WHOLE, true)]));
    small.pass(draw("number", Draw::FullScreen).draws(large, WHOLE, None));
    let own = Work::Custom { callback: "own".into() };
    let mut own = transfer("own", own, &[(from, WHOLE, false), (to, WHOLE, true)]);
    let declared = |resource, accesses| {
        DeclaredUse::new(resource, State { stages: Stages::COPY, accesses, layout: Layout::Undefined })
    };
    own.uses = vec![declared(from, Accesses::TRANSFER_READ), declared(to, Accesses::TRANSFER_WRITE)];
    own.any_queue = true;
    small.pass(own);
    small.pass(draw("show", Draw::FullScreen).samples("source", large, WHOLE).draws(shown, WHOLE, None));
    small.pass(copy("take", (to, WHOLE), (kept, WHOLE)));
    small.image_output(shown);
    small.buffer_output(last);
    let queues = Queues { compute: true, transfer: true, sharing, wait_bytes: 0 };
    let profile = Profile { queues, ..device.profile() };
    let options = Options { readable: true, order: Order::File, ..Options::default() };
    let plan = compile(&small.frame, &profile, &mut device.memory(), &options);
    let plan = plan.unwrap_or_else(|errors| panic!("{errors:?}"));
    let own = plan.steps.iter().find(|step| step.work.passes().iter().any(|pass| *pass.name == *"own"));
    assert_eq!(own.expect("it runs").queue, Queue::Compute, "{}", plan.tree());
    let options = ExecutorOptions { check_uses: true, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor");
    let mut record = Custom(|recorder: &mut CustomRecorder<'_>| {
        recorder.copy("seed", "list");
        if lies {
            let (commands, seed) = (recorder.raw(), recorder.buffer("seed").expect("the pass names it"));
            // SAFETY: the buffer lives. It is a lie, which a software driver forgives.
            unsafe { device.raw().cmd_fill_buffer(commands, seed, 8, 4, 77) };
        }
    });
    let frames = (0..4).map(|_| match executor.frame(&mut record) {
        Ok(_) => Vec::new(),
        Err(Error::BrokenPromises { promises }) => promises.iter().map(ToString::to_string).collect(),
        Err(error) => panic!("{error}"),
    });
    let told = frames.collect::<Vec<Vec<String>>>().concat();
    assert_eq!(texels(&mut executor, "shown", 0), (0..4096).map(|at| at % 64 + 10 * (at / 64)).collect::<Vec<_>>());
    if !lies {
        assert_eq!(words(&mut executor, "last"), [4; 8]);
    }
    told
}

#[test]
fn do_8_what_a_pass_on_a_queue_for_compute_does_is_told() {
    on_each_driver(|device| {
        for sharing in [Sharing::Concurrent, Sharing::Exclusive] {
            assert_eq!(told_of_compute(device, sharing, false), [""; 0], "{sharing:?}");
        }
    });
    on_each_driver_with(|device| {
        for sharing in [Sharing::Concurrent, Sharing::Exclusive] {
            let said = told_of_compute(&device, sharing, true);
            let wanted = "pass `own` declares `seed` as COPY, TRANSFER_READ, and 1 of 32 bytes are others after it";
            assert!(said.iter().any(|it| it.starts_with(wanted)), "{sharing:?}: {said:?}");
        }
    });
}
