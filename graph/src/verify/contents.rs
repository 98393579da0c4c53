//! Whether contents that are read were ever written, and not lost since.

use super::accesses::does;
use super::clocks::Time;
use super::findings::{Finding, name};
use super::program::Access;
use super::subresources::{Contents, LostContents, SubresourceState};
use super::violation::{Loss, Rule, StepName};
use super::walk::Walk;
use crate::plan::StepId;

impl<const Q: usize> SubresourceState<Q> {
    /// The effects of an access now.
    fn change_contents(&mut self, effects: u8, now: Time) {
        if effects & does::FILL != 0 {
            self.contents = Contents::Defined;
            self.filled = now;
        } else if effects & does::ADD != 0 {
            match self.contents {
                Contents::Defined => self.filled = now,
                Contents::Unwritten => self.contents = Contents::InPart(now),
                Contents::InPart(_) | Contents::Lost(..) => {}
            }
        }
        if effects & (does::NOT_LOAD | does::NOT_STORE | does::STORE_NONE) == 0 {
            return;
        }
        let lost = match self.contents {
            Contents::Defined if effects & does::NOT_LOAD != 0 => LostContents::NotLoaded,
            Contents::Defined if effects & does::NOT_STORE != 0 => LostContents::NotStored,
            // A store operation `NONE` keeps the contents before the scope, but not the scope's writes.
            Contents::Defined if effects & does::STORE_NONE != 0 && self.filled == now => LostContents::NotStored,
            _ => return,
        };
        self.contents = Contents::Lost(lost, now);
    }
}

impl<const Q: usize> Walk<'_, '_, Q> {
    /// Checks and updates the contents of a part for an access.
    #[inline]
    pub(super) fn contents(&mut self, step: StepId, access: &Access, index: usize) {
        if access.contents & does::READ != 0 && self.subresources[index].contents != Contents::Defined {
            let finding = self.undefined(step, access.resource, index);
            self.late.push(finding);
        }
        let now = self.now(step);
        self.subresources[index].change_contents(access.contents, now);
    }

    /// The contents of a part are relied on.
    pub(super) fn read(&mut self, step: StepId, resource: u32, index: usize) {
        if self.subresources[index].contents != Contents::Defined {
            let finding = self.undefined(step, resource, index);
            self.found.push(finding);
        }
    }

    /// The mistake of reading a part that is not defined.
    #[cold]
    fn undefined(&mut self, step: StepId, resource: u32, index: usize) -> Finding {
        let (rule, other) = match self.subresources[index].contents {
            Contents::Defined | Contents::Unwritten => {
                let first = self.program.used[resource as usize].steps().map(|[first, _]| first);
                (Rule::Uninitialised { in_part: false }, first.map(|first| StepName::new(self.plan, first, 0)))
            }
            Contents::InPart(time) => (Rule::Uninitialised { in_part: true }, self.name_at(time, resource)),
            Contents::Lost(lost, time) => (Rule::LostWrite { loss: self.loss(lost) }, self.name_at(time, resource)),
        };
        self.subresources[index].contents = Contents::Defined;
        let (range, bytes) = (self.range(resource, index), self.buffer_bytes(resource));
        Finding { rule, step, other, resource, range, bytes }
    }

    fn loss(&self, lost: LostContents) -> Loss {
        match lost {
            LostContents::Forgotten => Loss::Forgotten,
            LostContents::NotLoaded => Loss::NotLoaded,
            LostContents::NotStored => Loss::NotStored,
            LostContents::Taken(by) => Loss::Taken { by: name(self.plan, by).clone() },
        }
    }
}
