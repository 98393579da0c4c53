//! Every image after every pass that wrote it.
//!
//! Captures are drawn by Plans of their own. A Plan holds so many captures as fit a bound of memory;
//! the frames are drawn anew for each.

use crate::error::Error;
use crate::system::{interrupt, text};
use framewright::{Pipeline, SceneRenderer};
use framewright_graph::compile::Options;
use framewright_graph::dataflow::Dataflow;
use framewright_graph::frame::{Capture, Captures, Frame, capture_name};
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::{Aspects, Format};
use framewright_lab::outputs::side_by_side;
use framewright_lab::picture::{FileFormat, Picture};
use framewright_passes::scene::Scene;
use framewright_viewer::Thumbnail;
use framewright_vulkan::{Device, ExecutorOptions, Texels};
use std::collections::HashSet;

/// Captures of one Plan take at most about this many bytes.
const MOST_BYTES: u64 = 256 << 20;
/// A Plan has at most this many captures.
const MOST: usize = 64;

/// What captures are drawn with.
pub(crate) struct Drawing<'a> {
    pub(crate) device: &'a Device,
    pub(crate) pipeline: &'a mut Pipeline,
    /// The Plan whose images are captured, and the frame that it was made of.
    pub(crate) made: (&'a Plan, &'a Frame),
    pub(crate) scene: &'a Scene,
    /// How the Plans are made. Captures of images that share memory show what that does.
    pub(crate) options: Options,
    /// How they are executed.
    pub(crate) executor: ExecutorOptions,
    /// The captures are those of the last of this many frames.
    pub(crate) frames: u32,
}

/// What a pass left in an image. Layers and slices stand side by side.
pub(crate) struct CapturedImage {
    /// Its number, counted over all captures.
    pub(crate) number: usize,
    pub(crate) capture: Capture,
    pub(crate) format: Format,
    pub(crate) extent: [u32; 2],
    /// Rows from the top, as [`Texels`] has them.
    pub(crate) bytes: Vec<u8>,
}

impl CapturedImage {
    /// The part of the image in words; empty for its first level and layers.
    fn part(&self) -> String {
        let range = &self.capture.range;
        let stencil = (range.aspects == Aspects::STENCIL).then(|| "stencil".to_owned());
        let mip = (range.base_mip > 0).then(|| format!("mip level {}", range.base_mip));
        let layer = (range.base_layer > 0).then(|| format!("layer {}", range.base_layer));
        stencil.into_iter().chain(mip).chain(layer).collect::<Vec<_>>().join(", ")
    }

    /// A name for files: the number, the pass, the image, and the part if it isn't all.
    pub(crate) fn name(&self) -> String {
        let Capture { pass, image, range, .. } = &self.capture;
        let mut name = format!("{:03}-{pass}-{image}", self.number);
        if range.aspects == Aspects::STENCIL {
            name += "-stencil";
        }
        if range.base_mip > 0 {
            name += &format!("-mip{}", range.base_mip);
        }
        if range.base_layer > 0 {
            name += &format!("-layer{}", range.base_layer);
        }
        name.chars().map(|c| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '_' }).collect()
    }

    /// The small picture for a page, on which `file` is the whole one.
    pub(crate) fn thumbnail(&self, file: String) -> Thumbnail {
        let names = [self.capture.pass.to_string(), self.capture.image.to_string(), self.part(), file];
        Thumbnail::new(names, self.format, self.extent, &self.bytes)
    }

    /// The picture as a file.
    ///
    /// # Errors
    /// If it can't be encoded.
    pub(crate) fn encoded(&self, format: FileFormat) -> Result<Vec<u8>, Error> {
        let picture = Picture { format: self.format, encoding: None, extent: self.extent, bytes: &self.bytes };
        let name = self.capture.image.to_string();
        format.encode(&picture).map_err(|problem| framewright_lab::Error::Picture { image: name, problem }.into())
    }
}

impl<'a> Drawing<'a> {
    /// Captures of one frame of this Plan, in which nothing shares memory.
    pub(crate) fn new(
        device: &'a Device,
        pipeline: &'a mut Pipeline,
        made: (&'a Plan, &'a Frame),
        scene: &'a Scene,
        options: Options,
    ) -> Drawing<'a> {
        let options = Options { alias: false, ..options };
        Drawing { device, pipeline, made, scene, options, executor: ExecutorOptions::default(), frames: 1 }
    }
}

/// Draws all captures, and hands each to `take`.
///
/// # Errors
/// Those of planning and drawing, and of `take`.
pub(crate) fn draw(
    drawing: Drawing<'_>,
    mut take: impl FnMut(CapturedImage) -> Result<(), Error>,
) -> Result<usize, Error> {
    let Drawing { device, pipeline, made: (plan, frame), scene, options, executor, frames } = drawing;
    let flow = Dataflow::of(plan);
    let runs: HashSet<&str> = flow.nodes.iter().map(|node| node.name.as_str()).collect();
    let Captures { of_passes, left_out } = frame.captures(|pass| runs.contains(pass));
    for why in left_out {
        text::note_once(&format!("not captured: {}", text::escape(&why)));
    }
    let mut done = 0;
    for batch in batches(&of_passes) {
        let frame = frame.with_captures(batch);
        let plan = pipeline.compile(&frame, &device.profile(), &mut device.memory(), &options)?;
        let assets = &mut pipeline.assets;
        let mut prepared = SceneRenderer::new(device, (&plan, Some(&frame)), assets, scene, &executor)?;
        for drawn in 0..frames {
            if interrupt::asked() {
                return Err(Error::Interrupted { frames: drawn, wanted: frames });
            }
            prepared.draw()?;
        }
        for (at, capture) in batch.iter().enumerate() {
            let plane = capture.range.aspects;
            let texels = prepared.executor.read_image(&capture_name(at), plane, 0)?;
            let Some(Texels { format, extent: [width, height, _], bytes, .. }) = side_by_side(vec![texels]) else {
                continue;
            };
            // Stencil is read as bytes.
            let format = if plane == Aspects::STENCIL { Format::R8_UINT } else { format };
            let captured =
                CapturedImage { number: done, capture: capture.clone(), format, extent: [width, height], bytes };
            take(captured)?;
            done += 1;
        }
    }
    Ok(done)
}

/// Parts of the captures that one Plan holds each.
fn batches(captures: &[Capture]) -> impl Iterator<Item = &[Capture]> {
    let mut rest = captures;
    std::iter::from_fn(move || {
        let mut bytes = 0_u64;
        let fitting = rest.iter().take(MOST).take_while(|capture| {
            bytes = bytes.saturating_add(capture.bytes);
            bytes <= MOST_BYTES
        });
        let count = fitting.count().max(1).min(rest.len());
        let (batch, later) = rest.split_at(count);
        rest = later;
        (!batch.is_empty()).then_some(batch)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::base::Span;
    use framewright_graph::frame::Blend;
    use framewright_graph::frame::{ColorTarget, Draw, Image, ImageIndex, Pass, Work};
    use framewright_graph::vulkan::{ColorComponents, Subresources};

    #[test]
    fn batches_hold_all_captures_in_order_within_their_bounds() {
        let mut frame = Frame::default();
        for side in [64, 9000, 9000, 8, 8] {
            let image = ImageIndex(u32::try_from(frame.images.len()).expect("few"));
            frame.images.push(Image::new(&format!("i{}", image.0), Format::R8G8B8A8_SRGB, side, side));
            let work = Work::Draw { draw: Draw::FullScreen, shader: "s".into(), discards: false, per_sample: false };
            let target = ColorTarget {
                image,
                range: Subresources::WHOLE,
                span: Span::NONE,
                clear: None,
                blend: Blend::Replace,
                write_mask: ColorComponents::RGBA,
            };
            frame.passes.push(Pass { color: vec![target], ..Pass::new(&format!("p{}", image.0), work) });
        }
        let captures = frame.captures(|_| true).of_passes;
        let sizes: Vec<usize> = batches(&captures).map(<[Capture]>::len).collect();
        assert_eq!(sizes, [1, 1, 1, 2], "9000 × 9000 texels take more than a batch");
        assert!(batches(&captures).flatten().eq(&captures));
        assert_eq!(batches(&[]).count(), 0);
    }
}
