//! The rotation that a surface wants of its pictures.

use ash::vk;
use framewright_graph::vulkan::Rotation;

/// By how much a surface wants pictures to be turned, from the `currentTransform` of its capabilities: a swapchain that is made
/// with the same `preTransform` shows what is drawn so, without another turn by the compositor. `None` for the
/// transforms that mirror, and for `INHERIT`: draw upright, with `IDENTITY`, where the surface supports that.
///
/// Swapchain images of surfaces that want a quarter or three have the size of the turned picture;
/// [`Rotation::extent`] of it is the upright size, which frames are made for.
#[must_use]
pub fn rotation_of_surface(transform: vk::SurfaceTransformFlagsKHR) -> Option<Rotation> {
    match transform {
        vk::SurfaceTransformFlagsKHR::IDENTITY => Some(Rotation::Identity),
        vk::SurfaceTransformFlagsKHR::ROTATE_90 => Some(Rotation::Rotate90),
        vk::SurfaceTransformFlagsKHR::ROTATE_180 => Some(Rotation::Rotate180),
        vk::SurfaceTransformFlagsKHR::ROTATE_270 => Some(Rotation::Rotate270),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rotation_is_a_transform_and_no_mirroring_is_one() {
        let all = (0..9).map(|bit| rotation_of_surface(vk::SurfaceTransformFlagsKHR::from_raw(1 << bit)));
        let known: Vec<Rotation> = all.flatten().collect();
        assert_eq!(known, Rotation::ALL);
    }
}
