//! The Plans of small frames, compared with the least cost of any order and any placement.
//!
//! For each frame every valid order is tried: an exhaustive search says what that order costs at least, and the compiler
//! is made to take that order (the passes are put in it and compiled with `Order::File`). Resolves and image barriers must
//! be equal, memory at most 5 % above, for every single order. What the compiler's own choices of an order reach is
//! printed beside the best over all orders.

use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::Frame;
use framewright_graph::plan::Totals;
use framewright_tests::frames::device;
use framewright_tests::optima::{Cost, costs, graphs, in_order, orders};

/// Frames that are tried.
const FRAMES: u64 = 300;

/// Frames with more valid orders than these are left out.
const MOST_ORDERS: usize = 400;

fn compiled(frame: &Frame, order: Order) -> Totals {
    let device = device();
    let options = Options { order, ..Options::default() };
    compile(frame, &device, &mut MemoryEstimate(&device), &options).expect("the frame is valid").totals
}

fn reached(totals: &Totals) -> Cost {
    Cost { resolves: totals.resolves, barriers: totals.image_barriers, bytes: totals.placed_bytes }
}

/// Sums over frames for one line of the table.
#[derive(Default)]
struct Line {
    resolves: [u64; 2],
    barriers: [u64; 2],
    bytes: [u64; 2],
    worst_barriers: f64,
    worst_bytes: f64,
    equal: [u64; 3],
    count: u64,
}

impl Line {
    fn add(&mut self, least: Cost, reached: Cost) {
        let ratio = |least: u64, reached: u64| if least == 0 { 1.0 } else { reached as f64 / least as f64 };
        self.count += 1;
        for (at, cost) in [least, reached].into_iter().enumerate() {
            self.resolves[at] += u64::from(cost.resolves);
            self.barriers[at] += u64::from(cost.barriers);
            self.bytes[at] += cost.bytes;
        }
        self.worst_barriers = self.worst_barriers.max(ratio(least.barriers.into(), reached.barriers.into()));
        self.worst_bytes = self.worst_bytes.max(ratio(least.bytes, reached.bytes));
        self.equal[0] += u64::from(least.resolves == reached.resolves);
        self.equal[1] += u64::from(least.barriers == reached.barriers);
        self.equal[2] += u64::from(least.bytes == reached.bytes);
    }

    fn text(&self, name: &str) -> String {
        let Line { resolves, barriers, bytes, worst_barriers, worst_bytes, equal, count } = self;
        format!(
            "{name:<28}{count:>8}{:>9}{:>9}{:>7}{:>9}{:>9}{:>7}{worst_barriers:>7.2}{:>11}{:>11}{:>7}{worst_bytes:>7.2}",
            resolves[0],
            resolves[1],
            equal[0],
            barriers[0],
            barriers[1],
            equal[1],
            bytes[0] >> 10,
            bytes[1] >> 10,
            equal[2],
        )
    }
}

/// The page with the table.
const PUBLISHED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/small-optima.md");

/// How a changed table is accepted.
const ACCEPT: &str = "INSTA_UPDATE=always cargo test -p framewright-tests --test suite small_optima";

/// Holds the published table, the block of code in its file, against this one.
fn published(table: &str) {
    let text = std::fs::read_to_string(PUBLISHED).expect("the table is published");
    let [before, old, after] = text.split("```").collect::<Vec<_>>()[..] else {
        panic!("{PUBLISHED} has one block of code")
    };
    let new = format!("\n{table}\n");
    if old != new && std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        let text = format!("{before}```{new}```{after}");
        return std::fs::write(PUBLISHED, text).expect("the table can be written");
    }
    assert_eq!(old, new, "the published table is another one; accept with {ACCEPT}");
}

#[test]
fn every_order_of_small_frames_costs_no_more_than_it_must() {
    let [mut each, mut default, mut low_memory] = [Line::default(), Line::default(), Line::default()];
    let mut worse = Vec::new();
    let mut sizes = [0; 9];
    for seed in 0..FRAMES {
        let frame = graphs::frame(seed, 8);
        let Some(orders) = orders(&frame, MOST_ORDERS) else { continue };
        sizes[frame.passes.len()] += 1;
        let mut best: Option<Cost> = None;
        for order in &orders {
            let frame = in_order(&frame, order);
            let least = costs(&frame);
            let reached = reached(&compiled(&frame, Order::File));
            each.add(least, reached);
            if (reached.resolves, reached.barriers) != (least.resolves, least.barriers)
                || reached.bytes as f64 > 1.05 * least.bytes as f64
            {
                worse.push(format!("seed {seed}, order {order:?}: at least {least:?}, reached {reached:?}"));
            }
            let so_far = best.unwrap_or(least);
            best = Some(Cost {
                resolves: so_far.resolves.min(least.resolves),
                barriers: so_far.barriers.min(least.barriers),
                bytes: so_far.bytes.min(least.bytes),
            });
        }
        if let Some(best) = best {
            default.add(best, reached(&compiled(&frame, Order::Default)));
            low_memory.add(best, reached(&compiled(&frame, Order::LowMemory)));
        }
    }
    let table = [
        format!("frames of 0 to 8 passes: {sizes:?}"),
        format!("{:<36}{:>25}{:>32}{:>36}", "", "resolves", "image barriers", "KiB of transient memory"),
        format!(
            "{:<28}{:>8}{:>9}{:>9}{:>7}{:>9}{:>9}{:>7}{:>7}{:>11}{:>11}{:>7}{:>7}",
            "",
            "count",
            "least",
            "reached",
            "equal",
            "least",
            "reached",
            "equal",
            "worst",
            "least",
            "reached",
            "equal",
            "worst"
        ),
        each.text("each valid order by itself"),
        default.text("default, best of all orders"),
        low_memory.text("low-memory, best of all"),
    ]
    .join("\n");
    println!("{table}");
    worse.iter().take(8).for_each(|line| println!("{line}"));
    assert!(each.count > 5_000, "{}", each.count);
    assert!(worse.is_empty(), "{} of {} orders cost more than they must", worse.len(), each.count);
    published(&table);
}
