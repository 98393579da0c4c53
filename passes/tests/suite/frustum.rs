//! Claims about which objects are left out because a camera can't see them, held against triangles that are clipped.

use framewright_passes::draw::frustum::in_sight;
use framewright_passes::scene::{Camera, Movement, Object, Scene, load};
use glam::{DVec3, EulerRot, Mat4, Quat, Vec3};
use std::path::Path;

/// The shipped scene's meshes and materials, without its objects.
fn empty() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes/spheres_and_cubes.ron");
    let mut scene = load(&path).expect("it is shipped");
    scene.objects.clear();
    scene
}

fn object(mesh: usize, transform: Mat4) -> Object {
    let transform = transform.as_dmat4();
    Object { name: String::new(), mesh, material: 0, transform, cross_fade: 1.0, movement: Movement::default() }
}

/// A camera at the origin that looks along −z, 90° from border to border.
fn ahead() -> Camera {
    Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, std::f32::consts::FRAC_PI_2, 0.1).expect("a direction")
}

fn seen(camera: &Camera, aspect: f64, transform: Mat4) -> bool {
    let scene = Scene { objects: vec![object(0, transform)], ..empty() };
    in_sight(&scene, camera, aspect)[0]
}

/// Numbers without rhyme or reason, from 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    fn between(&mut self, least: f32, most: f32) -> f32 {
        least + (most - least) * self.next()
    }

    fn vector(&mut self, reach: f32) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.between(-reach, reach)))
    }
}

/// Whether any triangle of an object shows in the picture: each is cut by the planes of what the camera sees, in its space.
fn shows(scene: &Scene, camera: &Camera, aspect: f64, object: &Object) -> bool {
    let mesh = &scene.meshes[object.mesh];
    let to_view = camera.transform.inverse() * object.transform;
    let tangent = (f64::from(camera.vertical_fov) * 0.5).tan();
    // Each is positive on the inner side: the four borders, the near and the far plane.
    let planes: [&dyn Fn(DVec3) -> f64; 6] = [
        &|at| -at.z * tangent * aspect - at.x,
        &|at| -at.z * tangent * aspect + at.x,
        &|at| -at.z * tangent - at.y,
        &|at| -at.z * tangent + at.y,
        &|at| -at.z - f64::from(camera.near),
        &|at| at.z + camera.far.map_or(f64::INFINITY, f64::from),
    ];
    mesh.indices.as_chunks::<3>().0.iter().any(|corners| {
        let corner = |index: u32| to_view.transform_point3(Vec3::from(mesh.positions[index as usize]).as_dvec3());
        let mut shape: Vec<DVec3> = corners.map(corner).to_vec();
        for inside in planes {
            let next = shape.iter().cycle().skip(1);
            shape = shape
                .iter()
                .zip(next)
                .flat_map(|(&from, &to)| {
                    let (here, there) = (inside(from), inside(to));
                    let kept = (here >= 0.0).then_some(from);
                    let crossing = ((here >= 0.0) != (there >= 0.0)).then(|| from.lerp(to, here / (here - there)));
                    kept.into_iter().chain(crossing)
                })
                .collect();
        }
        !shape.is_empty()
    })
}

#[test]
fn no_object_is_left_out_of_which_a_triangle_shows() {
    let mut random = Random(1);
    let (mut kept, mut culled, mut needless) = (0, 0, 0);
    for round in 0..60 {
        let mut scene = empty();
        let far = [0.0, 0.0, 1e3, 1e6][round % 4];
        let eye = Vec3::splat(far) + random.vector(8.0);
        let (target, near) = (eye.as_dvec3() + random.vector(1.0).as_dvec3(), random.between(0.01, 3.0));
        let fov = random.between(0.2, 2.8);
        let Some(camera) = Camera::look_at(eye.as_dvec3(), target, DVec3::Y, fov, near) else { continue };
        let camera = Camera { far: (round % 3 == 0).then(|| near + random.between(0.1, 30.0)), ..camera };
        for _ in 0..60 {
            // Mirrored, flattened, long and thin, huge: a scene may hold all of these.
            let mut scale = random.vector(1.0) * [0.1, 1.0, 20.0][(random.next() * 3.0) as usize % 3];
            if random.next() < 0.1 {
                scale.y = 0.0;
            }
            let turn = random.vector(3.0);
            let turn = Quat::from_euler(EulerRot::XYZ, turn.x, turn.y, turn.z);
            let transform = Mat4::from_scale_rotation_translation(scale, turn, Vec3::splat(far) + random.vector(25.0));
            let mesh = (random.next() * scene.meshes.len() as f32) as usize % scene.meshes.len();
            scene.objects.push(object(mesh, transform));
        }
        let aspect = f64::from(random.between(0.3, 3.0));
        let in_sight = in_sight(&scene, &camera, aspect);
        for (object, seen) in scene.objects.iter().zip(in_sight) {
            let shows = shows(&scene, &camera, aspect, object);
            assert!(seen || !shows, "round {round}: {object:?} shows from {camera:?}, and is left out");
            kept += u32::from(seen);
            culled += u32::from(!seen);
            needless += u32::from(seen && !shows);
        }
    }
    assert!(kept > 300 && culled > 1500, "{kept} kept, {culled} left out");
    assert!(needless * 3 < kept, "of {kept} objects {needless} are kept that don't show");
}

#[test]
fn what_lies_behind_or_beside_or_before_the_near_plane_is_left_out() {
    let camera = ahead();
    let at = |x: f32, y: f32, z: f32| Mat4::from_translation(Vec3::new(x, y, z));
    for transform in [
        at(0.0, 0.0, 9.0),
        at(9.0, 0.0, -4.0),
        at(-9.0, 0.0, -4.0),
        at(0.0, 9.0, -4.0),
        at(0.0, -9.0, -4.0),
        at(0.0, 0.0, -0.05) * Mat4::from_scale(Vec3::splat(0.01)),
    ] {
        assert!(!seen(&camera, 1.0, transform), "{transform}");
    }
    for transform in [at(0.0, 0.0, -4.0), at(0.0, 0.0, -1e8), at(0.0, 0.0, 0.0), at(4.3, 0.0, -4.0)] {
        assert!(seen(&camera, 1.0, transform), "{transform}");
    }
}

#[test]
fn a_wider_picture_shows_more_to_its_sides() {
    let aside = Mat4::from_translation(Vec3::new(7.0, 0.0, -4.0));
    assert!(!seen(&ahead(), 1.0, aside));
    assert!(seen(&ahead(), 2.0, aside));
}

#[test]
fn an_object_whose_corners_all_lie_outside_is_kept_where_it_reaches_across() {
    let wall = Mat4::from_translation(Vec3::NEG_Z * 4.0) * Mat4::from_scale(Vec3::new(1e3, 1e3, 0.1));
    assert!(seen(&ahead(), 1.0, wall));
    let around = Mat4::from_scale(Vec3::splat(-1e3));
    assert!(seen(&ahead(), 1.0, around));
}

#[test]
fn an_object_beside_a_border_is_kept_where_32_bits_may_bring_it_in() {
    let side = |x: f32| Mat4::from_translation(Vec3::new(x, 0.0, -4.0)) * Mat4::from_scale(Vec3::new(2.0, 2.0, 0.0));
    // From 4 m aside on, where the border is; by four roundings beyond it, and by many.
    assert!(seen(&ahead(), 1.0, side(5.000002)));
    assert!(!seen(&ahead(), 1.0, side(5.001)));
}
