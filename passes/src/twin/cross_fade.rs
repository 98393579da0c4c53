//! Twin of `shaders/include/cross_fade.glsl`. The pattern's source stands there.

/// From which share on a pixel is drawn, more than 0 and less than 1.
#[must_use]
pub fn fade_threshold([x, y]: [u32; 2]) -> f64 {
    // Rows and columns of the recursive definition: M(2n) = [4M, 4M + 2; 4M + 3, 4M + 1].
    let quarter = |bit: u32| match (x >> bit & 1, y >> bit & 1) {
        (0, 0) => 0,
        (1, 0) => 2,
        (0, _) => 3,
        (_, _) => 1,
    };
    (f64::from(16 * quarter(0) + 4 * quarter(1) + quarter(2)) + 0.5) / 64.0
}

/// Whether an object that is seen to this share (−1 to 1) leaves the pixel out.
#[must_use]
pub fn fades_out(share: f64, pixel: [u32; 2]) -> bool {
    let threshold = fade_threshold(pixel);
    if share < 0.0 { threshold < -share } else { threshold >= share }
}
