//! A fragment is put in: its images, buffers and passes, under the name of its use.

use super::lower::{Lowering, Place, full};
use crate::base::{Diagnostic, Span};
use crate::expression::Value;
use crate::frame::Resource;
use crate::language::entries::body::Body;
use crate::language::entries::condition::{self, optional};
use crate::language::entries::fragments::Fragment;
use crate::language::entries::parts;
use crate::language::entries::stand_ins::{self, Of};
use crate::language::entries::uses::{self, UseFields};
use crate::language::model::{BufferRef, ImagePart, ImageRef, Instance, Part, Pass, Work};
use crate::language::scope::{Given, Level, Scope};
use crate::ron::{Name, Reader};

/// Uses of fragments stand at most this deep in each other.
const MOST_NESTED: usize = 32;

/// A longer circle is not shown whole.
const MOST_SHOWN: usize = 10;

impl<'t> Lowering<'_, 't> {
    /// Puts in what a use asks for. If the use is off, a pass that does nothing stands for it, with what fills its
    /// targets instead.
    pub(crate) fn put_in(
        &mut self,
        reader: &mut Reader,
        body: &Body<'t>,
        level: &Level,
        place: &Place,
        (index, number): (Option<(&Name, u32)>, Option<u32>),
        fields: &UseFields<'t>,
    ) {
        let before = reader.errors.len();
        let scope = self.scope(body, level, place.view, index);
        let name = reader.name(fields.name, "a use");
        let fragment = reader.reference(fields.r#use, "a fragment");
        let fragment = fragment.and_then(|name| Some((self.fragments.names.find(reader, &name)?, name)));
        let off = optional(fields.when, |leaf| condition::when(reader, &scope, leaf)).map(Option::flatten);
        let off = off.map(|off| self.off_within(place.view, off));
        let is_off = matches!(off, Some(Some(_)));
        let strict = Scope { lenient: scope.lenient || !is_off, ..scope };
        let otherwise = optional(fields.otherwise, |leaf| stand_ins::stand_ins(reader, &strict, leaf));
        let lenient = Scope { lenient: scope.lenient || is_off, ..scope };
        let (fragments, is_lenient) = (self.fragments, lenient.lenient);
        let found = fragment.as_ref().and_then(|(at, _)| fragments.list.get(*at)?.as_ref());
        let given =
            found.map(|fragment| uses::arguments(reader, &lenient, fields, (fragment.called(), &fragment.body.known)));
        let (Some(name), Some((at, _)), Some(found), Some(given), Some(off)) = (name, fragment, found, given, off)
        else {
            self.passes.push(None);
            return;
        };
        if reader.errors.len() > before || !self.may_nest(reader, at, &name) {
            self.passes.push(None);
            return;
        }
        let arguments: Vec<(Resource, Span)> = given
            .iter()
            .flatten()
            .filter_map(|(given, leaf)| {
                let resource = match given.value {
                    Value::Image(index) => Resource::Image(index),
                    Value::Buffer(index) => Resource::Buffer(index),
                    _ => return None,
                };
                Some((resource, (*leaf)?.span()))
            })
            .collect();
        let given: Vec<Option<Given>> = given.into_iter().map(|given| given.map(|(given, _)| given)).collect();
        let whole = full(place, &name, number);
        let start = [self.images.len(), self.buffers.len(), self.passes.len(), self.instances.len()];
        let outer = std::mem::replace(&mut self.lenient, is_lenient);
        let instance = u32::try_from(self.instances.len()).ok();
        let within = Place { prefix: format!("{}.", whole.text).into(), view: place.view, instance };
        self.instances.push(Instance { name: whole.text.clone(), span: name.span, within: place.instance });
        self.used.insert(at);
        self.path.push((at, name.clone()));
        let inside = reader.errors.len();
        self.body(reader, &found.body, &mut Level { given, ..Level::default() }, &within);
        self.path.pop();
        self.lenient = outer;
        self.used_here(reader, inside, &name);

        let written = if fields.otherwise.is_some() || off.is_some() {
            self.written_since(start[2], &arguments)
        } else {
            Vec::new()
        };
        let otherwise = match otherwise {
            Some(otherwise) => otherwise.unwrap_or_default(),
            None if is_off => {
                self.passes.push(None);
                return;
            }
            None => Vec::new(),
        };
        let is_on = off.is_none();
        let work = Work::Custom { callback: name.clone(), reads: Vec::new(), writes: written };
        let pass = Pass { off, work, otherwise, view: place.view, instance: place.instance, ..Pass::idle(whole) };
        if let Some(leaf) = fields.otherwise {
            stand_ins::stand_ins_make_sense(reader, fields.when.is_some(), leaf, Of::Use, &pass);
        }
        if is_on {
            return;
        }
        self.images.truncate(start[0]);
        self.properties.truncate(start[0]);
        self.buffers.truncate(start[1]);
        self.passes.truncate(start[2]);
        self.instances.truncate(start[3]);
        self.passes.push(Some(pass));
    }

    /// Arguments that passes from `start` on write.
    fn written_since(&self, start: usize, arguments: &[(Resource, Span)]) -> Vec<Part> {
        let mut written = std::collections::HashSet::new();
        for pass in self.passes.iter().skip(start).flatten() {
            written.extend(pass.written().map(|image| Resource::Image(image.index)));
            written.extend(pass.written_buffers().map(|buffer| Resource::Buffer(buffer.index)));
        }
        let parts = arguments.iter().filter(|(resource, _)| written.contains(resource));
        parts
            .map(|(resource, span)| match resource {
                Resource::Image(index) => Part::Image(ImagePart::whole(ImageRef { index: *index, span: *span })),
                Resource::Buffer(index) => Part::Buffer(parts::whole_buffer(BufferRef { index: *index, span: *span })),
            })
            .collect()
    }

    /// Whether a fragment may be put in here: not within itself, and not too deep.
    fn may_nest(&mut self, reader: &mut Reader, at: usize, name: &Name) -> bool {
        if self.is_full() {
            return false;
        }
        if let Some(first) = self.path.iter().position(|(outer, _)| *outer == at) {
            let called = |at: usize| {
                let fragment = self.fragments.list.get(at).and_then(Option::as_ref);
                format!("`{}`", fragment.map_or("", Fragment::called))
            };
            let circle: Vec<(usize, &Name)> =
                self.path[first + 1..].iter().map(|(at, name)| (*at, name)).chain([(at, name)]).collect();
            let mut path = vec![called(at)];
            path.extend(circle.iter().take(MOST_SHOWN).map(|(at, _)| called(*at)));
            if circle.len() > MOST_SHOWN {
                path.push("…".to_owned());
            }
            let message = format!("fragments use each other in a circle: {}", path.join(" → "));
            let mut wrong = Diagnostic::new(name.span, message).remark(format!("{} is used here", called(at)));
            for (inner, name) in circle[..circle.len() - 1].iter().take(MOST_SHOWN) {
                wrong = wrong.label(name.span, format!("{} is used here", called(*inner)));
            }
            reader.report(wrong.help("one of them must do without the others"));
            return false;
        }
        if self.path.len() >= MOST_NESTED {
            // What nobody uses is not deep yet; what is left out here is tried by itself.
            if !self.trying {
                let message = format!("uses of fragments stand at most {MOST_NESTED} deep in each other");
                reader.report(Diagnostic::new(name.span, message));
            }
            return false;
        }
        true
    }

    /// Says of mistakes from `start` on where the fragment was used. Those that an earlier use showed are taken out.
    fn used_here(&mut self, reader: &mut Reader, start: usize, name: &Name) {
        let new: Vec<Diagnostic> = reader.errors.drain(start..).collect();
        for error in new {
            let known = error.labels.first().map(|label| (label.span, error.message.clone()));
            let nested = error.labels.iter().filter(|label| label.text.starts_with("used here as ")).count();
            if nested >= MOST_SHOWN && !self.path.is_empty() {
                reader.report(error);
            } else if nested > 0 || known.is_none_or(|known| self.seen.insert(known)) {
                reader.report(error.label(name.span, format!("used here as `{}`", name.text)));
            }
        }
    }
}
