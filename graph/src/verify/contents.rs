//! Whether contents that are read were ever written, and not lost since.

use super::accesses::does;
use super::findings::{Finding, name};
use super::program::Access;
use super::subresources::{Contents, Lost};
use super::violation::{Loss, Rule, StepName};
use super::walk::Walk;
use crate::plan::StepId;

impl<const Q: usize> Walk<'_, '_, Q> {
    /// Checks and updates contents for an access.
    pub(super) fn contents(&mut self, step: StepId, access: &Access) {
        let now = self.now(step);
        let mut part = self.parts.of(access.resource, access.range);
        while let Some(index) = self.parts.next(&mut part) {
            if access.contents & does::READ != 0 {
                self.read(step, access.resource, index);
            }
            let state = &mut self.subresources[index];
            if access.contents & does::FILL != 0 {
                state.contents = Contents::Defined;
                state.filled = now;
            } else if access.contents & does::ADD != 0 {
                match state.contents {
                    Contents::Defined => state.filled = now,
                    Contents::Unwritten => state.contents = Contents::InPart(now),
                    Contents::InPart(_) | Contents::Lost(..) => {}
                }
            }
            let lost = match state.contents {
                Contents::Defined if access.contents & does::NOT_LOAD != 0 => Lost::NotLoaded,
                Contents::Defined if access.contents & does::NOT_STORE != 0 => Lost::NotStored,
                // A store operation `NONE` keeps the contents before the scope, but not the scope's writes.
                Contents::Defined if access.contents & does::STORE_NONE != 0 && state.filled == now => Lost::NotStored,
                _ => continue,
            };
            state.contents = Contents::Lost(lost, now);
        }
    }

    /// A step reads a part.
    pub(super) fn read(&mut self, step: StepId, resource: u32, index: usize) {
        let contents = self.subresources[index].contents;
        let (rule, other) = match contents {
            Contents::Defined => return,
            Contents::Unwritten => {
                let first = self.program.used[resource as usize].steps().map(|[first, _]| first);
                (Rule::Uninitialised { in_part: false }, first.map(|first| StepName::new(self.plan, first, 0)))
            }
            Contents::InPart(time) => (Rule::Uninitialised { in_part: true }, self.name_at(time, resource)),
            Contents::Lost(lost, time) => (Rule::LostWrite { loss: self.loss(lost) }, self.name_at(time, resource)),
        };
        self.subresources[index].contents = Contents::Defined;
        let (range, bytes) = (self.range(resource, index), self.buffer_bytes(resource));
        self.found.push(Finding { rule, step, other, resource, range, bytes });
    }

    fn loss(&self, lost: Lost) -> Loss {
        match lost {
            Lost::Forgotten => Loss::Forgotten,
            Lost::NotLoaded => Loss::NotLoaded,
            Lost::NotStored => Loss::NotStored,
            Lost::Taken(by) => Loss::Taken { by: name(self.plan, by).clone() },
        }
    }
}
