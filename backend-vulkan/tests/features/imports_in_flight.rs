//! Imports while frames are on their way: nothing is waited for, and what was made for the images and buffers before is kept until the
//! frames that use it are done.

use crate::foreign::{destroy_buffer, destroy_image, own_buffer, own_image};
use crate::frames::{frame, library, on_each_driver, planned, texels, to_bytes, words};
use crate::imports::{SHADERS, drawn_into, increased, sampled_from};
use crate::submitting::Semaphore;
use crate::testing::Nothing;
use framewright_graph::compile::Options;
use framewright_graph::frame::Frame;
use framewright_graph::vulkan::Aspects;
use framewright_vulkan::ash::vk;
use framewright_vulkan::{Device, Executor, ExecutorOptions, Submission};
use std::time::Duration;

const IN_FLIGHT: u64 = 3;
const FRAMES: u64 = 40;
/// Each frame in flight has had each import by then.
const SETTLED: u64 = 16;

fn executor(device: &Device, frame: &Frame) -> Executor {
    let options = ExecutorOptions {
        frames_in_flight: u32::try_from(IN_FLIGHT).expect("it is small"),
        readback: true,
        timeout: Duration::from_secs(3),
        ..ExecutorOptions::default()
    };
    Executor::new(device, &planned(device, frame, &Options::default()), &mut library(SHADERS), &options).expect("valid")
}

/// Brings an image of the program's into the state that the Plan finds it in.
fn sampled_before(device: &Device, image: vk::Image) {
    let mut drawing = executor(device, &drawn_into());
    // SAFETY: it is made as the Plan says, and outlives the executor.
    unsafe { drawing.import_image("shared", image) }.expect("it is external");
    frame(&mut drawing);
}

/// Lets all frames go that wait for it, also when a test fails: to destroy it waits for the device.
struct LetGo<'d>(Semaphore<'d>);

impl Drop for LetGo<'_> {
    fn drop(&mut self) {
        self.0.signal(FRAMES + 1);
    }
}

/// Imports something for each frame while as many frames as may be are held back by a semaphore of the program's: to wait for any of them
/// but the oldest would never end. The host keeps no more memory from frame to frame.
fn import_for_each_frame(
    device: &Device,
    executor: &mut Executor,
    mut import: impl FnMut(&mut Executor, u64),
    mut done: impl FnMut(&mut Executor, u64),
) {
    let begin = LetGo(Semaphore::timeline(device));
    let begin = &begin.0;
    let mut draw = |executor: &mut Executor, frame: u64| {
        import(executor, frame);
        // The place of this frame is that of the oldest one, and only that one is let go.
        if let Some(oldest) = frame.checked_sub(IN_FLIGHT) {
            begin.signal(oldest + 1);
            done(executor, oldest);
        }
        let waits = [begin.at(frame + 1)];
        let among = Submission { waits: &waits, ..Submission::default() };
        // SAFETY: the timeline lives until all is waited for, and its values rise.
        unsafe { executor.submit_with(&mut Nothing, &among) }.expect("only the oldest frame is waited for");
    };
    (0..SETTLED).for_each(|frame| draw(executor, frame));
    let device_memory = device.memory_in_use();
    let kept = allocation_counter::measure(|| (SETTLED..FRAMES).for_each(|frame| draw(executor, frame)));
    assert_eq!((kept.count_current, kept.bytes_current), (0, 0), "{kept:?}");
    assert_eq!(device.memory_in_use(), device_memory);
    begin.signal(FRAMES);
    executor.wait(FRAMES - 1).expect("it has ended");
}

#[test]
fn do_11_an_image_is_imported_for_each_frame_and_no_frame_is_waited_for() {
    on_each_driver(|device| {
        let own = [0; 5].map(|_| own_image(device));
        let of = |frame: u64| usize::try_from(frame).expect("it is small") % own.len();
        let given = |frame: u64| [1, 2, 3, 4].map(|at| 10 * u32::try_from(of(frame)).expect("it is small") + at);
        let mut sampling = executor(device, &sampled_from());
        let mut set = executor(device, &sampled_from());
        for frame in 0..5 {
            sampled_before(device, own[of(frame)].0);
            // SAFETY: each is made as the Plan says, and lives until the executors are dropped.
            unsafe { set.import_image("shared", own[of(frame)].0) }.expect("it is external");
            set.write_image("shared", Aspects::COLOR, 0, &to_bytes(&given(frame))).expect("it fits");
        }
        import_for_each_frame(
            device,
            &mut sampling,
            // SAFETY: as above, and the Plan only reads it.
            |executor, frame| unsafe { executor.import_image("shared", own[of(frame)].0) }.expect("it is external"),
            |executor, frame| {
                let seen = executor.read_back_image(frame, 0).expect("it is kept");
                assert_eq!(seen.bytes, to_bytes(&given(frame).map(|value| 2 * value)), "frame {frame}");
            },
        );
        assert_eq!(texels(&mut sampling, "doubled", 0), given(FRAMES - 1).map(|value| 2 * value));
        drop((sampling, set));
        // SAFETY: the executors were dropped.
        own.into_iter().for_each(|image| unsafe { destroy_image(device, image) });
    });
}

#[test]
fn do_11_a_buffer_is_imported_for_each_frame_and_no_frame_is_waited_for() {
    on_each_driver(|device| {
        let own = [0; 4].map(|_| own_buffer(device));
        let of = |frame: u64| usize::try_from(frame).expect("it is small") % own.len();
        let mut increasing = executor(device, &increased());
        for (buffer, _) in own {
            // SAFETY: each is made as the Plan says, and lives until the executor is dropped.
            unsafe { increasing.import_buffer("own", buffer) }.expect("it is external");
            increasing.write_buffer("own", &to_bytes(&[1, 10, 100])).expect("it fits");
        }
        import_for_each_frame(
            device,
            &mut increasing,
            // SAFETY: as above, and nothing else touches it.
            |executor, frame| unsafe { executor.import_buffer("own", own[of(frame)].0) }.expect("it is external"),
            |_, _| {},
        );
        for (frame, (buffer, _)) in (0..).zip(own) {
            // SAFETY: as above.
            unsafe { increasing.import_buffer("own", buffer) }.expect("it is external");
            assert_eq!(words(&mut increasing, "own"), [11, 20, 110], "buffer {frame}");
        }
        drop(increasing);
        // SAFETY: the executor was dropped.
        own.into_iter().for_each(|buffer| unsafe { destroy_buffer(device, buffer) });
    });
}

/// The program has no frames on their way, and changes its mind.
#[test]
fn do_11_imports_without_a_frame_between_them_keep_no_more_memory() {
    on_each_driver(|device| {
        let own = [own_image(device), own_image(device)];
        own.iter().for_each(|(image, _)| sampled_before(device, *image));
        let mut sampling = executor(device, &sampled_from());
        // SAFETY: each is made as the Plan says, and lives until the executor is dropped.
        let mut import = |count: usize| unsafe {
            (0..count).for_each(|number| sampling.import_image("shared", own[number % 2].0).expect("it is external"));
        };
        import(4);
        let kept = allocation_counter::measure(|| import(20));
        assert_eq!((kept.count_current, kept.bytes_current), (0, 0), "{kept:?}");
        let begin = Semaphore::timeline(device);
        let waits = [begin.at(1)];
        // SAFETY: the timeline lives until the frame is waited for.
        let held =
            unsafe { sampling.submit_with(&mut Nothing, &Submission { waits: &waits, ..Submission::default() }) };
        // SAFETY: as above.
        let mut import = |count: usize| unsafe {
            (0..count).for_each(|number| sampling.import_image("shared", own[number % 2].0).expect("it is external"));
        };
        import(4);
        let kept = allocation_counter::measure(|| import(20));
        assert_eq!((kept.count_current, kept.bytes_current), (0, 0), "{kept:?}");
        begin.signal(1);
        sampling.wait(held.expect("a frame")).expect("it ends");
        drop(sampling);
        // SAFETY: the executor was dropped.
        own.into_iter().for_each(|image| unsafe { destroy_image(device, image) });
    });
}
