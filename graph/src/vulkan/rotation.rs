//! Rotation: by how much a picture is turned before it is shown.

use serde::{Deserialize, Serialize};

/// By how much a picture is turned, clockwise as `VkSurfaceTransformFlagBitsKHR` has it: turned by 90 degrees, its upper left
/// corner lies on the upper right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub enum Rotation {
    /// Not at all.
    #[default]
    #[serde(rename = "IDENTITY")]
    Identity,
    /// A quarter.
    #[serde(rename = "ROTATE_90")]
    Rotate90,
    /// A half.
    #[serde(rename = "ROTATE_180")]
    Rotate180,
    /// Three quarters.
    #[serde(rename = "ROTATE_270")]
    Rotate270,
}

impl Rotation {
    /// All, by rising angle.
    pub const ALL: [Rotation; 4] = [Rotation::Identity, Rotation::Rotate90, Rotation::Rotate180, Rotation::Rotate270];

    /// The rotation by `degrees`; `None` if that isn't 0, 90, 180 or 270.
    #[must_use]
    pub fn from_degrees(degrees: u32) -> Option<Rotation> {
        Rotation::ALL.into_iter().find(|rotation| rotation.degrees() == degrees)
    }

    /// The angle: 0, 90, 180 or 270.
    #[must_use]
    pub fn degrees(self) -> u32 {
        90 * self.quarters()
    }

    /// How many quarters it turns, 0 to 3: the number that shaders know it by.
    #[must_use]
    pub fn quarters(self) -> u32 {
        match self {
            Rotation::Identity => 0,
            Rotation::Rotate90 => 1,
            Rotation::Rotate180 => 2,
            Rotation::Rotate270 => 3,
        }
    }

    /// Whether it turns at all.
    #[must_use]
    pub fn turns(self) -> bool {
        self != Rotation::Identity
    }

    /// Width and height of a picture once it is turned; also of the upright one, from those of the turned one.
    #[must_use]
    pub fn extent(self, [width, height]: [u32; 2]) -> [u32; 2] {
        match self {
            Rotation::Identity | Rotation::Rotate180 => [width, height],
            Rotation::Rotate90 | Rotation::Rotate270 => [height, width],
        }
    }

    /// Where a rectangle of the upright picture, which is `extent` large, lies in the turned one. Left and upper edge, then
    /// width and height, all in texels; edges may lie outside.
    #[must_use]
    pub fn rectangle(self, extent: [f64; 2], [x, y, width, height]: [f64; 4]) -> [f64; 4] {
        let (right, below) = (extent[0] - x - width, extent[1] - y - height);
        match self {
            Rotation::Identity => [x, y, width, height],
            Rotation::Rotate90 => [below, x, height, width],
            Rotation::Rotate180 => [right, below, width, height],
            Rotation::Rotate270 => [y, right, height, width],
        }
    }

    /// Where a texel of the upright picture, which is `extent` large, lies in the turned one.
    #[must_use]
    pub fn texel(self, [width, height]: [u32; 2], [x, y]: [u32; 2]) -> [u32; 2] {
        let (right, below) = (width.saturating_sub(x + 1), height.saturating_sub(y + 1));
        match self {
            Rotation::Identity => [x, y],
            Rotation::Rotate90 => [below, x],
            Rotation::Rotate180 => [right, below],
            Rotation::Rotate270 => [y, right],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As `VkSurfaceTransformFlagBitsKHR` says: clockwise.
    #[test]
    fn the_upper_left_corner_goes_clockwise_around_the_picture() {
        let corners = Rotation::ALL.map(|rotation| rotation.texel([3, 2], [0, 0]));
        assert_eq!(corners, [[0, 0], [1, 0], [2, 1], [0, 2]]);
        for rotation in Rotation::ALL {
            assert_eq!(Rotation::from_degrees(rotation.degrees()), Some(rotation));
            assert_eq!(rotation.extent(rotation.extent([3, 2])), [3, 2]);
        }
        assert_eq!(Rotation::from_degrees(45), None);
    }

    #[test]
    fn a_rectangle_covers_the_texels_that_it_covered() {
        for rotation in Rotation::ALL {
            let [x, y, width, height] = rotation.rectangle([7.0, 5.0], [1.0, 2.0, 3.0, 2.0]);
            let mut inside = Vec::new();
            for (column, row) in (0..5_u32).flat_map(|row| (0..7_u32).map(move |column| (column, row))) {
                let [tx, ty] = rotation.texel([7, 5], [column, row]).map(f64::from);
                if tx >= x && tx < x + width && ty >= y && ty < y + height {
                    inside.push((column, row));
                }
            }
            assert_eq!(inside, [(1, 2), (2, 2), (3, 2), (1, 3), (2, 3), (3, 3)], "{rotation:?}");
        }
    }
}
