//! `framewright devices`: the Vulkan devices of this machine, and the profile of one.

use crate::args::{CheckFormat, Devices};
use crate::error::{Error, Exit};
use crate::{output, run, text};
use comfy_table::Table;
use comfy_table::presets::ASCII_MARKDOWN;
use framewright_vulkan::{Device, DeviceOptions, DeviceSummary};
use serde::Serialize;
use std::path::PathBuf;

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
    /// Kinds of queues that it has.
    queues: &'a [&'static str],
    /// Whether passes can read what was drawn at their own position without leaving the rendering scope.
    local_read: bool,
    /// Whether `run` can draw on it.
    usable: bool,
    /// What it lacks of the minimum.
    missing: &'a [String],
}

/// Lists the devices, or saves the profile of one.
///
/// # Errors
/// If there is no loader or no such device, or the file can't be written.
pub(crate) fn devices(arguments: &Devices) -> Result<Exit, Error> {
    if let Some(file) = &arguments.save {
        return save(arguments, file);
    }
    let found = Device::list()?;
    let shown = match arguments.format {
        CheckFormat::Human => table(&found),
        CheckFormat::Json => text::json(&Answer { format_version: 1, devices: found.iter().map(entry).collect() })?,
    };
    text::print(&shown).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

fn save(arguments: &Devices, file: &PathBuf) -> Result<Exit, Error> {
    output::prepare(std::iter::once(file), &[])?;
    let choice = run::choice(arguments.device.as_deref())?;
    let device = Device::open(&DeviceOptions { choice, validation: false })?;
    let profile = device.profile().with_usual_needs(&mut device.memory());
    let text = profile.to_ron().map_err(|problem| Error::Unwritable(problem.to_string()))?;
    output::write(file, text.as_bytes())?;
    let needs: usize = profile.known_needs.iter().map(|known| known.usages.len() * known.sizes.len()).sum();
    let said = format!(
        "{}: the profile of {}: {} and the memory needs of {}\n",
        text::path(file),
        text::escape(&profile.name),
        text::count(profile.formats.len(), "format", "formats"),
        text::count(needs, "usual image", "usual images"),
    );
    text::print(&said).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

fn entry(device: &DeviceSummary) -> Entry<'_> {
    Entry {
        index: device.index,
        name: &device.name,
        driver: &device.driver,
        kind: device.kind,
        vulkan: &device.vulkan,
        queues: &device.queues,
        local_read: device.local_read,
        usable: device.missing.is_empty(),
        missing: &device.missing,
    }
}

fn table(devices: &[DeviceSummary]) -> String {
    let mut table = Table::new();
    let header = ["#", "name", "driver", "kind", "Vulkan", "queues", "local reads", "usable"];
    table.load_preset(ASCII_MARKDOWN).set_header(header);
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
            device.queues.join(", "),
            if device.local_read { "yes" } else { "no" }.to_owned(),
            usable,
        ]);
    }
    table.to_string() + "\n"
}
