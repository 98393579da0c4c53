//! Passes of a level, and fragments that are put in between them.

use super::evaluation::{Count, Evaluation, Level};
use crate::language::entries::body::{Entry, Item};
use crate::language::model::{Pass, PassDecisions};
use crate::language::scope::Evaluator;
use crate::ron::Reader;
use std::sync::Arc;

impl<'a> Evaluation<'a> {
    /// Everything at one level: images and buffers, then passes.
    pub(super) fn level(&mut self, reader: &mut Reader, level: &mut Level<'a>) {
        self.resources(reader, level);
        for entry in &level.body.items {
            if entry.as_ref().is_none_or(|entry| self.item(reader, level, entry).is_none()) {
                self.flat.fail();
            }
        }
    }

    /// Passes, or a fragment that is put in. `None` if that was reported.
    fn item(&mut self, reader: &mut Reader, level: &Level<'a>, entry: &'a Entry<Item>) -> Option<()> {
        let view = entry.view(reader, level.view)?;
        let Count::Known(count, repeat) = self.count(reader, level, view, Some(&entry.repeat), false) else {
            return None;
        };
        let repeated = PassDecisions { repeat, ..PassDecisions::default() };
        let decided = repeated.within(&level.decided);
        for number in 0..count {
            let before = reader.errors.len();
            let number = entry.repeat.is_list().then_some(number);
            match entry.value.get(reader)? {
                Item::Pass(pass) => {
                    let whole = |mut pass: Arc<Pass>, _: &mut Evaluator<'_, '_>| {
                        if pass.view != view || !level.has_own_names(number) {
                            let pass = Arc::make_mut(&mut pass);
                            pass.name = level.full(&pass.name, number);
                            (pass.view, pass.instance) = (view, level.instance);
                            pass.run = pass.run.take().or_else(|| level.run.clone());
                            if !decided.is_empty() {
                                pass.decided = pass.decided.within(&decided);
                            }
                        }
                        pass
                    };
                    let pass = self.made(reader, level, (pass, view, number), &decided, |_, _| true, whole);
                    self.flat.passes.push(pass);
                }
                Item::Use(fields) if reader.errors.len() == before => {
                    self.put_in(reader, level, (view, number, &repeated), fields)
                }
                Item::Use(_) | Item::Anchor => {}
            }
            if reader.errors.len() > before || self.is_full {
                return None;
            }
        }
        Some(())
    }
}
