//! Pictures of what a window shows.

use crate::error::Error;
use crate::files;
use crate::system::text;
use framewright::Renderer;
use framewright_lab::outputs;
use framewright_lab::picture::FileFormat;
use std::path::{Path, PathBuf};

/// The picture of a frame, as a PNG file, upright.
///
/// # Errors
/// Those of the device; [`framewright_lab::Error::Picture`].
pub(super) fn encoded(renderer: &mut Renderer, frame: u64) -> Result<Option<Vec<u8>>, Error> {
    let first = |renderer: &Renderer| renderer.plan()?.outputs.first().cloned();
    let Some(output) = first(renderer) else { return Ok(None) };
    let texels = renderer.read_back(frame, &output.name)?;
    let Some(plan) = renderer.plan() else { return Ok(None) };
    Ok(Some(outputs::encoded(FileFormat::Png, (plan, &output), vec![texels], &text::note_once)?))
}

/// Writes a picture by a name that is free, beside where the command was called, and says the name or what is wrong with it.
pub(super) fn write_by_a_free_name(pipeline: &Path, picture: &[u8]) {
    let stem = name(pipeline);
    let mut names = (1..1000).map(|number| PathBuf::from(format!("{stem}-{number:03}.png")));
    let Some(path) = names.find(|path| !path.exists()) else { return };
    match files::outputs::write_new(&path, picture) {
        Ok(()) => text::say(&format!("wrote `{}`", text::path(&path))),
        Err(error) => text::say(&error.shown()),
    }
}

/// The name of a pipeline, by its file.
pub(super) fn name(pipeline: &Path) -> String {
    pipeline.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
