//! The state of an evaluation: its inputs, its purpose, and the lists that it has made so far.

use super::lists::FlatLists;
use super::memory::Memory;
use crate::base::{Code, Diagnostic, Span};
use crate::frame::{Cadence, ViewIndex};
use crate::language::entries::body::Body;
use crate::language::entries::fragments::Fragments;
use crate::language::entries::repeat::{MOST_THINGS, Repeat, Times};
use crate::language::entries::views::Views;
use crate::language::inputs::Surroundings;
use crate::language::model::{Decisions, PassDecisions};
use crate::language::scope::{DecidedValue, Elements, Evaluator, FieldValueTuple, LevelValues, ScopeValues};
use crate::ron::{Name, Reader};
use std::collections::HashSet;
use std::sync::Arc;

/// The purpose of an evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// The pipeline for one choice of values.
    Pipeline,
    /// A check of a file that was read: only mistakes are reported that don't depend on values. Entries that are repeated
    /// 0 times, or an unknown number of times, are evaluated once.
    Check,
    /// A check of fragments that are never used. Their images, buffers and passes are thrown away.
    CheckUnused,
}

/// A pipeline that is being evaluated.
pub(super) struct Evaluation<'a> {
    pub(super) purpose: Purpose,
    pub(super) surroundings: &'a Surroundings<'a>,
    pub(super) fragments: &'a Fragments<Body>,
    pub(super) views: Views<'a>,
    pub(super) flat: FlatLists,
    /// Fragments that are being put in, by number, and where.
    pub(super) path: Vec<(usize, Name)>,
    /// Mistakes in fragments that were reported: place and message.
    pub(super) reported: HashSet<(Span, String)>,
    /// Fragments that were put in, by number.
    pub(super) used: HashSet<usize>,
    /// What the last evaluation of the document made, if that is kept.
    pub(super) memory: Option<&'a mut Memory>,
    /// How many images, buffers, passes and uses of fragments were made.
    made: u32,
    /// Whether more were asked for than a pipeline may have.
    pub(super) is_full: bool,
}

/// A level that is being evaluated: the pipeline itself, or a fragment that is put in.
pub(super) struct Level<'b> {
    pub(super) body: &'b Body,
    pub(super) values: LevelValues,
    /// The beginning of the names of its images, buffers and passes: `glow.`.
    pub(super) prefix: Arc<str>,
    /// The view that it is for.
    pub(super) view: ViewIndex,
    /// The fragment's instance: a number in the list of them.
    pub(super) instance: Option<u32>,
    /// Whether it is off, so that an expression without a value is no mistake.
    pub(super) off: bool,
    /// The settings and facts that decided about its passes: those of the uses that it is within.
    pub(super) decided: PassDecisions,
    /// In which frames its passes run that don't say it themselves, if a use that it is within does.
    pub(super) run: Option<Cadence>,
    /// The settings and facts that decided how often an image is repeated, with the image's number in the body, in rising
    /// order.
    pub(super) repeats: Vec<(usize, Decisions)>,
}

/// How often an entry is repeated.
pub(super) enum Count {
    /// This often, which these settings and facts decided.
    Known(u32, Decisions),
    /// It depends on images whose properties aren't known yet.
    Later,
    /// A mistake in the number was reported.
    Failed,
}

impl<'b> Level<'b> {
    /// The pipeline itself, or a fragment by itself: for the main view.
    pub(super) fn top(body: &'b Body, values: Vec<Option<DecidedValue>>) -> Level<'b> {
        Level {
            body,
            values: below(body, values),
            prefix: "".into(),
            view: ViewIndex::default(),
            instance: None,
            off: false,
            decided: PassDecisions::default(),
            run: None,
            repeats: Vec::new(),
        }
    }

    /// A fragment that is put in under the name `whole`.
    pub(super) fn within(
        outer: &Level<'_>,
        (body, values): (&'b Body, Vec<Option<DecidedValue>>),
        (whole, view, instance): (&Name, ViewIndex, Option<u32>),
        off: bool,
        decided: &PassDecisions,
        run: Option<Cadence>,
    ) -> Level<'b> {
        let prefix = format!("{}.", whole.text).into();
        let (off, decided) = (outer.off || off, decided.within(&outer.decided));
        let run = run.or_else(|| outer.run.clone());
        Level { body, values: below(body, values), prefix, view, instance, off, decided, run, repeats: Vec::new() }
    }

    /// Whether its entries, or those with this number, are called as they were declared, and belong to no fragment.
    pub(super) fn has_own_names(&self, number: Option<u32>) -> bool {
        number.is_none() && self.prefix.is_empty() && self.instance.is_none()
    }

    /// A whole name: `glow.down[0]`.
    pub(super) fn full(&self, name: &Name, number: Option<u32>) -> Name {
        let prefix = &self.prefix;
        let text = match number {
            None if prefix.is_empty() => return name.clone(),
            None => format!("{prefix}{}", name.text),
            Some(number) => format!("{prefix}{}[{number}]", name.text),
        };
        Name { text: text.into(), span: name.span }
    }
}

/// Values of a level of which no image or buffer is evaluated yet.
fn below(body: &Body, values: Vec<Option<DecidedValue>>) -> LevelValues {
    let [images, buffers] = [body.images.len(), body.buffers.len()].map(|count| vec![Elements::Below; count]);
    LevelValues { values, images, buffers }
}

impl<'a> Evaluation<'a> {
    pub(super) fn new(purpose: Purpose, surroundings: &'a Surroundings<'a>, fragments: &'a Fragments<Body>) -> Self {
        Evaluation {
            purpose,
            surroundings,
            fragments,
            views: Views::none(),
            flat: FlatLists::default(),
            path: Vec::new(),
            reported: HashSet::new(),
            used: HashSet::new(),
            memory: None,
            made: 0,
            is_full: false,
        }
    }

    /// The evaluator of an entry of a level, for `view`; `index` is the number of the repetition.
    pub(super) fn evaluator<'s>(
        &'s self,
        reader: &'s mut Reader,
        level: &'s Level<'_>,
        view: ViewIndex,
        index: Option<u32>,
    ) -> Evaluator<'s, 's> {
        let scope = self.scope(level, view, index);
        Evaluator::new(reader, scope, level.off || self.purpose != Purpose::Pipeline)
    }

    /// The values of everything that an entry of a level may refer to.
    pub(super) fn scope<'s>(&'s self, level: &'s Level<'_>, view: ViewIndex, index: Option<u32>) -> ScopeValues<'s> {
        let inputs = self.views.inputs(view);
        ScopeValues {
            symbols: &level.body.symbols,
            level: &level.values,
            values: inputs
                .filter(|_| level.body.symbols.settings)
                .map_or(&level.values.values, |inputs| &inputs.values),
            surroundings: inputs.map_or(self.surroundings, |inputs| &inputs.surroundings),
            properties: Some(&self.flat.properties),
            images: &self.flat.images,
            index,
            view: self.views.name(view),
            answers: None,
        }
    }

    /// How often an entry is repeated; `early` puts off a number that depends on properties of images.
    pub(super) fn count(
        &mut self,
        reader: &mut Reader,
        level: &Level<'_>,
        view: ViewIndex,
        repeat: Option<&Repeat>,
        early: bool,
    ) -> Count {
        let is_check = self.purpose != Purpose::Pipeline;
        let (count, by, span) = match repeat {
            None | Some(Repeat::Once) => (1, Decisions::default(), None),
            Some(Repeat::Broken) => return Count::Failed,
            Some(Repeat::Times(times)) => {
                let Times { count, span, .. } = &**times;
                let before = reader.errors.len();
                let count = count.get(reader);
                let mut evaluator = self.evaluator(reader, level, view, None);
                evaluator.scope.properties = evaluator.scope.properties.filter(|_| !early);
                match count.and_then(|count| count.evaluate(&mut evaluator)) {
                    Some(number) => (number.value.max(u32::from(is_check)), number.by, Some(*span)),
                    None if reader.errors.len() > before => return Count::Failed,
                    None if early => return Count::Later,
                    None if is_check => (1, Decisions::default(), Some(*span)),
                    None => return Count::Failed,
                }
            }
        };
        if self.makes(reader, count, span.unwrap_or(Span::NONE)) { Count::Known(count, by) } else { Count::Failed }
    }

    /// Counts `count` more; `false` if that is more than a pipeline may have, which is reported once.
    fn makes(&mut self, reader: &mut Reader, count: u32, span: Span) -> bool {
        let made = self.made.saturating_add(count);
        if made <= MOST_THINGS {
            self.made = made;
            return true;
        }
        let was_full = std::mem::replace(&mut self.is_full, true);
        if !was_full && self.purpose != Purpose::CheckUnused {
            let message = "this makes more than 1000000 images, buffers, passes and uses of fragments";
            let used = self.path.last().map(|(_, name)| name.span);
            let at = if span == Span::NONE { used.unwrap_or(span) } else { span };
            reader.report(
                Diagnostic::new(Code::TOO_MANY_THINGS, at, message)
                    .help("repeat less, or let fragments use each other less often"),
            );
        }
        false
    }
}
