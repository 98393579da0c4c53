//! Lifetimes of contents, and the states in which they come in and go out.

use super::list;
use super::parts::{self, MOST_FRAMES};
use super::values::{self, at, optional};
use crate::base::Code;
use crate::fields;
use crate::language::model::{Lifetime, State};
use crate::language::scope::{Context, FieldValue, combined};
use crate::ron::{FieldTable, Form, Leaf, Reader, Shape, Spanned, Word, WordContents, Words};
use crate::vulkan::access::{StateSubject, StateWord};
use crate::vulkan::layout::LAYOUTS;
use crate::vulkan::{self, AccessKind, Accesses, Layout, OutsideOwner, Stages};
use bitflags::Flags;

fields! {
    /// The fields of `Persistent`: contents that outlive the frame.
    #[derive(Default)]
    struct PersistentFields<'src> {
        /// The contents in the first frame, as in [a fill](#fills); zero if left out.
        initial: Option<Leaf<'src>> => values::FILL,
    }
}

fields! {
    /// The fields of `History`: contents of earlier frames.
    #[derive(Default)]
    struct HistoryFields<'src> {
        /// How many frames back the contents can be read; 1 if left out.
        frames: Option<Leaf<'src>> => Form::Whole(1, MOST_FRAMES),
        /// The contents of frames before the first, as in [a fill](#fills); zero if left out.
        initial: Option<Leaf<'src>> => values::FILL,
    }
}

fields! {
    /// The fields of `Imported`: states of an image or buffer that the program hands in.
    struct ImportedFields<'src> {
        /// The state in which it is handed in.
        before: Leaf<'src> => STATE,
        /// The state in which it is given back; the state of its last use if left out.
        after: Option<Leaf<'src>> => STATE,
        /// Who else than the device has it between frames: `External`, another device of Vulkan by the same driver, or `Foreign`, anything else,
        /// as a camera or a compositor. The frame takes it over and gives it back; nobody if left out.
        owner: Option<Leaf<'src>> => OWNER,
    }
}

fields! {
    /// A state in Vulkan's words: the last use before the frame, or the next use after it.
    /// ```ron
    /// (stages: [COPY], accesses: [TRANSFER_WRITE], layout: TRANSFER_DST_OPTIMAL)
    /// ```
    struct StateFields<'src> {
        /// Pipeline stages: `VK_PIPELINE_STAGE_2_…`.
        stages: Leaf<'src> => STAGES,
        /// Accesses: `VK_ACCESS_2_…`.
        accesses: Leaf<'src> => ACCESSES,
        /// The layout of an image, `VK_IMAGE_LAYOUT_…`; a buffer has none.
        layout: Option<Leaf<'src>> => LAYOUT,
    }
}

/// Pipeline stages, by Vulkan's names.
pub(crate) const STAGES: Form = Form::List(&Form::Choice("a Vulkan stage", flag_names::<Stages>));

/// Accesses, by Vulkan's names.
pub(crate) const ACCESSES: Form = Form::List(&Form::Choice("a Vulkan access", flag_names::<Accesses>));

/// A layout of images, by Vulkan's name.
pub(crate) const LAYOUT: Form = Form::Choice("an image layout", || layouts().map(|(name, _)| name).collect());

/// An outside owner.
const OWNER: Form = Form::Choice("an outside owner", || OutsideOwner::ALL.iter().map(|owner| owner.word()).collect());

/// The form of `lifetime`.
pub(crate) const LIFETIME: Form = Form::Words(&LIFETIMES);

static LIFETIMES: Words = Words {
    name: "Lifetime",
    what: "a lifetime",
    or: &[],
    all: &[
        Word::alone("Transient", "Within the frame."),
        Word::new(
            "Persistent",
            &[WordContents::Nothing, WordContents::Fields(PersistentFields::<'static>::table)],
            &["Persistent", "Persistent(initial: 1.0)"],
            "One image or buffer for all frames: a read before the first write finds what the frame before left.",
        ),
        Word::new(
            "History",
            &[WordContents::Nothing, WordContents::Fields(HistoryFields::<'static>::table)],
            &["History", "History(frames: 2, initial: 0)"],
            "Each frame writes it anew; `previous: 1` reads what the frame before left.",
        ),
        Word::new(
            "Imported",
            &[WordContents::Fields(ImportedFields::<'static>::table)],
            &["Imported(before: Undefined, after: Sampled)"],
            "The program hands it in for each frame, and gets it back.",
        ),
        Word::new(
            "Like",
            &[WordContents::Values(&[parts::WHOLE_RESOURCE])],
            &["Like(\"name\")"],
            "The lifetime of another image or buffer.",
        ),
    ],
};

/// A state, by purpose or in Vulkan's words.
pub(crate) const STATE: Form = Form::Words(&STATES);

static STATES: Words =
    Words { name: "State", what: "a state", or: &[Form::Fields(StateFields::<'static>::table)], all: &STATE_WORDS };

/// How many kinds of access have a word.
const WORDS: usize = {
    let (mut words, mut at) = (0, 0);
    while at < AccessKind::TABLE.len() {
        words += AccessKind::TABLE[at].word.is_some() as usize;
        at += 1;
    }
    words
};

const STATE_WORDS: [Word; WORDS] = {
    let mut words = [const { Word::alone("", "") }; WORDS];
    let (mut to, mut at) = (0, 0);
    while at < AccessKind::TABLE.len() {
        if let Some(state) = AccessKind::TABLE[at].word {
            words[to] = Word::alone(state.word, state.about);
            to += 1;
        }
        at += 1;
    }
    words
};

/// Vulkan's words for flags.
fn flag_names<F: Flags>() -> Vec<&'static str> {
    F::FLAGS.iter().filter(|flag| !flag.is_unnamed()).map(|flag| flag.name()).collect()
}

impl Context<'_> {
    /// A lifetime.
    pub(crate) fn lifetime(&mut self, leaf: Leaf<'_>, of: StateSubject) -> Option<FieldValue<Spanned<Lifetime>>> {
        let (word, rest) = self.reader.one_of(leaf, &LIFETIMES)?;
        let lifetime = match word {
            "Transient" => self.reader.bare(word, rest).map(|()| FieldValue::Constant(Lifetime::Transient))?,
            "Persistent" => {
                let fields: PersistentFields<'_> = list::within(self.reader, leaf, rest, "Persistent(initial: …)")?;
                let initial = optional(fields.initial, |leaf| self.fill(leaf));
                combined(initial?, |initial| Lifetime::Persistent { initial })
            }
            "History" => {
                let fields: HistoryFields<'_> =
                    list::within(self.reader, leaf, rest, "History(frames: 1, initial: …)")?;
                let frames = fields.frames.map_or(Some(FieldValue::Constant(1)), |frames| {
                    self.whole(frames, "number of frames to look back", 1..=MOST_FRAMES)
                });
                let initial = optional(fields.initial, |leaf| self.fill(leaf));
                combined((frames?, initial?), |(frames, initial)| Lifetime::History { frames, initial })
            }
            "Imported" => {
                let fields: ImportedFields<'_> = self.reader.inside(leaf, rest, "Imported(before: …, after: …)")?;
                let before = state(self.reader, fields.before, of);
                let after = optional(fields.after, |after| state(self.reader, after, of));
                let owner = optional(fields.owner, |owner| self.reader.choice(owner, "an outside owner", &owners()));
                FieldValue::Constant(Lifetime::Imported { before: before?, after: after?, owner: owner? })
            }
            _ => {
                let [other]: [Leaf<'_>; 1] = self.reader.inside(leaf, rest, "Like(\"name\")")?;
                self.resource(other)?.map(Lifetime::Like)
            }
        };
        Some(at(leaf, lifetime))
    }
}

/// The outside owners, by their words.
fn owners() -> [(&'static str, OutsideOwner); 2] {
    OutsideOwner::ALL.map(|owner| (owner.word(), owner))
}

/// The layouts, by Vulkan's names.
fn layouts() -> impl Iterator<Item = (&'static str, Layout)> {
    LAYOUTS.iter().map(|row| (row.name, row.layout))
}

/// A state, by purpose or in Vulkan's words.
pub(crate) fn state<'src>(reader: &mut Reader, leaf: Leaf<'src>, of: StateSubject) -> Option<Spanned<State>> {
    if let Shape::Parentheses = leaf.shape() {
        let fields: StateFields<'_> = reader.read(leaf, "a state")?;
        let leaves = StateLeaves { stages: fields.stages, accesses: fields.accesses, layout: fields.layout };
        let state = named_state(reader, leaf, leaves, of)?;
        return Some(leaf.spanned(State::Named(state)));
    }
    let words = || AccessKind::TABLE.iter().filter_map(|row| row.word.map(|word| (word, row.kind)));
    let fits = |(word, _): &(StateWord, AccessKind)| word.of.contains(&of);
    let known: Vec<&'static str> = words().map(|(word, _)| word.word).collect();
    let fitting: Vec<String> = words().filter(fits).map(|(word, _)| format!("`{}`", word.word)).collect();
    let layout = if of == StateSubject::Image { ", layout: …" } else { "" };
    let forms = format!("write {} or `(stages: […], accesses: […]{layout})`", fitting.join(", "));
    let (word, rest) = reader.word(leaf, "a state", &known, &forms)?;
    reader.bare(word, rest)?;
    let Some((_, kind)) = words().filter(fits).find(|(fitting, _)| fitting.word == word) else {
        let whose = if of == StateSubject::Image { "an image" } else { "a buffer" };
        reader.wrong(Code::STATE_UNFIT, leaf, format!("{whose} can't be in the state `{word}`"), &forms);
        return None;
    };
    Some(leaf.spanned(State::Word(kind)))
}

/// The parts of a state in Vulkan's words.
#[derive(Clone, Copy)]
pub(crate) struct StateLeaves<'src> {
    pub(crate) stages: Leaf<'src>,
    pub(crate) accesses: Leaf<'src>,
    pub(crate) layout: Option<Leaf<'src>>,
}

/// A state in Vulkan's words. `whole`: all that says it.
pub(crate) fn named_state<'src>(
    reader: &mut Reader,
    whole: Leaf<'src>,
    leaves: StateLeaves<'src>,
    of: StateSubject,
) -> Option<vulkan::State> {
    let stages = flags::<Stages>(reader, leaves.stages, "`stages`", "a pipeline stage");
    let accesses = flags::<Accesses>(reader, leaves.accesses, "`accesses`", "an access");
    let layout = match (leaves.layout, of) {
        (Some(layout), StateSubject::Buffer) => {
            reader.wrong(Code::STATE_UNFIT, layout, "a buffer has no layout", "");
            None
        }
        (Some(layout), StateSubject::Image) => reader.choice(layout, "an image layout", &layouts().collect::<Vec<_>>()),
        (None, StateSubject::Buffer) => Some(Layout::Undefined),
        (None, StateSubject::Image) => {
            reader.wrong(Code::STATE_UNFIT, whole, "the state of an image has a layout", "add `layout: …`");
            None
        }
    };
    Some(vulkan::State { stages: stages?, accesses: accesses?, layout: layout? })
}

/// A list of Vulkan's words.
fn flags<'src, F: Flags + Copy>(reader: &mut Reader, leaf: Leaf<'src>, field: &str, what: &str) -> Option<F> {
    let choices: Vec<(&'static str, F)> =
        F::FLAGS.iter().filter(|flag| !flag.is_unnamed()).map(|flag| (flag.name(), *flag.value())).collect();
    let mut all = F::empty();
    let mut complete = true;
    for entry in reader.list(leaf, field)? {
        match reader.choice(entry, what, &choices) {
            Some(flag) => all = all.union(flag),
            None => complete = false,
        }
    }
    complete.then_some(all)
}
