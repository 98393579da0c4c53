//! States in which images and buffers come in and go out: the meaning of the words.

use crate::base::Diagnostic;
use crate::language::{State as Described, StateWord};
use crate::ron::Spanned;
use crate::vulkan::states::{SHADERS, Subject, TESTS, TRANSFERS, When, contradiction};
use crate::vulkan::{Accesses, Format, Layout, Stages, State};

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

/// The state that a word stands for.
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
