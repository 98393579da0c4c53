//! The device that `--device` names: a saved profile to compile for, or a Vulkan device to draw on.

use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::system::interrupt;
use framewright_graph::base::ReadFiles;
use framewright_graph::device::{Profile, SHIPPED_PROFILES};
use framewright_vulkan::{Device, DeviceChoice, DeviceOptions, Helper};
use std::ffi::OsStr;
use std::path::Path;

/// A profile file has at most this many bytes.
const LARGEST: usize = 1 << 20;

/// The value of `--device` that stands for every shipped profile.
pub(crate) const ALL: &str = "all";

/// Every shipped profile, by name.
///
/// # Errors
/// If a shipped profile can't be read, which a test rules out.
pub(crate) fn all() -> Result<Vec<(&'static str, Profile)>, Error> {
    SHIPPED_PROFILES.iter().map(|(name, text)| Ok((*name, shipped(name, text)?))).collect()
}

fn shipped(name: &str, text: &str) -> Result<Profile, Error> {
    Profile::from_ron(text).map_err(|problem| Error::Profile { path: name.into(), problem })
}

/// The profile that `--device` names: a shipped one, or a file. Without a name the first shipped one.
///
/// # Errors
/// If there is no such profile, or the file isn't one.
pub(crate) fn choose(device: Option<&OsStr>, read: &ReadFiles) -> Result<Profile, Error> {
    let name = match device {
        Some(name) => name,
        None => OsStr::new(SHIPPED_PROFILES[0].0),
    };
    if let Some((name, text)) = SHIPPED_PROFILES.iter().find(|(known, _)| name == OsStr::new(known)) {
        return shipped(name, text);
    }
    let path = Path::new(name);
    if path.extension().is_none() && !path.exists() {
        let shipped = SHIPPED_PROFILES.iter().map(|(name, _)| *name).collect();
        return Err(Error::UnknownProfile { name: name.to_string_lossy().into_owned(), shipped });
    }
    let text = inputs::text(FileRole::PROFILE, path, LARGEST, read)?;
    Profile::from_ron(&text).map_err(|problem| Error::Profile { path: path.to_owned(), problem })
}

/// The Vulkan device that `--device` names, by its number or name.
///
/// # Errors
/// If it names the file of a profile.
pub(crate) fn to_draw_on(device: Option<&OsStr>) -> Result<DeviceChoice, Error> {
    let Some(name) = device else { return Ok(DeviceChoice::Default) };
    let name = name.to_string_lossy().into_owned();
    match name.parse() {
        Ok(index) => Ok(DeviceChoice::Index(index)),
        Err(_) if Path::new(&name).extension().is_some_and(|end| end == "ron") => {
            Err(Error::ProfileIsNoDevice { name })
        }
        Err(_) => Ok(DeviceChoice::Name(name)),
    }
}

/// Opens a device to draw on. Ctrl-C ends waits for it.
///
/// # Errors
/// If there is none, or it lacks what drawing takes.
pub(crate) fn open(choice: DeviceChoice, validation: bool, helper: &Helper) -> Result<Device, Error> {
    let helper = Some(helper.clone());
    let device = Device::open(&DeviceOptions { choice, validation, helper, ..DeviceOptions::default() })?;
    device.cancel_when(interrupt::asked);
    Ok(device)
}
