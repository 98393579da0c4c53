//! How a pass looks up what it samples: filters between texels and mip levels, and what lies beyond the edges.

use crate::table::{INPUTS, right};
use framewright_graph::vocabulary::{AddressMode, Filter, Sampler};

/// The sampler of a pass that samples an image of this format, with these fields beside its name.
fn sampler(format: &str, fields: &str) -> Sampler {
    let text = format!(
        r#"Pipeline(
            version: 1,
            images: [(name: "screen", format: Output, size: Output), (name: "source", format: {format}, size: Output)],
            passes: [
                (name: "fill", fill: (to: "source", value: 0)),
                (name: "show", draw: FullScreen("downsample"), sample: {{"source": (image: "source", {fields})}},
                    color: ["screen"]),
            ],
            outputs: ["screen"],
        )"#
    );
    right(&text, &INPUTS).passes[1].sampled[0].sampler
}

#[test]
fn a_sampler_ends_at_the_edges_and_takes_the_nearest_mip_level_unless_the_file_says_more() {
    assert_eq!(sampler("R8_UNORM", ""), Sampler::new(Filter::Linear));
    assert_eq!(sampler("Depth", ""), Sampler::new(Filter::Nearest));
    let nearest = Sampler::new(Filter::Nearest);
    assert_eq!(sampler("R8_UNORM", "filter: Nearest"), nearest);
    assert_eq!(sampler("R8_UNORM", "filter: Nearest, mip_filter: Linear"), Sampler { mips: Filter::Linear, ..nearest });
    assert_eq!(sampler("R8_UNORM", "filter: Nearest, mip_filter: Nearest, address: Clamp"), nearest);
}

#[test]
fn each_word_for_what_lies_beyond_the_edges_is_one_of_vulkans() {
    for (word, address) in
        [("Clamp", AddressMode::ClampToEdge), ("Repeat", AddressMode::Repeat), ("Mirror", AddressMode::MirroredRepeat)]
    {
        let wanted = Sampler { address, ..Sampler::new(Filter::Linear) };
        assert_eq!(sampler("R8_UNORM", &format!("address: {word}")), wanted);
    }
}
