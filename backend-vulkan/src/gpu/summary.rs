//! The devices of this machine, and which of them is asked for.

use super::features::Features;
use super::instance::Instance;
use super::minimum::{MINIMUM_VERSION, missing};
use super::queues::QueueFamilies;
use super::words::{text, version};
use crate::base::Error;
use ash::vk;
use framewright_graph::base::nearest;

/// Which device to open.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// lavapipe, the software driver that gives the same picture on every machine; where it isn't installed, the first
    /// device that meets the minimum.
    #[default]
    Default,
    /// By its number in [`crate::Device::list`].
    Index(usize),
    /// By name: the device's own, or else the first device in whose name or driver's name the text occurs. `lavapipe`
    /// is Mesa's software driver, which calls itself llvmpipe.
    Name(String),
}

/// A device that exists.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceSummary {
    /// Its number.
    pub index: usize,
    /// Its own name.
    pub name: String,
    /// Its driver's name and version.
    pub driver: String,
    /// `cpu`, `integrated`, `discrete`, `virtual` or `other`.
    pub kind: &'static str,
    /// Its Vulkan version.
    pub vulkan: String,
    /// Kinds of queues that it has: `graphics`, and beside it `compute` and `transfer`.
    pub queues: Vec<&'static str>,
    /// Whether passes can read what was drawn at their own position without leaving the rendering scope.
    pub local_read: bool,
    /// Features of the minimum that the device lacks; empty if it can be opened.
    pub missing: Vec<String>,
    driver_id: vk::DriverId,
    /// All that tells it from other devices and its driver from other drivers and versions.
    pub(crate) identity: String,
}

/// Every device with its summary, in the loader's order.
pub(super) fn devices(instance: &Instance) -> Result<Vec<(vk::PhysicalDevice, DeviceSummary)>, Error> {
    // SAFETY: the instance lives.
    let found = unsafe { instance.raw.enumerate_physical_devices() }.map_err(Error::vulkan("listing devices"))?;
    if found.is_empty() {
        return Err(Error::NoDevice);
    }
    Ok((0..).zip(found).map(|(index, physical)| (physical, summary(instance, index, physical))).collect())
}

/// The summary of a device, whose number is `index`.
pub(super) fn summary(instance: &Instance, index: usize, physical: vk::PhysicalDevice) -> DeviceSummary {
    // SAFETY: `physical` belongs to the instance.
    let properties = unsafe { instance.raw.get_physical_device_properties(physical) };
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut ids = vk::PhysicalDeviceIDProperties::default();
    if properties.api_version >= vk::API_VERSION_1_2 {
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut driver).push_next(&mut ids);
        // SAFETY: `physical` belongs to the instance, and the chained structures outlive the call.
        unsafe { instance.raw.get_physical_device_properties2(physical, &mut all) };
    }
    let families = QueueFamilies::of(&instance.raw, physical);
    let more = families.as_ref().map(|it| (it.compute.is_some(), it.transfer.is_some())).unwrap_or_default();
    let queues = [("graphics", families.is_some()), ("compute", more.0), ("transfer", more.1)];
    let (driver_name, driver_info) = (text(driver.driver_name_as_c_str()), text(driver.driver_info_as_c_str()));
    let (name, driver_text) = (text(properties.device_name_as_c_str()), format!("{driver_name} {driver_info}"));
    let numbers = [properties.vendor_id, properties.device_id, properties.driver_version, properties.api_version];
    let (device_id, driver_uuid) = (u128::from_be_bytes(ids.device_uuid), u128::from_be_bytes(ids.driver_uuid));
    DeviceSummary {
        index,
        identity: format!("{name}; {driver_text}; {numbers:x?}; device {device_id:032x}; driver {driver_uuid:032x}"),
        name,
        driver: driver_text.trim().to_owned(),
        kind: match properties.device_type {
            vk::PhysicalDeviceType::CPU => "cpu",
            vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated",
            vk::PhysicalDeviceType::DISCRETE_GPU => "discrete",
            vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual",
            _ => "other",
        },
        vulkan: version(properties.api_version),
        queues: queues.into_iter().filter(|(_, there)| *there).map(|(name, _)| name).collect(),
        local_read: properties.api_version >= MINIMUM_VERSION && Features::of(&instance.raw, physical).local_read(),
        missing: missing(&instance.raw, physical),
        driver_id: driver.driver_id,
    }
}

/// The device that is asked for.
pub(super) fn choose(
    devices: Vec<(vk::PhysicalDevice, DeviceSummary)>,
    choice: &DeviceChoice,
) -> Result<(vk::PhysicalDevice, DeviceSummary), Error> {
    let usable = |it: &DeviceSummary| it.missing.is_empty();
    let is_lavapipe = |it: &DeviceSummary| it.driver_id == vk::DriverId::MESA_LLVMPIPE;
    let position = |test: &dyn Fn(&DeviceSummary) -> bool| devices.iter().position(|(_, it)| test(it));
    let (at, wanted) = match choice {
        DeviceChoice::Default => {
            let found = position(&|it| is_lavapipe(it) && usable(it)).or_else(|| position(&usable));
            // Where none meets the minimum, the first one's lacks are told.
            (found.or(Some(0)), String::new())
        }
        DeviceChoice::Index(index) => ((*index < devices.len()).then_some(*index), format!("number {index}")),
        DeviceChoice::Name(name) => {
            let wanted = name.to_lowercase();
            let occurs = |it: &DeviceSummary| {
                it.name.to_lowercase().contains(&wanted)
                    || it.driver.to_lowercase().contains(&wanted)
                    || (wanted == "lavapipe" && is_lavapipe(it))
            };
            let found = position(&|it| it.name == *name);
            (found.or_else(|| position(&|it| !wanted.is_empty() && occurs(it))), format!("named {name}"))
        }
    };
    let known: Vec<String> = devices.iter().map(|(_, it)| format!("{}: {}", it.index, it.name)).collect();
    let near = match choice {
        DeviceChoice::Name(name) => near(name, &devices),
        _ => None,
    };
    at.and_then(|at| devices.into_iter().nth(at)).ok_or(Error::UnknownDevice { wanted, near, known })
}

/// The device one of whose name's words is nearly `wanted`.
fn near(wanted: &str, devices: &[(vk::PhysicalDevice, DeviceSummary)]) -> Option<String> {
    let words = || devices.iter().flat_map(|(_, it)| it.name.split_whitespace());
    let word = nearest(wanted, words())?;
    devices.iter().find(|(_, it)| it.name.split_whitespace().any(|found| found == word)).map(|(_, it)| it.name.clone())
}
