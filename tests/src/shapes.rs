//! Simple scenes.

use framewright_passes::scene::{AlphaMode, Bounds, Camera, Material, Mesh, Movement, Object, Scene, Sky, Sun};
use glam::{DMat4, DVec3, Mat4};

/// A scene without objects or light, for passes that look at none.
#[must_use]
pub fn empty_scene() -> Scene {
    let black = [0.0; 3];
    Scene {
        meshes: Vec::new(),
        materials: Vec::new(),
        textures: Vec::new(),
        objects: Vec::new(),
        sun: Sun { direction: [0.0, -1.0, 0.0], color: black, shadows: false },
        ambient: black,
        point_lights: Vec::new(),
        sky: Sky { zenith: black, horizon: black, ground: black },
        exposure: 1.0,
        camera: Camera::framing(Bounds { min: DVec3::ZERO, max: DVec3::ONE }),
        cameras: Vec::new(),
        notes: Vec::new(),
        mistakes: Vec::new(),
    }
}

/// An opaque, single-sided material without texture or light of its own.
#[must_use]
pub fn material(base_color: [f32; 4]) -> Material {
    Material {
        name: String::new(),
        base_color,
        base_color_texture: None,
        emissive: [0.0; 3],
        alpha: AlphaMode::Opaque,
        double_sided: false,
    }
}

fn mesh(positions: Vec<[f32; 3]>, normals: Vec<[f32; 3]>, uvs: Vec<[f32; 2]>, indices: Vec<u32>) -> Mesh {
    let bounds = Bounds::of(&positions).unwrap_or(Bounds { min: DVec3::ZERO, max: DVec3::ZERO });
    Mesh { normals, positions, uvs, indices, bounds }
}

/// A square from −1 to 1 in x and y that faces +z; (0, 0) of its texture is the upper left corner.
#[must_use]
pub fn square() -> Mesh {
    let positions = vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    mesh(
        positions,
        vec![[0.0, 0.0, 1.0]; 4],
        vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        vec![0, 1, 2, 0, 2, 3],
    )
}

/// A sphere of radius 1 in `rings` × 2 `rings` steps.
#[must_use]
pub fn sphere(rings: u32) -> Mesh {
    let columns = 2 * rings;
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for ring in 0..=rings {
        for column in 0..=columns {
            let latitude = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
            let longitude = std::f64::consts::TAU * f64::from(column) / f64::from(columns);
            let place = DVec3::new(latitude.sin() * longitude.sin(), latitude.cos(), latitude.sin() * longitude.cos());
            positions.push(place.as_vec3().to_array());
            if ring < rings && column < columns {
                let (here, below) = (ring * (columns + 1) + column, (ring + 1) * (columns + 1) + column);
                indices.extend([here, below, below + 1, here, below + 1, here + 1]);
            }
        }
    }
    let uvs = vec![[0.0; 2]; positions.len()];
    mesh(positions.clone(), positions, uvs, indices)
}

/// A scene of (mesh, material, transform) without light, seen from z = 5 towards −z with 60° from border to border.
#[must_use]
pub fn scene(meshes: Vec<Mesh>, materials: Vec<Material>, objects: Vec<(usize, usize, Mat4)>) -> Scene {
    let object = |(mesh, material, transform): (usize, usize, Mat4)| Object {
        name: String::new(),
        mesh,
        material,
        transform: transform.as_dmat4(),
        cross_fade: 1.0,
        movement: Movement::default(),
    };
    Scene {
        meshes,
        materials,
        objects: objects.into_iter().map(object).collect(),
        camera: Camera {
            transform: DMat4::from_translation(DVec3::new(0.0, 0.0, 5.0)),
            vertical_fov: std::f32::consts::FRAC_PI_3,
            near: 0.1,
            far: None,
            movement: Movement::default(),
        },
        ..empty_scene()
    }
}
