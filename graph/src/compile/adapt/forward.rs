//! Passes that are off: their target takes what another image holds.

use super::Adapter;
use crate::compile::model::{OpKind, Role, Start, StoreIndex, Use};
use crate::describe::Diagnostic;
use crate::frame::{ImageIndex, Pass};
use crate::plan::Cause;
use crate::vocabulary::{Filter, Stages};

impl Adapter<'_> {
    /// `to` takes what `from` holds: as the same image if nothing tells them apart, else by a copy or a draw.
    pub(super) fn forward(&mut self, number: u32, pass: &Pass, from: ImageIndex, to: ImageIndex, because: &str) {
        let frame = self.frame;
        if from == to {
            let name = &frame.images[to.0 as usize].name;
            return self.note(name, format!("`{}` is off ({because}) and leaves it as it is", pass.name), pass.span);
        }
        let (source_image, target_image) = (&frame.images[from.0 as usize], &frame.images[to.0 as usize]);
        let alike = (source_image.format, source_image.extent) == (target_image.format, target_image.extent)
            && self.samples.of(from) == self.samples.of(to);
        let resolves = self.samples.of(from) > 1 && !alike;
        let why = format!(
            "`{}` is off ({because}) and forwards `{}` to `{}`",
            pass.name, source_image.name, target_image.name
        );
        let source = if resolves {
            let why = format!("{why}; `{}` has {} samples", source_image.name, self.samples.of(from));
            match self.resolved(from, why, pass.span) {
                Some(source) => source,
                None => return,
            }
        } else {
            self.current(from)
        };
        let same = {
            let held = self.adapted.stores[source as usize].descriptor;
            (held.format, held.extent, held.mips, held.layers, held.samples)
                == (
                    target_image.format,
                    target_image.extent,
                    target_image.mips,
                    target_image.layers,
                    self.samples.of(to),
                )
        };
        if same && self.may_share(number, source, to) {
            let name = target_image.name.clone();
            let store = &mut self.adapted.stores[source as usize];
            if !resolves {
                store.cause = Cause::Inserted { because: why.clone(), at: frame.sources.place(pass.span) };
            }
            store.name = name.clone();
            self.named = true;
            self.store_of[to.0 as usize] = Some(source);
            self.resolved_of[to.0 as usize] = None;
            let what = if resolves { "the resolve goes straight into it" } else { "they are one image" };
            return self.note(&name, format!("{why}: {what}"), pass.span);
        }
        if same {
            let target = self.written(to, false);
            let uses = [Use { store: source, role: Role::Source }, Use { store: target, role: Role::Target }];
            let at = self.place(pass.span);
            let because = format!("{why}; one of them is used again later");
            return self.push(OpKind::Copy { because, at }, &uses);
        }
        self.forward_by_draw(number, pass, source, to, why);
    }

    fn forward_by_draw(&mut self, number: u32, pass: &Pass, source: StoreIndex, to: ImageIndex, why: String) {
        let held = self.adapted.stores[source as usize].descriptor;
        let target_image = &self.frame.images[to.0 as usize];
        let drawable = |depth: bool, integer: bool| !depth && !integer;
        if !drawable(held.format.is_depth(), held.format.is_integer())
            || !drawable(target_image.format.is_depth(), target_image.format.is_integer())
        {
            let message = format!("{why}, but {} can't be drawn into {}", held.format, target_image.format);
            self.errors.push(Diagnostic::new(pass.span, message).help("give both the same format, size and samples"));
            return;
        }
        let filtered = held.extent != target_image.extent
            && self.device.format(held.format).is_some_and(|support| support.linear_filter);
        let filter = if filtered { Filter::Linear } else { Filter::Nearest };
        let differ = match (held.format == target_image.format, held.extent == target_image.extent) {
            (false, true) => format!("formats differ ({} and {})", held.format, target_image.format),
            (true, false) => "sizes differ".to_owned(),
            (false, false) => "formats and sizes differ".to_owned(),
            (true, true) => "sample counts differ".to_owned(),
        };
        let target = self.written(to, false);
        let uses = [
            Use { store: source, role: Role::Sampled { entry: 0, stages: Stages::FRAGMENT_SHADER } },
            Use { store: target, role: Role::Color { entry: 0, start: Start::Discard, blends: false } },
        ];
        self.push(OpKind::ForwardDraw { pass: number, filter, because: format!("{why}; {differ}") }, &uses);
    }

    /// Whether `to` may live in `store` from pass `number` on: nobody must be able to tell. That holds unless somebody
    /// writes the store under one name while it is still used under another.
    fn may_share(&self, number: u32, store: StoreIndex, to: ImageIndex) -> bool {
        let is_output = |image: usize| self.frame.outputs.iter().any(|output| output.image.0 as usize == image);
        let later = |pass: Option<u32>| pass.is_some_and(|pass| pass > number);
        let holders =
            || (0..self.store_of.len()).filter(|image| self.store_of[*image] == Some(store)).chain([to.0 as usize]);
        let readers = (0..self.store_of.len()).filter(|image| self.resolved_of[*image] == Some(store)).chain(holders());
        let used: Vec<usize> =
            readers.filter(|image| later(self.live.last_access[*image]) || is_output(*image)).collect();
        let both_leave = used.iter().filter(|image| is_output(**image)).count() > 1;
        let told_apart =
            holders().any(|writer| later(self.live.last_write[writer]) && used.iter().any(|other| *other != writer));
        !both_leave && !told_apart
    }
}
