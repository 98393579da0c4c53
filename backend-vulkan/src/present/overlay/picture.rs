//! The picture of an overlay, and where it lies in the images of a window.

use crate::base::Error;
use crate::commands::rotate_texels;
use framewright_graph::vulkan::Rotation;
use std::borrow::Cow;

/// Bytes of a texel.
const TEXEL: usize = 4;

/// A picture that is laid over what a window shows, as a list of settings or times. It is no part of the frame. Where the surface wants
/// its pictures turned, it is turned like them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Overlay<'p> {
    /// Width and height in texels, which cover as many pixels of the window.
    pub extent: [u32; 2],
    /// The left and upper edge in the upright picture of the window, in pixels. What lies outside of the window isn't seen.
    pub offset: [i32; 2],
    /// Row by row, without gaps, four bytes for a texel: red, green and blue in the curve of sRGB, not multiplied by alpha, and alpha.
    /// In windows of an sRGB format light is blended; in others, the values as they are.
    pub texels: &'p [u8],
}

/// The picture of an overlay, kept.
pub(super) struct OverlayPicture {
    extent: [u32; 2],
    offset: [i32; 2],
    texels: Vec<u8>,
}

/// Where an overlay lies in an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Left and upper edge, width and height of all of it.
    pub(super) viewport: [f32; 4],
    /// The same of the part that can be seen.
    pub(super) scissor: [u32; 4],
}

impl Overlay<'_> {
    /// Whether it can be drawn by a device whose images are at most `largest` texels wide and high.
    ///
    /// # Errors
    /// [`Error::BadResource`] if it can't.
    pub(super) fn check(&self, largest: u32) -> Result<(), Error> {
        let [width, height] = self.extent;
        let bad = |what: String| Error::BadResource { what: format!("overlay of {width} × {height}: {what}") };
        if width == 0 || height == 0 || width > largest || height > largest {
            return Err(bad(format!("both must be from 1 to {largest} on this device")));
        }
        let (given, needed) = (self.texels.len() as u64, u64::from(width) * u64::from(height) * TEXEL as u64);
        if given != needed {
            return Err(bad(format!("{given} bytes were given, {needed} are needed")));
        }
        Ok(())
    }
}

impl OverlayPicture {
    pub(super) fn new(overlay: &Overlay<'_>) -> OverlayPicture {
        let Overlay { extent, offset, texels } = *overlay;
        OverlayPicture { extent, offset, texels: texels.to_vec() }
    }

    /// Becomes another overlay. Returns whether the texels are others.
    pub(super) fn change(&mut self, overlay: &Overlay<'_>) -> bool {
        let Overlay { extent, offset, texels } = *overlay;
        self.offset = offset;
        if self.extent == extent && self.texels == texels {
            return false;
        }
        self.extent = extent;
        self.texels.clear();
        self.texels.extend_from_slice(texels);
        true
    }

    /// Width and height of the turned picture.
    pub(super) fn extent(&self, rotation: Rotation) -> [u32; 2] {
        rotation.extent(self.extent)
    }

    /// The texels of the turned picture.
    pub(super) fn texels(&self, rotation: Rotation) -> Cow<'_, [u8]> {
        match rotation.turns() {
            true => rotate_texels::turned(&self.texels, self.extent, TEXEL, rotation).into(),
            false => Cow::Borrowed(&self.texels),
        }
    }

    /// Where it lies in images that are `image` large and hold pictures that are turned so. `None` if nothing of it can be seen.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole numbers within limits of devices"
    )]
    pub(super) fn place(&self, image: [u32; 2], rotation: Rotation) -> Option<Place> {
        let ([x, y], [width, height]) = (self.offset.map(f64::from), self.extent.map(f64::from));
        let upright = rotation.extent(image).map(f64::from);
        let turned = rotation.rectangle(upright, [x, y, width, height]);
        let edge = |side: usize, at: f64| at.clamp(0.0, f64::from(image[side])) as u32;
        let [left, top] = [0, 1].map(|side| edge(side, turned[side]));
        let [right, bottom] = [0, 1].map(|side| edge(side, turned[side] + turned[side + 2]));
        (left < right && top < bottom).then(|| Place {
            viewport: turned.map(|side| side as f32),
            scissor: [left, top, right - left, bottom - top],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(offset: [i32; 2]) -> OverlayPicture {
        let texels: Vec<u8> = (1..=3 * 2 * 4).collect();
        OverlayPicture::new(&Overlay { extent: [3, 2], offset, texels: &texels })
    }

    /// The texels of an image of this size with the overlay in it; 0 where there is none.
    fn laid(overlay: &OverlayPicture, [width, height]: [u32; 2], rotation: Rotation) -> Vec<u8> {
        let (texels, [across, _]) = (overlay.texels(rotation), overlay.extent(rotation));
        let Some(Place { viewport, scissor }) = overlay.place([width, height], rotation) else { return Vec::new() };
        let mut image = vec![0; (width * height) as usize];
        for y in scissor[1]..scissor[1] + scissor[3] {
            for x in scissor[0]..scissor[0] + scissor[2] {
                let [from_x, from_y] = [x as f32 - viewport[0], y as f32 - viewport[1]].map(|at| at as usize);
                image[(y * width + x) as usize] = texels[(from_y * across as usize + from_x) * TEXEL];
            }
        }
        image
    }

    #[test]
    fn an_overlay_is_turned_as_the_picture_below_is() {
        for offset in [[0, 0], [1, 2], [4, 3], [-1, -1], [3, 3]] {
            let overlay = picture(offset);
            let upright = laid(&overlay, [5, 4], Rotation::Identity);
            assert!(upright.iter().any(|texel| *texel != 0), "{offset:?}");
            for rotation in Rotation::ALL {
                let turned = rotate_texels::turned(&upright, [5, 4], 1, rotation);
                assert_eq!(laid(&overlay, rotation.extent([5, 4]), rotation), turned, "{offset:?} {rotation:?}");
            }
        }
    }

    #[test]
    fn what_lies_outside_of_the_window_has_no_place() {
        for offset in [[5, 0], [0, 4], [-3, 0], [0, -2], [i32::MIN, i32::MAX]] {
            assert_eq!(picture(offset).place([5, 4], Rotation::Identity), None, "{offset:?}");
        }
        let place = picture([-2, 3]).place([5, 4], Rotation::Identity);
        assert_eq!(place, Some(Place { viewport: [-2.0, 3.0, 3.0, 2.0], scissor: [0, 3, 1, 1] }));
    }

    #[test]
    fn only_other_texels_are_sent_again() {
        let mut overlay = picture([0, 0]);
        let texels: Vec<u8> = (1..=3 * 2 * 4).collect();
        assert!(!overlay.change(&Overlay { extent: [3, 2], offset: [7, 7], texels: &texels }));
        assert_eq!(overlay.offset, [7, 7]);
        assert!(overlay.change(&Overlay { extent: [2, 3], offset: [7, 7], texels: &texels }));
        assert!(overlay.change(&Overlay { extent: [2, 3], offset: [7, 7], texels: &[9; 24] }));
        assert_eq!(overlay.texels(Rotation::Identity)[..], [9; 24]);
    }
}
