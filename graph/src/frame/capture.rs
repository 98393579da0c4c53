//! Frames whose images are captured: a copy of each image after every pass that wrote it leaves the frame too.
//!
//! The passes and their pictures stay the same. The Plan doesn't: scopes are split where a copy stands between two passes, and
//! what is copied is stored.

use super::{Frame, Image, ImageIndex, Lifetime, Output, Pass, Resource, TransferUse, Work};
use crate::base::Span;
use crate::vulkan::Subresources;
use std::sync::Arc;

/// A copy of what a pass left in an image.
#[derive(Debug, Clone, PartialEq)]
pub struct Capture {
    /// The pass.
    pub pass: Arc<str>,
    /// The image.
    pub image: Arc<str>,
    /// The part that the pass wrote.
    pub range: Subresources,
    /// Bytes of the copy.
    pub bytes: u64,
    pass_index: usize,
    image_index: ImageIndex,
}

impl Frame {
    /// What can be captured: the images that each pass of `runs` writes, in the order of the passes.
    ///
    /// Left out are images of which less than a whole picture is in use, since those may change from frame to frame, and parts of
    /// multisampled images.
    #[must_use]
    pub fn captures(&self, runs: impl Fn(&str) -> bool) -> Vec<Capture> {
        let passes = self.passes.iter().enumerate().filter(|(_, pass)| runs(&pass.name));
        let of_pass = |(pass_index, pass)| {
            let written = writes(pass);
            written.into_iter().filter_map(move |(image_index, range)| self.capture(pass_index, image_index, range))
        };
        let mut captures: Vec<Capture> = Vec::new();
        for capture in passes.flat_map(of_pass) {
            let same = |other: &Capture| {
                (other.pass_index, other.image_index, other.range)
                    == (capture.pass_index, capture.image_index, capture.range)
            };
            if !captures.iter().rev().take_while(|other| other.pass_index == capture.pass_index).any(same) {
                captures.push(capture);
            }
        }
        captures
    }

    fn capture(&self, pass_index: usize, image_index: ImageIndex, range: Subresources) -> Option<Capture> {
        let image = self.images.get(image_index.0 as usize)?;
        let range = image.part(range);
        let range = Subresources { mips: range.mips.min(1), aspects: image.format.aspects(), ..range };
        if image.allocated.is_some() || image.samples > 1 && range != image.whole() {
            return None;
        }
        let (pass, name) = (self.passes[pass_index].name.clone(), image.name.clone());
        let copy = copy_of(image, range, "");
        let [width, height, depth] = copy.made();
        let texels = u64::from(width) * u64::from(height) * u64::from(depth) * u64::from(copy.made_layers());
        let bytes = texels.saturating_mul(image.format.texel_bytes());
        Some(Capture { pass, image: name, range, bytes, pass_index, image_index })
    }

    /// The frame with these captures: each is an output behind those that the frame has, in their order.
    #[must_use]
    pub fn with_captures(&self, captures: &[Capture]) -> Frame {
        let mut frame = Frame { passes: Vec::with_capacity(self.passes.len() + captures.len()), ..self.clone() };
        let mut left = captures.iter().enumerate().peekable();
        for (at, pass) in self.passes.iter().enumerate() {
            frame.passes.push(pass.clone());
            while let Some((number, capture)) = left.next_if(|(_, capture)| capture.pass_index == at) {
                let Some(image) = self.images.get(capture.image_index.0 as usize) else { continue };
                // No pipeline's names hold blanks.
                let name = format!("capture {number}");
                let target = ImageIndex(u32::try_from(frame.images.len()).unwrap_or(u32::MAX));
                frame.images.push(copy_of(image, capture.range, &name));
                frame.passes.push(copying(&name, pass, capture, target, image.samples > 1));
                frame.outputs.push(Output::from(Resource::Image(target)));
            }
        }
        frame
    }
}

/// The pass that copies: multisampled images are resolved on the way.
fn copying(name: &str, pass: &Pass, capture: &Capture, target: ImageIndex, multisampled: bool) -> Pass {
    if multisampled {
        let because = "it is captured".to_owned();
        return Pass {
            view: pass.view,
            inserted: Some(because.as_str().into()),
            ..Pass::new(name, Work::Forward { from: capture.image_index, to: target, because })
        };
    }
    let side = |image, range, write| TransferUse {
        resource: Resource::Image(image),
        range,
        frames_ago: 0,
        span: Span::NONE,
        write,
        keeps: false,
    };
    let transfers = vec![
        side(capture.image_index, capture.range, false),
        side(target, Subresources { base_mip: 0, base_layer: 0, ..capture.range }, true),
    ];
    Pass { view: pass.view, transfers, ..Pass::new(name, Work::Copy) }
}

/// An image that holds a part of another one, with one sample.
fn copy_of(image: &Image, range: Subresources, name: &str) -> Image {
    Image {
        name: name.into(),
        span: Span::NONE,
        extent: image.extent_at(range.base_mip),
        mips: 1,
        layers: range.layers,
        samples: 1,
        chosen: None,
        lifetime: Lifetime::Transient,
        ..image.clone()
    }
}

/// The images that a pass writes, with their parts.
fn writes(pass: &Pass) -> Vec<(ImageIndex, Subresources)> {
    let color = pass.color.iter().map(|target| (target.image, target.range));
    let depth = pass.depth.iter().filter(|target| target.write || target.clear.is_some() || target.stencil.is_some());
    let depth = depth.map(|target| (target.image, target.range));
    let storage = pass.storage.iter().filter(|used| used.write).map(|used| (used.image, used.range));
    let transfers = pass.transfers.iter().filter(|side| side.write).filter_map(|side| match side.resource {
        Resource::Image(image) => Some((image, side.range)),
        Resource::Buffer(_) => None,
    });
    let forward = match pass.work {
        Work::Forward { to, .. } => Some((to, Subresources::WHOLE)),
        _ => None,
    };
    color.chain(depth).chain(storage).chain(transfers).chain(forward).collect()
}
