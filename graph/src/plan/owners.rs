//! Who has external images and buffers between frames: the one rule of which transfers that takes, and where they stand.

use super::{OutsideTransfer, OutsideWay, Plan, Resource, Role, Totals};
use crate::vulkan::{Layout, OutsideOwner};

impl OutsideTransfer {
    /// What takes an external image or buffer over. `None`: its contents aren't needed, or it isn't external.
    #[must_use]
    pub fn acquire(resource: Resource, owner: OutsideOwner, role: &Role) -> Option<OutsideTransfer> {
        OutsideTransfer::of(resource, owner, OutsideWay::Acquire, role)
    }

    fn of(resource: Resource, owner: OutsideOwner, way: OutsideWay, role: &Role) -> Option<OutsideTransfer> {
        let Role::External { before, after, .. } = role else { return None };
        let state = match way {
            OutsideWay::Acquire => before,
            OutsideWay::Release => after,
        };
        let holds = matches!(resource, Resource::Buffer(_)) || state.layout != Layout::Undefined;
        // A state without stages is left to semaphores, which wait for everything: so does the transfer beside them.
        holds.then_some(OutsideTransfer { resource, owner, way, state: state.or_everything() })
    }
}

impl Plan {
    /// Says who outside of the device has an external image or buffer between frames; `None`: nobody. The transfers that it takes are put
    /// into the Plan in place of those that there are. A Plan that was compiled with this owner is equal to it, if one queue alone uses the
    /// image or buffer.
    ///
    /// # Errors
    /// In words: it isn't external, or several queues use it. The Plan stays as it is.
    pub fn set_owner(&mut self, resource: Resource, owner: Option<OutsideOwner>) -> Result<(), String> {
        // The transfers that there are go: they are no use.
        let uses = |number: &usize| self.steps[*number].touched_inside().any(|it| it == resource);
        let users: Vec<usize> = (0..self.steps.len()).filter(uses).collect();
        let mut queues = users.iter().map(|number| self.steps[*number].queue);
        let first = queues.next();
        if owner.is_some() && queues.any(|queue| Some(queue) != first) {
            let name = self.resource_name(resource);
            return Err(format!("several queues use `{name}`: its pipeline must say that it has an outside owner"));
        }
        let role = match resource {
            Resource::Image(image) => &mut self.images[image.0 as usize].role,
            Resource::Buffer(buffer) => &mut self.buffers[buffer.0 as usize].role,
        };
        let Role::External { owner: stated, .. } = role else {
            return Err(format!("`{}` isn't external", self.resource_name(resource)));
        };
        *stated = owner;
        let role = role.clone();
        self.steps.iter_mut().for_each(|step| step.outside.retain(|it| it.resource != resource));
        if let (Some(owner), Some(first), Some(last)) = (owner, users.first(), users.last()) {
            let transfer = |way| OutsideTransfer::of(resource, owner, way, &role);
            self.steps[*first].outside.extend(transfer(OutsideWay::Acquire));
            self.steps[*last].outside.extend(transfer(OutsideWay::Release));
            self.steps[*first].outside.sort_by_key(|it| it.resource);
            self.steps[*last].outside.sort_by_key(|it| it.resource);
        }
        self.totals = Totals {
            transient_bytes: self.totals.transient_bytes,
            placed_bytes: self.totals.placed_bytes,
            live_peak_bytes: self.totals.live_peak_bytes,
            kept_bytes: self.totals.kept_bytes,
            ..Totals::count(&self.steps)
        };
        Ok(())
    }
}
