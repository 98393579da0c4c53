//! CPU twins of the shaders' closed formulas, in 64-bit floating point: what the GPU is held against.

pub mod accumulate;
pub mod alpha_coverage;
pub mod ambient_occlusion;
pub mod bloom;
pub mod cross_fade;
pub mod depth_samples;
pub mod distance;
pub mod effects;
pub mod exposure;
pub mod filters;
pub mod fxaa;
pub mod g_buffer;
pub mod hdr10;
pub mod lighting;
pub mod motion;
pub mod overlay;
pub mod radiance;
pub mod random;
pub mod scale;
pub mod sky;
pub mod snow;
pub mod stereo;
pub mod sun_shadow;
pub mod temporal;
pub mod tone_mapping;
pub mod weighted_resolve;
