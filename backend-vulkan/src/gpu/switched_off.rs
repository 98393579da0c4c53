//! Settings of the validation layer that keep it from speaking. They come from the environment, or from a file that the environment
//! leads to, and are stronger than those of this crate.

use crate::base::{path_variable, read_file};
use std::env;
use std::path::PathBuf;

/// Beginnings of the layer's variables; the setting follows in capitals.
const PREFIXES: [&str; 3] = ["VK_KHRONOS_VALIDATION_", "VK_VALIDATION_", "VK_LAYER_"];
/// The beginning of a setting in a file.
const IN_FILE: &str = "khronos_validation.";
/// The folder or file that settings are read from.
const SETTINGS_PATH: &str = "VK_LAYER_SETTINGS_PATH";
/// The file in that folder, or in the working folder.
const SETTINGS_FILE: &str = "vk_layer_settings.txt";
/// A settings file is larger only by mistake.
const LARGEST: u64 = 1 << 20;

/// Checks that can be switched off by themselves.
const CHECKS: [&str; 10] = [
    "VALIDATE_CORE",
    "VALIDATE_SYNC",
    "CHECK_SHADERS",
    "CHECK_COMMAND_BUFFER",
    "CHECK_OBJECT_IN_USE",
    "CHECK_IMAGE_LAYOUT",
    "CHECK_QUERY",
    "STATELESS_PARAM",
    "OBJECT_LIFETIME",
    "THREAD_SAFETY",
];

/// Settings that choose among messages, or among checks.
const FILTERS: [&str; 3] = ["MESSAGE_ID_FILTER", "DISABLES", "REPORT_FLAGS"];

/// A setting that is made.
struct Setting {
    /// Its name in capitals.
    name: String,
    value: String,
    /// The place and the setting as it stands there.
    shown: String,
}

/// All settings of the layer, as they stand in the environment and in the file that is read.
pub(crate) fn settings() -> Vec<String> {
    all().into_iter().map(|setting| setting.shown).collect()
}

/// Those that keep messages back.
pub(crate) fn muting() -> Vec<String> {
    all().into_iter().filter(mutes).map(|setting| setting.shown).collect()
}

fn mutes(setting: &Setting) -> bool {
    let value = setting.value.trim().to_ascii_lowercase();
    let is_off = ["false", "0"].contains(&&*value);
    match &*setting.name {
        "MESSAGE_ID_FILTER" | "DISABLES" => !value.is_empty(),
        "REPORT_FLAGS" => !(value.contains("error") && value.contains("warn")),
        name => is_off && CHECKS.contains(&name),
    }
}

fn all() -> Vec<Setting> {
    let of_environment = env::vars_os().filter_map(|(variable, value)| {
        let (variable, value) = (variable.into_string().ok()?, value.to_string_lossy().into_owned());
        let name = PREFIXES.iter().find_map(|prefix| variable.strip_prefix(prefix));
        // The shortest form is told from other variables of Vulkan by the setting's name.
        let short = || variable.strip_prefix("VK_").filter(|name| CHECKS.contains(name) || FILTERS.contains(name));
        let name = name.or_else(short)?.to_owned();
        // They lead to the layer and its settings, and are none.
        let leads = ["PATH", "SETTINGS_PATH"].contains(&&*name);
        (!leads).then(|| Setting { name, shown: format!("{variable}={value}"), value })
    });
    let mut all: Vec<Setting> = of_environment.collect();
    all.sort_by(|a, b| a.shown.cmp(&b.shown));
    let file = file();
    let text = file.as_ref().and_then(|file| read_file(file, LARGEST)).unwrap_or_default();
    for line in String::from_utf8_lossy(&text).lines().map(str::trim) {
        if let Some((name, value)) = line.strip_prefix(IN_FILE).and_then(|setting| setting.split_once('=')) {
            let shown = format!("{line} in {}", file.as_ref().map_or_else(String::new, |it| it.display().to_string()));
            all.push(Setting { name: name.trim().to_ascii_uppercase(), value: value.trim().to_owned(), shown });
        }
    }
    all
}

/// The file of settings that the layer reads, if it is there.
fn file() -> Option<PathBuf> {
    let named = path_variable(SETTINGS_PATH);
    let named = named.map(|path| if path.is_dir() { path.join(SETTINGS_FILE) } else { path });
    [named, Some(PathBuf::from(SETTINGS_FILE))].into_iter().flatten().find(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_keeps_messages_back_mutes() {
        for (name, value, muted) in [
            ("MESSAGE_ID_FILTER", "VUID-vkCmdDraw-None-02699", true),
            ("MESSAGE_ID_FILTER", "", false),
            ("DISABLES", "VK_VALIDATION_FEATURE_DISABLE_CORE_CHECKS_EXT", true),
            ("VALIDATE_CORE", "false", true),
            ("VALIDATE_CORE", "true", false),
            ("CHECK_QUERY", "0", true),
            ("THREAD_SAFETY", "FALSE", true),
            ("REPORT_FLAGS", "error", true),
            ("REPORT_FLAGS", "error,warn,info", false),
            ("GPUAV_ENABLE", "true", false),
            ("GPUAV_ENABLE", "false", false),
            ("ENABLE_MESSAGE_LIMIT", "false", false),
        ] {
            let (name, value) = (name.to_owned(), value.to_owned());
            assert_eq!(mutes(&Setting { name, value, shown: String::new() }), muted);
        }
    }
}
