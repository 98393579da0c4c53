//! The pictures that choices are held against: still ones, and those of a moving scene.

use super::choice::{Choice, reference_settings};
use super::converging_frame::ConvergingFrame;
use super::references::{self, GIVEN, Reference, References};
use super::{Bench, pipeline_digest, reference, settings};
use crate::digest::Digest;
use crate::error::Error;
use crate::metric::{Changes, Flicker};
use crate::outputs;
use crate::picture::{FileFormat, Light};
use crate::sweep::size_name;
use framewright::SceneRenderer;
use framewright_graph::base::escape;
use framewright_vulkan::ExecutorOptions;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The pictures that errors are measured against.
#[derive(Debug)]
pub enum ErrorBaseline {
    /// Those of the same choice under the preset [`REFERENCE`](super::REFERENCE), converged.
    References,
    /// There are none: costs alone are measured.
    Nothing,
    /// One picture.
    Picture {
        /// Its file, for people.
        file: PathBuf,
        /// The picture.
        picture: Light,
    },
}

impl ErrorBaseline {
    /// The name of [`ErrorBaseline::References`].
    pub const AUTO: &str = "auto";
    /// The name of [`ErrorBaseline::Nothing`].
    pub const NONE: &str = "none";

    /// Its name in results.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            ErrorBaseline::References => ErrorBaseline::AUTO.to_owned(),
            ErrorBaseline::Nothing => ErrorBaseline::NONE.to_owned(),
            ErrorBaseline::Picture { picture, .. } => Digest::of_value(picture),
        }
    }

    /// Its name in messages.
    pub(super) fn file(&self) -> PathBuf {
        match self {
            ErrorBaseline::Picture { file, .. } => file.clone(),
            ErrorBaseline::References | ErrorBaseline::Nothing => self.name().into(),
        }
    }
}

impl Bench<'_> {
    /// Notes if a given reference and a picture hold light of different ranges.
    pub(super) fn tell_of_light(&self, reference: &Light, shown: &Light) {
        if let ErrorBaseline::Picture { file, .. } = &self.options.held_against
            && reference.is_light != shown.is_light
        {
            let file = escape(&file.to_string_lossy());
            let (with, without) = if reference.is_light { (&*file, "the output") } else { ("the output", &*file) };
            self.program.note(&format!(
                "FLIP is HDR-FLIP here: {with} holds light without an upper end, and {without} doesn't"
            ));
        }
    }

    /// The key of the reference that a choice needs at a frame of its scene, if it isn't kept yet. The problem of a reference is told
    /// with the choices that need it.
    ///
    /// # Errors
    /// Those that end the whole sweep.
    pub fn missing_reference(&mut self, choice: &Choice, frame: u32) -> Result<Option<String>, Error> {
        if !matches!(self.options.held_against, ErrorBaseline::References) {
            return Ok(None);
        }
        self.goes_on(0, 0)?;
        let key = self.reference_key(choice, frame);
        let key = self.own(key)?.ok().flatten();
        Ok(key.filter(|key| References::read(key, self.program).is_none()))
    }

    /// Draws the reference that a choice needs at a frame of its scene, and tells `progress` how many of how many frames are drawn. What
    /// goes wrong with it alone goes wrong again where the choice is measured.
    ///
    /// # Errors
    /// Those that end the whole sweep.
    pub fn draw_reference(
        &mut self,
        choice: &Choice,
        frame: u32,
        progress: &dyn Fn(usize, usize),
    ) -> Result<(), Error> {
        let drawn = self.drawn_reference(choice, frame, progress);
        self.own(drawn).map(drop)
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
        let reference = match References::read(&key, self.program) {
            Some(kept) => kept,
            None => {
                let scene = choice.scene.still_at(frame);
                let more = reference_settings(&self.pipeline).unwrap_or_default();
                let frame = self.planned(choice, &scene, &more)?.frame;
                let converging = ConvergingFrame::of(frame, &self.device.profile(), &self.pipeline);
                let by = (&self.device, self.program);
                let drawn = reference::draw(by, &converging, &mut self.pipeline, (&scene, choice.size), progress)?;
                let Some(drawn) = drawn else { return Ok(None) };
                References::keep(&key, drawn, self.program)?
            }
        };
        Ok(Some((self.references.remember(&key, reference), key)))
    }

    /// A digest of all that a reference is drawn from; `None` without references.
    fn reference_key(&mut self, choice: &Choice, frame: u32) -> Result<Option<String>, Error> {
        match &self.options.held_against {
            ErrorBaseline::Nothing => return Ok(None),
            ErrorBaseline::Picture { .. } => return Ok(Some(GIVEN.to_owned())),
            ErrorBaseline::References => {}
        }
        let more = reference_settings(&self.pipeline).unwrap_or_default();
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
            size_name(choice.size),
            planned.plan.stereo.name().to_owned(),
        ];
        Ok(Some(Digest::of(texts.iter().chain(&rest).map(|it| &**it))))
    }

    /// The flicker of a choice over the first frames of its scene; `None` if there is no picture.
    pub(super) fn flicker(&mut self, choice: &Choice, frames: u32) -> Result<Option<Flicker>, Error> {
        let moving = &choice.scene.moving;
        let planned = self.planned(choice, moving, &[])?;
        let Some(request) = outputs::of_first_output(&planned.plan) else { return Ok(None) };
        let options = ExecutorOptions::default();
        let mut drawn = SceneRenderer::new(&self.device, planned.parts(), &mut self.pipeline.assets, moving, &options)?;
        let mut changes = Changes::default();
        for frame in 0..frames {
            self.goes_on(frame, frames)?;
            drawn.draw()?;
            let file = request.encode(&mut drawn.executor, &planned.plan, &|note| self.program.note(note))?;
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
