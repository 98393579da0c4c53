//! The pictures that choices are held against: still ones, and those of a moving scene.

use super::converging::Converging;
use super::digest::Digest;
use super::pipeline_digest;
use super::reference;
use super::references::{self, Reference, References};
use super::run::{Bench, kept, settings};
use super::subjects::{self, Choice};
use crate::command_line::measuring::MeasureArguments;
use crate::drawing::pictures;
use crate::error::Error;
use crate::files::inputs;
use crate::metric::{Changes, Flicker};
use crate::picture::{FileFormat, Light};
use crate::system::counted::{Progress, Words};
use crate::system::{interrupt, text};
use framewright::SceneRenderer;
use framewright_graph::base::ReadFiles;
use framewright_vulkan::ExecutorOptions;
use std::collections::HashSet;
use std::path::Path;
use std::rc::Rc;
use std::time::Duration;

/// The values of `--reference` that are no files.
pub(super) const AUTO: &str = "auto";
const NONE: &str = "none";
/// How often a line says how far the work is, where there is no terminal.
pub(super) const LINES_EVERY: Duration = Duration::from_secs(60);
/// The key of a reference that is a file.
pub(super) const GIVEN: &str = "given";

/// The value of `--reference`.
pub(super) enum Given {
    Auto,
    None,
    /// A picture's file.
    Picture(Light),
}

impl Given {
    /// Reads the picture, if one is named; `fits` makes sure that it has the right size before it is decoded.
    pub(super) fn of(
        arguments: &MeasureArguments,
        read: &ReadFiles,
        fits: impl FnOnce([usize; 2]) -> Result<(), Error>,
    ) -> Result<Given, Error> {
        match arguments.reference.to_str() {
            Some(AUTO) => Ok(Given::Auto),
            Some(NONE) => Ok(Given::None),
            _ => {
                let picture = inputs::picture(&arguments.reference, read)?;
                fits(picture.extent)?;
                picture.decoded().map(Given::Picture)
            }
        }
    }

    /// Its name in results.
    pub(super) fn name(&self) -> String {
        match self {
            Given::Auto => AUTO.to_owned(),
            Given::None => NONE.to_owned(),
            Given::Picture(picture) => Digest::of_value(picture),
        }
    }
}

impl Bench<'_> {
    /// Says once if a given reference and the pictures hold light of different ranges.
    pub(super) fn tell_of_light(&mut self, reference: &Light, shown: &Light) {
        if let (Given::Picture(_), false) = (&self.given, self.told_of_light)
            && reference.is_light != shown.is_light
        {
            self.told_of_light = true;
            let file = text::path(&self.arguments.reference);
            let (with, without) = if reference.is_light { (&*file, "the output") } else { ("the output", &*file) };
            text::say(&format!(
                "note: FLIP is HDR-FLIP here: {with} holds light without an upper end, and {without} doesn't"
            ));
        }
    }

    /// Draws the references that choices need and that the folder doesn't hold: then it is known how far the work is. The problem of a
    /// reference is told with the choices that need it.
    ///
    /// # Errors
    /// Those that end the whole sweep; Ctrl-C.
    pub(super) fn draw_references(&mut self, choices: &[Choice]) -> Result<(), Error> {
        if !matches!(self.given, Given::Auto) {
            return Ok(());
        }
        let mut known = HashSet::new();
        let mut wanted = Vec::new();
        let words = Words { doing: "planning", done: "planned", things: "choices" };
        let progress = Progress::new(choices.len(), 0, words, LINES_EVERY);
        for choice in choices {
            for frame in 0..self.arguments.flicker.unwrap_or(1) {
                if interrupt::asked() {
                    return Err(Error::Interrupted { frames: 0, wanted: 0 });
                }
                let Ok(Some(key)) = kept(self.reference_key(choice, frame))? else { continue };
                if known.insert(key.clone()) && self.references.read(&key).is_none() {
                    wanted.push((choice, frame));
                }
            }
            progress.done_one();
        }
        progress.finish();
        let words = Words { doing: "drawing", done: "drew", things: "references" };
        let progress = Progress::new(wanted.len(), 0, words, LINES_EVERY);
        for (choice, frame) in wanted {
            // What goes wrong here goes wrong again where the choice is measured.
            let _of_choice = kept(self.drawn_reference(choice, frame, &|done, of| progress.within(done, of)))?;
            progress.done_one();
        }
        progress.finish();
        Ok(())
    }

    /// The picture that a choice is held against at a frame of its scene; `None` if there is none.
    pub(super) fn reference(&mut self, choice: &Choice, frame: u32) -> Result<Option<(Rc<Reference>, String)>, Error> {
        self.drawn_reference(choice, frame, &|_, _| ())
    }

    /// As [`Bench::reference`], and tells how many of how many frames are drawn.
    fn drawn_reference(
        &mut self,
        choice: &Choice,
        frame: u32,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Option<(Rc<Reference>, String)>, Error> {
        let Some(key) = self.reference_key(choice, frame)? else { return Ok(None) };
        if let Some(known) = self.references.lately(&key) {
            return Ok(Some((known, key)));
        }
        let reference = match self.references.read(&key) {
            Some(kept) => kept,
            None => {
                let scene = choice.scene.still_at(frame);
                let more = subjects::reference_settings(&self.pipeline).unwrap_or_default();
                let frame = self.planned(choice, &scene, &more)?.frame;
                let converging = Converging::of(frame, &self.device.profile(), &self.pipeline);
                let drawn =
                    reference::draw(&self.device, &converging, &mut self.pipeline, (&scene, choice.size), progress)?;
                let Some(drawn) = drawn else { return Ok(None) };
                self.references.keep(&key, drawn)?
            }
        };
        Ok(Some((self.references.remember(&key, reference), key)))
    }

    /// A digest of all that a reference is drawn from; `None` without references.
    fn reference_key(&mut self, choice: &Choice, frame: u32) -> Result<Option<String>, Error> {
        match &self.given {
            Given::None => return Ok(None),
            Given::Picture(_) => return Ok(Some(GIVEN.to_owned())),
            Given::Auto => {}
        }
        let more = subjects::reference_settings(&self.pipeline).unwrap_or_default();
        let scene = choice.scene.still_at(frame);
        let planned = self.planned(choice, &scene, &more)?;
        let texts: Vec<String> = settings(&planned.plan).into_iter().flat_map(|(name, value)| [name, value]).collect();
        let summary = self.device.summary();
        let frame = if choice.scene.moving.moves() { frame } else { 0 };
        let rest = [
            env!("CARGO_PKG_VERSION").to_owned(),
            pipeline_digest::of_shipped_shaders(),
            self.pipeline_digest.clone(),
            summary.name.clone(),
            summary.driver.clone(),
            choice.scene.digest.clone(),
            frame.to_string(),
            subjects::size_name(choice.size),
            planned.plan.stereo.name().to_owned(),
        ];
        Ok(Some(Digest::of(texts.iter().chain(&rest).map(|it| &**it))))
    }

    /// The flicker of a choice over the first frames of its scene; `None` if there is no picture.
    pub(super) fn flicker(&mut self, choice: &Choice, frames: u32) -> Result<Option<Flicker>, Error> {
        let moving = &choice.scene.moving;
        let planned = self.planned(choice, moving, &[])?;
        let Some(request) = pictures::of_first_output(&planned.plan) else { return Ok(None) };
        let options = ExecutorOptions::default();
        let mut drawn = SceneRenderer::new(&self.device, planned.parts(), &mut self.pipeline.assets, moving, &options)?;
        let mut changes = Changes::default();
        for frame in 0..frames {
            if interrupt::asked() {
                return Err(Error::Interrupted { frames: frame, wanted: frames });
            }
            drawn.draw()?;
            let file = request.encode(&mut drawn.executor, &planned.plan)?;
            let shown = light(&file.contents, &file.path)?;
            let Some((reference, _)) = self.reference(choice, frame)? else { return Ok(None) };
            changes.add(&reference.picture, &shown);
        }
        Ok(Some(changes.flicker()))
    }

    /// Writes a reference as a display shows it, and answers with its path within the folder.
    pub(super) fn shown(&self, key: &str, picture: &Light) -> Result<String, Error> {
        let file = references::encoded(picture, FileFormat::Png)?;
        self.written(References::name(key, "png"), &file)
    }
}

/// The light in a picture's file.
pub(super) fn light(contents: &[u8], path: &Path) -> Result<Light, Error> {
    Light::decode(contents).map_err(|problem| Error::NoLight { path: path.to_owned(), problem })
}
