//! Contents of images, as numbers that stand for how they were made: equal numbers, equal pictures.
//!
//! A frame and its Plan are followed separately, each by its own meaning. The checker can tell whether a Plan keeps its own
//! promises; only this can tell whether those are the frame's.

use framewright_graph::frame::{Blend, Draw, Face, Frame, Image, ImageIndex, Pass, ResolveWay, Resource, Work};
use framewright_graph::plan::{self, Plan};
use framewright_graph::vulkan::{Accesses, CompareOp, Layout, LoadOp, StoreOp};
use std::hash::{DefaultHasher, Hash, Hasher};

/// Nothing is known of what is there, and nothing needs to be.
const ANYTHING: u64 = 0;

fn mix(what: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    what.hash(&mut hasher);
    hasher.finish()
}

fn resolved(value: u64) -> u64 {
    mix(("resolved", value))
}

fn weighted(value: u64) -> u64 {
    mix(("weighted", value))
}

/// One value of what has several samples, as the image says.
fn single(image: &Image, value: u64) -> u64 {
    let way = image.resolve.as_ref().map(|resolve| resolve.way);
    if way == Some(ResolveWay::Weighted) { weighted(value) } else { resolved(value) }
}

fn drawn(value: u64) -> u64 {
    mix(("copy", value))
}

fn cleared(value: [f64; 4]) -> u64 {
    mix(value.map(f64::to_bits))
}

/// A pass makes this of one of its targets.
fn made(pass: &str, target: &str, before: u64, depth: u64, read: &[(String, u64)]) -> u64 {
    mix((pass, target, before, depth, read))
}

/// The contents of the outputs of `frame`.
pub(crate) fn of_frame(frame: &Frame) -> Vec<u64> {
    let mut held = vec![ANYTHING; frame.images.len()];
    for pass in &frame.passes {
        frame_pass(frame, pass, &mut held);
    }
    let leaving = |at: ImageIndex| match &frame.images[at.0 as usize] {
        image if image.samples == 1 => held[at.0 as usize],
        image => single(image, held[at.0 as usize]),
    };
    let image = |resource: Resource| match resource {
        Resource::Image(image) => image,
        Resource::Buffer(_) => unreachable!("these frames have no buffers"),
    };
    frame.outputs.iter().map(|output| leaving(image(output.resource))).collect()
}

fn frame_pass(frame: &Frame, pass: &Pass, held: &mut [u64]) {
    let image = |image: ImageIndex| &frame.images[image.0 as usize];
    if let Work::Forward { from, to, .. } = pass.work {
        let (source, target) = (image(from), image(to));
        let value = held[from.0 as usize];
        let value = if source.samples > target.samples { single(source, value) } else { value };
        let same = source.format == target.format && source.samples >= target.samples;
        held[to.0 as usize] = if same { value } else { drawn(value) };
        return;
    }
    let sampled = pass.sampled.iter().map(|sampled| {
        let value = held[sampled.image.0 as usize];
        let whole = sampled.face == Face::Samples || image(sampled.image).samples == 1;
        (sampled.binding.to_string(), if whole { value } else { single(image(sampled.image), value) })
    });
    let stored = pass.storage.iter().filter(|storage| storage.read);
    let stored = stored.map(|storage| (storage.binding.to_string(), held[storage.image.0 as usize]));
    let read: Vec<_> = sampled.chain(stored).collect();
    let tested = pass.depth.as_ref().is_some_and(|depth| depth.test != CompareOp::Always);
    let whole = matches!(pass.work, Work::Draw { draw: Draw::FullScreen, discards: false, .. }) && !tested;
    let depth = pass.depth.as_ref().map_or(ANYTHING, |depth| match depth.clear {
        _ if whole && depth.write => ANYTHING,
        Some(clear) => cleared([clear, 0.0, 0.0, 0.0]),
        None => held[depth.image.0 as usize],
    });
    for (location, target) in pass.color.iter().enumerate() {
        let value = &mut held[target.image.0 as usize];
        let before = match target.clear {
            Some(clear) => cleared(clear),
            None if whole && target.blend == Blend::Replace => ANYTHING,
            None => *value,
        };
        *value = made(&pass.name, &format!("color {location}"), before, depth, &read);
    }
    for storage in pass.storage.iter().filter(|storage| storage.write) {
        held[storage.image.0 as usize] = made(&pass.name, &storage.binding, ANYTHING, ANYTHING, &read);
    }
    if let Some(target) = &pass.depth {
        held[target.image.0 as usize] =
            if target.write { made(&pass.name, "depth", depth, depth, &read) } else { depth };
    }
}

/// The contents of the outputs of `plan`.
pub(crate) fn of_plan(plan: &Plan) -> Vec<u64> {
    let mut held = vec![ANYTHING; plan.images.len()];
    for (number, step) in plan.steps.iter().enumerate() {
        let lost = |image: plan::ImageId| mix(("lost", number, image));
        for barrier in step.image_barriers.iter().filter(|barrier| barrier.old_layout == Layout::Undefined) {
            held[barrier.image.0 as usize] = lost(barrier.image);
        }
        match &step.work {
            plan::Work::Render(scope) => {
                let attachments = || scope.attachments.iter();
                for attachment in attachments() {
                    let value = &mut held[attachment.image.0 as usize];
                    match attachment.load {
                        LoadOp::Load => {}
                        LoadOp::Clear => *value = attachment.clear.map_or(ANYTHING, cleared),
                        LoadOp::DontCare => *value = ANYTHING,
                    }
                }
                scope.passes.iter().for_each(|pass| plan_pass(plan, pass, Some(scope), &mut held));
                for attachment in attachments() {
                    let value = held[attachment.image.0 as usize];
                    if let Some(resolve) = &attachment.resolve {
                        held[resolve.image.0 as usize] = resolved(value);
                    }
                    if attachment.store == StoreOp::DontCare {
                        held[attachment.image.0 as usize] = lost(attachment.image);
                    }
                }
            }
            plan::Work::Dispatch(pass) => plan_pass(plan, pass, None, &mut held),
            plan::Work::Resolve(it) => held[side(&it.target)] = resolved(held[side(&it.source)]),
            plan::Work::Copy(it) => held[side(&it.target)] = held[side(&it.source)],
            plan::Work::Custom(_) | plan::Work::Blit(_) | plan::Work::Fill(_) => unreachable!("these frames have none"),
            plan::Work::Export => {}
        }
    }
    plan.outputs.iter().map(|output| held[number(output.resource)]).collect()
}

fn side(side: &plan::Side) -> usize {
    number(side.resource())
}

fn number(resource: plan::Resource) -> usize {
    match resource {
        plan::Resource::Image(image) => image.0 as usize,
        plan::Resource::Buffer(_) => unreachable!("these frames have no buffers"),
    }
}

/// Whether a copy by a draw does nothing but turn what it copies.
fn only_turns(plan: &Plan, pass: &plan::Pass, target: &plan::Image) -> bool {
    let source = pass.accesses.iter().find(|access| access.binding.is_some());
    source.map(|source| plan.image(source.image)).is_some_and(|source| {
        (source.format, source.samples) == (target.format, target.samples) && source.rotation != target.rotation
    })
}

fn plan_pass(plan: &Plan, pass: &plan::Pass, scope: Option<&plan::RenderScope>, held: &mut [u64]) {
    let bound = |accesses: Accesses| {
        let some = pass.accesses.iter().filter(move |access| access.accesses.intersects(accesses));
        some.filter_map(|access| Some((access.binding.as_ref()?.name.to_string(), access.image.0 as usize)))
    };
    let reads = Accesses::SHADER_SAMPLED_READ | Accesses::SHADER_STORAGE_READ;
    let read: Vec<_> = bound(reads).map(|(name, image)| (name, held[image])).collect();
    for (name, image) in bound(Accesses::SHADER_STORAGE_WRITE) {
        held[image] = made(&pass.name, &name, ANYTHING, ANYTHING, &read);
    }
    let Some(scope) = scope else { return };
    let depth_image = scope.depth().filter(|_| pass.depth.is_some()).map(|depth| depth.image.0 as usize);
    let replaces = |state: plan::DepthState| state.write && state.test == CompareOp::Always;
    let whole = pass.draw == Some(Draw::FullScreen) && !pass.discards && pass.depth.is_some_and(replaces);
    let depth = depth_image.filter(|_| !whole).map_or(ANYTHING, |image| held[image]);
    for (location, attachment) in scope.color().iter().enumerate() {
        let value = &mut held[attachment.image.0 as usize];
        *value = match &*pass.shader {
            "shipped:copy" if only_turns(plan, pass, plan.image(attachment.image)) => read[0].1,
            "shipped:copy" => drawn(read[0].1),
            "shipped:resolve_weighted" => weighted(read[0].1),
            _ => made(&pass.name, &format!("color {location}"), *value, depth, &read),
        };
    }
    if let (Some(image), Some(true)) = (depth_image, pass.depth.map(|state| state.write)) {
        held[image] = made(&pass.name, "depth", depth, depth, &read);
    }
}
