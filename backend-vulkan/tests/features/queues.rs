//! Plans for several queues on devices that have one.

use crate::frames::{Small, Uses, dispatch, draw, frame, library, on_each_driver, planned, texels, words};
use crate::testing::Nothing;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{Profile, Queues};
use framewright_graph::frame::{Cadence, Draw, Frame, Groups, ImageIndex, Pass};
use framewright_graph::plan::{Plan, Queue, StepId, Totals, Wait};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Format, Sharing, Stages, Subresources};
use framewright_vulkan::{Device, Executor, ExecutorOptions};

const ONE: Groups = Groups::Count([1, 1, 1]);

const SHADERS: &[(&str, &str)] = &[
    (
        "number.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0, r32ui) uniform writeonly uimage2D image;
        layout(set = 0, binding = 1) writeonly buffer Words { uint word[]; };
        void main() {
            imageStore(image, ivec2(0), uvec4(20));
            for (int i = 0; i < 3; ++i) word[i] = i + 1;
        }",
    ),
    (
        "place.frag",
        "#version 460
        layout(location = 0) out uint color;
        void main() { color = uint(gl_FragCoord.x) + 100 * uint(gl_FragCoord.y); }",
    ),
    (
        "next.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(location = 0) out uint color;
        void main() { color = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r + 1; }",
    ),
    (
        "both.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(set = 0, binding = 1) readonly buffer Words { uint word[]; };
        layout(location = 0) out uint color;
        void main() { color = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r + word[2]; }",
    ),
    (
        "all.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(set = 0, binding = 1) readonly buffer Words { uint word[]; };
        layout(set = 0, binding = 2) uniform usampler2D image;
        layout(location = 0) out uint color;
        void main() {
            color = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r + word[2] + 1000 * texelFetch(image, ivec2(0), 0).r;
        }",
    ),
    (
        "multiply.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0, r32ui) uniform readonly uimage2D image;
        layout(set = 0, binding = 1) readonly buffer From { uint from[]; };
        layout(set = 0, binding = 2) writeonly buffer To { uint to[]; };
        void main() { for (int i = 0; i < 3; ++i) to[i] = from[i] * imageLoad(image, ivec2(0)).r; }",
    ),
];

/// A dispatch on the graphics queue writes an image and a buffer, from which one on the compute queue makes another
/// buffer; everything is shared. The next frame's first dispatch waits for the second.
fn on_two_queues(device: &Device) -> Plan {
    let mut small = Small::default();
    let image = small.image("i", Format::R32_UINT, [1, 1]);
    let [from, to] = [small.buffer("from", 3), small.buffer("to", 3)];
    let pass = dispatch("number", ONE).stores("image", image, Subresources::WHOLE);
    small.pass(pass.block("Words", from, (false, true)));
    let pass = dispatch("multiply", ONE).loads("image", image, Subresources::WHOLE);
    small.pass(pass.block("From", from, (true, false)).block("To", to, (false, true)));
    small.buffer_output(to);
    let mut plan = planned(device, &small.frame, &Options::default());
    let [first, second] =
        [0, 1].map(|step| Wait { step: StepId(step), frames_ago: 1 - step, stages: Stages::COMPUTE_SHADER });
    plan.steps[0].waits = vec![Wait { frames_ago: 1, ..second }];
    plan.steps[1].waits = vec![Wait { frames_ago: 0, ..first }];
    plan.steps[1].queue = Queue::Compute;
    plan.steps[1].image_barriers.clear();
    plan.images.iter_mut().for_each(|image| image.sharing = Sharing::Concurrent);
    plan.buffers.iter_mut().for_each(|buffer| buffer.sharing = Sharing::Concurrent);
    plan.totals = Totals { ..counted(&plan) };
    plan
}

fn counted(plan: &Plan) -> Totals {
    let Totals { transient_bytes, placed_bytes, live_peak_bytes, .. } = plan.totals;
    Totals { transient_bytes, placed_bytes, live_peak_bytes, ..Totals::count(&plan.steps) }
}

#[test]
fn a_device_with_one_queue_runs_a_plan_for_two() {
    on_each_driver(|device| {
        let plan = on_two_queues(device);
        let violations = verify(&plan);
        assert!(violations.is_empty(), "{violations:?}\n{}", plan.tree());
        for frames_in_flight in [1, 3] {
            let options = ExecutorOptions { frames_in_flight, ..ExecutorOptions::default() };
            let mut executor = Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor");
            for _ in 0..5 {
                frame(&mut executor);
            }
            assert_eq!(words(&mut executor, "to"), [20, 40, 60]);
        }
    });
}

/// A chain of dispatches runs beside draws that are many texels large; at the end a pass reads what both made.
fn beside() -> Frame {
    let (mut small, last, _) = nearly_beside();
    small.pass(last("both"));
    small.frame
}

/// The same, and the last pass samples an image that a dispatch made too.
fn handed_over() -> Frame {
    let (mut small, last, image) = nearly_beside();
    small.pass(last("all").samples("image", image, Subresources::WHOLE));
    small.frame
}

/// All but the last pass, the last pass by the name of its shader, and an image that dispatches use.
fn nearly_beside() -> (Small, impl Fn(&str) -> Pass, ImageIndex) {
    let mut small = Small::default();
    let image = small.image("i", Format::R32_UINT, [1, 1]);
    let [from, to] = [small.buffer("from", 3), small.buffer("to", 3)];
    let [large, larger, shown] = [("large", 64), ("larger", 64), ("shown", 4)]
        .map(|(name, side)| small.image(name, Format::R32_UINT, [side, side]));
    let pass = dispatch("number", ONE).stores("image", image, Subresources::WHOLE);
    small.pass(pass.block("Words", from, (false, true)));
    small.pass(draw("place", Draw::FullScreen).draws(large, Subresources::WHOLE, None));
    let pass = draw("next", Draw::FullScreen).samples("source", large, Subresources::WHOLE);
    small.pass(pass.draws(larger, Subresources::WHOLE, None));
    let pass = dispatch("multiply", ONE).loads("image", image, Subresources::WHOLE);
    small.pass(pass.block("From", from, (true, false)).block("To", to, (false, true)));
    small.image_output(shown);
    let last = move |shader: &str| {
        let pass = draw(shader, Draw::FullScreen).samples("source", larger, Subresources::WHOLE);
        pass.block("Words", to, (true, false)).draws(shown, Subresources::WHOLE, None)
    };
    (small, last, image)
}

/// An executor of [`beside`], compiled for a device that shares between its three queues.
pub(crate) fn executor_beside(device: &Device, frames_in_flight: u32) -> Executor {
    executor_of(device, &beside(), Sharing::Concurrent, frames_in_flight)
}

/// An executor of a frame that is compiled for three queues, and uses two.
fn executor_of(device: &Device, frame: &Frame, sharing: Sharing, frames_in_flight: u32) -> Executor {
    let queues = Queues { compute: true, transfer: true, sharing, wait_bytes: 0 };
    let profile = Profile { queues, ..device.profile() };
    let plan = compile(frame, &profile, &mut device.memory(), &Options::default());
    let plan = plan.unwrap_or_else(|errors| panic!("{errors:?}"));
    assert!(plan.steps.iter().any(|step| step.queue == Queue::Compute), "{}", plan.tree());
    let options = ExecutorOptions { frames_in_flight, ..ExecutorOptions::default() };
    Executor::new(device, &plan, &mut library(SHADERS), &options).expect("an executor")
}

/// The texels of its image `shown`.
pub(crate) fn drawn_beside() -> Vec<u32> {
    (0..16).map(|at| at % 4 + 100 * (at / 4) + 1 + 60).collect()
}

#[test]
fn a_device_with_one_queue_runs_what_was_compiled_for_one_that_shares_between_three() {
    on_each_driver(|device| {
        let mut executor = executor_beside(device, 2);
        for _ in 0..4 {
            executor.submit(&mut Nothing).expect("a frame");
        }
        assert_eq!(texels(&mut executor, "shown", 0), drawn_beside());
    });
}

#[test]
fn a_device_with_one_queue_runs_what_was_compiled_for_one_that_hands_images_over() {
    on_each_driver(|device| {
        let mut executor = executor_of(device, &handed_over(), Sharing::Exclusive, 2);
        let handed_over = |step: &framewright_graph::plan::Step| !step.releases.is_empty();
        assert!(executor.plan().steps.iter().any(handed_over), "{}", executor.plan().tree());
        for _ in 0..4 {
            executor.submit(&mut Nothing).expect("a frame");
        }
        let expected: Vec<u32> = drawn_beside().iter().map(|texel| texel + 20_000).collect();
        assert_eq!(texels(&mut executor, "shown", 0), expected);
    });
}

/// What doesn't run in every frame stays on the queue for graphics; steps of other queues go on beside it when it is left out (DO-9).
#[test]
fn do_9_queues_wait_and_hand_over_when_a_step_is_left_out() {
    let runs = [Cadence::Always, Cadence::Every { count: 3, at: 1 }];
    on_each_driver(|device| {
        for (mut frame, sharing, more) in
            [(beside(), Sharing::Concurrent, 0), (handed_over(), Sharing::Exclusive, 20_000)]
        {
            frame.passes.iter_mut().zip(&runs).for_each(|(pass, run)| pass.run = run.clone());
            for frames_in_flight in [1, 3] {
                let mut executor = executor_of(device, &frame, sharing, frames_in_flight);
                let expected: Vec<u32> = drawn_beside().iter().map(|texel| texel + more).collect();
                for number in 0..7 {
                    executor.submit(&mut Nothing).expect("a frame");
                    if frames_in_flight == 1 || number == 6 {
                        assert_eq!(texels(&mut executor, "shown", 0), expected, "frame {number}");
                    }
                }
            }
        }
    });
}
