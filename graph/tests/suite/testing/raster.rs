//! Raster frames built in memory.

pub(crate) use super::parts::device;
use framewright_graph::base::Span;
use framewright_graph::frame::{
    Blend, ColorTarget, DepthTarget, Draw, DrawList, Face, Frame, Image, ImageIndex, Pass, Resource, SampledImage, Work,
};
use framewright_graph::vulkan::Format::{self, D32_SFLOAT, R8G8B8A8_SRGB, R16G16B16A16_SFLOAT};
use framewright_graph::vulkan::{CompareOp, Filter, Rotation, Sampler, Stages, Subresources};

/// Builds a frame of raster passes, all images 64×64.
#[derive(Default)]
pub(crate) struct Raster(Frame);

impl Raster {
    pub(crate) fn image(&mut self, name: &str, format: Format, samples: u32) -> ImageIndex {
        self.0.images.push(Image { samples, ..Image::new(name, format, 64, 64) });
        ImageIndex(self.0.images.len() as u32 - 1)
    }

    /// Gives an image another format.
    pub(crate) fn format(&mut self, image: usize, format: Format) {
        self.0.images[image].format = format;
    }

    fn pass(&mut self, name: &str, work: Work) -> Added<'_> {
        self.0.passes.push(Pass::new(name, work));
        Added(self.0.passes.last_mut().expect("one was just added"))
    }

    pub(crate) fn objects(&mut self, name: &str) -> Added<'_> {
        self.pass(
            name,
            Work::Draw {
                draw: Draw::Objects(DrawList::Opaque),
                shader: name.into(),
                discards: false,
                per_sample: false,
            },
        )
    }

    pub(crate) fn full_screen(&mut self, name: &str) -> Added<'_> {
        self.pass(name, Work::Draw { draw: Draw::FullScreen, shader: name.into(), discards: false, per_sample: false })
    }

    pub(crate) fn forward(&mut self, name: &str, from: ImageIndex, to: ImageIndex) {
        self.pass(name, Work::Forward { from, to, because: "a switch = false".to_owned() });
    }

    pub(crate) fn output(self, image: ImageIndex) -> Frame {
        self.outputs(&[image])
    }

    /// A frame whose output leaves it turned.
    pub(crate) fn rotated(self, image: ImageIndex, rotation: Rotation) -> Frame {
        let mut frame = self.output(image);
        frame.outputs[0].rotation = rotation;
        frame
    }

    pub(crate) fn outputs(mut self, images: &[ImageIndex]) -> Frame {
        self.0.outputs = images.iter().map(|image| Resource::Image(*image).into()).collect();
        self.0
    }
}

/// A pass that was just added.
pub(crate) struct Added<'a>(&'a mut Pass);

impl Added<'_> {
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

    pub(crate) fn clear(self, image: ImageIndex) -> Self {
        self.target(image, Some([0.0; 4]), Blend::Replace)
    }

    pub(crate) fn color(self, image: ImageIndex, blend: Blend) -> Self {
        self.target(image, None, blend)
    }

    fn depth(self, image: ImageIndex, clear: Option<f64>, test: CompareOp, write: bool) -> Self {
        self.0.depth = Some(DepthTarget {
            image,
            range: Subresources::WHOLE,
            span: Span::NONE,
            clear,
            test,
            write,
            stencil: None,
        });
        self
    }

    /// A depth attachment that every fragment passes.
    pub(crate) fn pass_depth(self, image: ImageIndex) -> Self {
        self.depth(image, None, CompareOp::Always, false)
    }

    pub(crate) fn clear_depth(self, image: ImageIndex) -> Self {
        self.depth(image, Some(0.0), CompareOp::GreaterOrEqual, true)
    }

    /// Goes on with depth, and writes it.
    pub(crate) fn write_depth(self, image: ImageIndex) -> Self {
        self.depth(image, None, CompareOp::GreaterOrEqual, true)
    }

    pub(crate) fn test_depth(self, image: ImageIndex) -> Self {
        self.depth(image, None, CompareOp::GreaterOrEqual, false)
    }

    pub(crate) fn sample(self, image: ImageIndex) -> Self {
        self.sample_by(image, Filter::Nearest)
    }

    pub(crate) fn sample_by(self, image: ImageIndex, filter: Filter) -> Self {
        self.sampled(image, Face::Resolved, filter)
    }

    /// Samples single samples.
    pub(crate) fn sample_each(self, image: ImageIndex) -> Self {
        self.sampled(image, Face::Samples, Filter::Nearest)
    }

    /// Samples depth that is drawn again for it.
    pub(crate) fn sample_depth_only(self, image: ImageIndex) -> Self {
        self.sampled(image, Face::DepthOnly, Filter::Nearest)
    }

    fn sampled(self, image: ImageIndex, face: Face, filter: Filter) -> Self {
        let sampled = SampledImage::new(format!("source{}", self.0.sampled.len()), image, Stages::FRAGMENT_SHADER);
        self.0.sampled.push(SampledImage { face, sampler: Sampler::new(filter), ..sampled });
        self
    }
}

/// Opaque, sky and glass into `color` and `depth`, then a tone map, if any, to the screen.
pub(crate) fn forward(samples: u32, hdr: bool, tone_mapping: bool) -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", if hdr { R16G16B16A16_SFLOAT } else { R8G8B8A8_SRGB }, samples);
    let depth = raster.image("depth", D32_SFLOAT, samples);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.objects("sky").color(color, Blend::Replace).test_depth(depth);
    raster.objects("glass").color(color, Blend::Alpha).test_depth(depth);
    if tone_mapping {
        raster.full_screen("tonemap").sample(color).color(screen, Blend::Replace);
    } else {
        raster.forward("tonemap", color, screen);
    }
    raster.output(screen)
}
