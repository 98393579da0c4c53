//! How several samples become one value: those of an image (`resolve`), or of all depth of a pipeline (`depth`).

use super::Diagnostic;
use super::forms::{Form, Word, Words};
use super::leaf::{Leaf, Shape};
use super::pipeline::{SettingKind, Spanned};
use super::reader::Reader;
use super::resources::{Resolve, Resolves};
use super::scope::{Quoted, Scope, joined};
use super::values::Decided;
use crate::expression::{Value, Wanted};
use crate::vocabulary::ResolveMode;
use std::sync::Arc;

/// How several samples of an image become one value.
pub(super) const RESOLVE: Form = Form::Words(&RESOLVES);

/// How several samples of depth become one value, of images that don't say it.
pub(super) const DEPTH: Form = Form::Words(&POLICIES);

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
        Word::alone("Average", "The mean of all samples. That of colour, which has no other way."),
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

/// What each word stands for.
const MEANINGS: [(&str, Resolve); 5] = [
    ("DepthOnly", Resolve::DepthOnly),
    ("SampleZero", Resolve::By(ResolveMode::SampleZero)),
    ("Min", Resolve::By(ResolveMode::Min)),
    ("Max", Resolve::By(ResolveMode::Max)),
    ("Average", Resolve::By(ResolveMode::Average)),
];

/// What an image's `resolve` says.
pub(super) fn lower(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'_>) -> Option<Resolves> {
    let (word, because) = word(reader, scope, leaf, &RESOLVES)?;
    let (word, resolve) = MEANINGS.into_iter().find(|(known, _)| *known == word)?;
    Some(Resolves { resolve: Spanned { value: resolve, span: leaf.span() }, said: said("resolve", word, because) })
}

/// What a pipeline's `depth` says; `None` for what is so without it.
pub(super) fn policy(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'_>) -> Option<Option<Resolves>> {
    let (word, because) = word(reader, scope, leaf, &POLICIES)?;
    if word == "Exact" {
        return Some(None);
    }
    let resolve = Spanned { value: Resolve::By(ResolveMode::SampleZero), span: leaf.span() };
    Some(Some(Resolves { resolve, said: said("depth", word, because) }))
}

fn said(field: &str, word: &str, because: Option<Arc<str>>) -> Arc<str> {
    let because = because.map(|because| format!(" ({because})")).unwrap_or_default();
    format!("`{field}: {word}`{because}").into()
}

/// One of several words that take nothing, or a setting or expression that says one.
fn word<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    words: &'static Words,
) -> Option<Decided<&'static str>> {
    let Shape::Text = leaf.shape() else {
        let (word, rest) = reader.one_of(leaf, words)?;
        return reader.bare(word, rest).map(|()| (word, None));
    };
    let fits = |kind: &SettingKind| matches!(kind, SettingKind::Choice { .. });
    let (value, because) = match scope.quoted(reader, leaf, fits, "a text")? {
        Quoted::Given(parameter, given) => {
            if scope.known.settings
                && let Some(odd) = parameter.texts().iter().find(|text| words.find(text).is_none())
            {
                let message = format!("this setting allows `{}`, which is not {}", odd, words.what);
                reader.wrong(leaf, message, &words.forms());
                return None;
            }
            (given.value.clone(), scope.because(parameter, given))
        }
        Quoted::Expression => {
            let outcome = scope.evaluate(reader, leaf, Wanted::TEXT)?;
            let because = joined(&outcome.decided);
            (outcome.value, because)
        }
    };
    let Value::Text(text) = value else { return None };
    match words.find(&text) {
        Some(known) => Some((known.word, because)),
        None => {
            let wrong = Diagnostic::new(leaf.span(), format!("`{}` is not {}", text, words.what));
            let wrong = wrong.remark(because.as_deref().unwrap_or_default()).help(words.forms());
            scope.fault(reader, leaf, wrong);
            None
        }
    }
}
