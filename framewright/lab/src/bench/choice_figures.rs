//! The figures of a choice that was drawn, and its pictures.

use super::choice::Choice;
use super::error_baseline::light;
use super::{Bench, cost};
use crate::error::Error;
use crate::metric::{self, Errors, PIXELS_PER_DEGREE};
use crate::outputs;
use crate::results::RowFigures;
use framewright::SceneRenderer;
use framewright_vulkan::FrameReport;
use std::path::PathBuf;

/// Flicker that its picture shows as the brightest.
const BRIGHTEST_FLICKER: f64 = 0.25;

impl Bench<'_> {
    /// The figures of a choice that was drawn.
    pub(super) fn measured(
        &mut self,
        choice: &Choice,
        drawn: &mut SceneRenderer<'_>,
        frames: &[FrameReport],
        of_baseline: &[FrameReport],
    ) -> Result<RowFigures, Error> {
        let plan = drawn.plan;
        let mut measured = RowFigures {
            cost: cost::cost(plan, frames, of_baseline),
            errors: None,
            reference_errors: None,
            passes: cost::of_passes(plan, frames),
            picture: None,
            reference: None,
            heat_map: None,
            flicker: None,
            flicker_map: None,
        };
        let Some(request) = outputs::of_first_output(plan) else { return Ok(measured) };
        let picture = request.encode(&mut drawn.executor, plan, &|note| self.program.note(note))?;
        let name = |folder: &str, ending: &str| format!("{folder}/{}.{ending}", choice.key());
        let ending = picture.path.extension().map_or("png", |ending| if ending == "exr" { "exr" } else { "png" });
        measured.picture = Some(self.written(name("pictures", ending), &picture.contents)?);
        let shown = light(&picture.contents, &picture.path)?;
        let Some((reference, key)) = self.reference(choice, 0)? else { return Ok(measured) };
        measured.reference = Some(self.shown(&key, &reference.picture)?);
        let Some(errors) = Errors::between(&reference.picture, &shown, PIXELS_PER_DEGREE) else {
            let reference = (self.options.held_against.file(), reference.picture.extent);
            return Err(Error::Sizes { reference, picture: (PathBuf::from(name("pictures", ending)), shown.extent) });
        };
        self.tell_of_light(&reference.picture, &shown);
        if errors.of_nothing {
            let reference = PathBuf::from(measured.reference.unwrap_or_default());
            return Err(Error::NothingFinite { reference, picture: PathBuf::from(name("pictures", ending)) });
        }
        let size = shown.extent.map(|size| u32::try_from(size).unwrap_or(u32::MAX));
        let heat_map = |image: &str, values: &[f64]| {
            let map = metric::heat_map(values, size);
            map.map_err(|problem| Error::Picture { image: image.to_owned(), problem })
        };
        measured.heat_map = Some(self.written(name("heat_maps", "png"), &heat_map("flip", errors.flip_map())?)?);
        measured.errors = Some(errors);
        measured.reference_errors.clone_from(&reference.errors);
        if let Some(frames) = self.options.flicker
            && let Some(flicker) = self.flicker(choice, frames)?
        {
            let seen: Vec<f64> = flicker.map().iter().map(|it| it / BRIGHTEST_FLICKER).collect();
            let file = format!("heat_maps/{}_flicker.png", choice.key());
            measured.flicker_map = Some(self.written(file, &heat_map("flicker", &seen)?)?);
            measured.flicker = Some(flicker);
        }
        Ok(measured)
    }
}
