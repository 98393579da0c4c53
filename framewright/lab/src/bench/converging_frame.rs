//! The frame that a reference is drawn by: that of the tested settings, with nothing rounded between its passes, and with light that
//! is averaged over all its frames before it is tone-mapped.

use crate::picture;
use framewright::{Error, Pipeline, PlannedFrame};
use framewright_graph::base::FilePath;
use framewright_graph::compile::Options;
use framewright_graph::device::{MemoryProvider, Profile};
use framewright_graph::frame::{
    Blend, ColorTarget, Draw, Face, Frame, Image, ImageIndex, Lifetime, ParamValue, Pass, Resource, SampledImage, Work,
};
use framewright_graph::vulkan::{ColorComponents, FillValue, Format, Stages, Subresources};

/// Shipped shaders that tone-map an image of light, and the name by which they know it.
const TONE_MAPPERS: [&str; 4] = ["tone_map", "tone_map_operator", "reinhard", "expose"];
const LIGHT: &str = "source";
/// The shader that averages frames, its images, and its number of frames.
const AVERAGE: &str = "shipped:average_frames";
const NOW: &str = "now";
const BEFORE: &str = "before";
const FRAMES: &str = "frames";

/// A frame for a reference, and its Plan once it is known over how many frames light is averaged.
pub(super) struct ConvergingFrame {
    frame: Frame,
    /// The pass that averages each image that is tone-mapped.
    averages: Vec<usize>,
    /// Steps from black to white in the tested output's picture; `None`: it holds light without an upper end.
    pub(super) steps: Option<u16>,
}

impl ConvergingFrame {
    /// The frame as it is for a reference of a pipeline on a device.
    pub(super) fn of(mut frame: Frame, device: &Profile, pipeline: &Pipeline) -> ConvergingFrame {
        let encoding = frame.outputs.first().and_then(|output| output.encoding);
        let steps = screen(&frame).and_then(|image| picture::steps(frame.images[image.0 as usize].format, encoding));
        frame.make_exact(device);
        let mut averages = Vec::new();
        let mut at = 0;
        while at < frame.passes.len() {
            if let Some((average, mean)) = averaged(&mut frame, at, pipeline) {
                let light = frame.passes[at].sampled.iter_mut().find(|sampled| *sampled.binding == *LIGHT);
                if let Some(light) = light {
                    (light.image, light.range) = (mean, Subresources::WHOLE);
                }
                frame.passes.insert(at, average);
                averages.push(at);
                at += 1;
            }
            at += 1;
        }
        ConvergingFrame { frame, averages, steps }
    }

    /// Frames that are drawn before light is averaged over as many.
    pub(super) fn before(&self, frames: u16) -> u16 {
        if self.averages.is_empty() { 0 } else { frames }
    }

    /// The frame with light averaged over `frames` frames, and its Plan.
    ///
    /// # Errors
    /// Those of the compiler.
    pub(super) fn planned(
        &self,
        pipeline: &mut Pipeline,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        frames: u16,
    ) -> Result<PlannedFrame, Error> {
        let mut frame = self.frame.clone();
        for at in &self.averages {
            frame.passes[*at].params = vec![(FRAMES.into(), ParamValue::Integer(frames.into()))];
        }
        let plan = pipeline.compile(&frame, device, memory, &Options::default())?;
        Ok(PlannedFrame { frame, plan })
    }
}

/// The image that is the picture.
fn screen(frame: &Frame) -> Option<ImageIndex> {
    match frame.outputs.first()?.resource {
        Resource::Image(image) => Some(image),
        Resource::Buffer(_) => None,
    }
}

/// Whether a pass's shader is a shipped tone mapper. It has that name in a shipped file, and in one of the user's own unless a shader
/// of that name lies beside it.
fn tone_maps(shader: &str, pipeline: &Pipeline) -> bool {
    let file = FilePath::of_text(shader);
    let is_shipped = || match &file {
        FilePath::Shipped(_) => true,
        FilePath::Own(name) => pipeline.assets.shaders.own_files(&FilePath::from(""), name).is_empty(),
    };
    TONE_MAPPERS.contains(&file.path()) && is_shipped()
}

/// The pass that averages the light that the pass `at` tone-maps, and the new image of the mean; `None` if it tone-maps none, or samples
/// or texels of which several make a pixel.
fn averaged(frame: &mut Frame, at: usize, pipeline: &Pipeline) -> Option<(Pass, ImageIndex)> {
    let pass = &frame.passes[at];
    let (_, shader) = pass.work.draw().filter(|(draw, _)| draw.is_full_screen())?;
    let light = pass.sampled.iter().find(|sampled| *sampled.binding == *LIGHT && sampled.face == Face::Resolved)?;
    if !tone_maps(shader, pipeline) {
        return None;
    }
    // What is tone-mapped at another size than the screen's is averaged as it is shown.
    let (Some(target), Some(screen)) = (pass.color.first().map(|target| target.image), screen(frame)) else {
        return None;
    };
    let extent = |image: ImageIndex| frame.images[image.0 as usize].extent;
    if extent(target) != extent(screen) {
        return None;
    }
    let source = &frame.images[light.image.0 as usize];
    let mean = ImageIndex(u32::try_from(frame.images.len()).ok()?);
    let image = Image {
        name: format!("{} over frames", pass.name).into(),
        format: Format::R32G32B32A32_SFLOAT,
        allocated: None,
        eyes: source.eyes.filter(|_| light.eye.is_none()),
        samples: 1,
        resolve: None,
        chosen: None,
        lifetime: Lifetime::History { frames: 1, initial: FillValue::Color([0.0; 4]) },
        ..source.clone()
    };
    let sampled = |binding: &str, image, frames_ago| SampledImage {
        span: light.span,
        eye: light.eye.filter(|_| frames_ago == 0),
        frames_ago,
        ..SampledImage::new(binding, image, Stages::FRAGMENT_SHADER)
    };
    let work = Work::Draw { draw: Draw::FullScreen, shader: AVERAGE.into(), discards: false, per_sample: false };
    let average = Pass {
        span: pass.span,
        view: pass.view,
        sampled: vec![sampled(NOW, light.image, 0), sampled(BEFORE, mean, 1)],
        color: vec![ColorTarget {
            image: mean,
            range: Subresources::WHOLE,
            span: pass.span,
            clear: None,
            blend: Blend::Replace,
            write_mask: ColorComponents::RGBA,
        }],
        params: vec![(FRAMES.into(), ParamValue::Integer(1))],
        ..Pass::new(&format!("{} averages frames", pass.name), work)
    };
    frame.images.push(image);
    Some((average, mean))
}

#[cfg(test)]
mod tests {
    use super::super::choice::reference_settings;
    use super::*;
    use framewright::{Choices, ReadFiles, RendererOptions};
    use framewright_graph::device::{MemoryEstimate, SHIPPED_PROFILES};
    use framewright_passes::shipped::SHADERS;

    /// Shipped pipelines with a preset `reference`.
    const PIPELINES: [&str; 10] = [
        "deferred",
        "deferred_mobile",
        "dynamic_resolution",
        "forward",
        "forward_overlay",
        "image_quality",
        "post",
        "shadows",
        "soft_focus",
        "temporal",
    ];

    fn of(pipeline: &str, set: &str, device: &Profile) -> (ConvergingFrame, PlannedFrame) {
        let options = RendererOptions::default();
        let mut loaded = Pipeline::open(pipeline, &options, &ReadFiles::default()).expect("a pipeline");
        let of_user = set.split_once('=').map(|(name, value)| (name.to_owned(), value.to_owned()));
        let of_reference = reference_settings(&loaded).expect("a preset");
        let mut choices = Choices::default();
        choices.set = of_user.into_iter().chain(of_reference).collect();
        let frame = loaded.frame(&choices, device).expect("a frame");
        let converging = ConvergingFrame::of(frame, device, &loaded);
        let planned = converging.planned(&mut loaded, device, &mut MemoryEstimate(device), 64).expect("a Plan");
        (converging, planned)
    }

    #[test]
    fn plans_of_references_round_nothing_between_passes() {
        let device = Profile::from_ron(SHIPPED_PROFILES[0].1).expect("a profile");
        for pipeline in PIPELINES {
            let (_, planned) = of(pipeline, "", &device);
            for image in planned.plan.images.iter().filter(|image| !image.format.is_integer()) {
                let exact = match image.format.components() {
                    _ if image.format.is_depth() => Format::D32_SFLOAT,
                    1 => Format::R32_SFLOAT,
                    2 => Format::R32G32_SFLOAT,
                    _ => Format::R32G32B32A32_SFLOAT,
                };
                assert_eq!(image.format, exact, "{pipeline}: {}", image.name);
            }
        }
    }

    /// Light is averaged over frames where the tested pipeline averages light, and not where it averages what is shown.
    #[test]
    fn references_average_before_or_after_tone_mapping_as_the_tested_pipeline_does() {
        let device = Profile::from_ron(SHIPPED_PROFILES[0].1).expect("a profile");
        let averages = |pipeline, set| {
            let (converging, planned) = of(pipeline, set, &device);
            let planned = planned.frame.passes.iter().filter(|pass| pass.name.ends_with("averages frames")).count();
            assert_eq!(planned, converging.averages.len());
            planned
        };
        for pipeline in PIPELINES {
            assert_eq!(averages(pipeline, ""), usize::from(pipeline != "image_quality"), "{pipeline}");
        }
        assert_eq!(averages("image_quality", "mapped=pixels"), 1);
        assert_eq!(averages("image_quality", "tone_mapping=clip"), 0);
        // A pipeline that extends a shipped one names shaders as shipped ones; one of the user's own that is called so is none.
        let folder = tempfile::tempdir().expect("a folder");
        let own = folder.path().join("own.ron");
        std::fs::write(&own, "Pipeline(version: 1, extends: \"forward.ron\")").expect("written");
        assert_eq!(averages(own.to_str().expect("a path"), ""), 1);
        let pass = "(name: \"shown\", draw: FullScreen(\"tone_map\"), sample: {\"source\": \"light\"}, color: [\"screen\"], \
            params: {\"exposure\": 1.0, \"white_point\": 9.0})";
        let text = format!(
            "Pipeline(version: 1, settings: [(name: \"msaa\", value: OneOf(default: 1, of: [1]))], \
             presets: [(name: \"reference\", set: {{\"msaa\": 1}})], \
             images: [(name: \"light\", format: Color(hdr: true), size: Output), (name: \"screen\", format: Output, size: Output)], \
             passes: [(name: \"sky\", draw: Sky, color: [(image: \"light\", clear: (0.0, 0.0, 0.0, 1.0))]), {pass}], outputs: [\"screen\"])"
        );
        std::fs::write(&own, text).expect("written");
        assert_eq!(averages(own.to_str().expect("a path"), ""), 1);
        let shader = SHADERS.iter().find(|(name, _)| *name == "tone_map.frag").expect("it is shipped").1;
        std::fs::write(folder.path().join("tone_map.frag"), shader).expect("written");
        assert_eq!(averages(own.to_str().expect("a path"), ""), 0);
    }
}
