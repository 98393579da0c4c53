//! Encodings of outputs as a file declares them.

use crate::testing::pipelines::{INPUTS, frame, right};
use framewright_graph::vulkan::Encoding::{self, *};
use framewright_graph::vulkan::Format;

/// A pipeline whose one output has this format and these fields beside its name.
fn text(format: Format, fields: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            images: [(name: "screen", format: {format}, size: Output)],
            passes: [(name: "show", draw: FullScreen("plain"), color: ["screen"])],
            outputs: [(image: "screen", {fields})],
        )"#
    )
}

#[test]
fn an_output_has_the_encoding_that_the_file_says_if_its_format_can_hold_it() {
    let color = |format: &&Format| !format.is_depth() && !format.is_integer();
    let mut fitting = 0;
    for format in Format::ALL.iter().filter(color) {
        for encoding in [Srgb, Unorm, Linear, Hdr10] {
            let said = frame(&text(*format, &format!("encoding: {}", encoding.name())), &INPUTS);
            let found: Option<Option<Encoding>> = said.ok().map(|frame| frame.outputs[0].encoding);
            assert_eq!(found, encoding.fits(*format).then_some(Some(encoding)), "{format} as {encoding:?}");
            fitting += usize::from(found.is_some());
        }
    }
    assert!(fitting > 10, "only {fitting} fit");
}

#[test]
fn without_a_word_the_format_says_what_numbers_mean() {
    assert_eq!(right(&text(Format::R8G8B8A8_SRGB, ""), &INPUTS).outputs[0].encoding, None);
}
