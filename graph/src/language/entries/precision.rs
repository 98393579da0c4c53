//! The precision of formats that are chosen by purpose: of colour (`color`) and of depth (`depth_format`).

use super::values::said;
use crate::language::model::{Decided, Precision, Precisions};
use crate::language::scope::{Context, FieldValue};
use crate::ron::{Form, Leaf, Word, Words};

/// The form of `color`: the precision of `Color`.
pub(crate) const COLOR: Form = Form::Words(&COLORS);

/// The form of `depth_format`: the precision of `Depth` and `DepthStencil`.
pub(crate) const DEPTH: Form = Form::Words(&DEPTHS);

static COLORS: Words = Words {
    name: "ColorPolicy",
    what: "a policy",
    or: &[Form::Expression("a text with one of these words")],
    all: &[
        Word::alone(
            "Smallest",
            "With high dynamic range `B10G11R11_UFLOAT_PACK32`, which holds steps of about 1/64 of a value, nothing negative and no \
             alpha; else `R8G8B8A8_SRGB`.",
        ),
        Word::alone("Balanced", "With high dynamic range `R16G16B16A16_SFLOAT`, else `R8G8B8A8_SRGB`."),
        Word::alone("Exact", "With high dynamic range `R32G32B32A32_SFLOAT`, else `R16G16B16A16_UNORM`."),
    ],
};

static DEPTHS: Words = Words {
    name: "DepthFormatPolicy",
    what: "a policy",
    or: &[Form::Expression("a text with one of these words")],
    all: &[
        Word::alone(
            "Smallest",
            "`D16_UNORM`, with stencil `D24_UNORM_S8_UINT`; finer if the scene reaches too far for it.",
        ),
        Word::alone(
            "Balanced",
            "`X8_D24_UNORM_PACK32`, with stencil `D24_UNORM_S8_UINT`; finer if the scene reaches too far for it.",
        ),
        Word::alone("Exact", "`D32_SFLOAT`; with stencil `D32_SFLOAT_S8_UINT`."),
    ],
};

/// The precision of each word.
const MEANINGS: [(&str, Precision); 3] =
    [("Smallest", Precision::Smallest), ("Balanced", Precision::Balanced), ("Exact", Precision::Exact)];

impl Context<'_> {
    /// The precision that a pipeline's `color` says.
    pub(crate) fn color_policy(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Precisions>> {
        self.precision(leaf, "color", &COLORS)
    }

    /// The precision that a pipeline's `depth_format` says.
    pub(crate) fn depth_format_policy(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Precisions>> {
        self.precision(leaf, "depth_format", &DEPTHS)
    }

    fn precision(
        &mut self,
        leaf: Leaf<'_>,
        field: &'static str,
        words: &'static Words,
    ) -> Option<FieldValue<Precisions>> {
        let span = leaf.span();
        self.bare_word(leaf, words)?.then(move |Decided { value: word, because, .. }| {
            let (_, precision) = MEANINGS.into_iter().find(|(known, _)| *known == word)?;
            Some(Precisions { precision, span, said: said(field, word, because) })
        })
    }
}
