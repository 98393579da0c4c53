//! Objects: meshes with a material and a place.

use super::movement::Movement;
use glam::{DMat3, DMat4, Mat3};

/// A mesh with a material, somewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Name for people; need not be unique and may hold any character.
    pub name: String,
    /// Index into [`crate::scene::Scene::meshes`].
    pub mesh: usize,
    /// Index into [`crate::scene::Scene::materials`].
    pub material: usize,
    /// From the mesh's space to the world's; affine (its last row is 0 0 0 1).
    pub transform: DMat4,
    /// The share of its pixels that is drawn, −1 to 1, where 1 is all. At 0.3 three tenths are drawn, in a fixed pattern; at
    /// −0.3 exactly the others. So one object fades into another without a gap between them. Transparent objects fade by
    /// their opacity instead.
    pub cross_fade: f32,
    /// How it moves from where `transform` says that it is at frame 0.
    pub movement: Movement,
}

impl Object {
    /// Whether the transform turns the mesh inside out (an odd number of negative scales): its front faces are then
    /// clockwise.
    #[must_use]
    pub fn mirrored(&self) -> bool {
        DMat3::from_mat4(self.transform).determinant() < 0.0
    }

    /// Whether less than all of it is seen.
    #[must_use]
    pub fn fades(&self) -> bool {
        self.cross_fade < 1.0
    }

    /// The share of it that is seen, 0 to 1.
    #[must_use]
    pub fn shown_share(&self) -> f64 {
        let share = f64::from(self.cross_fade);
        if share < 0.0 { 1.0 + share } else { share }
    }

    /// Takes normals from the mesh's space to the world's, up to their length: the matrix of cofactors, which is the
    /// inverse transpose times the determinant, with the determinant's sign taken out so that normals of mirrored objects
    /// still point outwards. Unlike the inverse it exists for flattened objects (a scale of 0) too.
    #[must_use]
    pub fn normal_matrix(&self) -> Mat3 {
        let m = DMat3::from_mat4(self.transform);
        let cofactors = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
        let largest = cofactors.to_cols_array().iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let sign = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
        let scale = if largest > 0.0 { sign / largest } else { sign };
        (cofactors * scale).as_mat3()
    }

    /// Its place at a frame: [`Object::transform`] then.
    #[must_use]
    pub fn transform_at(&self, frame: u64) -> DMat4 {
        self.movement.at(frame, self.transform)
    }
}
