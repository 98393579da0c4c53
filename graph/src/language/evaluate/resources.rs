//! Images and buffers of a level: how many there are, then the properties of each.

use super::evaluation::{Count, Evaluation, Level};
use super::properties;
use crate::language::model::{Buffer, Image, PassDecisions};
use crate::language::scope::{Elements, Evaluator, FieldValueTuple, ScopeValues};
use crate::ron::Reader;
use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

impl<'a> Evaluation<'a> {
    /// Gives images and buffers their indices, then evaluates them. A number of repetitions that depends on images waits until
    /// the images above are evaluated; those can't refer to images below then.
    pub(super) fn resources(&mut self, reader: &mut Reader, level: &mut Level<'a>) {
        let body = level.body;
        let images = body.images.len();
        let mut evaluated = 0;
        let [mut next_image, mut next_buffer] = [self.flat.images.len(), self.flat.buffers.len()];
        for at in 0..images + body.buffers.len() {
            let (repeat, view) = match at.checked_sub(images) {
                None => body.images[at].as_ref().map(|entry| (&entry.repeat, entry.view(reader, level.view))),
                Some(at) => body.buffers[at].as_ref().map(|entry| (&entry.repeat, entry.view(reader, level.view))),
            }
            .unzip();
            let view = view.unwrap_or(Some(level.view)).unwrap_or_default();
            let mut count = self.count(reader, level, view, repeat, true);
            if let Count::Later = count {
                self.each(reader, level, evaluated..at);
                evaluated = at;
                count = self.count(reader, level, view, repeat, false);
            }
            let next = if at < images { &mut next_image } else { &mut next_buffer };
            let elements = match (count, u32::try_from(*next)) {
                (Count::Known(count, by), Ok(first)) => {
                    if !by.is_empty() {
                        level.repeats.push((at, by));
                    }
                    *next += count as usize;
                    Elements::At { first, count }
                }
                _ => Elements::Failed,
            };
            match at.checked_sub(images) {
                None => level.values.images[at] = elements,
                Some(at) => level.values.buffers[at] = elements,
            }
        }
        self.each(reader, level, evaluated..images + body.buffers.len());
    }

    /// Evaluates images and buffers by number: images are counted first, then buffers.
    fn each(&mut self, reader: &mut Reader, level: &Level<'a>, range: Range<usize>) {
        let images = level.body.images.len();
        for at in range {
            let elements = match at.checked_sub(images) {
                None => level.values.images[at],
                Some(at) => level.values.buffers[at],
            };
            match (elements, at.checked_sub(images)) {
                (Elements::At { count, .. }, None) => self.image(reader, level, at, count),
                (Elements::At { count, .. }, Some(at)) => self.buffer(reader, level, at, count),
                (Elements::Below | Elements::Failed, _) => self.flat.fail(),
            }
        }
    }

    fn image(&mut self, reader: &mut Reader, level: &Level<'a>, at: usize, count: u32) {
        let entry = level.body.images[at].as_ref();
        let view = entry.map_or(Some(level.view), |entry| entry.view(reader, level.view));
        let mut right = view.is_some();
        let view = view.unwrap_or_default();
        let repeat = level.repeats.binary_search_by_key(&at, |(at, _)| *at).map(|found| level.repeats[found].1.clone());
        let decided = PassDecisions { repeat: repeat.unwrap_or_default(), ..PassDecisions::default() };
        for number in 0..count {
            let before = reader.errors.len();
            let number = level.body.symbols.image_lists[at].then_some(number);
            // Mistakes in its size are told by its own name, so these are found before it has the whole one.
            let known = Cell::new(None);
            let whole = |mut image: Arc<Image>, evaluator: &mut Evaluator<'_, '_>| {
                known.set(properties::of(&image, &evaluator.scope).map_err(|wrong| evaluator.fault(wrong)).ok());
                if image.view != view || !level.has_own_names(number) {
                    let image = Arc::make_mut(&mut image);
                    image.name = level.full(&image.name, number);
                    (image.view, image.instance) = (view, level.instance);
                    image.repeat = decided.repeat.clone();
                }
                image
            };
            let fits = |image: &Image, scope: &ScopeValues<'_>| {
                known.set(properties::of(image, scope).ok());
                known.get().is_some()
            };
            let image = entry.filter(|_| right).and_then(|entry| {
                let entry = entry.value.get(reader)?;
                self.made(reader, level, (entry, view, number), &decided, fits, whole)
            });
            self.flat.properties.push(known.get());
            self.flat.images.push(image);
            // The other elements have the same mistake.
            right = reader.errors.len() == before;
        }
    }

    fn buffer(&mut self, reader: &mut Reader, level: &Level<'_>, at: usize, count: u32) {
        let entry = level.body.buffers[at].as_ref();
        let view = entry.map_or(Some(level.view), |entry| entry.view(reader, level.view));
        let mut right = view.is_some();
        let view = view.unwrap_or_default();
        for number in 0..count {
            let before = reader.errors.len();
            let number = level.body.symbols.buffer_lists[at].then_some(number);
            let buffer = entry.filter(|_| right).and_then(|entry| {
                let buffer = entry.value.get(reader)?;
                buffer.evaluate(&mut self.evaluator(reader, level, view, number))
            });
            self.flat.buffers.push(buffer.map(|buffer| {
                let name = level.full(&buffer.name, number);
                Buffer { name, instance: level.instance, ..buffer }
            }));
            right = reader.errors.len() == before;
        }
    }
}
