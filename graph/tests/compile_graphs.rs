//! The measured graphs compile to Plans that keep their promises.

mod graphs;

use framewright_graph::compile::{Options, compile};
use framewright_graph::device::Estimated;
use framewright_graph::frame::Frame;
use framewright_graph::plan::Plan;
use framewright_graph::verify::verify;

fn compiled(frame: &Frame) -> Plan {
    let device = graphs::device();
    let plan = compile(frame, &device, &mut Estimated(&device), &Options::default()).expect("the graph is legal");
    assert_eq!(verify(&plan), [], "{}", plan.tree());
    plan
}

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
fn equal_sized_graphs_are_placed_at_their_live_peak() {
    for frame in [graphs::chain(100), graphs::wide(100), graphs::local(100), graphs::wide(1000)] {
        let totals = compiled(&frame).totals;
        assert_eq!(totals.placed_bytes, totals.live_peak_bytes, "{totals:?}");
    }
}

#[test]
fn the_same_frame_gives_the_same_plan() {
    let texts: Vec<String> =
        (0..2).map(|_| compiled(&graphs::wide(200)).to_json().expect("a Plan has a JSON form")).collect();
    assert_eq!(texts[0], texts[1]);
}
