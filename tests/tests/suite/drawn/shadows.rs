//! The sun's shadows (IQ-25) are held against rays from what the ray-caster sees to the sun, and their edges against the twin of
//! the filter.

use framewright_graph::frame::{Cascade, DrawList, Share};
use framewright_graph::vulkan::Filter;
use framewright_passes::draw::cascades::sun_view;
use framewright_passes::scene::{AlphaMode, Camera, Sampler, Scene, Sun, Texture, Wrap};
use framewright_passes::twin::lighting::{lit_surface, reflect_light};
use framewright_passes::twin::sun_shadow::{self, DEPTH_ROUNDING, Shadows, faded};
use framewright_tests::raycast::RayCaster;
use framewright_tests::raycast::triangle::Ray;
use framewright_tests::render::{Setup, device, floats, render, rgba};
use framewright_tests::shapes::{material, scene, square};
use glam::{DVec2, DVec3, EulerRot, Mat4, Quat, Vec3};
use std::error::Error;

/// Width and height.
const EXTENT: [u32; 2] = [120, 90];
/// Width and height of the maps of `tests/pipelines/shadows.ron`.
const MAP: u32 = 1024;
/// The distance of the yard's near plane.
const NEAR: f32 = 0.05;
/// Largest error of a channel, relative to it.
const RELATIVE: f64 = 1e-3;

/// A floor, a wall, a slanted board and a fence with holes, in a slanted sun.
fn yard() -> Scene {
    let mut board = material([0.8, 0.5, 0.3, 1.0]);
    board.double_sided = true;
    let mut fence = material([0.3, 0.8, 0.4, 1.0]);
    fence.double_sided = true;
    fence.alpha = AlphaMode::Mask { cutoff: 0.5 };
    fence.base_color_texture = Some(0);
    let place = |at: [f32; 3], turn: [f32; 3], scale: [f32; 3]| {
        let turn = Quat::from_euler(EulerRot::XYZ, turn[0], turn[1], turn[2]);
        Mat4::from_scale_rotation_translation(Vec3::from(scale), turn, Vec3::from(at))
    };
    let mut yard = scene(
        vec![square()],
        vec![material([0.7, 0.7, 0.7, 1.0]), board, fence],
        vec![
            (0, 0, place([0.0, 0.0, 0.0], [-std::f32::consts::FRAC_PI_2, 0.0, 0.0], [6.0, 6.0, 1.0])),
            (0, 1, place([-1.5, 1.2, 0.0], [0.0, 0.6, 0.0], [1.2, 1.2, 1.0])),
            (0, 1, place([1.2, 1.9, -0.5], [0.9, 0.3, 0.0], [1.2, 1.0, 1.0])),
            (0, 2, place([0.3, 0.9, 1.6], [0.0, -0.2, 0.0], [1.0, 0.7, 1.0])),
        ],
    );
    yard.textures = vec![bars()];
    yard.camera = Camera::look_at(DVec3::new(2.5, 4.0, 6.0), DVec3::new(0.0, 0.4, 0.0), DVec3::Y, 0.8, NEAR)
        .expect("a direction");
    yard.ambient = [0.1, 0.15, 0.2];
    yard.sun =
        Sun { direction: Vec3::new(0.45, -1.0, -0.6).normalize().to_array(), color: [3.0, 2.5, 2.0], shadows: true };
    yard
}

/// Wide bars with as wide gaps.
fn bars() -> Texture {
    let [wrap_u, wrap_v] = [Wrap::ClampToEdge; 2];
    let sampler = Sampler { wrap_u, wrap_v, magnify: Filter::Nearest, minify: Filter::Nearest, mip: None };
    let texel = |x: u32| if (x / 16).is_multiple_of(2) { [255; 4] } else { [255, 255, 255, 0] };
    Texture { name: String::new(), width: 64, height: 1, rgba8: (0..64).flat_map(texel).collect(), sampler }
}

/// Holds the sun's light against rays, and counts pixels: in light, without it, and those that neither can be said of.
fn hold_against_rays(scene: &Scene, cascades: u8, taps: u32, reach: f32) -> Result<[usize; 3], Box<dyn Error>> {
    let Some(device) = device() else { return Ok([usize::MAX; 3]) };
    let (number, width) = (cascades.to_string(), taps.to_string());
    let far = reach.to_string();
    let set = [("cascades", &*number), ("taps", &*width), ("reach", &*far)];
    let setup = Setup { pipeline: "tests/pipelines/shadows.ron", set: &set, scene, extent: EXTENT };
    let outputs = render(device, &setup)?;
    let (texels, _) = outputs[0].bytes.as_chunks::<16>();
    // Rays to the sun begin at surfaces: the camera's near plane must hide nothing from them.
    let mut judged = scene.clone();
    judged.camera.near = NEAR;
    let caster = RayCaster::new(&judged);
    let to_sun = -Vec3::from(scene.sun.direction).as_dvec3();
    let (right, up) = to_sun.any_orthonormal_pair();
    // Where no blocker begins or ends within this, the coarsest map can tell.
    let coarsest = Cascade {
        list: DrawList::Opaque,
        index: cascades - 1,
        of: cascades,
        reach: reach.try_into().ok(),
        logarithmic: Share::OF_CASCADES,
    };
    let aspect = f64::from(EXTENT[0]) / f64::from(EXTENT[1]);
    let blur = sun_view(scene, &scene.camera, aspect, coarsest, MAP).texel * f64::from(taps + 3);
    let mut counts = [0; 3];
    for (index, texel) in texels.iter().enumerate() {
        let at = DVec2::new((index % EXTENT[0] as usize) as f64 + 0.5, (index / EXTENT[0] as usize) as f64 + 0.5);
        let ray = caster.camera_ray(at, EXTENT);
        let Some(hit) = caster.cast(&ray) else { continue };
        let corners = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)].map(|(x, y)| at + DVec2::new(x, y));
        if corners.iter().any(|&at| caster.cast(&caster.camera_ray(at, EXTENT)).map(|it| it.object) != Some(hit.object))
        {
            continue;
        }
        let position = ray.origin + ray.direction * hit.depth;
        // Along the ray to the sun up to just above the surface.
        let rise = hit.normal.dot(to_sun);
        let blocked = |across: f64, upwards: f64| {
            let beside = (right * across + up * upwards) * blur;
            let origin = position + beside + to_sun * ((0.01 - hit.normal.dot(beside)) / rise);
            caster.cast(&Ray { origin, direction: to_sun, spread: [DVec3::ZERO; 2] }).is_some()
        };
        if rise < 0.05 {
            counts[2] += 1;
            continue;
        }
        let here = blocked(0.0, 0.0);
        let around = (0..16).map(|step| f64::from(step) * std::f64::consts::TAU / 16.0);
        if around
            .into_iter()
            .any(|turn| [0.5, 1.0].iter().any(|far| blocked(turn.cos() * far, turn.sin() * far) != here))
        {
            counts[2] += 1;
            continue;
        }
        let share = position.distance(scene.camera.position()) / f64::from(reach);
        let sunlit = faded(if here { 0.0 } else { 1.0 }, share);
        counts[usize::from(here)] += 1;
        // Drivers snap corners to a 16th of a pixel, which is some millimetres of the way along which shadows fade.
        let fading = if sunlit > 0.0 && sunlit < 1.0 { 0.01 } else { 0.0 };
        let material = &scene.materials[scene.objects[hit.object as usize].material];
        let expected = lit_surface(material, hit.base_color, &reflect_light(scene, position, hit.normal, sunlit));
        for channel in 0..3 {
            let word: [u8; 4] = texel[4 * channel..4 * channel + 4].try_into()?;
            let found = f64::from(f32::from_ne_bytes(word));
            let close = (found - expected[channel]).abs() <= RELATIVE * expected[channel] + 1e-3 + fading;
            assert!(
                close,
                "{cascades} cascades, {taps} taps, {at}: object {} shows {found}, not {} (sunlit {sunlit})",
                hit.object, expected[channel]
            );
        }
    }
    Ok(counts)
}

#[test]
fn what_the_sun_does_not_reach_lies_in_shadow_whatever_the_cascades_and_the_filter() -> Result<(), Box<dyn Error>> {
    let yard = yard();
    for (cascades, taps) in [(1, 1), (2, 3), (4, 1), (4, 7)] {
        let [lit, dark, between] = hold_against_rays(&yard, cascades, taps, 14.0)?;
        assert!(lit > 1000 && dark > 50, "{cascades} cascades, {taps} taps: {lit} lit, {dark} dark, {between} between");
    }
    Ok(())
}

/// NU-5: along the last tenth of the reach shadows fade as the twin says; beyond it there are none.
#[test]
fn shadows_fade_along_the_last_tenth_of_their_reach() -> Result<(), Box<dyn Error>> {
    let yard = yard();
    for reach in [6.5, 7.5, 8.5] {
        let [lit, dark, between] = hold_against_rays(&yard, 2, 3, reach)?;
        assert!(lit > 1000 && dark > 50, "to {reach} m: {lit} lit, {dark} dark, {between} between");
    }
    Ok(())
}

/// NU-5: in every pixel, at the edges of shadows and between two cascades too, as much of the sun's light arrives as the twin finds
/// in the same maps. It is asked with depth a little raised and lowered: what lies so near to a caster may be in light or not.
#[test]
fn as_much_of_the_sun_arrives_in_every_pixel_as_the_twin_finds_in_the_maps() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let yard = yard();
    let aspect = f64::from(EXTENT[0]) / f64::from(EXTENT[1]);
    for (of, taps, reach) in [(1, 1, 14.0), (1, 7, 9.0), (2, 3, 14.0), (4, 5, 9.0), (4, 7, 14.0)] {
        let [number, width, far] = [of.to_string(), taps.to_string(), reach.to_string()];
        let set = [("cascades", &*number), ("taps", &*width), ("reach", &*far)];
        let setup = Setup { pipeline: "tests/pipelines/sunlit.ron", set: &set, scene: &yard, extent: EXTENT };
        let outputs = render(device, &setup)?;
        let extent = outputs[0].extent[0].cast_signed();
        let maps = floats(&outputs[0]);
        let views = (0..of).map(|index| {
            let logarithmic = Share::OF_CASCADES;
            let cascade = Cascade { list: DrawList::Opaque, index, of, reach: f32::try_into(reach).ok(), logarithmic };
            sun_view(&yard, &yard.camera, aspect, cascade, extent.cast_unsigned())
        });
        let views: Vec<_> = views.collect();
        let casters: Vec<_> = (0..i32::from(of))
            .map(|layer| {
                let maps = &maps;
                move |x: i32, y: i32| maps[((layer * extent + y) * extent + x) as usize]
            })
            .collect();
        let cascades: Vec<_> = views
            .iter()
            .zip(&casters)
            .map(|(view, caster)| sun_shadow::Cascade { world_to_clip: view.world_to_clip, texel: view.texel, caster })
            .collect();
        let to_sun = -Vec3::from(yard.sun.direction).as_dvec3();
        let shadows = Shadows { to_sun, reach: reach.into(), cascades: &cascades, extent: extent.into(), taps };
        let [places, normals] = [1, 2].map(|output| rgba(&outputs[output]));
        let (mut partly, mut drawn) = (0, 0);
        for (pixel, ([x, y, z, found], [nx, ny, nz, there])) in places.into_iter().zip(normals).enumerate() {
            if there == 0.0 {
                continue;
            }
            let (position, normal) = (DVec3::new(x, y, z), DVec3::new(nx, ny, nz));
            let [least, most] = [-1e-6, 1e-6].map(|about| shadows.sunlit(position, normal, DEPTH_ROUNDING + about));
            let asked = format!("{of} cascades, {taps} taps, to {reach} m, pixel {pixel}");
            assert!((least - 1e-3..=most + 1e-3).contains(&found), "{asked}: {found}, not {least} to {most}");
            drawn += 1;
            partly += usize::from(found > 0.01 && found < 0.99);
        }
        assert!(drawn > 4000 && partly > 50, "{of} cascades, {taps} taps: {drawn} pixels, {partly} in half-light");
    }
    Ok(())
}

/// NU-6: with as many cascades as a scene needs, rays find the shadows as right as with four, in as many pixels.
#[test]
fn as_many_cascades_as_a_scene_needs_draw_shadows_as_right_as_four_do() -> Result<(), Box<dyn Error>> {
    for (near, needed) in [(0.75, 2), (3.75, 1)] {
        let mut yard = yard();
        yard.camera.near = near;
        assert_eq!(yard.facts().shadow_cascades, u32::from(needed), "near {near}");
        let [few, four] = [needed, 4].map(|cascades| hold_against_rays(&yard, cascades, 3, 14.0));
        let [[lit, dark, _], [lit_by_four, dark_by_four, _]] = [few?, four?];
        assert!(lit > 1000 && dark > 50, "near {near}: {lit} lit, {dark} dark");
        let [lit_share, dark_share] =
            [(lit, lit_by_four), (dark, dark_by_four)].map(|(few, all)| few as f64 / all as f64);
        assert!(
            lit_share > 0.97 && dark_share > 0.9,
            "near {near}: {lit_share} of what is lit, {dark_share} of what is dark"
        );
    }
    Ok(())
}

#[test]
fn a_scene_whose_sun_casts_no_shadows_has_no_maps_and_all_of_its_light() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut yard = yard();
    yard.sun.shadows = false;
    let setup = |pipeline| Setup { pipeline, set: &[], scene: &yard, extent: EXTENT };
    let without = render(device, &setup("tests/pipelines/lit.ron"))?;
    let with = render(device, &setup("tests/pipelines/shadows.ron"))?;
    assert!(with[0].bytes == without[0].bytes, "what has no shadow is not drawn as without any");
    Ok(())
}

/// IQ-25: neither the size of the maps nor what is in them follows the picture's size.
#[test]
fn shadow_maps_are_the_same_at_every_render_scale() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let yard = yard();
    for cascades in ["1", "4"] {
        let [usual, half, twice] = ["1", "0.5", "2"].map(|scale| {
            let set = [("cascades", cascades), ("render_scale", scale)];
            render(
                device,
                &Setup { pipeline: "tests/pipelines/shadow_map.ron", set: &set, scene: &yard, extent: EXTENT },
            )
        });
        let (usual, [half, twice]) = (usual?, [half?, twice?]);
        assert_eq!([half[1].extent, twice[1].extent], [[60, 45, 1], [240, 180, 1]], "the picture's size follows");
        for other in [&half[0], &twice[0]] {
            assert_eq!((other.extent, other.layers.to_string()), ([MAP, MAP, 1], cascades.to_owned()));
            assert!(other.bytes == usual[0].bytes, "{cascades} cascades: another map");
        }
        let drawn = usual[0].bytes.iter().filter(|byte| **byte != 0).count();
        assert!(drawn > MAP as usize, "{cascades} cascades: something is in the map");
    }
    Ok(())
}
