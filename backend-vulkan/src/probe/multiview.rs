//! Whether a device really draws several views at once. A driver is known that draws what it has to clip into the first layer,
//! whichever view it is for.
//!
//! A triangle that reaches beyond the picture is drawn for both eyes, each in its own colour. That is a frame like any other,
//! with a Plan of its own.

use super::claims::claimed_profile;
use super::draw::draw;
use crate::base::Error;
use crate::gpu::Device;
use framewright_graph::base::Span;
use framewright_graph::frame::{
    Blend, ColorTarget, Draw, EyeForm, Frame, Image, ImageIndex, Pass, Resource, Stereo, Work,
};
use framewright_graph::vulkan::{ColorComponents, Format, Subresources};

const SHADERS: &[(&str, &str)] = &[
    (
        "eyes.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }",
    ),
    (
        "eyes.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() { color = vec4(framewright_eye); }",
    ),
];

/// Whether `device` draws several views at once, if it says so.
///
/// # Errors
/// If that can't be tried.
pub(crate) fn probe(device: &Device) -> Result<bool, Error> {
    let claimed = claimed_profile(device);
    if claimed.max_multiview_views < 2 {
        return Ok(true);
    }
    let mut executor = draw(device, &claimed, &frame(), SHADERS)?;
    let texels = executor.read(0)?;
    let (left, right) = texels.bytes.split_at(texels.bytes.len() / 2);
    Ok(left.iter().all(|byte| *byte == 0) && right.iter().all(|byte| *byte == 255))
}

fn frame() -> Frame {
    let eyes = Image { eyes: Some(EyeForm::Layers), ..Image::new("eyes", Format::R8G8B8A8_UNORM, 4, 4) };
    let (image, range) = (ImageIndex(0), Subresources::WHOLE);
    let target = ColorTarget {
        image,
        range,
        span: Span::NONE,
        clear: None,
        blend: Blend::Replace,
        write_mask: ColorComponents::RGBA,
    };
    let draw = Work::Draw { draw: Draw::FullScreen, shader: "eyes".into(), discards: false, per_sample: false };
    Frame {
        stereo: Stereo::Multiview,
        images: vec![eyes],
        passes: vec![Pass { color: vec![target], ..Pass::new("eyes", draw) }],
        outputs: vec![Resource::Image(image).into()],
        ..Frame::default()
    }
}
