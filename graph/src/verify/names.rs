//! Names that were seen, to find those that are given twice.

use std::collections::HashSet;
use std::hash::{BuildHasher, Hasher, RandomState};

/// The names that were seen so far.
pub(super) struct Names<'p>(HashSet<&'p str, Key>);

/// The random key of the hashes of one set: names that collide can't be chosen without knowing it.
#[derive(Clone, Copy)]
struct Key(u64);

/// A hash of a short text, eight bytes at a time.
struct Hash(u64);

impl<'p> Names<'p> {
    /// No names, and room for as many as are expected.
    pub(super) fn new(expected: usize) -> Names<'p> {
        Names(HashSet::with_capacity_and_hasher(expected, Key(RandomState::new().hash_one(expected))))
    }

    /// Adds a name; whether it is new.
    pub(super) fn insert(&mut self, name: &'p str) -> bool {
        self.0.insert(name)
    }
}

impl BuildHasher for Key {
    type Hasher = Hash;

    fn build_hasher(&self) -> Hash {
        Hash(self.0)
    }
}

impl Hash {
    /// Multiplies to 128 bits, and folds them: each bit of the result depends on all bits.
    fn mix(&mut self, word: u64) {
        let product = u128::from(self.0 ^ word) * 0x9e37_79b9_7f4a_7c15;
        self.0 = product as u64 ^ (product >> 64) as u64;
    }
}

impl Hasher for Hash {
    fn write(&mut self, bytes: &[u8]) {
        let (words, rest) = bytes.as_chunks();
        words.iter().for_each(|word| self.mix(u64::from_le_bytes(*word)));
        let last = rest.iter().fold(bytes.len() as u64, |last, byte| last << 8 | u64::from(*byte));
        self.mix(last);
    }

    /// The end of a text: its length is part of its hash.
    fn write_u8(&mut self, _: u8) {}

    fn finish(&self) -> u64 {
        self.0
    }
}
