//! The loader, and an instance with or without the validation layer.

use super::minimum::MINIMUM_VERSION;
use super::validation::{FEATURES, LAYER, Layer, Messages, SETTINGS, Setting, known_settings, layer_settings};
use super::{layer, portability, words};
use crate::base::Error;
use ash::{ext, khr, vk};
use raw_window_handle::RawDisplayHandle;
use std::ffi::{CStr, CString};

/// An instance.
pub(crate) struct Instance {
    /// Vulkan's own.
    pub(crate) raw: ash::Instance,
    /// Whether `VK_EXT_debug_utils` is on.
    pub(crate) labels: bool,
    /// Whether `VK_KHR_surface` is on, which devices that present need.
    pub(crate) surfaces: bool,
    /// All extensions that are on.
    extensions: Vec<CString>,
    /// The validation layer, if it is on.
    pub(crate) validation: Option<Validation>,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// Keeps the loader in memory; `None` of an instance that the program made itself, and destroys.
    entry: Option<ash::Entry>,
}

/// The validation layer in use.
pub(crate) struct Validation {
    pub(crate) layer: Layer,
    pub(crate) messages: Messages,
}

impl Instance {
    /// Loads the loader and creates an instance, which can show pictures on `display`.
    pub(crate) fn new(validate: bool, display: Option<RawDisplayHandle>) -> Result<Instance, Error> {
        let entry = load()?;
        // SAFETY: the loader is loaded.
        let version = unsafe { entry.try_enumerate_instance_version() }.ok().flatten().unwrap_or(vk::API_VERSION_1_0);
        if version < MINIMUM_VERSION {
            let found = words::version(version);
            return Err(Error::NoLoader { reason: format!("it has Vulkan {found}, and 1.3 is needed") });
        }
        let mut validation = if validate {
            let layer = Layer::find(&entry).ok_or_else(|| Error::NoValidationLayer {
                layer_path: layer::user_layer_path().map(|path| path.display().to_string()),
            })?;
            Some(Validation { layer, messages: Messages::default() })
        } else {
            None
        };
        // SAFETY: the loader is loaded.
        let available = unsafe { entry.enumerate_instance_extension_properties(None) }.unwrap_or_default();
        let has = |name| available.iter().any(|it| it.extension_name_as_c_str() == Ok(name));
        let labels = validate || has(ext::debug_utils::NAME);
        let surfaces = has(khr::surface::NAME);
        let mut extensions: Vec<&CStr> = Vec::new();
        extensions.extend(labels.then_some(ext::debug_utils::NAME));
        extensions.extend(surfaces.then_some(khr::surface::NAME));
        let portability = has(khr::portability_enumeration::NAME);
        extensions.extend(portability.then_some(khr::portability_enumeration::NAME));
        let of_display = window_system(display)?;
        let missing = of_display.iter().filter(|name| !has(name)).map(|name| name.to_string_lossy().into_owned());
        let missing: Vec<String> = missing.collect();
        if !missing.is_empty() {
            return Err(Error::NoSurfaces { missing });
        }
        extensions.extend(of_display.into_iter().filter(|name| *name != khr::surface::NAME));
        let mut raw = create(&entry, &extensions, validation.as_ref(), &SETTINGS)?;
        if let Some(validation) = &mut validation {
            let known = known_settings(&validation.messages.list());
            if known.len() < SETTINGS.len() {
                // SAFETY: nothing was made from the instance, and its messages live until the next line.
                unsafe { raw.destroy_instance(None) };
                validation.messages = Messages::default();
                raw = create(&entry, &extensions, Some(validation), &known)?;
            }
        }
        let mut instance = Instance {
            raw,
            labels,
            surfaces,
            extensions: extensions.iter().map(|name| (*name).to_owned()).collect(),
            validation,
            messenger: None,
            entry: Some(entry),
        };
        if let (Some(validation), Some(entry)) = (&instance.validation, &instance.entry) {
            let functions = ext::debug_utils::Instance::new(entry, &instance.raw);
            // SAFETY: the messages live as long as the instance, which destroys the messenger first.
            let messenger = unsafe { functions.create_debug_utils_messenger(&validation.messages.messenger(), None) }
                .map_err(Error::vulkan("creating a debug messenger"))?;
            instance.messenger = Some((functions, messenger));
        }
        Ok(instance)
    }

    /// An instance that the program made itself, with these extensions.
    pub(super) fn adopted(raw: ash::Instance, extensions: &[&CStr]) -> Instance {
        Instance {
            raw,
            labels: extensions.contains(&ext::debug_utils::NAME),
            surfaces: extensions.contains(&khr::surface::NAME),
            extensions: extensions.iter().map(|name| (*name).to_owned()).collect(),
            validation: None,
            messenger: None,
            entry: None,
        }
    }

    /// Whether the extensions that surfaces of a display need are on.
    pub(crate) fn has_surfaces_of(&self, display: RawDisplayHandle) -> bool {
        let is_on = |name: &CStr| self.extensions.iter().any(|it| **it == *name);
        window_system(Some(display)).is_ok_and(|names| names.into_iter().all(is_on))
    }

    /// The loader.
    pub(crate) fn entry(&self) -> Result<ash::Entry, Error> {
        match &self.entry {
            Some(entry) => Ok(entry.clone()),
            None => load(),
        }
    }
}

/// The extensions that surfaces of a display need.
fn window_system(display: Option<RawDisplayHandle>) -> Result<Vec<&'static CStr>, Error> {
    let Some(display) = display else { return Ok(Vec::new()) };
    let names = ash_window::enumerate_required_extensions(display)
        .map_err(Error::vulkan("looking for surfaces of this window system"))?;
    // SAFETY: they are literals with an end.
    Ok(names.iter().map(|name| unsafe { CStr::from_ptr(*name) }).collect())
}

/// The system's Vulkan loader.
fn load() -> Result<ash::Entry, Error> {
    // SAFETY: it is trusted to initialise itself soundly.
    unsafe { ash::Entry::load() }.map_err(|error| Error::NoLoader { reason: error.to_string() })
}

fn create(
    entry: &ash::Entry,
    extensions: &[&CStr],
    validation: Option<&Validation>,
    settings: &[Setting],
) -> Result<ash::Instance, Error> {
    let application = vk::ApplicationInfo::default().application_name(c"framewright").api_version(MINIMUM_VERSION);
    let flags = portability::instance_flags(extensions);
    let mut extensions = extensions.to_vec();
    let mut layers: Vec<&CStr> = Vec::new();
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&FEATURES);
    let settings = layer_settings(settings);
    let mut settings = vk::LayerSettingsCreateInfoEXT::default().settings(&settings);
    let mut messenger = vk::DebugUtilsMessengerCreateInfoEXT::default();
    if let Some(validation) = validation {
        extensions.extend(validation.layer.extensions());
        layers.push(LAYER);
        messenger = validation.messages.messenger();
    }
    let extensions: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    let layers: Vec<_> = layers.iter().map(|name| name.as_ptr()).collect();
    let mut info = vk::InstanceCreateInfo::default()
        .flags(flags)
        .application_info(&application)
        .enabled_extension_names(&extensions)
        .enabled_layer_names(&layers);
    if let Some(validation) = validation {
        // The first messenger exists only after the instance: this one hears what creation and destruction say.
        info = info.push_next(&mut features).push_next(&mut messenger);
        if validation.layer.current {
            // Chained without its extension: the loader of Debian 12 knows no VK_EXT_layer_settings and would refuse.
            info = info.push_next(&mut settings);
        }
    }
    // SAFETY: everything that `info` points to outlives the call, and the messages outlive the instance.
    unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => Error::NoDevice,
        result => Error::NoInstance { result, validation: validation.is_some() },
    })
}

impl Drop for Instance {
    fn drop(&mut self) {
        if self.entry.is_none() {
            return;
        }
        // SAFETY: everything made from this instance holds it; the messenger goes before the instance.
        unsafe {
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}
