//! Pictures of a running program's frames, made when a page asks for them.

use crate::page::{PictureSize, PictureTexels, Thumbnail};
use crate::server::{Question, Server};
use framewright::{Error, Renderer};
use framewright_graph::frame::{Capture, CaptureName};
use framewright_lab::outputs::side_by_side;
use framewright_vulkan::Texels;
use std::collections::BTreeMap;

/// Questions for pictures that the next frame answers.
#[derive(Debug, Default)]
pub(crate) struct OpenQuestions {
    waiting: Vec<Question>,
    /// The id of the renderer whose frame answers them.
    renderer: u64,
}

/// A captured image whose layers and slices stand side by side, and how many these are; else why there is none.
type FlatImage = Result<(Texels, u32), String>;

impl OpenQuestions {
    /// Whether a frame owes answers.
    pub(crate) fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Whether a frame of this renderer owes answers.
    pub(crate) fn are_of(&self, renderer: &Renderer) -> bool {
        self.is_waiting() && self.renderer == renderer.id()
    }

    /// Answers what the frame that `renderer` drew last was captured for, or has the next one captured for what is asked. `shown` is the
    /// number of the frame on the page. Whether the renderer's Plan is one with captures, which no page shows.
    ///
    /// # Errors
    /// Those of reading what the device left.
    pub(crate) fn frame(&mut self, server: &Server, renderer: &mut Renderer, shown: u64) -> Result<bool, Error> {
        if self.are_of(renderer) {
            let Some(captured) = renderer.captured()? else { return Ok(renderer.is_capturing()) };
            let seen: BTreeMap<CaptureName, FlatImage> =
                captured.into_iter().map(|(name, texels)| (name, texels.and_then(flat))).collect();
            for question in self.waiting.drain(..) {
                question.answer(|asked| picture(&seen, &asked.of, asked.size)).map_err(no_json)?;
            }
            return Ok(renderer.is_capturing());
        }
        if self.is_waiting() || renderer.is_capturing() {
            return Ok(renderer.is_capturing());
        }
        for question in server.questions().try_iter().filter(Question::is_waiting) {
            if question.asked.frame == shown {
                self.waiting.push(question);
            } else {
                let why = "the frame that the page shows is another one by now";
                question.refuse(why).map_err(no_json)?;
            }
        }
        if self.is_waiting() {
            let mut names: Vec<CaptureName> = self.waiting.iter().flat_map(Question::names).collect();
            names.sort_unstable();
            names.dedup();
            self.renderer = renderer.id();
            renderer.capture(&names);
        }
        Ok(false)
    }
}

/// What a page can ask for, of the frame that is drawn.
///
/// # Errors
/// Those of [`Renderer::captures`].
pub(crate) fn to_ask_for(renderer: &mut Renderer) -> Result<Vec<Thumbnail>, Error> {
    Ok(renderer.captures()?.of_passes.iter().map(Capture::name).map(Thumbnail::to_ask_for).collect())
}

fn flat(texels: Texels) -> FlatImage {
    let columns = texels.layers.max(1) * texels.extent[2].max(1);
    let flat = side_by_side(vec![texels]).ok_or_else(|| "it has no texels".to_owned())?;
    Ok((flat, columns))
}

fn picture(seen: &BTreeMap<CaptureName, FlatImage>, of: &CaptureName, size: PictureSize) -> Result<Thumbnail, String> {
    let (texels, columns) = match seen.get(of) {
        Some(Ok(seen)) => seen,
        Some(Err(why)) => return Err(why.clone()),
        None => return Err("the frame has no such picture any more".to_owned()),
    };
    let Texels { format, extent: [width, height, _], ref bytes, .. } = *texels;
    Thumbnail::new(of.clone(), PictureTexels { format, size: [width, height], columns: *columns, bytes }, size)
}

pub(crate) fn no_json(error: serde_json::Error) -> Error {
    framewright_vulkan::Error::BadPlan { what: format!("it has no JSON form: {error}") }.into()
}
