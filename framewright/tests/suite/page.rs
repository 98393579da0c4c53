//! The page on embedding holds the examples, word for word (EM-1).

use framewright_tests::render::{self, in_repository};

#[test]
fn the_page_on_embedding_holds_the_examples() {
    let text = |path: &str| std::fs::read_to_string(in_repository(path)).expect("a text");
    let page = text("docs/embedding.md");
    for example in [
        "embed_minimal.rs",
        "embed_changing.rs",
        "custom_pass.rs",
        "own_window.rs",
        "embedding/settings.rs",
        "embedding/imports.rs",
        "embedding/moving.rs",
        "embedding/threads.rs",
        "embedding/exact_device.rs",
    ] {
        let example = format!("examples/{example}");
        assert!(page.contains(&format!("```rust\n{}```", text(&example))), "docs/embedding.md doesn't hold {example}");
    }
    assert!(page.contains("examples/headless_batch.rs"));
    for example in [
        "embed_minimal.rs",
        "embed_changing.rs",
        "headless_batch.rs",
        "custom_pass.rs",
        "own_window.rs",
        "embed_own_device.rs",
        "openxr_layers.rs",
        "openxr/runtime.rs",
    ] {
        assert!(text(&format!("examples/{example}")).lines().count() < 150, "{example} is long");
    }
}

#[path = "../../../examples/custom_pass/interface.rs"]
mod interface;

#[path = "../../../examples/embedding/moving.rs"]
mod moving;

#[test]
fn the_example_of_data_that_changes_draws_each_frame_with_its_own() {
    let Some(device) = render::device() else { return };
    let pictures = moving::draw(device).expect("drawn");
    // The triangle is a quarter of the width wide at the bottom, and moves an eighth of it with each frame.
    let first_white = |picture: &framewright::Texels| {
        let last_row = picture.bytes.as_chunks::<4>().0.chunks(64).next_back().expect("rows");
        last_row.iter().position(|texel| texel[0] == 255)
    };
    let left: Vec<_> = pictures.iter().map(first_white).collect();
    assert_eq!(left, [Some(0), Some(8), Some(16)]);
    render::silent(device).expect("silent");
}

#[path = "../../../examples/embedding/settings.rs"]
mod settings;

#[test]
fn the_example_of_settings_draws_what_it_says() {
    let Some(device) = render::device() else { return };
    let pictures = settings::draw(device, &crate::testing::scene()).expect("drawn");
    let light = |at: usize| pictures[at].bytes.iter().map(|byte| u64::from(*byte)).sum::<u64>();
    assert!(light(1) > light(0), "{} and {}", light(0), light(1));
    assert_eq!(pictures[2].extent[..2], [32, 32]);
    render::silent(device).expect("silent");
}

/// Draws, and asks in a custom pass for what the pass doesn't name.
struct Curious;

impl framewright::DrawSource for Curious {
    fn record(
        &mut self,
        _: framewright::Draw,
        _: &mut framewright::Recorder<'_>,
    ) -> Result<u32, framewright::vulkan::Error> {
        Ok(0)
    }

    fn custom(
        &mut self,
        _: &str,
        recorder: &mut framewright::CustomRecorder<'_>,
    ) -> Result<(), framewright::vulkan::Error> {
        assert!(recorder.image("screen").is_none());
        recorder.fill("list", framewright::graph::vulkan::FillValue::Bits([0; 4]));
        Ok(())
    }
}

/// The renderer compiles for the check, and the place of the pass is told (DO-8).
#[test]
fn do_8_a_broken_promise_is_told_with_the_place_of_the_pass() {
    const PIPELINE: &str = r#"Pipeline(
    version: 1,
    images: [(name: "drawn", format: Output, size: Output), (name: "screen", format: Output, size: Output)],
    buffers: [(name: "list", bytes: 16)],
    passes: [
        (name: "clear", fill: (to: "drawn", value: 0)),
        (name: "own", custom: "own", writes: ["list"]),
        (name: "show", draw: FullScreen("copy"), sample: {"source": "drawn"}, color: ["screen"]),
    ],
    outputs: ["screen", "list"],
)"#;
    let Some(device) = render::device() else { return };
    for check_uses in [false, true] {
        let mut options = framewright::RendererOptions::default();
        options.executor.check_uses = check_uses;
        let mut renderer = framewright::Renderer::carried(device, "own.ron", PIPELINE, options).expect("a renderer");
        renderer.set_extent([16, 16]).expect("a size");
        let drawn = renderer.frame(&mut Curious).map(drop).map_err(|error| error.to_string());
        let told = "pass `own` (own.ron:7:16) doesn't name `screen`, and the program asked the recorder for it";
        assert_eq!(drawn, if check_uses { Err(told.to_owned()) } else { Ok(()) });
    }
    render::silent(device).expect("silent");
}
