//! Contradictions in the state in which an image or buffer comes in or goes out.

use super::{Accesses, Aspects, Format, Layout, Stages, State, Usage};

/// The time at which an image or buffer is in a state.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum When {
    /// When it is handed in.
    Before,
    /// When it is left.
    After,
}

/// The image or buffer that is in a state.
#[derive(Clone, Copy)]
pub(crate) struct Subject<'a> {
    pub(crate) name: &'a str,
    /// Of an image; `None`: a buffer.
    pub(crate) format: Option<Format>,
    pub(crate) samples: u32,
}

pub(crate) const SHADERS: Stages = Stages::VERTEX_SHADER.union(Stages::FRAGMENT_SHADER).union(Stages::COMPUTE_SHADER);
pub(crate) const TESTS: Stages = Stages::EARLY_FRAGMENT_TESTS.union(Stages::LATE_FRAGMENT_TESTS);
pub(crate) const TRANSFERS: Stages = Stages::COPY.union(Stages::BLIT).union(Stages::RESOLVE).union(Stages::CLEAR);
const MEMORY: Accesses = Accesses::MEMORY_READ.union(Accesses::MEMORY_WRITE);

/// The usage that an image must have to be in a layout.
pub(crate) fn usage_for(layout: Layout) -> Usage {
    match layout {
        Layout::Undefined | Layout::General | Layout::PresentSrcKhr => Usage::empty(),
        Layout::ColorAttachmentOptimal => Usage::COLOR_ATTACHMENT,
        Layout::DepthStencilAttachmentOptimal
        | Layout::DepthStencilReadOnlyOptimal
        | Layout::DepthAttachmentOptimal
        | Layout::DepthReadOnlyOptimal
        | Layout::StencilAttachmentOptimal
        | Layout::StencilReadOnlyOptimal => Usage::DEPTH_STENCIL_ATTACHMENT,
        Layout::ShaderReadOnlyOptimal => Usage::SAMPLED,
        Layout::TransferSrcOptimal => Usage::TRANSFER_SRC,
        Layout::TransferDstOptimal => Usage::TRANSFER_DST,
        Layout::RenderingLocalReadKhr => Usage::INPUT_ATTACHMENT,
    }
}

/// Why no image or buffer of this kind can be in this state, and the help.
pub(crate) fn contradiction(state: &State, of: Subject<'_>, when: When) -> Option<(String, String)> {
    let name = of.name;
    for (access, stages) in STAGES_OF {
        if state.accesses.contains(access) && !state.stages.intersects(stages | Stages::ALL_COMMANDS) {
            let message = format!("`{name}` can't have seen {} in these stages", words(access));
            return Some((message, format!("such an access happens in {}", words(stages))));
        }
    }
    let Some(format) = of.format else {
        let foreign = state.accesses.intersection(OF_IMAGES);
        let message = format!("`{name}` is a buffer and can't have seen {}", words(foreign));
        return (!foreign.is_empty()).then(|| (message, "name accesses of buffers".to_owned()));
    };
    let foreign = state.accesses.intersection(OF_BUFFERS);
    if !foreign.is_empty() {
        let message = format!("`{name}` is an image and can't have seen {}", words(foreign));
        return Some((message, "name accesses of images".to_owned()));
    }
    layout_contradiction(state, name, format, of.samples, when)
}

fn layout_contradiction(
    state: &State,
    name: &str,
    format: Format,
    samples: u32,
    when: When,
) -> Option<(String, String)> {
    let shown = super::name_of(&state.layout);
    let (depth, stencil) = (format.is_depth(), format.aspects().contains(Aspects::STENCIL));
    let (fits, allowed) = match state.layout {
        Layout::Undefined => {
            let message = format!("`{name}` can't be left in the layout UNDEFINED: its contents would be lost");
            return (when == When::After)
                .then(|| (message, "leave `after` out to keep it as its last use leaves it".to_owned()));
        }
        Layout::General => return None,
        Layout::ColorAttachmentOptimal => (!depth, Accesses::COLOR_ATTACHMENT_READ | Accesses::COLOR_ATTACHMENT_WRITE),
        Layout::DepthStencilAttachmentOptimal => {
            (depth, Accesses::DEPTH_STENCIL_ATTACHMENT_READ | Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE)
        }
        Layout::DepthAttachmentOptimal => {
            let accesses = Accesses::DEPTH_STENCIL_ATTACHMENT_READ | Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE;
            (depth && !stencil, accesses)
        }
        Layout::DepthStencilReadOnlyOptimal => (depth, READ_ONLY_DEPTH),
        Layout::DepthReadOnlyOptimal => (depth && !stencil, READ_ONLY_DEPTH),
        Layout::StencilAttachmentOptimal | Layout::StencilReadOnlyOptimal => (false, READ_ONLY_DEPTH),
        Layout::ShaderReadOnlyOptimal => (true, Accesses::SHADER_SAMPLED_READ | Accesses::INPUT_ATTACHMENT_READ),
        Layout::TransferSrcOptimal => (true, Accesses::TRANSFER_READ),
        Layout::TransferDstOptimal => (true, Accesses::TRANSFER_WRITE),
        Layout::PresentSrcKhr => (!depth && samples == 1, Accesses::empty()),
        // Attachments are in it within a frame alone.
        Layout::RenderingLocalReadKhr => (false, Accesses::INPUT_ATTACHMENT_READ),
    };
    if !fits {
        let planes = match (depth, stencil) {
            (true, true) => "depth and stencil",
            (true, false) => "depth",
            _ => "colour",
        };
        let several = if samples > 1 { format!(" with {samples} samples") } else { String::new() };
        let message = format!("`{name}` holds {planes} ({format}){several} and can't be in the layout {shown}");
        return Some((message, "a layout serves all planes of the image, and its samples".to_owned()));
    }
    let odd = state.accesses.difference(allowed | MEMORY);
    if odd.is_empty() {
        return None;
    }
    let message = format!("`{name}` can't have seen {} in the layout {shown}", words(odd));
    let help = if allowed.is_empty() {
        "no access happens in this layout".to_owned()
    } else {
        format!("accesses in this layout are {}", words(allowed))
    };
    Some((message, help))
}

const READ_ONLY_DEPTH: Accesses =
    Accesses::DEPTH_STENCIL_ATTACHMENT_READ.union(Accesses::SHADER_SAMPLED_READ).union(Accesses::INPUT_ATTACHMENT_READ);

const OF_IMAGES: Accesses = Accesses::COLOR_ATTACHMENT_READ
    .union(Accesses::COLOR_ATTACHMENT_WRITE)
    .union(READ_ONLY_DEPTH)
    .union(Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE);

const OF_BUFFERS: Accesses = Accesses::INDIRECT_COMMAND_READ
    .union(Accesses::INDEX_READ)
    .union(Accesses::VERTEX_ATTRIBUTE_READ)
    .union(Accesses::UNIFORM_READ);

/// In which stages accesses happen (Vulkan 1.3, table "Supported access types").
const STAGES_OF: [(Accesses, Stages); 17] = [
    (Accesses::INDIRECT_COMMAND_READ, Stages::DRAW_INDIRECT),
    (Accesses::INDEX_READ, Stages::VERTEX_INPUT),
    (Accesses::VERTEX_ATTRIBUTE_READ, Stages::VERTEX_INPUT),
    (Accesses::UNIFORM_READ, SHADERS),
    (Accesses::INPUT_ATTACHMENT_READ, Stages::FRAGMENT_SHADER),
    (Accesses::COLOR_ATTACHMENT_READ, Stages::COLOR_ATTACHMENT_OUTPUT),
    (Accesses::COLOR_ATTACHMENT_WRITE, Stages::COLOR_ATTACHMENT_OUTPUT),
    (Accesses::DEPTH_STENCIL_ATTACHMENT_READ, TESTS),
    (Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE, TESTS),
    (Accesses::TRANSFER_READ, TRANSFERS),
    (Accesses::TRANSFER_WRITE, TRANSFERS),
    (Accesses::HOST_READ, Stages::HOST),
    (Accesses::HOST_WRITE, Stages::HOST),
    (Accesses::SHADER_SAMPLED_READ, SHADERS),
    (Accesses::SHADER_STORAGE_READ, SHADERS),
    (Accesses::SHADER_STORAGE_WRITE, SHADERS),
    (MEMORY, Stages::all()),
];

/// The names of flags.
fn words<F: bitflags::Flags + Copy>(flags: F) -> String {
    let names: Vec<&str> = flags.iter_names().map(|(name, _)| name).collect();
    names.join(", ")
}
