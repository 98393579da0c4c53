//! Bytes of uniform and storage blocks, laid out as GLSL's std140 and std430 lay out what the shipped shaders declare.

use glam::{Mat3, Mat4};

/// A block being written front to back.
#[derive(Debug, Default)]
pub(super) struct Block(Vec<u8>);

impl Block {
    pub(super) fn float(&mut self, value: f32) {
        self.0.extend(value.to_ne_bytes());
    }

    pub(super) fn uint(&mut self, value: u32) {
        self.0.extend(value.to_ne_bytes());
    }

    /// A `vec3`. A scalar that follows takes its last four bytes; any other member is aligned first.
    pub(super) fn vec3(&mut self, value: [f32; 3]) {
        self.align();
        value.into_iter().for_each(|component| self.float(component));
    }

    pub(super) fn vec4(&mut self, value: [f32; 4]) {
        self.align();
        value.into_iter().for_each(|component| self.float(component));
    }

    /// A `mat3`: three columns, each as long as a `vec4`.
    pub(super) fn mat3(&mut self, value: Mat3) {
        value.to_cols_array_2d().into_iter().for_each(|column| self.vec3(column));
        self.align();
    }

    /// A `mat4`, column by column.
    pub(super) fn mat4(&mut self, value: Mat4) {
        value.to_cols_array_2d().into_iter().for_each(|column| self.vec4(column));
    }

    /// Fills up to a multiple of 16 bytes: where vectors and structures begin.
    pub(super) fn align(&mut self) {
        self.0.resize(self.0.len().next_multiple_of(16), 0);
    }

    /// The bytes, filled up to a multiple of 16.
    pub(super) fn bytes(mut self) -> Vec<u8> {
        self.align();
        self.0
    }
}
