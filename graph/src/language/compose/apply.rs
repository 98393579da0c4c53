//! `changes`: a file sets, removes and inserts entries.

use super::change_log::{ChangeLog, ChangedEntry, RemovedEntry};
use super::changes::{InsertFields, KINDS, RemoveFields, SetFields};
use super::draft::{self, Draft};
use super::entry::Entry;
use crate::base::{Code, Diagnostic, suggestion};
use crate::frame::change::{Action, InsertPlace, Kind};
use crate::ron::{Leaf, Name, Reader, Shape};
use std::collections::HashSet;
use std::sync::Arc;

const SET: &str = "Set(pass: \"name\", to: (…))";

const REMOVE: &str = "Remove(pass: \"name\")";

const INSERT: &str = "Insert(before: \"name\", passes: […])";

/// Fields that stand in the parentheses of a setting's value.
const OF_VALUES: [&str; 5] = ["default", "min", "max", "step", "of"];

/// Applies a list of changes, one after the other.
pub(crate) fn changes<'t>(reader: &mut Reader, draft: &mut Draft<'t>, list: Leaf<'t>, change_log: &mut ChangeLog) {
    for leaf in reader.list(list, "`changes`").into_iter().flatten() {
        let Some((word, rest)) = reader.one_of(leaf, &KINDS) else { continue };
        let mut change = Change { reader, draft, change_log, leaf };
        match word {
            "Set" => change.set(rest),
            "Remove" => change.remove(rest),
            _ => change.insert(rest),
        };
    }
}

/// A change that is being applied.
struct Change<'c, 't> {
    reader: &'c mut Reader,
    draft: &'c mut Draft<'t>,
    change_log: &'c mut ChangeLog,
    leaf: Leaf<'t>,
}

impl<'t> Change<'_, 't> {
    fn set(&mut self, rest: Option<Leaf<'t>>) -> Option<()> {
        let fields: SetFields<'_> = self.reader.inside(self.leaf, rest, SET)?;
        let SetFields { pass, image, buffer, texture, setting, preset, view, to, without } = fields;
        let (kind, name) = self.one([
            (Kind::Pass, pass),
            (Kind::Image, image),
            (Kind::Buffer, buffer),
            (Kind::Texture, texture),
            (Kind::Setting, setting),
            (Kind::Preset, preset),
            (Kind::View, view),
        ])?;
        if to.is_none() && without.is_none() {
            self.reader.wrong(Code::CHANGE_UNFIT, self.leaf, "this change sets nothing", &format!("write `{SET}`"));
            return None;
        }
        let taken = self.without(without)?;
        let given = self.to(to)?;
        let Some(entry) = find(self.draft, kind, &name.text) else {
            self.missing(kind, &name);
            return None;
        };
        let mut mistakes = Vec::new();
        for (field, leaf) in &taken {
            if !entry.take(field) {
                mistakes.push((*leaf, format!("{} `{}` has no `{field}` to take away", kind.word(), name.text)));
            }
        }
        for (field, value) in &given {
            let part = kind == Kind::Setting && OF_VALUES.contains(&field.text());
            if !part {
                entry.set(*field, *value);
            } else if !entry.set_part("value", *field, *value) {
                mistakes.push((*field, format!("setting `{}` has no such value", name.text)));
            }
        }
        let (entry, stands) = (entry.leaf.span(), entry.name.map_or(entry.leaf.start(), |name| name.span));
        for (leaf, message) in mistakes {
            let wrong = Diagnostic::new(Code::CHANGE_UNFIT, leaf.span(), message);
            self.reader.report(wrong.label(stands, format!("`{}` stands here", name.text)));
        }
        let by = self.leaf.span();
        self.change_log.changed.push(ChangedEntry { entry, name: Name { text: name.text.clone(), span: stands }, by });
        let fields = given.iter().map(|(field, _)| field.text().into()).collect();
        let without = taken.into_iter().map(|(field, _)| field.into()).collect();
        self.change_log.did(by, Action::Set { of: kind, name: name.text, fields, without });
        Some(())
    }

    /// Names and values of the fields that are set.
    fn to(&mut self, to: Option<Leaf<'t>>) -> Option<Vec<(Leaf<'t>, Leaf<'t>)>> {
        let Some(to) = to else { return Some(Vec::new()) };
        let Some(fields) = to.fields().filter(|_| matches!(to.shape(), Shape::Parentheses)) else {
            self.reader.expected(to, "fields and their values as `(field: value, …)`");
            return None;
        };
        let fields: Vec<_> = fields.collect();
        let mut seen = HashSet::new();
        for (name, _) in &fields {
            if name.text() == "name" {
                self.reader.wrong(
                    Code::CHANGE_UNFIT,
                    *name,
                    "a change gives nothing another name",
                    "remove it, and insert another",
                );
                return None;
            }
            if !seen.insert(name.text()) {
                self.reader.wrong(Code::LISTED_TWICE, *name, format!("this change sets `{}` twice", name.text()), "");
                return None;
            }
        }
        Some(fields)
    }

    /// The fields that are taken away, and where each is named.
    fn without(&mut self, without: Option<Leaf<'t>>) -> Option<Vec<(String, Leaf<'t>)>> {
        let Some(without) = without else { return Some(Vec::new()) };
        let mut fields = Vec::new();
        for leaf in self.reader.list(without, "`without`")? {
            let field = self.reader.reference(leaf, "a field")?;
            if &*field.text == "name" {
                self.reader.wrong(Code::CHANGE_UNFIT, leaf, "nothing goes without a name", "");
                return None;
            }
            fields.push((field.text.to_string(), leaf));
        }
        Some(fields)
    }

    fn remove(&mut self, rest: Option<Leaf<'t>>) -> Option<()> {
        let fields: RemoveFields<'_> = self.reader.inside(self.leaf, rest, REMOVE)?;
        let RemoveFields { pass, image, buffer, texture, setting, preset, view, output } = fields;
        let (kind, name) = self.one([
            (Kind::Pass, pass),
            (Kind::Image, image),
            (Kind::Buffer, buffer),
            (Kind::Texture, texture),
            (Kind::Setting, setting),
            (Kind::Preset, preset),
            (Kind::View, view),
            (Kind::Output, output),
        ])?;
        let texts = |entry: &Entry<'t>| entry.texts().map(Arc::from).collect();
        let found: Option<Vec<Arc<str>>> = match kind {
            Kind::Pass => self.draft.passes.remove(&name.text).map(texts),
            Kind::Output => self.draft.outputs.remove(&name.text).map(|_| Vec::new()),
            _ => self.draft.list_mut(kind).remove(&name.text).map(|_| Vec::new()),
        };
        let Some(texts) = found else {
            self.missing(kind, &name);
            return None;
        };
        if kind == Kind::Setting {
            self.draft.removed_settings.insert(name.text.clone());
        }
        let by = self.leaf.span();
        if let Some(outputs) = self.draft.outputs_written.filter(|_| kind == Kind::Output) {
            let (entry, span) = (outputs.span(), outputs.start());
            self.change_log.changed.push(ChangedEntry { entry, name: Name { text: "outputs".into(), span }, by });
        }
        self.change_log.remove(RemovedEntry { kind, name: name.clone(), by, texts });
        self.change_log.did(by, Action::Remove { of: kind, name: name.text });
        Some(())
    }

    fn insert(&mut self, rest: Option<Leaf<'t>>) -> Option<()> {
        let fields: InsertFields<'_> = self.reader.inside(self.leaf, rest, INSERT)?;
        let by = self.leaf.span();
        match fields {
            InsertFields { before: None, after: None, at: None, passes: None, outputs: Some(outputs) } => {
                let new: Vec<_> = self.reader.list(outputs, "`outputs`")?.into_iter().map(draft::output).collect();
                let names = new.iter().filter_map(|entry| Some(entry.name?.text.into())).collect();
                new.into_iter().for_each(|output| self.draft.outputs.add(output));
                self.change_log.did(by, Action::Add { of: Kind::Output, names });
            }
            InsertFields { before, after, at, passes: Some(passes), outputs: None } => {
                let place = self.place(before, after, at)?;
                let entries: Vec<_> = self.reader.list(passes, "`passes`")?.into_iter().map(Entry::of).collect();
                let name = |entry: &Entry<'t>| Some(entry.name?.text.into());
                let names = entries.iter().filter_map(name).collect();
                for entry in entries {
                    self.draft.passes.insert(&place, entry);
                }
                self.change_log.did(by, Action::Insert { place, names });
            }
            _ => {
                let wrong = "passes are inserted at a place, or outputs by themselves";
                let help = format!("write `{INSERT}` or `Insert(outputs: [\"name\"])`");
                self.reader.wrong(Code::CHANGE_UNFIT, self.leaf, wrong, &help);
            }
        }
        Some(())
    }

    /// Where passes are inserted.
    fn place(
        &mut self,
        before: Option<Leaf<'t>>,
        after: Option<Leaf<'t>>,
        at: Option<Leaf<'t>>,
    ) -> Option<InsertPlace> {
        match (before, after, at) {
            (Some(before), None, None) => self.pass(before).map(InsertPlace::Before),
            (None, Some(after), None) => self.pass(after).map(InsertPlace::After),
            (None, None, Some(at)) => {
                if let Shape::Text = at.shape() {
                    return self.anchor(at).map(InsertPlace::At);
                }
                let forms = "a place is `at: \"anchor\"`, `at: Start` or `at: End`";
                let (word, rest) = self.reader.word(at, "a place", &["Start", "End"], forms)?;
                self.reader.bare(word, rest)?;
                Some(if word == "Start" { InsertPlace::Start } else { InsertPlace::End })
            }
            _ => {
                let help = "write `before: \"pass\"`, `after: \"pass\"`, `at: \"anchor\"`, `at: Start` or `at: End`";
                self.reader.wrong(Code::CHANGE_UNFIT, self.leaf, "passes are inserted at one place", help);
                None
            }
        }
    }

    fn pass(&mut self, leaf: Leaf<'t>) -> Option<Arc<str>> {
        let name = self.reader.reference(leaf, "a pass")?;
        if self.draft.passes.find(&name.text).is_none() {
            self.missing(Kind::Pass, &name);
            return None;
        }
        Some(name.text)
    }

    fn anchor(&mut self, leaf: Leaf<'t>) -> Option<Arc<str>> {
        let name = self.reader.reference(leaf, "an anchor")?;
        if self.draft.passes.has_anchor(&name.text) {
            return Some(name.text);
        }
        let help = match self.draft.passes.find(&name.text) {
            None if self.reader.has_many() => String::new(),
            Some(_) => format!("that is a pass: write `before: \"{0}\"` or `after: \"{0}\"`", name.text),
            None => suggestion(&name.text, self.draft.passes.anchors())
                .unwrap_or_else(|| "this pipeline has no anchors: name a pass, by `before` or `after`".to_owned()),
        };
        let unknown =
            Diagnostic::new(Code::UNKNOWN_ANCHOR, name.span, format!("there is no anchor named `{}`", name.text));
        let help = Some(help).filter(|help| !help.is_empty());
        self.reader.report(Diagnostic { help, ..unknown });
        None
    }

    /// The kind and name of the one thing that a change names.
    fn one<const N: usize>(&mut self, named: [(Kind, Option<Leaf<'t>>); N]) -> Option<(Kind, Name)> {
        let mut given = named.iter().filter_map(|(kind, leaf)| leaf.map(|leaf| (*kind, leaf)));
        let (Some((kind, leaf)), None) = (given.next(), given.next()) else {
            let words: Vec<String> = named.iter().map(|(kind, _)| format!("`{}: \"…\"`", kind.word())).collect();
            let help = format!("name one of {}", words.join(", "));
            self.reader.wrong(Code::CHANGE_UNFIT, self.leaf, "a change names one thing", &help);
            return None;
        };
        let article = if matches!(kind, Kind::Image | Kind::Output) { "an" } else { "a" };
        self.reader.reference(leaf, &format!("{article} {}", kind.word())).map(|name| (kind, name))
    }

    /// Reports that there is nothing of that name to change.
    fn missing(&mut self, kind: Kind, name: &Name) {
        let (word, text) = (kind.word(), &name.text);
        if let Some(removed) = self.change_log.removed(kind, text) {
            let gone = Diagnostic::new(Code::REMOVED_ALREADY, name.span, format!("{word} `{text}` is removed already"));
            self.reader.report(gone.label(removed.by, "removed here"));
            return;
        }
        let unknown = Diagnostic::unknown_name(unknown(kind), word, text).at(name.span);
        if self.reader.has_many() {
            self.reader.report(unknown);
            return;
        }
        let names = match kind {
            Kind::Pass => self.draft.passes.names(),
            Kind::Output => self.draft.outputs.names(),
            _ => self.draft.list_mut(kind).names(),
        };
        let within = text.split(['.', '[']).next().filter(|outer| names.contains(outer) && *outer != &**text);
        let help = match within {
            Some(outer) if text.contains('.') => Some(format!(
                "changes don't reach into a use: give it other arguments by `Set(pass: \"{outer}\", to: (with: {{…}}))`"
            )),
            Some(outer) => Some(format!("changes are of all that is repeated: `{outer}`")),
            None if kind == Kind::Pass && self.draft.passes.has_anchor(text) => Some(format!(
                "that is an anchor, which does nothing and stays: insert at it by `Insert(at: \"{text}\", passes: […])`, and change \
                 or remove what stands there by its own name"
            )),
            None => suggestion(text, names).or_else(|| Some(format!("this pipeline has no {}", kind.plural()))),
        };
        self.reader.report(Diagnostic { help, ..unknown });
    }
}

/// The mistake that there is no such thing of a name.
const fn unknown(kind: Kind) -> Code {
    match kind {
        Kind::Setting => Code::UNKNOWN_SETTING,
        Kind::Preset => Code::UNKNOWN_PRESET,
        Kind::View => Code::UNKNOWN_VIEW,
        Kind::Fragment => Code::UNKNOWN_FRAGMENT,
        Kind::Texture | Kind::Image => Code::UNKNOWN_IMAGE,
        Kind::Buffer => Code::UNKNOWN_BUFFER,
        Kind::Pass => Code::UNKNOWN_PASS,
        Kind::Output => Code::UNKNOWN_OUTPUT,
    }
}

fn find<'d, 't>(draft: &'d mut Draft<'t>, kind: Kind, name: &str) -> Option<&'d mut Entry<'t>> {
    match kind {
        Kind::Pass => draft.passes.find(name),
        _ => draft.list_mut(kind).find(name),
    }
}
