//! Passes of a level, and fragments that are put in between them.

use super::evaluation::{Count, Evaluation, Level, indexed};
use crate::language::entries::body::{Entry, Item};
use crate::language::model::Pass;
use crate::ron::Reader;

impl<'t> Evaluation<'_, 't> {
    /// Everything at one level: images and buffers, then passes.
    pub(super) fn level(&mut self, reader: &mut Reader, level: &mut Level<'_, 't>) {
        self.resources(reader, level);
        for entry in &level.body.items {
            if entry.as_ref().is_none_or(|entry| self.item(reader, level, entry).is_none()) {
                self.flat.fail();
            }
        }
    }

    /// Passes, or a fragment that is put in. `None` if that was reported.
    fn item(&mut self, reader: &mut Reader, level: &Level<'_, 't>, entry: &Entry<'t, Item<'t>>) -> Option<()> {
        let view = match &entry.fields {
            Item::Pass(fields) => fields.view,
            Item::Use(fields) => fields.view,
            Item::Anchor => return Some(()),
        };
        let view = self.view(reader, level, view)?;
        let Count::Known(count) = self.count(reader, level, view, Some(&entry.repeat), false) else { return None };
        for number in 0..count {
            let before = reader.errors.len();
            let index = indexed(&entry.repeat, number);
            let number = entry.repeat.is_list().then_some(number);
            match &entry.fields {
                Item::Pass(fields) => {
                    let pass = self.context(reader, level, view, index).pass(fields);
                    self.flat.passes.push(pass.map(|pass| {
                        let name = level.full(&pass.name, number);
                        Pass { name, view, instance: level.instance, ..pass }
                    }));
                }
                Item::Use(fields) => self.put_in(reader, level, view, (index, number), fields),
                Item::Anchor => {}
            }
            if reader.errors.len() > before || self.is_full {
                return None;
            }
        }
        Some(())
    }
}
