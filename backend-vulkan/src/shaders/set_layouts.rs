//! Layouts of sets that the program makes itself.

use ash::vk;

/// Vulkan's layouts of the sets that the program binds itself, by their numbers, where it has made them: they can have immutable
/// samplers. A set without one here gets a layout as [`ProgramSet`] says, and the program's own sets fit it if theirs are made alike.
///
/// [`ProgramSet`]: framewright_graph::shader::ProgramSet
#[derive(Debug, Clone, Default)]
pub struct SetLayouts(Vec<(u32, vk::DescriptorSetLayout)>);

impl SetLayouts {
    /// With the layout of another set, in place of the one of its number.
    ///
    /// # Safety
    /// It must be of the device of all executors that it is used for, be made as its `ProgramSet` says, and live as long as executors are
    /// made on that device.
    #[must_use]
    pub unsafe fn with(mut self, set: u32, layout: vk::DescriptorSetLayout) -> SetLayouts {
        self.0.retain(|(known, _)| *known != set);
        self.0.push((set, layout));
        self
    }

    /// The layout of a set.
    pub(crate) fn of(&self, set: u32) -> Option<vk::DescriptorSetLayout> {
        self.0.iter().find(|(known, layout)| *known == set && *layout != vk::DescriptorSetLayout::null()).map(|it| it.1)
    }
}
