//! The shipped library of fragments: what its fragments come to for images of any size.

use crate::testing::pipelines::INPUTS;
use crate::testing::table::Table;
use framewright_graph::base::{self, Root, Sources};
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile, SHIPPED_PROFILES};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::frame::{Frame, ParamValue};
use framewright_graph::language::{self, PipelineFiles};
use framewright_graph::verify::verify;
use std::path::Path;
use std::sync::Arc;

/// A frame that puts `uses` between a picture of the size `extent` and the screen, made into a Plan on every shipped device.
fn frame(extent: [u32; 2], include: &str, uses: &str) -> Frame {
    let text = format!(
        "Pipeline(version: 1, include: [\"library/{include}.ron\"],
        images: [(name: \"color\", format: Color(hdr: true), size: Output), (name: \"screen\", format: Like(\"color\"), size: Output)],
        passes: [(name: \"draw\", draw: FullScreen(\"plain\"), color: [\"color\"]), {uses}], outputs: [\"screen\"])"
    );
    let root = Root::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/pipelines"));
    let mut sources = Sources::default();
    let mut files = PipelineFiles::beside(root, "test.ron", &[]);
    let document = language::read_with(&mut sources, &mut files, "test.ron", "test.ron", text);
    let sources = Arc::new(sources);
    let inputs = Inputs { output_extent: extent, ..INPUTS };
    let frame = document.and_then(|document| expand(&document, sources.clone(), &inputs, &mut Table));
    let frame = frame.unwrap_or_else(|wrong| panic!("{}", base::render(&sources, &wrong)));
    for (name, text) in SHIPPED_PROFILES {
        let device = Profile::from_ron(text).expect("shipped profiles are read");
        let plan = compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default());
        let plan = plan.unwrap_or_else(|wrong| panic!("{extent:?} on {name}: {wrong:?}"));
        assert_eq!(verify(&plan), [], "{extent:?} on {name}");
    }
    frame
}

/// The files of the shipped library, by the names that pipelines include them by.
fn shipped_files() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/pipelines/library");
    let entries = folder.read_dir().expect("the shipped library");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry").path().file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn a_shipped_file_of_fragments_that_is_included_and_not_used_is_no_mistake() {
    let files = shipped_files();
    assert!(files.iter().any(|name| name == "motion"), "{files:?}");
    for include in files {
        let frame = frame([64, 64], &include, r#"(name: "show", draw: FullScreen("plain"), color: ["screen"])"#);
        assert_eq!(frame.passes.len(), 2, "{include}");
    }
}

fn passes(frame: &Frame, within: &str) -> usize {
    frame.passes.iter().filter(|pass| pass.name.contains(within)).count()
}

#[test]
fn bloom_halves_an_image_as_often_as_is_asked_for_and_no_further_than_to_one_texel() {
    let cases = [
        ([1, 1], 1),
        ([2, 1], 1),
        ([3, 5], 1),
        ([4, 400], 2),
        ([64, 63], 5),
        ([64, 64], 6),
        ([640, 360], 8),
        ([4096, 4096], 12),
    ];
    for (extent, most) in cases {
        for levels in [1, 2, 12] {
            let uses = format!(
                "(use: \"bloom\", name: \"glow\", with: {{\"source\": \"color\", \"target\": \"screen\", \"levels\": {levels}}})"
            );
            let frame = frame(extent, "bloom", &uses);
            let expected = levels.min(most);
            assert_eq!(passes(&frame, ".shrink["), expected, "{extent:?}, {levels}");
            assert_eq!(passes(&frame, ".grow["), expected - 1, "{extent:?}, {levels}");
            let smallest = frame.images.iter().rfind(|image| image.name.contains(".down[")).expect("there is one");
            let expected = extent.map(|side| (side >> expected).max(1));
            assert_eq!(smallest.extent[..2], expected, "{extent:?}, {levels}");
        }
    }
}

#[test]
fn a_blur_is_two_passes_as_often_as_it_is_repeated() {
    for times in [1, 2, 5, 64] {
        let uses = format!(
            "(use: \"blur\", name: \"soften\", with: {{\"source\": \"color\", \"target\": \"screen\", \"times\": {times}}})"
        );
        let frame = frame([33, 7], "blur", &uses);
        assert_eq!((passes(&frame, ".rows"), passes(&frame, ".columns")), (times, times));
        assert_eq!(frame.passes.last().map(|pass| pass.color[0].image.0), Some(1), "the last one draws the target");
    }
}

#[test]
fn tone_mapping_has_a_curve_for_each_operator() {
    let operators = ["clip", "reinhard", "white_point", "filmic", "neutral", "reinhard_luminance"];
    for (number, operator) in operators.iter().enumerate() {
        for fragment in ["tone_mapping", "tone_mapping_of_samples"] {
            let uses = format!(
                "(use: \"{fragment}\", name: \"show\", with: {{\"source\": \"color\", \"target\": \"screen\", \
                 \"operator\": \"'{operator}'\"}})"
            );
            let frame = frame([8, 8], "tone_mapping", &uses);
            let params = &frame.passes.last().expect("it maps").params;
            let found = params.iter().find(|(name, _)| &**name == "operator").map(|(_, value)| value.clone());
            assert_eq!(found, Some(ParamValue::Integer(number as i64)), "{fragment}, {operator}");
        }
    }
}

#[test]
fn a_scale_is_one_pass_by_whatever_filter() {
    for filter in ["nearest", "bilinear", "area", "catmull_rom"] {
        let uses = format!(
            "(use: \"scale\", name: \"show\", with: {{\"source\": \"color\", \"target\": \"screen\", \
             \"filter\": \"'{filter}'\"}})"
        );
        let frame = frame([33, 7], "scale", &uses);
        assert_eq!((passes(&frame, "show"), passes(&frame, filter)), (1, 1), "{filter}");
    }
}

#[test]
fn a_blur_of_a_strength_is_as_many_passes() {
    for strength in [1, 2, 5, 64] {
        let uses = format!(
            "(use: \"blur_of_strength\", name: \"soften\", with: {{\"source\": \"color\", \"target\": \"screen\", \
             \"strength\": {strength}}})"
        );
        let frame = frame([33, 7], "blur", &uses);
        assert_eq!(passes(&frame, ".blur"), strength);
        assert_eq!(frame.passes.last().map(|pass| pass.color[0].image.0), Some(1), "the last one draws the target");
    }
}

#[test]
fn an_overlay_shows_any_image_over_what_was_drawn() {
    let uses =
        "(use: \"overlay\", name: \"look\", with: {\"shown\": \"color\", \"target\": \"screen\", \"left\": 0.5})";
    let first = "(name: \"copy\", copy: (from: \"color\", to: \"screen\")), ";
    let frame = frame([8, 8], "overlay", &format!("{first}{uses}"));
    let pass = frame.passes.last().expect("it draws");
    assert_eq!(pass.sampled[0].texture.map(|texture| texture.to_string()).as_deref(), Some("sampler2D"));
}
