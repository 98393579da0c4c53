//! Texts and versions as Vulkan hands them over, in words.

use ash::vk;
use std::ffi::{CStr, FromBytesUntilNulError};

/// A version in words.
pub(crate) fn version(packed: u32) -> String {
    let major = vk::api_version_major(packed);
    format!("{major}.{}.{}", vk::api_version_minor(packed), vk::api_version_patch(packed))
}

/// A text of Vulkan's, as far as it is UTF-8.
pub(crate) fn text(text: Result<&CStr, FromBytesUntilNulError>) -> String {
    text.map_or_else(|_| String::new(), |text| text.to_string_lossy().into_owned())
}
