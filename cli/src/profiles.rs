//! Which device `check` and `inspect` compile for: a saved profile, shipped or the user's own.

use crate::error::Error;
use crate::files;
use framewright_graph::device::{Profile, SHIPPED_PROFILES};
use std::ffi::OsStr;
use std::path::Path;

/// A profile file has at most this many bytes.
const LARGEST: usize = 1 << 20;

/// The profile that `--device` names: a shipped one, or a file. Without a name the first shipped one.
///
/// # Errors
/// If there is no such profile, or the file isn't one.
pub(crate) fn choose(device: Option<&OsStr>) -> Result<Profile, Error> {
    let shipped = || SHIPPED_PROFILES.iter().map(|(name, _)| *name);
    let name = match device {
        Some(name) => name,
        None => OsStr::new(SHIPPED_PROFILES[0].0),
    };
    if let Some((name, text)) = SHIPPED_PROFILES.iter().find(|(known, _)| name == OsStr::new(known)) {
        return Profile::from_ron(text).map_err(|problem| Error::Profile { path: (*name).into(), problem });
    }
    let path = Path::new(name);
    if path.extension().is_none() && !path.exists() {
        return Err(Error::UnknownProfile { name: name.to_string_lossy().into_owned(), shipped: shipped().collect() });
    }
    let text = files::text("device profile", path, LARGEST)?;
    Profile::from_ron(&text).map_err(|problem| Error::Profile { path: path.to_owned(), problem })
}
