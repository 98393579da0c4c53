//! The rotation, as draw sources and custom passes are told of it.

use super::{EXTENT, drawn, planned};
use framewright_graph::frame::Draw;
use framewright_graph::vulkan::{FillValue, Rotation};
use framewright_passes::draw::SceneDrawSource;
use framewright_tests::render::device;
use framewright_tests::shapes::{material, scene, square};
use framewright_vulkan::{CustomRecorder, DrawSource, Error, Recorder};
use glam::{Mat4, Vec3};

/// Draws a scene within a rectangle, and notes the rotation that it is told.
struct Noting {
    scene: SceneDrawSource,
    told: Vec<(Rotation, [u32; 2], [u32; 2])>,
    narrow: bool,
}

impl DrawSource for Noting {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        self.told.push((recorder.rotation(), recorder.extent(), recorder.target_extent()));
        if self.narrow {
            recorder.set_viewport([10.0, 5.0], [60.0, 40.0]);
            recorder.set_scissor([20, 10], [1000, 22]);
        }
        self.scene.record(draw, recorder)
    }

    fn custom(&mut self, _: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        let image = recorder.image("screen").expect("the pass writes it");
        let [width, height, _] = image.extent;
        self.told.push((image.rotation, image.rotation.extent([width, height]), [width, height]));
        recorder.fill("screen", FillValue::Color([0.25, 0.5, 0.75, 1.0]));
        Ok(())
    }
}

/// A slanted square: of no two rotations its picture is the same.
fn tilted() -> framewright_passes::scene::Scene {
    let place = Mat4::from_rotation_z(0.3) * Mat4::from_scale(Vec3::new(2.0, 0.6, 1.0));
    scene(vec![square()], vec![material([0.9, 0.4, 0.1, 1.0])], vec![(0, 0, place)])
}

const OBJECTS: &str = r#"Pipeline(
    version: 1,
    images: [(name: "screen", format: Output, size: Output), (name: "depth", format: Depth, size: Output)],
    passes: [
        (name: "opaque", draw: Objects(Opaque), shader: "lit", color: [(image: "screen", clear: (0.1, 0.0, 0.2, 1.0))],
            depth: (image: "depth", clear: 0.0)),
        (name: "sky", draw: Sky, color: ["screen"], depth: (image: "depth", write: false)),
    ],
    outputs: ["screen"],
)"#;

const CUSTOM: &str = r#"Pipeline(
    version: 1,
    images: [(name: "screen", format: Output, size: Output)],
    passes: [(name: "paint", custom: "paint", writes: "screen")],
    outputs: ["screen"],
)"#;

/// PR-5: who draws says rectangles of the upright picture; the next pass has all of it again.
#[test]
fn viewports_and_scissors_are_those_of_the_upright_picture() -> Result<(), Box<dyn std::error::Error>> {
    let Some(device) = device() else { return Ok(()) };
    let shown = |rotation, narrow| {
        let plan = planned(device, OBJECTS, rotation)?;
        let scene = SceneDrawSource::for_plan(device, &tilted(), EXTENT, &plan)?;
        let mut source = Noting { scene, told: Vec::new(), narrow };
        Ok::<_, Box<dyn std::error::Error>>(drawn(device, &plan, &mut source)?.swap_remove(0).bytes)
    };
    let [narrow, whole] = [shown(Rotation::Identity, true)?, shown(Rotation::Identity, false)?];
    assert!(narrow != whole);
    for rotation in Rotation::ALL {
        assert!(shown(rotation, true)? == narrow, "{rotation:?}");
        assert!(shown(rotation, false)? == whole, "{rotation:?}");
    }
    Ok(())
}

/// PR-8: rotation, the upright size, and the size of what is written.
#[test]
fn custom_passes_and_draws_are_told_rotation_and_size() -> Result<(), Box<dyn std::error::Error>> {
    let Some(device) = device() else { return Ok(()) };
    for rotation in Rotation::ALL {
        for text in [OBJECTS, CUSTOM] {
            let plan = planned(device, text, rotation)?;
            let scene = SceneDrawSource::for_plan(device, &tilted(), EXTENT, &plan)?;
            let mut source = Noting { scene, told: Vec::new(), narrow: false };
            let texels = drawn(device, &plan, &mut source)?.swap_remove(0);
            assert_eq!([texels.extent[0], texels.extent[1]], EXTENT);
            assert!(!source.told.is_empty());
            let turned = if rotation.degrees() % 180 == 90 { [EXTENT[1], EXTENT[0]] } else { EXTENT };
            assert!(source.told.iter().all(|told| *told == (rotation, EXTENT, turned)), "{:?}", source.told);
        }
    }
    Ok(())
}
