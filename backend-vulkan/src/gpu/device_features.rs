//! What a program switches on when it makes a device for this crate.

use super::features::Features;
use super::minimum::missing;
use crate::base::Error;
use ash::vk;
use std::ffi::CStr;

/// What a program creates a device with that this crate is to [adopt](crate::Device::adopt): the features of
/// [`minimum_features`](crate::minimum_features), those of [`optional_features`](crate::optional_features) that the physical device has, and
/// the extensions that are used.
///
/// A program with a chain of its own puts these features into its structures; one of each type stands in a chain.
pub struct DeviceFeatures {
    features: Features,
    extensions: Vec<&'static CStr>,
}

impl DeviceFeatures {
    /// Those of a physical device.
    ///
    /// # Errors
    /// [`Error::Lacking`] with all that it lacks of the minimum.
    ///
    /// # Safety
    /// `physical` belongs to `instance`, whose `apiVersion` is 1.3 or later.
    pub unsafe fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Result<DeviceFeatures, Error> {
        let missing = missing(instance, physical);
        if !missing.is_empty() {
            // SAFETY: the caller's word: `physical` belongs to `instance`.
            let properties = unsafe { instance.get_physical_device_properties(physical) };
            let name = properties.device_name_as_c_str().unwrap_or_default();
            return Err(Error::Lacking { device: name.to_string_lossy().into_owned(), missing });
        }
        let features = Features::used(Features::of(instance, physical), |_| true);
        let extensions = features.extensions();
        Ok(DeviceFeatures { features, extensions })
    }

    /// The features, chained: for `vkCreateDevice` and [`AdoptedDevice::features`](crate::AdoptedDevice::features).
    pub fn chain(&mut self) -> vk::PhysicalDeviceFeatures2<'_> {
        self.features.chain()
    }

    /// The extensions of the device, for `vkCreateDevice` and
    /// [`AdoptedDevice::device_extensions`](crate::AdoptedDevice::device_extensions). A program that presents adds `VK_KHR_swapchain`.
    #[must_use]
    pub fn extensions(&self) -> &[&'static CStr] {
        &self.extensions
    }
}
