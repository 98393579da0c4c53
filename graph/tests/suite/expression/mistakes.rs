//! Mistakes, each with its whole answer.

use crate::expression::world::{ANY, World};
use framewright_graph::base::{Sources, Span, render};
use framewright_graph::expression::{Expression, ParsedExpression, WantedTypes};

/// Pins the answers to several expressions as one text.
fn pinned(name: &str, mistakes: &[(&str, WantedTypes<'_>)]) {
    let world = World::new();
    let answers: Vec<String> = mistakes.iter().map(|(text, wanted)| world.answer(text, *wanted)).collect();
    for (answer, (text, _)) in answers.iter().zip(mistakes) {
        assert!(answer.starts_with("error: "), "{text} is answered with nothing");
    }
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/expression/answers");
    insta::with_settings!({
        snapshot_path => folder, prepend_module_to_snapshot => false, omit_expression => true,
    }, { insta::assert_snapshot!(name, answers.join("\n")) });
}

/// Mistakes in places that want any type.
fn any<'t>(texts: &[&'t str]) -> Vec<(&'t str, WantedTypes<'static>)> {
    texts.iter().map(|text| (*text, ANY)).collect()
}

#[test]
fn texts_that_are_no_expressions() {
    pinned(
        "texts_that_are_no_expressions",
        &any(&[
            "",
            "  ",
            "levels +",
            "levels levels",
            "hdr and bloom",
            "hdr & bloom",
            "levels = 5",
            "0 < levels < 9",
            "levels == 5 == hdr",
            "min(levels, 2",
            "down[i",
            "(levels))",
            "min(levels,)",
            "(1, 2)",
            "2 * (levels - )",
            "quality == 'high",
            "quality == \"high\"",
            "levels ? 1 : 2",
            "2^levels",
            ".5",
            "1.",
            "0x10",
            "2levels",
            "9223372036854775808",
            "1e999",
            "scene.",
            "5[0]",
            "down[0][1]",
            "(levels)[0]",
            "levels # 3",
            "not hdr",
        ]),
    );
}

#[test]
fn calls_that_cannot_be() {
    pinned(
        "calls_that_cannot_be",
        &any(&[
            "mim(1, 2)",
            "shade(1)",
            "min(1)",
            "clamp(1, 2)",
            "abs()",
            "if(hdr, 1)",
            "if(hdr, 1, 2, 3)",
            "floor(1, 2)",
            "levels(3)",
        ]),
    );
}

#[test]
fn names_of_nothing() {
    pinned(
        "names_of_nothing",
        &any(&[
            "levles + 1",
            "scene.has_opaqe",
            "R8_UNROM",
            "somewhere_else",
            "min",
            "quality == high",
            "levles + hrd + levles",
        ]),
    );
}

#[test]
fn types_that_do_not_fit() {
    let mut mistakes = any(&[
        "levels && hdr",
        "hdr || (1 + 2)",
        "!radius",
        "-hdr",
        "levels + true",
        "quality < 'low'",
        "width(lights)",
        "width('source')",
        "min(1, hdr, quality)",
        "if(levels, 1, 2)",
        "if(hdr, 1, source)",
        "quality == 3",
        "quality == 'hihg'",
        "'medium' != quality",
        "down",
        "levels[0]",
        "R8_UNORM[0]",
        "down[radius]",
        "(levels == 1) + 1",
    ]);
    mistakes.extend([
        ("levels / 2", WantedTypes::INTEGER),
        ("radius", WantedTypes::INTEGER),
        ("true", WantedTypes::INTEGER),
        ("levels", WantedTypes::BOOL),
        ("'source'", WantedTypes::IMAGE),
        ("scene.has_opaque", WantedTypes::NUMBER),
        ("R8_UNORM", WantedTypes::RESOURCE),
        ("lights", WantedTypes::IMAGE),
        ("quality", WantedTypes::PARAMETER),
    ]);
    pinned("types_that_do_not_fit", &mistakes);
}

#[test]
fn expressions_without_a_value() {
    pinned(
        "expressions_without_a_value",
        &any(&[
            "1 / none",
            "1 / (levels - 5)",
            "levels % none",
            "7 / 0",
            "9223372036854775807 + i",
            "-(-9223372036854775807 - i)",
            "levels * 4611686018427387904",
            "abs(-9223372036854775808 + none)",
            "1e308 * (9 + levels)",
            "exp2(levels * 1000)",
            "sqrt(i - levels)",
            "log2(none)",
            "pow(-2, strength)",
            "pow(none, -1)",
            "floor(1e300)",
            "ceil(9223372036854775808.0)",
            "clamp(i, levels, 2)",
            "down[i + 2]",
            "down[i - 2]",
            "empty[0]",
            "lone[i]",
            "width(later) > 1",
            "if(quality == 'high' && hdr, 1 / none, 0.0)",
        ]),
    );
}

#[test]
fn every_mistake_in_types_and_names_is_reported_at_once_in_the_order_of_the_text() {
    let errors = Expression::new("(1 + hdr) * (2 + nowhere) + -bloom", Span::new(0, 0, 34), &World::new(), ANY);
    let places: Vec<u32> = errors.expect_err("three mistakes").iter().map(|error| error.labels[0].span.start).collect();
    assert_eq!(places, [5, 17, 29]);
}

#[test]
fn a_text_with_escapes_is_underlined_whole() {
    let file = r#"when: "levels \u{3d}= hdr""#.to_owned();
    let span = Span::new(0, 7, u32::try_from(file.len() - 1).expect("short"));
    let mut sources = Sources::default();
    sources.add("p.ron", "p.ron", file);
    let errors = Expression::new("levels == hdr", span, &World::new(), ANY).expect_err("types differ");
    assert_eq!(errors[0].labels[0].span, span);
    let mistake = ParsedExpression::new("levels =", span).expect_err("no expression");
    assert_eq!(mistake.labels[0].span, span);
    assert!(render(&sources, &[mistake]).contains(r"^^^^^^^^^^^^^^^^^^"));
}
