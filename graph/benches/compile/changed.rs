//! The same frame with other values, and with other sizes.

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

pub(crate) fn with_sizes(frame: &Frame) -> Frame {
    let mut frame = with_values(frame);
    frame.images.iter_mut().for_each(|image| image.extent = image.extent.map(|side| side.div_ceil(2)));
    frame
}
