//! Rotation of texels: images hold rotated pictures, and what the host reads and writes is upright.

use framewright_graph::vulkan::Rotation;

/// The texels of the upright picture, layer after layer, from those of the turned one, which is `turned` wide and high. A texel
/// takes `texel_bytes` bytes.
pub(crate) fn upright(bytes: &[u8], turned: [u32; 2], texel_bytes: usize, rotation: Rotation) -> Vec<u8> {
    let extent = rotation.extent(turned);
    let mut all = Vec::with_capacity(bytes.len());
    for layer in layers(bytes, turned, texel_bytes) {
        for place in places(extent) {
            let from = index(turned, rotation.texel(extent, place)) * texel_bytes;
            all.extend_from_slice(&layer[from..from + texel_bytes]);
        }
    }
    all
}

/// The texels of the turned picture from those of the upright one, which is `extent` wide and high.
pub(crate) fn turned(bytes: &[u8], extent: [u32; 2], texel_bytes: usize, rotation: Rotation) -> Vec<u8> {
    let turned = rotation.extent(extent);
    let mut all = vec![0; bytes.len()];
    let into = all.chunks_exact_mut(index(extent, [0, extent[1]]).max(1) * texel_bytes.max(1));
    for (layer, into) in layers(bytes, extent, texel_bytes).zip(into) {
        for (texel, place) in layer.chunks_exact(texel_bytes.max(1)).zip(places(extent)) {
            let to = index(turned, rotation.texel(extent, place)) * texel_bytes;
            into[to..to + texel_bytes].copy_from_slice(texel);
        }
    }
    all
}

fn layers(bytes: &[u8], extent: [u32; 2], texel_bytes: usize) -> impl Iterator<Item = &[u8]> {
    bytes.chunks_exact((index(extent, [0, extent[1]]) * texel_bytes).max(1))
}

/// Every texel, row by row.
fn places([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

fn index([width, _]: [u32; 2], [x, y]: [u32; 2]) -> usize {
    y as usize * width as usize + x as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_is_turned_and_back_is_what_it_was_and_turns_clockwise() {
        // Two layers of 3 × 2 texels of 2 bytes.
        let picture: Vec<u8> = (0..24).collect();
        for rotation in Rotation::ALL {
            let there = turned(&picture, [3, 2], 2, rotation);
            assert_eq!(upright(&there, rotation.extent([3, 2]), 2, rotation), picture, "{rotation:?}");
        }
        let quarter = turned(&picture[..12], [3, 2], 2, Rotation::Rotate90);
        assert_eq!(quarter, [6, 7, 0, 1, 8, 9, 2, 3, 10, 11, 4, 5]);
    }
}
