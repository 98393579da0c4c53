//! Colour spaces of FLIP: linear light with the primaries of Rec. 709, CIE XYZ under D65, YCxCz, and CIELAB with Hunt's effect.

/// CIE XYZ of the colours red, green and blue (columns), by the primaries of Rec. 709.
const XYZ_OF_RGB: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];
/// The inverse.
const RGB_OF_XYZ: [[f64; 3]; 3] = [
    [3.241_003_275, -1.537_398_934, -0.498_615_861],
    [-0.969_224_334, 1.875_930_071, 0.041_554_224],
    [0.055_639_423, -0.204_011_202, 1.057_148_933],
];
/// The white of D65 in XYZ.
const WHITE: [f64; 3] = [0.950_428_545, 1.0, 1.088_900_371];

/// YCxCz of linear light: CIELAB's axes without its cube roots, in which filters act as on light.
pub(super) fn ycxcz(rgb: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = xyz_of_white(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Linear light of YCxCz.
pub(super) fn rgb_of_ycxcz([y, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (y + 16.0) / 116.0;
    let xyz = [y + cx / 500.0, y, y - cz / 200.0];
    times(&RGB_OF_XYZ, [0, 1, 2].map(|at| xyz[at] * WHITE[at]))
}

/// CIELAB of linear light. Its chroma grows with lightness, as Hunt's effect has it.
pub(super) fn hunt_lab(rgb: [f64; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let root = |it: f64| match it > DELTA.powi(3) {
        true => it.cbrt(),
        false => it / (3.0 * DELTA * DELTA) + 4.0 / 29.0,
    };
    let [x, y, z] = xyz_of_white(rgb).map(root);
    let lightness = 116.0 * y - 16.0;
    let chroma = 0.01 * lightness;
    [lightness, 500.0 * (x - y) * chroma, 200.0 * (y - z) * chroma]
}

/// The distance of two colours in CIELAB for large differences: that of lightness and that of chroma are added.
pub(super) fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// Luminance of linear light, as Rec. 709 weights it.
pub(super) fn luminance([red, green, blue]: [f64; 3]) -> f64 {
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/// XYZ as shares of white.
fn xyz_of_white(rgb: [f64; 3]) -> [f64; 3] {
    let xyz = times(&XYZ_OF_RGB, rgb);
    [0, 1, 2].map(|at| xyz[at] / WHITE[at])
}

fn times(matrix: &[[f64; 3]; 3], by: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * by[0] + row[1] * by[1] + row[2] * by[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_light_without_chroma_and_ycxcz_comes_back() {
        let white = hunt_lab([1.0; 3]);
        assert!((white[0] - 100.0).abs() < 1e-6 && white[1].abs() < 1e-3 && white[2].abs() < 1e-3, "{white:?}");
        for rgb in [[0.0; 3], [1.0, 0.5, 0.25], [0.01, 0.9, 0.3]] {
            let back = rgb_of_ycxcz(ycxcz(rgb));
            assert!(rgb.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-6), "{rgb:?} {back:?}");
        }
    }
}
