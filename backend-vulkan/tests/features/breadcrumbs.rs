//! Breadcrumbs: the step at which a device stopped is told, without a wait for each (EM-13).

use crate::frames::{
    Custom, Small, Uses, dispatch, library, on_each_driver, on_each_driver_with, planned, transfer, words,
};
use ash::vk;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Groups, Resource, Work};
use framewright_graph::vulkan::Subresources;
use framewright_vulkan::{CustomRecorder, Device, Error, Executor, ExecutorOptions};
use std::time::Duration;

const SQUARES: &[(&str, &str)] = &[(
    "squares.comp",
    "#version 460
    layout(local_size_x = 4) in;
    layout(set = 0, binding = 0) buffer Words { uint word[4]; } words;
    void main() { words.word[gl_LocalInvocationIndex] = gl_LocalInvocationIndex * gl_LocalInvocationIndex; }",
)];

/// An executor of a frame of three steps: a dispatch, a custom pass that reads what it wrote, and a copy of that.
fn executor(device: &Device, timeout: Duration) -> Executor {
    let mut small = Small::default();
    let [squares, b, c] = ["squares", "b", "c"].map(|name| small.buffer(name, 4));
    small.pass(dispatch("squares", Groups::Count([1; 3])).block("words", squares, (false, true)));
    for (name, from, to) in [("by hand", squares, b), ("again", b, c)] {
        let sides =
            [(Resource::Buffer(from), Subresources::WHOLE, false), (Resource::Buffer(to), Subresources::WHOLE, true)];
        small.pass(transfer(name, Work::Custom { callback: name.into() }, &sides));
    }
    small.buffer_output(c);
    let plan = planned(device, &small.frame, &Options::default());
    let options = ExecutorOptions { breadcrumbs: true, timeout, frames_in_flight: 2, ..ExecutorOptions::default() };
    Executor::new(device, &plan, &mut library(SQUARES), &options).expect("an executor")
}

/// Copies what a custom pass reads to what it writes.
fn copy(recorder: &mut CustomRecorder<'_>) {
    let (from, to) = if recorder.pass() == "again" { ("b", "c") } else { ("squares", "b") };
    recorder.copy(from, to);
}

#[test]
fn frames_with_breadcrumbs_are_those_without() {
    on_each_driver(|device| {
        let mut executor = executor(device, Duration::from_secs(120));
        for _ in 0..4 {
            executor.frame(&mut Custom(copy)).expect("a frame");
            assert_eq!(words(&mut executor, "c"), [0, 1, 4, 9]);
        }
    });
}

#[test]
fn the_step_at_which_a_device_stops_is_told() {
    on_each_driver_with(|device| {
        let raw = device.raw().clone();
        // SAFETY: the device lives.
        let event = unsafe { raw.create_event(&vk::EventCreateInfo::default(), None) }.expect("an event");
        let mut executor = executor(&device, Duration::from_secs(2));
        executor.frame(&mut Custom(copy)).expect("a frame");
        // The second frame stops in the second of its steps, until the program sets the event.
        let mut stops = Custom(|recorder: &mut CustomRecorder<'_>| {
            if recorder.pass() == "by hand" {
                let from_host = [vk::MemoryBarrier2::default()
                    .src_stage_mask(vk::PipelineStageFlags2::HOST)
                    .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
                let waited = [vk::DependencyInfo::default().memory_barriers(&from_host)];
                // SAFETY: the command buffer is being recorded outside a scope, and the event lives.
                unsafe { raw.cmd_wait_events2(recorder.raw(), &[event], &waited) };
            }
            copy(recorder);
        });
        executor.submit(&mut stops).expect("it is on its way");
        // One behind it, which doesn't begin: it is the older one's step that is told.
        let behind = executor.submit(&mut Custom(copy)).expect("it is on its way");
        let error = executor.wait(behind).expect_err("it doesn't come");
        // SAFETY: the event lives.
        unsafe { raw.set_event(event) }.expect("set");
        assert!(matches!(executor.frame(&mut Custom(copy)), Err(Error::DeviceLost { .. })), "told once");
        let Error::AtStep { step, error } = error else { panic!("it is told with its step: {error}") };
        assert!(matches!(*error, Error::Timeout { .. }), "{error}");
        assert_eq!(step, "step 1: by hand");
    });
}
