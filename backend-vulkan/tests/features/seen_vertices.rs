//! Draws of a pass's own vertices see what the draw source brings along (DO-12): it binds, and the draw follows by itself.

use crate::frames::{Small, Uses, draw, on_each_driver, planned};
use framewright_graph::compile::Options;
use framewright_graph::frame::Draw;
use framewright_graph::shader::{DrawInterface, DrawInterfaces, DrawKind, SuppliedKind, SuppliedResource};
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::{
    BindGroup, BufferUsage, DrawSource, Error, Executor, ExecutorOptions, Recorder, Resource, ShaderLibrary,
};

const SHADERS: &[(&str, &str)] = &[
    (
        "seen.vert",
        "#version 460
        layout(set = 1, binding = 0) uniform Camera { vec4 shift; } camera;
        void main() {
            const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
            gl_Position = vec4(corner + camera.shift.xy, 0.0, 1.0);
        }",
    ),
    (
        "seen.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() { color = vec4(1.0); }",
    ),
    (
        "alone.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }",
    ),
    (
        "alone.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() { color = vec4(0.0, 1.0, 0.0, 1.0); }",
    ),
];

/// Binds the camera, if it has one, and draws if it shall.
struct Source {
    camera: Option<BindGroup>,
    draws: bool,
    asked: Vec<(Draw, String)>,
}

impl DrawSource for Source {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        self.asked.push((draw, recorder.pass().to_owned()));
        if let Some(camera) = &self.camera {
            recorder.bind_group(1, camera);
        }
        if self.draws {
            recorder.draw(0..3, 0..1);
        }
        Ok(7)
    }
}

#[test]
fn do_12_a_source_binds_for_vertices_of_the_passs_own_and_draws_none_of_them() {
    let whole = Subresources::WHOLE;
    let mut small = Small::default();
    let shown = small.image("shown", Format::R8G8B8A8_UNORM, [4, 2]);
    let vertices = Draw::Vertices { count: 3, instances: 1 };
    small.pass(draw("alone", vertices).draws(shown, whole, Some([0.0; 4])));
    small.pass(draw("seen", vertices).draws(shown, whole, None));
    small.image_output(shown);
    on_each_driver(|device| {
        let plan = planned(device, &small.frame, &Options::default());
        let seen = DrawInterface {
            supplied: vec![SuppliedResource::new(1, 0, "camera", SuppliedKind::UniformBlock)],
            ..DrawInterface::default()
        };
        let interfaces = DrawInterfaces::default().with(DrawKind::Vertices, seen.clone());
        let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces);
        let options = ExecutorOptions { timestamps: true, ..ExecutorOptions::default() };
        let mut executor = Executor::new(device, &plan, &mut shaders, &options).expect("an executor");
        let shift: Vec<u8> = [1.0f32, 0.0, 0.0, 0.0].iter().flat_map(|number| number.to_ne_bytes()).collect();
        let buffer = device.buffer(BufferUsage::Uniform, &shift).expect("a buffer");
        let group = || device.bind_group(&seen, 1, &[(0, Resource::Buffer(&buffer))]).expect("a group");
        let mut source = Source { camera: Some(group()), draws: false, asked: Vec::new() };
        let frame = executor.frame(&mut source).expect("a frame");
        // What reads nothing of the source doesn't ask it.
        assert_eq!(source.asked, [(vertices, "seen".to_owned())]);
        let (green, white) = ([0, 255, 0, 255], [255; 4]);
        let picture = executor.read(0).expect("a picture").bytes;
        assert_eq!(picture.as_chunks().0, [[green, green, white, white]].repeat(2).concat());
        // Framewright draws, once each.
        let report = executor.report(frame).expect("its report");
        let draws: Vec<u32> = report.steps.iter().flat_map(|step| &step.passes).map(|pass| pass.draws).collect();
        assert_eq!(draws, [1, 1]);

        let mut said = |camera, draws| {
            let mut source = Source { camera, draws, asked: Vec::new() };
            executor.frame(&mut source).expect_err("it is misuse").to_string()
        };
        assert_eq!(said(None, false), "pass `seen`, while recording: a draw without a bind group for set 1");
        let beside = "a draw beside that of the pass's own vertices, which follows by itself";
        assert_eq!(said(Some(group()), true), format!("pass `seen`, while recording: {beside}"));
        drop(executor);
    });
}
