//! A device that doesn't answer in time, or that is no longer waited for. A test binary of its own: the device is given up with its work unfinished.

mod testing;

use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::DrawInterface;
use framewright_graph::vulkan::{Aspects, Format};
use framewright_vulkan::{DrawSource, Error, Executor, ExecutorOptions, Recorder, SamplerDescriptor, ShaderLibrary};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
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

/// Draws the same triangle very often.
struct Busy;

impl DrawSource for Busy {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        recorder.draw(0..3, 0..300_000);
        Ok(1)
    }
}

#[test]
fn a_frame_that_takes_too_long_is_an_error_and_the_device_is_given_up() {
    let Some(device) = testing::open() else { return };
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let plan = resolve_then_sample(&device, ("white", Draw::Objects(DrawList::Opaque)), "show");
    let options = ExecutorOptions { timeout: Duration::from_millis(1), ..ExecutorOptions::default() };
    let mut executor = Executor::new(&device, &plan, &mut shaders, &options).expect("an executor");
    assert!(matches!(executor.frame(&mut Busy), Err(Error::Timeout { .. })));
    // From then on nothing waits, hangs or crashes.
    assert!(matches!(executor.frame(&mut Busy), Err(Error::DeviceLost { .. })));
    assert!(matches!(executor.submit(&mut Busy), Err(Error::DeviceLost { .. })));
    assert!(executor.wait(0).is_err());
    let lost = |result: Result<(), Error>| matches!(result, Err(Error::DeviceLost { .. } | Error::BadResource { .. }));
    assert!(lost(executor.read(0).map(drop)));
    assert!(lost(executor.read_image("screen", Aspects::COLOR, 0).map(drop)));
    assert!(lost(
        device.texture(1, 1, Format::R8G8B8A8_UNORM, &[0; 4], &SamplerDescriptor::default(), false).map(drop)
    ));
    let mut another = Executor::new(&device, &plan, &mut shaders, &options).expect("only drawing needs the device");
    assert!(matches!(another.frame(&mut Busy), Err(Error::DeviceLost { .. })));
    // Nothing is freed, since the device may still be using it.
    drop((executor, another, device));
}

#[test]
fn a_frame_that_takes_too_long_is_told_with_its_step_when_each_is_waited_for() {
    let Some(device) = testing::open() else { return };
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let plan = resolve_then_sample(&device, ("white", Draw::Objects(DrawList::Opaque)), "show");
    let timeout = Duration::from_millis(1);
    let options = ExecutorOptions { timeout, step_by_step: true, ..ExecutorOptions::default() };
    let mut executor = Executor::new(&device, &plan, &mut shaders, &options).expect("an executor");
    let Err(Error::AtStep { step, error }) = executor.frame(&mut Busy) else { panic!("it is told with its step") };
    assert!(step.starts_with("step 0: ") && matches!(*error, Error::Timeout { .. }), "{step}: {error}");
    drop((executor, device));
}

#[test]
fn a_wait_that_the_program_cancels_is_an_error_and_the_device_is_given_up() {
    let Some(device) = testing::open() else { return };
    let stop = Arc::new(AtomicBool::new(false));
    let asked = stop.clone();
    device.cancel_when(move || asked.load(Ordering::Relaxed));
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let plan = resolve_then_sample(&device, ("white", Draw::Objects(DrawList::Opaque)), "show");
    let mut executor = Executor::new(&device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
    stop.store(true, Ordering::Relaxed);
    assert!(matches!(executor.frame(&mut Busy), Err(Error::Cancelled { .. })));
    assert!(matches!(executor.frame(&mut Busy), Err(Error::DeviceLost { .. })));
    // This process goes on, and its end needs a device that is done.
    stop.store(false, Ordering::Relaxed);
    drop((executor, device));
}
