//! Keys and values in the order in which they came, found by key.

use crate::ron::Leaf;
use std::borrow::Cow;
use std::collections::HashMap;

/// Fields, or the entries of a map. A key that is written twice stays twice: the mistake is reported later.
pub(crate) struct KeyedFields<'t, V> {
    /// `None`: it was taken away.
    pairs: Vec<Option<(Leaf<'t>, V)>>,
    /// The places of a key's pairs.
    index: HashMap<Cow<'t, str>, Vec<usize>>,
}

impl<'t, V> KeyedFields<'t, V> {
    /// The pairs of one file; `key` is the key at a leaf, if it can be one.
    pub(crate) fn new(
        written: impl Iterator<Item = (Leaf<'t>, V)>,
        key: impl Fn(Leaf<'t>) -> Option<Cow<'t, str>>,
    ) -> KeyedFields<'t, V> {
        let mut all = KeyedFields { pairs: Vec::new(), index: HashMap::new() };
        for (name, value) in written {
            all.add(key(name), (name, value));
        }
        all
    }

    /// The first value of that key.
    pub(crate) fn find(&mut self, key: &str) -> Option<&mut V> {
        let first = *self.index.get(key)?.first()?;
        self.pairs[first].as_mut().map(|(_, value)| value)
    }

    /// Puts a value in the place of the first with the same key, or at the end.
    pub(crate) fn put(&mut self, name: Leaf<'t>, value: V, key: impl Fn(Leaf<'t>) -> Option<Cow<'t, str>>) {
        let key = key(name);
        let there = key.as_ref().and_then(|key| self.index.get(key)).and_then(|all| all.first());
        match there {
            Some(first) => self.pairs[*first] = Some((name, value)),
            None => self.add(key, (name, value)),
        }
    }

    /// Takes all values of a key away. Whether there were any.
    pub(crate) fn take(&mut self, key: &str) -> bool {
        let taken = self.index.remove(key).unwrap_or_default();
        for at in &taken {
            self.pairs[*at] = None;
        }
        !taken.is_empty()
    }

    /// All pairs that are left, in order.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = &(Leaf<'t>, V)> {
        self.pairs.iter().flatten()
    }

    fn add(&mut self, key: Option<Cow<'t, str>>, pair: (Leaf<'t>, V)) {
        if let Some(key) = key {
            self.index.entry(key).or_default().push(self.pairs.len());
        }
        self.pairs.push(Some(pair));
    }
}
