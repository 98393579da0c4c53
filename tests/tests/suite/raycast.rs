//! Claims about the ray-caster itself, held against shapes with closed formulas.

use framewright_graph::vulkan::Filter;
use framewright_passes::scene::{AlphaMode, Sampler, Scene, Texture, Wrap};
use framewright_tests::raycast::{Hit, RayCaster, texture};
use framewright_tests::shapes::{material, scene, sphere, square};
use glam::{DVec2, DVec3, Mat4, Vec3};

fn cast(scene: &Scene, x: f64, y: f64) -> Option<Hit> {
    let caster = RayCaster::new(scene);
    caster.cast(&caster.camera_ray(DVec2::new(x, y) * 1000.0, [1000, 1000]))
}

/// Distance along a ray of `direction` from `origin` to a sphere.
fn analytic_sphere(origin: DVec3, direction: DVec3, centre: DVec3, radius: f64) -> Option<f64> {
    let offset = origin - centre;
    let (a, b) = (direction.length_squared(), offset.dot(direction));
    let discriminant = b * b - a * (offset.length_squared() - radius * radius);
    (discriminant >= 0.0).then(|| (-b - discriminant.sqrt()) / a)
}

#[test]
fn it_sees_spheres_where_their_formula_says() {
    let balls =
        [(DVec3::new(-0.8, 0.3, 0.0), 1.0), (DVec3::new(0.9, -0.2, -2.0), 1.5), (DVec3::new(0.2, 0.9, 2.0), 0.4)];
    let place = |(at, radius): (DVec3, f64)| {
        Mat4::from_translation(at.as_vec3()) * Mat4::from_scale(Vec3::splat(radius as f32))
    };
    let objects = balls.into_iter().map(|ball| (0, 0, place(ball))).collect();
    let scene = scene(vec![sphere(64)], vec![material([1.0; 4])], objects);
    let caster = RayCaster::new(&scene);
    let (mut wrong, side) = (0, 80);
    for pixel in 0..side * side {
        let at = DVec2::new(f64::from(pixel % side) + 0.5, f64::from(pixel / side) + 0.5);
        let ray = caster.camera_ray(at, [side, side]);
        let formula = (0_u32..)
            .zip(balls)
            .filter_map(|(index, (centre, radius))| {
                Some((index, analytic_sphere(ray.origin, ray.direction, centre, radius)?))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1));
        match (caster.cast(&ray), formula) {
            (None, None) => {}
            (Some(hit), Some((object, depth))) if hit.object == object => {
                assert!((hit.depth - depth).abs() < 0.05, "depth {} instead of {depth} at {at}", hit.depth);
            }
            _ => wrong += 1,
        }
    }
    // The triangles lie within the sphere by at most 0.12 % of its radius: only the very border may differ.
    assert!(wrong <= 12, "{wrong} of {} pixels differ", side * side);
}

#[test]
fn the_picture_is_upright() {
    let materials = vec![material([1.0, 0.0, 0.0, 1.0]), material([0.0, 1.0, 0.0, 1.0])];
    let upper_right = Mat4::from_translation(Vec3::new(1.2, 1.2, 0.0));
    let lower_left = Mat4::from_translation(Vec3::new(-1.2, -1.2, 0.0));
    let scene = scene(vec![square()], materials, vec![(0, 0, upper_right), (0, 1, lower_left)]);
    assert_eq!(cast(&scene, 0.7, 0.3).map(|hit| hit.base_color), Some([1.0, 0.0, 0.0, 1.0]));
    assert_eq!(cast(&scene, 0.3, 0.7).map(|hit| hit.base_color), Some([0.0, 1.0, 0.0, 1.0]));
    assert_eq!(cast(&scene, 0.3, 0.3), None);
}

#[test]
fn back_faces_are_seen_only_of_double_sided_materials() {
    let turned = Mat4::from_rotation_y(std::f32::consts::PI);
    let mut scene = scene(vec![square()], vec![material([1.0; 4])], vec![(0, 0, turned)]);
    assert_eq!(cast(&scene, 0.5, 0.5), None);
    scene.materials[0].double_sided = true;
    assert!(cast(&scene, 0.5, 0.5).is_some());
}

#[test]
fn a_mirrored_object_still_shows_its_front() {
    let mirrored = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let scene = scene(vec![square()], vec![material([1.0; 4])], vec![(0, 0, mirrored)]);
    assert!(cast(&scene, 0.4, 0.5).is_some());
}

#[test]
fn nothing_before_the_near_plane_is_seen() {
    let objects = vec![(0, 0, Mat4::IDENTITY), (0, 0, Mat4::from_translation(Vec3::new(0.0, 0.0, 4.95)))];
    let mut scene = scene(vec![square()], vec![material([1.0; 4])], objects);
    assert_eq!(cast(&scene, 0.5, 0.4).map(|hit| hit.object), Some(0));
    scene.camera.near = 0.01;
    assert_eq!(cast(&scene, 0.5, 0.4).map(|hit| hit.object), Some(1));
}

#[test]
fn holes_of_masked_materials_let_the_ray_through() {
    let mut masked = material([1.0, 1.0, 1.0, 0.8]);
    masked.alpha = AlphaMode::Mask { cutoff: 0.5 };
    masked.base_color_texture = Some(0);
    let behind = Mat4::from_translation(Vec3::new(0.0, 0.0, -1.0));
    let mut scene =
        scene(vec![square()], vec![masked, material([1.0; 4])], vec![(0, 0, Mat4::IDENTITY), (0, 1, behind)]);
    // The left half is whole, the right half has the alpha 0.5 · 0.8, below the cut-off.
    scene.textures.push(two_texels([255, 255, 255, 255], [255, 255, 255, 128]));
    assert_eq!(cast(&scene, 0.45, 0.5).map(|hit| hit.object), Some(0));
    assert_eq!(cast(&scene, 0.55, 0.5).map(|hit| hit.object), Some(1));
}

fn two_texels(left: [u8; 4], right: [u8; 4]) -> Texture {
    let sampler = Sampler {
        wrap_u: Wrap::ClampToEdge,
        wrap_v: Wrap::ClampToEdge,
        magnify: Filter::Nearest,
        minify: Filter::Nearest,
        mip: None,
    };
    Texture { name: String::new(), width: 2, height: 1, rgba8: [left, right].concat().into(), sampler }
}

#[test]
fn texels_are_linear_and_mix_linearly() {
    let mut texture = two_texels([0, 0, 0, 0], [255, 188, 0, 255]);
    assert_eq!(texture::sample(&texture, DVec2::new(0.49, 0.5), 0.0), [0.0; 4]);
    texture.sampler.magnify = Filter::Linear;
    let [red, green, blue, alpha] = texture::sample(&texture, DVec2::new(0.5, 0.5), 0.0);
    assert_eq!([red, blue, alpha], [0.5, 0.0, 0.5]);
    assert!((green - 0.25).abs() < 0.002, "188 is about one half in linear light, but half of it gave {green}");
}

#[test]
fn textures_go_on_beyond_their_borders_as_they_say() {
    let mut texture = two_texels([255, 0, 0, 255], [0, 255, 0, 255]);
    let (left, right) = ([1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]);
    for (wrap, expected) in [
        (Wrap::Repeat, [right, right, left, right]),
        (Wrap::MirroredRepeat, [left, right, right, left]),
        (Wrap::ClampToEdge, [left, right, right, right]),
    ] {
        texture.sampler.wrap_u = wrap;
        let seen = [-0.25, 0.75, 1.25, 1.75].map(|u| texture::sample(&texture, DVec2::new(u, 0.5), 0.0));
        assert_eq!(seen, expected, "{wrap:?}");
    }
}

#[test]
fn encoding_undoes_decoding() {
    for byte in 0..=255 {
        let encoded = f64::from(byte) / 255.0;
        assert!((texture::encode(texture::decode(encoded)) - encoded).abs() < 1e-6);
    }
}

#[test]
fn a_texture_shown_reduced_is_averaged() {
    let mut texture = two_texels([255, 0, 0, 255], [0, 255, 0, 255]);
    texture.sampler = Sampler::default();
    for u in [0.0, 0.3, 0.5] {
        let [red, green, ..] = texture::sample(&texture, DVec2::new(u, 0.5), 8.0);
        assert!((red - 0.5).abs() < 0.02 && (green - 0.5).abs() < 0.02, "{red}, {green}");
    }
}
