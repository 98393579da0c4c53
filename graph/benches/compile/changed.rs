//! The same frame with other values.

use framewright_graph::frame::{Frame, Groups, Work};

pub(crate) fn with_values(frame: &Frame) -> Frame {
    let mut frame = frame.clone();
    for pass in &mut frame.passes {
        if let Work::Dispatch { groups, .. } = &mut pass.work {
            *groups = Groups::Invocations([128, 128, 1]);
        }
    }
    frame
}
