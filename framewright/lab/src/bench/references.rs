//! The references of a sweep: each is drawn once, and kept in the folder of the results for the next time.

use super::program::Program;
use super::reference::ReferencePair;
use crate::digest::Digest;
use crate::error::Error;
use crate::metric::{Errors, PIXELS_PER_DEGREE};
use crate::picture::{FileFormat, Light, Picture};
use framewright_graph::vulkan::Format;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::rc::Rc;

/// The version of the form in which references are kept, and of the way in which they are drawn.
const FORMAT_VERSION: u32 = 4;

/// References that stay in memory.
const REMEMBERED: usize = 8;

/// The key of a reference that is a file.
pub(super) const GIVEN: &str = "given";

/// A picture that choices are held against.
#[derive(Debug)]
pub(super) struct Reference {
    /// As the tested output shows it.
    pub(super) picture: Light,
    /// Its own errors beside one of half as many samples; `None`: it was given.
    pub(super) errors: Option<Errors>,
}

/// The references of a sweep, by the digest of all that they are drawn from.
#[derive(Debug, Default)]
pub(super) struct References {
    /// Those that were asked for last, by key, the last one first.
    latest: VecDeque<(String, Rc<Reference>)>,
}

/// The file beside a reference's picture.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ReferenceFile {
    format_version: u32,
    /// A digest of the picture's file and of all that is said here.
    digest: String,
    /// Steps from black to white in the tested output's picture; `null`: it holds light without an upper end.
    steps: Option<u16>,
    errors: Errors,
}

impl References {
    /// A reference that was asked for lately.
    pub(super) fn lately(&mut self, key: &str) -> Option<Rc<Reference>> {
        let at = self.latest.iter().position(|(latest, _)| latest == key)?;
        let (key, reference) = self.latest.remove(at)?;
        self.latest.push_front((key, Rc::clone(&reference)));
        Some(reference)
    }

    /// Remembers a reference for those that ask for it soon.
    pub(super) fn remember(&mut self, key: &str, reference: Reference) -> Rc<Reference> {
        let reference = Rc::new(reference);
        self.latest.push_front((key.to_owned(), Rc::clone(&reference)));
        self.latest.truncate(REMEMBERED);
        reference
    }

    /// The path of a reference's file within the folder.
    pub(super) fn name(key: &str, ending: &str) -> String {
        format!("pictures/reference_{key}.{ending}")
    }

    /// The reference that was kept under a key; `None` if there is none, or it is damaged.
    pub(super) fn read(key: &str, program: &dyn Program) -> Option<Reference> {
        let beside = program.kept(&References::name(key, "json"))?;
        let ReferenceFile { format_version: _, digest, steps, errors } = serde_json::from_slice(&beside).ok()?;
        let file = program.kept(&References::name(key, "exr"))?;
        if digest != self::digest(&file, steps, &errors).ok()? {
            return None;
        }
        let picture = Light { is_light: steps.is_none(), ..Light::decode(&file).ok()? };
        Some(Reference { picture: shown(picture, steps), errors: Some(errors) })
    }

    /// Keeps a reference that was drawn.
    ///
    /// # Errors
    /// If it can't be written.
    pub(super) fn keep(key: &str, drawn: ReferencePair, program: &dyn Program) -> Result<Reference, Error> {
        let ReferencePair { picture, of_half, steps } = drawn;
        let file = encoded(&picture, FileFormat::OpenExr)?;
        let [picture, of_half] = [picture, of_half].map(|drawn| shown(drawn, steps));
        let name = |ending| PathBuf::from(References::name(key, ending));
        let errors = Errors::between(&picture, &of_half, PIXELS_PER_DEGREE);
        let errors = errors.ok_or_else(|| Error::Sizes {
            reference: (name("exr"), picture.extent),
            picture: (name("half.exr"), of_half.extent),
        })?;
        let digest = digest(&file, steps, &errors)?;
        let beside = ReferenceFile { format_version: FORMAT_VERSION, digest, steps, errors };
        let text = serde_json::to_string_pretty(&beside)? + "\n";
        let files = [("exr", &*file), ("json", text.as_bytes())];
        for (ending, contents) in files {
            program.keep(&References::name(key, ending), contents).map_err(Error::Program)?;
        }
        Ok(Reference { picture, errors: Some(beside.errors) })
    }
}

/// A picture in the steps of the tested output; `None`: as it is.
fn shown(picture: Light, steps: Option<u16>) -> Light {
    match steps {
        Some(steps) => picture.in_steps(steps),
        None => picture,
    }
}

/// A digest of a reference's file and of what is said beside it.
fn digest(file: &[u8], steps: Option<u16>, errors: &Errors) -> serde_json::Result<String> {
    let said = serde_json::to_string(&(FORMAT_VERSION, steps, errors))?;
    Ok(Digest::of_bytes([file, said.as_bytes()]))
}

/// A picture of light as a file.
///
/// # Errors
/// If the encoder fails.
pub(super) fn encoded(picture: &Light, file_format: FileFormat) -> Result<Vec<u8>, Error> {
    let texels = picture.texels.iter().flat_map(|[red, green, blue]| [*red, *green, *blue, 1.0]);
    let bytes: Vec<u8> = texels.flat_map(f32::to_ne_bytes).collect();
    let extent = picture.extent.map(|size| u32::try_from(size).unwrap_or(u32::MAX));
    let floats = Picture { format: Format::R32G32B32A32_SFLOAT, encoding: None, extent, bytes: &bytes };
    file_format.encode(&floats).map_err(|problem| Error::Picture { image: "reference".to_owned(), problem })
}
