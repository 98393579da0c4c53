//! Pictures that the page asks for: what passes of the last good frame leave in images, drawn when somebody looks.

use super::Session;
use crate::drawing::captures::{self, CapturedImage, Drawing};
use crate::error::Error;
use framewright_graph::frame::CaptureName;
use framewright_viewer::Question;
use std::collections::BTreeMap;

/// Captures of the last good frame are kept as long as they take no more bytes than this.
const MOST_KEPT: usize = 512 << 20;

impl Session<'_> {
    /// Answers a question of the page.
    ///
    /// # Errors
    /// Those of the device, which no change to a file mends.
    pub(crate) fn answer(&mut self, question: Question) -> Result<(), Error> {
        if !question.is_waiting() {
            return Ok(());
        }
        if question.asked.frame != self.good.version {
            return Ok(question.refuse("the frame that the page shows is another one by now")?);
        }
        if !self.wrong.message.is_empty() {
            return Ok(question.refuse("a file has mistakes: pictures are drawn when they are mended")?);
        }
        let missing = match self.capture(&question) {
            Ok(missing) => missing,
            Err(error) if error.can_be_mended_in_files() => return Ok(question.refuse(&error.shown())?),
            Err(error) => return Err(error),
        };
        let captured = &self.good.captured;
        Ok(question.answer(|asked| match captured.get(&asked.of) {
            Some(image) => image.thumbnail(asked.size),
            None => Err(missing.get(&asked.of).cloned().unwrap_or_else(|| "there is no such picture".to_owned())),
        })?)
    }

    /// Draws what a question asks for and isn't there yet. Returns what there is no picture of, with the reasons.
    fn capture(&mut self, question: &Question) -> Result<BTreeMap<CaptureName, String>, Error> {
        let (device, arguments) = (self.device, self.arguments);
        let (Some(scene), Some(pipeline), Some(planned)) =
            (&self.scene.value, &mut self.pipeline.value, &self.good.planned)
        else {
            return Ok(BTreeMap::new());
        };
        let mut wanted = question.names();
        wanted.retain(|name| !self.good.captured.contains_key(name));
        let wanted: Vec<CaptureName> = wanted.into_iter().collect();
        let made = (&planned.plan, &planned.frame);
        let (found, missing) = captures::of(made.0, made.1).named(&wanted);
        let mut drawn: Vec<CapturedImage> = Vec::new();
        let (frames, options) = (arguments.frames, arguments.planning.options());
        let drawing = Drawing { frames, ..Drawing::new(device, pipeline, made, scene, options) };
        captures::draw_these(drawing, &found, |image| {
            drawn.push(image);
            Ok(())
        })?;
        let bytes =
            |images: &mut dyn Iterator<Item = &CapturedImage>| images.map(|image| image.bytes.len()).sum::<usize>();
        let kept = bytes(&mut self.good.captured.values()) + bytes(&mut drawn.iter());
        if kept > MOST_KEPT {
            let asked = question.names();
            self.good.captured.retain(|name, _| asked.contains(name));
        }
        self.good.captured.extend(drawn.into_iter().map(|image| (image.capture.name(), image)));
        Ok(missing.into_iter().collect())
    }
}
