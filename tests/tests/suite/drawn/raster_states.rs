//! Raster state of pipelines (DO-6): what each state does to texels, calculated by hand.

use framewright_graph::compile::Options;
use framewright_graph::frame::Stereo;
use framewright_graph::plan::{Plan, Work};
use framewright_graph::vulkan::{LoadOp, Rotation};
use framewright_passes::draw::SceneDrawSource;
use framewright_passes::scene::load;
use framewright_tests::render::{Setup, Ways, device, floats, in_repository, library, plan_for, silent};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::{Device, Executor, ExecutorOptions, Texels};
use std::error::Error;
use std::io::Write;

const EXTENT: [u32; 2] = [16, 8];
/// What `even.frag` draws.
const OLD: [u8; 4] = [128, 64, 255, 255];
const OLD_LIGHT: [f64; 4] = [0.5, 0.25, 1.0, 1.0];
/// What `raster_color.frag` is told to draw.
const NEW: [u8; 4] = [51, 153, 102, 204];
const NEW_LIGHT: [f64; 4] = [0.2, 0.6, 0.4, 0.8];
const FIRST: &str = r#""first": (0.2, 0.6, 0.4, 0.8)"#;
const OTHER: [f64; 4] = [0.3, 0.9, 0.1, 0.7];
const CONSTANTS: [f64; 4] = [0.1, 0.3, 0.7, 0.9];

/// A Plan that was drawn, and its outputs.
struct Drawn {
    plan: Plan,
    outputs: Vec<Texels>,
}

fn drawn(device: &Device, text: &str, ways: Ways, poison: bool) -> Result<Drawn, Box<dyn Error>> {
    let mut file = tempfile::NamedTempFile::new()?;
    file.write_all(text.as_bytes())?;
    let pipeline = file.path().to_str().ok_or("no path")?;
    let scene = empty_scene();
    let setup = Setup { pipeline, set: &[], scene: &scene, extent: EXTENT };
    let (mut shaders, options) = (library(), Options { poison, ..Options::default() });
    let plan = plan_for(device, &setup, ways, &mut shaders, &options)?;
    let mut draws = SceneDrawSource::for_plan(device, &scene, EXTENT, &plan)?;
    let how = ExecutorOptions { poison, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plan, &mut shaders, &how)?;
    executor.frame(&mut draws)?;
    let outputs = (0..plan.outputs.len()).map(|output| executor.read(output)).collect::<Result<_, _>>()?;
    silent(device)?;
    Ok(Drawn { plan, outputs })
}

/// For each pass of `cases` an image that is `OLD` before it, and that the pass draws into as `$image`; shown with one sample.
fn text(cases: &[String], samples: u32, per_eye: bool) -> String {
    let (mut images, mut passes, mut outputs) = (String::new(), String::new(), Vec::new());
    for (at, case) in cases.iter().enumerate() {
        let case = case.replace("$image", &format!("color_{at}"));
        images += &format!(
            r#"(name: "color_{at}", format: R8G8B8A8_UNORM, size: Output, samples: {samples}, per_eye: {per_eye}),
               (name: "shown_{at}", format: R8G8B8A8_UNORM, size: Output, per_eye: {per_eye}),"#
        );
        passes += &format!(
            r#"(name: "before_{at}", draw: FullScreen("even"), color: ["color_{at}"]),
               (name: "state_{at}", {case}),
               (name: "show_{at}", draw: FullScreen("copy"), sample: {{"source": (image: "color_{at}", filter: Nearest)}},
                   color: ["shown_{at}"]),"#
        );
        outputs.push(format!("\"shown_{at}\""));
    }
    format!("Pipeline(version: 1, images: [{images}], passes: [{passes}], outputs: [{}])", outputs.join(", "))
}

/// The same, drawn into images that are shown as they are.
fn straight(cases: &[String], per_eye: bool) -> String {
    let (mut images, mut passes, mut outputs) = (String::new(), String::new(), Vec::new());
    for (at, case) in cases.iter().enumerate() {
        let case = case.replace("$image", &format!("shown_{at}"));
        images += &format!(r#"(name: "shown_{at}", format: Output, size: Output, per_eye: {per_eye}),"#);
        passes += &format!(
            r#"(name: "before_{at}", draw: FullScreen("even"), color: ["shown_{at}"]), (name: "state_{at}", {case}),"#
        );
        outputs.push(format!("\"shown_{at}\""));
    }
    format!("Pipeline(version: 1, images: [{images}], passes: [{passes}], outputs: [{}])", outputs.join(", "))
}

/// Bytes of light in sRGB; alpha is as it is.
fn encoded(light: [f64; 4]) -> [u8; 4] {
    let curve = |light: f64| if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    [0, 1, 2, 3].map(|at| ((if at == 3 { light[at] } else { curve(light[at]) }) * 255.0).round() as u8)
}

fn full_screen(target: &str, more: &str) -> String {
    format!(r#"draw: FullScreen("raster_color"), params: {{{FIRST}}}, color: [(image: "$image"{target})]{more}"#)
}

fn vertices(count: u32, vertex: &str, raster: &str) -> String {
    format!(
        r#"draw: Vertices({count}), shader: (vertex: "{vertex}", fragment: "raster_color"), params: {{{FIRST}}},
           color: ["$image"], raster: ({raster})"#
    )
}

fn texels(output: &Texels) -> Vec<[u8; 4]> {
    output.bytes.as_chunks::<4>().0.to_vec()
}

/// All texels of `output` are `expected`, up to a step.
fn demand_even(output: &Texels, expected: [u8; 4], what: &str, plan: &Plan) {
    for (at, texel) in texels(output).into_iter().enumerate() {
        let off = texel.iter().zip(expected).any(|(found, wanted)| found.abs_diff(wanted) > 1);
        assert!(!off, "{what}: texel {at} is {texel:?}, not {expected:?}\n{}", plan.tree());
    }
}

/// Coordinates of the texels that were drawn.
fn places(output: &Texels) -> Vec<(usize, usize)> {
    let width = output.extent[0] as usize;
    let new = texels(output).into_iter().enumerate().filter(|(_, texel)| *texel == NEW);
    new.map(|(at, _)| (at % width, at / width)).collect()
}

#[test]
fn channels_that_are_not_written_keep_what_they_held() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let masks: Vec<[bool; 4]> = (0..16).map(|bits| [0, 1, 2, 3].map(|at| bits >> at & 1 == 1)).collect();
    let case = |[r, g, b, a]: &[bool; 4]| full_screen(&format!(", write_mask: ({r}, {g}, {b}, {a})"), "");
    let cases: Vec<String> = masks.iter().map(case).collect();
    for samples in [1, 4] {
        for poison in [false, true] {
            let Drawn { plan, outputs } = drawn(device, &text(&cases, samples, false), Ways::default(), poison)?;
            for (mask, output) in masks.iter().zip(&outputs) {
                let expected = [0, 1, 2, 3].map(|at| if mask[at] { NEW[at] } else { OLD[at] });
                demand_even(output, expected, &format!("{mask:?}, {samples} samples"), &plan);
            }
        }
    }
    Ok(())
}

/// Scopes are told apart by a pass in between that reads what the first drew.
#[test]
fn what_is_not_written_is_loaded_where_it_was_stored_before() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let text = format!(
        r#"Pipeline(version: 1,
            images: [(name: "color", format: R8G8B8A8_UNORM, size: Output), (name: "seen", format: R8G8B8A8_UNORM, size: Output)],
            passes: [(name: "before", fill: (to: "color", value: (0.5, 0.25, 1.0, 1.0))),
                     (name: "see", draw: FullScreen("copy"), sample: {{"source": (image: "color", filter: Nearest)}}, color: ["seen"]),
                     (name: "state", {})],
            outputs: ["color", "seen"])"#,
        full_screen(", write_mask: (true, false, false, true)", "").replace("$image", "color")
    );
    let Drawn { plan, outputs } = drawn(device, &text, Ways::default(), true)?;
    demand_even(&outputs[0], [NEW[0], OLD[1], OLD[2], NEW[3]], "the rest was loaded", &plan);
    demand_even(&outputs[1], OLD, "what was seen", &plan);
    let loads: Vec<LoadOp> = plan
        .steps
        .iter()
        .filter_map(|step| match &step.work {
            Work::Render(scope) if scope.passes.iter().any(|pass| &*pass.name == "state") => {
                Some(scope.color()[0].load)
            }
            _ => None,
        })
        .collect();
    assert_eq!(loads, [LoadOp::Load], "{}", plan.tree());
    Ok(())
}

/// The triangle that fills the screen goes round clockwise, as y goes down: it shows its back.
#[test]
fn faces_are_left_out_as_the_pass_says_however_the_picture_is_turned_and_in_both_eyes() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut cases = Vec::new();
    for (front, back_shows) in [("CounterClockwise", true), ("Clockwise", false)] {
        for (mode, drawn) in [("Neither", true), ("Front", back_shows), ("Back", !back_shows), ("FrontAndBack", false)]
        {
            cases.push((full_screen("", &format!(", raster: (cull_mode: {mode}, front_face: {front})")), drawn));
        }
    }
    let passes: Vec<String> = cases.iter().map(|(pass, _)| pass.clone()).collect();
    let mut ways: Vec<(Ways, bool, u32)> = Vec::new();
    for rotation in Rotation::ALL {
        ways.push((Ways { rotation, ..Ways::default() }, false, 1));
    }
    ways.push((Ways::default(), false, 4));
    let stereos = [Stereo::MultiPass, Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];
    for stereo in stereos.into_iter().filter(|stereo| stereo.lacks(&device.profile()).is_none()) {
        ways.push((Ways { stereo, rotation: Rotation::Identity }, true, 1));
        ways.push((Ways { stereo, rotation: Rotation::ALL[1] }, true, 1));
    }
    for (ways, per_eye, samples) in ways {
        // What is shown on a screen is drawn turned.
        let text = match samples {
            1 => straight(&passes, per_eye),
            _ => text(&passes, samples, per_eye),
        };
        let Drawn { plan, outputs } = drawn(device, &text, ways, true)?;
        let turned = plan.images.iter().any(|image| image.rotation.turns());
        assert_eq!(turned, ways.rotation != Rotation::Identity, "{}", plan.tree());
        let each = outputs.len() / cases.len();
        for (at, (pass, shows)) in cases.iter().enumerate() {
            for output in &outputs[at * each..(at + 1) * each] {
                let expected = match (samples, *shows) {
                    (1, shows) => encoded(if shows { NEW_LIGHT } else { OLD_LIGHT }),
                    (_, true) => NEW,
                    (_, false) => OLD,
                };
                demand_even(output, expected, &format!("{ways:?}: {pass}"), &plan);
            }
        }
    }
    Ok(())
}

#[test]
fn vertices_make_what_the_topology_says() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let row = |y: usize, xs: std::ops::RangeInclusive<usize>| xs.map(move |x| (x, y)).collect::<Vec<_>>();
    // Drivers differ in whether the ends of lines are drawn.
    let lines = [row(2, 2..=13), row(5, 2..=13)].concat();
    let ends = [(1, 2), (14, 2), (1, 5), (14, 5)];
    let mut strip = lines.clone();
    strip.extend([(14, 3), (14, 4)]);
    let mut cases = vec![
        (vertices(4, "raster_points", "topology: LineList"), lines),
        (vertices(4, "raster_points", "topology: LineStrip"), strip),
        (vertices(4, "raster_quad", "topology: TriangleStrip"), (0..8).flat_map(|y| row(y, 0..=15)).collect()),
    ];
    if device.profile().has_feature("largePoints") {
        cases.push((vertices(4, "raster_points", "topology: PointList"), ends.to_vec()));
    }
    let passes: Vec<String> = cases.iter().map(|(pass, _)| pass.clone()).collect();
    let Drawn { plan, outputs } = drawn(device, &text(&passes, 1, false), Ways::default(), false)?;
    for ((pass, expected), output) in cases.into_iter().zip(&outputs) {
        let (mut found, mut expected) = (places(output), expected);
        if pass.contains("Line") {
            found.retain(|place| !ends.contains(place));
        }
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected, "{pass}\n{}", plan.tree());
    }
    let half = |pass: String| -> Result<Vec<(usize, usize)>, Box<dyn Error>> {
        let Drawn { outputs, .. } = drawn(device, &text(&[pass], 1, false), Ways::default(), false)?;
        Ok(places(&outputs[0]))
    };
    let list = half(vertices(3, "raster_quad", "topology: TriangleList"))?;
    assert!(list.contains(&(0, 0)) && list.contains(&(14, 0)) && !list.contains(&(15, 7)), "{list:?}");
    // Its triangles are (0, 1, 2) and (0, 2, 3): only the fan has the lower left corner, and not the lower right one.
    let fan = half(vertices(4, "raster_quad", "topology: TriangleFan"))?;
    assert!(fan.contains(&(0, 7)) && fan.contains(&(1, 7)) && !fan.contains(&(15, 4)), "{fan:?}");
    Ok(())
}

#[test]
fn wide_lines_are_as_wide_as_the_pass_says() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    if !device.profile().has_feature("wideLines") {
        return Ok(());
    }
    let pass = vertices(2, "raster_points", "topology: LineList, line_width: 3.0");
    let Drawn { outputs, .. } = drawn(device, &text(&[pass], 1, false), Ways::default(), false)?;
    let found = places(&outputs[0]);
    for y in 0..8 {
        let middle: Vec<usize> =
            found.iter().filter(|at| at.1 == y && (3..=12).contains(&at.0)).map(|at| at.0).collect();
        assert_eq!(middle.len(), if (1..=3).contains(&y) { 10 } else { 0 }, "row {y}: {found:?}");
    }
    Ok(())
}

/// The factors by name: with new, old and second colour, constants, and the channel.
fn factor(name: &str, at: usize) -> f64 {
    let of = |light: [f64; 4], alpha: bool| if alpha { light[3] } else { light[at] };
    if let Some(rest) = name.strip_prefix("OneMinus") {
        return 1.0 - factor(rest, at);
    }
    match name {
        "Zero" => 0.0,
        "One" => 1.0,
        "SrcColor" => of(NEW_LIGHT, false),
        "DstColor" => of(OLD_LIGHT, false),
        "SrcAlpha" => of(NEW_LIGHT, true),
        "DstAlpha" => of(OLD_LIGHT, true),
        "ConstantColor" => of(CONSTANTS, false),
        "ConstantAlpha" => of(CONSTANTS, true),
        "Src1Color" => of(OTHER, false),
        "Src1Alpha" => of(OTHER, true),
        "SrcAlphaSaturate" if at == 3 => 1.0,
        "SrcAlphaSaturate" => NEW_LIGHT[3].min(1.0 - OLD_LIGHT[3]),
        other => panic!("{other}"),
    }
}

const FACTORS: [&str; 19] = [
    "Zero",
    "One",
    "SrcColor",
    "OneMinusSrcColor",
    "DstColor",
    "OneMinusDstColor",
    "SrcAlpha",
    "OneMinusSrcAlpha",
    "DstAlpha",
    "OneMinusDstAlpha",
    "ConstantColor",
    "OneMinusConstantColor",
    "ConstantAlpha",
    "OneMinusConstantAlpha",
    "SrcAlphaSaturate",
    "Src1Color",
    "OneMinusSrc1Color",
    "Src1Alpha",
    "OneMinusSrc1Alpha",
];

fn operation(name: &str, [new, old]: [f64; 2], [by_new, by_old]: [f64; 2]) -> f64 {
    match name {
        "Add" => new * by_new + old * by_old,
        "Subtract" => new * by_new - old * by_old,
        "ReverseSubtract" => old * by_old - new * by_new,
        "Min" => new.min(old),
        "Max" => new.max(old),
        other => panic!("{other}"),
    }
}

#[test]
fn blends_are_what_their_factors_and_operations_make() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let has_second = device.profile().has_feature("dualSrcBlend");
    let mut equations: Vec<[&str; 6]> = Vec::new();
    for name in FACTORS.into_iter().filter(|name| has_second || !name.contains("Src1")) {
        equations.push([name, "Zero", "Add", name, "Zero", "Add"]);
        equations.push(["Zero", name, "Add", "Zero", name, "Add"]);
        equations.push(["One", "Zero", "Add", "Zero", name, "Add"]);
    }
    for name in ["Add", "Subtract", "ReverseSubtract", "Min", "Max"] {
        equations.push(["One", "SrcAlpha", name, "DstAlpha", "One", name]);
        equations.push(["SrcAlpha", "DstColor", name, "One", "Zero", "Add"]);
    }
    let case = |[src, dst, op, src_alpha, dst_alpha, alpha_op]: &[&str; 6]| {
        let second = [src, dst, src_alpha, dst_alpha].iter().any(|name| name.contains("Src1"));
        let (shader, other) = match second {
            true => ("raster_second", r#", "other": (0.3, 0.9, 0.1, 0.7)"#),
            false => ("raster_color", ""),
        };
        format!(
            r#"draw: FullScreen("{shader}"), params: {{{FIRST}{other}}}, raster: (blend_constants: (0.1, 0.3, 0.7, 0.9)),
               color: [(image: "$image", blend: (src_color: {src}, dst_color: {dst}, color_op: {op}, src_alpha: {src_alpha},
                   dst_alpha: {dst_alpha}, alpha_op: {alpha_op}))]"#
        )
    };
    let cases: Vec<String> = equations.iter().map(case).collect();
    for samples in [1, 4] {
        let Drawn { plan, outputs } = drawn(device, &text(&cases, samples, false), Ways::default(), false)?;
        for (equation, output) in equations.iter().zip(&outputs) {
            let [src, dst, op, src_alpha, dst_alpha, alpha_op] = equation;
            let expected = [0, 1, 2, 3].map(|at| {
                let (op, src, dst) = if at == 3 { (alpha_op, src_alpha, dst_alpha) } else { (op, src, dst) };
                let value = operation(op, [NEW_LIGHT[at], OLD_LIGHT[at]], [factor(src, at), factor(dst, at)]);
                (value.clamp(0.0, 1.0) * 255.0).round() as u8
            });
            demand_even(output, expected, &format!("{equation:?}"), &plan);
        }
    }
    Ok(())
}

#[test]
fn each_target_has_its_own_blend_and_channels() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let text = r#"Pipeline(version: 1,
        images: [(name: "a", format: R8G8B8A8_UNORM, size: Output), (name: "b", format: R8G8B8A8_UNORM, size: Output)],
        passes: [(name: "before_a", draw: FullScreen("even"), color: ["a"]),
                 (name: "before_b", draw: FullScreen("even"), color: ["b"]),
                 (name: "both", draw: FullScreen("raster_both"), color: [
                    (image: "a", write_mask: (true, true, false, false)),
                    (image: "b", blend: (src_color: One, dst_color: One, color_op: ReverseSubtract), write_mask: (false, false, true, true))])],
        outputs: ["a", "b"])"#;
    let Drawn { plan, outputs } = drawn(device, text, Ways::default(), false)?;
    demand_even(&outputs[0], [NEW[0], NEW[1], OLD[2], OLD[3]], "a", &plan);
    demand_even(&outputs[1], [OLD[0], OLD[1], 255 - 102, 255 - 204], "b", &plan);
    Ok(())
}

/// The depth that a pass leaves, row by row alike, of 16 texels.
fn depths(device: &Device, pass: &str) -> Result<Vec<f64>, Box<dyn Error>> {
    let text = format!(
        r#"Pipeline(version: 1,
            images: [(name: "depth", format: D32_SFLOAT, size: Output), (name: "seen", format: R32_SFLOAT, size: Output)],
            passes: [(name: "state", draw: Vertices(3), depth: (image: "depth", clear: 0.0, test: Always), {pass}),
                     (name: "see", draw: FullScreen("copy"), sample: {{"source": (image: "depth", filter: Nearest)}}, color: ["seen"])],
            outputs: ["seen"])"#
    );
    let Drawn { outputs, .. } = drawn(device, &text, Ways::default(), false)?;
    let all = floats(&outputs[0]);
    assert!(all.chunks(16).all(|row| row == &all[..16]), "{all:?}");
    Ok(all[..16].to_vec())
}

#[test]
fn depth_bias_adds_steps_and_slopes_up_to_its_bound() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let biased = |bias: &str| {
        let shader = r#"shader: (vertex: "raster_slope", fragment: "depth_alone")"#;
        depths(device, &format!("{shader}, raster: (depth_bias: ({bias}))"))
    };
    let plain = biased("")?;
    for (x, depth) in plain.iter().enumerate() {
        let expected = 0.25 + 0.25 * (x as f64 + 0.5) / 16.0;
        assert!((depth - expected).abs() < 1e-6, "{x}: {depth} {expected}");
    }
    let off =
        |biased: &[f64]| -> Vec<f64> { biased.iter().zip(&plain).map(|(with, without)| with - without).collect() };
    let demand = |found: Vec<f64>, expected: f64, what: &str| {
        assert!(found.iter().all(|it| (it - expected).abs() < 1e-5), "{what}: {found:?} {expected}");
    };
    // The greatest slope is 1/64 a texel.
    demand(off(&biased("slope: 2.0")?), 2.0 / 64.0, "slope");
    demand(off(&biased("slope: -1.0")?), -1.0 / 64.0, "away");
    // The triangle's greatest depth is 0.75: a step is 2^(-1 - 23).
    demand(off(&biased("constant: 131072.0")?), 131_072.0 / f64::from(1 << 24), "constant");
    if device.profile().has_feature("depthBiasClamp") {
        demand(off(&biased("slope: 8.0, clamp: 0.01")?), 0.01, "bound");
        demand(off(&biased("slope: -8.0, clamp: -0.02")?), -0.02, "bound from below");
    }
    Ok(())
}

#[test]
fn depth_beyond_a_plane_is_cut_off_or_moved_onto_it() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let shader = r#"shader: (vertex: "raster_beyond", fragment: "depth_alone")"#;
    assert_eq!(depths(device, shader)?, [0.0; 16]);
    if device.profile().has_feature("depthClamp") {
        assert_eq!(depths(device, &format!("{shader}, raster: (depth_clamp: true)"))?, [1.0; 16]);
    }
    Ok(())
}

/// Objects say which of their faces are left out; a pass may say otherwise.
#[test]
fn a_pass_may_leave_out_other_faces_of_objects() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    let shown = |raster: &str| -> Result<Vec<f64>, Box<dyn Error>> {
        let text = format!(
            r#"Pipeline(version: 1,
                images: [(name: "depth", format: D32_SFLOAT, size: Output), (name: "seen", format: R32_SFLOAT, size: Output)],
                passes: [(name: "objects", draw: Objects(Opaque), shader: "depth_alone", depth: (image: "depth", clear: 0.0){raster}),
                         (name: "see", draw: FullScreen("copy"), sample: {{"source": (image: "depth", filter: Nearest)}}, color: ["seen"])],
                outputs: ["seen"])"#
        );
        let mut file = tempfile::NamedTempFile::new()?;
        file.write_all(text.as_bytes())?;
        let pipeline = file.path().to_str().ok_or("no path")?;
        let setup = Setup { pipeline, set: &[], scene: &scene, extent: [96, 60] };
        Ok(floats(&framewright_tests::render::render(device, &setup)?[0]))
    };
    let usual = shown("")?;
    let [front, turned, none] = ["cull_mode: Front", "front_face: Clockwise", "cull_mode: Neither"]
        .map(|it| shown(&format!(", raster: ({it})")));
    let (front, turned, none) = (front?, turned?, none?);
    assert!(front == turned, "front faces are left out in both");
    assert!(none == usual, "closed objects hide their back faces");
    assert!(front.iter().zip(&usual).all(|(back, front)| back <= front), "back faces are farther away");
    assert!(front.iter().zip(&usual).filter(|(back, front)| back < front).count() > 100);
    assert!(shown(", raster: (cull_mode: FrontAndBack)")?.iter().all(|depth| *depth == 0.0));
    Ok(())
}
