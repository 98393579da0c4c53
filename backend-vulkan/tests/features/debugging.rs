//! Ways to execute a Plan that may not change a picture: every step waits for all before it, or is submitted by itself.

use crate::frames::{
    Small, Uses, dispatch, draw, frame, library, on_each_driver, on_each_driver_with, planned, texels,
};
use crate::testing::{Nothing, findings};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame, Groups};
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::ash::vk;
use framewright_vulkan::{Device, Error, Executor, ExecutorOptions, SemaphorePoint};

const SHADERS: &[(&str, &str)] = &[
    (
        "write.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer Words { uint word[]; };
        void main() { word[0] = 7; }",
    ),
    (
        "read.frag",
        "#version 460
        layout(set = 0, binding = 0) readonly buffer Words { uint word[]; };
        layout(location = 0) out uint color;
        void main() { color = word[0]; }",
    ),
];

/// A dispatch writes a buffer that a draw reads.
fn handed_on() -> Frame {
    let mut small = Small::default();
    let words = small.buffer("words", 1);
    let shown = small.image("shown", Format::R32_UINT, [2, 2]);
    small.pass(dispatch("write", Groups::Count([1, 1, 1])).block("Words", words, (false, true)));
    let read = draw("read", Draw::FullScreen).block("Words", words, (true, false));
    small.pass(read.draws(shown, Subresources::WHOLE, None));
    small.image_output(shown);
    small.frame
}

fn executor(device: &Device, plan: &Plan, options: &ExecutorOptions) -> Executor {
    Executor::new(device, plan, &mut library(SHADERS), options).expect("an executor")
}

#[test]
fn full_barriers_stand_in_for_one_that_a_plan_lacks() {
    on_each_driver_with(|device| {
        let mut plan = planned(&device, &handed_on(), &Options::default());
        plan.steps.iter_mut().for_each(|step| step.memory_barriers.clear());
        let heard = |full_barriers| {
            let before = findings(&device.messages()).len();
            let options = ExecutorOptions { full_barriers, ..ExecutorOptions::default() };
            // SAFETY: software drivers execute commands in order.
            let executor = unsafe { Executor::with_hazards(&device, &plan, &mut library(SHADERS), &options) };
            frame(&mut executor.expect("an executor"));
            findings(&device.messages()).len() - before
        };
        assert_eq!(heard(true), 0, "{}", device.summary().name);
        assert!(heard(false) > 0, "{}", device.summary().name);
    });
}

#[test]
fn a_frame_goes_step_by_step_and_into_no_command_buffer_of_the_programs() {
    on_each_driver(|device| {
        let plan = planned(device, &handed_on(), &Options::default());
        for frames_in_flight in [1, 2] {
            let options = ExecutorOptions { step_by_step: true, frames_in_flight, ..ExecutorOptions::default() };
            let mut executor = executor(device, &plan, &options);
            for _ in 0..3 {
                executor.submit(&mut Nothing).expect("a frame");
            }
            assert_eq!(texels(&mut executor, "shown", 0), [7; 4]);
            let (commands, done) = (vk::CommandBuffer::null(), SemaphorePoint::timeline(vk::Semaphore::null(), 1));
            // SAFETY: it is refused before anything is recorded.
            let refused = unsafe { executor.record_into(commands, done, &[], &mut Nothing) };
            let Err(Error::BadPlan { what }) = refused else { panic!("{refused:?}") };
            assert_eq!(what, "it is executed step by step, and a command buffer is submitted at once");
        }
    });
}
