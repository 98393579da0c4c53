//! Pictures are held against the ray-caster: object and base colour, at one and at four samples a pixel.

use framewright_graph::vulkan::Filter;
use framewright_passes::scene::{Movement, Object, Sampler, Scene, Texture, Wrap, load};
use framewright_tests::agreement::agreement;
use framewright_tests::raycast::texture::decode;
use framewright_tests::render::{Setup, device, in_repository, render};
use framewright_tests::shapes::{material, scene, square};
use framewright_vulkan::Device;
use glam::{DMat4, DVec3, Mat4, Vec3};
use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;

/// The share of interior pixels that must agree.
const SHARE: f64 = 0.995;

/// Objects and base colours, as drawn.
fn drawn(device: &Device, scene: &Scene, extent: [u32; 2], msaa: &str) -> Result<[Vec<u8>; 2], Box<dyn Error>> {
    let set = [("msaa", msaa)];
    let setup = Setup { pipeline: "tests/pipelines/object_and_color.ron", set: &set, scene, extent };
    let mut outputs = render(device, &setup)?.into_iter().map(|output| output.bytes);
    Ok([outputs.next().ok_or("no objects")?, outputs.next().ok_or("no colours")?])
}

/// Draws a scene at one and at four samples a pixel, and fails unless the ray-caster agrees.
fn demand_agreement(device: &Device, shown: &str, scene: &Scene, extent: [u32; 2]) -> Result<(), Box<dyn Error>> {
    for msaa in ["1", "4"] {
        let [objects, colors] = drawn(device, scene, extent, msaa)?;
        let found = agreement(scene, extent, &objects, &colors);
        assert!(found.objects.interior > 100, "{shown}: nothing to compare\n{found}");
        assert!(found.objects.agrees(SHARE) && found.background.agrees(SHARE), "{shown} at {msaa}×\n{found}");
    }
    Ok(())
}

/// Files of a folder of the repository with this ending, by name.
fn files(folder: &str, ending: &str) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let entries = std::fs::read_dir(in_repository(folder))?.collect::<Result<Vec<_>, _>>()?;
    let mut paths: Vec<PathBuf> = entries.iter().map(std::fs::DirEntry::path).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == ending));
    paths.sort();
    Ok(paths)
}

#[test]
fn every_glb_fixture_is_drawn_as_the_ray_caster_sees_it() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let fixtures = files("tests/glb", "glb")?;
    assert!(fixtures.len() >= 8, "{fixtures:?}");
    for path in fixtures {
        demand_agreement(device, &format!("{:?}", path.file_name()), &load(&path)?, [300, 200])?;
    }
    Ok(())
}

#[test]
fn every_shipped_scene_is_drawn_as_the_ray_caster_sees_it() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scenes = files("examples/scenes", "ron")?;
    assert!(!scenes.is_empty());
    for path in scenes {
        demand_agreement(device, &format!("{:?}", path.file_name()), &load(&path)?, [320, 180])?;
    }
    Ok(())
}

#[test]
fn a_scene_a_million_metres_from_its_origin_is_drawn_where_it_is() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut scene = load(&in_repository("tests/glb/transforms.glb"))?;
    let away = DMat4::from_translation(DVec3::new(1e6, -1e6, 1e6));
    for object in &mut scene.objects {
        object.transform = away * object.transform;
    }
    scene.camera.transform = away * scene.camera.transform;
    demand_agreement(device, "transforms.glb, far away", &scene, [300, 200])
}

#[test]
fn any_picture_size_is_drawn_upright() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("tests/glb/transforms.glb"))?;
    demand_agreement(device, "transforms.glb, portrait", &scene, [101, 203])?;
    for msaa in ["1", "4"] {
        drawn(device, &scene, [1, 1], msaa)?;
    }
    Ok(())
}

/// Squares that show more than a texture, one for each pair of ways to go on beyond its borders, and one sharp.
fn wrapped_squares() -> Scene {
    let wraps = [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge];
    let mut wide = square();
    wide.uvs.iter_mut().flatten().for_each(|coordinate| *coordinate = *coordinate * 3.5 - 1.25);
    let mut scene = scene(vec![wide], Vec::new(), Vec::new());
    for number in 0..9 {
        let sampler = Sampler { wrap_u: wraps[number % 3], wrap_v: wraps[number / 3], ..Sampler::default() };
        let sampler = if number == 4 { Sampler { magnify: Filter::Nearest, ..sampler } } else { sampler };
        let rgba8 =
            [255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255, 90, 90, 0, 255].into();
        scene.textures.push(Texture { name: String::new(), width: 3, height: 2, rgba8, sampler });
        let mut material = material([0.9, 0.6, 0.8, 1.0]);
        material.base_color_texture = Some(number);
        scene.materials.push(material);
        let at = Vec3::new((number % 3) as f32 - 1.0, (number / 3) as f32 - 1.0, 0.0) * 1.8;
        let transform = (Mat4::from_translation(at) * Mat4::from_scale(Vec3::splat(0.8))).as_dmat4();
        scene.objects.push(Object {
            name: String::new(),
            mesh: 0,
            material: number,
            transform,
            cross_fade: 1.0,
            movement: Movement::default(),
        });
    }
    scene
}

#[test]
fn textures_wrap_in_each_direction_as_they_say() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    demand_agreement(device, "wrapped squares", &wrapped_squares(), [300, 300])
}

/// Something drawn wrongly, by name: the scene that the ray-caster is given instead.
type Change = (&'static str, fn(&mut Scene));

#[test]
fn the_comparison_notices_what_is_drawn_wrongly() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let extent = [150, 150];
    let right = wrapped_squares();
    let [objects, colors] = drawn(device, &right, extent, "1")?;
    let changes: [Change; 6] = [
        ("v upside down", |scene| scene.meshes[0].uvs.iter_mut().for_each(|[_, v]| *v = 1.0 - *v)),
        ("no base colour factor", |scene| scene.materials.iter_mut().for_each(|it| it.base_color = [1.0; 4])),
        ("directions of wrapping exchanged", |scene| {
            let samplers = scene.textures.iter_mut().map(|texture| &mut texture.sampler);
            samplers.for_each(|it| (it.wrap_u, it.wrap_v) = (it.wrap_v, it.wrap_u));
        }),
        ("texels as if they were linear", |scene| {
            let texels = scene.textures.iter_mut().flat_map(|texture| Arc::make_mut(&mut texture.rgba8));
            texels.for_each(|texel| *texel = (255.0 * decode(f64::from(*texel) / 255.0)) as u8);
        }),
        ("another order of objects", |scene| scene.objects.reverse()),
        ("back faces for front faces", |scene| {
            let mirror = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
            let turn = DMat4::from_rotation_y(std::f64::consts::PI);
            scene.objects.iter_mut().for_each(|object| object.transform *= mirror * turn);
        }),
    ];
    for (change, apply) in changes {
        let mut wrong = right.clone();
        apply(&mut wrong);
        let found = agreement(&wrong, extent, &objects, &colors);
        assert!(!(found.objects.agrees(SHARE) && found.background.agrees(SHARE)), "{change}\n{found}");
    }
    Ok(())
}
