//! A pipeline while files add to it and change it: lists of entries, each still where it was written.

use super::change_log::ChangeLog;
use super::entry::{Entry, PlacedName};
use super::layers::Role;
use super::order::Order;
use super::tables::{self, Section, Sections};
use crate::base::{Code, Diagnostic};
use crate::frame::change::{Action, InsertPlace, Kind};
use crate::ron::{Leaf, Name, Reader, Shape};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Lists whose entries several files add, in the order in which a pipeline has them.
pub(crate) const LISTS: [(Kind, Section); 7] = [
    (Kind::Setting, tables::SETTINGS),
    (Kind::Preset, tables::PRESETS),
    (Kind::View, tables::VIEWS),
    (Kind::Fragment, tables::FRAGMENTS),
    (Kind::Texture, tables::TEXTURES),
    (Kind::Image, tables::IMAGES),
    (Kind::Buffer, tables::BUFFERS),
];

/// Values that a later file replaces.
pub(crate) const REPLACED: [Section; 3] = [tables::DEPTH, tables::COLOR, tables::DEPTH_FORMAT];

/// All lists of a pipeline.
#[derive(Default)]
pub(crate) struct Draft<'t> {
    lists: HashMap<Kind, List<'t>>,
    pub(crate) passes: Order<'t>,
    pub(crate) passes_written: Option<Leaf<'t>>,
    pub(crate) outputs: List<'t>,
    pub(crate) outputs_written: Option<Leaf<'t>>,
    /// Values of [`REPLACED`], each of the last file that has it.
    pub(crate) replaced: [Option<Leaf<'t>>; REPLACED.len()],
    /// Names of settings that were removed, whether or not others of the name were added since.
    pub(crate) removed_settings: HashSet<Arc<str>>,
}

/// Entries whose order has no meaning.
#[derive(Default)]
pub(crate) struct List<'t> {
    /// The list that was written first.
    pub(crate) written: Option<Leaf<'t>>,
    /// `None`: it was removed.
    pub(crate) entries: Vec<Option<Entry<'t>>>,
    index: HashMap<&'t str, usize>,
}

impl<'t> List<'t> {
    /// The entry of that name.
    pub(crate) fn find(&mut self, name: &str) -> Option<&mut Entry<'t>> {
        self.entries.get_mut(*self.index.get(name)?)?.as_mut()
    }

    /// Removes the entry of that name.
    pub(crate) fn remove(&mut self, name: &str) -> Option<Entry<'t>> {
        self.entries.get_mut(self.index.remove(name)?)?.take()
    }

    /// Names of entries.
    pub(crate) fn names(&self) -> Vec<&'t str> {
        self.entries.iter().flatten().filter_map(|entry| Some(entry.name?.text)).collect()
    }

    /// Adds an entry. If several have one name, the first is found.
    pub(crate) fn add(&mut self, entry: Entry<'t>) {
        if let Some(name) = entry.name {
            self.index.entry(name.text).or_insert(self.entries.len());
        }
        self.entries.push(Some(entry));
    }
}

impl<'t> Draft<'t> {
    pub(crate) fn list(&self, kind: Kind) -> Option<&List<'t>> {
        self.lists.get(&kind)
    }

    pub(crate) fn list_mut(&mut self, kind: Kind) -> &mut List<'t> {
        self.lists.entry(kind).or_default()
    }

    /// Adds the entries of a file.
    pub(crate) fn add(&mut self, reader: &mut Reader, sections: &Sections<'t>, role: Role, change_log: &mut ChangeLog) {
        for (kind, section) in LISTS {
            let Some(leaf) = sections.get(&section) else { continue };
            let Some(entries) = reader.list(leaf, &format!("`{}`", section.name)) else { continue };
            let list = self.list_mut(kind);
            list.written.get_or_insert(leaf);
            let mut names = Vec::new();
            for entry in entries.into_iter().map(Entry::of) {
                if let Some(name) = entry.name.filter(|_| role != Role::Whole) {
                    if let Some(first) = list.find(name.text).and_then(|first| first.name) {
                        reader.report(again(kind, name, first));
                        continue;
                    }
                    names.push(Arc::from(name.text));
                }
                list.add(entry);
            }
            if !names.is_empty() {
                change_log.did(leaf.start(), Action::Add { of: kind, names });
            }
        }
        for (old, section) in self.replaced.iter_mut().zip(REPLACED) {
            *old = sections.get(&section).or(*old);
        }
        // Passes of a pipeline that extends another were reported.
        if let Some(leaf) = sections.get(&tables::PASSES).filter(|_| role == Role::Whole)
            && let Some(entries) = reader.list(leaf, "`passes`")
        {
            self.passes_written.get_or_insert(leaf);
            for entry in entries {
                self.passes.insert(&InsertPlace::End, Entry::of(entry));
            }
        }
        if let Some(leaf) = sections.get(&tables::OUTPUTS)
            && let Some(entries) = reader.list(leaf, "`outputs`")
        {
            self.outputs_written = Some(leaf);
            self.outputs = List::default();
            entries.into_iter().map(output).for_each(|output| self.outputs.add(output));
            if role != Role::Whole {
                let names = self.outputs.names().into_iter().map(Arc::from).collect();
                change_log.did(leaf.start(), Action::Outputs { names });
            }
        }
    }
}

/// An output, by the name of its image or buffer.
pub(crate) fn output(leaf: Leaf<'_>) -> Entry<'_> {
    let named = match leaf.shape() {
        Shape::Text => Some(leaf),
        _ => leaf.field("image").or_else(|| leaf.field("buffer")),
    };
    Entry { leaf, name: named.and_then(PlacedName::of), fields: None }
}

/// The mistake that a file adds an entry of a name that is taken.
fn again(kind: Kind, name: PlacedName<'_>, first: PlacedName<'_>) -> Diagnostic {
    let Name { text, span } = name.name();
    let what = kind.word();
    let wrong = Diagnostic::new(Code::NAME_TAKEN, span, format!("`{text}` is the name of more than one {what}"));
    let wrong = wrong.remark("again here").label(first.span, "first here");
    match kind {
        Kind::Fragment => wrong.help("give it another name"),
        _ => wrong.help(format!("give it another name, or change the first: `Set({what}: \"{text}\", to: (…))`")),
    }
}
