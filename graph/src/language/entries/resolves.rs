//! How several samples become one value: in an image (`resolve`), or in all depth of a pipeline (`depth`).

use super::values;
use crate::frame::ResolveWay;
use crate::language::model::{Decided, Resolves};
use crate::language::scope::{Context, FieldValue};
use crate::ron::{Form, Leaf, Spanned, Word, Words};
use crate::vulkan::ResolveMode;

/// How several samples of an image become one value.
pub(crate) const RESOLVE: Form = Form::Words(&RESOLVES);

/// How several samples of depth become one value, in images without `resolve`.
pub(crate) const DEPTH: Form = Form::Words(&POLICIES);

static RESOLVES: Words = Words {
    name: "Resolve",
    what: "a way to resolve samples",
    or: &[Form::Expression("a text with one of these words")],
    all: &[
        Word::alone(
            "DepthOnly",
            "Whatever drew the depth is drawn again with one sample, and nothing but its depth: that of the middle of each \
             texel.",
        ),
        Word::alone("SampleZero", "The first sample. That of integers, which have no other way."),
        Word::alone("Min", "The least sample; of depth the farthest, since it is reversed."),
        Word::alone("Max", "The greatest sample; of depth the nearest, since it is reversed."),
        Word::alone("Average", "The mean of all samples. That of colour, if nothing is said."),
        Word::alone(
            "Weighted",
            "Of colour: the mean of tone-mapped samples, taken back to light, so that one bright sample doesn't drown the others. \
             By a draw.",
        ),
    ],
};

static POLICIES: Words = Words {
    name: "DepthPolicy",
    what: "a policy",
    or: &[Form::Expression("a text with one of these words")],
    all: &[
        Word::alone("Exact", "As `DepthOnly`."),
        Word::alone("Fastest", "As `SampleZero`: where the device can, at no cost but the memory."),
    ],
};

/// The way to resolve of each word.
const MEANINGS: [(&str, ResolveWay); 6] = [
    ("DepthOnly", ResolveWay::DepthOnly),
    ("SampleZero", ResolveWay::By(ResolveMode::SampleZero)),
    ("Min", ResolveWay::By(ResolveMode::Min)),
    ("Max", ResolveWay::By(ResolveMode::Max)),
    ("Average", ResolveWay::By(ResolveMode::Average)),
    ("Weighted", ResolveWay::Weighted),
];

impl Context<'_> {
    /// The way that an image's `resolve` says.
    pub(crate) fn resolve(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Resolves>> {
        let span = leaf.span();
        self.bare_word(leaf, &RESOLVES)?.then(move |Decided { value: word, because, .. }| {
            let (_, resolve) = MEANINGS.into_iter().find(|(known, _)| *known == word)?;
            Some(Resolves { resolve: Spanned { value: resolve, span }, said: values::said("resolve", word, because) })
        })
    }

    /// A pipeline's `depth`; `None`: `Exact`, the default.
    pub(crate) fn depth_policy(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Option<Resolves>>> {
        let resolve = leaf.spanned(ResolveWay::By(ResolveMode::SampleZero));
        Some(self.bare_word(leaf, &POLICIES)?.map(move |Decided { value: word, because, .. }| {
            let said = || values::said("depth", word, because);
            (word != "Exact").then(|| Resolves { resolve, said: said() })
        }))
    }
}
