//! The shapes that our own scene format knows, each of size 1: objects scale them.

use super::model::{Bounds, Mesh};
use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// A square from −0.5 to 0.5 in x and z that faces up; its texture's upper border is at the back (−z).
pub(crate) fn plane() -> Mesh {
    Mesh {
        positions: vec![[-0.5, 0.0, 0.5], [0.5, 0.0, 0.5], [0.5, 0.0, -0.5], [-0.5, 0.0, -0.5]],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
        bounds: Bounds { min: DVec3::new(-0.5, 0.0, -0.5), max: DVec3::new(0.5, 0.0, 0.5) },
    }
}

/// A cube of side 1; each face shows the whole texture, upright on the four sides.
pub(crate) fn cube() -> Mesh {
    // Each face: its normal, and what points right and up on it.
    let faces = [
        (Vec3::Z, Vec3::X, Vec3::Y),
        (Vec3::NEG_Z, Vec3::NEG_X, Vec3::Y),
        (Vec3::X, Vec3::NEG_Z, Vec3::Y),
        (Vec3::NEG_X, Vec3::Z, Vec3::Y),
        (Vec3::Y, Vec3::X, Vec3::NEG_Z),
        (Vec3::NEG_Y, Vec3::X, Vec3::Z),
    ];
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let each = || faces.iter().flat_map(|face| corners.iter().map(move |corner| (*face, *corner)));
    Mesh {
        positions: each().map(|((out, right, up), (x, y))| (out * 0.5 + right * x + up * y).to_array()).collect(),
        normals: each().map(|((out, ..), _)| out.to_array()).collect(),
        uvs: each().map(|(_, (x, y))| [x + 0.5, 0.5 - y]).collect(),
        indices: (0..6).flat_map(|face| [0, 1, 2, 0, 2, 3].map(|corner| 4 * face + corner)).collect(),
        bounds: Bounds { min: DVec3::splat(-0.5), max: DVec3::splat(0.5) },
    }
}

/// From pole to pole.
const RINGS: u32 = 24;
/// Around the axis.
const SECTORS: u32 = 48;

/// A sphere of diameter 1 with its poles on y; the texture runs once around it and once from the upper pole to the lower.
/// Its 2208 triangles stay within 0.3 % of the radius of the true sphere.
pub(crate) fn sphere() -> Mesh {
    let place = |ring: u32, sector: u32| {
        let (down, around) = (PI * f64::from(ring) / f64::from(RINGS), TAU * f64::from(sector) / f64::from(SECTORS));
        // Exactly the same where the ends of a ring meet.
        let around = if sector == SECTORS { 0.0 } else { around };
        let radius = if ring == RINGS { 0.0 } else { down.sin() };
        [(radius * around.sin()) as f32, down.cos() as f32, (radius * around.cos()) as f32]
    };
    let each = || (0..=RINGS).flat_map(|ring| (0..=SECTORS).map(move |sector| (ring, sector)));
    let at = |ring: u32, sector: u32| ring * (SECTORS + 1) + sector;
    let quads = (0..RINGS).flat_map(|ring| (0..SECTORS).map(move |sector| (ring, sector)));
    let triangles = quads.flat_map(|(ring, sector)| {
        let (upper, lower) =
            ([at(ring, sector), at(ring, sector + 1)], [at(ring + 1, sector), at(ring + 1, sector + 1)]);
        // At a pole one of the two has no area.
        let first = (ring + 1 < RINGS).then_some([upper[0], lower[0], lower[1]]);
        let second = (ring > 0).then_some([upper[0], lower[1], upper[1]]);
        first.into_iter().chain(second).flatten()
    });
    Mesh {
        positions: each().map(|(ring, sector)| place(ring, sector).map(|part| 0.5 * part)).collect(),
        normals: each().map(|(ring, sector)| place(ring, sector)).collect(),
        uvs: each().map(|(ring, sector)| [sector as f32 / SECTORS as f32, ring as f32 / RINGS as f32]).collect(),
        indices: triangles.collect(),
        bounds: Bounds { min: DVec3::splat(-0.5), max: DVec3::splat(0.5) },
    }
}
