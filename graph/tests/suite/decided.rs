//! Which fact decided (NU-6): the Plan names the facts and settings behind each format, pass, image, cascade and copy.

use crate::testing::pipelines::{INPUTS, right, set, shipped};
use crate::testing::plans::{compiled, image};
use framewright_graph::compile::{Compiler, Options, Reuse};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{DecidedBy, Draw, NamedValue, Property, Subject};
use framewright_graph::language::{Fact, Facts};
use framewright_graph::plan::{Plan, Stage, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format;
use std::sync::Arc;

/// Light, shadow maps, glass, two sources to choose from, a copy, and a draw that only a setting asks for.
const TEXT: &str = r#"Pipeline(
    version: 1,
    settings: [
        (name: "hdr", value: Bool(default: true)),
        (name: "msaa", value: OneOf(default: 4, of: [1, 4])),
        (name: "cascades", value: Integer(default: 4, min: 1, max: 4)),
        (name: "blur", value: Bool(default: false)),
    ],
    fragments: [
        (name: "cast", parameters: [(name: "map", value: Image), (name: "cascades", value: Integer(min: 1, max: 4))],
            passes: [(name: "opaque", repeat: ("i", "cascades"), shader: "casters",
                draw: Casters(list: Opaque, cascade: "i", of: "cascades"),
                depth: (image: "map", layer: "i", clear: 0.0))]),
    ],
    images: [
        (name: "shadow", format: Depth, size: Fixed(64, 64), layers: "min(cascades, scene.objects)"),
        (name: "color", format: Color(hdr: "hdr && view.allows_hdr && scene.peak_radiance > 1"),
            size: Scaled("if(view.allows_scale, 0.5, 1)"), samples: "if(view.allows_msaa, msaa, 1)"),
        (name: "depth", format: Depth, size: Like("color"), samples: Like("color")),
        (name: "soft", format: Like("color"), size: Like("color")),
        (name: "kept", format: Like("color"), size: Like("color")),
        (name: "screen", format: Output, size: Like("color")),
    ],
    passes: [
        (use: "cast", name: "sun", when: "scene.casts_shadows && scene.suns > 0",
            with: {"map": "shadow", "cascades": "layers(shadow)"}),
        (name: "draw", draw: Objects(Opaque), shader: "lit",
            sample: {"sun_shadow": (image: "shadow", when: "scene.casts_shadows && scene.suns > 0")},
            params: {"shadow_taps": 3},
            color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
        (name: "glass", when: "scene.has_transparent", draw: Objects(Transparent), shader: "lit",
            color: [(image: "color", blend: Premultiplied)], depth: (image: "depth", write: false)),
        (name: "soften", when: "blur", draw: FullScreen("blur_tent"), sample: {"source": "color"}, color: ["soft"],
            otherwise: Forward(from: "color", to: "soft")),
        (name: "keep", when: "scene.has_alpha_clip", copy: (from: "soft", to: "kept"),
            otherwise: Clear(image: "kept", value: 0.0)),
        (name: "show", draw: FullScreen("copy"), sample: {"source": "if(scene.has_alpha_clip, kept, soft)"}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#;

const FACTS: Facts = Facts {
    has_transparent: true,
    has_alpha_clip: true,
    casts_shadows: true,
    peak_radiance: 0.75,
    suns: 1,
    objects: 2,
    ..Facts::UNKNOWN
};

fn plan(facts: Facts, settings: &[(&str, &str)]) -> Plan {
    let settings = set(settings);
    compiled(&right(TEXT, &Inputs { facts, facts_known: true, set: &settings, ..INPUTS }))
}

/// The names and values that decided a property, facts before the bar; none if nothing decided it.
fn decided(plan: &Plan, subject: &Subject, what: Property) -> String {
    let found: Vec<_> = plan.decided.iter().filter(|it| it.subject == *subject && it.what == what).collect();
    assert!(found.len() < 2, "{found:?}");
    let list = |all: &[NamedValue]| all.iter().map(|it| format!("{} = {}", it.name, it.value)).collect::<Vec<_>>();
    found.first().map_or_else(String::new, |it| {
        let DecidedBy { facts, settings } = &*it.by;
        format!("{} | {}", list(facts).join(", "), list(settings).join(", "))
    })
}

#[test]
fn two_fields_of_a_format_decide_together() {
    let text = TEXT
        .replace("hdr && view.allows_hdr && scene.peak_radiance > 1\"", "scene.peak_radiance > 1\", alpha: \"!blur\"");
    let plan = compiled(&right(&text, &Inputs { facts: FACTS, facts_known: true, ..INPUTS }));
    assert_eq!(of_image(&plan, "color", Property::Format), "scene.peak_radiance = 0.75 | blur = false");
}

fn of_image(plan: &Plan, name: &str, what: Property) -> String {
    decided(plan, &Subject::Image(name.into()), what)
}

fn of_pass(plan: &Plan, name: &str, what: Property) -> String {
    decided(plan, &Subject::Pass(name.into()), what)
}

/// The lines of the tree that stand under the line that contains `title`, without the branches.
fn under(plan: &Plan, title: &str) -> Vec<String> {
    let tree = plan.tree();
    let depth = |line: &str| line.find(|it: char| !"│├└─ ".contains(it)).unwrap_or(line.len());
    let mut lines = tree.lines().skip_while(|line| !line.contains(title));
    let first = lines.next().unwrap_or_else(|| panic!("no `{title}`:\n{tree}"));
    let own = lines.take_while(|line| depth(line) > depth(first));
    own.map(|line| line.trim_start_matches(|it| "│├└─ ".contains(it)).to_owned()).collect()
}

#[test]
fn a_format_names_the_fact_that_alone_decided_it() {
    let dark = plan(FACTS, &[]);
    assert_eq!(image(&dark, "color").format, Format::R8G8B8A8_SRGB);
    assert_eq!(of_image(&dark, "color", Property::Format), "scene.peak_radiance = 0.75 | ");
    assert!(under(&dark, "`color` R8G8B8A8_SRGB").contains(&"format: by scene.peak_radiance = 0.75".to_owned()));
    // An image that follows another one follows its decision.
    assert_eq!(of_image(&dark, "kept", Property::Format), "scene.peak_radiance = 0.75 | ");

    let bright = plan(Facts { peak_radiance: 3.0, ..FACTS }, &[]);
    assert_eq!(image(&bright, "color").format, Format::R16G16B16A16_SFLOAT);
    let all = "view.allows_hdr = true, scene.peak_radiance = 3 | hdr = true";
    assert_eq!(of_image(&bright, "color", Property::Format), all);
    let line = "format: by view.allows_hdr = true, scene.peak_radiance = 3; set by hdr = true";
    assert!(under(&bright, "`color` R16G16B16A16_SFLOAT").contains(&line.to_owned()), "{}", bright.tree());

    let plain = plan(Facts { peak_radiance: 3.0, ..FACTS }, &[("hdr", "false")]);
    assert_eq!(of_image(&plain, "color", Property::Format), " | hdr = false");
    assert!(under(&plain, "`color` R8G8B8A8_SRGB").contains(&"format: set by hdr = false".to_owned()));
}

#[test]
fn the_shipped_forward_renderer_keeps_brightness_beyond_white_only_where_there_is_any() {
    let text = shipped("forward.ron");
    let planned = |peak_radiance: f64, hdr: &str| {
        let (facts, set) = (Facts { peak_radiance, ..FACTS }, set(&[("hdr", hdr)]));
        compiled(&right(&text, &Inputs { facts, facts_known: true, set: &set, ..INPUTS }))
    };
    for (peak, hdr, format, by) in [
        (1.0, "true", Format::R8G8B8A8_SRGB, "scene.peak_radiance = 1 | "),
        (1.5, "true", Format::R16G16B16A16_SFLOAT, "scene.peak_radiance = 1.5 | hdr = true"),
        (1.5, "false", Format::R8G8B8A8_SRGB, " | hdr = false"),
    ] {
        let plan = planned(peak, hdr);
        assert_eq!(image(&plan, "color").format, format, "{peak} {hdr}");
        assert_eq!(of_image(&plan, "color", Property::Format), by);
    }
}

#[test]
fn sizes_and_samples_name_what_decided_them() {
    let plan = plan(FACTS, &[]);
    assert_eq!(of_image(&plan, "color", Property::Size), "view.allows_scale = true | ");
    assert_eq!(of_image(&plan, "depth", Property::Size), "view.allows_scale = true | ");
    assert_eq!(of_image(&plan, "depth", Property::Samples), "view.allows_msaa = true | msaa = 4");
    // The resolve is there because there are several samples.
    let resolve = under(&plan, "resolve `color`");
    let line = "samples: by view.allows_msaa = true; set by msaa = 4".to_owned();
    assert_eq!(resolve.last(), Some(&line), "{}", plan.tree());
}

#[test]
fn a_pass_that_runs_and_one_that_does_not_name_their_fact() {
    let with = plan(FACTS, &[]);
    assert_eq!(of_pass(&with, "glass", Property::Runs), "scene.has_transparent = true | ");
    assert!(under(&with, "`glass` draws").contains(&"runs: by scene.has_transparent = true".to_owned()));
    assert_eq!(of_pass(&with, "draw", Property::Runs), "");

    let without = plan(Facts { has_transparent: false, ..FACTS }, &[]);
    assert_eq!(of_pass(&without, "glass", Property::Runs), "");
    assert_eq!(of_pass(&without, "glass", Property::LeftOut), "scene.has_transparent = false | ");
    let note = without.notes.iter().find(|note| *note.subject == *"glass").expect("a note");
    assert_eq!((note.stage(), &*note.text), (Stage::Expand, "is off: scene.has_transparent = false"));
    assert_eq!(of_pass(&without, "soften", Property::LeftOut), " | blur = false");
}

#[test]
fn an_image_names_the_fact_that_it_exists_for() {
    let with = plan(FACTS, &[]);
    let both = "scene.casts_shadows = true, scene.suns = 1 | ";
    assert_eq!(of_image(&with, "shadow", Property::Exists), both);
    let line = "exists: by scene.casts_shadows = true, scene.suns = 1".to_owned();
    assert!(under(&with, "`shadow` D32").contains(&line), "{}", with.tree());
    assert_eq!(of_image(&with, "color", Property::Exists), "");
    assert_eq!(of_pass(&with, "draw", Property::Images), both);
    assert!(under(&with, "`draw` draws").contains(&"images: by scene.casts_shadows = true, scene.suns = 1".to_owned()));

    let without = plan(Facts { casts_shadows: false, ..FACTS }, &[]);
    assert!(without.images.iter().all(|image| *image.name != *"shadow"));
    assert_eq!(of_pass(&without, "sun", Property::LeftOut), "scene.casts_shadows = false | ");
    assert_eq!(of_pass(&without, "draw", Property::Images), "scene.casts_shadows = false | ");
    assert!(without.decided.iter().all(|it| it.subject != Subject::Image("shadow".into())));
}

#[test]
fn cascades_name_the_fact_that_decided_how_many_there_are() {
    let few = plan(FACTS, &[]);
    assert_eq!(image(&few, "shadow").layers, 2);
    let by = "scene.objects = 2 | cascades = 4";
    assert_eq!(of_image(&few, "shadow", Property::Layers), by);
    assert_eq!(of_pass(&few, "sun.opaque[1]", Property::Repeat), by);
    assert_eq!(of_pass(&few, "sun.opaque[1]", Property::Runs), "scene.casts_shadows = true, scene.suns = 1 | ");
    assert!(
        under(&few, "`sun.opaque[0]` draws").contains(&"repeat: by scene.objects = 2; set by cascades = 4".to_owned())
    );
    assert!(under(&few, "`shadow` D32").contains(&"layers: by scene.objects = 2; set by cascades = 4".to_owned()));
    let casters =
        few.steps.iter().filter_map(|step| if let Work::Render(scope) = &step.work { Some(scope) } else { None });
    assert_eq!(
        casters.flat_map(|scope| &scope.passes).filter(|it| matches!(it.draw, Some(Draw::Casters(_)))).count(),
        2
    );
}

#[test]
fn a_copy_and_what_stands_in_for_it_name_their_fact_and_so_does_the_choice_between_them() {
    let with = plan(FACTS, &[]);
    assert_eq!(of_pass(&with, "keep", Property::Runs), "scene.has_alpha_clip = true | ");
    assert!(
        under(&with, "`keep`: copy").contains(&"runs: by scene.has_alpha_clip = true".to_owned()),
        "{}",
        with.tree()
    );
    assert_eq!(of_pass(&with, "show", Property::Images), "scene.has_alpha_clip = true | ");
    assert_eq!(of_image(&with, "kept", Property::Exists), "");

    let without = plan(Facts { has_alpha_clip: false, ..FACTS }, &[]);
    assert_eq!(of_pass(&without, "keep", Property::LeftOut), "scene.has_alpha_clip = false | ");
    assert_eq!(of_pass(&without, "show", Property::Images), "scene.has_alpha_clip = false | ");
}

#[test]
fn every_fact_and_setting_that_is_named_has_the_value_that_was_put_in() {
    for (peak, clip) in [(0.75, true), (3.0, false)] {
        let facts = Facts { peak_radiance: peak, has_alpha_clip: clip, ..FACTS };
        let plan = plan(facts, &[("msaa", "1")]);
        for decided in plan.decided.iter() {
            for NamedValue { name, value } in &decided.by.facts {
                if let Some(fact) = Fact::ALL.into_iter().find(|fact| fact.name() == &**name) {
                    assert_eq!(*value, facts.value(fact).to_string(), "{name}");
                } else {
                    assert!(name.starts_with("view."), "{name}");
                }
            }
            for NamedValue { name, value } in &decided.by.settings {
                assert!(
                    plan.settings.iter().any(|used| (&used.name, &used.value) == (name, value)),
                    "{name} = {value}"
                );
            }
        }
        assert!(plan.decided.iter().any(|it| !it.by.facts.is_empty()));
    }
}

#[test]
fn json_keeps_what_decided_and_a_pipeline_without_conditions_decides_nothing() {
    let one = plan(FACTS, &[]);
    let json: serde_json::Value = serde_json::from_str(&one.to_json().expect("JSON")).expect("JSON");
    let format =
        json["decided"].as_array().expect("a list").iter().find(|it| it["what"] == "format").expect("a format");
    assert_eq!(format["subject"], serde_json::json!({"image": "color"}));
    let fact = serde_json::json!({"name": "scene.peak_radiance", "value": "0.75"});
    assert_eq!(format["by"], serde_json::json!({"facts": [fact], "settings": []}));
    assert_eq!(Plan::from_json(&one.to_json().expect("JSON")).expect("a Plan"), one);

    let plain = r#"Pipeline(version: 1, images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "draw", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#;
    assert!(compiled(&right(plain, &INPUTS)).decided.is_empty());
}

#[test]
fn names_out_of_a_plan_reach_no_terminal_raw() {
    let mut plan = plan(FACTS, &[]);
    let mut decided = plan.decided.to_vec();
    let value = NamedValue { name: "a\u{1b}[31m".into(), value: "b\nc".to_owned() };
    decided[0].by = DecidedBy { facts: vec![value], settings: Vec::new() }.into();
    plan.decided = decided.into();
    let tree = plan.tree();
    assert!(tree.contains("a\\u{1b}[31m = b\\nc") && !tree.contains('\u{1b}'), "{tree}");
}

#[test]
fn a_plan_that_is_brought_up_to_date_names_the_new_values() {
    let device = Arc::new(crate::testing::parts::device());
    let mut compiler = Compiler::new();
    for objects in [2, 3, 4, 40] {
        let facts = Facts { objects, ..FACTS };
        let frame = Arc::new(right(TEXT, &Inputs { facts, facts_known: true, ..INPUTS }));
        let memory = &mut MemoryEstimate(&device);
        let plan = compiler.compile(&frame, &device, memory, &Options::default()).expect("it compiles").clone();
        assert_eq!(compiler.reuse() != Reuse::Nothing, objects == 40, "{objects}");
        assert_eq!(verify(&plan), []);
        assert_eq!(plan, compiled(&frame), "{objects}");
        assert!(of_image(&plan, "shadow", Property::Layers).starts_with(&format!("scene.objects = {objects} ")));
    }
}
