//! External images and buffers: the states in which frames find and leave them, and the choice among those that were imported.

use super::executor::Executor;
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
        let Role::External { before, after, .. } = self.plan.role(resource) else { return None };
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
