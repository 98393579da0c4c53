//! Values that clear and fill images: exact in the frame, in the Plan and in its JSON, or refused where they are written.
//! (That devices set them: backend-vulkan/tests/features/clear_values.rs.)

use crate::testing::pipelines::{INPUTS, frame, right, set, wrong};
use crate::testing::plans::shipped;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Lifetime, Work};
use framewright_graph::plan::{Plan, Work as PlanWork};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{FillValue, Format, Numeric};

/// The least and the greatest number of every component, by the letters and digits of the format's name: Vulkan's, "Formats".
fn ends(format: Format) -> [[f64; 4]; 2] {
    let name = format.name();
    let bits = [8, 16, 32].into_iter().find(|bits| name.starts_with(&format!("R{bits}"))).unwrap_or(8);
    let both = |least: f64, most: f64| [[least; 4], [most; 4]];
    match name {
        _ if name.ends_with("UNORM") || name.ends_with("SRGB") || name.ends_with("UNORM_PACK32") => both(0.0, 1.0),
        _ if name.ends_with("SNORM") => both(-1.0, 1.0),
        _ if name.ends_with("UINT") => both(0.0, 2_f64.powi(bits) - 1.0),
        _ if name.ends_with("SINT") => both(-2_f64.powi(bits - 1), 2_f64.powi(bits - 1) - 1.0),
        "E5B9G9R9_UFLOAT_PACK32" => [[0.0; 4], [65408.0, 65408.0, 65408.0, 1.0]],
        "B10G11R11_UFLOAT_PACK32" => [[0.0; 4], [65024.0, 65024.0, 64512.0, 1.0]],
        _ if bits == 16 => both(-65504.0, 65504.0),
        _ => both(f64::from(f32::MIN), f64::from(f32::MAX)),
    }
}

fn colors() -> impl Iterator<Item = Format> {
    Format::ALL.iter().copied().filter(|format| !format.is_depth() && !format.is_compressed())
}

/// A pipeline that sets images of a format to a value in every way: a clear, a fill, a stand-in, first contents.
fn text(format: Format, value: &str) -> String {
    let shader = match format.numeric() {
        Numeric::Uint => "uints",
        Numeric::Sint => "ints",
        _ => "plain",
    };
    let show = if format.is_integer() {
        "(name: \"show\", draw: Sky, color: [(image: \"screen\", clear: (0, 0, 0, 1))])"
    } else {
        "(name: \"show\", draw: FullScreen(\"copy\"), sample: {\"source\": \"a\"}, color: [\"screen\"])"
    };
    format!(
        r#"Pipeline(version: 1, settings: [(name: "on", value: Bool(default: false)), (name: "n", value: Integer(default: 16777217, min: 0, max: 4294967295))],
    images: [(name: "screen", format: Output, size: Output),
        (name: "a", format: {format}, size: Output), (name: "b", format: {format}, size: Output), (name: "c", format: {format}, size: Output),
        (name: "d", format: {format}, size: Output, lifetime: Persistent(initial: {value}))],
    passes: [
        (name: "clear", draw: Vertices(3), shader: "{shader}", color: [(image: "a", clear: {value})]),
        (name: "fill", fill: (to: "b", value: {value})),
        (name: "stand", when: "on", draw: Vertices(3), shader: "{shader}", color: [(image: "c", clear: {value})],
            otherwise: Clear(image: "c", value: {value})),
        {show},
    ], outputs: ["screen"])"#
    )
}

fn ron([r, g, b, a]: [f64; 4]) -> String {
    format!("({r:?}, {g:?}, {b:?}, {a:?})")
}

fn numbers(format: Format, value: &FillValue) -> [f64; 4] {
    match value {
        FillValue::Color(color) => color.map(f64::from),
        FillValue::Bits(bits) if format.numeric() == Numeric::Sint => bits.map(|word| word.cast_signed().into()),
        FillValue::Bits(bits) => bits.map(f64::from),
        FillValue::Depth(..) => panic!("{format} is no depth"),
    }
}

#[test]
fn the_ends_of_every_format_are_exact_in_every_way_to_set_an_image() {
    for format in colors() {
        let [least, most] = ends(format);
        let mut mixed = most;
        mixed[1] = least[1];
        for value in [least, most, mixed] {
            let frame = right(&text(format, &ron(value)), &INPUTS);
            assert_eq!(frame.passes[0].color[0].clear, Some(value), "{format}");
            for pass in &frame.passes[1..3] {
                let Work::Fill { value: filled } = &pass.work else { panic!("{:?}", pass.work) };
                assert_eq!(numbers(format, filled), value, "{format}, pass `{}`", pass.name);
            }
            let Lifetime::Persistent { initial } = &frame.images[4].lifetime else { panic!("it is persistent") };
            assert_eq!(numbers(format, initial), value, "{format}");
        }
    }
}

#[test]
fn what_a_format_does_not_hold_is_refused_in_every_way_to_set_an_image() {
    // What 32 bits of floating point don't hold is no colour at all, whatever the format.
    let wide = |format: &Format| format.numeric() == Numeric::Sfloat && format.name().starts_with("R32");
    for format in colors().filter(|format| !wide(format)) {
        let [least, most] = ends(format);
        let mut values = Vec::new();
        for (end, out) in [(least, -1.0), (most, 1.0)] {
            for component in 0..format.components() as usize {
                let mut value = end;
                value[component] +=
                    out * if format.is_integer() { 1.0 } else { value[component].abs().max(1.0) / 64.0 };
                values.push(value);
            }
        }
        values.extend(format.is_integer().then_some([0.75, 0.0, 0.0, 0.0]));
        for value in values {
            let text = text(format, &ron(value));
            let begin = wrong(&text, &INPUTS);
            assert!(
                begin.contains("`d` can't begin like this: ") && begin.contains("test.ron:4:"),
                "{format}\n{begin}"
            );
            let set = wrong(&text.replace(&format!("(initial: {})", ron(value)), "(initial: 0)"), &INPUTS);
            for (said, line) in
                [("`a` can't be cleared: ", 6), ("`b` can't be filled: ", 7), ("`c` can't be filled: ", 9)]
            {
                assert!(set.contains(said), "{format} {value:?}: {said}\n{set}");
                assert!(set.contains(&format!("test.ron:{line}:")), "{format} {value:?}: {line}\n{set}");
            }
        }
    }
}

#[test]
fn a_setting_or_an_expression_clears_to_the_very_integer() {
    for (value, set_to, wanted) in [
        ("\"n\"", None, 16_777_217.0),
        ("\"n + 2\"", None, 16_777_219.0),
        ("\"n\"", Some("4294967295"), 4_294_967_295.0),
    ] {
        let chosen = set_to.map(|value| set(&[("n", value)])).unwrap_or_default();
        let inputs = Inputs { set: &chosen, ..INPUTS };
        let frame = right(&text(Format::R32_UINT, &format!("({value}, 0, 0, 0)")), &inputs);
        assert_eq!(frame.passes[0].color[0].clear, Some([wanted, 0.0, 0.0, 0.0]), "{value}");
        let Work::Fill { value: FillValue::Bits([filled, ..]) } = frame.passes[1].work else { panic!("a fill") };
        assert_eq!(f64::from(filled), wanted, "{value}");
    }
    let chosen = set(&[("n", "256")]);
    let answer =
        frame(&text(Format::R8_UINT, "(\"n\", 0, 0, 0)"), &Inputs { set: &chosen, ..INPUTS }).expect_err("256");
    assert!(answer.contains("`a` can't be cleared: 256 is no component of R8_UINT"), "{answer}");
}

/// The Plan of a pipeline whose outputs are all that it sets.
fn plan(format: Format, value: [f64; 4]) -> Plan {
    let text = text(format, &ron(value)).replace("outputs: [\"screen\"]", "outputs: [\"screen\", \"a\", \"b\", \"c\"]");
    let device = shipped("lavapipe");
    let plan = compile(&right(&text, &INPUTS), &device, &mut MemoryEstimate(&device), &Options::default());
    plan.unwrap_or_else(|errors| panic!("{errors:?}"))
}

#[test]
fn a_plan_holds_integers_exactly_as_text_and_as_json() {
    for (format, value) in [
        (Format::R32_UINT, [16_777_217.0, 4_294_967_295.0, 1.0, 0.0]),
        (Format::R32_SINT, [-16_777_217.0, 2_147_483_647.0, -1.0, 0.0]),
    ] {
        let plan = plan(format, value);
        let [r, g, b, a] = value;
        let tree = plan.tree();
        let said = format!("({r}, {g}, {b}, {a})");
        assert_eq!(tree.matches(&said).count(), 3, "{said}\n{tree}");
        let again = Plan::from_json(&plan.to_json().expect("JSON")).expect("its own JSON");
        assert_eq!(again, plan);
    }
}

#[test]
fn the_checker_refuses_a_clear_or_a_fill_that_the_format_does_not_hold() {
    let plan = plan(Format::R8_SINT, [1.0, -2.0, 3.0, 4.0]);
    assert!(verify(&plan).is_empty());
    let mut cleared = plan.clone();
    let mut filled = plan;
    for step in &mut cleared.steps {
        if let PlanWork::Render(scope) = &mut step.work {
            scope
                .attachments
                .iter_mut()
                .filter(|it| it.clear.is_some())
                .for_each(|it| it.clear = Some([128.0, 0.0, 0.0, 0.0]));
        }
    }
    for step in &mut filled.steps {
        if let PlanWork::Fill(fill) = &mut step.work {
            fill.value = FillValue::Bits([128, 0, 0, 0]);
        }
    }
    for (plan, said) in
        [(cleared, "a clear value that its format doesn't hold"), (filled, "filled with what its format")]
    {
        let found = verify(&plan);
        assert!(found.iter().any(|it| it.to_string().contains(said)), "{said}: {found:?}");
    }
}

/// A pipeline that fills planes of a depth-stencil image.
fn planes(fills: &str) -> String {
    format!(
        r#"Pipeline(version: 1,
    images: [(name: "screen", format: Output, size: Output), (name: "d", format: D32_SFLOAT_S8_UINT, size: Output)],
    passes: [
        (name: "both", fill: (to: "d", value: (0.5, 3))),
        {fills}
        (name: "show", draw: FullScreen("copy"), sample: {{"source": (image: "d", plane: Depth)}}, color: ["screen"]),
    ], outputs: ["screen"])"#
    )
}

#[test]
fn a_fill_of_one_plane_takes_the_number_for_that_plane() {
    let stencil = r#"(name: "one", fill: (to: (image: "d", plane: Stencil), value: VALUE)),"#;
    let depth = stencil.replace("Stencil", "Depth");
    let value = |fill: &str, value: &str| {
        let frame = right(&planes(&fill.replace("VALUE", value)), &INPUTS);
        let Work::Fill { value } = frame.passes[1].work else { panic!("a fill") };
        value
    };
    assert_eq!(value(stencil, "1"), FillValue::Depth(0.0, 1));
    assert_eq!(value(stencil, "255"), FillValue::Depth(0.0, 255));
    assert_eq!(value(stencil, "(0, 7)"), FillValue::Depth(0.0, 7));
    assert_eq!(value(&depth, "1"), FillValue::Depth(1.0, 0));
    assert_eq!(value(&depth, "(0.25, 0)"), FillValue::Depth(0.25, 0));
    let refused = |fill: &str, value: &str| wrong(&planes(&fill.replace("VALUE", value)), &INPUTS);
    for (fill, value, said) in [
        (stencil, "256", "256 is no stencil value"),
        (stencil, "0.5", "0.5 is no stencil value"),
        (stencil, "(0.5, 7)", "stencil is filled alone, and not with the depth 0.5"),
        (depth.as_str(), "(0.5, 7)", "depth is filled alone, and not with the stencil 7"),
        (depth.as_str(), "7", "depth lies from 0 to 1, found 7"),
    ] {
        let answer = refused(fill, value);
        assert!(answer.contains(said) && answer.contains("test.ron:5:"), "{said}\n{answer}");
    }
}

#[test]
fn the_checker_refuses_a_depth_beyond_0_to_1() {
    let device = shipped("lavapipe");
    let text = planes("");
    let plan = compile(&right(&text, &INPUTS), &device, &mut MemoryEstimate(&device), &Options::default())
        .expect("it is valid");
    for (depth, right) in [(0.0, true), (1.0, true), (-0.25, false), (1.5, false), (f32::NAN, false)] {
        let mut plan = plan.clone();
        let fills = plan.steps.iter_mut().filter_map(|step| match &mut step.work {
            PlanWork::Fill(fill) => Some(fill),
            _ => None,
        });
        fills.for_each(|fill| fill.value = FillValue::Depth(depth, 3));
        let found = verify(&plan);
        assert_eq!(found.is_empty(), right, "{depth}: {found:?}");
    }
}
