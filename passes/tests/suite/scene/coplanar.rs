//! Surfaces of the shipped scenes that lie in one plane would fight over which is in front: each driver and each way of drawing
//! would show other pixels.

use framewright_passes::scene::{Object, Scene, load};
use glam::{DVec2, DVec3};
use std::path::Path;

/// Surfaces that are this near to each other count as lying in one plane, metres.
const NEAR: f64 = 1e-3;

/// A triangle in the world.
type Triangle = [DVec3; 3];

fn normal([a, b, c]: Triangle) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// The triangles of an object that the scene's camera sees from their front, or from either side of what has two.
fn drawn(scene: &Scene, object: &Object) -> Vec<Triangle> {
    let (mesh, material) = (&scene.meshes[object.mesh], &scene.materials[object.material]);
    let to_world = object.transform;
    let corner = |index: &u32| to_world.transform_point3(DVec3::from(mesh.positions[*index as usize].map(f64::from)));
    let triangles = mesh.indices.as_chunks::<3>().0.iter().map(|[a, b, c]| [corner(a), corner(b), corner(c)]);
    let eye = scene.camera.transform.w_axis.truncate();
    let front = if object.mirrored() { -1.0 } else { 1.0 };
    let is_seen = |triangle: &Triangle| material.double_sided || front * normal(*triangle).dot(eye - triangle[0]) > 0.0;
    triangles.filter(is_seen).collect()
}

/// Whether two triangles that lie in one plane overlap: no side of either parts them.
fn overlap(one: Triangle, other: Triangle) -> bool {
    let axis = normal(one);
    let across = axis.any_orthonormal_vector();
    let flat = |triangle: Triangle| triangle.map(|at| DVec2::new(at.dot(across), at.dot(axis.cross(across))));
    let [one, other] = [one, other].map(flat);
    let parts = |sides: [DVec2; 3]| {
        (0..3).any(|at| {
            let beside = (sides[(at + 1) % 3] - sides[at]).perp().normalize_or_zero();
            let span = |of: [DVec2; 3]| {
                let along = of.map(|corner| corner.dot(beside));
                [along.into_iter().fold(f64::MAX, f64::min), along.into_iter().fold(f64::MIN, f64::max)]
            };
            let ([least, most], [from, to]) = (span(one), span(other));
            most < from + NEAR || to < least + NEAR
        })
    };
    !parts(one) && !parts(other)
}

/// Whether a triangle lies in the plane of another, and over it.
fn fight(one: Triangle, other: Triangle) -> bool {
    let up = normal(one);
    other.iter().all(|corner| (*corner - one[0]).dot(up).abs() < NEAR) && overlap(one, other)
}

/// The pairs of objects of which surfaces fight, by name.
fn fighting(scene: &Scene) -> Vec<String> {
    let drawn: Vec<Vec<Triangle>> = scene.objects.iter().map(|object| drawn(scene, object)).collect();
    let bounds = |at: usize| scene.meshes[scene.objects[at].mesh].bounds.transformed(scene.objects[at].transform);
    let apart = |one: usize, other: usize| {
        let (one, other) = (bounds(one), bounds(other));
        (0..3).any(|axis| one.max[axis] < other.min[axis] - 0.1 || other.max[axis] < one.min[axis] - 0.1)
    };
    let pairs = (0..drawn.len()).flat_map(|one| (0..one).map(move |other| (one, other)));
    let pairs = pairs.filter(|(one, other)| !apart(*one, *other));
    let fight = |(one, other): &(usize, usize)| {
        drawn[*one].iter().any(|triangle| drawn[*other].iter().any(|other| fight(*triangle, *other)))
    };
    let names = |(one, other)| [one, other].map(|at: usize| &*scene.objects[at].name).join(" and ");
    pairs.filter(fight).map(names).collect()
}

#[test]
fn no_surface_of_a_shipped_scene_lies_in_the_plane_of_another() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes");
    for file in std::fs::read_dir(folder).expect("scenes are shipped") {
        let path = file.expect("the folder can be listed").path();
        let scene = load(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(fighting(&scene), Vec::<String>::new(), "{}", path.display());
    }
}
