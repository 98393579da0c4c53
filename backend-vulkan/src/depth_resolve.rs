//! How a device really resolves depth: what it says, held against what it does. A driver is known that says it averages, and
//! takes sample zero.
//!
//! A slope is drawn into depth of one texel and several samples, once for each mode, in every depth format and with every
//! number of samples; a pass works out from the single samples what each mode has to give. That is a frame like any other, with
//! a Plan of its own.

use crate::device::Device;
use crate::error::Error;
use crate::executor::{Executor, ExecutorOptions};
use crate::readback::Texels;
use crate::recorder::{DrawSource, Recorder};
use crate::shaders::ShaderLibrary;
use crate::{capabilities, convert};
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::Profile;
use framewright_graph::format::Format;
use framewright_graph::frame::{
    Blend, ColorTarget, DepthTarget, Draw, Face, Frame, Image, ImageIndex, Pass, Resolve, ResolveWay, Resource,
    Sampled, Work,
};
use framewright_graph::interface::DrawInterface;
use framewright_graph::source::Span;
use framewright_graph::vocabulary::{CompareOp, Filter, ResolveMode, Sampler, Stages, Subresources};

/// The modes in which depth can be resolved.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct DepthResolve {
    /// Those that the device has.
    pub(crate) has: Vec<ResolveMode>,
    /// Those that it says it has, and doesn't.
    pub(crate) refuted: Vec<ResolveMode>,
}

/// All modes, in the order of the four components that `expect.frag` writes.
const MODES: [ResolveMode; 4] = [ResolveMode::SampleZero, ResolveMode::Average, ResolveMode::Min, ResolveMode::Max];

/// Depth alone: what has stencil too isn't resolved.
const FORMATS: [Format; 3] = [Format::D16_UNORM, Format::X8_D24_UNORM_PACK32, Format::D32_SFLOAT];

const SHADERS: &[(&str, &str)] = &[
    (
        "slope.vert",
        "#version 460
        void main() {
            const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
            gl_Position = vec4(corner, (corner.x + 1.0) * 0.2 + 0.1, 1.0);
        }",
    ),
    ("slope.frag", "#version 460\nvoid main() {}"),
    (
        "expect.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }",
    ),
    (
        "expect.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2DMS slope;
        layout(location = 0) out vec4 modes;
        void main() {
            const float first = texelFetch(slope, ivec2(0), 0).r;
            modes = vec4(first);
            for (int number = 1; number < textureSamples(slope); ++number) {
                const float depth = texelFetch(slope, ivec2(0), number).r;
                modes = vec4(first, modes.y + depth, min(modes.z, depth), max(modes.w, depth));
            }
            modes.y /= float(textureSamples(slope));
        }",
    ),
];

/// How far a resolve may be from what the samples say: a hundredth of the distance from sample to sample.
const TOLERANCE: f32 = 0.001;

/// What `device` does of what it says. Where that can't be found out, it is believed what every device must do.
pub(crate) fn probe(device: &Device) -> DepthResolve {
    let said = device.shared.depth_stencil_resolve().supported_depth_resolve_modes;
    let said: Vec<ResolveMode> = MODES.into_iter().filter(|mode| said.contains(convert::resolve(*mode))).collect();
    let kept = |mode: &ResolveMode| *mode == ResolveMode::SampleZero;
    match resolves_so(device, &said) {
        Ok(right) => {
            let (has, refuted) = said.into_iter().partition(|mode| right.contains(mode));
            DepthResolve { has, refuted }
        }
        Err(_) => DepthResolve { has: said.into_iter().filter(kept).collect(), refuted: Vec::new() },
    }
}

/// Those of these modes that give what they have to, in every format and with every number of samples.
fn resolves_so(device: &Device, modes: &[ResolveMode]) -> Result<Vec<ResolveMode>, Error> {
    let claims = DepthResolve { has: modes.to_vec(), refuted: Vec::new() };
    let claimed = capabilities::profile(&device.shared, String::new(), &mut device.memory(), claims, false);
    let mut right = modes.to_vec();
    for format in FORMATS {
        for samples in claimed.format(format).into_iter().flat_map(|it| &it.samples).filter(|count| **count > 1) {
            let found = resolves_samples_so(device, &claimed, &frame(format, *samples, modes), modes)?;
            right.retain(|mode| found.contains(mode));
        }
    }
    Ok(right)
}

/// The same of one format and number of samples, by a frame that [`frame`] made.
fn resolves_samples_so(
    device: &Device,
    claimed: &Profile,
    frame: &Frame,
    modes: &[ResolveMode],
) -> Result<Vec<ResolveMode>, Error> {
    let failed = |what: String| Error::BadPlan { what };
    let plan = compile(frame, claimed, &mut device.memory(), &Options::default());
    let plan = plan.map_err(|mistakes| failed(mistakes.into_iter().map(|it| it.message).collect()))?;
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    executor.frame(&mut Nothing)?;
    let expected = floats(&executor.read(0)?.bytes);
    let expected =
        |mode: ResolveMode| MODES.iter().zip(&expected).find(|(it, _)| **it == mode).map(|(_, depth)| *depth);
    let mut right = Vec::new();
    for (output, mode) in (1..).zip(modes) {
        let Texels { format, bytes, .. } = executor.read(output)?;
        let found = first_depth(format, &bytes);
        let near = |(found, expected): (f32, f32)| (found - expected).abs() < TOLERANCE;
        if found.zip(expected(*mode)).is_some_and(near) {
            right.push(*mode);
        }
    }
    Ok(right)
}

/// Draws the slope for each mode.
fn frame(format: Format, samples: u32, modes: &[ResolveMode]) -> Frame {
    let whole = Subresources::WHOLE;
    let mut frame = Frame::default();
    frame.images.push(Image::new("modes", Format::R32G32B32A32_SFLOAT, 1, 1));
    for (number, mode) in (1..).zip(modes) {
        let resolve = Some(Resolve { way: ResolveWay::By(*mode), because: "to see what it does".into() });
        frame.images.push(Image { samples, resolve, ..Image::new(&format!("slope {number}"), format, 1, 1) });
        let depth = DepthTarget {
            image: ImageIndex(number),
            range: whole,
            span: Span::NONE,
            clear: Some(0.0),
            test: CompareOp::Always,
            write: true,
            stencil: None,
        };
        frame.passes.push(Pass { depth: Some(depth), ..full_screen(&format!("slope {number}"), "slope") });
    }
    let slope = Sampled {
        binding: "slope".into(),
        image: ImageIndex(1),
        range: whole,
        frames_ago: 0,
        span: Span::NONE,
        eye: None,
        face: Face::Samples,
        texture: None,
        own_pixel: false,
        sampler: Sampler::new(Filter::Nearest),
        stages: Stages::FRAGMENT_SHADER,
    };
    let target =
        ColorTarget { image: ImageIndex(0), range: whole, span: Span::NONE, clear: None, blend: Blend::Replace };
    frame.passes.push(Pass { sampled: vec![slope], color: vec![target], ..full_screen("expect", "expect") });
    frame.outputs = (0..).take(frame.images.len()).map(|image| Resource::Image(ImageIndex(image)).into()).collect();
    frame
}

fn full_screen(name: &str, shader: &str) -> Pass {
    Pass::new(name, Work::Draw { draw: Draw::FullScreen, shader: shader.into(), discards: false, per_sample: false })
}

/// The depth of the first texel, 0 to 1.
fn first_depth(format: Format, bytes: &[u8]) -> Option<f32> {
    let word = || bytes.first_chunk().copied().map(u32::from_ne_bytes);
    match format {
        Format::D16_UNORM => bytes.first_chunk().map(|it| f32::from(u16::from_ne_bytes(*it)) / 65535.0),
        #[allow(clippy::cast_precision_loss, reason = "24 bits are what an f32 holds")]
        Format::X8_D24_UNORM_PACK32 => word().map(|it| (it & 0xff_ffff) as f32 / 16_777_215.0),
        _ => word().map(f32::from_bits),
    }
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|word| f32::from_ne_bytes(*word)).collect()
}

/// Full-screen draws need nothing brought along.
pub(crate) struct Nothing;

impl DrawSource for Nothing {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Ok(0)
    }
}
