//! Every image after every pass that wrote it.
//!
//! Captures are drawn by Plans of their own. A Plan holds so many captures as fit a bound of memory; the frames are drawn anew for each.

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
use framewright_viewer::{PictureSize, PictureTexels, Thumbnail};
use framewright_vulkan::{Device, ExecutorOptions, Texels};
use std::collections::HashSet;

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
    /// Layers and slices that stand side by side.
    pub(crate) columns: u32,
    /// Rows from the top, as [`Texels`] has them.
    pub(crate) bytes: Vec<u8>,
}

impl CapturedImage {
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

    /// The picture for a page at this size.
    ///
    /// # Errors
    /// If the part that is asked for lies beside it, in words.
    pub(crate) fn thumbnail(&self, size: PictureSize) -> Result<Thumbnail, String> {
        let CapturedImage { format, extent, columns, ref bytes, .. } = *self;
        Thumbnail::new(self.capture.name(), PictureTexels { format, size: extent, columns, bytes }, size)
    }

    /// The picture for a page with at most so many texels at its longer side.
    pub(crate) fn small(&self, most: u32) -> Thumbnail {
        let small = self.thumbnail(PictureSize { most, region: None });
        // An image without a texel has no picture.
        small.unwrap_or_else(|_| Thumbnail::to_ask_for(self.capture.name()))
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

/// What can be captured of a frame and its Plan.
pub(crate) fn of(plan: &Plan, frame: &Frame) -> Captures {
    let flow = Dataflow::of(plan);
    let runs: HashSet<&str> = flow.nodes.iter().map(|node| node.name.as_str()).collect();
    frame.captures(|pass| runs.contains(pass))
}

/// Draws all captures, and hands each to `take`.
///
/// # Errors
/// Those of planning and drawing, and of `take`.
pub(crate) fn draw(drawing: Drawing<'_>, take: impl FnMut(CapturedImage) -> Result<(), Error>) -> Result<usize, Error> {
    let (plan, frame) = drawing.made;
    let Captures { of_passes, left_out } = of(plan, frame);
    for why in left_out {
        text::note_once(&format!("not captured: {}", text::escape(&why)));
    }
    draw_these(drawing, &of_passes, take)
}

/// Draws these captures, which are in the order of their passes, and hands each to `take`.
///
/// # Errors
/// Those of planning and drawing, and of `take`.
pub(crate) fn draw_these(
    drawing: Drawing<'_>,
    captures: &[Capture],
    mut take: impl FnMut(CapturedImage) -> Result<(), Error>,
) -> Result<usize, Error> {
    let Drawing { device, pipeline, made: (_, frame), scene, options, executor, frames } = drawing;
    let mut done = 0;
    for batch in Capture::batches(captures) {
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
            let columns = texels.layers.max(1) * texels.extent[2].max(1);
            let Some(Texels { format, extent: [width, height, _], bytes, .. }) = side_by_side(vec![texels]) else {
                continue;
            };
            // Stencil is read as bytes.
            let format = if plane == Aspects::STENCIL { Format::R8_UINT } else { format };
            let (number, capture, extent) = (done, capture.clone(), [width, height]);
            take(CapturedImage { number, capture, format, extent, columns, bytes })?;
            done += 1;
        }
    }
    Ok(done)
}
