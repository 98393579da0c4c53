//! Frames that are shown in windows of an X server that nobody sees.

use crate::foreign::{destroy_image, own_image_like};
use crate::frames::{
    Small, Uses, copy, dispatch, draw, library, on_each_driver_for, on_each_driver_with, planned, transfer, words,
};
use crate::testing::{Nothing, findings};
use framewright_graph::base::Span;
use framewright_graph::compile::Options;
use framewright_graph::frame::{
    Buffer, BufferIndex, Draw, Frame, Groups, Image, ImageIndex, Lifetime, Output, Resource, Work,
};
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::{Accesses, FillValue, Format, Layout, Stages, State, Subresources, Usage};
use framewright_tests::sweep;
use framewright_tests::x_server::XServer;
use framewright_vulkan::raw_window_handle::{RawDisplayHandle, XcbDisplayHandle, XcbWindowHandle};
use framewright_vulkan::{
    CustomRecorder, Device, DrawSource, Error, Executor, ExecutorOptions, PresentMode, Presentation, Recorder, Surface,
    Swapchain, SwapchainOptions,
};
use std::ffi::CString;
use std::num::NonZeroU32;
use std::ptr::NonNull;
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConfigureWindowAux, ConnectionExt, CreateWindowAux, ImageFormat, WindowClass};
use x11rb::xcb_ffi::XCBConnection;
use x11rb::{COPY_DEPTH_FROM_PARENT, COPY_FROM_PARENT};

pub(crate) const SHADERS: &[(&str, &str)] = &[
    (
        "count.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) buffer Words { uint word[]; };
        void main() { word[0] += 1; }",
    ),
    (
        "counted.frag",
        "#version 460
        layout(set = 0, binding = 0) readonly buffer Words { uint word[]; };
        layout(location = 0) out vec4 color;
        void main() { color = vec4(word[0] / 255.0, floor(gl_FragCoord.x) / 255.0, 0.0, 1.0); }",
    ),
];

pub(crate) const PRESENTED: State =
    State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::PresentSrcKhr };

/// Counts its frames, and draws the count into the output `screen`.
fn counting(format: Format, [width, height]: [u32; 2], after: Option<State>) -> Frame {
    let mut small = Small::default();
    let lifetime = Lifetime::Persistent { initial: FillValue::Bits([0; 4]) };
    let count = small.buffer_with("count", 1, lifetime);
    let screen = small.image_like(Image::new("screen", format, width, height));
    small.pass(dispatch("count", Groups::Count([1, 1, 1])).block("Words", count, (true, true)));
    let pass = draw("counted", Draw::FullScreen).block("Words", count, (true, false));
    small.pass(pass.draws(screen, Subresources::WHOLE, None));
    small.frame.outputs.push(Output { after, ..Resource::Image(screen).into() });
    small.frame
}

fn executor(device: &Device, plan: &Plan) -> Executor {
    let options = ExecutorOptions { frames_in_flight: 2, ..ExecutorOptions::default() };
    Executor::new(device, plan, &mut library(SHADERS), &options).expect("an executor")
}

/// An executor for the images of a swapchain.
pub(crate) fn executor_for(device: &Device, swapchain: &Swapchain) -> Executor {
    executor(device, &planned_for(device, swapchain))
}

/// A Plan for the images of a swapchain, which counts its frames.
pub(crate) fn planned_for(device: &Device, swapchain: &Swapchain) -> Plan {
    let (format, extent) = (swapchain.format().expect("an area"), swapchain.extent().expect("an area"));
    planned(device, &counting(format, extent, Some(PRESENTED)), &Options::default())
}

/// UNORM formats, so that texels are what the shader says.
pub(crate) fn options(extent: [u32; 2]) -> SwapchainOptions {
    let formats = vec![Format::R8G8B8A8_UNORM, Format::B8G8R8A8_UNORM];
    SwapchainOptions { extent, formats, ..SwapchainOptions::default() }
}

/// A window of an X server.
pub(crate) struct Window {
    connection: XCBConnection,
    screen: usize,
    window: u32,
}

impl Window {
    fn new(server: &XServer, [width, height]: [u16; 2]) -> Window {
        let (connection, screen) =
            XCBConnection::connect(Some(&CString::new(server.display()).expect("a name"))).expect("the server listens");
        let window = connection.generate_id().expect("a number");
        let root = connection.setup().roots[screen].root;
        let (depth, class, visual) = (COPY_DEPTH_FROM_PARENT, WindowClass::INPUT_OUTPUT, COPY_FROM_PARENT);
        let more = CreateWindowAux::new();
        let created = connection.create_window(depth, window, root, 0, 0, width, height, 0, class, visual, &more);
        created.expect("sent").check().expect("a window");
        connection.map_window(window).expect("sent").check().expect("it is shown");
        Window { connection, screen, window }
    }

    pub(crate) fn resize(&self, [width, height]: [u32; 2]) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.connection.configure_window(self.window, &size).expect("sent").check().expect("it has the size");
    }

    fn display(&self) -> RawDisplayHandle {
        let connection = NonNull::new(self.connection.get_raw_xcb_connection());
        XcbDisplayHandle::new(connection, i32::try_from(self.screen).expect("few")).into()
    }

    fn surface(&self, device: &Device) -> Result<Surface, Error> {
        let window = XcbWindowHandle::new(NonZeroU32::new(self.window).expect("a number"));
        // SAFETY: the window outlives the surface, and the device was opened for its display.
        unsafe { device.surface_from_raw(self.display(), window.into()) }
    }

    /// Waits until the window shows the picture of this size with this count.
    pub(crate) fn shows(&self, extent: [u32; 2], count: u32) {
        let expected = [count, extent[0] - 1].map(|component| u8::try_from(component).expect("small"));
        let begun = Instant::now();
        while self.edge(extent) != expected {
            assert!(
                begun.elapsed() < Duration::from_secs(10),
                "{:?} is shown, and not {expected:?}",
                self.edge(extent)
            );
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Red, green and blue of each pixel, row by row, as the server shows them.
    pub(crate) fn pixels(&self, [width, height]: [u32; 2]) -> Vec<[u8; 3]> {
        let [width, height] = [width, height].map(|side| u16::try_from(side).expect("small"));
        let image = self.connection.get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, width, height, u32::MAX);
        let data = image.expect("sent").reply().expect("a picture").data;
        data.chunks_exact(4).map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect()
    }

    /// Red and green of the pixel at the right end of the first row, as the server shows it.
    fn edge(&self, [width, _]: [u32; 2]) -> [u8; 2] {
        let x = i16::try_from(width - 1).expect("small");
        let image = self.connection.get_image(ImageFormat::Z_PIXMAP, self.window, x, 0, 1, 1, u32::MAX);
        let pixel = image.expect("sent").reply().expect("a pixel").data;
        [pixel[2], pixel[1]]
    }
}

/// Runs a test with a window of 64 by 48 pixels on each driver that has surfaces of X.
pub(crate) fn in_windows(test: impl Fn(&Device, &Window, &Surface)) {
    let server = match XServer::start() {
        Ok(server) => server,
        Err(missing) => {
            assert!(std::env::var_os("CI").is_none(), "in CI this is a failure: {missing}");
            return eprintln!("SKIPPED: {missing}");
        }
    };
    let window = Window::new(&server, [64, 48]);
    on_each_driver_for(Some(window.display()), |device| {
        let (name, messages) = (device.summary().name.clone(), device.messages());
        let surface = window.surface(&device).expect("a surface");
        window.resize([64, 48]);
        test(&device, &window, &surface);
        drop((surface, device));
        assert_eq!(findings(&messages), [], "{name}");
    });
}

#[test]
fn frames_are_shown_one_after_the_other() {
    in_windows(|device, window, surface| {
        let extent = [64, 48];
        let mut swapchain = Swapchain::new(surface, &options(extent)).expect("a swapchain");
        assert_eq!(swapchain.extent(), Some(extent));
        let mut executor = executor_for(device, &swapchain);
        for frame in 0..20 {
            let shown = executor.present(&mut Nothing, &mut swapchain, "screen").expect("shown");
            assert_eq!(shown, Presentation::Shown(frame));
        }
        assert_eq!(words(&mut executor, "count"), [20]);
        window.shows(extent, 20);
    });
}

#[test]
fn a_window_is_resized_a_hundred_times_and_each_picture_is_right() {
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options([32, 32])).expect("a swapchain");
        let mut before: Option<Executor> = None;
        let live = device.memory_in_use();
        for step in 0..100 {
            let extent = [20 + step % 40, 30 + step % 7];
            window.resize(extent);
            assert!(swapchain.resize([0, 0]).expect("a swapchain"));
            assert_eq!(swapchain.extent(), Some(extent));
            let mut executor = executor_for(device, &swapchain);
            if let Some(before) = before.take() {
                executor.migrate_from(before).expect("the count goes on");
            }
            for _ in 0..2 {
                let shown = executor.present(&mut Nothing, &mut swapchain, "screen").expect("shown");
                assert!(matches!(shown, Presentation::Shown(_)), "{shown:?}");
            }
            assert_eq!(words(&mut executor, "count"), [2 * (step + 1)]);
            window.shows(extent, 2 * (step + 1));
            before = Some(executor);
        }
        drop(before);
        assert_eq!(device.memory_in_use(), live);
    });
}

#[test]
fn many_frames_with_resizes_take_no_more_memory_and_allocate_nothing_in_between() {
    let frames = if sweep::is_long() { 10_000 } else { 600 };
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options([64, 48])).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let mut settled = None;
        for frame in 1..=frames {
            // Now and then another size, and back.
            if frame % 100 == 0 {
                window.resize([64 + frame / 100 % 2 * 16, 48]);
                assert!(swapchain.resize([0, 0]).expect("a swapchain"));
                let mut next = executor_for(device, &swapchain);
                next.migrate_from(executor).expect("the count goes on");
                executor = next;
            }
            let counted = allocation_counter::measure(|| {
                let shown = executor.present(&mut Nothing, &mut swapchain, "screen").expect("shown");
                assert!(matches!(shown, Presentation::Shown(_)), "{shown:?} at {frame}");
            });
            // By then each image was drawn into, on each place of a frame in flight.
            if frame % 100 > 20 {
                assert_eq!(counted.count_total, 0, "frame {frame}");
            }
            if frame % 200 == 199 {
                let now = device.memory_in_use();
                assert_eq!(*settled.get_or_insert(now), now, "frame {frame}");
            }
        }
        assert_eq!(words(&mut executor, "count"), [frames]);
    });
}

#[test]
fn a_resize_that_would_change_nothing_keeps_the_images() {
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options([64, 48])).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        let mut present = |swapchain: &mut Swapchain| {
            let counted = allocation_counter::measure(|| {
                let shown = executor.present(&mut Nothing, swapchain, "screen").expect("shown");
                assert!(matches!(shown, Presentation::Shown(_)), "{shown:?}");
            });
            counted.count_total
        };
        for _ in 0..20 {
            present(&mut swapchain);
        }
        // An executor takes new images in, which allocates.
        for _ in 0..20 {
            assert!(swapchain.resize([0, 0]).expect("a swapchain"));
            assert_eq!(present(&mut swapchain), 0);
        }
        // Each surface has this mode, or else the one that there is.
        swapchain.set_mode(PresentMode::Immediate);
        assert!(swapchain.resize([0, 0]).expect("a swapchain"));
        let allocated = present(&mut swapchain);
        let other_mode = device.summary().name.contains("llvmpipe");
        assert_eq!(allocated > 0, other_mode, "{allocated}");
        window.resize([80, 48]);
        assert!(swapchain.resize([0, 0]).expect("a swapchain"));
        assert_eq!(swapchain.extent(), Some([80, 48]));
    });
}

#[test]
fn images_are_made_for_what_the_plans_need_that_are_shown() {
    in_windows(|device, window, surface| {
        let extent = [64, 48];
        let mut swapchain = Swapchain::new(surface, &options(extent)).expect("a swapchain");
        let usual = Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC;
        assert_eq!(swapchain.usage(), usual);
        let mut drawn = executor_for(device, &swapchain);
        for frame in 0..3 {
            let shown = drawn.present(&mut Nothing, &mut swapchain, "screen").expect("shown");
            assert_eq!(shown, Presentation::Shown(frame));
        }
        assert_eq!(swapchain.usage(), usual);
        let mut frame = counting(swapchain.format().expect("an area"), extent, Some(PRESENTED));
        let copied = ImageIndex(u32::try_from(frame.images.len()).expect("few"));
        frame.images.push(Image { name: "copied".into(), ..frame.images[0].clone() });
        frame.outputs[0].resource = Resource::Image(copied);
        let sides = [Resource::Image(ImageIndex(0)), Resource::Image(copied)].map(|it| (it, Subresources::WHOLE));
        frame.passes.push(copy("copy", sides[0], sides[1]));
        let mut copies = executor(device, &planned(device, &frame, &Options::default()));
        for frame in 0..3 {
            let shown = copies.present(&mut Nothing, &mut swapchain, "copied").expect("shown");
            assert_eq!(shown, Presentation::Shown(frame));
        }
        window.shows(extent, 3);
        assert_eq!(swapchain.usage(), usual | Usage::TRANSFER_DST);
        // What the first one needs is still allowed.
        let shown = drawn.present(&mut Nothing, &mut swapchain, "screen").expect("shown");
        assert_eq!(shown, Presentation::Shown(3));
        window.shows(extent, 4);
    });
}

#[test]
fn a_window_that_was_resized_says_so_and_a_new_picture_fits_it() {
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options([64, 48])).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        window.resize([80, 48]);
        let said = (0..100).find_map(|_| match executor.present(&mut Nothing, &mut swapchain, "screen") {
            Ok(Presentation::Shown(_)) => None,
            said => Some(said),
        });
        assert!(matches!(said, Some(Ok(Presentation::OutOfDate | Presentation::Suboptimal(_)))), "{said:?}");
        assert!(swapchain.resize([0, 0]).expect("a swapchain"));
        assert_eq!(swapchain.extent(), Some([80, 48]));
        let refused = executor.present(&mut Nothing, &mut swapchain, "screen").expect_err("it is smaller");
        assert!(refused.to_string().contains("it has 64x48 texels"), "{refused}");
        let mut executor = executor_for(device, &swapchain);
        executor.present(&mut Nothing, &mut swapchain, "screen").expect("shown");
        window.shows([80, 48], 1);
    });
}

/// Gives up a custom pass, or fills its buffer.
struct GivesUp(bool);

impl DrawSource for GivesUp {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Ok(0)
    }

    fn custom(&mut self, _: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        if self.0 {
            return Err(Error::DrawSource { what: "it gives up".to_owned() });
        }
        recorder.copy("count", "copied");
        Ok(())
    }
}

#[test]
fn an_image_of_a_frame_that_failed_is_given_up_and_new_ones_are_shown() {
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options([64, 48])).expect("a swapchain");
        let mut frame = counting(swapchain.format().expect("an area"), [64, 48], Some(PRESENTED));
        frame.buffers.push(Buffer { name: "copied".into(), span: Span::NONE, bytes: 4, lifetime: Lifetime::Transient });
        let [count, copied] = [0, 1].map(|index| Resource::Buffer(BufferIndex(index)));
        let sides = [(count, Subresources::WHOLE, false), (copied, Subresources::WHOLE, true)];
        frame.passes.push(transfer("by hand", Work::Custom { callback: "by_hand".into() }, &sides));
        frame.outputs.push(copied.into());
        let mut executor = executor(device, &planned(device, &frame, &Options::default()));
        for _ in 0..10 {
            let failed = executor.present(&mut GivesUp(true), &mut swapchain, "screen").expect_err("it gives up");
            assert_eq!(failed.to_string(), "it gives up");
            let shown = executor.present(&mut GivesUp(false), &mut swapchain, "screen").expect("no other error");
            assert_eq!(shown, Presentation::OutOfDate);
            assert!(swapchain.resize([0, 0]).expect("a swapchain"));
        }
        let shown = executor.present(&mut GivesUp(false), &mut swapchain, "screen").expect("shown");
        assert_eq!(shown, Presentation::Shown(0));
        window.shows([64, 48], 1);
    });
}

#[test]
fn an_image_of_a_window_is_neither_read_nor_drawn_into_behind_its_back() {
    in_windows(|device, window, surface| {
        let mut swapchain = Swapchain::new(surface, &options([64, 48])).expect("a swapchain");
        let mut executor = executor_for(device, &swapchain);
        executor.present(&mut Nothing, &mut swapchain, "screen").expect("shown");
        let refused = executor.read(0).expect_err("it is shown").to_string();
        assert!(refused.starts_with("`screen` can't be read: it is shown in a window"), "{refused}");
        let refused = executor.submit(&mut Nothing).expect_err("it is shown").to_string();
        assert!(refused.starts_with("`screen` is shown in a window"), "{refused}");
        // The program's own image in its place, and then the window's again.
        let (own, memory) = own_image_like(device, swapchain.format().expect("an area"), [64, 48]);
        // SAFETY: the image is made as the Plan says, and outlives the executor.
        unsafe { executor.import_image("screen", own) }.expect("it is external");
        executor.submit(&mut Nothing).expect("a frame");
        executor.present(&mut Nothing, &mut swapchain, "screen").expect("shown");
        window.shows([64, 48], 3);
        drop(executor);
        // SAFETY: the executor was dropped.
        unsafe { destroy_image(device, (own, memory)) };
    });
}

#[test]
fn images_that_do_not_fit_are_refused_by_what_does_not_fit() {
    in_windows(|device, _, surface| {
        let mut swapchain = Swapchain::new(surface, &options([64, 48])).expect("a swapchain");
        let format = swapchain.format().expect("an area");
        let other = Format::R16G16B16A16_SFLOAT;
        for (frame, name, expected) in [
            (
                counting(format, [64, 50], Some(PRESENTED)),
                "screen",
                "it has 64x50 texels, and those of the window have 64x48",
            ),
            (
                counting(other, [64, 48], Some(PRESENTED)),
                "screen",
                "it is R16G16B16A16_SFLOAT, and those of the window are",
            ),
            (counting(format, [64, 48], None), "screen", "the frame doesn't leave it as `Present`"),
            (counting(format, [64, 48], Some(PRESENTED)), "picture", "the Plan has no such image"),
        ] {
            let mut executor = executor(device, &planned(device, &frame, &Options::default()));
            let refused = executor.present(&mut Nothing, &mut swapchain, name).expect_err("it doesn't fit").to_string();
            let expected = format!("`{name}` can't be shown: {expected}");
            assert!(refused.starts_with(&expected), "{refused}");
        }
        let mut executor = executor_for(device, &swapchain);
        let shown = executor.present(&mut Nothing, &mut swapchain, "screen").expect("shown");
        assert_eq!(shown, Presentation::Shown(0), "what was refused has taken no image");
    });
}

#[test]
fn a_device_that_was_opened_for_no_display_shows_nothing() {
    in_windows(|_, window, _| {
        on_each_driver_with(|device| {
            let refused = window.surface(&device).map(drop).expect_err("it wasn't opened for it").to_string();
            let expected = "can't show anything in this window: the device was opened for another display, or for none";
            assert!(refused.ends_with(expected), "{refused}");
        });
    });
}

#[test]
fn a_surface_says_which_formats_it_has() {
    in_windows(|_, _, surface| {
        let wanted = SwapchainOptions { formats: vec![Format::R32_UINT], ..options([8, 8]) };
        let refused = Swapchain::new(surface, &wanted).map(drop).expect_err("no such format").to_string();
        assert!(refused.starts_with("the window has none of the formats R32_UINT; it has "), "{refused}");
        let modes = [PresentMode::Mailbox, PresentMode::Immediate, PresentMode::FifoRelaxed];
        for mode in modes {
            // A mode that isn't there is the one that is always there.
            assert!(Swapchain::new(surface, &SwapchainOptions { mode, ..options([8, 8]) }).is_ok());
        }
    });
}
