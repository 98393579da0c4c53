use super::interface;
use framewright::graph::frame::DrawList;
use framewright::vulkan::{BindGroup, Buffer, BufferUsage, DynamicBuffer, Resource};
use framewright::{Device, Draw, DrawSource, Error, Recorder, Renderer, RendererOptions, Texels, vulkan};
use std::path::Path;

/// Draws a triangle for each instance, seen by a camera that moves to the right.
struct Moving {
    corners: Buffer,
    camera: DynamicBuffer,
    camera_group: BindGroup,
    materials: BindGroup,
}

impl DrawSource for Moving {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, vulkan::Error> {
        let shift = 0.25 * recorder.frame() as f32;
        // The frame before may still be drawn: it keeps the camera that it was recorded with.
        self.camera.write([shift, 0.0, 0.0, 0.0].map(f32::to_ne_bytes).as_flattened())?;
        recorder.bind_group(1, &self.camera_group);
        recorder.bind_group(2, &self.materials);
        recorder.bind_vertex_buffer(&self.corners);
        recorder.draw(0..3, 0..1);
        Ok(1)
    }
}

/// Three pictures, the next one always begun before the last is read.
pub(crate) fn draw(device: &Device) -> Result<Vec<Texels>, Error> {
    let mut options = RendererOptions::default();
    options.draws = interface::interfaces();
    options.executor.frames_in_flight = 2;
    options.executor.readback = true;
    let pipeline = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/custom_pass/engine.ron");
    let mut renderer = Renderer::open(device, pipeline, options)?;
    renderer.set("grass", false)?;
    renderer.set_extent([64, 32])?;

    let of_objects = interface::interfaces().of(Draw::Objects(DrawList::Opaque));
    let bytes = |values: &[f32]| values.iter().flat_map(|value| value.to_ne_bytes()).collect::<Vec<u8>>();
    // Places and tints.
    let corners = [[-1.0, -1.0, 1.0, 1.0, 1.0], [-0.5, -1.0, 1.0, 1.0, 1.0], [-1.0, 3.0, 1.0, 1.0, 1.0]].concat();
    let camera = device.dynamic_buffer(BufferUsage::Uniform, 16)?;
    let materials = device.buffer(BufferUsage::Storage, &bytes(&[1.0; 4]))?;
    let mut moving = Moving {
        corners: device.buffer(BufferUsage::Vertex, &bytes(&corners))?,
        camera_group: device.bind_group(&of_objects, 1, &[(0, Resource::Dynamic(&camera))])?,
        materials: device.bind_group(&of_objects, 2, &[(0, Resource::Buffer(&materials))])?,
        camera,
    };
    let mut pictures = Vec::new();
    let mut last = renderer.submit(&mut moving)?;
    for _ in 0..3 {
        let next = renderer.submit(&mut moving)?;
        pictures.push(renderer.executor_mut()?.read_back_image(last, 0)?);
        last = next;
    }
    Ok(pictures)
}
