//! The measured graphs compile to Plans that keep their promises.

use crate::testing::graphs;
use crate::testing::plans::{compiled, planned};
use framewright_graph::compile::{Options, Order};
use framewright_graph::frame::{Frame, ImageIndex};
use std::collections::HashSet;

#[test]
fn deferred_is_placed_near_its_live_peak_and_has_the_fewest_image_barriers() {
    let plan = compiled(&graphs::deferred());
    let totals = plan.totals;
    assert_eq!(totals.passes, 25);
    assert!(totals.placed_bytes as f64 <= 1.02 * totals.live_peak_bytes as f64, "{totals:?}");
    assert!(totals.placed_bytes <= 1318 * (1 << 20) / 10, "{totals:?}");
    assert_eq!((totals.image_barriers, totals.barrier_calls), (54, 21), "{totals:?}");
}

#[test]
fn equal_sized_graphs_are_placed_at_their_live_peak_if_more_memory_saves_no_call() {
    let low_memory = Options { order: Order::LowMemory, ..Options::default() };
    let [default, low_memory] = [Options::default(), low_memory].map(|options| {
        move |frame: &Frame| planned(frame, &graphs::device(), &options).expect("the graph is valid").totals
    });
    for totals in [
        default(&graphs::chain(100)),
        default(&graphs::local(100)),
        low_memory(&graphs::wide(100)),
        low_memory(&graphs::wide(1000)),
    ] {
        assert_eq!(totals.placed_bytes, totals.live_peak_bytes, "{totals:?}");
    }
}

#[test]
fn a_fiftieth_more_memory_is_taken_where_it_saves_barrier_calls() {
    for (passes, calls) in [(100, 21), (1000, 43), (10_000, 58)] {
        let totals = compiled(&graphs::wide(passes)).totals;
        assert_eq!(totals.barrier_calls, calls, "{totals:?}");
        assert!(totals.placed_bytes * 50 <= totals.live_peak_bytes * 51, "{totals:?}");
    }
}

#[test]
fn the_same_frame_gives_the_same_plan() {
    let texts: Vec<String> =
        (0..2).map(|_| compiled(&graphs::wide(200)).to_json().expect("a Plan has a JSON form")).collect();
    assert_eq!(texts[0], texts[1]);
}

#[test]
fn a_wide_graph_has_one_image_barrier_for_each_image_and_one_for_each_that_is_read() {
    let mut frame = graphs::wide(100);
    // Images that no other pass reads need no reader: what writes them stays by itself.
    frame.passes[99].sampled.truncate(3);
    let read: HashSet<ImageIndex> = frame.passes.iter().flat_map(|pass| &pass.sampled).map(|read| read.image).collect();
    for (number, pass) in (0..).zip(&mut frame.passes) {
        pass.side_effect = !read.contains(&ImageIndex(number));
    }
    let totals = compiled(&frame).totals;
    assert_eq!(totals.image_barriers as usize, 100 + read.len(), "{totals:?}");
    assert_eq!((totals.image_barriers, totals.memory_barriers, totals.barrier_calls), (173, 9, 32));
    assert_eq!(totals.placed_bytes, totals.live_peak_bytes);
}
