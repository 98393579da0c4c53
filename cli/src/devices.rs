//! `framewright devices`: the Vulkan devices of this machine.

use crate::args::{CheckFormat, Devices};
use crate::error::{Error, Exit};
use crate::text;
use comfy_table::Table;
use comfy_table::presets::ASCII_MARKDOWN;
use framewright_vulkan::{Device, DeviceSummary};
use serde::Serialize;

#[derive(Debug, Serialize)]
struct Answer<'a> {
    format_version: u32,
    devices: Vec<Entry<'a>>,
}

#[derive(Debug, Serialize)]
struct Entry<'a> {
    index: usize,
    name: &'a str,
    driver: &'a str,
    kind: &'a str,
    vulkan: &'a str,
    /// Whether `run` can draw on it.
    usable: bool,
    /// What it lacks of the minimum.
    missing: &'a [String],
}

/// Lists the devices.
///
/// # Errors
/// If there is no loader or no device.
pub(crate) fn devices(arguments: &Devices) -> Result<Exit, Error> {
    let found = Device::list()?;
    let shown = match arguments.format {
        CheckFormat::Human => table(&found),
        CheckFormat::Json => text::json(&Answer { format_version: 1, devices: found.iter().map(entry).collect() })?,
    };
    text::print(&shown).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

fn entry(device: &DeviceSummary) -> Entry<'_> {
    Entry {
        index: device.index,
        name: &device.name,
        driver: &device.driver,
        kind: device.kind,
        vulkan: &device.vulkan,
        usable: device.missing.is_empty(),
        missing: &device.missing,
    }
}

fn table(devices: &[DeviceSummary]) -> String {
    let mut table = Table::new();
    table.load_preset(ASCII_MARKDOWN).set_header(["#", "name", "driver", "kind", "Vulkan", "usable"]);
    for device in devices {
        let usable = if device.missing.is_empty() {
            "yes".to_owned()
        } else {
            format!("no: it lacks {}", text::escape(&device.missing.join(", ")))
        };
        table.add_row([
            device.index.to_string(),
            text::escape(&device.name),
            text::escape(&device.driver),
            device.kind.to_owned(),
            text::escape(&device.vulkan),
            usable,
        ]);
    }
    table.to_string() + "\n"
}
