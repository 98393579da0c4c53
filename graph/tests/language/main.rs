//! The shipped pipelines, and what the language's words come to in a frame.

mod table;

use framewright_graph::expand::Inputs;
use framewright_graph::frame::Frame;
use table::{INPUTS, frame, set, shipped};

fn names(frame: &Frame) -> Vec<&str> {
    frame.passes.iter().map(|pass| &*pass.name).collect()
}

fn forward(values: &[(&str, &str)]) -> Frame {
    frame(&shipped("forward.ron"), &Inputs { set: &set(values), ..INPUTS }).unwrap_or_else(|text| panic!("{text}"))
}

#[test]
fn forward_holds_all_passes_by_default() {
    let frame = forward(&[]);
    assert_eq!(names(&frame), ["opaque", "masked", "sky", "transparent", "tone_map"]);
    assert!(frame.switched_off.is_empty());
    let shown: Vec<(&str, &str)> = frame.settings.iter().map(|(name, value)| (&**name, &**value)).collect();
    assert_eq!(shown, [("msaa", "4"), ("hdr", "true"), ("tone_mapping", "true"), ("white_point", "100")]);
}
