//! Which kinds of things random pipelines hold: one table of what the library can't do yet.

/// A kind of pass, resource or access.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Full-screen draws.
    FullScreen,
    /// Draws that cover part of their targets.
    Triangles,
    /// Dispatches.
    Compute,
    /// Copies.
    Copy,
    /// Blits.
    Blit,
    /// Fills.
    Fill,
    /// Passes that the embedding program records.
    Custom,
    /// Passes that are off.
    Forward,
    /// Multisampled images.
    Multisampled,
    /// Fragment shaders that run once a sample.
    PerSample,
    /// Blending.
    Blend,
    /// Mip levels.
    Mips,
    /// Stencil.
    Stencil,
    /// Array layers.
    Layers,
    /// Deep images.
    Deep,
    /// Cubes.
    Cube,
    /// Buffers.
    Buffers,
    /// Buffers that leave the frame.
    BufferOutput,
    /// Uniform blocks.
    Uniform,
    /// Vertex buffers.
    VertexBuffer,
    /// Vertex shaders that read.
    VertexRead,
    /// Index buffers.
    IndexBuffer,
    /// Draws whose counts stand in a buffer.
    IndirectDraw,
    /// Dispatches whose counts stand in a buffer.
    IndirectDispatch,
    /// Reads of storage images.
    StorageRead,
    /// Reads of the fragment's own pixel.
    OwnPixel,
    /// Reading and writing the same texels.
    Modify,
    /// Atomics.
    Atomics,
    /// Fragment shaders that write without attachments.
    FragmentStores,
    /// Resources that stay from frame to frame.
    Persistent,
    /// Resources that can be read in later frames.
    History,
    /// Resources that the embedding program hands in.
    Imported,
    /// Passes that are never culled.
    SideEffect,
}

/// The kinds of things that random pipelines may hold.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Allowed {
    without: Vec<Kind>,
}

impl Allowed {
    /// Everything but these.
    #[must_use]
    pub fn without(kinds: &[Kind]) -> Allowed {
        Allowed { without: kinds.to_vec() }
    }

    /// Whether pipelines may hold things of this kind.
    #[must_use]
    pub fn has(&self, kind: Kind) -> bool {
        !self.without.contains(&kind)
    }
}

/// Kinds that the library can't do yet. The list shrinks to nothing as features land.
pub const NOT_YET: &[Kind] = &[];

impl Allowed {
    /// Everything that the library can do today.
    #[must_use]
    pub fn today() -> Allowed {
        Allowed::without(NOT_YET)
    }
}
