//! Frames whose images are captured: a copy of each image after every pass that wrote it leaves the frame too.
//!
//! The passes and their pictures stay the same. The Plan doesn't: scopes are split where a copy stands between two passes, and
//! what is copied is stored.

use super::{Cadence, Frame, Image, ImageIndex, Lifetime, Output, Pass, Resource, TransferUse, Work};
use crate::base::Span;
use crate::vulkan::{Aspects, FillValue, Shape, Subresources};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::sync::Arc;

/// Captures of one Plan take at most about this many bytes.
const MOST_BYTES: u64 = 256 << 20;
/// A Plan has at most this many captures.
const MOST: usize = 64;

/// What tells a capture from all others of a frame.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaptureName {
    /// The pass.
    pub pass: Arc<str>,
    /// The image.
    pub image: Arc<str>,
    /// The mip level.
    #[serde(default)]
    pub mip: u32,
    /// The first layer.
    #[serde(default)]
    pub layer: u32,
    /// Whether it is the stencil of depth and stencil.
    #[serde(default)]
    pub stencil: bool,
}

/// A copy of what a pass left in an image: one mip level, and of depth and stencil one plane.
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

/// What can be captured of a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Captures {
    /// The images that each pass writes, in the order of the passes.
    pub of_passes: Vec<Capture>,
    /// What is left out, and why, once for each image.
    pub left_out: Vec<String>,
}

impl Capture {
    /// What tells it from all others of its frame.
    #[must_use]
    pub fn name(&self) -> CaptureName {
        CaptureName {
            pass: self.pass.clone(),
            image: self.image.clone(),
            mip: self.range.base_mip,
            layer: self.range.base_layer,
            stencil: self.range.aspects == Aspects::STENCIL,
        }
    }

    /// Parts of `captures` that one Plan holds each: their copies take memory.
    pub fn batches(captures: &[Capture]) -> impl Iterator<Item = &[Capture]> {
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
}

impl Captures {
    /// Those of these names, in the order of the passes, each once; and of each other name why there is none, in words.
    #[must_use]
    pub fn named(&self, names: &[CaptureName]) -> (Vec<Capture>, Vec<(CaptureName, String)>) {
        let wanted: HashSet<&CaptureName> = names.iter().collect();
        let found: Vec<Capture> =
            self.of_passes.iter().filter(|capture| wanted.contains(&capture.name())).cloned().collect();
        let there: HashSet<CaptureName> = found.iter().map(Capture::name).collect();
        let missing = names.iter().filter(|name| !there.contains(*name));
        (found, missing.map(|name| (name.clone(), self.why_not(name))).collect())
    }

    fn why_not(&self, name: &CaptureName) -> String {
        let CaptureName { pass, image, .. } = name;
        let of_image = format!("`{image}`: ");
        if let Some(why) = self.left_out.iter().find(|why| why.starts_with(&of_image)) {
            return why.clone();
        }
        let written = self.of_passes.iter().filter(|capture| capture.image == *image).collect::<Vec<_>>();
        match () {
            () if written.is_empty() => format!("no pass of the frame writes an image `{image}` that has a picture"),
            () if written.iter().all(|capture| capture.pass != *pass) => format!("no pass `{pass}` writes `{image}`"),
            () => format!("`{pass}` doesn't write this part of `{image}`"),
        }
    }
}

impl Frame {
    /// What can be captured: the images that each pass of `runs` writes, in the order of the passes.
    ///
    /// Two kinds of images are left out. If less than a whole picture of an image is in use, that part may change from frame to frame.
    /// And some of multisampled images can't be resolved: parts, several layers of depth or integers, and stencil.
    #[must_use]
    pub fn captures(&self, runs: impl Fn(&str) -> bool) -> Captures {
        let mut all = Captures::default();
        for (pass_index, pass) in self.passes.iter().enumerate().filter(|(_, pass)| runs(&pass.name)) {
            let first = all.of_passes.len();
            for (image_index, range) in writes(pass, &self.images) {
                let image = &self.images[image_index.0 as usize];
                for range in range.aspects.iter().map(|plane| Subresources { aspects: plane, ..range }) {
                    if let Some(why) = no_capture(image, range) {
                        let said = format!("`{}`: {why}", image.name);
                        if !all.left_out.contains(&said) {
                            all.left_out.push(said);
                        }
                        continue;
                    }
                    for mip in 0..range.mips {
                        let range = Subresources { base_mip: range.base_mip + mip, mips: 1, ..range };
                        let capture = self.capture(pass_index, image_index, range);
                        if !all.of_passes[first..].contains(&capture) {
                            all.of_passes.push(capture);
                        }
                    }
                }
            }
        }
        all
    }

    fn capture(&self, pass_index: usize, image_index: ImageIndex, range: Subresources) -> Capture {
        let image = &self.images[image_index.0 as usize];
        let (pass, name) = (self.passes[pass_index].name.clone(), image.name.clone());
        let copy = copy_of(image, range, "");
        let [width, height, depth] = copy.made();
        let texels = u64::from(width) * u64::from(height) * u64::from(depth) * u64::from(copy.made_layers());
        let bytes = texels.saturating_mul(image.format.texel_bytes());
        Capture { pass, image: name, range, bytes, pass_index, image_index }
    }

    /// The frame with these captures: each is an output behind those that the frame has, in their order. All passes run in each frame: a copy
    /// between two of them would find what the later one left.
    #[must_use]
    pub fn with_captures(&self, captures: &[Capture]) -> Frame {
        let mut frame = Frame { passes: Vec::with_capacity(self.passes.len() + captures.len()), ..self.clone() };
        let mut left = captures.iter().enumerate().peekable();
        for (at, pass) in self.passes.iter().enumerate() {
            frame.passes.push(Pass { run: Cadence::Always, ..pass.clone() });
            while let Some((number, capture)) = left.next_if(|(_, capture)| capture.pass_index == at) {
                let Some(image) = self.images.get(capture.image_index.0 as usize) else { continue };
                let name = capture_name(number);
                let target = ImageIndex(u32::try_from(frame.images.len()).unwrap_or(u32::MAX));
                frame.images.push(copy_of(image, capture.range, &name));
                frame.passes.extend(copying(&name, pass, capture, target, image));
                frame.outputs.push(Output::from(Resource::Image(target)));
            }
        }
        frame
    }
}

/// The name of the output that holds the capture with this number: no pipeline's names hold blanks.
#[must_use]
pub fn capture_name(number: usize) -> String {
    format!("capture {number}")
}

/// Why a part of an image can't be captured, if it can't.
fn no_capture(image: &Image, range: Subresources) -> Option<&'static str> {
    let all = Subresources { aspects: range.aspects, ..image.whole() };
    match () {
        () if image.samples == 1 => None,
        () if range.aspects.contains(Aspects::STENCIL) => Some("it has several samples, and stencil can't be resolved"),
        () if range != all => Some("it has several samples, and a part of it can't be resolved"),
        () if image.layers > 1 && (image.format.is_depth() || image.format.is_integer()) => {
            Some("it has several samples and several layers, which can't be resolved")
        }
        () => None,
    }
}

/// The passes that copy: multisampled images are resolved on the way. The other plane of a copy of one is filled: all of it leaves the
/// frame.
fn copying(name: &str, pass: &Pass, capture: &Capture, target: ImageIndex, image: &Image) -> Vec<Pass> {
    let side = |image, range, write| TransferUse {
        resource: Resource::Image(image),
        range,
        frames_ago: 0,
        span: Span::NONE,
        write,
        keeps: false,
    };
    let copied = Subresources { base_mip: 0, base_layer: 0, ..capture.range };
    let transfers = vec![side(capture.image_index, capture.range, false), side(target, copied, true)];
    let copy = Pass { view: pass.view, transfers, ..Pass::new(name, Work::Copy) };
    let other = image.format.aspects().difference(capture.range.aspects);
    if other.is_empty() {
        return vec![copy];
    }
    let value = FillValue::Depth(0.0, 0);
    let transfers = vec![side(target, Subresources { aspects: other, ..copied }, true)];
    vec![Pass { view: pass.view, transfers, ..Pass::new(&format!("{name}, the rest"), Work::Fill { value }) }, copy]
}

/// An image that holds a part of another one, with one sample. Faces of a cube become layers: there may be fewer than six.
fn copy_of(image: &Image, range: Subresources, name: &str) -> Image {
    Image {
        name: name.into(),
        span: Span::NONE,
        extent: image.extent_at(range.base_mip),
        allocated: image.allocated_at(range.base_mip),
        shape: if image.shape == Shape::Cube { Shape::D2 } else { image.shape },
        mips: 1,
        layers: range.layers,
        samples: 1,
        chosen: None,
        lifetime: Lifetime::Transient,
        ..image.clone()
    }
}

/// The images that a pass writes, with their parts: planes that it doesn't write aren't among them.
fn writes(pass: &Pass, images: &[Image]) -> Vec<(ImageIndex, Subresources)> {
    let mut all = Vec::new();
    for access in pass.accesses() {
        let image = access.image_index().and_then(|index| Some((index, images.get(index.0 as usize)?)));
        if let Some((index, image)) = image {
            access.for_each_effect(pass, Some(image), |effect| {
                if effect.writes {
                    all.push((index, image.part(effect.range)));
                }
            });
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Blend, ColorTarget, Draw};
    use crate::vulkan::{ColorComponents, Format};

    /// One image of each size, and a pass that draws into it.
    fn frame(sides: &[u32]) -> Frame {
        let mut frame = Frame::default();
        for side in sides.iter().copied() {
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
        frame
    }

    #[test]
    fn batches_hold_all_captures_in_order_within_their_bounds() {
        let captures = frame(&[64, 9000, 9000, 8, 8]).captures(|_| true).of_passes;
        let sizes: Vec<usize> = Capture::batches(&captures).map(<[Capture]>::len).collect();
        assert_eq!(sizes, [1, 1, 1, 2], "9000 × 9000 texels take more than a batch");
        assert!(Capture::batches(&captures).flatten().eq(&captures));
        assert_eq!(Capture::batches(&[]).count(), 0);
    }

    /// LV-5: whoever asks for what isn't there is told what is missing.
    #[test]
    fn lv_5_captures_are_found_by_name_and_what_is_missing_is_said() {
        let mut frame = frame(&[8, 8]);
        frame.images[1].samples = 4;
        frame.images[1].format = Format::R32_UINT;
        frame.images[1].layers = 2;
        let all = frame.captures(|_| true);
        let name = |pass: &str, image: &str, mip| CaptureName {
            pass: pass.into(),
            image: image.into(),
            mip,
            layer: 0,
            stencil: false,
        };
        let (found, missing) = all.named(&[name("p0", "i0", 0), name("p0", "i0", 0)]);
        assert_eq!((found.len(), missing), (1, Vec::new()));
        assert_eq!(found[0].name(), name("p0", "i0", 0));
        for (wanted, why) in [
            (name("p1", "i0", 0), "no pass `p1` writes `i0`"),
            (name("p0", "i0", 1), "`p0` doesn't write this part of `i0`"),
            (name("p0", "i", 0), "no pass of the frame writes an image `i` that has a picture"),
            (name("p1", "i1", 0), "`i1`: it has several samples and several layers, which can't be resolved"),
        ] {
            let (found, missing) = all.named(std::slice::from_ref(&wanted));
            assert_eq!((found, missing), (Vec::new(), vec![(wanted, why.to_owned())]));
        }
    }
}
