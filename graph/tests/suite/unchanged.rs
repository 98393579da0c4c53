//! A frame that is the last one costs no allocation.

use crate::testing::graphs;
use framewright_graph::compile::{Compiler, Options, Reuse};
use framewright_graph::device::MemoryEstimate;
use std::sync::Arc;

#[test]
fn the_same_frame_again_and_an_equal_one_allocate_nothing() {
    let (device, options) = (Arc::new(graphs::device()), Options::default());
    for frame in [graphs::deferred(), graphs::chain(1000), graphs::wide(100)].map(Arc::new) {
        let equal = Arc::new(framewright_graph::frame::Frame::clone(&frame));
        let mut compiler = Compiler::new();
        let mut allocations = |frame| {
            let counted = allocation_counter::measure(|| {
                let plan = compiler.compile(frame, &device, &mut MemoryEstimate(&device), &options);
                assert!(plan.is_ok());
            });
            (counted.count_total, compiler.reuse())
        };
        let (first, reuse) = allocations(&frame);
        assert!(first > frame.passes.len() as u64, "the counting allocator counts: {first}");
        assert_eq!(reuse, Reuse::Nothing);
        assert_eq!(allocations(&frame), (0, Reuse::Everything));
        assert_eq!(allocations(&equal), (0, Reuse::Everything));
    }
}
