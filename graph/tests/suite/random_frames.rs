//! Random valid frames: every Plan passes the checker, makes of its outputs what the frame says, and has no barrier too many.

use crate::testing::{raster, symbolic};
use framewright_graph::base::{Diagnostic, Span};
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::frame::{
    Blend, ColorTarget, DepthTarget, Draw, DrawList, Face, Frame, Groups, Image, ImageIndex, Output, Pass, Resolve,
    ResolveWay, Resource, SampledImage, Storage, Work,
};
use framewright_graph::plan::{self, Plan};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{self, D32_SFLOAT, R8G8B8A8_SRGB, R16G16B16A16_SFLOAT, R32_UINT};
use framewright_graph::vulkan::{CompareOp, Rotation, Stages, Subresources};
use proptest::prelude::*;
use std::cell::Cell;

/// Images of every random frame: format and samples.
const IMAGES: [(Format, u32); 10] = [
    (R8G8B8A8_SRGB, 1),
    (R8G8B8A8_SRGB, 4),
    (R16G16B16A16_SFLOAT, 1),
    (R16G16B16A16_SFLOAT, 4),
    (R32_UINT, 1),
    (R32_UINT, 4),
    (R8G8B8A8_SRGB, 1),
    (D32_SFLOAT, 4),
    (D32_SFLOAT, 1),
    (D32_SFLOAT, 4),
];

/// Turns random bytes into a frame: every choice is made among what is valid at that point.
struct Maker {
    frame: Frame,
    written: [bool; IMAGES.len()],
    about: [bool; IMAGES.len()],
    bytes: Vec<u8>,
}

impl Maker {
    fn byte(&mut self) -> usize {
        self.bytes.pop().unwrap_or(0).into()
    }

    fn one_in(&mut self, of: usize) -> bool {
        self.byte() % of == 1
    }

    /// An image that `fits`, among those that this frame is about.
    fn pick(&mut self, fits: impl Fn(&Maker, usize) -> bool) -> Option<usize> {
        let among: Vec<usize> = (0..IMAGES.len()).filter(|image| self.about[*image] && fits(self, *image)).collect();
        let at = self.byte();
        among.get(at.checked_rem(among.len())?).copied()
    }

    fn pass(&mut self, bytes: &[u8]) {
        self.bytes = bytes.to_vec();
        let name = format!("pass{}", self.frame.passes.len());
        let kind = self.byte() % 9;
        let draw = if kind < 3 { Draw::Objects(DrawList::Opaque) } else { Draw::FullScreen };
        let work = Work::Draw { draw, shader: name.as_str().into(), discards: kind == 3, per_sample: false };
        let mut pass = Pass::new(&name, work);
        match kind {
            0..=5 => self.draw(&mut pass),
            6 => self.dispatch(&mut pass),
            _ => self.forward(&mut pass),
        }
        if matches!(pass.work, Work::Draw { .. }) && pass.color.is_empty() {
            // There was nothing that it could have drawn into.
            return;
        }
        let targets = pass.color.iter().map(|target| target.image);
        let stored = pass.storage.iter().filter(|storage| storage.write).map(|storage| storage.image);
        let depth = pass.depth.iter().map(|depth| depth.image);
        let to = if let Work::Forward { to, .. } = pass.work { Some(to) } else { None };
        targets.chain(stored).chain(depth).chain(to).for_each(|image| self.written[image.0 as usize] = true);
        self.frame.passes.push(pass);
    }

    fn draw(&mut self, pass: &mut Pass) {
        let Some(first) = self.pick(|_, image| !IMAGES[image].0.is_depth()) else { return };
        let samples = IMAGES[first].1;
        self.color(pass, first);
        if self.one_in(4) {
            let fits =
                |_: &Maker, image: usize| image != first && !IMAGES[image].0.is_depth() && IMAGES[image].1 == samples;
            if let Some(second) = self.pick(fits) {
                self.color(pass, second);
            }
        }
        let depth = self.pick(|_, image| IMAGES[image] == (D32_SFLOAT, samples));
        if let Some(depth) = depth {
            let clear = (!self.written[depth] || self.one_in(4)).then_some(0.0);
            let test = if self.one_in(4) { CompareOp::Always } else { CompareOp::GreaterOrEqual };
            let write = self.one_in(2);
            let image = ImageIndex(depth as u32);
            pass.depth = Some(DepthTarget {
                image,
                range: Subresources::WHOLE,
                span: Span::NONE,
                clear,
                test,
                write,
                stencil: None,
            });
        }
        let covers = matches!(pass.work, Work::Draw { draw: Draw::FullScreen, discards: false, .. })
            && pass.depth.as_ref().is_none_or(|depth| depth.test == CompareOp::Always);
        for target in &mut pass.color {
            if !(self.written[target.image.0 as usize] || covers && target.blend == Blend::Replace) {
                let integers = IMAGES[target.image.0 as usize].0.is_integer();
                target.clear = Some([if integers { 25.0 } else { 0.25 }; 4]);
            }
        }
        self.sample(pass, Stages::FRAGMENT_SHADER);
    }

    fn color(&mut self, pass: &mut Pass, image: usize) {
        let blend = if self.one_in(2) && !IMAGES[image].0.is_integer() { Blend::Alpha } else { Blend::Replace };
        let clear = self.one_in(4).then_some([if IMAGES[image].0.is_integer() { 5.0 } else { 0.5 }; 4]);
        let image = ImageIndex(image as u32);
        pass.color.push(ColorTarget {
            image,
            range: Subresources::WHOLE,
            span: Span::NONE,
            clear,
            blend,
            write_mask: Default::default(),
        });
    }

    /// Up to three images that are written by now; depth only where the pass doesn't change it.
    fn sample(&mut self, pass: &mut Pass, stages: Stages) {
        let changed = pass.depth.as_ref().filter(|depth| depth.write || depth.clear.is_some());
        let changed = changed.map(|depth| depth.image.0 as usize);
        for number in 0..self.byte() % 4 {
            let Some(image) = self.pick(|maker, image| maker.written[image] && changed != Some(image)) else { return };
            let (format, samples) = IMAGES[image];
            let face = match samples > 1 && (format.is_depth() || self.one_in(4)) {
                true => Face::Samples,
                false => Face::Resolved,
            };
            pass.sampled.push(SampledImage {
                face,
                ..SampledImage::new(format!("source{number}"), ImageIndex(image as u32), stages)
            });
        }
    }

    fn dispatch(&mut self, pass: &mut Pass) {
        pass.work = Work::Dispatch { shader: pass.name.clone(), groups: Groups::Count([1; 3]) };
        for number in 0..1 + self.byte() % 3 {
            let taken: Vec<u32> = pass.storage.iter().map(|storage| storage.image.0).collect();
            let fits = |_: &Maker, image: usize| IMAGES[image].1 == 1 && !taken.contains(&(image as u32));
            let Some(image) = self.pick(fits) else { return };
            let read = self.written[image] && self.one_in(2);
            pass.storage.push(Storage {
                binding: format!("store{number}").into(),
                image: ImageIndex(image as u32),
                range: Subresources::WHOLE,
                span: Span::NONE,
                read,
                write: !read || self.one_in(2),
                eye: None,
                stages: Stages::COMPUTE_SHADER,
            });
        }
        self.sample(pass, Stages::COMPUTE_SHADER);
    }

    fn forward(&mut self, pass: &mut Pass) {
        let Some(from) = self.pick(|maker, image| maker.written[image]) else { return self.draw(pass) };
        let (format, samples) = IMAGES[from];
        let fits = |_: &Maker, to: usize| match IMAGES[to] {
            (other, count) if format.is_depth() || other.is_depth() => (other, count) == (format, samples),
            (other, count) if format.is_integer() || other.is_integer() => other == format && count <= samples,
            (other, count) => count == 1 || samples == 1 || (other, count) == (format, samples),
        };
        // Multisampled depth is resolved where it is drawn, so what is forwarded to is no output below.
        let Some(to) = self.pick(|maker, to| to != 7 && fits(maker, to)) else { return };
        let [from, to] = [from, to].map(|image| ImageIndex(image as u32));
        pass.work = Work::Forward { from, to, because: "a switch = false".to_owned() };
    }
}

/// The frame that these bytes stand for.
fn frame(passes: &[Vec<u8>], about: [bool; IMAGES.len()], outputs: &[u8]) -> Frame {
    let mut maker = Maker { frame: Frame::default(), written: [false; IMAGES.len()], about, bytes: Vec::new() };
    for (number, (format, samples)) in IMAGES.into_iter().enumerate() {
        let image = Image::new(&format!("image{number}"), format, 64, 64);
        let weighted = samples > 1 && format == R16G16B16A16_SFLOAT;
        let resolve = weighted.then(|| Resolve { way: ResolveWay::Weighted, because: "it says so".into() });
        maker.frame.images.push(Image { samples, resolve, ..image });
    }
    passes.iter().for_each(|bytes| maker.pass(bytes));
    maker.bytes = outputs.to_vec();
    for _ in outputs {
        let listed: Vec<Resource> = maker.frame.outputs.iter().map(|output| output.resource).collect();
        if let Some(image) = maker.pick(|maker, image| {
            maker.written[image] && image != 9 && !listed.contains(&Resource::Image(ImageIndex(image as u32)))
        }) {
            maker.frame.outputs.push(Resource::Image(ImageIndex(image as u32)).into());
        }
    }
    maker.frame
}

fn compiled(frame: &Frame, device: &Profile, options: &Options) -> Plan {
    compile(frame, device, &mut MemoryEstimate(device), options)
        .unwrap_or_else(|errors| panic!("the frame is valid: {errors:?}"))
}

fn passes() -> impl Strategy<Value = Vec<Vec<u8>>> {
    prop::collection::vec(prop::collection::vec(any::<u8>(), 24), 1..30)
}

/// A frame as a failure shows it.
fn words(frame: &Frame) -> String {
    let passes: Vec<String> = frame.passes.iter().map(|pass| format!("{pass:?}")).collect();
    passes.join("\n")
}

/// Deterministic: the same cases every time.
fn check(cases: u32, holds: impl Fn(&Frame, &Profile)) {
    let config = ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases) };
    let rng = prop::test_runner::TestRng::deterministic_rng(prop::test_runner::RngAlgorithm::ChaCha);
    let mut runner = prop::test_runner::TestRunner::new_with_rng(config, rng);
    let mut device = raster::device();
    device.lazily_allocated_memory = true;
    let strategy = (passes(), prop::array::uniform10(any::<bool>()), prop::collection::vec(any::<u8>(), 1..5));
    let result = runner.run(&strategy, |(passes, about, outputs)| {
        holds(&frame(&passes, about, &outputs), &device);
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
}

#[test]
fn whatever_the_options_the_checker_finds_nothing_and_the_outputs_hold_what_the_frame_says() {
    check(1500, |frame, device| {
        let expected = symbolic::of_frame(frame);
        for [alias, poison] in [[true, false], [false, false], [true, true], [false, true]] {
            let plan = compiled(frame, device, &Options { alias, poison, demote: false, ..Options::default() });
            assert_eq!(verify(&plan), [], "{}\n{}", words(frame), plan.tree());
            assert_eq!(symbolic::of_plan(&plan), expected, "{}\n{}", words(frame), plan.tree());
        }
    });
}

/// PR-1, PR-2, PR-7: for all images that are turned together with an output, and for all that stay upright.
#[test]
fn outputs_that_leave_rotated_hold_the_same_or_are_refused_beside_other_targets() {
    let (turned, drawn_so) = (Cell::new(0), Cell::new(0));
    check(1500, |frame, device| {
        let expected = symbolic::of_frame(frame);
        let mut frame = frame.clone();
        let Frame { images, outputs, .. } = &mut frame;
        let color = |output: &&mut Output| match output.resource {
            Resource::Image(image) => !images[image.0 as usize].format.is_depth(),
            Resource::Buffer(_) => false,
        };
        outputs.iter_mut().filter(color).for_each(|output| output.rotation = Rotation::Rotate90);
        let options = Options { demote: false, ..Options::default() };
        let plan = match compile(&frame, device, &mut MemoryEstimate(device), &options) {
            Ok(plan) => plan,
            Err(errors) => {
                let beside =
                    |error: &Diagnostic| error.message.contains("which leaves the frame rotated by 90°, and into");
                let undrawable = |error: &Diagnostic| error.message.contains("can't be drawn into");
                assert!(errors.iter().all(|error| beside(error) || undrawable(error)), "{errors:?}\n{}", words(&frame));
                return;
            }
        };
        assert_eq!(verify(&plan), [], "{}\n{}", words(&frame), plan.tree());
        assert_eq!(symbolic::of_plan(&plan), expected, "{}\n{}", words(&frame), plan.tree());
        let demoted = compiled(&frame, device, &Options::default());
        assert_eq!(verify(&demoted), [], "{}\n{}", words(&frame), demoted.tree());
        let leaves = plan.outputs.iter().filter_map(|output| match output.resource {
            plan::Resource::Image(image) => Some(plan.image(image)),
            plan::Resource::Buffer(_) => None,
        });
        for image in leaves.filter(|image| !image.format.is_depth()) {
            assert_eq!(image.rotation, Rotation::Rotate90, "{}", plan.tree());
            turned.set(turned.get() + 1);
        }
        drawn_so.set(drawn_so.get() + plan.images.iter().filter(|image| image.rotation.turns()).count());
    });
    assert!(turned.get() > 500 && drawn_so.get() > turned.get() + 100, "{} {}", turned.get(), drawn_so.get());
}

#[test]
fn no_barrier_can_be_left_out() {
    check(200, |frame, device| {
        // A memory barrier covers everything, so it may stand in for image barriers: those are looked at where there is none.
        let apart = compiled(frame, device, &Options { alias: false, ..Options::default() });
        for (step, number) in apart.steps.iter().zip(0..) {
            for barrier in 0..step.image_barriers.len() {
                let mut less = apart.clone();
                let removed = less.steps[number].image_barriers.remove(barrier);
                assert_ne!(breaches(&less), 0, "{removed:?} before step {number}\n{}", apart.tree());
            }
        }
        // One memory barrier may stand in for another, and who takes memory that was partly its own names writes in its own
        // barrier, which the checker accepts for both. But they can't all go.
        let mut shared = compiled(frame, device, &Options::default());
        let mut due = false;
        for step in &mut shared.steps {
            for [_, to] in step.memory_barriers.drain(..).flat_map(|barrier| barrier.hand_overs) {
                let of_it = step.image_barriers.iter().find(|barrier| plan::Resource::Image(barrier.image) == to);
                due |= of_it.is_some_and(|barrier| barrier.src_accesses.is_empty());
            }
        }
        assert!(!due || breaches(&shared) > 0, "without memory barriers:\n{}", shared.tree());
    });
}

/// Violations that are not about sums, which every removal changes.
fn breaches(plan: &Plan) -> usize {
    use framewright_graph::verify::Rule;
    verify(plan).iter().filter(|violation| !matches!(violation.rule, Rule::Total { .. })).count()
}
