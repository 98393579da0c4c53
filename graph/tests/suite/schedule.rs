//! Every order is valid and the same each time; the default one merges, batches and saves memory; the low-memory one saves
//! more.

use crate::testing::graphs::{self, Builder};
use crate::testing::plans::planned;
use crate::testing::raster::{Raster, device};
use framewright_graph::compile::{Options, Order};
use framewright_graph::frame::{Blend, Frame, ImageIndex, Resource};
use framewright_graph::plan::{Plan, Work};
use framewright_graph::vulkan::Format::{R8G8B8A8_UNORM, R16G16B16A16_SFLOAT};

const ORDERS: [Order; 5] = [Order::File, Order::Default, Order::LowMemory, Order::Random(1), Order::Random(2)];

fn compiled(frame: &Frame, order: Order) -> Plan {
    let options = Options { order, ..Options::default() };
    planned(frame, &device(), &options).unwrap_or_else(|errors| panic!("{order:?}: {errors:?}"))
}

/// The passes of each step.
fn steps(plan: &Plan) -> Vec<Vec<&str>> {
    let passes = plan.steps.iter().map(|step| match &step.work {
        Work::Render(scope) => scope.passes.iter().map(|pass| &*pass.name).collect(),
        Work::Dispatch(pass) | Work::Custom(pass) => vec![&*pass.name],
        _ => Vec::new(),
    });
    passes.filter(|passes: &Vec<&str>| !passes.is_empty()).collect()
}

fn measured() -> Vec<(&'static str, Frame)> {
    vec![
        ("deferred", graphs::deferred()),
        ("chain 100", graphs::chain(100)),
        ("wide 25", graphs::wide(25)),
        ("wide 100", graphs::wide(100)),
        ("wide 1,000", graphs::wide(1000)),
        ("local 100", graphs::local(100)),
        ("local 1,000", graphs::local(1000)),
    ]
}

#[test]
fn every_order_runs_every_pass_legally_and_the_same_each_time() {
    for frame in [graphs::deferred(), graphs::wide(100), graphs::local(100)] {
        for order in ORDERS {
            let plan = compiled(&frame, order);
            assert_eq!(plan.totals.passes as usize, frame.passes.len(), "{order:?}");
            assert_eq!(plan, compiled(&frame, order), "{order:?}");
        }
    }
}

#[test]
fn the_order_of_the_file_is_kept_where_it_is_asked_for() {
    let frame = graphs::wide(100);
    let plan = compiled(&frame, Order::File);
    let names: Vec<&str> = frame.passes.iter().map(|pass| &*pass.name).collect();
    assert_eq!(steps(&plan).concat(), names);
}

#[test]
fn seeds_give_different_orders() {
    let frame = graphs::wide(100);
    let [one, other] = [1, 2].map(|seed| compiled(&frame, Order::Random(seed)));
    assert_ne!(steps(&one), steps(&other));
}

#[test]
fn the_default_order_costs_no_more_barriers_and_no_more_memory_than_that_of_the_file() {
    for (name, frame) in measured() {
        let [file, default] = [Order::File, Order::Default].map(|order| compiled(&frame, order).totals);
        assert!(default.image_barriers <= file.image_barriers, "{name}: {default:?} against {file:?}");
        assert!(default.memory_barriers <= file.memory_barriers, "{name}: {default:?} against {file:?}");
        assert!(default.barrier_calls <= file.barrier_calls, "{name}: {default:?} against {file:?}");
        assert!(default.placed_bytes * 50 <= file.placed_bytes * 51, "{name}: {default:?} against {file:?}");
    }
}

/// Four chains of four passes, one after the other in the file, and a pass that reads the end of each.
fn four_chains() -> Frame {
    let mut builder = Builder::default();
    let mut ends = Vec::new();
    for chain in 0..4 {
        let mut before: Option<ImageIndex> = None;
        for link in 0..4 {
            let image = builder.image(&format!("image{chain}{link}"), R8G8B8A8_UNORM, 64, 64);
            builder.pass(&format!("pass{chain}{link}"), before.as_slice(), &[(image, false)]);
            before = Some(image);
        }
        ends.extend(before);
    }
    let last = builder.image("last", R8G8B8A8_UNORM, 64, 64);
    builder.pass("last", &ends, &[(last, false)]);
    let mut frame = builder.output(last);
    // Images of their own memory: no call serves a hand-over.
    let outputs = (0..frame.images.len() as u32 - 1).map(|image| Resource::Image(ImageIndex(image)).into());
    frame.outputs.extend(outputs);
    frame
}

#[test]
fn passes_that_do_not_depend_on_each_other_share_a_barrier_call() {
    let frame = four_chains();
    assert_eq!(compiled(&frame, Order::Default).totals.barrier_calls, 5);
    assert!(compiled(&frame, Order::File).totals.barrier_calls > 5);
}

#[test]
fn effects_that_nothing_shows_share_a_barrier_call_in_their_order() {
    let mut frame = four_chains();
    frame.passes.iter_mut().step_by(4).take(4).for_each(|pass| pass.side_effect = true);
    let plan = compiled(&frame, Order::Default);
    assert_eq!(plan.totals.barrier_calls, 5);
    assert_eq!(steps(&plan).concat()[..4], ["pass00", "pass10", "pass20", "pass30"]);
}

#[test]
fn draws_into_the_same_image_are_brought_together() {
    let mut raster = Raster::default();
    let (color, other, last) = (
        raster.image("color", R8G8B8A8_UNORM, 1),
        raster.image("other", R16G16B16A16_SFLOAT, 1),
        raster.image("last", R8G8B8A8_UNORM, 1),
    );
    raster.objects("opaque").clear(color);
    raster.full_screen("aside").color(other, Blend::Replace);
    raster.full_screen("haze").color(color, Blend::Alpha);
    raster.full_screen("both").sample(color).sample(other).color(last, Blend::Replace);
    let frame = raster.output(last);
    assert_eq!(compiled(&frame, Order::File).totals.scopes, 4);
    for order in [Order::Default, Order::LowMemory] {
        let plan = compiled(&frame, order);
        assert!(steps(&plan).contains(&vec!["opaque", "haze"]), "{}", plan.tree());
    }
}

#[test]
fn what_a_later_draw_waits_for_comes_before_the_draws_that_it_joins() {
    let mut raster = Raster::default();
    let (color, other) = (raster.image("color", R8G8B8A8_UNORM, 1), raster.image("other", R16G16B16A16_SFLOAT, 1));
    raster.objects("opaque").clear(color);
    raster.full_screen("aside").color(other, Blend::Replace);
    raster.full_screen("haze").sample(other).color(color, Blend::Alpha);
    let frame = raster.output(color);
    assert_eq!(steps(&compiled(&frame, Order::Default)), [vec!["aside"], vec!["opaque", "haze"]]);
}

#[test]
fn effects_that_nothing_shows_keep_their_order() {
    let mut frame = graphs::wide(100);
    for pass in &mut frame.passes {
        pass.side_effect = true;
    }
    for order in ORDERS {
        assert_eq!(steps(&compiled(&frame, order)), steps(&compiled(&frame, Order::File)), "{order:?}");
    }
}

#[test]
fn the_low_memory_order_never_takes_more_than_the_others() {
    for (name, frame) in measured() {
        let least = compiled(&frame, Order::LowMemory).totals.live_peak_bytes;
        for order in [Order::File, Order::Default] {
            let other = compiled(&frame, order).totals.live_peak_bytes;
            assert!(least <= other, "{name}: {least} against {other} of {order:?}");
        }
    }
}

#[test]
fn the_low_memory_order_of_a_wide_graph_takes_two_fifths_of_the_sum() {
    let totals = compiled(&graphs::wide(1000), Order::LowMemory).totals;
    assert!(totals.placed_bytes * 1000 <= totals.transient_bytes * 392, "{totals:?}");
}
