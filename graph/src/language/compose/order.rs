//! Passes in their order while files insert others between them.

use super::entry::{Entry, PlacedName};
use crate::frame::change::InsertPlace;
use std::collections::HashMap;

/// Passes, uses of fragments and anchors.
///
/// Items that are inserted at one place stay together there, in the order of insertion. So each item keeps the items that
/// stand before and after it.
#[derive(Default)]
pub(crate) struct Order<'t> {
    items: Vec<Item<'t>>,
    start: Vec<usize>,
    /// Items of the first file, then items that were inserted at the end.
    top: Vec<usize>,
    names: HashMap<&'t str, usize>,
    anchors: HashMap<&'t str, usize>,
}

struct Item<'t> {
    entry: Entry<'t>,
    before: Vec<usize>,
    after: Vec<usize>,
    removed: bool,
}

impl<'t> Order<'t> {
    /// Adds a pass, a use or an anchor behind all items at a place. `false`: there is no such place.
    pub(crate) fn insert(&mut self, place: &InsertPlace, entry: Entry<'t>) -> bool {
        let at = match place {
            InsertPlace::Start | InsertPlace::End => None,
            InsertPlace::Before(name) | InsertPlace::After(name) => self.names.get(&**name).copied(),
            InsertPlace::At(name) => self.anchors.get(&**name).copied(),
        };
        let number = self.items.len();
        let list = match (place, at) {
            (InsertPlace::Start, _) => &mut self.start,
            (InsertPlace::End, _) => &mut self.top,
            (InsertPlace::Before(_), Some(at)) => &mut self.items[at].before,
            (_, Some(at)) => &mut self.items[at].after,
            (_, None) => return false,
        };
        list.push(number);
        if let Some(name) = entry.name {
            self.names.entry(name.text).or_insert(number);
        }
        if let Some(anchor) = entry.leaf.field("anchor").and_then(PlacedName::of) {
            self.anchors.entry(anchor.text).or_insert(number);
        }
        self.items.push(Item { entry, before: Vec::new(), after: Vec::new(), removed: false });
        true
    }

    /// The pass or use of that name.
    pub(crate) fn find(&mut self, name: &str) -> Option<&mut Entry<'t>> {
        Some(&mut self.items[*self.names.get(name)?].entry)
    }

    /// Removes the pass or use of that name. Items that were inserted before or after it stay.
    pub(crate) fn remove(&mut self, name: &str) -> Option<&Entry<'t>> {
        let item = &mut self.items[self.names.remove(name)?];
        item.removed = true;
        Some(&item.entry)
    }

    /// Whether there is an anchor of that name.
    pub(crate) fn has_anchor(&self, name: &str) -> bool {
        self.anchors.contains_key(name)
    }

    /// Names of passes and uses, in the order in which they came.
    pub(crate) fn names(&self) -> Vec<&'t str> {
        sorted(&self.names)
    }

    /// Names of anchors, in the order in which they came.
    pub(crate) fn anchors(&self) -> Vec<&'t str> {
        sorted(&self.anchors)
    }

    /// All entries that are left, in order.
    pub(crate) fn all(&self) -> Vec<&Entry<'t>> {
        enum NextRead {
            Around(usize),
            Itself(usize),
        }
        let mut all = Vec::with_capacity(self.items.len());
        // A stack: the next item is the last.
        let mut next: Vec<NextRead> =
            self.start.iter().chain(&self.top).rev().map(|item| NextRead::Around(*item)).collect();
        while let Some(item) = next.pop() {
            match item {
                NextRead::Itself(item) => {
                    all.extend(Some(&self.items[item].entry).filter(|_| !self.items[item].removed))
                }
                NextRead::Around(number) => {
                    let item = &self.items[number];
                    next.extend(item.after.iter().rev().map(|after| NextRead::Around(*after)));
                    next.push(NextRead::Itself(number));
                    next.extend(item.before.iter().rev().map(|before| NextRead::Around(*before)));
                }
            }
        }
        all
    }
}

/// Names by their numbers.
fn sorted<'t>(names: &HashMap<&'t str, usize>) -> Vec<&'t str> {
    let mut names: Vec<(&usize, &&str)> = names.iter().map(|(name, at)| (at, name)).collect();
    names.sort();
    names.into_iter().map(|(_, name)| *name).collect()
}
