//! Whether a device resolves integers to sample zero, as a rendering scope asks it to: a driver is known that takes the last one.
//!
//! Each sample of a texel is given its number, in several formats and with every number of samples. That is a frame like any other,
//! with a Plan of its own.

use super::claims::claimed_profile;
use super::draw::draw;
use crate::base::Error;
use crate::gpu::Device;
use framewright_graph::base::Span;
use framewright_graph::device::Profile;
use framewright_graph::frame::{Blend, ColorTarget, Draw, Frame, Image, ImageIndex, Pass, Resource, Work};
use framewright_graph::vulkan::{ColorComponents, Format, Subresources};

/// One of each width, and one of signed integers, with the shader that draws it.
const FORMATS: [(Format, &str); 4] = [
    (Format::R8_UINT, "number_uint"),
    (Format::R16_UINT, "number_uint"),
    (Format::R32_UINT, "number_uint"),
    (Format::R32_SINT, "number_sint"),
];

const SHADERS: &[(&str, &str)] = &[
    (
        "full_screen.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }",
    ),
    (
        "number_uint.frag",
        "#version 460
        layout(location = 0) out uvec4 color;
        void main() { color = uvec4(gl_SampleID); }",
    ),
    (
        "number_sint.frag",
        "#version 460
        layout(location = 0) out ivec4 color;
        void main() { color = ivec4(gl_SampleID); }",
    ),
];

/// Whether integers are resolved to another sample than sample zero.
///
/// # Errors
/// If that can't be tried.
pub(super) fn is_refuted(device: &Device) -> Result<bool, Error> {
    let claimed = claimed_profile(device);
    let counts = |format| claimed.format(format).into_iter().flat_map(|it| &it.samples).copied();
    let mut all: Vec<u32> = FORMATS.into_iter().flat_map(|(format, _)| counts(format)).filter(|it| *it > 1).collect();
    all.sort_unstable();
    all.dedup();
    for samples in all {
        let frame = frame(&claimed, samples);
        let mut executor = draw(device, &claimed, &frame, SHADERS)?;
        for output in 0..frame.outputs.len() {
            if executor.read(output)?.bytes.iter().any(|byte| *byte != 0) {
                return Ok(true);
            }
        }
    }
    Ok(false)
}

/// Draws the number of each sample in every format that has as many.
fn frame(claimed: &Profile, samples: u32) -> Frame {
    let mut frame = Frame::default();
    let has = |format| claimed.format(format).is_some_and(|it| it.samples.contains(&samples));
    for (number, (format, shader)) in (0..).zip(FORMATS.into_iter().filter(|(format, _)| has(*format))) {
        let name = format!("numbers {number}");
        let image = ImageIndex(number);
        let work = Work::Draw { draw: Draw::FullScreen, shader: shader.into(), discards: false, per_sample: true };
        let (range, span) = (Subresources::WHOLE, Span::NONE);
        let target =
            ColorTarget { image, range, span, clear: None, blend: Blend::Replace, write_mask: ColorComponents::RGBA };
        frame.images.push(Image { samples, ..Image::new(&name, format, 1, 1) });
        frame.passes.push(Pass { color: vec![target], ..Pass::new(&name, work) });
        frame.outputs.push(Resource::Image(image).into());
    }
    frame
}
