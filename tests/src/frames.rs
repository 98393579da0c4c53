//! Small frames built in memory, and a device for them.

use crate::parts;
use framewright_graph::base::Span;
use framewright_graph::device::Profile;
use framewright_graph::frame::{
    Blend, ColorTarget, DepthTarget, Draw, DrawList, Frame, Groups, Image, ImageIndex, Pass, Resource, SampledImage,
    Work,
};
use framewright_graph::vulkan::{CompareOp, Format, Stages, Subresources};

/// A device that has every format at 1, 2, 4 and 8 samples, adds nothing to an image's bytes, and has one queue.
#[must_use]
pub fn device() -> Profile {
    let mut device = Profile { max_layers: 2048, ..parts::device() };
    device.formats.iter_mut().for_each(|format| format.samples = vec![1, 2, 4, 8]);
    device
}

/// Builds a frame pass by pass.
#[derive(Debug, Default)]
pub struct Builder(pub Frame);

impl Builder {
    /// Declares a transient image.
    pub fn image(&mut self, name: &str, format: Format, side: u32, samples: u32) -> ImageIndex {
        self.0.images.push(Image { samples, ..Image::new(name, format, side, side) });
        ImageIndex(self.0.images.len() as u32 - 1)
    }

    /// Adds a pass; what it touches follows.
    pub fn pass(&mut self, name: &str, work: Work) -> Added<'_> {
        self.0.passes.push(Pass::new(name, work));
        let last = self.0.passes.len() - 1;
        Added(&mut self.0.passes[last])
    }

    /// Adds a compute pass.
    pub fn dispatch(&mut self, name: &str) -> Added<'_> {
        self.pass(name, Work::Dispatch { shader: name.into(), groups: Groups::Count([1; 3]) })
    }

    /// Adds a pass that draws the scene's opaque objects.
    pub fn objects(&mut self, name: &str) -> Added<'_> {
        self.draw(name, Draw::Objects(DrawList::Opaque))
    }

    /// Adds a pass that draws a full-screen triangle.
    pub fn full_screen(&mut self, name: &str) -> Added<'_> {
        self.draw(name, Draw::FullScreen)
    }

    /// Adds a raster pass.
    pub fn draw(&mut self, name: &str, draw: Draw) -> Added<'_> {
        self.pass(name, Work::Draw { draw, shader: name.into(), discards: false, per_sample: false })
    }

    /// The frame, made for these images.
    #[must_use]
    pub fn outputs(mut self, images: &[ImageIndex]) -> Frame {
        self.0.outputs = images.iter().map(|image| Resource::Image(*image).into()).collect();
        self.0
    }
}

/// A pass that was just added.
#[derive(Debug)]
pub struct Added<'f>(pub &'f mut Pass);

impl Added<'_> {
    /// A draw into a cleared image.
    pub fn clear(self, image: ImageIndex) -> Self {
        self.target(image, Some([0.0; 4]), Blend::Replace)
    }

    /// A draw into an image.
    pub fn color(self, image: ImageIndex, blend: Blend) -> Self {
        self.target(image, None, blend)
    }

    fn target(self, image: ImageIndex, clear: Option<[f64; 4]>, blend: Blend) -> Self {
        self.0.color.push(ColorTarget {
            image,
            range: Subresources::WHOLE,
            span: Span::NONE,
            clear,
            blend,
            write_mask: Default::default(),
        });
        self
    }

    /// It tests depth and writes it, from a clear value if there is one.
    pub fn depth(self, image: ImageIndex, clear: Option<f64>, write: bool) -> Self {
        self.0.depth = Some(DepthTarget {
            image,
            range: Subresources::WHOLE,
            span: Span::NONE,
            clear,
            test: CompareOp::GreaterOrEqual,
            write,
            stencil: None,
        });
        self
    }

    /// It samples an image, one value a texel.
    pub fn sample(self, image: ImageIndex) -> Self {
        let compute = matches!(self.0.work, Work::Dispatch { .. });
        let stages = if compute { Stages::COMPUTE_SHADER } else { Stages::FRAGMENT_SHADER };
        self.0.sampled.push(SampledImage::new(format!("source{}", self.0.sampled.len()), image, stages));
        self
    }

    /// It writes an image as storage: whole, or on top of what it reads.
    pub fn store(self, image: ImageIndex, read: bool) -> Self {
        self.0.storage.push(parts::stored(format!("target{}", self.0.storage.len()), image, read));
        self
    }
}
