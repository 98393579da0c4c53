//! Names and labels for debuggers and validation messages (`VK_EXT_debug_utils`). Where nobody shows them nothing happens.

use super::handle::Gpu;
use super::instance::Instance;
use ash::vk;
use std::ffi::{CStr, CString};

impl Gpu {
    /// Names an object.
    pub(crate) fn name(&self, object: impl vk::Handle, name: &str) {
        if let Some(labels) = &self.labels {
            let name = c_string(name);
            let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(object).object_name(&name);
            // SAFETY: the object is new and belongs to this device. A name that can't be set is no loss.
            let _ = unsafe { labels.set_debug_utils_object_name(&info) };
        }
    }

    /// Begins a label.
    pub(crate) fn begin_label(&self, commands: vk::CommandBuffer, name: &CStr) {
        if let Some(labels) = &self.labels {
            let label = vk::DebugUtilsLabelEXT::default().label_name(name);
            // SAFETY: the command buffer is being recorded.
            unsafe { labels.cmd_begin_debug_utils_label(commands, &label) };
        }
    }

    /// Ends the label that was begun last.
    pub(crate) fn end_label(&self, commands: vk::CommandBuffer) {
        if let Some(labels) = &self.labels {
            // SAFETY: the command buffer is being recorded, and a label was begun.
            unsafe { labels.cmd_end_debug_utils_label(commands) };
        }
    }
}

/// Whether something shows names and labels: the validation layer, or a tool such as a debugger or profiler.
pub(super) fn are_shown(instance: &Instance, physical: vk::PhysicalDevice) -> bool {
    // SAFETY: the physical device is the instance's, and has Vulkan 1.3.
    let tools = || unsafe { instance.raw.get_physical_device_tool_properties_len(physical) };
    instance.labels && (instance.validation.is_some() || tools().is_ok_and(|tools| tools > 0))
}

/// A name as Vulkan takes it. Names come from files: a zero byte would end them early.
pub(crate) fn c_string(name: &str) -> CString {
    CString::new(name.replace('\0', "\u{fffd}")).unwrap_or_default()
}
