//! Twin of `shaders/include/depth_samples.glsl`.
//!
//! The modes are those of `VkResolveModeFlagBits` (Vulkan 1.3, "Render Pass Resolve Operations").

/// The least number of all samples of a texel, with reversed depth the farthest; +∞ of none.
#[must_use]
pub fn least_depth(samples: &[f64]) -> f64 {
    samples.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The greatest number of all samples of a texel, with reversed depth the nearest; −∞ of none.
#[must_use]
pub fn greatest_depth(samples: &[f64]) -> f64 {
    samples.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// The mean of all samples of a texel; NaN of none.
#[must_use]
pub fn mean_depth(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len() as f64
}
