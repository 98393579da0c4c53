//! Outside owners that the program tells of an executor, beside those of its Plan.

use super::executor::Executor;
use super::import::Import;
use crate::base::Error;
use crate::prepare::refused_owner;
use framewright_graph::plan::{Plan, Resource, Role};
use framewright_graph::vulkan::OutsideOwner;
use std::borrow::Cow;

impl Executor {
    /// Says who has the external image or buffer `name` between frames; `None`: the queues of this device. It takes the place of what the
    /// pipeline says. The Plan is then the one that is compiled with this owner ([`Plan::set_owner`]): each frame takes the image or buffer
    /// over before its first use, in the state `before` of [`Executor::external_states`], and gives it back in the state `after`. What is in the
    /// layout `UNDEFINED` before the frame isn't taken over: its contents are lost. The other owner gives and takes it by barriers of its own, in the
    /// same layouts. Frames in flight are waited for.
    ///
    /// What a frame gave away is taken back from the owner that it was given to, and what a frame kept isn't taken, also where the owner is
    /// another one by then. What the program has imported and no frame has used yet is at the owner. An executor that
    /// [goes on](Executor::migrate_from) from this one keeps the owner, by name, unless it was told another one.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such external image or buffer, several queues use it, or the device can't take anything from that
    /// owner.
    pub fn set_owner(&mut self, name: &str, owner: Option<OutsideOwner>) -> Result<(), Error> {
        if let Some(what) = owner.and_then(|owner| refused_owner(&self.gpu, name, owner)) {
            return Err(Error::BadResource { what });
        }
        if self.external(name).is_none() {
            let what = format!("the Plan has no external image or buffer `{name}`");
            return Err(Error::BadResource { what });
        }
        self.wait_for_all()?;
        let told = (name.to_owned(), owner);
        with_owners(&mut self.plan, std::slice::from_ref(&told)).map_err(|what| Error::BadResource { what })?;
        self.told.retain(|(of, _)| of != name);
        self.told.push(told);
        self.follow_owners();
        Ok(())
    }

    /// The first difference of another Plan, with the [owners](Executor::set_owner) that this executor was told, beside values, in words;
    /// `None`: [`Executor::change`] takes it.
    #[must_use]
    pub fn differs_beyond_values(&self, plan: &Plan) -> Option<String> {
        match self.with_told_owners(plan) {
            Ok(plan) => self.plan.differs_beyond_values(&plan),
            Err(what) => Some(what),
        }
    }

    /// Whether another Plan can have the [owners](Executor::set_owner) that this executor was told: one that an executor is to execute which
    /// [goes on](Executor::migrate_from) from this one.
    ///
    /// # Errors
    /// [`Error::BadResource`] if several queues use in it what has an outside owner.
    pub fn check_owners(&self, plan: &Plan) -> Result<(), Error> {
        self.with_told_owners(plan).map(drop).map_err(|what| Error::BadResource { what })
    }

    /// A Plan with the owners that this executor was told.
    pub(super) fn with_told_owners<'p>(&self, plan: &'p Plan) -> Result<Cow<'p, Plan>, String> {
        if self.told.is_empty() {
            return Ok(Cow::Borrowed(plan));
        }
        let mut plan = plan.clone();
        with_owners(&mut plan, &self.told)?;
        Ok(Cow::Owned(plan))
    }

    /// Has the same outside owners as `before`, by name, but for those that the program told this one. What became of images and buffers that
    /// this Plan doesn't know is kept for the executor after this one.
    pub(super) fn take_owners(&mut self, before: &mut Executor) -> Result<(), Error> {
        for told in std::mem::take(&mut before.told) {
            if self.told.iter().all(|(name, _)| *name != told.0) {
                with_owners(&mut self.plan, std::slice::from_ref(&told)).map_err(|what| Error::BadResource { what })?;
                self.told.push(told);
            }
        }
        self.follow_owners();
        let names = |import: &Import| before.plan.resource_name(import.resource).to_owned();
        let known = before.imports.iter().map(|it| (names(it), it.ownership.clone()));
        for (name, ownership) in known.chain(std::mem::take(&mut before.elsewhere)) {
            let resource = self.external(&name);
            match self.imports.iter_mut().find(|it| Some(it.resource) == resource) {
                Some(import) => import.ownership.take_over(&ownership),
                None if ownership.is_unused() => {}
                None => self.elsewhere.push((name, ownership)),
            }
        }
        Ok(())
    }

    /// Has the owners that the Plan says.
    fn follow_owners(&mut self) {
        for import in &mut self.imports {
            import.ownership.owner = self.plan.role(import.resource).owner();
        }
    }
}

/// Puts these owners into a Plan, as far as it knows the names.
fn with_owners(plan: &mut Plan, owners: &[(String, Option<OutsideOwner>)]) -> Result<(), String> {
    for (name, owner) in owners {
        let images = plan.images.iter().map(|it| (&it.name, Resource::Image(it.id), &it.role));
        let mut all = images.chain(plan.buffers.iter().map(|it| (&it.name, Resource::Buffer(it.id), &it.role)));
        let known = all.find(|(of, _, role)| ***of == **name && matches!(role, Role::External { .. }));
        if let Some((_, resource, _)) = known {
            plan.set_owner(resource, *owner)?;
        }
    }
    Ok(())
}
