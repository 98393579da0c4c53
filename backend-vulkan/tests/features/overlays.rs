//! EM-4: frames that are drawn over what a window shows, and over nothing else.

use crate::frames::{Small, Uses, draw, library, planned};
use crate::presenting::{PRESENTED, SHADERS, Window, executor_for, in_windows, options, planned_for};
use crate::testing::Nothing;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Blend, Draw, Frame, Image, Lifetime, Output, Pass, Resource};
use framewright_graph::vulkan::{Aspects, FillValue, Format, Layout, Numeric, State, Subresources};
use framewright_tests::sweep;
use framewright_vulkan::{
    Device, DeviceChoice, DeviceOptions, DrawSource, Error, Executor, ExecutorOptions, Overlay, Presentation, Recorder,
    Swapchain, SwapchainOptions,
};
use std::time::{Duration, Instant};

const EXTENT: [u32; 2] = [64, 48];

/// The upper left corner of the picture that overlays show.
const CORNER: [u32; 2] = [10, 20];

const OVER: &[(&str, &str)] = &[(
    "over.frag",
    "#version 460
    layout(set = 0, binding = 0) uniform sampler2D picture;
    layout(location = 0) out vec4 color;
    void main() {
        ivec2 texel = ivec2(gl_FragCoord.xy) - ivec2(10, 20);
        bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, textureSize(picture, 0)));
        color = inside ? texelFetch(picture, texel, 0) : vec4(0.0);
    }",
)];

/// Draws a picture of this size over an image `screen` that is handed in as it was presented.
fn over(format: Format, [width, height]: [u32; 2], picture: [u32; 2]) -> Frame {
    let mut small = Small::default();
    let is_srgb = format.numeric() == Numeric::Srgb;
    let shown = if is_srgb { Format::R8G8B8A8_SRGB } else { Format::R8G8B8A8_UNORM };
    let lifetime = Lifetime::Persistent { initial: FillValue::Color([0.0; 4]) };
    let picture = Image { lifetime, ..Image::new("picture", shown, picture[0], picture[1]) };
    let picture = small.image_like(picture);
    let lifetime = Lifetime::Imported { before: PRESENTED, after: Some(PRESENTED), owner: None };
    let screen = small.image_like(Image { lifetime, ..Image::new("screen", format, width, height) });
    let pass = draw("over", Draw::FullScreen).samples("picture", picture, Subresources::WHOLE);
    let mut pass = pass.draws(screen, Subresources::WHOLE, None);
    pass.color[0].blend = Blend::Alpha;
    small.pass(pass);
    small.frame.outputs.push(Output { after: Some(PRESENTED), ..Resource::Image(screen).into() });
    small.frame
}

/// An executor of such a frame for the images of a swapchain.
fn overlay_for(device: &Device, swapchain: &Swapchain, picture: [u32; 2]) -> Executor {
    let (format, extent) = (swapchain.format().expect("an area"), swapchain.extent().expect("an area"));
    overlay_of(device, &over(format, extent, picture))
}

fn overlay_of(device: &Device, frame: &Frame) -> Executor {
    let options = ExecutorOptions { frames_in_flight: 2, ..ExecutorOptions::default() };
    let plan = planned(device, frame, &Options::default());
    Executor::new(device, &plan, &mut library(OVER), &options).expect("an executor")
}

/// Texels of one colour.
fn filled([width, height]: [u32; 2], texel: [u8; 4]) -> Vec<u8> {
    texel.repeat((width * height) as usize)
}

fn write(overlay: &mut Executor, texels: &[u8]) {
    overlay.write_image("picture", Aspects::COLOR, 0, texels).expect("it fits");
}

/// Presents a frame, which must be shown.
fn present(executor: &mut Executor, swapchain: &mut Swapchain) -> u64 {
    shown(executor.present(&mut Nothing, swapchain, "screen"))
}

/// The same below an overlay.
fn present_below(executor: &mut Executor, swapchain: &mut Swapchain, overlay: &mut Executor) -> u64 {
    let overlay = Overlay { executor: overlay, source: &mut Nothing, name: "screen" };
    shown(executor.present_with_overlay(&mut Nothing, swapchain, "screen", overlay))
}

fn shown(presented: Result<Presentation, Error>) -> u64 {
    match presented.expect("shown") {
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
        let (extent, [left, top]) = ([6, 4], CORNER);
        let mut overlay = overlay_for(device, &swapchain, extent);
        let mut texels = filled(extent, [200, 100, 50, 255]);
        // The upper left texel is another one, and the lower right one lets the frame through.
        texels[..4].copy_from_slice(&[1, 2, 3, 255]);
        texels[92..].copy_from_slice(&[255, 255, 255, 0]);
        write(&mut overlay, &texels);
        let with = |count, x: u32, y: u32| match (x.wrapping_sub(left), y.wrapping_sub(top)) {
            (0, 0) => [1, 2, 3],
            (5, 3) => frame(count, x),
            (0..6, 0..4) => [200, 100, 50],
            _ => frame(count, x),
        };
        for count in 1..=6 {
            let number = present_below(&mut executor, &mut swapchain, &mut overlay);
            shows(window, EXTENT, |x, y| Some(with(count, x, y)));
            let left = executor.read_back_image(number, 0).expect("it was kept").bytes;
            let swapped = swapchain.format() == Some(Format::B8G8R8A8_UNORM);
            for (x, texel) in (0..EXTENT[0]).cycle().zip(left.chunks_exact(4)) {
                let [red, green, blue] = frame(count, x);
                let expected = if swapped { [blue, green, red, 255] } else { [red, green, blue, 255] };
                assert_eq!(texel, expected, "of frame {count}");
            }
        }
        // Another picture, then none.
        write(&mut overlay, &filled(extent, [255, 255, 255, 128]));
        present_below(&mut executor, &mut swapchain, &mut overlay);
        let is_inside = |x, y| (left..left + 6).contains(&x) && (top..top + 4).contains(&y);
        let blended = |x, y| frame(7, x).map(|below| if is_inside(x, y) { 128 + below / 2 } else { below });
        shows(window, EXTENT, |x, y| Some(blended(x, y)));
        present(&mut executor, &mut swapchain);
        shows(window, EXTENT, |x, _| Some(frame(8, x)));
    });
}

#[test]
fn em_4_an_overlay_has_its_colours_in_windows_of_srgb_and_its_light_is_blended() {
    in_windows(|device, window, surface| {
        let options = SwapchainOptions { extent: EXTENT, ..SwapchainOptions::default() };
        let mut swapchain = Swapchain::new(surface, &options).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let mut overlay = overlay_for(device, &swapchain, [2, 1]);
        write(&mut overlay, &[100, 150, 200, 255, 255, 255, 255, 128]);
        present_below(&mut executor, &mut swapchain, &mut overlay);
        // Half of white's light over nearly none.
        let expected = |x, y| match (x, y) {
            (10, 20) => Some([100, 150, 200]),
            (11, 20) => Some([188, 191, 188]),
            _ => None,
        };
        shows(window, EXTENT, expected);
    });
}

#[test]
fn em_4_frames_under_an_overlay_allocate_nothing_and_many_resizes_take_no_more_memory() {
    let resizes = if sweep::is_long() { 1_000 } else { 200 };
    in_windows(|device, window, surface| {
        let before = device.memory_in_use();
        let mut swapchain = Swapchain::new(surface, &options(EXTENT)).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let mut overlay = overlay_for(device, &swapchain, [20, 20]);
        for frame in 0..60 {
            let counted = allocation_counter::measure(|| {
                present_below(&mut executor, &mut swapchain, &mut overlay);
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
            drop(overlay);
            let mut next = executor_for(device, &swapchain);
            next.migrate_from(executor).expect("the count goes on");
            executor = next;
            // Another picture, and another size of it now and then.
            let picture = [20, 20 + step / 50 % 2];
            overlay = overlay_for(device, &swapchain, picture);
            write(&mut overlay, &filled(picture, [u8::try_from(step % 200).expect("small"), 0, 0, 255]));
            present_below(&mut executor, &mut swapchain, &mut overlay);
            present_below(&mut executor, &mut swapchain, &mut overlay);
            if step % 100 == 99 {
                let now = device.memory_in_use();
                assert_eq!(*settled.get_or_insert(now), now, "step {step}");
            }
        }
        let red = u8::try_from((resizes - 1) % 200).expect("small");
        shows(window, [30, 30], |x, y| (x >= CORNER[0] && y >= CORNER[1]).then_some([red, 0, 0]));
        drop((executor, overlay, swapchain));
        assert_eq!(device.memory_in_use(), before);
    });
}

#[test]
fn overlays_that_cannot_be_drawn_are_refused_before_the_frame_is_drawn() {
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options(EXTENT)).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let format = swapchain.format().expect("an area");
        let right = over(format, EXTENT, [2, 2]);
        let mut unfound = right.clone();
        let undefined = State { layout: Layout::Undefined, ..PRESENTED };
        unfound.images[1].lifetime = Lifetime::Imported { before: undefined, after: Some(PRESENTED), owner: None };
        unfound.passes[0].color[0].clear = Some([0.0; 4]);
        for (frame, name, expected) in [
            (over(format, [64, 50], [2, 2]), "screen", "it has 64x50 texels, and those of the window have 64x48"),
            (unfound, "screen", "the frame doesn't find it as `Present`"),
            (right, "picture", "the Plan has no such image"),
        ] {
            let mut overlay = overlay_of(device, &frame);
            let name = if name == "picture" { "another" } else { name };
            let overlay = Overlay { executor: &mut overlay, source: &mut Nothing, name };
            let refused = executor.present_with_overlay(&mut Nothing, &mut swapchain, "screen", overlay);
            let refused = refused.expect_err("it doesn't fit").to_string();
            assert_eq!(refused, format!("`{name}` can't be shown: {expected}"));
        }
        let refused = overlay_for(device, &swapchain, [2, 2]).present(&mut Nothing, &mut swapchain, "screen");
        let refused = refused.expect_err("nothing lies below it").to_string();
        assert_eq!(refused, "`screen` can't be shown: the frame needs its earlier contents");
        assert_eq!(present(&mut executor, &mut swapchain), 0, "no frame was drawn");
        shows(window, EXTENT, |x, _| Some(frame(1, x)));
    });
}

#[test]
fn executors_that_have_the_images_already_are_refused_in_each_other_s_place() {
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options(EXTENT)).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let mut overlay = overlay_for(device, &swapchain, [2, 2]);
        let mut other = executor_for(device, &swapchain);
        present_below(&mut executor, &mut swapchain, &mut overlay);
        present(&mut other, &mut swapchain);
        let refused = overlay.present(&mut Nothing, &mut swapchain, "screen").expect_err("nothing lies below it");
        assert_eq!(refused.to_string(), "`screen` can't be shown: the frame needs its earlier contents");
        let over = Overlay { executor: &mut other, source: &mut Nothing, name: "screen" };
        let refused = executor.present_with_overlay(&mut Nothing, &mut swapchain, "screen", over);
        let refused = refused.expect_err("nothing would be left of the frame below").to_string();
        assert_eq!(refused, "`screen` can't be shown: the frame doesn't find it as `Present`");
        assert_eq!(present_below(&mut executor, &mut swapchain, &mut overlay), 1, "no frame was drawn");
        shows(window, EXTENT, |x, y| (x < 10 || y < 20).then_some(frame(2, x)));
    });
}

#[test]
fn executors_of_another_device_are_refused_below_an_overlay_and_as_one() {
    in_windows(|device, window, surface| {
        let choice = DeviceChoice::Name(device.summary().name.clone());
        let other = Device::open(&DeviceOptions { choice, ..DeviceOptions::default() }).expect("the driver is there");
        let mut swapchain = Swapchain::new(surface, &options(EXTENT)).expect("a swapchain");
        let (mut executor, mut of_other) = (executor_for(device, &swapchain), executor_for(&other, &swapchain));
        let mut overlay = overlay_for(&other, &swapchain, [2, 2]);
        let overlay = Overlay { executor: &mut overlay, source: &mut Nothing, name: "screen" };
        for refused in [
            of_other.present(&mut Nothing, &mut swapchain, "screen"),
            executor.present_with_overlay(&mut Nothing, &mut swapchain, "screen", overlay),
        ] {
            let refused = refused.expect_err("of another device").to_string();
            assert_eq!(refused, "`screen` can't be shown: the window belongs to another device");
        }
        assert_eq!(present(&mut executor, &mut swapchain), 0, "no frame was drawn");
        shows(window, EXTENT, |x, _| Some(frame(1, x)));
    });
}

/// Draws nothing, or fails.
struct Failing(bool);

impl DrawSource for Failing {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        if self.0 { Err(Error::DrawSource { what: "it gives up".to_owned() }) } else { Ok(0) }
    }
}

#[test]
fn an_image_whose_overlay_failed_is_given_up_and_new_ones_are_shown() {
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options(EXTENT)).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let mut frame_over = over(swapchain.format().expect("an area"), EXTENT, [2, 2]);
        let mut pass = Pass { name: "over by hand".into(), ..draw("over", Draw::Custom) };
        pass.color.clone_from(&frame_over.passes[0].color);
        pass.sampled.clone_from(&frame_over.passes[0].sampled);
        frame_over.passes.push(pass);
        let mut overlay = overlay_of(device, &frame_over);
        let mut present = |fails: bool, swapchain: &mut Swapchain| {
            let overlay = Overlay { executor: &mut overlay, source: &mut Failing(fails), name: "screen" };
            executor.present_with_overlay(&mut Nothing, swapchain, "screen", overlay)
        };
        for _ in 0..5 {
            let failed = present(true, &mut swapchain).expect_err("it gives up");
            assert_eq!(failed.to_string(), "it gives up");
            assert_eq!(present(false, &mut swapchain).expect("no other error"), Presentation::OutOfDate);
            assert!(swapchain.resize([0, 0]).expect("a swapchain"));
        }
        assert_eq!(present(false, &mut swapchain).expect("shown"), Presentation::Shown(5));
        shows(window, EXTENT, |x, _| Some(frame(6, x)));
    });
}
