//! How a pass looks up what it samples: filters between texels and mip levels, and what lies beyond the edges.

use crate::testing::pipelines::{INPUTS, right};
use framewright_graph::vulkan::{AddressMode, CompareOp, Filter, Sampler};

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

#[test]
fn an_expression_chooses_a_filter_and_an_address_mode_by_their_words() {
    let chosen = "filter: \"if(2 > 1, 'Nearest', 'Linear')\", mip_filter: \"'Linear'\", address: \"'Mirror'\"";
    let wanted =
        Sampler { mips: Filter::Linear, address: AddressMode::MirroredRepeat, ..Sampler::new(Filter::Nearest) };
    assert_eq!(sampler("R8_UNORM", chosen), wanted);
}

#[test]
fn a_sampler_compares_where_shader_and_file_say_so() {
    let compared = |fields: &str| {
        let text = format!(
            r#"Pipeline(
                version: 1,
                images: [(name: "screen", format: Output, size: Output), (name: "depth", format: Depth, size: Output)],
                passes: [
                    (name: "fill", fill: (to: "depth", value: 0)),
                    (name: "show", draw: FullScreen("shadowed"), sample: {{"shadow": (image: "depth", {fields})}},
                        color: ["screen"]),
                ],
                outputs: ["screen"],
            )"#
        );
        right(&text, &INPUTS).passes[1].sampled[0].sampler
    };
    let nearest = Sampler::new(Filter::Nearest);
    assert_eq!(compared("compare: Less"), Sampler { compare: Some(CompareOp::Less), ..nearest });
    let linear = Sampler { compare: Some(CompareOp::GreaterOrEqual), ..Sampler::new(Filter::Linear) };
    assert_eq!(compared("compare: \"'GreaterOrEqual'\", filter: Linear"), linear);
}

#[test]
fn a_fragment_hands_on_the_filter_that_it_is_given() {
    let text = r#"Pipeline(
        version: 1,
        fragments: [(name: "look",
            parameters: [
                (name: "source", value: Image), (name: "target", value: Image),
                (name: "filter", value: OneOf(default: "Linear", of: ["Nearest", "Linear"])),
            ],
            passes: [(name: "look", draw: FullScreen("downsample"), color: ["target"],
                sample: {"source": (image: "source", filter: "filter")})])],
        images: [
            (name: "source", format: R8_UNORM, size: Output), (name: "one", format: Output, size: Output),
            (name: "other", format: Output, size: Output),
        ],
        passes: [
            (name: "fill", fill: (to: "source", value: 0)),
            (use: "look", name: "first", with: {"source": "source", "target": "one"}),
            (use: "look", name: "second", with: {"source": "source", "target": "other", "filter": "'Nearest'"}),
        ],
        outputs: ["one", "other"],
    )"#;
    let passes = right(text, &INPUTS).passes;
    let filters: Vec<Filter> = passes[1..].iter().map(|pass| pass.sampled[0].sampler.filter).collect();
    assert_eq!(filters, [Filter::Linear, Filter::Nearest]);
}
