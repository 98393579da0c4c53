//! A use of a fragment: the fragment's images, buffers and passes are made under the name of the use.

use super::evaluation::{Evaluation, Level, Purpose};
use crate::base::{Code, Diagnostic, Label, Span};
use crate::expression::Value;
use crate::frame::{Resource, ViewIndex};
use crate::language::entries::condition::Condition;
use crate::language::entries::stand_ins::{self, OtherwiseOwner};
use crate::language::entries::uses::{Argument, UseEntry};
use crate::language::model::{BufferPart, BufferRef, ImagePart, ImageRef, Instance, Part, Pass, PassDecisions, Work};
use crate::language::scope::{DecidedValue, FieldValueTuple};
use crate::ron::{Name, Reader};
use std::sync::Arc;

/// Uses of fragments stand at most this deep in each other.
const MOST_NESTED: usize = 32;

/// A longer circle is not shown whole.
const MOST_SHOWN: usize = 10;

impl<'a> Evaluation<'a> {
    /// Puts in the fragment of a use. If the use is off, a pass that does nothing stands for it, with the use's stand-ins.
    pub(super) fn put_in(
        &mut self,
        reader: &mut Reader,
        level: &Level<'a>,
        (view, number, repeated): (ViewIndex, Option<u32>, &PassDecisions),
        entry: &UseEntry,
    ) {
        let before = reader.errors.len();
        let mut evaluator = self.evaluator(reader, level, view, number);
        let condition = entry.condition.evaluate(&mut evaluator);
        let is_off = condition.as_ref().is_some_and(|condition| condition.off.is_some());
        let otherwise = evaluator.leniently(!is_off, |evaluator| {
            entry.otherwise.as_ref().map(|otherwise| otherwise.stand_ins.evaluate(evaluator))
        });
        let arguments = entry.arguments.iter().map(|argument| {
            let Argument { value, span } = argument.as_ref()?;
            Some((evaluator.leniently(is_off, |evaluator| value.evaluate(evaluator))?, *span))
        });
        let values: Vec<Option<(DecidedValue, Option<Span>)>> = arguments.collect();
        let run = entry.run.as_ref().map(|run| evaluator.leniently(is_off, |evaluator| run.evaluate(evaluator)));
        let images = std::mem::take(&mut evaluator.chosen);
        let (name, at, fragments) = (&entry.name, entry.fragment, self.fragments);
        let (Some(found), Some(Condition { off, by })) = (fragments.get(at), condition) else {
            self.flat.fail();
            return;
        };
        if reader.errors.len() > before || !self.may_nest(reader, at, name) {
            self.flat.fail();
            return;
        }
        let arguments: Vec<(Resource, Span)> = values
            .iter()
            .flatten()
            .filter_map(|(value, span)| {
                let resource = match value.value {
                    Value::Image(index) => Resource::Image(index),
                    Value::Buffer(index) => Resource::Buffer(index),
                    _ => return None,
                };
                Some((resource, (*span)?))
            })
            .collect();
        let values: Vec<Option<DecidedValue>> = values.into_iter().map(|value| value.map(|(value, _)| value)).collect();
        let whole = level.full(name, number);
        let start = self.flat.lengths();
        let instance = u32::try_from(self.flat.instances.len()).ok();
        let decided = PassDecisions { runs: by, images, repeat: repeated.repeat.clone() };
        let mut inner =
            Level::within(level, (found, values), (&whole, view, instance), is_off, &decided, run.flatten());
        self.flat.instances.push(Instance { name: whole.text.clone(), span: name.span, within: level.instance });
        self.used.insert(at);
        self.path.push((at, name.clone()));
        let inside = reader.errors.len();
        self.level(reader, &mut inner);
        self.path.pop();
        self.used_here(reader, inside, name);

        let written =
            if entry.otherwise.is_some() || is_off { self.written_since(start.passes, &arguments) } else { Vec::new() };
        let otherwise = match otherwise {
            Some(None) if is_off => {
                self.flat.fail();
                return;
            }
            otherwise => otherwise.flatten().unwrap_or_default(),
        };
        let work = Work::Custom { callback: name.clone(), reads: Vec::new(), writes: written };
        let pass = Pass { off, decided, work, otherwise, view, instance: level.instance, ..Pass::idle(whole) };
        // A pass that is wrong may write anything.
        let is_whole = self.flat.passes[start.passes..].iter().all(Option::is_some);
        if let Some(otherwise) = entry.otherwise.as_ref().filter(|_| is_whole) {
            stand_ins::stand_ins_make_sense(reader, otherwise, OtherwiseOwner::Use, &pass);
        }
        if is_off {
            self.flat.truncate(start);
            self.flat.passes.push(Some(Arc::new(pass)));
        }
    }

    /// Arguments that passes from `start` on write.
    fn written_since(&self, start: usize, arguments: &[(Resource, Span)]) -> Vec<Part> {
        let mut written = std::collections::HashSet::new();
        for pass in self.flat.passes.iter().skip(start).flatten() {
            written.extend(pass.parts().filter(|(_, of)| of.writes()).map(|(part, _)| part.resource().resource));
        }
        let parts = arguments.iter().filter(|(resource, _)| written.contains(resource));
        parts
            .map(|(resource, span)| match resource {
                Resource::Image(index) => Part::Image(ImagePart::whole(ImageRef { index: *index, span: *span })),
                Resource::Buffer(index) => Part::Buffer(BufferPart::whole(BufferRef { index: *index, span: *span })),
            })
            .collect()
    }

    /// Whether a fragment may be put in here: not within itself, and not too deep.
    fn may_nest(&mut self, reader: &mut Reader, at: usize, name: &Name) -> bool {
        if self.is_full {
            return false;
        }
        if let Some(first) = self.path.iter().position(|(outer, _)| *outer == at) {
            let called = |at: usize| format!("`{}`", self.fragments.called(at));
            let circle: Vec<(usize, &Name)> =
                self.path[first + 1..].iter().map(|(at, name)| (*at, name)).chain([(at, name)]).collect();
            let mut path = vec![called(at)];
            path.extend(circle.iter().take(MOST_SHOWN).map(|(at, _)| called(*at)));
            if circle.len() > MOST_SHOWN {
                path.push("…".to_owned());
            }
            let message = format!("fragments use each other in a circle: {}", path.join(" → "));
            let mut wrong = Diagnostic::new(Code::FRAGMENTS_IN_CIRCLE, name.span, message)
                .remark(format!("{} is used here", called(at)));
            for (inner, name) in circle[..circle.len() - 1].iter().take(MOST_SHOWN) {
                wrong = wrong.label(name.span, format!("{} is used here", called(*inner)));
            }
            reader.report(wrong.help("one of them must do without the others"));
            return false;
        }
        if self.path.len() >= MOST_NESTED {
            // An unused fragment is not within another; those that it uses are checked by themselves.
            if self.purpose != Purpose::CheckUnused {
                let message = format!("uses of fragments stand at most {MOST_NESTED} deep in each other");
                reader.report(Diagnostic::new(Code::FRAGMENTS_TOO_DEEP, name.span, message));
            }
            return false;
        }
        true
    }

    /// Adds the use of the fragment to mistakes from `start` on. Mistakes that an earlier use showed are taken out.
    fn used_here(&mut self, reader: &mut Reader, start: usize, name: &Name) {
        let new: Vec<Diagnostic> = reader.errors.drain(start..).collect();
        for mut error in new {
            let known = error.labels.first().map(|label| (label.span, error.message.clone()));
            let nested = error.labels.iter().filter(|label| label.is_use).count();
            if nested >= MOST_SHOWN && !self.path.is_empty() {
                reader.report(error);
            } else if nested > 0 || known.is_none_or(|known| self.reported.insert(known)) {
                error.labels.push(Label::of_use(name.span, &name.text));
                reader.report(error);
            }
        }
    }
}
