//! Whether a device really draws several views at once. A driver is known that draws what it has to clip into the first layer,
//! whichever view it is for.
//!
//! A triangle that reaches beyond the picture is drawn for both eyes, each in its own colour. That is a frame like any other,
//! with a Plan of its own.

use crate::capabilities;
use crate::depth_resolve::{DepthResolve, Nothing};
use crate::device::Device;
use crate::error::Error;
use crate::executor::{Executor, ExecutorOptions};
use crate::shaders::ShaderLibrary;
use framewright_graph::base::Span;
use framewright_graph::compile::{Options, compile};
use framewright_graph::frame::{
    Blend, ColorTarget, Draw, EyeForm, Frame, Image, ImageIndex, Pass, Resource, Stereo, Work,
};
use framewright_graph::shader::DrawInterface;
use framewright_graph::vulkan::{Format, Subresources};

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
    let claimed =
        capabilities::profile(&device.shared, String::new(), &mut device.memory(), DepthResolve::default(), true);
    if claimed.max_multiview_views < 2 {
        return Ok(true);
    }
    let failed = |what: String| Error::BadPlan { what };
    let plan = compile(&frame(), &claimed, &mut device.memory(), &Options::default());
    let plan = plan.map_err(|mistakes| failed(mistakes.into_iter().map(|it| it.message).collect()))?;
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    executor.frame(&mut Nothing)?;
    let texels = executor.read(0)?;
    let (left, right) = texels.bytes.split_at(texels.bytes.len() / 2);
    Ok(left.iter().all(|byte| *byte == 0) && right.iter().all(|byte| *byte == 255))
}

fn frame() -> Frame {
    let eyes = Image { eyes: Some(EyeForm::Layers), ..Image::new("eyes", Format::R8G8B8A8_UNORM, 4, 4) };
    let (image, range) = (ImageIndex(0), Subresources::WHOLE);
    let target = ColorTarget { image, range, span: Span::NONE, clear: None, blend: Blend::Replace };
    let draw = Work::Draw { draw: Draw::FullScreen, shader: "eyes".into(), discards: false, per_sample: false };
    Frame {
        stereo: Stereo::Multiview,
        images: vec![eyes],
        passes: vec![Pass { color: vec![target], ..Pass::new("eyes", draw) }],
        outputs: vec![Resource::Image(image).into()],
        ..Frame::default()
    }
}
