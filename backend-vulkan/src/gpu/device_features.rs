//! What a program switches on when it makes a device for this crate.

use super::buffer_bounds::BufferBounds;
use super::features::{Features, ROBUST, known_features, minimum_features};
use super::minimum::{has_extensions, missing, missing_of, too_old};
use crate::base::Error;
use ash::{khr, vk};
use framewright_graph::base::nearest;
use framewright_graph::device::EVERY_PLAN_USES;
use framewright_graph::plan::UsedFeature;
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
    /// All that are used, of a physical device: for any Plan.
    ///
    /// # Errors
    /// [`Error::Lacking`] with all that it lacks of the minimum.
    ///
    /// # Safety
    /// `physical` belongs to `instance`, whose `apiVersion` is 1.3 or later.
    pub unsafe fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Result<DeviceFeatures, Error> {
        refuse(instance, physical, missing(instance, physical))?;
        let features = Features::used(Features::of(instance, physical), |_| true);
        let extensions = features.extensions();
        Ok(DeviceFeatures { features, extensions })
    }

    /// Those alone that Plans use, by the names that [`Plan::features`](framewright_graph::plan::Plan::features) lists; of several Plans
    /// all lists together. `robustBufferAccess` isn't among them: add it where files or shaders of strangers are drawn.
    ///
    /// # Errors
    /// [`Error::BadResource`] for a name that no Plan lists; [`Error::Lacking`] with all of them that the physical device lacks.
    ///
    /// # Safety
    /// That of [`DeviceFeatures::of`].
    pub unsafe fn exactly(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        names: &[&str],
    ) -> Result<DeviceFeatures, Error> {
        let names: Vec<&str> = EVERY_PLAN_USES.into_iter().chain(names.iter().copied()).collect();
        check_names(&names)?;
        refuse(instance, physical, too_old(instance, physical).into_iter().collect())?;
        // Queues are looked at with the features of the minimum.
        let mut lacks = missing_of(instance, physical, |name| names.contains(&name));
        let bounds = match names.contains(&ROBUST) {
            true => BufferBounds::CHECKED,
            // SAFETY: nothing is drawn here. The program vouches for what is drawn on its device.
            false => unsafe { BufferBounds::unchecked() },
        };
        let has = Features::with_bounds(instance, physical, bounds);
        let (of_swapchains, is_minimum) =
            (UsedFeature::SWAPCHAIN, |name: &str| minimum_features().any(|it| it == name));
        let shows = names.contains(&of_swapchains);
        let [has_swapchains] = has_extensions(instance, physical, [khr::swapchain::NAME]);
        let beyond = names.iter().filter(|name| **name != of_swapchains && !is_minimum(name) && !has.has(name));
        lacks.extend(beyond.map(|name| format!("the feature {name}")));
        lacks.extend((shows && !has_swapchains).then(|| of_swapchains.to_owned()));
        refuse(instance, physical, lacks)?;
        let features = has.only(&names);
        let mut extensions = features.extensions();
        extensions.extend(shows.then_some(khr::swapchain::NAME));
        Ok(DeviceFeatures { features, extensions })
    }

    /// The features, chained: for `vkCreateDevice` and [`AdoptedDevice::features`](crate::AdoptedDevice::features).
    pub fn chain(&mut self) -> vk::PhysicalDeviceFeatures2<'_> {
        self.features.chain()
    }

    /// The extensions of the device, for `vkCreateDevice` and
    /// [`AdoptedDevice::device_extensions`](crate::AdoptedDevice::device_extensions). A program that presents adds `VK_KHR_swapchain`, if
    /// it isn't among them.
    #[must_use]
    pub fn extensions(&self) -> &[&'static CStr] {
        &self.extensions
    }
}

/// Whether Plans may list each of these names.
fn check_names(names: &[&str]) -> Result<(), Error> {
    let known = || known_features().chain([UsedFeature::SWAPCHAIN]);
    let Some(unknown) = names.iter().find(|name| known().all(|it| it != **name)) else { return Ok(()) };
    let near = nearest(unknown, known()).map_or_else(String::new, |near| format!(" (did you mean {near}?)"));
    Err(Error::BadResource {
        what: format!("no Plan uses a feature {unknown}{near}: take the names of `Plan::features`"),
    })
}

/// Refuses a physical device that lacks anything.
fn refuse(instance: &ash::Instance, physical: vk::PhysicalDevice, missing: Vec<String>) -> Result<(), Error> {
    if missing.is_empty() {
        return Ok(());
    }
    // SAFETY: the callers' word: `physical` belongs to `instance`.
    let properties = unsafe { instance.get_physical_device_properties(physical) };
    let name = properties.device_name_as_c_str().unwrap_or_default();
    Err(Error::Lacking { device: name.to_string_lossy().into_owned(), missing })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::extension_features::DIVISOR;

    #[test]
    fn do_11_the_divisor_comes_with_either_extension() {
        let has = |khr_divisor| {
            let mut has = Features { khr_divisor, ..Features::default() };
            has.of_extensions.divisor.vertex_attribute_instance_rate_divisor = vk::TRUE;
            has
        };
        let khr = khr::vertex_attribute_divisor::NAME;
        for (khr_divisor, name) in [(false, DIVISOR), (true, khr)] {
            let used = Features::used(has(khr_divisor), |on| on == name);
            assert_eq!(used.extensions(), [name]);
            assert_eq!(used.only(&["vertexAttributeInstanceRateDivisor"]).extensions(), [name]);
        }
        assert_eq!(Features::used(has(true), |_| false).extensions(), [c""; 0]);
    }
}
