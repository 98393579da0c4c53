//! The table of accesses: the ways in which work uses images and buffers, and what Vulkan calls each of them.
//!
//! Each way is a row. The words for states in files, the stages and layouts that go with an access, and the usages that an image or
//! a buffer needs are derived from these rows. What happens in each layout stands in the [table of layouts](super::layout), the stages of
//! queues and pipelines in the [table of stages](super::stage). The checker keeps tables of its own, so that a mistake here is found there.

use super::{Accesses, BufferUsage, Layout, Stages, State, Usage};

/// A way in which work uses an image or a buffer, or the lack of one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AccessKind {
    /// None, and contents are lost.
    Undefined,
    /// Colour attachment.
    ColorAttachment,
    /// Depth or stencil attachment.
    DepthAttachment,
    /// Attachment that fragment shaders read at their own position.
    InputAttachment,
    /// Attachment that says how many texels a fragment covers.
    ShadingRate,
    /// Sampled by shaders.
    Sampled,
    /// Read and written by shaders.
    Storage,
    /// Uniform block.
    Uniform,
    /// Vertex attributes.
    Vertex,
    /// Indices.
    Index,
    /// Counts of draws or dispatches.
    Indirect,
    /// Source of a copy, blit or resolve.
    TransferSource,
    /// Target of a copy, blit, resolve or clear.
    TransferTarget,
    /// Acceleration structure: traced, built, copied.
    AccelerationStructure,
    /// Vertices, instances and the like that an acceleration structure is built from.
    BuildInput,
    /// Shader binding table.
    ShaderBindingTable,
    /// Presented in a window.
    Present,
    /// Read or written by the program.
    Host,
}

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AccessRow {
    pub(crate) kind: AccessKind,
    /// The word for it in a file's states; `None`: only Vulkan's own words say it.
    pub(crate) word: Option<StateWord>,
    /// The stages in which it can happen (Vulkan 1.4, table "Supported access flags").
    pub(crate) stages: Stages,
    /// Those of its stages that only read.
    pub(crate) read_only: Stages,
    /// Its reads.
    pub(crate) reads: Accesses,
    /// Its writes.
    pub(crate) writes: Accesses,
    /// The usage that an image needs, and its layout. `None`: no image is used so.
    pub(crate) image: Option<(Usage, Layout)>,
    /// The usage that a buffer needs. `None`: no buffer is used so.
    pub(crate) buffer: Option<BufferUsage>,
    /// The device feature that it needs beyond those of its stages, by Vulkan's name, if it needs one.
    pub(crate) feature: Option<&'static str>,
}

/// A word for a state in a pipeline file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StateWord {
    pub(crate) word: &'static str,
    /// The meaning.
    pub(crate) about: &'static str,
    /// What can be in the state.
    pub(crate) of: &'static [StateSubject],
}

/// The kind of thing that a state belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StateSubject {
    /// An image.
    Image,
    /// A buffer.
    Buffer,
}

const SHADERS: Stages = Stages::SHADERS;
const TESTS: Stages = Stages::EARLY_FRAGMENT_TESTS.union(Stages::LATE_FRAGMENT_TESTS);
const SOURCES: Stages = Stages::COPY.union(Stages::BLIT).union(Stages::RESOLVE);
const STRUCTURES: Stages = Stages::ACCELERATION_STRUCTURE_BUILD_KHR.union(Stages::ACCELERATION_STRUCTURE_COPY_KHR);

/// A buffer that holds an acceleration structure, or is the scratch memory of a build. Commands know both by their addresses.
const STRUCTURE: BufferUsage = BufferUsage::ACCELERATION_STRUCTURE_STORAGE_KHR
    .union(BufferUsage::STORAGE_BUFFER)
    .union(BufferUsage::SHADER_DEVICE_ADDRESS);
const BUILD_INPUT: BufferUsage =
    BufferUsage::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR.union(BufferUsage::SHADER_DEVICE_ADDRESS);

/// Nothing, from which rows are made.
const NONE: AccessRow = AccessRow {
    kind: AccessKind::Undefined,
    word: None,
    stages: Stages::empty(),
    read_only: Stages::empty(),
    reads: Accesses::empty(),
    writes: Accesses::empty(),
    image: None,
    buffer: None,
    feature: None,
};

const fn word(word: &'static str, about: &'static str, of: &'static [StateSubject]) -> Option<StateWord> {
    Some(StateWord { word, about, of })
}

/// The rows, by [`AccessKind`].
const ROWS: &[AccessRow] = &[
    AccessRow {
        word: word("Undefined", "An image without contents.", &[StateSubject::Image]),
        image: Some((Usage::empty(), Layout::Undefined)),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::ColorAttachment,
        word: word("ColorAttachment", "An image that is drawn into as colour.", &[StateSubject::Image]),
        stages: Stages::COLOR_ATTACHMENT_OUTPUT,
        reads: Accesses::COLOR_ATTACHMENT_READ,
        writes: Accesses::COLOR_ATTACHMENT_WRITE,
        image: Some((Usage::COLOR_ATTACHMENT, Layout::ColorAttachmentOptimal)),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::DepthAttachment,
        word: word("DepthAttachment", "An image that is drawn into as depth or stencil.", &[StateSubject::Image]),
        stages: TESTS,
        reads: Accesses::DEPTH_STENCIL_ATTACHMENT_READ,
        writes: Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE,
        image: Some((Usage::DEPTH_STENCIL_ATTACHMENT, Layout::DepthStencilAttachmentOptimal)),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::InputAttachment,
        stages: Stages::FRAGMENT_SHADER,
        reads: Accesses::INPUT_ATTACHMENT_READ,
        image: Some((Usage::INPUT_ATTACHMENT, Layout::RenderingLocalReadKhr)),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::ShadingRate,
        stages: Stages::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR,
        reads: Accesses::FRAGMENT_SHADING_RATE_ATTACHMENT_READ_KHR,
        image: Some((Usage::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR, Layout::FragmentShadingRateAttachmentOptimalKhr)),
        feature: Some("attachmentFragmentShadingRate"),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::Sampled,
        word: word("Sampled", "An image that shaders sample.", &[StateSubject::Image]),
        stages: SHADERS,
        reads: Accesses::SHADER_SAMPLED_READ,
        image: Some((Usage::SAMPLED, Layout::ShaderReadOnlyOptimal)),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::Storage,
        word: word("Storage", "Read and written by shaders.", &[StateSubject::Image, StateSubject::Buffer]),
        stages: SHADERS,
        reads: Accesses::SHADER_STORAGE_READ,
        writes: Accesses::SHADER_STORAGE_WRITE,
        image: Some((Usage::STORAGE, Layout::General)),
        buffer: Some(BufferUsage::STORAGE_BUFFER),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::Uniform,
        word: word("Uniform", "A buffer that is read as a uniform block.", &[StateSubject::Buffer]),
        stages: SHADERS,
        reads: Accesses::UNIFORM_READ,
        buffer: Some(BufferUsage::UNIFORM_BUFFER),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::Vertex,
        word: word("Vertex", "A buffer of vertices.", &[StateSubject::Buffer]),
        stages: Stages::VERTEX_INPUT,
        reads: Accesses::VERTEX_ATTRIBUTE_READ,
        buffer: Some(BufferUsage::VERTEX_BUFFER),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::Index,
        word: word("Index", "A buffer of indices.", &[StateSubject::Buffer]),
        stages: Stages::VERTEX_INPUT,
        reads: Accesses::INDEX_READ,
        buffer: Some(BufferUsage::INDEX_BUFFER),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::Indirect,
        word: word("Indirect", "A buffer that holds counts of draws or dispatches.", &[StateSubject::Buffer]),
        stages: Stages::DRAW_INDIRECT.union(Stages::ACCELERATION_STRUCTURE_BUILD_KHR),
        reads: Accesses::INDIRECT_COMMAND_READ,
        buffer: Some(BufferUsage::INDIRECT_BUFFER),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::TransferSource,
        word: word("TransferSource", "Copied or scaled from.", &[StateSubject::Image, StateSubject::Buffer]),
        stages: SOURCES.union(STRUCTURES),
        reads: Accesses::TRANSFER_READ,
        image: Some((Usage::TRANSFER_SRC, Layout::TransferSrcOptimal)),
        buffer: Some(BufferUsage::TRANSFER_SRC),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::TransferTarget,
        word: word("TransferTarget", "Copied, scaled or filled into.", &[StateSubject::Image, StateSubject::Buffer]),
        stages: SOURCES.union(Stages::CLEAR).union(STRUCTURES),
        writes: Accesses::TRANSFER_WRITE,
        image: Some((Usage::TRANSFER_DST, Layout::TransferDstOptimal)),
        buffer: Some(BufferUsage::TRANSFER_DST),
        ..NONE
    },
    // No pass accesses one: states of imports and outputs name it.
    AccessRow {
        kind: AccessKind::AccelerationStructure,
        stages: SHADERS.union(STRUCTURES),
        read_only: SHADERS,
        reads: Accesses::ACCELERATION_STRUCTURE_READ_KHR,
        writes: Accesses::ACCELERATION_STRUCTURE_WRITE_KHR,
        buffer: Some(STRUCTURE),
        feature: Some("accelerationStructure"),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::BuildInput,
        stages: Stages::ACCELERATION_STRUCTURE_BUILD_KHR,
        reads: Accesses::SHADER_READ,
        buffer: Some(BUILD_INPUT),
        feature: Some("accelerationStructure"),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::ShaderBindingTable,
        stages: Stages::RAY_TRACING_SHADER_KHR,
        reads: Accesses::SHADER_BINDING_TABLE_READ_KHR,
        buffer: Some(BufferUsage::SHADER_BINDING_TABLE_KHR.union(BufferUsage::SHADER_DEVICE_ADDRESS)),
        feature: Some("rayTracingMaintenance1"),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::Present,
        word: word("Present", "An image that is shown in a window.", &[StateSubject::Image]),
        image: Some((Usage::empty(), Layout::PresentSrcKhr)),
        ..NONE
    },
    AccessRow {
        kind: AccessKind::Host,
        word: word(
            "Host",
            "A buffer that the program writes before the frame, or reads afterwards.",
            &[StateSubject::Buffer],
        ),
        stages: Stages::HOST,
        reads: Accesses::HOST_READ,
        writes: Accesses::HOST_WRITE,
        image: Some((Usage::empty(), Layout::General)),
        buffer: Some(BufferUsage::empty()),
        ..NONE
    },
];

impl AccessKind {
    /// Every row.
    pub(crate) const TABLE: &'static [AccessRow] = ROWS;

    /// The row.
    pub(crate) const fn row(self) -> &'static AccessRow {
        &ROWS[self as usize]
    }

    /// The stages in which the work of a Plan does it, unless the work itself narrows them: none that an extension brings.
    pub(crate) const fn stages(self) -> Stages {
        self.row().stages.intersection(Stages::CORE)
    }

    /// Its reads, its writes, or both.
    pub(crate) const fn accesses(self, reads: bool, writes: bool) -> Accesses {
        let AccessRow { reads: read, writes: written, .. } = self.row();
        match (reads, writes) {
            (false, false) => Accesses::empty(),
            (true, false) => *read,
            (false, true) => *written,
            (true, true) => read.union(*written),
        }
    }

    /// The usage that an image needs.
    pub(crate) const fn usage(self) -> Usage {
        match self.row().image {
            Some((usage, _)) => usage,
            None => Usage::empty(),
        }
    }

    /// The layout of an image; of depth that is an attachment elsewhere it is another one. Buffers have none: `UNDEFINED`.
    pub(crate) const fn layout(self) -> Layout {
        match self.row().image {
            Some((_, layout)) => layout,
            None => Layout::Undefined,
        }
    }
}

impl State {
    /// The device features that it needs beyond the minimum, by Vulkan's names; one may come several times.
    pub fn features(&self) -> impl Iterator<Item = &'static str> {
        let accesses = rows_of(self.accesses).filter_map(|row| row.feature);
        let layout = self.layout.row().kinds.iter().filter_map(|kind| kind.row().feature);
        self.stages.features().chain(accesses).chain(layout)
    }
}

impl Accesses {
    /// Whether a transfer reads.
    pub(crate) fn reads_by_transfer(self) -> bool {
        self.contains(Accesses::TRANSFER_READ)
    }

    /// The stages in which one of these can happen; every one, where `MEMORY_READ` or `MEMORY_WRITE` is among them.
    pub(crate) fn stages(self) -> Stages {
        if self.intersects(Accesses::MEMORY) {
            return Stages::all();
        }
        rows_of(self).fold(Stages::empty(), |all, row| {
            all | if self.intersects(row.reads) { row.stages } else { row.stages - row.read_only }
        })
    }

    /// The usage that an image needs for them; none for accesses to any memory.
    pub(crate) fn image_usage(self) -> Usage {
        rows_of(self).fold(Usage::empty(), |all, row| all | row.kind.usage())
    }

    /// The usage that a buffer needs for them.
    pub(crate) fn buffer_usage(self) -> BufferUsage {
        self.iter()
            .fold(BufferUsage::empty(), |all, access| all | BUFFER_USAGES[access.bits().trailing_zeros() as usize])
    }

    /// Those that only images, or only buffers, can have seen.
    pub(crate) fn only_of(self, of: StateSubject) -> Accesses {
        let other = |row: &&AccessRow| match of {
            StateSubject::Image => row.buffer.is_none(),
            StateSubject::Buffer => row.image.is_none(),
        };
        rows_of(self).filter(other).fold(Accesses::empty(), |all, row| all | (self & (row.reads | row.writes)))
    }
}

/// The rows of these accesses.
fn rows_of(accesses: Accesses) -> impl Iterator<Item = &'static AccessRow> {
    AccessKind::TABLE.iter().filter(move |row| accesses.intersects(row.reads | row.writes))
}

/// The usage that a buffer needs for each access, by the number of its bit. Work that reads or writes in a way that isn't known
/// needs all usages that no extension brings.
const BUFFER_USAGES: [BufferUsage; 64] = {
    let mut usages = [BufferUsage::empty(); 64];
    let mut row = 0;
    while row < ROWS.len() {
        let AccessRow { reads, writes, buffer, .. } = ROWS[row];
        if let Some(usage) = buffer {
            let mut bit = 0;
            while bit < 64 {
                if (reads.bits() | writes.bits()) >> bit & 1 == 1 {
                    usages[bit] = usages[bit].union(usage);
                }
                bit += 1;
            }
            let core = usage.intersection(BufferUsage::CORE);
            let any = [(reads, Accesses::MEMORY_READ), (writes, Accesses::MEMORY_WRITE)];
            let mut which = 0;
            while which < any.len() {
                if !any[which].0.is_empty() {
                    let bit = any[which].1.bits().trailing_zeros() as usize;
                    usages[bit] = usages[bit].union(core);
                }
                which += 1;
            }
        }
        row += 1;
    }
    usages
};

/// The rows stand in the order of the kinds.
const _: () = {
    let mut row = 0;
    while row < ROWS.len() {
        assert!(ROWS[row].kind as usize == row);
        row += 1;
    }
    assert!(AccessKind::Host as usize + 1 == ROWS.len());
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_access_but_those_to_any_memory_stands_in_one_row() {
        for access in Accesses::all().difference(Accesses::MEMORY).iter() {
            assert_eq!(rows_of(access).count(), 1, "{access:?}");
        }
        for row in AccessKind::TABLE {
            assert!(Accesses::WRITES.contains(row.writes) && !Accesses::WRITES.intersects(row.reads), "{row:?}");
        }
    }

    #[test]
    fn accesses_to_any_memory_need_each_usage_that_no_extension_brings() {
        let any = Accesses::MEMORY_READ.buffer_usage() | Accesses::MEMORY_WRITE.buffer_usage();
        assert_eq!(any, BufferUsage::CORE);
        assert!(!Accesses::MEMORY_READ.buffer_usage().contains(BufferUsage::TRANSFER_DST));
    }
}
