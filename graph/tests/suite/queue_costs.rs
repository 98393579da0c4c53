//! A step leaves the graphics queue only where that saves more than its waits cost.

use crate::queues::{Builder, device, note, shown, transferred};
use crate::testing::plans::planned;
use framewright_graph::compile::{Compiler, Options, Order, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues};
use framewright_graph::frame::{BufferIndex, Cadence, Frame, ImageIndex, Lifetime, Pass, Resource, Work};
use framewright_graph::plan::{Plan, Queue};
use framewright_graph::vulkan::{Accesses, FillValue, Layout, Sharing, Stages, State};
use proptest::prelude::*;
use std::sync::Arc;

const KIB: u64 = 1 << 10;
const MIB: u64 = 1 << 20;
const OPTIONS: Options =
    Options { alias: true, poison: false, readable: false, order: Order::File, demote: true, queues: true };

/// A device with all queues, on which a wait costs this much.
fn with_wait(wait_bytes: u64) -> Profile {
    device(Queues { compute: true, transfer: true, sharing: Sharing::Concurrent, wait_bytes })
}

fn plan(frame: &Frame) -> Plan {
    planned(frame, &with_wait(2 * MIB), &OPTIONS).expect("the frame is valid")
}

/// A buffer of this size.
fn buffer(builder: &mut Builder, name: &str, bytes: u64) -> BufferIndex {
    let buffer = builder.buffer(name, Lifetime::Transient);
    builder.0.buffers[buffer.0 as usize].bytes = bytes;
    buffer
}

/// An image of this size: a power of four times 4 bytes.
fn image(builder: &mut Builder, name: &str, bytes: u64) -> ImageIndex {
    let image = builder.image(name);
    let side = ((bytes / 4) as f64).sqrt() as u32;
    builder.0.images[image.0 as usize].extent = [side, side, 1];
    image
}

fn fill(builder: &mut Builder, name: &str, buffer: BufferIndex) {
    let transfers = vec![transferred(Resource::Buffer(buffer), true)];
    let value = FillValue::Bits([0; 4]);
    builder.0.passes.push(Pass { transfers, ..Pass::new(name, Work::Fill { value }) });
}

/// `clear` fills a buffer, while `shadows` draws an image; `lit` reads both.
fn cleared(bytes: u64, shadow: u64) -> Frame {
    let mut builder = Builder::default();
    let [shadow, screen] =
        [("shadow", shadow), ("screen", 16 * KIB)].map(|(name, size)| image(&mut builder, name, size));
    let counts = buffer(&mut builder, "counts", bytes);
    fill(&mut builder, "clear", counts);
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("lit", &[shadow], &[counts], screen);
    builder.output(screen)
}

fn queue_of_first(plan: &Plan) -> Queue {
    plan.steps[0].queue
}

#[test]
fn a_small_fill_stays_and_says_what_it_would_save() {
    let plan = plan(&cleared(KIB, 16 * MIB));
    assert_eq!(shown(&plan), ["clear", "shadows", "lit"]);
    let why = "stays on the graphics queue: moving it would save at most 1.0 KiB of work beside `shadows`, and 2 waits cost as \
               much as 4.0 MiB";
    assert_eq!(note(&plan, "clear"), why);
}

#[test]
fn a_fill_that_saves_just_what_its_waits_cost_stays() {
    let queue = |bytes| queue_of_first(&plan(&cleared(bytes, 16 * MIB)));
    assert_eq!([4 * MIB, 4 * MIB + 4].map(queue), [Queue::Graphics, Queue::Transfer]);
}

#[test]
fn a_large_fill_moves_and_says_what_it_saves() {
    let plan = plan(&cleared(8 * MIB, 16 * MIB));
    assert_eq!(shown(&plan), ["transfer: clear, after lit of the frame before", "shadows", "lit, after clear"]);
    let why = "runs on the transfer queue, beside `shadows`: that saves up to 8.0 MiB of work, and 2 waits cost as much as 4.0 MiB";
    assert_eq!(note(&plan, "clear"), why);
}

#[test]
fn nothing_moves_beside_graphics_work_that_is_done_sooner_than_the_waits() {
    let plan = plan(&cleared(8 * MIB, 4 * MIB));
    assert_eq!(shown(&plan), ["clear", "shadows", "lit"]);
    assert!(note(&plan, "clear").contains("at most 4.0 MiB of work beside `shadows`"), "{}", note(&plan, "clear"));
}

#[test]
fn do_9_what_runs_in_some_frames_neither_moves_nor_has_anything_beside_it() {
    let mut frame = cleared(8 * MIB, 16 * MIB);
    frame.passes[0].run = Cadence::Every { count: 6, at: 0 };
    let rare = plan(&frame);
    assert_eq!(shown(&rare), ["clear", "shadows", "lit"]);
    assert_eq!(note(&rare, "clear"), "stays on the graphics queue: it doesn't run in every frame");
    let mut frame = cleared(8 * MIB, 16 * MIB);
    frame.passes[1].run = Cadence::Once;
    assert_eq!(shown(&plan(&frame)), ["clear", "shadows", "lit"]);
}

/// `length` dispatches, each of which samples the image of 1 MiB that the one before it wrote.
fn chained(length: usize) -> Frame {
    let mut builder = Builder::default();
    let [shadow, screen] = ["shadow", "screen"].map(|name| image(&mut builder, name, 16 * MIB));
    let mut before = Vec::new();
    for at in 0..length {
        let next = image(&mut builder, &format!("image{at}"), MIB);
        builder.dispatch(&format!("pass{at}"), &before, &[], next);
        before = vec![next];
    }
    builder.draw("shadows", &[], &[], shadow);
    builder.draw("lit", &[shadow, before[0]], &[], screen);
    builder.output(screen)
}

#[test]
fn a_chain_pays_its_waits_once() {
    // The first dispatch writes 1 MiB, the others read as much, too.
    assert_eq!(shown(&plan(&chained(1))), ["pass0", "shadows", "lit"]);
    let chain = plan(&chained(3));
    // The frame before sampled the last image, whose memory no other one has.
    let last = "compute: pass2, after lit of the frame before";
    assert_eq!(shown(&chain), ["compute: pass0", "compute: pass1", last, "shadows", "lit, after pass2"]);
    let why = "runs on the compute queue, beside `shadows`: that saves up to 5.0 MiB of work for it and the 2 other steps that \
               need the same waits, and 2 waits cost as much as 4.0 MiB";
    assert_eq!(["pass0", "pass1", "pass2"].map(|pass| note(&chain, pass)), [why; 3]);
    assert_eq!(chain.totals.waits, 2);
}

#[test]
fn a_small_step_that_stays_does_not_hold_a_heavy_one_back() {
    let mut builder = Builder::default();
    let [heavy, first, shadow, screen] =
        ["heavy", "first", "shadow", "screen"].map(|name| image(&mut builder, name, 16 * MIB));
    let small = image(&mut builder, "small", KIB);
    builder.dispatch("simulate", &[], &[], heavy);
    // On the same queue, `simulate` would have to be done before `count`, and that before `reads`.
    builder.dispatch("count", &[], &[], small);
    builder.draw("reads", &[small], &[], first);
    builder.draw("shadows", &[first], &[], shadow);
    builder.draw("lit", &[shadow, heavy], &[], screen);
    let plan = plan(&builder.output(screen));
    assert_eq!(shown(&plan)[0], "compute: simulate, after lit of the frame before", "{}", plan.tree());
    assert_eq!(plan.steps[1].queue, Queue::Graphics);
    assert!(note(&plan, "count").contains("nothing that neither waits for it"), "{}", note(&plan, "count"));
}

#[test]
fn what_one_run_has_beside_it_another_one_has_not() {
    // `second` begins after `early`, and both dispatches are needed by `lit`.
    let frame = |shadow| {
        let mut builder = Builder::default();
        let [early, shadow] =
            [("early", 4 * KIB), ("shadow", shadow)].map(|(name, size)| image(&mut builder, name, size));
        let [one, other, screen] = ["one", "other", "screen"].map(|name| image(&mut builder, name, 16 * MIB));
        builder.draw("early", &[], &[], early);
        builder.dispatch("first", &[], &[], one);
        builder.dispatch("second", &[early], &[], other);
        builder.draw("shadows", &[], &[], shadow);
        builder.draw("lit", &[shadow, one, other], &[], screen);
        builder.output(screen)
    };
    let on_compute = |frame: &Frame| plan(frame).steps.iter().filter(|step| step.queue == Queue::Compute).count();
    // Beside 64 MiB there is room for both, 16 MiB each; beside 16 MiB for one.
    assert_eq!([64 * MIB, 16 * MIB].map(|shadow| on_compute(&frame(shadow))), [2, 1]);
}

proptest! {
    /// More work, more graphics work beside it, or cheaper waits never bring a step back to graphics.
    #[test]
    fn what_moves_still_moves_if_it_gains_more(work in 1..64_u64, more in 0..64_u64, beside in 0..7_u32, wider in 0..2_u32, wait in 0..16 * MIB, less in 0..16 * MIB) {
        let queue = |work: u64, beside: u32, wait| {
            let frame = cleared(work * 256 * KIB, KIB << (2 * beside));
            queue_of_first(&planned(&frame, &with_wait(wait), &OPTIONS).expect("the frame is valid"))
        };
        let [before, after] = [queue(work, beside, wait), queue(work + more, beside + wider, wait.saturating_sub(less))];
        prop_assert!(before == Queue::Graphics || after == before);
    }
}

/// Another frame of other sizes has the Plan that compiling it anew makes: figures in notes, and queues.
#[test]
fn other_sizes_are_weighed_again() {
    let device = Arc::new(with_wait(2 * MIB));
    let mut compiler = Compiler::new();
    let mut follow = |frame: Frame| {
        let anew = compile(&frame, &device, &mut MemoryEstimate(&device), &OPTIONS).expect("the frame is valid");
        let plan = compiler.compile(&Arc::new(frame), &device, &mut MemoryEstimate(&device), &OPTIONS);
        assert_eq!(plan.expect("the frame is valid"), &anew);
        queue_of_first(&anew)
    };
    let sizes = [KIB, 2 * KIB, 8 * MIB, 9 * MIB, KIB];
    let queues = [Queue::Graphics, Queue::Graphics, Queue::Transfer, Queue::Transfer, Queue::Graphics];
    assert_eq!(sizes.map(|size| follow(cleared(size, 16 * MIB))), queues);
}

/// What is handed in comes in the state of one queue.
#[test]
fn a_step_that_shares_what_is_handed_in_stays_and_says_so() {
    let mut builder = Builder::default();
    let [shadow, texture, screen] = ["shadow", "texture", "screen"].map(|name| image(&mut builder, name, 64 * MIB));
    let before = State { stages: Stages::COPY, accesses: Accesses::TRANSFER_WRITE, layout: Layout::Undefined };
    let staging = builder.buffer("staging", Lifetime::Imported { before, after: None, owner: None });
    builder.0.buffers[staging.0 as usize].bytes = 64 * MIB;
    builder.copy("upload", Resource::Buffer(staging), Resource::Image(texture));
    builder.draw("shadows", &[], &[], shadow);
    let mut of_one_user = Builder(builder.0.clone());
    of_one_user.draw("lit", &[shadow, texture], &[], screen);
    assert_eq!(queue_of_first(&plan(&of_one_user.output(screen))), Queue::Transfer);
    builder.draw("lit", &[shadow, texture], &[staging], screen);
    let plan = plan(&builder.output(screen));
    assert_eq!(shown(&plan), ["upload", "shadows", "lit"]);
    let why = "stays on the graphics queue: it uses something that is handed in and that another queue uses, too";
    assert_eq!(note(&plan, "upload"), why);
}
