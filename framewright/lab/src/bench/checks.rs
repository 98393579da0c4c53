//! Checks of a sweep before a device is opened.

use super::choice::Choice;
use crate::error::Error;
use framewright::{Choices, Pipeline};
use framewright_graph::frame::{Resource, Stereo};
use std::collections::BTreeSet;
use std::path::Path;

/// Makes sure that settings take all values that a sweep chooses for them. `of_all` is chosen for all choices.
///
/// # Errors
/// All values that aren't allowed.
pub fn check_values(pipeline: &Pipeline, of_all: &Choices, choices: &[Choice]) -> Result<(), Error> {
    pipeline.check([of_all])?;
    let swept: BTreeSet<(String, String)> = choices.iter().flat_map(Choice::settings).collect();
    let each = swept.into_iter().map(|chosen| {
        let mut choices = of_all.clone();
        choices.set.push(chosen);
        choices
    });
    Ok(pipeline.check(&each.collect::<Vec<_>>())?)
}

/// Makes sure that a reference has the size of the pictures that are held against it, as far as sizes depend on no device. Those
/// of two eyes do.
///
/// # Errors
/// [`Error::Sizes`].
pub fn check_sizes(
    (file, reference): (&Path, [usize; 2]),
    (pipeline, of_all): (&mut Pipeline, &Choices),
    baseline: &Choice,
    choices: &[Choice],
) -> Result<(), Error> {
    let mut seen: Vec<[u32; 2]> = Vec::new();
    for choice in std::iter::once(baseline).chain(choices) {
        if choice.stereo.iter().any(|stereo| *stereo != Stereo::Off) || seen.contains(&choice.size) {
            continue;
        }
        seen.push(choice.size);
        if let Some((image, extent)) = output(pipeline, &choice.of(of_all, &choice.scene.still))
            && extent != reference
        {
            let reference = (file.to_owned(), reference);
            return Err(Error::Sizes { reference, picture: (image.into(), extent) });
        }
    }
    Ok(())
}

/// Name and size of the first output, where no device is asked. A pipeline that is wrong is told of later, by its choice.
fn output(pipeline: &mut Pipeline, choices: &Choices) -> Option<(String, [usize; 2])> {
    let frame = pipeline.expand(&choices.inputs(Stereo::Off, None)).ok()?;
    let Resource::Image(image) = frame.outputs.first()?.resource else { return None };
    let image = frame.images.get(image.0 as usize)?;
    let [width, height, _] = image.extent.map(|side| side as usize);
    Some((image.name.to_string(), [width, height]))
}
