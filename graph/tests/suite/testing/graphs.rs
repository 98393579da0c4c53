//! The graphs that the compiler is measured on, built in memory.

pub(crate) use super::parts::device;
use super::parts::stored;
use framewright_graph::frame::{Frame, Groups, Image, ImageIndex, Pass, Resource, SampledImage, Work};
use framewright_graph::vulkan::{Format, Stages};
use std::sync::Arc;

/// Builds a frame of compute passes.
#[derive(Default)]
pub(crate) struct Builder {
    frame: Frame,
    sampled: Option<Arc<str>>,
    stored: Option<Arc<str>>,
}

impl Builder {
    /// An image of one mip and one layer.
    pub(crate) fn image(&mut self, name: &str, format: Format, width: u32, height: u32) -> ImageIndex {
        let image = Image::new(name, format, width, height);
        self.frame.images.push(image);
        ImageIndex(self.frame.images.len() as u32 - 1)
    }

    /// A compute pass that samples `reads`, and writes `writes` as storage: whole, or on top of what is there.
    pub(crate) fn pass(&mut self, name: &str, reads: &[ImageIndex], writes: &[(ImageIndex, bool)]) {
        let source = self.sampled.get_or_insert_with(|| "source".into()).clone();
        let target = self.stored.get_or_insert_with(|| "target".into()).clone();
        let work = Work::Dispatch { shader: source.clone(), groups: Groups::Invocations([256, 256, 1]) };
        self.frame.passes.push(Pass {
            sampled: reads
                .iter()
                .map(|image| SampledImage::new(source.clone(), *image, Stages::COMPUTE_SHADER))
                .collect(),
            storage: writes.iter().map(|(image, read)| stored(target.clone(), *image, *read)).collect(),
            ..Pass::new(name, work)
        });
    }

    /// The frame, made for `output`.
    pub(crate) fn output(mut self, output: ImageIndex) -> Frame {
        self.frame.outputs.push(Resource::Image(output).into());
        self.frame
    }
}

/// Pass i reads image i−1 and writes image i.
pub(crate) fn chain(passes: u32) -> Frame {
    let mut builder = Builder::default();
    let mut before: Option<ImageIndex> = None;
    for number in 0..passes {
        let image = builder.image(&format!("image{number}"), Format::R8G8B8A8_UNORM, 256, 256);
        builder.pass(&format!("pass{number}"), before.as_slice(), &[(image, false)]);
        before = Some(image);
    }
    builder.output(ImageIndex(passes - 1))
}

/// Pass i reads three random images among those before it, `window` at most back, and writes image i. Every image that
/// nobody reads goes into the last pass, so that all passes stay.
fn random(passes: u32, window: u64) -> Frame {
    let mut builder = Builder::default();
    let mut state = 12345_u64;
    let mut read = vec![false; passes as usize];
    for number in 0..passes {
        let image = builder.image(&format!("image{number}"), Format::R8G8B8A8_UNORM, 256, 256);
        let mut reads = Vec::new();
        let among = u64::from(number).min(window);
        for _ in 0..if number == 0 { 0 } else { 3 } {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let back = ((state >> 33) % among) as u32;
            let source = ImageIndex(number - 1 - back);
            if !reads.contains(&source) {
                reads.push(source);
                read[source.0 as usize] = true;
            }
        }
        if number == passes - 1 {
            let unread = (0..number).filter(|image| !read[*image as usize]).map(ImageIndex);
            reads.extend(unread.filter(|image| !reads.contains(image)).collect::<Vec<_>>());
        }
        builder.pass(&format!("pass{number}"), &reads, &[(image, false)]);
    }
    builder.output(ImageIndex(passes - 1))
}

/// Three random earlier images.
pub(crate) fn wide(passes: u32) -> Frame {
    random(passes, u64::MAX)
}

/// Three random images among the last 32.
pub(crate) fn local(passes: u32) -> Frame {
    random(passes, 32)
}

/// A deferred frame of 25 passes and 26 transient images at 1920×1080.
pub(crate) fn deferred() -> Frame {
    use Format::{D32_SFLOAT, R8_UNORM, R8G8B8A8_UNORM, R16G16_SFLOAT, R16G16B16A16_SFLOAT};
    let (width, height) = (1920, 1080);
    let mut builder = Builder::default();
    let cascades: Vec<ImageIndex> =
        (0..4).map(|number| builder.image(&format!("cascade{number}"), D32_SFLOAT, 2048, 2048)).collect();
    let depth = builder.image("depth", D32_SFLOAT, width, height);
    let albedo = builder.image("albedo", R8G8B8A8_UNORM, width, height);
    let normal = builder.image("normal", R16G16B16A16_SFLOAT, width, height);
    let material = builder.image("material", R8G8B8A8_UNORM, width, height);
    let motion = builder.image("motion", R16G16_SFLOAT, width, height);
    let occlusion = builder.image("occlusion", R8_UNORM, width, height);
    let occlusion_blurred = builder.image("occlusion_blurred", R8_UNORM, width, height);
    let lit = builder.image("lit", R16G16B16A16_SFLOAT, width, height);
    let bloom = |builder: &mut Builder, way: &str, level: u32| {
        builder.image(
            &format!("bloom_{way}{level}"),
            R16G16B16A16_SFLOAT,
            (width >> level).max(1),
            (height >> level).max(1),
        )
    };
    let down: Vec<ImageIndex> = (1..=6).map(|level| bloom(&mut builder, "down", level)).collect();
    let up: Vec<ImageIndex> = (0..6).map(|level| bloom(&mut builder, "up", level)).collect();
    let mapped = builder.image("mapped", R8G8B8A8_UNORM, width, height);
    let smooth = builder.image("smooth", R8G8B8A8_UNORM, width, height);

    for (number, cascade) in cascades.iter().enumerate() {
        builder.pass(&format!("cascade{number}"), &[], &[(*cascade, false)]);
    }
    builder.pass("depth", &[], &[(depth, false)]);
    let targets = [albedo, normal, material, motion].map(|target| (target, false));
    builder.pass("g_buffer", &[], &[&targets[..], &[(depth, true)]].concat());
    builder.pass("occlusion", &[depth, normal], &[(occlusion, false)]);
    builder.pass("occlusion_blur", &[occlusion], &[(occlusion_blurred, false)]);
    let shading = [&[albedo, normal, material, depth, occlusion_blurred][..], &cascades[..]].concat();
    builder.pass("lighting", &shading, &[(lit, false)]);
    builder.pass("transparents", &[&[depth][..], &cascades[..]].concat(), &[(lit, true)]);
    for level in 0..6 {
        let source = if level == 0 { lit } else { down[level - 1] };
        builder.pass(&format!("bloom_down{level}"), &[source], &[(down[level], false)]);
    }
    for level in (0..6).rev() {
        let sources = if level == 5 { vec![down[5]] } else { vec![up[level + 1], down[level]] };
        builder.pass(&format!("bloom_up{level}"), &sources, &[(up[level], false)]);
    }
    builder.pass("tone_map", &[lit, up[0]], &[(mapped, false)]);
    builder.pass("smooth", &[mapped, motion], &[(smooth, false)]);
    builder.pass("interface", &[], &[(smooth, true)]);
    builder.output(smooth)
}
