//! Vertex buffers that a draw source binds and no pipeline reads.

use crate::engine_vertices::{OBJECTS, Plain, QUARTERS, drawn, executor, plain, plan, value};
use crate::frames::on_each_driver;
use framewright_graph::frame::Draw;
use framewright_graph::shader::VertexBuffer;
use framewright_vulkan::{DrawSource, Error, Recorder};

/// Binds a vertex buffer that nothing reads, in each place.
struct Stray(u32, Plain);

impl DrawSource for Stray {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        (0..self.0).for_each(|number| recorder.bind_vertex_buffer_at(number, &self.1.vertices, 0));
        if draw == OBJECTS { self.1.record(draw, recorder) } else { Ok(0) }
    }
}

#[test]
fn do_5_a_vertex_buffer_that_the_device_has_no_binding_of_is_left_out() {
    on_each_driver(|device| {
        let (instance, physical) = device.raw_physical();
        // SAFETY: the physical device belongs to the instance.
        let limits = unsafe { instance.get_physical_device_properties(physical) }.limits;
        let count = limits.max_vertex_input_bindings + 2;
        let mut draws = plain();
        draws.vertex_buffers.resize(count as usize, VertexBuffer::of_vertices(4));
        let mut stray = Stray(count, Plain::quarters(device));
        let found = drawn(device, "plain", draws.clone(), &mut stray).expect("a picture");
        assert_eq!([found[0], found[7], found[56], found[63]], QUARTERS.map(value));
        // A pass of the program's own pipelines has the same interface.
        let plan = plan(device, |pass| pass, ("own", Draw::Custom));
        let mut own = executor(device, &plan, move |_| draws.clone()).expect("an executor");
        own.frame(&mut stray).expect("a frame");
        stray.0 += 1;
        let beyond = own.frame(&mut stray).expect_err("a refusal").to_string();
        assert!(beyond.contains(&format!("the draw interface has no vertex buffer {count}")), "{beyond}");
    });
}
