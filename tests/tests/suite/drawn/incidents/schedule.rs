//! Bad orders, graphs that were lists, errors without a place, scenes too large.

use super::right;
use framewright_graph::base::{self, Sources};
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::ImageIndex;
use framewright_graph::language;
use framewright_graph::plan::{Plan, Work};
use framewright_graph::vulkan::Format::R8G8B8A8_UNORM;
use framewright_tests::frames::{Builder, device};
use framewright_tests::happens_before::judge;
use framewright_tests::incidents::diamond;
use framewright_tests::optima::orders;
use std::collections::BTreeSet;

/// The passes of a Plan in the order in which they run.
fn order(plan: &Plan) -> Vec<String> {
    let passes = plan.steps.iter().flat_map(|step| match &step.work {
        Work::Render(scope) => scope.passes.iter().map(|pass| pass.name.to_string()).collect(),
        Work::Dispatch(pass) => vec![pass.name.to_string()],
        _ => Vec::new(),
    });
    passes.collect()
}

/// A table of priorities was wrong for a long time, unseen. Golden Plans show the order of every shipped pipeline; this
/// shows that each order is valid and the same every time.
#[test]
fn godot_119204_orders_are_the_same_every_time() {
    for order_of in [Order::File, Order::Default, Order::LowMemory, Order::Random(7)] {
        let options = Options { order: order_of, ..Options::default() };
        let first = order(&right(&diamond(), &options));
        assert_eq!(first, order(&right(&diamond(), &options)), "{order_of:?}");
        assert_eq!(first.len(), 5, "{first:?}");
    }
}

/// It was "not a real dependency graph": what ran when was what the file said. Here the order follows from the data: every
/// order that the data allows is taken by some seed, no other one is, and all of them make the same picture.
#[test]
fn vk_graph_94_passes_are_ordered_by_their_data_and_by_nothing_else() {
    let valid: BTreeSet<Vec<String>> = orders(&diamond(), 100)
        .expect("a diamond has few orders")
        .into_iter()
        .map(|order| order.into_iter().map(|pass| diamond().passes[pass].name.to_string()).collect())
        .collect();
    let made = |seed| right(&diamond(), &Options { order: Order::Random(seed), ..Options::default() });
    let taken: BTreeSet<Vec<String>> = (0..400).map(|seed| order(&made(seed))).collect();
    assert_eq!(taken, valid);
    let outcomes: BTreeSet<_> = (0..20).map(|seed| judge(&made(seed)).outcome).collect();
    assert_eq!(outcomes.len(), 1);
}

/// Errors came again and again, without a place.
#[test]
fn o3de_10413_each_mistake_is_said_once_and_with_its_place() {
    let text = "Pipeline(version: 1, settings: [], images: [\n    (name: \"screen\", format: Output, size: Output),\n], \
                passes: [\n    (name: \"a\", draw: FullScreen(\"copy\"), sample: {\"source\": \"colour\"}, color: [\"screen\"]),\n\
                    (name: \"b\", draw: FullScreen(\"copy\"), sample: {\"source\": \"colour\"}, color: [\"screen\"]),\n], \
                outputs: [\"screen\"])";
    let mut sources = Sources::default();
    let mistakes =
        language::read(&mut sources, "bad.ron", "bad.ron", text.to_owned()).expect_err("`colour` is no image");
    let shown = base::render(&sources, &mistakes);
    assert_eq!(mistakes.len(), 2, "{shown}");
    assert!(shown.contains("bad.ron:4:") && shown.contains("bad.ron:5:"), "{shown}");
}

/// One bad file closed the editor.
#[test]
fn o3de_16359_a_bad_file_is_an_error_and_no_crash() {
    for text in ["", "Pipeline(", "Pipeline(version: 9)", "\u{0}", "Pipeline(version: 1, images: 7)"] {
        let mut sources = Sources::default();
        assert!(language::read(&mut sources, "bad.ron", "bad.ron", text.to_owned()).is_err(), "{text:?}");
    }
}

/// The graph's memory ran out on large scenes.
#[test]
fn filament_10320_a_graph_of_ten_thousand_passes_compiles() {
    let mut builder = Builder::default();
    let images: Vec<ImageIndex> =
        (0..10_000).map(|at| builder.image(&format!("i{at}"), R8G8B8A8_UNORM, 16, 1)).collect();
    builder.dispatch("p0").store(images[0], false);
    for at in 1..images.len() {
        builder.dispatch(&format!("p{at}")).sample(images[at - 1]).store(images[at], false);
    }
    let device = device();
    let frame = builder.outputs(&[images[images.len() - 1]]);
    let plan = compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default()).expect("the frame is valid");
    assert_eq!(plan.totals.passes, 10_000);
    // Two images are alive at a time.
    assert_eq!(plan.totals.placed_bytes, plan.totals.live_peak_bytes);
}
