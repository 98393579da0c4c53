//! Passes of a frame, and their work.

use super::{BufferUse, ColorTarget, DepthTarget, ImageIndex, ParamValue, Sampled, Storage, TransferUse, ViewIndex};
use crate::base::Span;
use crate::vulkan::{FillValue, Filter};
use serde::{Deserialize, Serialize};
use std::num::NonZero;
use std::sync::Arc;

#[cfg(doc)]
use super::BufferRole;

/// One pass.
#[derive(Debug, Clone, PartialEq)]
pub struct Pass {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// The view that it draws for.
    pub view: ViewIndex,
    /// The work of the pass.
    pub work: Work,
    /// Images that its shaders sample.
    pub sampled: Vec<Sampled>,
    /// Images that its shaders write (and perhaps read) without attachments.
    pub storage: Vec<Storage>,
    /// Colour attachments by location.
    pub color: Vec<ColorTarget>,
    /// Depth (and stencil) attachment.
    pub depth: Option<DepthTarget>,
    /// Whether the alpha of the first colour says how many samples are covered, where the targets have several.
    pub alpha_to_coverage: bool,
    /// Whether the file promises that it sets every texel of its targets; blending and tests need what is there all the same.
    pub covers: bool,
    /// Why it may leave texels of its targets as they were although it fills the screen, in words; `None`: it sets them all, or it
    /// doesn't fill the screen. If there are any words, a draw doesn't cover.
    pub untouched: Option<Arc<str>>,
    /// Why its shader can't draw its depth alone, for images of fewer samples, if it can't.
    pub no_depth_only: Option<Arc<str>>,
    /// Why its shader can't draw into an image that is turned, if it can't, behind the name of the pass.
    pub no_rotation: Option<Arc<str>>,
    /// Why the compiler inserted it; in frames that it is given, nothing is.
    pub inserted: Option<Arc<str>>,
    /// Buffers that it reads or writes by anything but a copy or fill.
    pub buffers: Vec<BufferUse>,
    /// Images and buffers that a copy, blit, fill or custom pass reads and writes by transfer: source before target.
    pub transfers: Vec<TransferUse>,
    /// Whether it has an effect that no image or buffer shows: it is never culled.
    pub side_effect: bool,
    /// Values for the shader's parameter block, by member name.
    pub params: Vec<(Arc<str>, ParamValue)>,
}

impl Pass {
    /// A pass that accesses nothing yet, and that no file declares.
    #[must_use]
    pub fn new(name: &str, work: Work) -> Pass {
        Pass {
            name: name.into(),
            span: Span::NONE,
            view: ViewIndex::default(),
            work,
            sampled: Vec::new(),
            storage: Vec::new(),
            color: Vec::new(),
            depth: None,
            alpha_to_coverage: false,
            covers: false,
            untouched: None,
            no_depth_only: None,
            no_rotation: None,
            inserted: None,
            buffers: Vec::new(),
            transfers: Vec::new(),
            side_effect: false,
            params: Vec::new(),
        }
    }
}

/// The work of a pass.
#[derive(Debug, Clone, PartialEq)]
pub enum Work {
    /// Draws into its attachments.
    Draw {
        /// The geometry.
        draw: Draw,
        /// The shader's name.
        shader: Arc<str>,
        /// Whether its fragment shader leaves samples out, as it does where it discards fragments: then a full-screen draw doesn't
        /// cover.
        discards: bool,
        /// Whether it tells the samples of a texel apart, as a fragment shader does that runs once a sample.
        per_sample: bool,
    },
    /// Runs compute shaders.
    Dispatch {
        /// The shader's name.
        shader: Arc<str>,
        /// How many workgroups.
        groups: Groups,
    },
    /// Copies its first transfer into its second: texel for texel, byte for byte, or rows of texels to or from a buffer.
    Copy,
    /// Scales its first transfer into its second.
    Blit {
        /// Filter between texels.
        filter: Filter,
    },
    /// Sets all of its one transfer to a value.
    Fill {
        /// The value.
        value: FillValue,
    },
    /// The embedding program records it outside of rendering scopes.
    Custom {
        /// The name by which the program knows it.
        callback: Arc<str>,
    },
    /// Stands in for a pass that is off: `to` takes the contents of `from`.
    Forward {
        /// Source.
        from: ImageIndex,
        /// Target.
        to: ImageIndex,
        /// The condition that switched the pass off: "tone_mapping = false".
        because: String,
    },
}

/// How many workgroups a dispatch has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Groups {
    /// This many workgroups in x, y and z.
    Count([u32; 3]),
    /// Enough workgroups for this many invocations in x, y and z: divided by the shader's own workgroup size, rounded up.
    Invocations([u32; 3]),
    /// As many as its buffer of the role [`BufferRole::Indirect`] says, a `VkDispatchIndirectCommand` at this byte.
    Indirect {
        /// Byte offset, a multiple of 4.
        offset: u64,
    },
}

/// The geometry of a raster pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Draw {
    /// One of the scene's draw lists.
    Objects(DrawList),
    /// Objects that cast the sun's shadow, as the sun sees them.
    Casters(Cascade),
    /// The sky, behind everything.
    Sky,
    /// One triangle that covers every pixel, unless the shader has a vertex stage of its own.
    FullScreen,
    /// Triangles: a number of vertices and instances. The vertex shader finds its data itself or in the pass's vertex
    /// buffers.
    Vertices {
        /// Vertices, or indices if the pass has an index buffer (32 bits each).
        count: u32,
        /// Instances.
        instances: u32,
    },
    /// As `Vertices`; the counts stand in the pass's buffer of the role [`BufferRole::Indirect`]: a
    /// `VkDrawIndirectCommand`, or `VkDrawIndexedIndirectCommand` if the pass has an index buffer.
    Indirect,
    /// Draws that the embedding program records inside the rendering scope. The program knows them by the pass's shader name.
    Custom,
}

/// One part of the scene that the sun's shadows fall on, by distance from the camera; each part has a shadow map of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cascade {
    /// Which of the objects that may cast shadows are drawn.
    pub list: DrawList,
    /// Which part, from 0, the nearest.
    pub index: u8,
    /// How many there are, 1 to [`Cascade::MOST`].
    pub of: u8,
    /// How far shadows reach; `None`: through the whole scene.
    pub reach: Option<Metres>,
    /// How logarithmic the distances are at which parts end: 0 cuts parts of equal depth, 1 parts whose ends are multiples of each
    /// other.
    pub logarithmic: Share,
}

impl Cascade {
    /// The most that there are.
    pub const MOST: u8 = 4;

    /// The part and how the view is cut, for people: "cascade 1 of 4 through 14 m".
    #[must_use]
    pub fn in_words(&self) -> String {
        let reach = self.reach.map_or_else(|| "the whole scene".to_owned(), |reach| format!("{} m", f32::from(reach)));
        let words = format!("cascade {} of {} through {reach}", self.index, self.of);
        if self.logarithmic == Share::OF_CASCADES {
            return words;
        }
        format!("{words}, with ends {} logarithmic", f32::from(self.logarithmic))
    }
}

/// A share of a whole, 0 to 1.
// Bits of such numbers are ordered as the numbers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "f32", into = "f32")]
pub struct Share(u32);

impl Share {
    /// How logarithmic the ends of cascades are if a pipeline says nothing.
    pub const OF_CASCADES: Share = Share(0.85f32.to_bits());
}

impl TryFrom<f32> for Share {
    type Error = &'static str;

    fn try_from(share: f32) -> Result<Share, &'static str> {
        // A zero loses its sign.
        (0.0..=1.0).contains(&share).then(|| Share((share + 0.0).to_bits())).ok_or("no number from 0 to 1")
    }
}

impl From<Share> for f32 {
    fn from(share: Share) -> f32 {
        f32::from_bits(share.0)
    }
}

/// A length in metres, finite and above 0.
// Bits of such numbers are ordered as the numbers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "f32", into = "f32")]
pub struct Metres(NonZero<u32>);

impl TryFrom<f32> for Metres {
    type Error = &'static str;

    fn try_from(metres: f32) -> Result<Metres, &'static str> {
        let bits = NonZero::new(metres.to_bits()).filter(|_| metres.is_finite() && metres > 0.0);
        bits.map(Metres).ok_or("no length above 0")
    }
}

impl From<Metres> for f32 {
    fn from(metres: Metres) -> f32 {
        f32::from_bits(metres.0.get())
    }
}

/// The scene's draw lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum DrawList {
    /// Objects that hide what is behind them.
    Opaque,
    /// Objects with holes: fragments whose alpha is below the material's cut-off are discarded.
    Masked,
    /// Objects that let through what is behind them, sorted back to front.
    Transparent,
}

impl DrawList {
    /// All lists, by name.
    pub const NAMED: [(&'static str, DrawList); 3] =
        [("Opaque", DrawList::Opaque), ("Masked", DrawList::Masked), ("Transparent", DrawList::Transparent)];
    /// Those of objects that light doesn't go through, by name.
    pub const CASTERS: [(&'static str, DrawList); 2] = [DrawList::NAMED[0], DrawList::NAMED[1]];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_numbers_from_0_to_1_are_shares_and_they_are_ordered_as_numbers() {
        for bad in [-f32::MIN_POSITIVE, 1.0 + f32::EPSILON, f32::INFINITY, f32::NAN] {
            assert!(Share::try_from(bad).is_err(), "{bad}");
        }
        let shares = [-0.0, 0.0, f32::MIN_POSITIVE, 0.5, 1.0].map(|share| Share::try_from(share).expect("a share"));
        assert_eq!(shares[0], shares[1]);
        assert!(shares.is_sorted() && f32::from(shares[3]) == 0.5);
    }

    #[test]
    fn only_finite_lengths_above_0_are_lengths_and_they_are_ordered_as_numbers() {
        for bad in [0.0, -0.0, -1.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
            assert!(Metres::try_from(bad).is_err(), "{bad}");
        }
        let lengths = [f32::MIN_POSITIVE / 2.0, 1e-3, 1.0, 14.0, f32::MAX];
        let known = lengths.map(|length| Metres::try_from(length).expect("a length"));
        assert!(known.is_sorted() && known.map(f32::from) == lengths);
    }

    #[test]
    fn no_draw_takes_more_room_than_a_draw_of_vertices() {
        assert_eq!(size_of::<Draw>(), 12);
    }
}
