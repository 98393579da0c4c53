//! An engine of the program's own: draws with its vertices and materials, a custom pass that draws, and one that writes a buffer.
//! `custom_pass/engine.ron` is its pipeline, `custom_pass/interface.rs` what its draws bring along.
//!
//! `cargo run --package framewright --example custom_pass` writes `out/engine.png`.

use framewright::graph::vulkan::FillValue;
use framewright::vulkan::Error;
use framewright::{
    BindGroup, Buffer, BufferUsage, CustomRecorder, Device, DeviceOptions, DispatchRecorder, Draw, DrawList,
    DrawSource, Recorder, Renderer, RendererOptions, Resource,
};
use std::path::Path;

#[path = "custom_pass/interface.rs"]
mod interface;

/// What the engine draws with.
struct Engine {
    vertices: Buffer,
    camera: BindGroup,
    materials: BindGroup,
}

impl Engine {
    fn new(device: &Device) -> Result<Engine, Error> {
        let bytes = |values: &[f32]| values.iter().flat_map(|value| value.to_ne_bytes()).collect::<Vec<u8>>();
        // A place and a tint each.
        let corner = |x, y| [x, y, 1.0, 0.5, 0.0];
        let corners = [corner(-1.0, -1.0), corner(3.0, -1.0), corner(-1.0, 3.0)].concat();
        let camera = device.buffer(BufferUsage::Uniform, &bytes(&[0.0; 4]))?;
        let materials = device.buffer(BufferUsage::Storage, &bytes(&[1.0, 0.0, 1.0, 1.0]))?;
        let of_objects = interface::interfaces().of(Draw::Objects(DrawList::Opaque));
        Ok(Engine {
            vertices: device.buffer(BufferUsage::Vertex, &bytes(&corners))?,
            // Custom draws and compute passes bring the same set, so they share the group.
            camera: device.bind_group(&of_objects, 1, &[(0, Resource::Buffer(&camera))])?,
            materials: device.bind_group(&of_objects, 2, &[(0, Resource::Buffer(&materials))])?,
        })
    }
}

impl DrawSource for Engine {
    /// Draws within a rendering scope. Pipeline and attachments are bound.
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        match (draw, recorder.shader()) {
            (Draw::Custom, "grass") => recorder.bind_group(1, &self.camera),
            (Draw::Objects(DrawList::Opaque), _) => {
                recorder.bind_group(1, &self.camera);
                recorder.bind_group(2, &self.materials);
                recorder.bind_vertex_buffer(&self.vertices);
            }
            (_, shader) => return Err(Error::DrawSource { what: format!("the engine doesn't draw `{shader}`") }),
        }
        recorder.draw(0..3, 0..1);
        Ok(1)
    }

    /// Binds what a compute pass sees of the engine. The dispatch follows by itself.
    fn dispatch(&mut self, recorder: &mut DispatchRecorder<'_>) -> Result<(), Error> {
        recorder.bind_group(1, &self.camera);
        Ok(())
    }

    /// Records a custom pass outside of rendering scopes. The Plan has the barriers around it.
    fn custom(&mut self, callback: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        match callback {
            "upload" => recorder.fill("wind", FillValue::Bits([0; 4])),
            _ => return Err(Error::DrawSource { what: format!("the engine doesn't record `{callback}`") }),
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pipeline = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/custom_pass/engine.ron");
    let mut options = RendererOptions::default();
    options.draws = interface::interfaces();
    let device = Device::open(&DeviceOptions::default())?;
    let mut renderer = Renderer::open(&device, pipeline, options)?;
    renderer.set_extent([160, 80])?;
    renderer.frame(&mut Engine::new(&device)?)?;

    let texels = renderer.read("screen")?;
    std::fs::create_dir_all("out")?;
    image::save_buffer("out/engine.png", &texels.bytes, 160, 80, image::ExtendedColorType::Rgba8)?;
    Ok(())
}
