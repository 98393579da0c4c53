//! The drivers and validation layers that tests name, and where the packages of software drivers put them. Which version a
//! driver has is the machine's: the same tests run on each.

use clap::ValueEnum;
use std::path::Path;
use std::sync::OnceLock;

/// A driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Driver {
    /// Mesa's, from `mesa-vulkan-drivers`.
    Lavapipe,
    /// Google's, from `chromium-common`.
    #[value(name = "swiftshader")]
    SwiftShader,
    /// That of this machine's GPU, which the Vulkan loader finds by itself.
    Gpu,
}

/// The current validation layer, from `chromium-common`; `framewright` finds it by itself.
pub const CURRENT_LAYER: &str = "/usr/lib/chromium/libVkLayer_khronos_validation.so";

/// The folder of the distribution's own validation layer, from `vulkan-validationlayers`.
pub const DISTRIBUTION_LAYERS: &str = "/usr/share/vulkan/explicit_layer.d";

/// The folder in which distributions install drivers.
const DRIVERS: &str = "/usr/share/vulkan/icd.d";

impl Driver {
    /// The software drivers.
    pub const SOFTWARE: [Driver; 2] = [Driver::Lavapipe, Driver::SwiftShader];

    /// Its name, as the commands and the shipped profiles have it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Driver::Lavapipe => "lavapipe",
            Driver::SwiftShader => "swiftshader",
            Driver::Gpu => "gpu",
        }
    }

    /// The file that leads the Vulkan loader to it; `None` if it isn't installed, or is the GPU's.
    #[must_use]
    pub fn manifest(self) -> Option<&'static str> {
        static LAVAPIPE: OnceLock<Option<String>> = OnceLock::new();
        const SWIFTSHADER: &str = "/usr/lib/chromium/vk_swiftshader_icd.json";
        match self {
            Driver::Lavapipe => LAVAPIPE.get_or_init(lavapipe).as_deref(),
            Driver::SwiftShader => Path::new(SWIFTSHADER).exists().then_some(SWIFTSHADER),
            Driver::Gpu => None,
        }
    }

    /// Whether tests shall run on it: `FRAMEWRIGHT_TEST_DEVICE` may ask for another one alone.
    #[must_use]
    pub fn is_tested(self) -> bool {
        std::env::var("FRAMEWRIGHT_TEST_DEVICE").map_or(true, |wanted| wanted.eq_ignore_ascii_case(self.name()))
    }
}

/// Distributions name the file differently: `lvp_icd.x86_64.json`, `lvp_icd.json`.
fn lavapipe() -> Option<String> {
    let entries = std::fs::read_dir(DRIVERS).ok()?;
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let name = names.filter(|name| name.starts_with("lvp_icd") && name.ends_with(".json")).min()?;
    Some(format!("{DRIVERS}/{name}"))
}
