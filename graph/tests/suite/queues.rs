//! Which passes run on the queues for compute and transfer, what waits for what, and how images change hands. Waits cost
//! nothing here: `queue_costs` weighs them.

use crate::testing::parts::{self, stored};
use crate::testing::plans::planned;
use framewright_graph::base::Span;
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues};
use framewright_graph::frame::{
    Blend, Buffer, BufferIndex, BufferRole, BufferUse, ColorTarget, DepthTarget, Draw, DrawList, Frame, Groups, Image,
    ImageIndex, Lifetime, Pass, Resource, SampledImage, TransferUse, Work,
};
use framewright_graph::plan::{self, Plan, Queue, Role};
use framewright_graph::vulkan::{
    Accesses, Aspects, CompareOp, FillValue, Filter, Format, Layout, Sharing, Stages, State, Subresources,
};

const EXCLUSIVE: Queues = Queues { compute: true, transfer: true, sharing: Sharing::Exclusive, wait_bytes: 0 };
const CONCURRENT: Queues = Queues { compute: true, transfer: true, sharing: Sharing::Concurrent, wait_bytes: 0 };

/// Builds a frame: what passes read, then what they write.
#[derive(Default)]
pub(crate) struct Builder(pub(crate) Frame);

impl Builder {
    pub(crate) fn image(&mut self, name: &str) -> ImageIndex {
        self.0.images.push(Image::new(name, Format::R8G8B8A8_UNORM, 64, 64));
        ImageIndex(self.0.images.len() as u32 - 1)
    }

    pub(crate) fn buffer(&mut self, name: &str, lifetime: Lifetime) -> BufferIndex {
        self.0.buffers.push(Buffer { name: name.into(), span: Span::NONE, bytes: 1 << 20, lifetime });
        BufferIndex(self.0.buffers.len() as u32 - 1)
    }

    fn pass(&mut self, mut pass: Pass, stages: Stages, reads: &[ImageIndex], buffers: &[(BufferIndex, bool)]) {
        pass.sampled =
            reads.iter().map(|image| SampledImage::new(format!("source{}", image.0), *image, stages)).collect();
        pass.buffers = buffers.iter().map(|(buffer, write)| used(*buffer, *write, stages)).collect();
        self.0.passes.push(pass);
    }

    /// A full-screen draw.
    pub(crate) fn draw(&mut self, name: &str, reads: &[ImageIndex], buffers: &[BufferIndex], target: ImageIndex) {
        let draw = Draw::FullScreen;
        let mut pass = Pass::new(name, Work::Draw { draw, shader: name.into(), discards: false, per_sample: false });
        let (range, span, blend) = (Subresources::WHOLE, Span::NONE, Blend::Replace);
        pass.color.push(ColorTarget { image: target, range, span, clear: None, blend, write_mask: Default::default() });
        let buffers: Vec<_> = buffers.iter().map(|buffer| (*buffer, false)).collect();
        self.pass(pass, Stages::FRAGMENT_SHADER, reads, &buffers);
    }

    pub(crate) fn dispatch(
        &mut self,
        name: &str,
        reads: &[ImageIndex],
        buffers: &[(BufferIndex, bool)],
        target: impl Into<Option<ImageIndex>>,
    ) {
        let (stages, groups) = (Stages::COMPUTE_SHADER, Groups::Count([8, 8, 1]));
        let mut pass = Pass::new(name, Work::Dispatch { shader: name.into(), groups });
        pass.storage.extend(target.into().map(|image| stored("target", image, false)));
        self.pass(pass, stages, reads, buffers);
    }

    pub(crate) fn copy(&mut self, name: &str, from: impl Into<Resource>, to: impl Into<Resource>) {
        let mut pass = Pass::new(name, Work::Copy);
        pass.transfers = vec![transferred(from.into(), false), transferred(to.into(), true)];
        self.0.passes.push(pass);
    }

    pub(crate) fn output(mut self, image: ImageIndex) -> Frame {
        self.0.outputs.push(Resource::Image(image).into());
        self.0
    }
}

/// A storage block that is read, and perhaps written.
fn used(buffer: BufferIndex, write: bool, stages: Stages) -> BufferUse {
    let (role, binding) = (BufferRole::Storage { read: true, write }, format!("block{}", buffer.0));
    BufferUse { binding: Some(binding.as_str().into()), buffer, frames_ago: 0, span: Span::NONE, role, stages }
}

pub(crate) fn transferred(resource: Resource, write: bool) -> TransferUse {
    TransferUse { resource, range: Subresources::WHOLE, frames_ago: 0, span: Span::NONE, write, keeps: false }
}

pub(crate) fn device(queues: Queues) -> Profile {
    Profile { queues, ..parts::device() }
}

fn compiled(frame: &Frame, queues: Queues) -> Plan {
    let options = Options { order: Order::File, ..Options::default() };
    planned(frame, &device(queues), &options).expect("the frame is valid")
}

fn name(work: &plan::Work) -> String {
    match work {
        plan::Work::Render(scope) => scope.passes.iter().map(|pass| &*pass.name).collect::<Vec<_>>().join(" + "),
        plan::Work::Dispatch(pass) => pass.name.to_string(),
        plan::Work::Copy(it) => it.name.as_deref().unwrap_or("copy").to_owned(),
        plan::Work::Fill(it) => it.name.as_deref().unwrap_or("fill").to_owned(),
        other => format!("{other:?}"),
    }
}

/// Each step: where it runs, what it waits for, what it takes over and hands over.
pub(crate) fn shown(plan: &Plan) -> Vec<String> {
    let names: Vec<String> = plan.steps.iter().map(|step| name(&step.work)).collect();
    let line = |step: &plan::Step, own: &String| {
        let mut line = match step.queue {
            Queue::Graphics => own.clone(),
            Queue::Compute => format!("compute: {own}"),
            Queue::Transfer => format!("transfer: {own}"),
        };
        for wait in &step.waits {
            let before = if wait.frames_ago > 0 { " of the frame before" } else { "" };
            line += &format!(", after {}{before}", names[wait.step.0 as usize]);
        }
        let image = |barrier: &plan::ImageBarrier| plan.image(barrier.image).name.clone();
        for barrier in step.image_barriers.iter().filter(|barrier| barrier.ownership.is_some()) {
            line += &format!(", takes {}", image(barrier));
        }
        for barrier in &step.releases {
            line += &format!(", gives {}", image(barrier));
        }
        line
    };
    plan.steps.iter().zip(&names).map(|(step, name)| line(step, name)).collect()
}

pub(crate) fn note<'p>(plan: &'p Plan, pass: &str) -> &'p str {
    let found = plan.notes.iter().find(|note| &*note.subject == pass && note.text.contains("queue"));
    found.map_or("", |note| &note.text)
}

/// `simulate` writes a texture that `lit` samples; `shadows` is drawn before that.
fn simulated() -> Frame {
    let mut builder = Builder::default();
    let [waves, shadow, screen] = ["waves", "shadow", "screen"].map(|name| builder.image(name));
    builder.dispatch("simulate", &[], &[], waves);
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("lit", &[waves, shadow], &[], screen);
    builder.output(screen)
}

#[test]
fn a_dispatch_leaves_graphics_if_draws_can_run_beside_it() {
    let plan = compiled(&simulated(), CONCURRENT);
    // The frame before sampled `waves` last.
    assert_eq!(shown(&plan), ["compute: simulate, after lit of the frame before", "shadows", "lit, after simulate"]);
    assert_eq!(
        note(&plan, "simulate"),
        "runs on the compute queue, beside `shadows`: that saves up to 16.0 KiB of work, and 2 waits cost as much as 0 B"
    );
    assert_eq!(plan.totals.waits, 2);
}

#[test]
fn a_chain_that_nothing_runs_beside_stays() {
    let mut builder = Builder::default();
    let [color, blurred, sharp, screen] = ["color", "blurred", "sharp", "screen"].map(|name| builder.image(name));
    builder.draw("scene", &[], &[], color);
    builder.dispatch("blur", &[color], &[], blurred);
    builder.dispatch("sharpen", &[blurred], &[], sharp);
    builder.draw("tonemap", &[sharp], &[], screen);
    let frame = builder.output(screen);
    for queues in [EXCLUSIVE, CONCURRENT] {
        let plan = compiled(&frame, queues);
        assert_eq!(shown(&plan), ["scene", "blur", "sharpen", "tonemap"]);
        let why = "stays on the graphics queue: nothing that neither waits for it nor is waited for runs beside it";
        assert_eq!(note(&plan, "blur"), why);
        let one = Plan { notes: plan.notes.clone(), ..compiled(&frame, Queues::default()) };
        assert_eq!(plan, one);
    }
}

#[test]
fn a_device_with_one_queue_and_a_compiler_told_to_use_one_make_the_same_plan() {
    for order in [Order::File, Order::Default, Order::LowMemory] {
        let plan = |queues, used| {
            let device = device(queues);
            let options = Options { order, queues: used, ..Options::default() };
            compile(&simulated(), &device, &mut MemoryEstimate(&device), &options).expect("the frame is valid")
        };
        let one = plan(Queues::default(), true);
        assert_eq!(plan(EXCLUSIVE, false), one);
        assert_eq!(plan(CONCURRENT, false), one);
        assert!(one.steps.iter().all(|step| step.queue == Queue::Graphics && step.waits.is_empty()));
    }
}

#[test]
fn what_an_earlier_wait_covers_is_not_waited_for_again() {
    let mut builder = Builder::default();
    let [a, b, shadow, color, screen] = ["a", "b", "shadow", "color", "screen"].map(|name| builder.image(name));
    builder.dispatch("first", &[], &[], a);
    builder.dispatch("second", &[], &[], b);
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("scene", &[b, shadow], &[], color);
    builder.draw("tonemap", &[a, color], &[], screen);
    let plan = compiled(&builder.output(screen), CONCURRENT);
    let expected = [
        // `tonemap` comes after `scene`: a step that waits for `tonemap` needs no other wait.
        "compute: first, after tonemap of the frame before",
        "compute: second",
        "shadows",
        "scene, after second",
        "tonemap",
    ];
    assert_eq!(shown(&plan), expected);
}

/// `blur` samples what `scene` drew while `shadows` is drawn, and `tonemap` samples the result.
fn blurred() -> Frame {
    let mut builder = Builder::default();
    let [color, shadow, blurred, screen] = ["color", "shadow", "blurred", "screen"].map(|name| builder.image(name));
    builder.draw("scene", &[], &[], color);
    builder.dispatch("blur", &[color], &[], blurred);
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("tonemap", &[blurred, shadow], &[], screen);
    builder.output(screen)
}

#[test]
fn an_exclusive_image_is_released_and_acquired_with_its_contents() {
    let plan = compiled(&blurred(), EXCLUSIVE);
    let expected = [
        "scene, gives color",
        "compute: blur, after scene, takes color, gives blurred",
        "shadows",
        "tonemap, after blur, takes blurred",
    ];
    assert_eq!(shown(&plan), expected);
    let (release, acquire) = (&plan.steps[0].releases[0], &plan.steps[1].image_barriers);
    let acquire = acquire.iter().find(|barrier| barrier.ownership.is_some()).expect("it takes `color`");
    assert_eq!(release.range, acquire.range);
    let layouts = [Layout::ColorAttachmentOptimal, Layout::ShaderReadOnlyOptimal];
    assert_eq!([release.old_layout, release.new_layout], layouts);
    assert_eq!([acquire.old_layout, acquire.new_layout], layouts);
    assert_eq!(release.ownership, Some([Queue::Graphics, Queue::Compute]));
    assert_eq!(acquire.ownership, release.ownership);
    // Stages of each queue stand in the barrier on that queue.
    assert_eq!(
        (release.src_stages, release.src_accesses.writes()),
        (Stages::COLOR_ATTACHMENT_OUTPUT, release.src_accesses)
    );
    assert!(release.dst_stages.is_empty() && acquire.src_accesses.is_empty());
    assert_eq!(acquire.dst_stages, Stages::COMPUTE_SHADER);
    assert!(plan.images.iter().all(|image| image.sharing == Sharing::Exclusive));
}

#[test]
fn a_concurrent_image_takes_waits_alone_and_barriers_for_layouts() {
    let plan = compiled(&blurred(), CONCURRENT);
    assert_eq!(shown(&plan), ["scene", "compute: blur, after scene", "shadows", "tonemap, after blur"]);
    let shared = |name: &str| plan.images.iter().find(|image| &*image.name == name).map(|image| image.sharing);
    assert_eq!([shared("color"), shared("blurred")], [Some(Sharing::Concurrent); 2]);
    assert_eq!(shared("shadow"), Some(Sharing::Exclusive));
    for barrier in plan.steps.iter().flat_map(|step| &step.image_barriers) {
        assert_ne!(barrier.old_layout, barrier.new_layout, "{barrier:?}");
    }
}

#[test]
fn reading_beside_draws_that_read_the_same_gains_only_where_images_are_concurrent() {
    let mut builder = Builder::default();
    let [depth, occlusion, color, screen] = ["depth", "occlusion", "color", "screen"].map(|name| builder.image(name));
    builder.draw("prepass", &[], &[], depth);
    builder.dispatch("occlude", &[depth], &[], occlusion);
    builder.draw("scene", &[depth], &[], color);
    builder.draw("tonemap", &[color, occlusion], &[], screen);
    let frame = builder.output(screen);
    assert_eq!(shown(&compiled(&frame, EXCLUSIVE)), ["prepass", "occlude", "scene", "tonemap"]);
    // Neither reader waits for the other one: the layout changes by itself.
    let expected = ["prepass", "Export", "compute: occlude, after Export", "scene", "tonemap, after occlude"];
    assert_eq!(shown(&compiled(&frame, CONCURRENT)), expected);
}

/// A scope that tests depth and then writes it is no reader of it: a change of layout before it would be nobody's on its queue.
#[test]
fn a_scope_that_reads_depth_and_then_writes_it_takes_no_change_of_layout() {
    let mut builder = Builder::default();
    let [depth, pyramid, shadow, color, screen] =
        ["depth", "pyramid", "shadow", "color", "screen"].map(|name| builder.image(name));
    builder.0.images[depth.0 as usize].format = Format::D32_SFLOAT;
    let tested = |name: &str, test, write, clear| {
        let (range, span) = (Subresources::WHOLE, Span::NONE);
        let draw = Draw::Objects(DrawList::Opaque);
        let work = Work::Draw { draw, shader: name.into(), discards: false, per_sample: false };
        let depth = Some(DepthTarget { image: depth, range, span, clear, test, write, stencil: None });
        Pass { depth, ..Pass::new(name, work) }
    };
    builder.0.passes.push(tested("prepass", CompareOp::GreaterOrEqual, true, Some(0.0)));
    builder.dispatch("reduce", &[depth], &[], pyramid);
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("sky", &[], &[], color);
    for (name, test, write) in [("opaque", CompareOp::Equal, false), ("masked", CompareOp::GreaterOrEqual, true)] {
        let color = builder.0.passes.iter().find(|pass| &*pass.name == "sky").map(|sky| sky.color.clone());
        builder.0.passes.push(Pass { color: color.unwrap_or_default(), ..tested(name, test, write, None) });
    }
    builder.draw("tonemap", &[color, pyramid, shadow], &[], screen);
    let frame = builder.output(screen);
    // The checker finds that `reduce` doesn't wait for a change of layout that nothing on graphics waits for.
    let plan = compiled(&frame, CONCURRENT);
    assert!(shown(&plan).iter().any(|line| line == "compute: reduce, after prepass"), "{:#?}", shown(&plan));
    assert!(shown(&plan).iter().any(|line| line.contains("opaque + masked")), "{:#?}", shown(&plan));
}

#[test]
fn buffers_of_several_queues_are_concurrent_and_take_no_barrier() {
    let mut builder = Builder::default();
    let [shadow, screen] = ["shadow", "screen"].map(|name| builder.image(name));
    let [lights, own] = ["lights", "own"].map(|name| builder.buffer(name, Lifetime::Transient));
    for buffer in [lights, own] {
        builder.0.passes.push(Pass {
            transfers: vec![transferred(Resource::Buffer(buffer), true)],
            ..Pass::new(&format!("clear{}", buffer.0), Work::Fill { value: FillValue::Bits([0; 4]) })
        });
    }
    builder.dispatch("bin", &[], &[(lights, true), (own, true)], None);
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("lit", &[shadow], &[lights], screen);
    let plan = compiled(&builder.output(screen), EXCLUSIVE);
    // Fills go where the dispatch goes that they are for.
    assert_eq!(shown(&plan)[2..], ["compute: bin", "shadows", "lit, after bin"]);
    assert!(plan.steps[..2].iter().all(|step| step.queue == Queue::Compute));
    let shared = |name: &str| plan.buffers.iter().find(|buffer| &*buffer.name == name).map(|buffer| buffer.sharing);
    assert_eq!([shared("lights"), shared("own")], [Some(Sharing::Concurrent), Some(Sharing::Exclusive)]);
    assert!(plan.steps[4].memory_barriers.is_empty(), "{}", plan.tree());
}

fn handed_in() -> Lifetime {
    let before = State { stages: Stages::COPY, accesses: Accesses::TRANSFER_WRITE, layout: Layout::Undefined };
    Lifetime::Imported { before, after: None, owner: None }
}

#[test]
fn an_upload_runs_on_the_transfer_queue() {
    let mut builder = Builder::default();
    let [shadow, texture, screen] = ["shadow", "texture", "screen"].map(|name| builder.image(name));
    let staging = builder.buffer("staging", handed_in());
    builder.copy("upload", Resource::Buffer(staging), Resource::Image(texture));
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("lit", &[shadow, texture], &[], screen);
    let plan = compiled(&builder.output(screen), EXCLUSIVE);
    let expected = [
        "transfer: upload, after lit of the frame before, gives texture",
        "shadows",
        "lit, after upload, takes texture",
    ];
    assert_eq!(shown(&plan), expected);
    // The program hands `staging` in on another queue family.
    assert_eq!(plan.buffers[0].sharing, Sharing::Concurrent);
}

#[test]
fn what_other_queues_cannot_do_stays_and_says_why() {
    let mut builder = Builder::default();
    let [shadow, big, small, screen] = ["shadow", "big", "small", "screen"].map(|name| builder.image(name));
    let [depth, copy] = ["depth", "copy"].map(|name| builder.image(name));
    for image in [depth, copy] {
        builder.0.images[image.0 as usize].format = Format::D32_SFLOAT;
    }
    builder.draw("scene", &[], &[], big);
    builder.0.passes.push(Pass {
        transfers: vec![transferred(Resource::Image(depth), true)],
        ..Pass::new("far", Work::Fill { value: FillValue::Depth(0.0, 0) })
    });
    builder.copy("keep", Resource::Image(depth), Resource::Image(copy));
    let mut blit = Pass::new("shrink", Work::Blit { filter: Filter::Nearest });
    blit.transfers = vec![transferred(Resource::Image(big), false), transferred(Resource::Image(small), true)];
    builder.0.passes.push(blit);
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("lit", &[shadow, small, copy], &[], screen);
    let plan = compiled(&builder.output(screen), CONCURRENT);
    assert!(plan.steps.iter().all(|step| step.queue == Queue::Graphics), "{}", plan.tree());
    let planes = "stays on the graphics queue: copies and fills of depth, stencil or several samples need it";
    assert_eq!([note(&plan, "far"), note(&plan, "keep")], [planes; 2]);
    assert_eq!(note(&plan, "shrink"), "stays on the graphics queue: blits need it");
    assert_eq!(plan.images.iter().filter(|image| image.format.aspects() == Aspects::DEPTH).count(), 2);
}

#[test]
fn what_the_devices_other_queue_cannot_do_stays_and_says_why() {
    let queues = Queues { compute: false, transfer: true, ..Queues::default() };
    let plan = compiled(&simulated(), queues);
    assert!(plan.steps.iter().all(|step| step.queue == Queue::Graphics), "{}", plan.tree());
    assert_eq!(note(&plan, "simulate"), "stays on the graphics queue: no other queue of the device can do it");
}

#[test]
fn what_persists_is_waited_for_across_frames() {
    let mut builder = Builder::default();
    let [shadow, screen] = ["shadow", "screen"].map(|name| builder.image(name));
    let particles = builder.buffer("particles", Lifetime::Persistent { initial: FillValue::Bits([0; 4]) });
    builder.dispatch("simulate", &[], &[(particles, true)], None);
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("lit", &[shadow], &[particles], screen);
    let plan = compiled(&builder.output(screen), EXCLUSIVE);
    assert_eq!(shown(&plan), ["compute: simulate, after lit of the frame before", "shadows", "lit, after simulate"]);
    assert_eq!(plan.buffers[0].sharing, Sharing::Concurrent);
    // Semaphores alone lead from frame to frame.
    let Role::Persistent { before, after, .. } = &plan.buffers[0].role else { panic!("{:?}", plan.buffers[0]) };
    assert!(before == after && before.stages.is_empty() && before.accesses.is_empty());
    assert!(plan.steps.iter().all(|step| step.memory_barriers.is_empty()), "{}", plan.tree());
}

#[test]
fn what_is_only_read_takes_no_wait() {
    let mut builder = Builder::default();
    let [waves, shadow, screen] = ["waves", "shadow", "screen"].map(|name| builder.image(name));
    let table = builder.buffer("table", Lifetime::Persistent { initial: FillValue::Bits([1; 4]) });
    builder.draw("shadows", &[], &[table], shadow);
    builder.dispatch("simulate", &[], &[(table, false)], waves);
    builder.draw("lit", &[shadow, waves], &[table], screen);
    let plan = compiled(&builder.output(screen), CONCURRENT);
    // All of these are for `waves`.
    let expected = ["shadows", "compute: simulate, after lit of the frame before", "lit, after simulate"];
    assert_eq!(shown(&plan), expected, "{}", plan.tree());
}

#[test]
fn images_that_are_alive_side_by_side_share_no_memory() {
    let mut builder = Builder::default();
    let [waves, foam, shadow, color, screen] =
        ["waves", "foam", "shadow", "color", "screen"].map(|name| builder.image(name));
    builder.dispatch("simulate", &[], &[], waves);
    builder.dispatch("churn", &[waves], &[], foam);
    // By its place in the row `waves` is done with, but `churn` may still be running.
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("scene", &[shadow], &[], color);
    builder.draw("lit", &[color, foam], &[], screen);
    let frame = builder.output(screen);
    let place = |plan: &Plan, name: &str| {
        let image = plan.images.iter().find(|image| &*image.name == name).expect("it is in the Plan");
        let Role::Transient(placement) = &image.role else { panic!("{name} is transient") };
        (placement.heap, placement.offset..placement.offset + placement.bytes)
    };
    let meet = |plan: &Plan, one: &str, other: &str| {
        let ((heap, one), (other_heap, other)) = (place(plan, one), place(plan, other));
        heap == other_heap && one.start < other.end && other.start < one.end
    };
    let plan = compiled(&frame, CONCURRENT);
    assert_eq!(plan.steps[1].queue, Queue::Compute);
    for other in ["shadow", "color"] {
        assert!(!meet(&plan, "waves", other), "{}", plan.tree());
    }
    // On one queue they do share: the test would notice.
    let one = compiled(&frame, Queues::default());
    assert!(["shadow", "color"].iter().any(|other| meet(&one, "waves", other)), "{}", one.tree());
}
