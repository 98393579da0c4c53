//! Places where something stood first, to find what stands twice.

use std::collections::HashMap;
use std::hash::Hash;

/// The most keys that are compared one by one.
const FEW: usize = 8;

/// The last place of each key. Most entries have a few keys, which are compared without being hashed.
pub(crate) struct Firsts<K, V> {
    few: [Option<(K, V)>; FEW],
    /// All keys beyond those.
    many: HashMap<K, V>,
}

impl<K, V> Default for Firsts<K, V> {
    fn default() -> Firsts<K, V> {
        Firsts { few: [const { None }; FEW], many: HashMap::new() }
    }
}

impl<K: Eq + Hash, V> Firsts<K, V> {
    /// Keeps the place of a key, and returns the one before it, if there is one.
    pub(crate) fn insert(&mut self, key: K, place: V) -> Option<V> {
        for slot in &mut self.few {
            match slot {
                Some((known, before)) if *known == key => return Some(std::mem::replace(before, place)),
                Some(_) => {}
                None => {
                    *slot = Some((key, place));
                    return None;
                }
            }
        }
        self.many.insert(key, place)
    }
}
