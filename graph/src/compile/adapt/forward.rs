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
    fn may_share(&mut self, number: u32, store: StoreIndex, to: ImageIndex) -> bool {
        let Adapter { live, store_of, resolved_of, is_output, known_as, image_of, .. } = self;
        let later = |pass: Option<u32>| pass.is_some_and(|pass| pass > number);
        let held = |image: usize| store_of[image] == Some(store) || image == to.0 as usize;
        let known = known_as.entry(store).or_insert_with(|| vec![image_of[store as usize]]);
        // What isn't used any more by now never is again, so a long chain of forwards is no long list.
        known.retain(|image| (later(live.last_access[*image]) || is_output[*image]) && *image != to.0 as usize);
        known.retain(|image| held(*image) || resolved_of[*image] == Some(store));
        known.push(to.0 as usize);
        let both_leave = known.iter().filter(|image| is_output[**image]).count() > 1;
        let told_apart = known.len() > 1 && known.iter().any(|image| held(*image) && later(live.last_write[*image]));
        !both_leave && !told_apart
    }
}
