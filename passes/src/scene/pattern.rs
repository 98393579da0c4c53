//! Textures that are computed: patterns of cells.

use super::model::{Sampler, Texture};

/// A pattern that fills a texture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pattern {
    pub(crate) kind: PatternKind,
    /// Cells across and down, each 1 to [`MOST_CELLS`].
    pub(crate) cells: [u32; 2],
}

/// The look of the cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PatternKind {
    /// Two colours by turns, sRGB bytes.
    Checker([[u8; 3]; 2]),
    /// White, with a round hole (alpha 0) of this radius in the middle of each cell; a cell is 1 wide.
    Dots(f64),
}

/// Cells along a side.
pub(crate) const MOST_CELLS: u32 = 32;

/// Texels along a side of a cell: enough for a round edge, and for edges of a checker that don't look blurred.
fn cell_texels(kind: PatternKind) -> u32 {
    match kind {
        PatternKind::Checker(_) => 32,
        PatternKind::Dots(_) => 64,
    }
}

impl Pattern {
    /// Bytes of its texture.
    pub(crate) fn bytes(self) -> u64 {
        let [width, height] = self.cells.map(|cells| u64::from(cells * cell_texels(self.kind)));
        4 * width * height
    }

    pub(crate) fn texture(self, name: String) -> Texture {
        let side = cell_texels(self.kind);
        let [width, height] = self.cells.map(|cells| cells * side);
        // Two cells each way repeat.
        let period = 2 * side;
        let row = |y| {
            let texels: Vec<u8> = (0..period).flat_map(|x| self.texel(x, y, side)).collect();
            repeated(&texels, 4 * width as usize)
        };
        let rows: Vec<Vec<u8>> = (0..period).map(row).collect();
        let rgba8 = repeated(&rows.concat(), 4 * width as usize * height as usize);
        Texture { name, width, height, rgba8: rgba8.into(), sampler: Sampler::default() }
    }

    fn texel(self, x: u32, y: u32, side: u32) -> [u8; 4] {
        match self.kind {
            PatternKind::Checker(colors) => {
                let [r, g, b] = colors[((x / side + y / side) % 2) as usize];
                [r, g, b, 255]
            }
            PatternKind::Dots(radius) => {
                // Alpha runs through 0.5 on the circle, over the width of a texel, so that a cut-off there is smooth.
                let from_middle = |at: u32| f64::from(at % side) + 0.5 - f64::from(side) * 0.5;
                let outside = from_middle(x).hypot(from_middle(y)) - radius * f64::from(side);
                [255, 255, 255, ((outside + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8]
            }
        }
    }
}

/// `bytes` again and again, `count` in all.
fn repeated(bytes: &[u8], count: usize) -> Vec<u8> {
    let mut all = bytes.repeat(count.div_ceil(bytes.len()));
    all.truncate(count);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_is_that_of_its_place() {
        for kind in [PatternKind::Checker([[1, 2, 3], [40, 50, 60]]), PatternKind::Dots(0.3)] {
            for cells in [[1, 1], [1, 4], [3, 2], [5, 3]] {
                let pattern = Pattern { kind, cells };
                let texture = pattern.texture(String::new());
                let side = cell_texels(kind);
                assert_eq!([texture.width, texture.height], cells.map(|cells| cells * side));
                for (at, texel) in (0..).zip(texture.rgba8.as_chunks::<4>().0) {
                    let (x, y) = (at % texture.width, at / texture.width);
                    assert_eq!(*texel, pattern.texel(x, y, side), "{pattern:?} at {x}, {y}");
                }
                assert_eq!(texture.rgba8.len() as u64, pattern.bytes());
            }
        }
    }
}
