//! Twin of `shaders/include/random.glsl`.

/// An integer from an integer: "pcg" of M. Jarzynski, M. Olano, "Hash Functions for GPU Rendering", Journal of Computer
/// Graphics Techniques 9 (3), 2020.
#[must_use]
pub fn hash(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// 0 to 1, without 1.
#[must_use]
pub fn random(value: u32) -> f64 {
    f64::from(hash(value) >> 8) / 16_777_216.0
}
