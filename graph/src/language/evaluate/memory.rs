//! What an evaluation made, for the next one of the same document: an entry is evaluated again only where something that it asked for
//! has another value.

use super::evaluation::{Evaluation, Level};
use crate::frame::{Cadence, ViewIndex};
use crate::language::entries::pipeline::Entries;
use crate::language::model::{Image, Pass, PassDecisions};
use crate::language::scope::{Answers, Asked, Evaluator, FieldContents, FieldValue, FieldValueTuple, ScopeValues};
use crate::ron::Reader;
use std::collections::HashMap;
use std::sync::Arc;

/// The images and passes that the last evaluation of a document made.
#[derive(Default)]
pub(crate) struct Memory {
    images: Table<Image>,
    passes: Table<Pass>,
    /// The number of the evaluation at hand.
    turn: u64,
    /// The entries of the document. They are held, so that no others get their addresses.
    entries: Option<Arc<Entries>>,
}

/// Images or passes by the places that they have in a document.
pub(super) type Table<T> = HashMap<Place, EvaluatedEntry<T>>;

/// The place of an image or pass: the address of its entry, the fragment's instance, and the number of the repetition.
pub(super) type Place = (usize, Option<u32>, Option<u32>);

/// An image or pass that was made of an entry.
pub(super) struct EvaluatedEntry<T> {
    value: Arc<T>,
    /// What its entry asked for, and what the level gave it.
    asked: Vec<Asked>,
    given: LevelContext,
    /// The last evaluation that it is part of.
    turn: u64,
}

/// What a level gives to the images and passes of its entries, beside the values that they ask for.
struct LevelContext {
    prefix: Arc<str>,
    view: ViewIndex,
    off: bool,
    decided: PassDecisions,
    run: Option<Cadence>,
}

impl LevelContext {
    fn is_same(&self, level: &Level<'_>, view: ViewIndex, decided: &PassDecisions) -> bool {
        let named = self.view == view && self.prefix == level.prefix;
        named && self.off == level.off && self.decided == *decided && self.run == level.run
    }
}

/// What is remembered: images and passes.
pub(super) trait Remembered: FieldContents {
    /// The table of its kind.
    fn table(memory: &mut Memory) -> &mut Table<Self>;
}

impl Remembered for Image {
    fn table(memory: &mut Memory) -> &mut Table<Image> {
        &mut memory.images
    }
}

impl Remembered for Pass {
    fn table(memory: &mut Memory) -> &mut Table<Pass> {
        &mut memory.passes
    }
}

impl Memory {
    /// Begins an evaluation of these entries. What was made of others is forgotten.
    pub(crate) fn begin(&mut self, entries: &Arc<Entries>) {
        if self.entries.as_ref().is_none_or(|known| !Arc::ptr_eq(known, entries)) {
            *self = Memory { entries: Some(Arc::clone(entries)), ..Memory::default() };
        }
        self.turn += 1;
    }

    /// Forgets what the evaluation at hand has no part in.
    pub(super) fn end(&mut self) {
        self.images.retain(|_, thing| thing.turn == self.turn);
        self.passes.retain(|_, thing| thing.turn == self.turn);
    }
}

impl<'a> Evaluation<'a> {
    /// The image or pass that an entry makes. If all that it depends on is as it was in the last evaluation, and it still `fits`, the last
    /// one is taken. Else the entry is evaluated, and `finish` gives the result its whole name and its place.
    pub(super) fn made<T: Remembered>(
        &mut self,
        reader: &mut Reader,
        level: &Level<'a>,
        (entry, view, number): (&FieldValue<Arc<T>>, ViewIndex, Option<u32>),
        decided: &PassDecisions,
        fits: impl FnOnce(&T, &ScopeValues<'_>) -> bool,
        finish: impl FnOnce(Arc<T>, &mut Evaluator<'_, '_>) -> Arc<T>,
    ) -> Option<Arc<T>> {
        let Some(memory) = self.memory.take() else {
            let mut evaluator = self.evaluator(reader, level, view, number);
            return Some(finish(entry.evaluate(&mut evaluator)?, &mut evaluator));
        };
        let turn = memory.turn;
        let place = (std::ptr::from_ref(entry).addr(), level.instance, number);
        let known = T::table(memory).get_mut(&place).filter(|thing| {
            let scope = self.scope(level, view, number);
            let same = thing.given.is_same(level, view, decided) && thing.asked.iter().all(|it| it.is_same(&scope));
            same && fits(&thing.value, &scope)
        });
        if let Some(thing) = known {
            let value = thing.value.clone();
            thing.turn = turn;
            self.memory = Some(memory);
            return Some(value);
        }
        let (answers, before) = (Answers::default(), reader.errors.len());
        let mut evaluator = self.evaluator(reader, level, view, number);
        evaluator.scope.answers = Some(&answers);
        let made = entry.evaluate(&mut evaluator).map(|thing| finish(thing, &mut evaluator));
        if let Some(value) = made.as_ref().filter(|_| reader.errors.len() == before) {
            let (prefix, run) = (level.prefix.clone(), level.run.clone());
            let given = LevelContext { prefix, view, off: level.off, decided: decided.clone(), run };
            let (value, asked) = (value.clone(), answers.into_inner());
            let thing = EvaluatedEntry { value, asked, given, turn };
            T::table(memory).insert(place, thing);
        }
        self.memory = Some(memory);
        made
    }
}
