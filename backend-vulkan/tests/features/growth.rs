//! Memory over time: what a frame takes the next one takes again, and everything is given back.

use crate::frames::{Small, Uses, copy, dispatch, draw, frame, library, on_each_driver, planned, words};
use crate::testing::Nothing;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame, Groups, Image, Lifetime, Resource};
use framewright_graph::plan::{Plan, Role, Work};
use framewright_graph::vulkan::{FillValue, Format, Subresources};
use framewright_vulkan::{Device, Error, Executor, ExecutorOptions, MemoryInUse};

const WHOLE: Subresources = Subresources::WHOLE;

const SHADERS: &[(&str, &str)] = &[
    (
        "follow.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D last;
        layout(set = 0, binding = 1) uniform Params { uint step; } params;
        layout(location = 0) out uint color;
        void main() { color = texelFetch(last, ivec2(gl_FragCoord.xy), 0).r + params.step; }",
    ),
    (
        "double.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) readonly buffer From { uint from[]; };
        layout(set = 0, binding = 1) writeonly buffer To { uint to[]; };
        void main() { for (int i = 0; i < 16; ++i) to[i] = 2 * from[i]; }",
    ),
];

/// History three frames deep, a transient image and two buffers.
fn busy() -> Frame {
    let mut small = Small::default();
    let lifetime = Lifetime::History { frames: 3, initial: FillValue::Bits([1, 0, 0, 0]) };
    let kept = small.image_like(Image { lifetime, ..Image::new("kept", Format::R32_UINT, 4, 4) });
    let passing = small.image("passing", Format::R32_UINT, [4, 4]);
    let [rows, doubled] = [small.buffer("rows", 16), small.buffer("doubled", 16)];
    let mut follow = draw("follow", Draw::FullScreen).samples_earlier("last", kept, 3).draws(kept, WHOLE, None);
    follow.params.push(("step".into(), framewright_graph::frame::ParamValue::Integer(5)));
    small.pass(follow);
    small.pass(copy("on", (Resource::Image(kept), WHOLE), (Resource::Image(passing), WHOLE)));
    small.pass(copy("to rows", (Resource::Image(passing), WHOLE), (Resource::Buffer(rows), WHOLE)));
    let pass = dispatch("double", Groups::Count([1, 1, 1])).block("From", rows, (true, false));
    small.pass(pass.block("To", doubled, (false, true)));
    small.buffer_output(doubled);
    small.frame
}

fn executor(device: &Device, plan: &Plan, options: &ExecutorOptions) -> Executor {
    Executor::new(device, plan, &mut library(SHADERS), options).expect("an executor")
}

#[test]
fn frame_after_frame_takes_no_more_memory() {
    on_each_driver(|device| {
        let nothing = device.memory_in_use();
        assert_eq!((nothing.allocations, nothing.bytes), (0, 0));
        let plan = planned(device, &busy(), &Options { poison: true, ..Options::default() });
        let options =
            ExecutorOptions { poison: true, frames_in_flight: 2, readback: true, ..ExecutorOptions::default() };
        let mut executor = executor(device, &plan, &options);
        let mut run = |frames: u32| -> MemoryInUse {
            for _ in 0..frames {
                executor.submit(&mut Nothing).expect("a frame");
            }
            device.memory_in_use()
        };
        // Each frame in flight has had every place of the history once.
        let settled = run(8);
        assert!(settled.bytes > 0);
        assert_eq!(run(40), settled);
        assert_eq!(
            words(&mut executor, "doubled"),
            [2 * (1 + 5 * 16); 16],
            "every third frame goes on from the one before"
        );
        drop(executor);
        let left = device.memory_in_use();
        assert_eq!((left.allocations, left.bytes), (0, 0));
    });
}

#[test]
fn executors_come_and_go_in_the_same_memory() {
    on_each_driver(|device| {
        let plan = planned(device, &busy(), &Options::default());
        let mut reserved = Vec::new();
        for _ in 0..4 {
            let mut executor = executor(device, &plan, &ExecutorOptions::default());
            frame(&mut executor);
            reserved.push(device.memory_in_use());
        }
        assert!(reserved.iter().all(|it| *it == reserved[0]), "{reserved:?}");
    });
}

#[test]
fn a_plan_that_takes_more_memory_than_there_is_is_refused_in_numbers() {
    on_each_driver(|device| {
        let mut plan = planned(device, &busy(), &Options::default());
        plan.heaps.iter_mut().for_each(|heap| heap.bytes = 1 << 50);
        plan.totals.placed_bytes = plan.heaps.iter().map(|heap| heap.bytes).sum();
        let refused = Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default());
        match refused.err() {
            Some(Error::OutOfMemory { what, bytes, parts, reason }) => {
                let images = plan.images.iter().map(|image| &image.name);
                let names: Vec<_> = images.chain(plan.buffers.iter().map(|buffer| &buffer.name)).collect();
                assert!(!parts.is_empty() && parts.iter().all(|(name, _)| names.iter().any(|it| ***it == **name)));
                let is_kept = |name: &str| {
                    let image = plan.images.iter().find(|image| *image.name == *name).map(|image| &image.role);
                    let buffer = plan.buffers.iter().find(|buffer| *buffer.name == *name).map(|buffer| &buffer.role);
                    !matches!(image.or(buffer), Some(Role::Transient(_)))
                };
                let kept: u64 = parts.iter().filter(|(name, _)| is_kept(name)).map(|(_, bytes)| *bytes).sum();
                assert_eq!((what.as_str(), bytes), ("the Plan", plan.totals.placed_bytes + kept));
                assert!(reason.starts_with("the device has "), "{reason}");
            }
            other => panic!("{other:?}"),
        }
        assert_eq!(device.memory_in_use().allocations, 0, "what was made before is given back");
    });
}

#[test]
fn a_plan_whose_json_was_edited_by_hand_is_checked_before_it_runs() {
    on_each_driver(|device| {
        let plan = planned(device, &busy(), &Options::default());
        let refusal = |plan: &Plan| {
            let text = plan.to_json().expect("finite numbers");
            let plan = Plan::from_json(&text).expect("its form is right");
            let refused = Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default());
            refused.err().map(|error| error.to_string()).unwrap_or_default()
        };
        assert_eq!(refusal(&plan), "");

        let mut edited = plan.clone();
        let copied = edited.steps.iter_mut().rfind(|step| matches!(step.work, Work::Copy(_)));
        copied.expect("two copies").image_barriers.clear();
        let said = refusal(&edited);
        assert!(said.starts_with("the Plan is wrong: ") && said.contains("passing"), "{said}");

        let mut edited = plan.clone();
        let places = edited.buffers.iter_mut().find_map(|buffer| match &mut buffer.role {
            Role::Transient(place) => Some(place),
            Role::Persistent { .. } | Role::External { .. } => None,
        });
        places.expect("`rows` is transient").offset += 1;
        let said = refusal(&edited);
        assert!(said.starts_with("the Plan is wrong: ") && said.contains("rows"), "{said}");
    });
}
