//! A random pipeline. It says less than a pipeline file can, in a form that is easy to make, to evaluate and to shrink.

use framewright_graph::frame::{Blend, StencilState};
use framewright_graph::vulkan::{Aspects, ColorComponents, CompareOp, Format, ResolveMode, Shape};

/// Texels in x, y and z.
pub type Extent = [u32; 3];

/// Samples of every multisampled image: the count that both software drivers have.
pub const SAMPLES: u32 = 4;

/// Triangles that an index may name; vertex buffers hold at least three times as many vertices.
pub const TRIANGLES: u32 = 5;

/// Invocations of a workgroup in x and y.
pub const WORKGROUP: u32 = 4;

/// A random pipeline.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Pipeline {
    /// Images, named `i0`, `i1`, ….
    pub images: Vec<Image>,
    /// Buffers, named `b0`, `b1`, ….
    pub buffers: Vec<Buffer>,
    /// Passes in order.
    pub passes: Vec<Pass>,
    /// The outputs.
    pub outputs: Vec<Thing>,
}

/// An image or a buffer, by its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Thing {
    /// An image.
    Image(usize),
    /// A buffer.
    Buffer(usize),
}

/// An image.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Texel format.
    pub format: Format,
    /// Flat, deep or a cube.
    pub shape: Shape,
    /// Texels of the first mip level.
    pub extent: Extent,
    /// Mip levels.
    pub mips: u32,
    /// Array layers, 6 of a cube.
    pub layers: u32,
    /// 1 or [`SAMPLES`].
    pub samples: u32,
    /// How several samples of depth become one value; `None`: drawn again for shaders, and sample zero for all else.
    pub resolve: Option<ResolveMode>,
    /// How long its contents live.
    pub life: Life,
}

impl Image {
    /// The extent of a mip level.
    #[must_use]
    pub fn extent_of(&self, mip: u32) -> Extent {
        self.extent.map(|side| (side >> mip).max(1))
    }
}

/// How long contents live.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Life {
    /// Within the frame.
    Transient,
    /// From frame to frame; the first finds this value in every component (of depth: this many 256ths).
    Persistent(u8),
    /// Written anew each frame, and read for this many frames more; before the first they hold this value.
    History(u32, u8),
    /// An image that the embedding program hands in without contents.
    Target,
    /// Handed in by the embedding program with contents that differ from frame to frame.
    Imported,
}

/// A buffer.
#[derive(Debug, Clone, PartialEq)]
pub struct Buffer {
    /// 32-bit words, at least 16.
    pub words: u32,
    /// The meaning of the words.
    pub contents: Contents,
    /// How long its contents live.
    pub life: Life,
}

/// The meaning of a buffer's words. All passes that write the buffer keep to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contents {
    /// Any.
    Words,
    /// One float for each vertex.
    Vertices,
    /// Indices, three for each triangle.
    Indices,
    /// `VkDrawIndirectCommand`s.
    Draw,
    /// `VkDrawIndexedIndirectCommand`s.
    IndexedDraw,
    /// Counts of workgroups.
    Dispatch,
}

impl Contents {
    /// Words that must be made together.
    #[must_use]
    pub const fn group(self) -> u32 {
        match self {
            Contents::Words | Contents::Vertices | Contents::Dispatch => 1,
            Contents::Indices => 3,
            Contents::Draw => 4,
            Contents::IndexedDraw => 5,
        }
    }

    /// The number by which shaders know it.
    #[must_use]
    pub const fn number(self) -> u32 {
        match self {
            Contents::Words => 0,
            Contents::Vertices => 1,
            Contents::Indices => 2,
            Contents::Draw => 3,
            Contents::IndexedDraw => 4,
            Contents::Dispatch => 5,
        }
    }
}

/// Planes of an image of depth and stencil.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Plane {
    /// All that the image has.
    #[default]
    All,
    /// Depth alone, of an image that has stencil too.
    Depth,
    /// Stencil alone.
    Stencil,
}

impl Plane {
    /// The planes of an image of this format that are meant.
    #[must_use]
    pub const fn aspects(self, format: Format) -> Aspects {
        match self {
            Plane::All => format.aspects(),
            Plane::Depth => Aspects::DEPTH,
            Plane::Stencil => Aspects::STENCIL,
        }
    }

    /// Whether they share a plane.
    #[must_use]
    pub fn overlaps(self, other: Plane) -> bool {
        self == Plane::All || other == Plane::All || self == other
    }
}

/// A part of an image: whole mip levels and layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The image.
    pub image: usize,
    /// First mip level.
    pub mip: u32,
    /// Number of mip levels.
    pub mips: u32,
    /// First layer.
    pub layer: u32,
    /// Number of layers.
    pub layers: u32,
    /// The planes.
    pub plane: Plane,
}

impl Part {
    /// Its subresources: mip level and layer.
    pub fn subresources(self) -> impl Iterator<Item = [u32; 2]> {
        (self.mip..self.mip + self.mips)
            .flat_map(move |mip| (self.layer..self.layer + self.layers).map(move |layer| [mip, layer]))
    }

    /// Whether they share a subresource.
    #[must_use]
    pub fn overlaps(self, other: Part) -> bool {
        let apart = |at: u32, count: u32, from: u32, others: u32| at + count <= from || from + others <= at;
        self.image == other.image
            && self.plane.overlaps(other.plane)
            && !apart(self.mip, self.mips, other.mip, other.mips)
            && !apart(self.layer, self.layers, other.layer, other.layers)
    }
}

/// A pass. What it writes is a hash of its number, the position and all that it reads.
#[derive(Debug, Clone, PartialEq)]
pub struct Pass {
    /// Its number: its name is `p` and that, and it is hashed.
    pub number: u32,
    /// The work of the pass.
    pub work: Work,
    /// Whether it is never culled.
    pub side_effect: bool,
}

/// The work of a pass.
#[derive(Debug, Clone, PartialEq)]
pub enum Work {
    /// Draws.
    Draw(Draw),
    /// Runs a compute shader.
    Compute(Compute),
    /// Copies.
    Copy {
        /// From here.
        from: Region,
        /// How many frames before.
        frames_ago: u32,
        /// To there.
        to: Region,
    },
    /// Scales, taking the nearest texel.
    Blit {
        /// From here.
        from: Part,
        /// To there.
        to: Part,
    },
    /// Sets every component of an image, or every word of a buffer (of depth: a number of 256ths).
    Fill {
        /// The target.
        to: Region,
        /// The value.
        value: u8,
    },
    /// Recorded by the embedding program: a copy, or a fill where nothing is read.
    Custom {
        /// From here.
        from: Option<Region>,
        /// To there.
        to: Region,
        /// The value of a fill.
        value: u8,
    },
    /// A pass that is off: `to` becomes what `from` is.
    Forward {
        /// From here.
        from: usize,
        /// To there.
        to: usize,
    },
}

/// Part of an image, or a whole buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Region {
    /// Part of an image.
    Image(Part),
    /// A whole buffer.
    Buffer(usize),
}

/// A draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Draw {
    /// The geometry.
    pub geometry: Geometry,
    /// Whether the embedding program records it.
    pub custom: bool,
    /// Whether its fragment shader discards fragments.
    pub discards: bool,
    /// Whether its fragment shader runs once a sample.
    pub per_sample: bool,
    /// Reads of the shaders.
    pub reads: Vec<Read>,
    /// How many of these its vertex shader reads, the first ones.
    pub vertex_reads: usize,
    /// Colour attachments.
    pub color: Vec<Target>,
    /// Depth attachment.
    pub depth: Option<DepthTarget>,
    /// Writes at the fragment's own position.
    pub stores: Vec<Store>,
}

/// The geometry of a draw.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// One triangle that covers all, at depth 0.
    FullScreen,
    /// Triangles that cover quarters of the target around a corner, at depths of their own.
    Triangles {
        /// How many.
        count: Count,
        /// A buffer of [`Contents::Vertices`].
        vertices: Option<usize>,
        /// A buffer of [`Contents::Indices`].
        indices: Option<usize>,
    },
}

/// How many triangles a draw has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Count {
    /// Counts of triangles (up to [`TRIANGLES`]) and of instances.
    Direct(u32, u32),
    /// As the first command of this buffer says.
    Indirect(usize),
}

/// A colour attachment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// One mip level and layer.
    pub part: Part,
    /// Value of every component that it is cleared to.
    pub clear: Option<u8>,
    /// How new meets old.
    pub blend: Blend,
    /// The channels that it writes.
    pub write_mask: ColorComponents,
}

/// A depth attachment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthTarget {
    /// One mip level and layer.
    pub part: Part,
    /// 256ths that it is cleared to.
    pub clear: Option<u8>,
    /// The comparison.
    pub test: CompareOp,
    /// Whether passing fragments write depth.
    pub write: bool,
    /// Clear value, test and operation of the stencil plane; `None`: it isn't there, or not used.
    pub stencil: Option<StencilState>,
}

/// A dispatch. Each invocation stands at a position of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Compute {
    /// The grid: positions beyond it do nothing.
    pub grid: Extent,
    /// How many workgroups.
    pub groups: Groups,
    /// Reads of the shader.
    pub reads: Vec<Read>,
    /// Writes of the shader.
    pub stores: Vec<Store>,
}

/// How many workgroups a dispatch has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Groups {
    /// A fixed number.
    Count(Extent),
    /// As many as cover the grid.
    Cover,
    /// As many as this buffer says, from this word on.
    Indirect(usize, u32),
}

/// Something that a shader reads, near its own position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Read {
    /// Samples part of an image.
    Sampled {
        /// The part.
        part: Part,
        /// The age of the part's contents, in frames.
        frames_ago: u32,
        /// Whether it reads every sample, or one value a texel.
        per_sample: bool,
    },
    /// Samples one mip level and layer, as large as the target, at the fragment's own position.
    Own(Part),
    /// Reads one mip level of an image as storage.
    Storage(Part),
    /// Reads the first 16 words of a buffer as a uniform block.
    Uniform(usize, u32),
    /// Reads a buffer as a storage block, of this or an earlier frame.
    Block(usize, u32),
}

/// Something that a shader writes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Store {
    /// One mip level of an image, or a buffer.
    pub region: Region,
    /// How.
    pub access: StoreAccess,
}

/// How a shader writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StoreAccess {
    /// Replaces what is there, all of it.
    Write,
    /// Reads what is there and replaces it, at its own position.
    Modify,
    /// Adds to what is there, anywhere.
    Add,
}
