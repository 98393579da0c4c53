//! External images and buffers: the states in which frames find and leave them, and the choice among those that were imported.

use super::executor::Executor;
use super::outside_owner::OutsideOwner;
use super::submission::{ExternalStates, ResourceState};
use crate::base::Error;
use crate::memory::create_info;
use crate::prepare::descriptor;
use ash::vk;
use framewright_graph::plan::{BufferId, Resource, Role};

impl Executor {
    /// The states of the external image or buffer `name`: an output, or one that is imported. `None` if the Plan has no such one.
    #[must_use]
    pub fn external_states(&self, name: &str) -> Option<ExternalStates> {
        let resource = self.external(name)?;
        let Role::External { before, after } = self.plan.role(resource) else { return None };
        Some(ExternalStates { before: ResourceState::of(*before), after: ResourceState::of(*after) })
    }

    /// How an image is created that can be imported for the external image `name`. `None` if the Plan has no such image.
    #[must_use]
    pub fn image_info(&self, name: &str) -> Option<vk::ImageCreateInfo<'_>> {
        match self.external(name)? {
            Resource::Image(image) => {
                let descriptor = descriptor(self.plan.image(image));
                Some(create_info(&descriptor, &self.gpu.queues.families.indices))
            }
            Resource::Buffer(_) => None,
        }
    }

    /// Says who has the external image or buffer `name` between frames; `None`: the queues of this device, as at first. Each frame then
    /// takes it over before its first use, from the state `before` of [`Executor::external_states`], and gives it back in the state
    /// `after`. What was to be left as it was, and is in the layout `UNDEFINED` before the frame, isn't taken over: its contents are lost.
    /// The other owner gives and takes it by barriers of its own, in the same layouts. Frames in flight are waited for.
    ///
    /// What a frame gave away is taken back from the owner that it was given to, and what a frame kept isn't taken, also where the owner is
    /// another one by then. What the program has imported and no frame has used yet is at the owner. An executor that
    /// [goes on](Executor::migrate_from) from this one keeps the owner, by name, unless it was told another one.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such external image or buffer, or the device can't take anything from that owner.
    pub fn set_owner(&mut self, name: &str, owner: Option<OutsideOwner>) -> Result<(), Error> {
        if owner == Some(OutsideOwner::Foreign) && !self.gpu.takes_foreign {
            let what = format!(
                "`{name}` can't have a foreign owner: {} {} VK_EXT_queue_family_foreign",
                self.gpu.summary.name,
                if self.gpu.is_adopted { "was created without" } else { "lacks" }
            );
            return Err(Error::BadResource { what });
        }
        let resource = self.external(name);
        let unknown = || Error::BadResource { what: format!("the Plan has no external image or buffer `{name}`") };
        let resource = resource.ok_or_else(unknown)?;
        self.frames.wait_for_all()?;
        let import = self.imports.iter_mut().find(|import| import.resource == resource);
        import.ok_or_else(unknown)?.ownership.owner = owner;
        Ok(())
    }

    /// Whether somebody outside of the device has what stands for it in a frame.
    pub(super) fn is_outside(&self, resource: Resource, frame: u64) -> bool {
        let physical = &self.prepared.physical;
        self.imports.iter().any(|it| it.resource == resource && it.holder(physical, frame).is_some())
    }

    /// Notes that a frame is on its way: it has given away what has an outside owner.
    pub(super) fn drawn(&mut self, number: u64) {
        self.runs.recorded();
        for import in &mut self.imports {
            import.drawn(&self.prepared.physical, number, self.first_frame + number);
        }
    }

    /// Chooses among the program's buffers and images for the next frame.
    pub(super) fn choose_images(&mut self, images: &[(&str, usize)]) -> Result<(), Error> {
        let physical = &self.prepared.physical;
        let none =
            |(name, choice): &&(&str, usize)| !self.external(name).is_some_and(|it| physical.has_choice(it, *choice));
        if let Some((name, choice)) = images.iter().find(none) {
            let what = format!("`{name}` has no image {choice} of the program's");
            return Err(Error::BadResource { what });
        }
        for number in 0..self.in_turn.len() {
            self.take_turn(self.in_turn[number].0);
        }
        for (name, choice) in images {
            if let Some(resource) = self.external(name) {
                self.prepared.physical.choose(resource, *choice);
            }
        }
        Ok(())
    }

    /// Chooses the one whose turn it is in the next frame, if the program has imported buffers for this one.
    pub(super) fn take_turn(&mut self, buffer: BufferId) {
        if let Some((_, count)) = self.in_turn.iter().find(|(of, _)| *of == buffer) {
            let turn = usize::try_from(self.frames() % *count as u64).unwrap_or(0);
            self.prepared.physical.choose(Resource::Buffer(buffer), turn);
        }
    }

    /// The external image or buffer of this name.
    pub(super) fn external(&self, name: &str) -> Option<Resource> {
        let mut all = self.imports.iter().map(|import| import.resource);
        all.find(|it| self.plan.resource_name(*it) == name)
    }
}
