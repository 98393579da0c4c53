//! What a draw may leave as it was, and what a store does: the Plan names the line of the shader, and the promise that brings the
//! cheaper way back.

use crate::testing::Place;
use serde_json::Value;

/// A pass that fills `screen`, if there is one, and another one that draws or stores over it.
fn pipeline(before: bool, over: &str) -> String {
    let before = if before { r#"(name: "before", fill: (to: "screen", value: (0, 0, 1, 1))),"# } else { "" };
    format!(
        r#"Pipeline(version: 1,
    images: [(name: "screen", format: R8G8B8A8_UNORM, size: Output)],
    buffers: [(name: "words", bytes: 64)],
    passes: [
        {before}
        (name: "zeros", fill: (to: "words", value: 0)),
        (name: "over", {over}),
    ],
    outputs: [(image: "screen", encoding: Unorm), "words"],
)"#
    )
}

/// The Plan of `p.ron`, in JSON.
fn plan(place: &Place) -> Value {
    serde_json::from_str(&place.run(&["inspect", "p.ron", "--format", "json"]).exits(0).out).expect("JSON")
}

/// The words of notes of the Plan about a pass.
fn notes(plan: &Value, pass: &str) -> Vec<String> {
    let notes = plan["notes"].as_array().expect("a list").iter().filter(|note| note["subject"] == pass);
    notes.map(|note| note["text"].as_str().expect("a text").to_owned()).collect()
}

/// The tree of the Plan of `p.ron`, its lines joined to one.
fn tree(place: &Place) -> String {
    let tree = place.run(&["inspect", "p.ron"]).exits(0).out;
    let words = tree.split(|letter: char| letter.is_whitespace() || "│├└─".contains(letter));
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

#[test]
fn what_a_draw_loads_names_the_line_that_may_leave_texels_out_and_the_promise() {
    let head = "#version 460\n#extension GL_GOOGLE_include_directive : require\nlayout(location = 0) out vec4 color;";
    let masks = "// gl_SampleMask\nvoid main() {\n    color = vec4(1.0);\n    gl_SampleMask[0] = gl_FragCoord.x < 4.0 ? 1 : 0;\n}";
    let discards =
        "/* discard */ void main() {\n    if (gl_FragCoord.x < 4.0)\n        discard;\n    color = vec4(1.0);\n}";
    let includes = "#include \"deep/holes.glsl\"\nvoid main() { leave(); color = vec4(1.0); }";
    let place = Place::new();
    std::fs::create_dir(place.path("deep")).expect("a folder");
    place.file("deep/holes.glsl", "// discard\nvoid leave() {\n    if (gl_FragCoord.x < 4.0) discard;\n}\n");
    for (text, what, line) in [
        (masks, "writes `gl_SampleMask`", "s.frag:7)"),
        (discards, "discards fragments", "s.frag:6)"),
        (includes, "discards fragments", "deep/holes.glsl:3)"),
    ] {
        place.file("s.frag", format!("{head}\n{text}\n"));
        let over = r#"draw: FullScreen("s"), color: ["screen"]"#;
        // The load says why.
        place.file("p.ron", pipeline(true, over));
        let kept = tree(&place);
        let [begins, ends] = [
            format!("load LOAD, store STORE: `over` may leave texels as they were: shader `s` {what} ("),
            format!("{line}; `covers: true` promises that it sets them all; it outlives the frame"),
        ];
        assert!(kept.contains(&begins) && kept.contains(&ends), "{kept}");
        assert!(!kept.contains("does not run"), "{kept}");
        // Promised, nothing is loaded, and the pass before isn't needed.
        place.file("p.ron", pipeline(true, &format!("{over}, covers: true")));
        let promised = tree(&place);
        assert!(promised.contains("load DONT_CARE, store STORE: `over` covers every pixel"), "{promised}");
        assert!(promised.contains("`before`: does not run: no output needs what it writes"), "{promised}");
        // Where nothing was there before it is a mistake.
        place.file("p.ron", pipeline(false, over));
        place
            .run(&["check", "p.ron"])
            .exits(1)
            .mentions(&format!("may leave texels untouched: shader `s` {what} ("))
            .mentions(line)
            .mentions("or say `covers: true` of the pass, which promises that it sets every texel");
        place.file("p.ron", pipeline(false, &format!("{over}, covers: true")));
        place.run(&["check", "p.ron"]).exits(0);
    }
}

#[test]
fn what_a_store_keeps_names_the_line_that_declares_it_and_the_promise() {
    let place = Place::new();
    place.file(
        "dots.comp",
        "#version 460
        layout(local_size_x = 8, local_size_y = 8) in; // to
        layout(set = 0, binding = 0, rgba8) uniform writeonly image2D to;
        layout(set = 0, binding = 1) writeonly buffer Counts { uint of[16]; } counts;
        void main() {
            if (gl_LocalInvocationIndex != 0) return;
            imageStore(to, ivec2(gl_GlobalInvocationID.xy), vec4(1.0));
            counts.of[3] = 1;
        }",
    );
    let over = |image: &str, buffer: &str| {
        let storage = format!(r#"storage: {{"to": {image}, "counts": {buffer}}}"#);
        pipeline(true, &format!(r#"dispatch: "dots", groups: Texels("screen"), {storage}"#))
    };
    place.file("p.ron", over(r#""screen""#, r#""words""#));
    let kept = notes(&plan(&place), "over");
    for (name, line) in [("screen", 3), ("words", 4)] {
        let begins = format!("keeps what it doesn't write of `{name}`: its shader doesn't read it (");
        let ends =
            format!("dots.comp:{line}), which doesn't say that it writes all of it; `access: Write` promises that");
        let is_it = |note: &&String| note.starts_with(&begins) && note.ends_with(&ends);
        assert_eq!(kept.iter().filter(is_it).count(), 1, "{name}: {kept:?}");
    }
    let promised = over(r#"(image: "screen", access: Write)"#, r#"(buffer: "words", access: Write)"#);
    place.file("p.ron", promised);
    let plan = plan(&place);
    assert!(notes(&plan, "over").iter().all(|note| !note.contains("keeps")), "{plan:#}");
    for before in ["before", "zeros"] {
        assert!(notes(&plan, before).iter().any(|note| note.starts_with("does not run")), "{before}: {plan:#}");
    }
}
