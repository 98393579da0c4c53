//! A frame that the executor records.

use crate::workload::{FRAME_SET, MATERIAL_SET, Objects, Workload, interface};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::plan::Plan;
use framewright_vulkan::{
    BindGroup, Buffer, BufferUsage, CullMode, Device, DrawSource, Error, Executor, ExecutorOptions, FrontFace,
    IndexType, Recorder, Resource, ShaderLibrary,
};

/// A frame and what draws its objects.
pub(crate) struct Ours {
    pub(crate) executor: Executor,
    pub(crate) source: Source,
}

impl Ours {
    pub(crate) fn new(device: &Device, workload: &Workload, plan: &Plan) -> Ours {
        let mut shaders = ShaderLibrary::new(Vec::new(), workload.shaders, interface);
        let executor = Executor::new(device, plan, &mut shaders, &ExecutorOptions::default());
        let objects = workload.objects.as_ref().map(|objects| DrawnObjects::new(device, objects));
        Ours { executor: executor.expect("an executor"), source: Source { objects } }
    }
}

/// Draws the objects as a scene's are drawn: state is set only where it differs from the draw before.
pub(crate) struct Source {
    objects: Option<DrawnObjects>,
}

struct DrawnObjects {
    frame: BindGroup,
    materials: Vec<BindGroup>,
    vertices: Buffer,
    indices: Buffer,
    index_count: u32,
    runs: Vec<(usize, u32)>,
}

impl DrawnObjects {
    fn new(device: &Device, objects: &Objects) -> DrawnObjects {
        let buffer = |usage, bytes: &[u8]| device.buffer(usage, bytes).expect("a buffer");
        let interface = interface(Draw::Objects(DrawList::Opaque));
        let group = |set, buffer: &Buffer| {
            device.bind_group(&interface, set, &[(0, Resource::Buffer(buffer))]).expect("a bind group")
        };
        let material = |color: &Vec<u8>| group(MATERIAL_SET, &buffer(BufferUsage::Uniform, color));
        DrawnObjects {
            frame: group(FRAME_SET, &buffer(BufferUsage::Storage, &objects.places)),
            materials: objects.materials.iter().map(material).collect(),
            vertices: buffer(BufferUsage::Vertex, &objects.vertices),
            indices: buffer(BufferUsage::Index, &objects.indices),
            index_count: objects.index_count,
            runs: objects.runs.clone(),
        }
    }
}

impl DrawSource for Source {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let Some(objects) = &self.objects else { return Ok(0) };
        recorder.bind_group(FRAME_SET, &objects.frame);
        recorder.bind_vertex_buffer(&objects.vertices);
        recorder.bind_index_buffer(&objects.indices, IndexType::U32);
        recorder.set_cull_mode(CullMode::None);
        recorder.set_front_face(FrontFace::CounterClockwise);
        let mut object = 0;
        for (material, count) in &objects.runs {
            recorder.bind_group(MATERIAL_SET, &objects.materials[*material]);
            for _ in 0..*count {
                recorder.draw_indexed(0..objects.index_count, 0, object..object + 1);
                object += 1;
            }
        }
        Ok(object)
    }
}
