//! States in which images and buffers come in and go out: what the words mean, and what contradicts itself.

use crate::describe::{Diagnostic, Spanned, State as Described, StateWord};
use crate::format::Format;
use crate::vocabulary::{Accesses, Aspects, Layout, Stages, State};

/// When something is in a state.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum When {
    /// When it is handed in.
    Before,
    /// When it is left.
    After,
}

/// What is in a state.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub(super) name: &'a str,
    /// Of an image; `None`: a buffer.
    pub(super) format: Option<Format>,
    pub(super) samples: u32,
}

const SHADERS: Stages = Stages::VERTEX_SHADER.union(Stages::FRAGMENT_SHADER).union(Stages::COMPUTE_SHADER);
const TESTS: Stages = Stages::EARLY_FRAGMENT_TESTS.union(Stages::LATE_FRAGMENT_TESTS);
const TRANSFERS: Stages = Stages::COPY.union(Stages::BLIT).union(Stages::RESOLVE).union(Stages::CLEAR);
const MEMORY: Accesses = Accesses::MEMORY_READ.union(Accesses::MEMORY_WRITE);

/// The state that the file asks for, or `None` after a mistake was reported.
pub(super) fn lower(
    state: Spanned<Described>,
    of: Subject<'_>,
    when: When,
    errors: &mut Vec<Diagnostic>,
) -> Option<State> {
    let lowered = match state.value {
        Described::Word(word) => meaning(word, of.format, when),
        Described::Named(state) => state,
    };
    let Some((message, help)) = contradiction(&lowered, of, when) else { return Some(lowered) };
    errors.push(Diagnostic::new(state.span, message).help(help));
    None
}

/// What a word stands for.
fn meaning(word: StateWord, format: Option<Format>, when: When) -> State {
    let depth = format.is_some_and(Format::is_depth);
    let (stages, accesses, layout) = match word {
        StateWord::Undefined => (Stages::empty(), Accesses::empty(), Layout::Undefined),
        StateWord::ColorAttachment => (
            Stages::COLOR_ATTACHMENT_OUTPUT,
            Accesses::COLOR_ATTACHMENT_READ | Accesses::COLOR_ATTACHMENT_WRITE,
            Layout::ColorAttachmentOptimal,
        ),
        StateWord::DepthAttachment => (
            TESTS,
            Accesses::DEPTH_STENCIL_ATTACHMENT_READ | Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE,
            Layout::DepthStencilAttachmentOptimal,
        ),
        StateWord::Sampled if depth => (SHADERS, Accesses::SHADER_SAMPLED_READ, Layout::DepthStencilReadOnlyOptimal),
        StateWord::Sampled => (SHADERS, Accesses::SHADER_SAMPLED_READ, Layout::ShaderReadOnlyOptimal),
        StateWord::Storage => {
            (SHADERS, Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE, Layout::General)
        }
        StateWord::Uniform => (SHADERS, Accesses::UNIFORM_READ, Layout::Undefined),
        StateWord::Vertex => (Stages::VERTEX_INPUT, Accesses::VERTEX_ATTRIBUTE_READ, Layout::Undefined),
        StateWord::Index => (Stages::VERTEX_INPUT, Accesses::INDEX_READ, Layout::Undefined),
        StateWord::Indirect => (Stages::DRAW_INDIRECT, Accesses::INDIRECT_COMMAND_READ, Layout::Undefined),
        StateWord::TransferSource => {
            let stages = Stages::COPY | Stages::BLIT | Stages::RESOLVE;
            (stages, Accesses::TRANSFER_READ, Layout::TransferSrcOptimal)
        }
        StateWord::TransferTarget => (TRANSFERS, Accesses::TRANSFER_WRITE, Layout::TransferDstOptimal),
        StateWord::Present => (Stages::empty(), Accesses::empty(), Layout::PresentSrcKhr),
        StateWord::Host if when == When::Before => (Stages::HOST, Accesses::HOST_WRITE, Layout::Undefined),
        StateWord::Host => (Stages::HOST, Accesses::HOST_READ, Layout::Undefined),
    };
    State { stages, accesses, layout: if format.is_some() { layout } else { Layout::Undefined } }
}

/// Why nothing of this kind can be in this state, and what would be right.
fn contradiction(state: &State, of: Subject<'_>, when: When) -> Option<(String, String)> {
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
    layout(state, name, format, of.samples, when)
}

fn layout(state: &State, name: &str, format: Format, samples: u32, when: When) -> Option<(String, String)> {
    let shown = crate::plan::names::vulkan(&state.layout);
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
        Layout::RenderingLocalReadKhr => (
            true,
            Accesses::COLOR_ATTACHMENT_READ
                | Accesses::COLOR_ATTACHMENT_WRITE
                | Accesses::DEPTH_STENCIL_ATTACHMENT_READ
                | Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE
                | Accesses::INPUT_ATTACHMENT_READ,
        ),
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
