//! Rotations as shaders see them, and the shaders that they break.

use super::{EXTENT, drawn, floats, planned};
use framewright_graph::frame::Draw;
use framewright_graph::shader::{ShaderInterfaces, ShaderProblem, UnturnedPart, Variant};
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw::SceneDrawSource;
use framewright_passes::shipped::SHADERS;
use framewright_tests::render::{device, library};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::{Device, Texels};
use std::error::Error;

/// One full-screen draw of a shader into the output, of floating point.
fn one_draw(shader: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            images: [(name: "screen", format: R32G32B32A32_SFLOAT, size: Output)],
            passes: [(name: "draw", draw: FullScreen("{shader}"), color: ["screen"])],
            outputs: ["screen"],
        )"#
    )
}

/// Noise, and another draw that fetches it texel by texel, by each way to say where a fragment lies.
const FETCHED: &str = r#"Pipeline(
    version: 1,
    images: [
        (name: "noise", format: R32G32B32A32_SFLOAT, size: Output),
        (name: "by_place", format: R32G32B32A32_SFLOAT, size: Output),
        (name: "by_uv", format: R32G32B32A32_SFLOAT, size: Output),
    ],
    passes: [
        (name: "noise", draw: FullScreen("noise_of_texels"), color: ["noise"],
            params: {"width": "width(noise)", "height": "height(noise)"}),
        (name: "fetch", draw: FullScreen("fetch"), sample: {"source": "noise"}, color: ["by_place"]),
        (name: "copy", draw: FullScreen("copy"), sample: {"source": (image: "noise", filter: Nearest)}, color: ["by_uv"]),
    ],
    outputs: ["noise", "by_place", "by_uv"],
)"#;

fn shown(device: &Device, text: &str, rotation: Rotation) -> Result<Vec<Texels>, Box<dyn Error>> {
    let plan = planned(device, text, rotation)?;
    let mut source = SceneDrawSource::for_plan(device, &empty_scene(), EXTENT, &plan)?;
    drawn(device, &plan, &mut source)
}

/// PR-3, PR-5: exactly, at every texel, by the helpers and by `uv`.
#[test]
fn texels_are_fetched_exactly_where_they_are() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let upright = shown(device, FETCHED, Rotation::Identity)?;
    for rotation in Rotation::ALL {
        let outputs = shown(device, FETCHED, rotation)?;
        for (output, expected) in outputs.iter().zip(&upright) {
            assert_eq!(output.extent, [EXTENT[0], EXTENT[1], 1]);
            assert!(output.bytes == upright[0].bytes && expected.bytes == upright[0].bytes, "{rotation:?}");
        }
    }
    Ok(())
}

/// PR-6: a ramp's derivatives, and where fragments lie.
#[test]
fn derivatives_and_places_of_the_helpers_are_upright() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let [across, down] = [3.0 / EXTENT[0] as f32, 5.0 / EXTENT[1] as f32];
    for rotation in Rotation::ALL {
        let texels = floats(&shown(device, &one_draw("ramp"), rotation)?[0]);
        for (at, [dx, dy, x, y]) in texels.into_iter().enumerate() {
            let (column, row) = (at % EXTENT[0] as usize, at / EXTENT[0] as usize);
            assert_eq!([x, y], [column as f32 + 0.5, row as f32 + 0.5], "{rotation:?}");
            assert!((dx - across).abs() < 1e-4 && (dy - down).abs() < 1e-4, "{rotation:?}: {dx}, {dy}");
        }
    }
    Ok(())
}

/// The values of `fwidth`, depth and `uv` don't depend on a rotation, so no shader is refused for them.
#[test]
fn what_no_rotation_changes_is_left_alone() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let upright = floats(&shown(device, &one_draw("unmoved"), Rotation::Identity)?[0]);
    for rotation in Rotation::ALL {
        let texels = floats(&shown(device, &one_draw("unmoved"), rotation)?[0]);
        let off = texels
            .iter()
            .zip(&upright)
            .filter(|(some, others)| some.iter().zip(*others).any(|(one, other)| (one - other).abs() > 1e-5));
        assert_eq!(off.count(), 0, "{rotation:?}");
    }
    Ok(())
}

/// PR-4: what is drawn on the way is upright, and its shaders' rotation is 0: the same shader draws the same into it.
#[test]
fn images_that_do_not_leave_the_frame_are_drawn_upright() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let text = r#"Pipeline(
        version: 1,
        images: [
            (name: "ramp", format: R32G32B32A32_SFLOAT, size: Output),
            (name: "screen", format: R32G32B32A32_SFLOAT, size: Output),
        ],
        passes: [
            (name: "ramp", draw: FullScreen("raw_ramp"), color: ["ramp"]),
            (name: "copy", draw: FullScreen("copy"), sample: {"source": (image: "ramp", filter: Nearest)}, color: ["screen"]),
        ],
        outputs: ["screen"],
    )"#;
    let upright = shown(device, text, Rotation::Identity)?;
    for rotation in Rotation::ALL {
        assert!(shown(device, text, rotation)?[0].bytes == upright[0].bytes, "{rotation:?}");
    }
    Ok(())
}

/// PR-6: what reads `gl_FragCoord` or `dFdx` itself, or places vertices without the rotation, at its place in the file.
#[test]
fn a_shader_that_breaks_is_reported_at_its_pass() {
    let Some(device) = device() else { return };
    assert!(planned(device, &one_draw("raw_ramp"), Rotation::Identity).is_ok());
    let said = planned(device, &one_draw("raw_ramp"), Rotation::Rotate90).expect_err("it breaks");
    let expected = "`draw` has the shader `raw_ramp`, which reads `gl_FragCoord` without `frag_coord()` and takes `dFdx` or \
                    `dFdy` without `ddx()` or `ddy()`; it draws into `screen`, which is rotated by 90°";
    assert!(said.contains(expected), "{said}");
    assert!(said.contains("test.ron:4:29") && said.contains("`include/rotation.glsl`"), "{said}");
    let vertices = one_draw("corner").replace("FullScreen(\"corner\")", "Vertices(3), shader: \"corner\"");
    let clears = vertices.replacen("[\"screen\"]", "[(image: \"screen\", clear: (0.0, 0.0, 0.0, 0.0))]", 1);
    let said = planned(device, &clears, Rotation::Rotate180).expect_err("it breaks");
    assert!(said.contains("which places vertices without `rotate_clip()`"), "{said}");
}

/// PR-6: each shipped shader with each draw that it is shipped for.
#[test]
fn no_shipped_shader_breaks() {
    let draws = [
        Draw::FullScreen,
        Draw::Sky,
        Draw::Objects(framewright_graph::frame::DrawList::Opaque),
        Draw::Vertices { count: 6, instances: 1 },
    ];
    let (mut library, mut known) = (library(), 0);
    for name in SHADERS.iter().filter_map(|(file, _)| file.strip_suffix(".frag")) {
        let fits: Vec<_> = draws
            .iter()
            .filter_map(|draw| match library.draw_shader(&format!("shipped:{name}"), *draw, &Variant::default()) {
                Ok(interface) => Some(interface.unturned),
                Err(ShaderProblem::Unsupported { .. }) => None,
                Err(other) => panic!("{name}: {other:?}"),
            })
            .collect();
        assert!(!fits.is_empty() && fits.iter().all(Vec::is_empty), "{name}: {fits:?}");
        known += fits.len();
    }
    assert!(known > 30, "{known}");
    let ramp = library.draw_shader("raw_ramp", Draw::FullScreen, &Variant::default()).expect("it compiles");
    assert_eq!(ramp.unturned, [UnturnedPart::FragCoord, UnturnedPart::Derivatives]);
}

/// PR-7: with the place in the file.
#[test]
fn the_screen_beside_another_target_is_refused_at_its_place() {
    let Some(device) = device() else { return };
    let text = r#"Pipeline(
        version: 1,
        images: [
            (name: "screen", format: Output, size: Output),
            (name: "other", format: R8G8B8A8_UNORM, size: Output),
            (name: "depth", format: Depth, size: Output),
        ],
        passes: [
            (name: "both", draw: Objects(Opaque), shader: "g_buffer", color: [
                (image: "screen", clear: (0.0, 0.0, 0.0, 1.0)),
                (image: "other", clear: (0.0, 0.0, 0.0, 1.0)),
                (image: "other_too", clear: (0.0, 0.0, 0.0, 1.0)),
            ], depth: (image: "depth", clear: 0.0)),
        ],
        outputs: ["screen"],
    )"#;
    let text = text.replace(
        "(name: \"depth\"",
        "(name: \"other_too\", format: R16G16B16A16_SFLOAT, size: Output), (name: \"depth\"",
    );
    let text = text.replace("(name: \"other\", format: R8G8B8A8_UNORM", "(name: \"other\", format: R16G16_SFLOAT");
    assert_eq!(planned(device, &text, Rotation::Identity).err(), None);
    let said = planned(device, &text, Rotation::Rotate270).expect_err("it is refused");
    let expected =
        "`both` draws into `screen`, which leaves the frame rotated by 270°, and into `other`, which doesn't";
    assert!(said.contains(expected) && said.contains("test.ron:10:25"), "{said}");
}
