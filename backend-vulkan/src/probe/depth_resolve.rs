//! How a device really resolves depth: what it says, held against what it does. A driver is known that says it averages, and
//! takes sample zero.
//!
//! A slope is drawn into depth of one texel and several samples, once for each mode, in every depth format and with every
//! number of samples; a pass works out from the single samples what each mode has to give. That is a frame like any other, with
//! a Plan of its own. The same is done with a layer for each eye, in every way in which the device draws into both layers at
//! once: a driver is known that resolves the first layer alone.

use super::claims::{DEPTH_RESOLVE_MODES, claimed_profile};
use super::draw::draw;
use crate::base::Error;
use crate::commands::Texels;
use crate::gpu::Device;
use crate::process::SampleResolve;
use framewright_graph::base::Span;
use framewright_graph::device::Profile;
use framewright_graph::frame::{
    Blend, ColorTarget, DepthTarget, Draw, EyeForm, Face, Frame, Image, ImageIndex, Pass, Resolve, ResolveWay,
    Resource, SampledImage, Stereo, Work,
};
use framewright_graph::vulkan::{ColorComponents, CompareOp, Format, ResolveMode, Stages, Subresources};

/// Depth alone: what has stencil too isn't resolved.
const FORMATS: [Format; 3] = [Format::D16_UNORM, Format::X8_D24_UNORM_PACK32, Format::D32_SFLOAT];

const SHADERS: &[(&str, &str)] = &[
    (
        "slope.vert",
        "#version 460
        #ifndef FRAMEWRIGHT_BOTH_EYES
        const int framewright_eye = 0;
        #endif
        void main() {
            const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
            gl_Position = vec4(corner, (corner.x + 1.0) * 0.2 + 0.1 + 0.3 * float(framewright_eye), 1.0);
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

/// The result of trying `device`'s depth resolves. `draws_views`: whether it draws several views at once, if it claims to.
///
/// # Errors
/// If the resolves can't be tried.
pub(crate) fn probe(device: &Device, draws_views: bool) -> Result<SampleResolve, Error> {
    let mut claimed = claimed_profile(device);
    if !draws_views {
        claimed.max_multiview_views = 1;
    }
    let right = resolves_so(device, &claimed, Stereo::Off, &claimed.depth_resolve)?;
    let (has, refuted): (Vec<_>, Vec<_>) = claimed.depth_resolve.iter().copied().partition(|mode| right.contains(mode));
    let mut layered = has.clone();
    for stereo in [Stereo::Instanced, Stereo::Multiview] {
        if stereo.form(Some(&claimed)) == Some(EyeForm::Layers) && stereo.lacks(&claimed).is_none() {
            layered = resolves_so(device, &claimed, stereo, &layered)?;
        }
    }
    let refuted_layered = has.iter().copied().filter(|mode| !layered.contains(mode)).collect();
    Ok(SampleResolve { has, refuted, refuted_layered, ..SampleResolve::default() })
}

/// The resolve modes, of these, that resolve correctly in every format and with every sample count, in all layers that are
/// drawn at once.
fn resolves_so(
    device: &Device,
    claimed: &Profile,
    stereo: Stereo,
    modes: &[ResolveMode],
) -> Result<Vec<ResolveMode>, Error> {
    let mut right = modes.to_vec();
    for format in FORMATS {
        for samples in claimed.format(format).into_iter().flat_map(|it| &it.samples).filter(|count| **count > 1) {
            let found = resolves_samples_so(device, claimed, &frame(stereo, format, *samples, modes), modes)?;
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
    let mut executor = draw(device, claimed, frame, SHADERS)?;
    // Four components for each layer.
    let expected = floats(&executor.read(0)?.bytes);
    let expected = |mode: ResolveMode| -> Vec<f32> {
        let component = DEPTH_RESOLVE_MODES.iter().position(|it| *it == mode);
        expected.chunks(DEPTH_RESOLVE_MODES.len()).filter_map(|layer| layer.get(component?).copied()).collect()
    };
    let mut right = Vec::new();
    for (output, mode) in (1..).zip(modes) {
        let Texels { format, bytes, .. } = executor.read(output)?;
        let (found, expected) = (depths(format, &bytes), expected(*mode));
        let near = |(found, expected): (&f32, &f32)| (found - expected).abs() < TOLERANCE;
        if found.len() == expected.len() && found.iter().zip(&expected).all(near) {
            right.push(*mode);
        }
    }
    Ok(right)
}

/// Draws the slope for each mode; for two eyes, if `stereo` is one of the modes that draw for both at once, each eye's at
/// another depth.
fn frame(stereo: Stereo, format: Format, samples: u32, modes: &[ResolveMode]) -> Frame {
    let whole = Subresources::WHOLE;
    let mut frame = Frame { stereo, ..Frame::default() };
    let eyes = (stereo != Stereo::Off).then_some(EyeForm::Layers);
    frame.images.push(Image { eyes, ..Image::new("modes", Format::R32G32B32A32_SFLOAT, 1, 1) });
    for (number, mode) in (1..).zip(modes) {
        let resolve = Some(Resolve { way: ResolveWay::By(*mode), because: "to see what it does".into() });
        frame.images.push(Image { samples, resolve, eyes, ..Image::new(&format!("slope {number}"), format, 1, 1) });
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
    let slope =
        SampledImage { face: Face::Samples, ..SampledImage::new("slope", ImageIndex(1), Stages::FRAGMENT_SHADER) };
    let target = ColorTarget {
        image: ImageIndex(0),
        range: whole,
        span: Span::NONE,
        clear: None,
        blend: Blend::Replace,
        write_mask: ColorComponents::RGBA,
    };
    frame.passes.push(Pass { sampled: vec![slope], color: vec![target], ..full_screen("expect", "expect") });
    frame.outputs = (0..).take(frame.images.len()).map(|image| Resource::Image(ImageIndex(image)).into()).collect();
    frame
}

fn full_screen(name: &str, shader: &str) -> Pass {
    Pass::new(name, Work::Draw { draw: Draw::FullScreen, shader: shader.into(), discards: false, per_sample: false })
}

/// The depths of texels, 0 to 1.
fn depths(format: Format, bytes: &[u8]) -> Vec<f32> {
    match format {
        Format::D16_UNORM => {
            let texels = bytes.as_chunks().0.iter();
            texels.map(|it| f32::from(u16::from_ne_bytes(*it)) / 65535.0).collect()
        }
        #[allow(clippy::cast_precision_loss, reason = "24 bits are what an f32 holds")]
        Format::X8_D24_UNORM_PACK32 => {
            let texels = bytes.as_chunks().0.iter();
            texels.map(|it| (u32::from_ne_bytes(*it) & 0xff_ffff) as f32 / 16_777_215.0).collect()
        }
        _ => floats(bytes),
    }
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|word| f32::from_ne_bytes(*word)).collect()
}
