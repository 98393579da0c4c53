//! States in which images and buffers come in and go out: the meaning of the words.

use crate::base::{Code, Diagnostic};
use crate::language::State as Described;
use crate::ron::Spanned;
use crate::vulkan::states::{StateTime, Subject, contradiction};
use crate::vulkan::{AccessKind, Format, Layout, State};

/// The state that the file asks for, or `None` after a mistake was reported.
pub(in crate::expand) fn lower(
    state: Spanned<Described>,
    of: Subject<'_>,
    when: StateTime,
    errors: &mut Vec<Diagnostic>,
) -> Option<State> {
    let lowered = match state.value {
        Described::Word(word) => meaning(word, of.format, when),
        Described::Named(state) => state,
    };
    let Some((message, help)) = contradiction(&lowered, of, when) else { return Some(lowered) };
    errors.push(Diagnostic::new(Code::STATE_UNFIT, state.span, message).help(help));
    None
}

/// The state that a word stands for. The program writes a buffer before the frame, and reads it afterwards.
fn meaning(word: AccessKind, format: Option<Format>, when: StateTime) -> State {
    let layout = match format {
        None => Layout::Undefined,
        Some(format) if format.is_depth() && word == AccessKind::Sampled => Layout::DepthStencilReadOnlyOptimal,
        Some(_) => word.layout(),
    };
    let host = word == AccessKind::Host;
    let accesses = word.accesses(!host || when == StateTime::After, !host || when == StateTime::Before);
    State { stages: word.stages(), accesses, layout }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vulkan::access::StateSubject;

    #[test]
    fn something_can_be_in_the_state_of_each_word() {
        for (kind, word) in AccessKind::TABLE.iter().filter_map(|row| Some((row.kind, row.word?))) {
            for of in word.of {
                let formats = match of {
                    StateSubject::Image => &[Some(Format::R8G8B8A8_UNORM), Some(Format::D32_SFLOAT)][..],
                    StateSubject::Buffer => &[None],
                };
                let wrong = |format: &Option<Format>| {
                    let subject = Subject { name: "it", format: *format, samples: 1 };
                    contradiction(&meaning(kind, *format, StateTime::Before), subject, StateTime::Before)
                };
                let wrong: Vec<_> = formats.iter().map(wrong).collect();
                assert!(wrong.contains(&None), "{}, of {of:?}: {wrong:?}", word.word);
            }
        }
    }
}
