//! Shaders of objects, of the sky and of what else has vertices, for scenes whose materials and lights hold numbers that go wrong
//! easily. No file brings such a scene; a program may.

use super::full_screen::full_screen;
use super::pipeline::{Pipeline, own, params};
use super::{demand_storable, draws_color, names, outputs};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::{BindingKind, ShaderInterface, ShaderInterfaces, Variant};
use framewright_passes::scene::{AlphaMode, Scene, Sky, Sun};
use framewright_tests::render::library;
use framewright_tests::shapes::{material, scene, square};
use glam::{Mat4, Vec3};
use std::error::Error;

const EXTREMES: [f32; 9] = [0.0, 1e-45, 65504.0, 1e30, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, -1.0];

/// A wall of squares, half of them with holes, each with `extreme` in another place; all light is `extreme` too if `lit` says so.
fn wall(extreme: f32, lit: bool) -> Scene {
    let mut materials = Vec::new();
    let mut meshes = Vec::new();
    let mut objects = Vec::new();
    for masked in [false, true] {
        for place in 0..4 {
            let mut paint = material([0.5, 0.5, 0.5, 1.0]);
            let mut mesh = square();
            match place {
                0 => paint.base_color = [extreme, extreme, extreme, 1.0],
                1 => paint.emissive = [extreme; 3],
                2 => mesh.normals = vec![[extreme; 3]; 4],
                _ => paint.base_color[3] = extreme,
            }
            if masked {
                paint.alpha = AlphaMode::Mask { cutoff: 0.5 };
            }
            let at = Vec3::new(f32::from(place as u8) * 2.0 - 3.0, if masked { -1.0 } else { 1.0 }, 0.0);
            objects.push((meshes.len(), materials.len(), Mat4::from_translation(at)));
            meshes.push(mesh);
            materials.push(paint);
        }
    }
    let wall = scene(meshes, materials, objects);
    if !lit {
        return wall;
    }
    let light = [extreme; 3];
    let sun = Sun { direction: [0.0, 0.0, -1.0], color: light, shadows: false };
    Scene { sun, ambient: light, sky: Sky { zenith: light, horizon: light, ground: light }, ..wall }
}

/// How a shader that doesn't fill the screen is drawn.
fn draw_of(name: &str) -> Result<(Draw, ShaderInterface), Box<dyn Error>> {
    let drawn = |draw| library().draw_shader(name, draw, &Variant::default());
    if let Ok(shader) = drawn(Draw::Sky)
        && shader.vertex_inputs.is_empty()
    {
        let buffers = own(&shader).any(|it| matches!(it.kind, BindingKind::StorageBlock { .. }));
        return Ok((if buffers { Draw::Indirect } else { Draw::Sky }, shader));
    }
    let shader = drawn(Draw::Objects(DrawList::Opaque)).map_err(|problem| format!("{name}: {problem:?}"))?;
    Ok((Draw::Objects(if shader.discards { DrawList::Masked } else { DrawList::Opaque }), shader))
}

/// Passes that make flakes of snow, for shaders that draw neither objects nor the sky.
const FLAKES: &str = r#"
    (name: "fall", dispatch: "snow_fall", groups: Invocations(256, 1, 1),
        storage: {"before": (buffer: "flakes", previous: 1), "flakes": (buffer: "flakes", access: Write)},
        params: {"seconds": 0.02, "wind": 0.3}),
    (name: "gather", dispatch: "snow_gather", groups: Count(1, 1, 1),
        storage: {"flakes": "flakes", "seen": (buffer: "seen", access: Write), "counts": (buffer: "counts", access: Write)}),
"#;

fn pipeline() -> Result<String, Box<dyn Error>> {
    let mut pipeline = Pipeline::default();
    let mut depths = 0;
    for name in names()?.into_iter().filter(|name| full_screen(name).is_none()) {
        let (draw, shader) = draw_of(&name)?;
        if !draws_color(&shader) {
            continue;
        }
        let targets = pipeline.targets(&name, &shader.outputs);
        let params = params(&shader, 1_000_000_000);
        let what = match draw {
            Draw::Sky => "Sky".to_owned(),
            Draw::Objects(list) => format!("Objects({list:?})"),
            _ => {
                pipeline.buffer("(name: \"flakes\", bytes: 4096, lifetime: History), ");
                pipeline.buffer("(name: \"seen\", bytes: 1024), (name: \"counts\", bytes: 16), ");
                pipeline.pass(FLAKES);
                pipeline.pass(&format!(
                    "(name: \"{name}\", draw: Indirect(\"counts\"), shader: \"{name}\", color: [{targets}], \
                     storage: {{\"flakes\": (buffer: \"flakes\", access: Read), \"seen\": (buffer: \"seen\", access: Read)}}, \
                     params: {{{params}}}),\n"
                ));
                continue;
            }
        };
        let depth = format!("depth_{depths}");
        depths += 1;
        pipeline.image(&depth, "Depth");
        pipeline.pass(&format!(
            "(name: \"{name}\", draw: {what}, shader: \"{name}\", color: [{targets}], \
             depth: (image: \"{depth}\", clear: 0.0)),\n"
        ));
    }
    Ok(pipeline.text())
}

#[test]
fn every_other_shipped_shader_stores_finite_numbers_whatever_materials_and_lights_hold() -> Result<(), Box<dyn Error>> {
    let pipeline = pipeline()?;
    for name in ["lit", "g_buffer", "g_buffer_masked", "motion", "motion_sky", "sky", "snow"] {
        assert!(pipeline.contains(&format!("(name: \"{name}\", draw")), "{name} is drawn");
    }
    for extreme in EXTREMES {
        for lit in [false, true] {
            let Some(found) = outputs(&pipeline, &wall(extreme, lit))? else { return Ok(()) };
            assert!(found.iter().any(|numbers| numbers.iter().any(|number| *number != 0.0)), "something is drawn");
            demand_storable(&format!("{extreme}, lit by it: {lit}"), &found);
        }
    }
    Ok(())
}
