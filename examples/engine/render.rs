//! The thread that draws: Framewright's renderer, and what it asks of the engine.

use crate::gpu::Gpu;
use crate::interface;
use crate::materials::{self, Materials};
use crate::screens::Screens;
use crate::sparks::Sparks;
use crate::{Object, World};
use framewright::graph::frame::DrawList;
use framewright::vulkan::{BindGroup, BufferUsage, DynamicBuffer, Resource, Submission};
use framewright::{CustomRecorder, Device, Draw, DrawSource, Recorder, Renderer, RendererOptions, vulkan};
use std::error::Error;
use std::path::Path;
use std::sync::mpsc::Receiver;

pub(crate) const EXTENT: [u32; 2] = [320, 180];

/// Frames that may be on their way.
const FRAMES: usize = 2;
/// Bytes of an object in `material.hlsl`.
const OBJECT_BYTES: usize = 80;

/// The last frame.
pub(crate) struct Picture {
    pub(crate) texels: Vec<u8>,
    pub(crate) device: String,
}

/// Draws each world that comes.
pub(crate) fn draw(worlds: &Receiver<World>) -> Result<Picture, Box<dyn Error>> {
    let (gpu, device) = Gpu::open()?;
    let mut options = RendererOptions::default();
    options.draws = interface::interfaces();
    options.executor.frames_in_flight = FRAMES as u32;
    let pipeline = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/engine/frame.ron");
    // What is declared first is dropped last: the engine's objects outlive the frames of the renderer.
    let screens;
    let materials;
    let mut engine;
    let mut renderer = Renderer::open(&device, pipeline, options)?;
    renderer.set_extent(EXTENT)?;
    let executor = renderer.executor_mut()?;
    let info = executor.image_info("screen").ok_or("the pipeline has no `screen`")?;
    screens = Screens::new(&gpu, &info, FRAMES + 1)?;
    let images: Vec<_> = screens.screens.iter().map(|screen| screen.image).collect();
    // SAFETY: they were made as the Plan says, and live longer than the renderer. Each frame waits for the last copy of its image.
    unsafe { executor.import_images("screen", &images)? };
    materials = Materials::new(&device)?;
    renderer.bind_set(interface::TABLE, materials.set(), &[]);
    engine = Engine::new(&device)?;

    let mut last = None;
    for world in worlds {
        engine.tell(&world)?;
        let frame = last.map_or(0, |last| last + 1);
        let waits = screens.waits(frame);
        let among = Submission {
            images: &[("screen", frame as usize % images.len())],
            waits: waits.as_slice(),
            signals: &[screens.signals(frame)],
        };
        // SAFETY: the semaphores live, and the copy of the image's last frame was submitted.
        let number = unsafe { renderer.executor_mut()?.submit_with(&mut engine, &among)? };
        assert_eq!(number, frame, "the executor counts frames too");
        screens.copy(frame)?;
        last = Some(frame);
    }
    let texels = screens.read(last.ok_or("there was no frame")?)?;
    Ok(Picture { texels, device: device.summary().name.clone() })
}

/// What the frame's passes are drawn with.
struct Engine {
    objects: DynamicBuffer,
    group: BindGroup,
    sparks: Sparks,
    count: u32,
    seconds: f32,
}

impl Engine {
    fn new(device: &Device) -> Result<Engine, Box<dyn Error>> {
        let camera = device.buffer(BufferUsage::Uniform, &bytes(&camera_matrix()))?;
        let objects = device.dynamic_buffer(BufferUsage::Storage, (materials::COUNT as usize * OBJECT_BYTES) as u64)?;
        let of_objects = interface::interfaces().of(Draw::Objects(DrawList::Opaque));
        let resources = [(0, Resource::Buffer(&camera)), (1, Resource::Dynamic(&objects))];
        let group = device.bind_group(&of_objects, interface::OBJECTS, &resources)?;
        let sparks = Sparks::new(device, FRAMES + 1)?;
        Ok(Engine { objects, group, sparks, count: 0, seconds: 0.0 })
    }

    /// Takes over the world of the next frame.
    fn tell(&mut self, world: &World) -> Result<(), vulkan::Error> {
        let objects: Vec<u8> = world.objects.iter().flat_map(object_bytes).collect();
        self.objects.write(&objects)?;
        (self.count, self.seconds) = (world.objects.len() as u32, world.seconds);
        Ok(())
    }
}

impl DrawSource for Engine {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, vulkan::Error> {
        let Draw::Objects(DrawList::Opaque) = draw else {
            return Err(vulkan::Error::DrawSource { what: format!("the engine doesn't draw `{}`", recorder.shader()) });
        };
        recorder.bind_group(interface::OBJECTS, &self.group);
        // One draw for each object, so that all of a draw has one material.
        for object in 0..self.count {
            recorder.draw(0..36, object..object + 1);
        }
        Ok(self.count)
    }

    fn custom(&mut self, _: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), vulkan::Error> {
        self.sparks.record(recorder, self.seconds);
        Ok(())
    }
}

/// An object as `material.hlsl` reads it: the rows of its matrix, and its material.
fn object_bytes(object: &Object) -> Vec<u8> {
    let (sine, cosine) = object.turned.sin_cos();
    let [x, y, z] = object.place;
    let rows = [[cosine, 0.0, sine, x], [0.0, 1.0, 0.0, y], [-sine, 0.0, cosine, z], [0.0, 0.0, 0.0, 1.0]];
    let mut object_bytes = bytes(rows.as_flattened());
    object_bytes.extend(object.material.to_ne_bytes());
    object_bytes.resize(OBJECT_BYTES, 0);
    object_bytes
}

/// A camera above the cubes, by columns. Depth is 1 at the near plane and 0 in infinity.
fn camera_matrix() -> [f32; 16] {
    const NEAR: f32 = 0.1;
    let aspect = EXTENT[0] as f32 / EXTENT[1] as f32;
    let (down, across) = (1.9, 1.9 / aspect);
    // Looks down by this angle, from this height and distance.
    let (sine, cosine) = 0.55_f32.sin_cos();
    let (height, distance) = (3.6, 5.6);
    // Rows of the view: right, up, and away from what is seen.
    let view = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, cosine, -sine, sine * distance - cosine * height],
        [0.0, sine, cosine, -sine * height - cosine * distance],
    ];
    let mut columns = [0.0; 16];
    for column in 0..4 {
        columns[4 * column] = across * view[0][column];
        columns[4 * column + 1] = -down * view[1][column];
        columns[4 * column + 2] = if column == 3 { NEAR } else { 0.0 };
        columns[4 * column + 3] = -view[2][column];
    }
    columns
}

fn bytes(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_ne_bytes()).collect()
}
