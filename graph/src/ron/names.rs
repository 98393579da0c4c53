//! The names that a file gives, each once, and the search for those that it refers to.

use super::{Leaf, Name, Reader};
use crate::base::{Code, Diagnostic, Span, nearest, without_quotes};
use std::collections::HashMap;
use std::sync::Arc;

impl Name {
    /// A name as it stands in the file, without a judgement.
    #[must_use]
    pub fn written(leaf: Leaf<'_>) -> Option<Name> {
        leaf.plain().map(|text| Name { text: text.into(), span: leaf.span() })
    }
}

/// Names of one kind of thing, in file order.
pub struct Names {
    /// The word for one.
    what: &'static str,
    /// The mistake that none has a name.
    unknown: Code,
    given: Vec<Option<Name>>,
    index: HashMap<Arc<str>, usize>,
    /// Whether every name could be read.
    complete: bool,
}

impl Names {
    /// No names yet, of things called `what`. `unknown`: the mistake that none of them has a name.
    #[must_use]
    pub fn new(what: &'static str, unknown: Code) -> Names {
        Names { what, unknown, given: Vec::new(), index: HashMap::new(), complete: true }
    }

    /// Makes room for `more` things.
    pub(crate) fn reserve(&mut self, more: usize) {
        self.given.reserve(more);
        self.index.reserve(more);
    }

    /// Gives the next thing its name; `None` if it couldn't be read. Reports a name that is given twice.
    pub fn give(&mut self, reader: &mut Reader, name: Option<Name>) {
        if let Some(name) = &name {
            let first = *self.index.entry(name.text.clone()).or_insert(self.given.len());
            if first < self.given.len() {
                let message = format!("`{}` is the name of more than one {}", name.text, self.what);
                let again = Diagnostic::new(Code::NAME_TAKEN, name.span, message).remark("again here");
                reader.report(again.label(self.span(first), "first here"));
            }
        }
        self.complete &= name.is_some();
        self.given.push(name);
    }

    /// The index of the thing named `name`, if there is one.
    #[must_use]
    pub fn at(&self, name: &str) -> Option<usize> {
        self.index.get(name).copied()
    }

    /// The first name that reads `name`, if there is one.
    pub(crate) fn find_name(&self, name: &str) -> Option<&Name> {
        self.given[self.at(name)?].as_ref()
    }

    /// The name of the thing numbered `at`, if it could be read.
    pub(crate) fn get(&self, at: usize) -> Option<&Name> {
        self.given.get(at)?.as_ref()
    }

    /// Where the name of the thing numbered `at` stands.
    pub(crate) fn span(&self, at: usize) -> Span {
        self.get(at).map_or(Span::NONE, |name| name.span)
    }

    /// Names that could be read, in file order.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Name> {
        self.given.iter().flatten()
    }

    /// Whether every name could be read.
    #[must_use]
    pub const fn complete(&self) -> bool {
        self.complete
    }

    /// The index of the thing named `name`. Reports a name that doesn't exist, unless some name couldn't be read: it
    /// may be that one.
    pub fn find(&self, reader: &mut Reader, name: &Name) -> Option<usize> {
        self.find_fitting(reader, name, |_| true, None)
    }

    /// As [`Names::find`], but only names of things whose number `fits` are suggested. `literal` names the values that may
    /// stand there without quotes.
    pub(crate) fn find_fitting(
        &self,
        reader: &mut Reader,
        name: &Name,
        fits: impl Fn(usize) -> bool + Clone,
        literal: Option<&str>,
    ) -> Option<usize> {
        if let Some(index) = self.index.get(&name.text) {
            return Some(*index);
        }
        if self.complete {
            let unknown = Diagnostic::unknown_name(self.unknown, self.what, &name.text).at(name.span);
            let fitting = (0..).zip(&self.given).filter(|(at, _)| fits(*at));
            let names = fitting.filter_map(|(_, name)| name.as_ref().map(|name| &*name.text));
            let is_far = !reader.has_many() && nearest(&name.text, names.clone()).is_none();
            let help = reader.known(&name.text, names);
            let help = match literal.filter(|_| is_far) {
                Some(literal) => Some(without_quotes(literal, help)),
                None => help,
            };
            reader.report(Diagnostic { help, ..unknown });
        }
        None
    }

    /// Known names in file order.
    pub fn in_order(&self) -> impl Iterator<Item = &str> + Clone {
        self.given.iter().flatten().map(|name| &*name.text)
    }
}
