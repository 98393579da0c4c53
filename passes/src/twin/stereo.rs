//! Twin of `shaders/include/stereo.glsl` and `shaders/include/part.glsl`: where an eye's picture lies in what is drawn into, or what a pass
//! sees of an image.

/// The part of an image that holds an eye's picture: its width and height as shares, and where it begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Width and height.
    pub scale: [f64; 2],
    /// The upper left corner.
    pub offset: [f64; 2],
}

impl Part {
    /// All of the image.
    pub const WHOLE: Part = Part { scale: [1.0; 2], offset: [0.0; 2] };

    /// The left or right half, of the left or right eye.
    #[must_use]
    pub fn half(right: bool) -> Part {
        Part { scale: [0.5, 1.0], offset: [if right { 0.5 } else { 0.0 }, 0.0] }
    }

    /// A place in the eye's picture, 0 to 1 from its upper left corner, as a place in the image.
    #[must_use]
    pub fn screen_uv(&self, uv: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.offset[axis] + self.scale[axis] * uv[axis])
    }

    /// A place in the image as a place in the part, 0 to 1 from its upper left corner.
    #[must_use]
    pub fn own_uv(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (place[axis] - self.offset[axis]) / self.scale[axis])
    }

    /// The place nearest to a place in the image whose linear filter, four texels of an image of `texels`, reaches no texel beyond the
    /// part along an axis that isn't seen whole; a 512th of a texel further in. The middle of a part that is narrower than that.
    #[must_use]
    pub fn nearest_within(&self, place: [f64; 2], texels: [u32; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let side = f64::from(texels[axis]);
            let [first, last] = [self.offset[axis], self.offset[axis] + self.scale[axis]].map(|border| border * side);
            let (first, last) = (first + 0.5 + 1.0 / 512.0, last - 0.5 - 1.0 / 512.0);
            match place[axis] * side {
                _ if self.scale[axis] == 1.0 => place[axis],
                _ if first >= last => (first + last) / 2.0 / side,
                at => at.clamp(first, last) / side,
            }
        })
    }

    /// Where a position in clip space is seen in the image, after the division by w.
    #[must_use]
    pub fn screen_pos(&self, [x, y, _, w]: [f64; 4]) -> [f64; 2] {
        self.screen_uv([x, y].map(|at| (at / w + 1.0) / 2.0))
    }
}
