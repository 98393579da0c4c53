//! A device that doesn't answer in time, or that is no longer waited for. A test binary of its own: the device is given up with its work unfinished.

mod testing;

use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::DrawInterface;
use framewright_graph::vulkan::{Aspects, Format};
use framewright_vulkan::{DrawSource, Error, Executor, ExecutorOptions, Recorder, SamplerDescriptor, ShaderLibrary};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use testing::plans::resolve_then_sample;
use testing::{OVER_ALL, WHITE};

const SHADERS: &[(&str, &str)] = &[
    ("full_screen.vert", OVER_ALL),
    ("objects.vert", OVER_ALL),
    ("white.frag", WHITE),
    (
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D source;
        layout(set = 0, binding = 1) uniform Params { bool invert; } params;
        layout(location = 0) out vec4 color;
        void main() { color = texture(source, vec2(params.invert ? 0.5 : 0.0)); }",
    ),
];

/// The time after which a frame is given up.
const SHORT: Duration = Duration::from_millis(1);

/// Draws the same triangle very often.
#[derive(Clone, Copy)]
struct Busy {
    times: u32,
}

impl DrawSource for Busy {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        recorder.draw(0..3, 0..self.times);
        Ok(1)
    }
}

/// As often as keeps this device busy for a hundred times [`SHORT`], or longer.
fn busy() -> Option<Busy> {
    let device = testing::open()?;
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let plan = resolve_then_sample(&device, ("white", Draw::Objects(DrawList::Opaque)), "show");
    let mut executor = Executor::new(&device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
    // The first frame has a driver compile shaders.
    executor.frame(&mut Busy { times: 1 }).expect("a frame");
    let mut busy = Busy { times: 10_000 };
    loop {
        let begun = Instant::now();
        executor.frame(&mut busy).expect("in time");
        if begun.elapsed() >= 100 * SHORT {
            return Some(busy);
        }
        busy.times = busy.times.checked_mul(2).expect("no device is as fast as that");
    }
}

#[test]
fn a_frame_that_takes_too_long_is_an_error_and_the_device_is_given_up() {
    let (Some(mut busy), Some(device)) = (busy(), testing::open()) else { return };
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let plan = resolve_then_sample(&device, ("white", Draw::Objects(DrawList::Opaque)), "show");
    let options = ExecutorOptions { timeout: SHORT, ..ExecutorOptions::default() };
    let mut executor = Executor::new(&device, &plan, &mut shaders, &options).expect("an executor");
    assert!(matches!(executor.frame(&mut busy), Err(Error::Timeout { .. })));
    // From then on nothing waits, hangs or crashes.
    assert!(matches!(executor.frame(&mut busy), Err(Error::DeviceLost { .. })));
    assert!(matches!(executor.submit(&mut busy), Err(Error::DeviceLost { .. })));
    assert!(executor.wait(0).is_err());
    let lost = |result: Result<(), Error>| matches!(result, Err(Error::DeviceLost { .. } | Error::BadResource { .. }));
    assert!(lost(executor.read(0).map(drop)));
    assert!(lost(executor.read_image("screen", Aspects::COLOR, 0).map(drop)));
    assert!(lost(
        device.texture(1, 1, Format::R8G8B8A8_UNORM, &[0; 4], &SamplerDescriptor::default(), false).map(drop)
    ));
    let mut another = Executor::new(&device, &plan, &mut shaders, &options).expect("only drawing needs the device");
    assert!(matches!(another.frame(&mut busy), Err(Error::DeviceLost { .. })));
    // Nothing is freed, since the device may still be using it.
    drop((executor, another, device));
}

#[test]
fn a_frame_that_takes_too_long_is_told_with_its_step_when_each_is_waited_for() {
    let (Some(mut busy), Some(device)) = (busy(), testing::open()) else { return };
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let plan = resolve_then_sample(&device, ("white", Draw::Objects(DrawList::Opaque)), "show");
    let options = ExecutorOptions { timeout: SHORT, step_by_step: true, ..ExecutorOptions::default() };
    let mut executor = Executor::new(&device, &plan, &mut shaders, &options).expect("an executor");
    let Err(Error::AtStep { step, error }) = executor.frame(&mut busy) else { panic!("it is told with its step") };
    assert!(step.starts_with("step 0: ") && matches!(*error, Error::Timeout { .. }), "{step}: {error}");
    drop((executor, device));
}

#[test]
fn a_wait_that_the_program_cancels_is_an_error_and_the_device_is_given_up() {
    let (Some(mut busy), Some(device)) = (busy(), testing::open()) else { return };
    let stop = Arc::new(AtomicBool::new(false));
    let asked = stop.clone();
    device.cancel_when(move || asked.load(Ordering::Relaxed));
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let plan = resolve_then_sample(&device, ("white", Draw::Objects(DrawList::Opaque)), "show");
    let mut executor = Executor::new(&device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
    stop.store(true, Ordering::Relaxed);
    assert!(matches!(executor.frame(&mut busy), Err(Error::Cancelled { .. })));
    assert!(matches!(executor.frame(&mut busy), Err(Error::DeviceLost { .. })));
    // This process goes on, and its end needs a device that is done.
    stop.store(false, Ordering::Relaxed);
    drop((executor, device));
}
