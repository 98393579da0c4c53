//! Images and buffers of a frame.

use super::{EyeForm, Resource, TextureFile};
use crate::base::Span;
use crate::vulkan::{FillValue, Format, Layout, OutsideOwner, ResolveMode, Rotation, Shape, State, extent_at};
use std::sync::Arc;

/// The numbers of samples a texel that an image can be asked to have.
pub const SAMPLE_COUNTS: [u32; 5] = [1, 2, 4, 8, 16];

/// An image of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// Texel format.
    pub format: Format,
    /// Flat, deep, or a cube.
    pub shape: Shape,
    /// Width, height, depth in texels, each at least 1: of the part in use, if more is allocated.
    pub extent: [u32; 3],
    /// The allocated width and height if `extent` may change from frame to frame, both at least as much as that: the part
    /// in use begins in the upper left corner. `None`: the allocated extent is `extent`. Flat images that are transient or
    /// have history may have one of their own.
    pub allocated: Option<[u32; 2]>,
    /// The rotation of its contents; `extent` and `allocated` are those of the turned picture then. The compiler turns
    /// images for [`Output::rotation`](super::Output::rotation): in frames that it is given, no image is turned.
    pub rotation: Rotation,
    /// The form in which it holds both eyes' parts; `None`: both eyes share it, or it is one eye's. Its other properties are
    /// those of one eye's part then: flat, of one layer and one mip level. Draws replace both eyes' parts, and the image is
    /// sampled, copied to others of its kind, or filled.
    pub eyes: Option<EyeForm>,
    /// Mip levels, at least 1.
    pub mips: u32,
    /// Array layers, at least 1; of a cube 6 for each.
    pub layers: u32,
    /// Samples a texel that were asked for, one of [`SAMPLE_COUNTS`]. `fit` lowers it to what the device has.
    pub samples: u32,
    /// How several samples of it become one value, if the pipeline says so. Without a word colour is averaged, integers are
    /// sample zero, and depth is drawn again for passes that sample it and sample zero where it is copied or leaves the
    /// frame.
    pub resolve: Option<Resolve>,
    /// The format without the pipeline's choice, if the pipeline chose the format out of several that its purpose allows.
    pub chosen: Option<ChosenFormat>,
    /// How long its contents live.
    pub lifetime: Lifetime,
}

/// A format that a pipeline has chosen by a policy.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChosenFormat {
    /// The format without the policy. It serves every purpose of the chosen format.
    pub usual: Format,
    /// The policy in words: "`color: Smallest`".
    pub because: Arc<str>,
}

impl Image {
    /// A flat transient image of one mip level, one layer and one sample, that no file declares.
    #[must_use]
    pub fn new(name: &str, format: Format, width: u32, height: u32) -> Image {
        Image {
            name: name.into(),
            span: Span::NONE,
            format,
            shape: Shape::D2,
            extent: [width, height, 1],
            allocated: None,
            rotation: Rotation::Identity,
            eyes: None,
            mips: 1,
            layers: 1,
            samples: 1,
            resolve: None,
            chosen: None,
            lifetime: Lifetime::Transient,
        }
    }

    /// Width, height and depth that it is made with.
    #[must_use]
    pub fn made(&self) -> [u32; 3] {
        EyeForm::extent(self.eyes, allocated_extent(self.extent, self.allocated), self.rotation)
    }

    /// Array layers that it is made with.
    #[must_use]
    pub fn made_layers(&self) -> u32 {
        EyeForm::layers(self.eyes, self.layers)
    }
}

/// Width, height and depth of an image of which a part is in use.
pub(crate) fn allocated_extent(part: [u32; 3], allocated: Option<[u32; 2]>) -> [u32; 3] {
    allocated.map_or(part, |[width, height]| [width, height, part[2]])
}

/// The least part in use, in texels. A linear filter reads two texels in each direction, one of them possibly with weight 0:
/// both must be drawn, since 0 times an undrawn value need not be 0.
const LEAST_PART: u32 = 2;

/// Width, height and depth of the part in use, at least as much as a linear filter needs, if `allocated` has room for that.
pub(crate) fn least_part(part: [u32; 3], allocated: [u32; 2]) -> [u32; 3] {
    let side = |side: usize| part[side].max(allocated[side].min(LEAST_PART));
    [side(0), side(1), part[2]]
}

/// Width, height and depth of mip level number `mip` of an image with this extent; if more is allocated, of the level's part in use.
pub(crate) fn level_extent(extent: [u32; 3], allocated: Option<[u32; 2]>, mip: u32) -> [u32; 3] {
    let level = extent_at(extent, mip);
    let Some(allocated) = allocated else { return level };
    let [width, height, _] = extent_at(allocated_extent(extent, Some(allocated)), mip);
    least_part(level, [width, height])
}

/// How several samples of an image become one value.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolve {
    /// The way.
    pub way: ResolveWay,
    /// The reason in words: "`resolve: Min`".
    pub because: Arc<str>,
}

/// A way in which several samples become one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResolveWay {
    /// Depth alone: its draws are repeated with one sample.
    DepthOnly,
    /// By one of Vulkan's modes: the average for colour, sample zero for integers, any mode for depth.
    By(ResolveMode),
    /// Floating-point and normalised colour alone: a draw takes the mean of tone-mapped samples back to light. So one bright
    /// sample doesn't drown the others.
    Weighted,
}

impl ResolveWay {
    /// Whether images of a format can be resolved in this way.
    pub(crate) fn fits(self, format: Format) -> bool {
        match self {
            ResolveWay::DepthOnly => format.is_depth(),
            ResolveWay::By(_) if format.is_depth() => true,
            ResolveWay::By(mode) if format.is_integer() => mode == ResolveMode::SampleZero,
            ResolveWay::By(mode) => mode == ResolveMode::Average,
            ResolveWay::Weighted => !format.is_depth() && !format.is_integer(),
        }
    }
}

/// A buffer of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Buffer {
    /// Unique name, among images too.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// Bytes, at least 1.
    pub bytes: u64,
    /// How long its contents live. A fill value is its bits in the first component.
    pub lifetime: Lifetime,
}

/// How long the contents of an image or a buffer live.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Lifetime {
    /// Within the frame.
    #[default]
    Transient,
    /// From frame to frame: a read before the first write finds the contents of the frame before.
    Persistent {
        /// Contents before the first frame.
        initial: FillValue,
    },
    /// Each frame writes it anew; its contents of earlier frames can be read beside it (`frames_ago`).
    History {
        /// How many frames back it can be read, at least 1.
        frames: u32,
        /// Contents that stand for frames before the first.
        initial: FillValue,
    },
    /// It belongs to the embedding program, which hands it in for each frame.
    Imported {
        /// The state in which it is handed in. An image in the layout `Undefined` has no contents to read.
        before: State,
        /// The state in which it is to be left; `None`: that of its last use, which the Plan says.
        after: Option<State>,
        /// Who else than this device has it between frames.
        owner: Option<OutsideOwner>,
    },
    /// An image whose contents come from a file before the first frame, and which is only sampled.
    File(Arc<TextureFile>),
}

impl Lifetime {
    /// Who else than this device has it between frames.
    pub(crate) fn owner(&self) -> Option<OutsideOwner> {
        match self {
            Lifetime::Imported { owner, .. } => *owner,
            Lifetime::Transient | Lifetime::Persistent { .. } | Lifetime::History { .. } | Lifetime::File(_) => None,
        }
    }

    /// Whether contents of earlier frames can be found in it.
    pub(crate) fn outlives_frame(&self) -> bool {
        !matches!(self, Lifetime::Transient)
    }

    /// Whether a frame finds contents in it that the frame didn't write. With history each frame writes it anew.
    pub(crate) fn is_kept(&self) -> bool {
        !matches!(self, Lifetime::Transient | Lifetime::History { .. })
    }

    /// Whether `of`, which lives so, has contents before the first pass.
    pub(crate) fn has_contents(&self, of: Resource) -> bool {
        match self {
            Lifetime::Transient | Lifetime::History { .. } => false,
            Lifetime::Persistent { .. } | Lifetime::File(_) => true,
            Lifetime::Imported { before, .. } => {
                matches!(of, Resource::Buffer(_)) || before.layout != Layout::Undefined
            }
        }
    }
}
