//! Plans of the compiler are accepted, and none of their barriers can be left out.

use crate::testing::graphs;
use crate::testing::hand_written_plans::names_all;
use crate::testing::raster::{self, Raster, forward};
use crate::verify::accepts::accept;
use crate::verify::mutations::without_a_barrier;
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::frame::{Blend, Frame};
use framewright_graph::plan::{Plan, Work};
use framewright_graph::verify::{Loss, Rule, Violation, verify};
use framewright_graph::vulkan::Format::{D24_UNORM_S8_UINT, D32_SFLOAT, R8G8B8A8_SRGB, R16G16B16A16_SFLOAT, R32_UINT};
use framewright_graph::vulkan::{Aspects, Layout, LoadOp, Stages};

fn options() -> [Options; 5] {
    let with = |alias, poison| Options { alias, poison, ..Options::default() };
    let low = Options { order: Order::LowMemory, ..Options::default() };
    [with(true, false), with(false, false), with(true, true), with(false, true), low]
}

fn compiled(frame: &Frame, device: &Profile, options: &Options) -> Plan {
    compile(frame, device, &mut MemoryEstimate(device), options).expect("the frame is valid")
}

/// Two versions of a multisampled image, each read by others; two outputs.
fn resolved_twice(samples: u32) -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", R16G16B16A16_SFLOAT, samples);
    let [a, b, screen] = ["a", "b", "screen"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("opaque").clear(color);
    raster.full_screen("first").sample(color).color(a, Blend::Replace);
    raster.full_screen("second").sample(color).color(b, Blend::Replace);
    raster.objects("glass").color(color, Blend::Alpha);
    raster.full_screen("last").sample(color).sample(a).sample(b).color(screen, Blend::Replace);
    raster.outputs(&[screen, a])
}

/// Depth that is written, sampled, then tested and sampled at once.
fn depth_sampled(samples: u32, format: framewright_graph::vulkan::Format) -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, samples);
    let depth = raster.image("depth", format, samples);
    let screen = raster.image("screen", R8G8B8A8_SRGB, samples);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.full_screen("fog").sample(depth).sample(color).color(screen, Blend::Replace);
    raster.objects("glass").color(screen, Blend::Alpha).test_depth(depth);
    raster.objects("soft").sample(depth).color(screen, Blend::Premultiplied).test_depth(depth);
    let mut frame = raster.output(screen);
    let sampled = frame.passes.iter_mut().flat_map(|pass| &mut pass.sampled).filter(|sampled| sampled.image == depth);
    sampled.for_each(|sampled| sampled.range.aspects = Aspects::DEPTH);
    frame
}

/// Draws that sample what they draw into, and an image that is read after it was forwarded.
fn feedback(samples: u32) -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, samples);
    let [screen, second] = ["screen", "second"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("opaque").clear(color);
    raster.full_screen("blur").sample(color).color(color, Blend::Replace);
    raster.full_screen("haze").sample(color).color(color, Blend::Alpha);
    raster.forward("tonemap", color, screen);
    raster.objects("interface").color(screen, Blend::Alpha);
    raster.full_screen("preview").sample(color).color(second, Blend::Replace);
    raster.outputs(&[screen, second])
}

fn integers() -> Frame {
    let mut raster = Raster::default();
    let ids = raster.image("ids", R32_UINT, 4);
    raster.objects("opaque").clear(ids);
    raster.output(ids)
}

fn frames() -> Vec<(String, Frame, Profile)> {
    let mut frames = Vec::new();
    for samples in [1, 4] {
        for (hdr, tone_mapping) in [(true, true), (true, false), (false, true), (false, false)] {
            let name = format!("forward {samples} {hdr} {tone_mapping}");
            frames.push((name, forward(samples, hdr, tone_mapping), raster::device()));
        }
        frames.push((format!("resolved twice {samples}"), resolved_twice(samples), raster::device()));
        frames.push((format!("feedback {samples}"), feedback(samples), raster::device()));
    }
    for format in [D32_SFLOAT, D24_UNORM_S8_UINT] {
        frames.push((format!("depth sampled {format}"), depth_sampled(1, format), raster::device()));
    }
    frames.push(("integers".to_owned(), integers(), raster::device()));
    let graphs = [("chain", graphs::chain(25)), ("wide", graphs::wide(40)), ("local", graphs::local(40))];
    frames.extend(graphs.map(|(name, frame)| (name.to_owned(), frame, graphs::device())));
    frames.push(("deferred".to_owned(), graphs::deferred(), graphs::device()));
    frames
}

#[test]
fn compiled_plans_are_accepted() {
    for (name, frame, device) in frames() {
        for options in options() {
            accept(&format!("{name} {options:?}"), &compiled(&frame, &device, &options));
        }
    }
}

#[test]
fn every_barrier_that_is_removed_from_a_compiled_plan_is_caught() {
    let (mut caught, mut missed) = (0, Vec::new());
    for (name, frame, device) in frames() {
        for mutant in without_a_barrier(&compiled(&frame, &device, &Options::default())) {
            let violations = verify(&mutant.plan);
            if violations.iter().any(names_all) {
                caught += 1;
            } else {
                let said: Vec<String> = violations.iter().map(ToString::to_string).collect();
                missed.push(format!("{name}: {} {said:?}", mutant.change));
            }
        }
    }
    println!("caught {caught}, missed {}", missed.len());
    assert!(caught > 200, "{caught}");
    assert!(missed.is_empty(), "missed:\n{}", missed.join("\n"));
}

/// A compiler that takes a draw for one that covers would forget what is there and not load it: both at once.
#[test]
fn contents_that_are_forgotten_and_not_loaded_are_missed() {
    let mut raster = Raster::default();
    let [color, second] = ["color", "second"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("opaque").clear(color);
    raster.full_screen("preview").sample(color).color(second, Blend::Replace);
    raster.objects("sky").color(color, Blend::Replace);
    let mut plan = compiled(&raster.outputs(&[color, second]), &raster::device(), &Options::default());
    let Work::Render(scope) = &mut plan.steps[2].work else { panic!("{}", plan.tree()) };
    scope.attachments[0].load = LoadOp::DontCare;
    let image = scope.attachments[0].image;
    for barrier in plan.steps[2].image_barriers.iter_mut().filter(|barrier| barrier.image == image) {
        barrier.old_layout = Layout::Undefined;
    }
    let violations = verify(&plan);
    assert!(
        matches!(violations[..], [Violation { rule: Rule::LostWrite { loss: Loss::Forgotten }, .. }]),
        "{violations:?}"
    );
}

#[test]
fn depth_that_is_said_to_be_tested_in_one_stage_only_is_caught() {
    for stage in [Stages::EARLY_FRAGMENT_TESTS, Stages::LATE_FRAGMENT_TESTS] {
        let mut plan = compiled(&forward(4, true, true), &raster::device(), &Options::default());
        let Work::Render(scope) = &mut plan.steps[0].work else { panic!("{}", plan.tree()) };
        let access = scope.passes[1].accesses.iter_mut().find(|access| access.stages.contains(stage));
        access.expect("the sky is tested").stages = stage;
        let violations = verify(&plan);
        assert!(matches!(violations[..], [Violation { rule: Rule::Structure { .. }, .. }]), "{violations:?}");
    }
}
