//! Checks of a sweep before a device is opened.

use super::subjects::Choice;
use crate::command_line::values::Size;
use crate::error::Error;
use crate::planning::{Loaded, View, inputs};
use crate::system::Exit;
use framewright_graph::base::Sources;
use framewright_graph::expand;
use framewright_graph::frame::{Resource, Stereo};
use framewright_graph::vulkan::Rotation;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// Makes sure that settings take all values that a sweep chooses for them.
///
/// # Errors
/// All values that aren't allowed.
pub(super) fn values(pipeline: &Loaded, choices: &[Choice]) -> Result<(), Error> {
    let view = View::without_scene(Rotation::Identity);
    pipeline.check_command_line(view)?;
    let swept: BTreeSet<(String, String)> = choices.iter().flat_map(Choice::settings).collect();
    let wrong = swept.into_iter().flat_map(|chosen| {
        let set: Vec<(String, String)> = pipeline.set.iter().cloned().chain([chosen]).collect();
        expand::check_inputs(&pipeline.pipeline, &inputs(&set, pipeline.stereo.0[0], view, None))
    });
    let wrong: Vec<_> = wrong.collect();
    if wrong.is_empty() {
        return Ok(());
    }
    Err(Error::mistakes(Sources::clone(&pipeline.sources), wrong, Exit::Usage))
}

/// Makes sure that a reference has the size of the pictures that are held against it, as far as sizes depend on no device. Those
/// of two eyes do.
///
/// # Errors
/// [`Error::Sizes`].
pub(super) fn sizes(
    (file, reference): (&Path, [usize; 2]),
    pipeline: &mut Loaded,
    baseline: &Choice,
    choices: &[Choice],
) -> Result<(), Error> {
    let mut seen: Vec<Size> = Vec::new();
    for choice in std::iter::once(baseline).chain(choices) {
        if choice.stereo.0 != [Stereo::Off] || seen.contains(&choice.size) {
            continue;
        }
        seen.push(choice.size);
        if let Some((image, extent)) = output(pipeline, choice)
            && extent != reference
        {
            let reference = (file.to_owned(), reference);
            return Err(Error::Sizes { reference, picture: (image.into(), extent) });
        }
    }
    Ok(())
}

/// Name and size of the first output, where no device is asked. A pipeline that is wrong is told of later, by its choice.
fn output(pipeline: &mut Loaded, choice: &Choice) -> Option<(String, [usize; 2])> {
    let facts = Some(choice.scene.scene.facts());
    let view = View { facts, size: choice.size, rotation: Rotation::Identity, dump: &[] };
    let set: Vec<(String, String)> = pipeline.set.iter().cloned().chain(choice.settings()).collect();
    let inputs = inputs(&set, Stereo::Off, view, None);
    let sources = Arc::clone(&pipeline.sources);
    let frame = expand::expand(&pipeline.pipeline, sources, &inputs, &mut pipeline.assets.shaders).ok()?;
    let Resource::Image(image) = frame.outputs.first()?.resource else { return None };
    let image = frame.images.get(image.0 as usize)?;
    let [width, height, _] = image.extent.map(|side| side as usize);
    Some((image.name.to_string(), [width, height]))
}
