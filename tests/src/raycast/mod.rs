//! A CPU ray-caster in 64 bits: which object a pixel shows, and its base colour.
//!
//! It judges what the GPU drew, so it shares no code with the drawing: rays come from the camera's place, axes and field of
//! view and not from a projection matrix, facing from the corners' order along the ray, texels from its own filter.

mod bounds;
pub mod texture;
pub mod triangle;

use bounds::BoundsTree;
use framewright_passes::scene::{AlphaMode, Scene};
use glam::{DVec2, DVec3};
use triangle::{Meeting, Ray, meet, meet_plane};

/// The first surface that a ray meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Index of the object in the scene.
    pub object: u32,
    /// Linear base colour with alpha: factor times texture.
    pub base_color: [f64; 4],
    /// Distance along the camera's axis, metres.
    pub depth: f64,
    /// Unit normal of the triangle, on the side that the ray comes from.
    pub normal: DVec3,
}

/// A scene made ready for rays.
#[derive(Debug)]
pub struct RayCaster<'scene> {
    scene: &'scene Scene,
    /// Their corners in world space.
    triangles: Vec<[DVec3; 3]>,
    /// Object of each triangle, and where its indices begin in the mesh.
    origins: Vec<(u32, usize)>,
    tree: BoundsTree,
}

impl<'scene> RayCaster<'scene> {
    /// Makes a scene ready.
    #[must_use]
    pub fn new(scene: &'scene Scene) -> Self {
        let (mut triangles, mut origins) = (Vec::new(), Vec::new());
        for (object_index, object) in (0..).zip(&scene.objects) {
            let mesh = &scene.meshes[object.mesh];
            let columns = object.transform.to_cols_array_2d();
            let place = |index: u32| {
                let [x, y, z] = mesh.positions[index as usize].map(f64::from);
                let axis =
                    |row: usize| columns[0][row] * x + columns[1][row] * y + columns[2][row] * z + columns[3][row];
                DVec3::new(axis(0), axis(1), axis(2))
            };
            for (first, corners) in mesh.indices.chunks_exact(3).enumerate() {
                triangles.push([place(corners[0]), place(corners[1]), place(corners[2])]);
                origins.push((object_index, first * 3));
            }
        }
        let tree = BoundsTree::new(&triangles);
        Self { scene, triangles, origins, tree }
    }

    /// The ray through a point of a picture, `at` counted in pixels from its upper left corner. The direction's part along
    /// the camera's axis is 1, so distances are depths.
    #[must_use]
    pub fn camera_ray(&self, at: DVec2, extent: [u32; 2]) -> Ray {
        let camera = &self.scene.camera;
        let columns = camera.transform.to_cols_array_2d().map(|[x, y, z, _]| DVec3::new(x, y, z));
        let [right, up, back, origin] = columns;
        let [width, height] = extent.map(f64::from);
        // Pixels are square.
        let pixel = 2.0 * (f64::from(camera.vertical_fov) / 2.0).tan() / height;
        let across = (at.x - width / 2.0) * pixel;
        let upwards = (height / 2.0 - at.y) * pixel;
        Ray { origin, direction: right * across + up * upwards - back, spread: [right * pixel, up * -pixel] }
    }

    /// The first surface that `ray` meets between the near and the far plane: front faces, back faces of double-sided
    /// materials, and no holes of masked ones. Transparent objects count as whole.
    #[must_use]
    pub fn cast(&self, ray: &Ray) -> Option<Hit> {
        let near = f64::from(self.scene.camera.near);
        let far = self.scene.camera.far.map_or(f64::INFINITY, f64::from);
        let mut nearest: Option<Hit> = None;
        self.tree.walk(ray, |triangle| {
            let limit = nearest.map_or(far, |hit| hit.depth);
            let meeting = meet(ray, &self.triangles[triangle as usize]);
            if let Some(meeting) = meeting.filter(|meeting| (near..limit).contains(&meeting.distance)) {
                nearest = self.shown(ray, triangle, &meeting).or(nearest);
            }
            nearest.map_or(far, |hit| hit.depth)
        });
        nearest
    }

    /// The colours of a triangle where it is met, unless that side or place of it shows nothing.
    fn shown(&self, ray: &Ray, triangle: u32, meeting: &Meeting) -> Option<Hit> {
        let (object_index, _) = self.origins[triangle as usize];
        let object = &self.scene.objects[object_index as usize];
        let material = &self.scene.materials[object.material];
        let [x, y, z, _] = object.transform.to_cols_array_2d().map(|[x, y, z, _]| DVec3::new(x, y, z));
        let turned_inside_out = x.dot(y.cross(z)) < 0.0;
        if !material.double_sided && meeting.counter_clockwise == turned_inside_out {
            return None;
        }
        let texel = material.base_color_texture.map_or([1.0; 4], |texture| {
            let texture = &self.scene.textures[texture];
            let size = DVec2::new(texture.width.into(), texture.height.into());
            let uv = |meeting: &Meeting| self.uv(triangle, meeting);
            let here = uv(meeting);
            let beside = ray.neighbours().map(|ray| meet_plane(&ray, &self.triangles[triangle as usize]));
            // The least of the lengths between which Vulkan lets a driver choose (section "Scale Factor Operation").
            let texels = |beside: &Meeting| ((uv(beside) - here) * size).abs().max_element();
            texture::sample(texture, here, beside.iter().flatten().map(texels).fold(0.0, f64::max))
        });
        let base_color = std::array::from_fn(|i| f64::from(material.base_color[i]) * texel[i]);
        match material.alpha {
            AlphaMode::Mask { cutoff } if base_color[3] < f64::from(cutoff) => None,
            _ => {
                let [a, b, c] = self.triangles[triangle as usize];
                let normal = (b - a).cross(c - a).normalize();
                let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
                Some(Hit { object: object_index, base_color, depth: meeting.distance, normal })
            }
        }
    }

    /// Texture coordinates where a triangle is met.
    fn uv(&self, triangle: u32, meeting: &Meeting) -> DVec2 {
        let (object, first) = self.origins[triangle as usize];
        let mesh = &self.scene.meshes[self.scene.objects[object as usize].mesh];
        let [second, third] = meeting.weights;
        let weights = [1.0 - second - third, second, third];
        weights.iter().zip(&mesh.indices[first..first + 3]).fold(DVec2::ZERO, |uv, (weight, index)| {
            let [u, v] = mesh.uvs[*index as usize];
            uv + DVec2::new(u.into(), v.into()) * *weight
        })
    }
}
