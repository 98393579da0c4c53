//! How long contents live, and in which state they come in and go out.

use super::fields::FromLeaf;
use super::leaf::{Leaf, Shape};
use super::parts::MOST_FRAMES;
use super::reader::Reader;
use super::resources::{Fill, Lifetime, State, StateWord};
use super::scope::Scope;
use super::{Spanned, values};
use crate::fields;
use crate::vocabulary::{self, Accesses, Layout, Stages};
use bitflags::Flags;

fields! {
    #[derive(Default)]
    struct PersistentFields<'src> {
        initial: Option<Leaf<'src>>,
    }
}

fields! {
    #[derive(Default)]
    struct HistoryFields<'src> {
        frames: Option<Leaf<'src>>,
        initial: Option<Leaf<'src>>,
    }
}

fields! {
    struct ImportedFields<'src> {
        before: Leaf<'src>,
        after: Option<Leaf<'src>>,
    }
}

fields! {
    struct StateFields<'src> {
        stages: Leaf<'src>,
        accesses: Leaf<'src>,
        layout: Option<Leaf<'src>>,
    }
}

const LIFETIMES: &str = "a lifetime is `Transient`, `Persistent(initial: …)`, `History(frames: 1, initial: …)`, \
                         `Imported(before: …, after: …)` or `Like(\"name\")`";

/// Which of the two a state belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    /// An image.
    Image,
    /// A buffer.
    Buffer,
}

/// A lifetime.
pub(super) fn lower<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    of: Of,
) -> Option<Spanned<Lifetime>> {
    let words = ["Transient", "Persistent", "History", "Imported", "Like"];
    let (word, rest) = reader.word(leaf, "a lifetime", &words, LIFETIMES)?;
    let lifetime = match word {
        "Transient" => reader.bare(word, rest).map(|()| Lifetime::Transient)?,
        "Persistent" => {
            let fields: PersistentFields<'_> = within(reader, leaf, rest, "Persistent(initial: …)")?;
            Lifetime::Persistent { initial: initial(reader, scope, fields.initial)? }
        }
        "History" => {
            let fields: HistoryFields<'_> = within(reader, leaf, rest, "History(frames: 1, initial: …)")?;
            let frames = match fields.frames {
                Some(frames) => values::whole(reader, scope, frames, "number of frames to look back", 1..=MOST_FRAMES),
                None => Some(1),
            };
            let initial = initial(reader, scope, fields.initial);
            Lifetime::History { frames: frames?, initial: initial? }
        }
        "Imported" => {
            let fields: ImportedFields<'_> = reader.inside(leaf, rest, "Imported(before: …, after: …)")?;
            let before = state(reader, fields.before, of);
            let after = match fields.after {
                Some(after) => state(reader, after, of).map(Some),
                None => Some(None),
            };
            Lifetime::Imported { before: before?, after: after? }
        }
        _ => {
            let [other]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Like(\"name\")")?;
            Lifetime::Like(scope.resource(reader, other)?)
        }
    };
    Some(leaf.spanned(lifetime))
}

/// What stands in parentheses, if there are any.
fn within<'src, T: FromLeaf<'src> + Default>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    rest: Option<Leaf<'src>>,
    form: &str,
) -> Option<T> {
    match rest {
        Some(_) => reader.inside(leaf, rest, form),
        None => Some(T::default()),
    }
}

fn initial<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Option<Leaf<'src>>) -> Option<Option<Spanned<Fill>>> {
    let Some(leaf) = leaf else { return Some(None) };
    let value = values::fill(reader, scope, leaf)?;
    Some(Some(leaf.spanned(value)))
}

const WORDS: [(&str, StateWord); 13] = [
    ("Undefined", StateWord::Undefined),
    ("ColorAttachment", StateWord::ColorAttachment),
    ("DepthAttachment", StateWord::DepthAttachment),
    ("Sampled", StateWord::Sampled),
    ("Storage", StateWord::Storage),
    ("Uniform", StateWord::Uniform),
    ("Vertex", StateWord::Vertex),
    ("Index", StateWord::Index),
    ("Indirect", StateWord::Indirect),
    ("TransferSource", StateWord::TransferSource),
    ("TransferTarget", StateWord::TransferTarget),
    ("Present", StateWord::Present),
    ("Host", StateWord::Host),
];

const LAYOUTS: [(&str, Layout); 14] = [
    ("UNDEFINED", Layout::Undefined),
    ("GENERAL", Layout::General),
    ("COLOR_ATTACHMENT_OPTIMAL", Layout::ColorAttachmentOptimal),
    ("DEPTH_STENCIL_ATTACHMENT_OPTIMAL", Layout::DepthStencilAttachmentOptimal),
    ("DEPTH_STENCIL_READ_ONLY_OPTIMAL", Layout::DepthStencilReadOnlyOptimal),
    ("DEPTH_ATTACHMENT_OPTIMAL", Layout::DepthAttachmentOptimal),
    ("DEPTH_READ_ONLY_OPTIMAL", Layout::DepthReadOnlyOptimal),
    ("STENCIL_ATTACHMENT_OPTIMAL", Layout::StencilAttachmentOptimal),
    ("STENCIL_READ_ONLY_OPTIMAL", Layout::StencilReadOnlyOptimal),
    ("SHADER_READ_ONLY_OPTIMAL", Layout::ShaderReadOnlyOptimal),
    ("TRANSFER_SRC_OPTIMAL", Layout::TransferSrcOptimal),
    ("TRANSFER_DST_OPTIMAL", Layout::TransferDstOptimal),
    ("PRESENT_SRC_KHR", Layout::PresentSrcKhr),
    ("RENDERING_LOCAL_READ_KHR", Layout::RenderingLocalReadKhr),
];

impl StateWord {
    /// Whether an image, and whether a buffer can be in it.
    const fn fits(self, of: Of) -> bool {
        match self {
            StateWord::Storage | StateWord::TransferSource | StateWord::TransferTarget => true,
            StateWord::Uniform | StateWord::Vertex | StateWord::Index | StateWord::Indirect | StateWord::Host => {
                matches!(of, Of::Buffer)
            }
            StateWord::Undefined
            | StateWord::ColorAttachment
            | StateWord::DepthAttachment
            | StateWord::Sampled
            | StateWord::Present => matches!(of, Of::Image),
        }
    }
}

/// A state, by purpose or in Vulkan's words.
pub(super) fn state<'src>(reader: &mut Reader, leaf: Leaf<'src>, of: Of) -> Option<Spanned<State>> {
    if let Shape::Parentheses = leaf.shape() {
        let fields: StateFields<'_> = reader.read(leaf, "a state")?;
        let stages = flags::<Stages>(reader, fields.stages, "`stages`", "a pipeline stage");
        let accesses = flags::<Accesses>(reader, fields.accesses, "`accesses`", "an access");
        let layout = match (fields.layout, of) {
            (Some(layout), Of::Buffer) => {
                reader.wrong(layout, "a buffer has no layout", "");
                None
            }
            (Some(layout), Of::Image) => values::choice(reader, layout, "an image layout", &LAYOUTS),
            (None, Of::Buffer) => Some(Layout::Undefined),
            (None, Of::Image) => {
                reader.wrong(leaf, "the state of an image has a layout", "add `layout: …`");
                None
            }
        };
        let state = vocabulary::State { stages: stages?, accesses: accesses?, layout: layout? };
        return Some(leaf.spanned(State::Named(state)));
    }
    let fitting: Vec<(&'static str, StateWord)> = WORDS.into_iter().filter(|(_, word)| word.fits(of)).collect();
    let known: Vec<&'static str> = WORDS.iter().map(|(word, _)| *word).collect();
    let words: Vec<&str> = fitting.iter().map(|(word, _)| *word).collect();
    let forms = format!("write {}, or `(stages: […], accesses: […], layout: …)`", words.join(", "));
    let (word, rest) = reader.word(leaf, "a state", &known, &forms)?;
    reader.bare(word, rest)?;
    let Some((_, word)) = fitting.into_iter().find(|(fitting, _)| *fitting == word) else {
        let whose = if of == Of::Image { "an image" } else { "a buffer" };
        reader.wrong(leaf, format!("{whose} can't be in the state `{word}`"), &forms);
        return None;
    };
    Some(leaf.spanned(State::Word(word)))
}

/// A list of Vulkan's words.
fn flags<'src, F: Flags + Copy>(reader: &mut Reader, leaf: Leaf<'src>, field: &str, what: &str) -> Option<F> {
    let choices: Vec<(&'static str, F)> =
        F::FLAGS.iter().filter(|flag| !flag.is_unnamed()).map(|flag| (flag.name(), *flag.value())).collect();
    let mut all = F::empty();
    let mut complete = true;
    for entry in reader.list(leaf, field)? {
        match values::choice(reader, entry, what, &choices) {
            Some(flag) => all = all.union(flag),
            None => complete = false,
        }
    }
    complete.then_some(all)
}
