//! `framewright devices`: the Vulkan devices of this machine, and the profile of one.

use crate::command_line::args::DevicesArguments;
use crate::command_line::values::AnswerFormat;
use crate::commands::run::DeviceUsed;
use crate::error::Error;
use crate::files::outputs;
use crate::planning::{device, helper};
use crate::system::{Exit, text};
use comfy_table::Table;
use comfy_table::presets::ASCII_MARKDOWN;
use framewright_graph::base::ReadFiles;
use framewright_vulkan::{Device, DeviceChoice, DeviceOptions, DeviceSummary, Helper};
use serde::Serialize;
use std::path::Path;

#[derive(Debug, Serialize)]
struct Answer<'a> {
    format_version: u32,
    devices: Vec<Entry<'a>>,
}

#[derive(Debug, Serialize)]
struct Entry<'a> {
    index: usize,
    #[serde(flatten)]
    summary: DeviceUsed,
    /// Kinds of queues that it has.
    queues: &'a [&'static str],
    /// Whether passes can read attachments of their own rendering scope.
    local_read: bool,
    /// Whether `run` can draw on it.
    usable: bool,
    /// Required features that it lacks.
    missing: &'a [String],
    /// Why it can't be opened, if it lacks nothing and can't be.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_opened: Option<&'a str>,
    /// Features that it has and `run` doesn't use, and why.
    used_without: &'a [String],
}

/// The features that a device is used without, or why it can't be opened.
type OpenResult = Result<Vec<String>, String>;

/// Lists the devices, or saves the profile of one.
///
/// # Errors
/// If there is no loader or no such device, or the file can't be written.
pub(crate) fn devices(arguments: &DevicesArguments) -> Result<Exit, Error> {
    if let Some(file) = &arguments.save {
        return save(arguments, file);
    }
    let helper = helper::usual(arguments.caching)?;
    let found: Vec<_> = Device::list()?.into_iter().map(|device| (used_without(&device, &helper), device)).collect();
    let shown = match arguments.format {
        AnswerFormat::Human => table(&found),
        AnswerFormat::Json => text::json(&answer(&found))?,
    };
    text::print(&shown).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

fn save(arguments: &DevicesArguments, file: &Path) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    outputs::prepare(std::iter::once(file), &read)?;
    let choice = device::to_draw_on(arguments.device.as_deref())?;
    let helper = Some(helper::usual(arguments.caching)?);
    let device = Device::open(&DeviceOptions { choice, validation: false, helper, ..DeviceOptions::default() })?;
    let profile = device.profile().with_usual_needs(&mut device.memory());
    let text = profile.to_ron().map_err(|problem| Error::Unwritable(problem.to_string()))?;
    outputs::write(&[(file, text.as_bytes())], &read)?;
    if profile.untested_multiview || !profile.untested_depth_resolve.is_empty() {
        text::say(
            "note: not all of the device could be tested, and the profile is without what wasn't; `framewright devices` tells \
             why: save the profile anew once it can be",
        );
    }
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

/// The features that a device has and isn't used with, because its self-tests failed.
///
/// # Errors
/// In words: why it can't be opened.
fn used_without(device: &DeviceSummary, helper: &Helper) -> OpenResult {
    if !device.missing.is_empty() {
        return Ok(Vec::new());
    }
    let choice = DeviceChoice::Index(device.index);
    match Device::open(&DeviceOptions {
        choice,
        validation: false,
        helper: Some(helper.clone()),
        ..DeviceOptions::default()
    }) {
        Ok(device) => Ok(device.used_without()),
        Err(problem) => Err(problem.to_string()),
    }
}

fn answer(devices: &[(OpenResult, DeviceSummary)]) -> Answer<'_> {
    Answer { format_version: 1, devices: devices.iter().map(|(opened, device)| entry(device, opened)).collect() }
}

fn entry<'a>(device: &'a DeviceSummary, opened: &'a OpenResult) -> Entry<'a> {
    Entry {
        index: device.index,
        summary: device.into(),
        queues: &device.queues,
        local_read: device.local_read,
        usable: device.missing.is_empty() && opened.is_ok(),
        missing: &device.missing,
        not_opened: opened.as_ref().err().map(String::as_str),
        used_without: opened.as_deref().unwrap_or_default(),
    }
}

fn table(devices: &[(OpenResult, DeviceSummary)]) -> String {
    let mut table = Table::new();
    let header = ["#", "name", "driver", "kind", "Vulkan", "queues", "local reads", "usable"];
    table.load_preset(ASCII_MARKDOWN).set_header(header);
    for (opened, device) in devices {
        let usable = match opened {
            _ if !device.missing.is_empty() => format!("no: it lacks {}", text::cell(&device.missing.join(", "))),
            Ok(_) => "yes".to_owned(),
            Err(_) => "no: it can't be opened".to_owned(),
        };
        table.add_row([
            device.index.to_string(),
            text::cell(&device.name),
            text::cell(&device.driver),
            device.kind.to_owned(),
            text::cell(&device.vulkan),
            device.queues.join(", "),
            if device.local_read { "yes" } else { "no" }.to_owned(),
            usable,
        ]);
    }
    let below = devices.iter().map(|(opened, DeviceSummary { index, .. })| match opened {
        Ok(without) => {
            without.iter().map(|what| format!("device {index} is used without {}\n", text::escape(what))).collect()
        }
        Err(problem) => format!("device {index} can't be opened: {}\n", text::escape(problem)),
    });
    table.to_string() + "\n" + &below.collect::<String>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command_line::args::CachingArguments;

    /// The devices of this machine, and one that is listed and is gone when it is opened.
    fn with_one_that_is_gone() -> Option<Vec<(OpenResult, DeviceSummary)>> {
        let list = || Device::list().ok().filter(|devices| !devices.is_empty());
        let mut gone = list()?.swap_remove(0);
        gone.index = 99;
        gone.missing.clear();
        let helper = helper::usual(CachingArguments { no_cache: false }).expect("this program");
        let there = list()?.into_iter().map(|device| (Ok(Vec::new()), device));
        Some(there.chain([(used_without(&gone, &helper), gone)]).collect())
    }

    #[test]
    fn a_device_that_can_not_be_opened_is_not_usable_and_both_forms_say_why() {
        let Some(devices) = with_one_that_is_gone() else {
            assert!(std::env::var_os("CI").is_none(), "no device");
            return eprintln!("SKIPPED: no device");
        };
        let why = "no device number 99; there are: ";
        let answer = serde_json::to_value(answer(&devices)).expect("JSON");
        let (gone, there) = answer["devices"].as_array().and_then(|devices| devices.split_last()).expect("a device");
        assert_eq!(
            (&gone["usable"], &gone["missing"], &gone["used_without"]),
            (&false.into(), &[(); 0][..].into(), &[(); 0][..].into())
        );
        assert!(gone["not_opened"].as_str().is_some_and(|said| said.starts_with(why)), "{gone:#}");
        for device in there {
            let lacks_nothing = device["missing"].as_array().is_some_and(Vec::is_empty);
            assert!(device.get("not_opened").is_none() && device["usable"] == lacks_nothing, "{device:#}");
        }
        let table = table(&devices);
        assert_eq!(table.matches("| no: it can't be opened |").count(), 1, "{table}");
        assert!(table.contains(&format!("\ndevice 99 can't be opened: {why}")), "{table}");
    }
}
