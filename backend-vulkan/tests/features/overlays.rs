//! EM-4: pictures that are laid over what a window shows, and over nothing else.

use crate::frames::library;
use crate::presenting::{SHADERS, Window, executor_for, in_windows, options, planned_for};
use crate::testing::Nothing;
use framewright_graph::vulkan::Format;
use framewright_tests::sweep;
use framewright_vulkan::{Device, Executor, ExecutorOptions, Overlay, Presentation, Swapchain, SwapchainOptions};
use std::time::{Duration, Instant};

const EXTENT: [u32; 2] = [64, 48];

/// Texels of one colour.
fn filled([width, height]: [u32; 2], texel: [u8; 4]) -> Vec<u8> {
    texel.repeat((width * height) as usize)
}

/// Presents a frame, which must be shown.
fn present(executor: &mut Executor, swapchain: &mut Swapchain) -> u64 {
    match executor.present(&mut Nothing, swapchain, "screen").expect("shown") {
        Presentation::Shown(frame) => frame,
        other => panic!("{other:?}"),
    }
}

/// Waits until the window has these pixels. `expected` has one for each place; `None` means any.
fn shows(window: &Window, [width, height]: [u32; 2], expected: impl Fn(u32, u32) -> Option<[u8; 3]>) {
    let begun = Instant::now();
    loop {
        let pixels = window.pixels([width, height]);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let wrong = places.zip(&pixels).find_map(|([x, y], pixel)| {
            let near = |expected: [u8; 3]| expected.iter().zip(pixel).all(|(one, other)| one.abs_diff(*other) <= 1);
            let expected = expected(x, y)?;
            (!near(expected)).then(|| format!("{pixel:?} at {x}, {y}, and not {expected:?}"))
        });
        let Some(wrong) = wrong else { return };
        assert!(begun.elapsed() < Duration::from_secs(10), "{wrong}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The pixel of a frame that counts itself.
fn frame(count: u64, x: u32) -> [u8; 3] {
    [u8::try_from(count).expect("small"), u8::try_from(x).expect("small"), 0]
}

#[test]
fn em_4_an_overlay_is_in_the_window_and_not_in_what_the_frame_leaves() {
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options(EXTENT)).expect("a swapchain");
        let plan = planned_for(device, &swapchain);
        let kept = ExecutorOptions { frames_in_flight: 2, readback: true, ..ExecutorOptions::default() };
        let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &kept).expect("an executor");
        let (extent, mut texels) = ([6, 4], filled([6, 4], [200, 100, 50, 255]));
        // The upper left texel is another one, and the lower right one lets the frame through.
        texels[..4].copy_from_slice(&[1, 2, 3, 255]);
        texels[92..].copy_from_slice(&[255, 255, 255, 0]);
        let with = |count, x: u32, y: u32| match (x.wrapping_sub(10), y.wrapping_sub(20)) {
            (0, 0) => [1, 2, 3],
            (5, 3) => frame(count, x),
            (0..6, 0..4) => [200, 100, 50],
            _ => frame(count, x),
        };
        for count in 1..=6 {
            let overlay = Overlay { extent, offset: [10, 20], texels: &texels };
            // It stays until another one takes its place.
            if count == 1 {
                swapchain.set_overlay(Some(&overlay)).expect("an overlay");
            }
            let number = present(&mut executor, &mut swapchain);
            shows(window, EXTENT, |x, y| Some(with(count, x, y)));
            let left = executor.read_back_image(number, 0).expect("it was kept").bytes;
            let swapped = swapchain.format() == Some(Format::B8G8R8A8_UNORM);
            for (x, texel) in (0..EXTENT[0]).cycle().zip(left.chunks_exact(4)) {
                let [red, green, blue] = frame(count, x);
                let expected = if swapped { [blue, green, red, 255] } else { [red, green, blue, 255] };
                assert_eq!(texel, expected, "of frame {count}");
            }
        }
        // Partly outside of the window, then another one, then none.
        swapchain.set_overlay(Some(&Overlay { extent, offset: [-5, -2], texels: &texels })).expect("an overlay");
        present(&mut executor, &mut swapchain);
        let inside = |x, y| match (x, y) {
            (0, 0) => [200, 100, 50],
            _ => frame(7, x),
        };
        shows(window, EXTENT, |x, y| Some(inside(x, y)));
        let half = filled([64, 2], [255, 255, 255, 128]);
        swapchain.set_overlay(Some(&Overlay { extent: [64, 2], offset: [0, 46], texels: &half })).expect("an overlay");
        present(&mut executor, &mut swapchain);
        let blended = |x, y| frame(8, x).map(|below| if y < 46 { below } else { 128 + below / 2 });
        shows(window, EXTENT, |x, y| Some(blended(x, y)));
        swapchain.set_overlay(None).expect("none");
        present(&mut executor, &mut swapchain);
        shows(window, EXTENT, |x, _| Some(frame(9, x)));
    });
}

#[test]
fn em_4_an_overlay_has_its_colours_in_windows_of_srgb_and_its_light_is_blended() {
    in_windows(|device, window, surface| {
        let options = SwapchainOptions { extent: EXTENT, ..SwapchainOptions::default() };
        let mut swapchain = Swapchain::new(surface, &options).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let mut texels = filled([2, 1], [100, 150, 200, 255]);
        texels[4..].copy_from_slice(&[255, 255, 255, 128]);
        swapchain.set_overlay(Some(&Overlay { extent: [2, 1], offset: [0, 0], texels: &texels })).expect("an overlay");
        present(&mut executor, &mut swapchain);
        // Half of white's light over nearly none.
        let expected = |x, y| match (x, y) {
            (0, 0) => Some([100, 150, 200]),
            (1, 0) => Some([188; 3]),
            _ => None,
        };
        shows(window, EXTENT, expected);
    });
}

#[test]
fn em_4_frames_under_an_overlay_allocate_nothing_until_it_changes_and_many_resizes_take_no_more_memory() {
    let resizes = if sweep::is_long() { 1_000 } else { 200 };
    in_windows(|device, window, surface| {
        let before = device.memory_in_use();
        let mut swapchain = Swapchain::new(surface, &options(EXTENT)).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let texels = filled([20, 20], [0, 0, 0, 200]);
        let overlay = Overlay { extent: [20, 20], offset: [2, 2], texels: &texels };
        for frame in 0..60 {
            let counted = allocation_counter::measure(|| {
                // The same texels are sent once.
                swapchain.set_overlay(Some(&Overlay { offset: [frame % 7, 2], ..overlay })).expect("an overlay");
                present(&mut executor, &mut swapchain);
            });
            if frame > 20 {
                assert_eq!(counted.count_total, 0, "frame {frame}");
            }
        }
        let mut settled = None;
        for step in 0..resizes {
            let extent = [30 + step % 30, 30 + step % 7];
            window.resize(extent);
            assert!(swapchain.resize([0, 0]).expect("a swapchain"));
            let mut next = executor_for(device, &swapchain);
            next.migrate_from(executor).expect("the count goes on");
            executor = next;
            // Another picture, and another size of it now and then.
            let texels = filled([20, 20 + step / 50 % 2], [u8::try_from(step % 200).expect("small"), 0, 0, 255]);
            let overlay = Overlay { extent: [20, 20 + step / 50 % 2], offset: [2, 2], texels: &texels };
            swapchain.set_overlay(Some(&overlay)).expect("an overlay");
            present(&mut executor, &mut swapchain);
            present(&mut executor, &mut swapchain);
            if step % 100 == 99 {
                let now = device.memory_in_use();
                assert_eq!(*settled.get_or_insert(now), now, "step {step}");
            }
        }
        let red = u8::try_from((resizes - 1) % 200).expect("small");
        shows(window, [22, 22], |x, y| (x >= 2 && y >= 2).then_some([red, 0, 0]));
        swapchain.set_overlay(None).expect("none");
        present(&mut executor, &mut swapchain);
        drop((executor, swapchain));
        assert_eq!(device.memory_in_use(), before);
    });
}

#[test]
fn overlays_that_cannot_be_drawn_are_refused_and_the_one_before_stays() {
    in_windows(|device: &Device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options(EXTENT)).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let texels = filled([2, 2], [7, 8, 9, 255]);
        swapchain.set_overlay(Some(&Overlay { extent: [2, 2], offset: [0, 0], texels: &texels })).expect("an overlay");
        for (extent, expected) in [
            ([0, 2], "overlay of 0 × 2: both must be from 1 to "),
            ([2, 1 << 20], "overlay of 2 × 1048576: both must be from 1 to "),
            ([2, 3], "overlay of 2 × 3: 16 bytes were given, 24 are needed"),
        ] {
            let refused = swapchain.set_overlay(Some(&Overlay { extent, offset: [0, 0], texels: &texels }));
            let refused = refused.expect_err("it can't be drawn").to_string();
            assert!(refused.starts_with(expected), "{refused}");
        }
        present(&mut executor, &mut swapchain);
        shows(window, EXTENT, |x, y| Some(if x < 2 && y < 2 { [7, 8, 9] } else { frame(1, x) }));
    });
}
