//! Draws whose vertices, indices and counts come out of the frame's own buffers.

use crate::frames::{Small, Uses, dispatch, draw, everywhere, frame, texels};
use framewright_graph::frame::{BufferIndex, BufferRole, Draw, Groups, ImageIndex};
use framewright_graph::vulkan::{Format, Subresources};

const WHOLE: Subresources = Subresources::WHOLE;
const ONE: Groups = Groups::Count([1, 1, 1]);
const EXTENT: [u32; 2] = [4, 1];

/// Six vertices: place (two numbers) and value. The first three cover the left half of the target's one row, the others the
/// right.
const SHADERS: &[(&str, &str)] = &[
    (
        "corners.comp",
        "#version 460
        layout(local_size_x = 1) in;
        struct Vertex { float x; float y; uint value; };
        layout(set = 0, binding = 0) writeonly buffer Vertices { Vertex vertex[]; } vertices;
        void main() {
            for (uint i = 0; i < 6; ++i) {
                float left = i < 3 ? -1.0 : 0.0;
                vec2 at = vec2(left + (i % 3 == 1 ? 1.0 : 0.0), float(i % 3) - 1.0);
                vertices.vertex[i] = Vertex(at.x, at.y, 5 + i / 3);
            }
        }",
    ),
    (
        "indices.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer Indices { uint index[]; } indices;
        void main() { for (uint i = 0; i < 3; ++i) indices.index[i] = i + 3; }",
    ),
    (
        "counts.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer Counts { uint count[]; } counts;
        void main() {
            // Vertices, instances, first vertex, first instance.
            uint values[4] = uint[](3, 2, 3, 0);
            for (int i = 0; i < 4; ++i) counts.count[i] = values[i];
        }",
    ),
    (
        "indexed_counts.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer Counts { uint count[]; } counts;
        void main() {
            // Indices, instances, first index, vertex offset, first instance. Indices 0, 1, 2 become 3 - 3 and so on.
            uint values[5] = uint[](3, 1, 0, uint(-3), 0);
            for (int i = 0; i < 5; ++i) counts.count[i] = values[i];
        }",
    ),
    (
        "vertices.vert",
        "#version 460
        layout(location = 0) in vec2 place;
        layout(location = 1) in uint value;
        layout(location = 0) flat out uint seen;
        void main() {
            gl_Position = vec4(place, 0.0, 1.0);
            seen = value + 10 * gl_InstanceIndex;
        }",
    ),
    (
        "show.frag",
        "#version 460
        layout(location = 0) flat in uint seen;
        layout(location = 0) out uint color;
        void main() { color = seen; }",
    ),
];

/// A frame with vertices and a target, to which a draw is added.
fn begun() -> (Small, BufferIndex, ImageIndex) {
    let mut small = Small::default();
    let vertices = small.buffer("vertices", 18);
    let target = small.image("target", Format::R32_UINT, EXTENT);
    small.pass(dispatch("corners", ONE).block("vertices", vertices, (false, true)));
    small.image_output(target);
    (small, vertices, target)
}

fn shows(small: &Small, row: [u32; 4]) {
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "target", 0), row);
    });
}

const CLEAR: Option<[f64; 4]> = Some([1.0, 0.0, 0.0, 0.0]);

#[test]
fn vertices_that_a_pass_wrote_are_drawn() {
    let (mut small, vertices, target) = begun();
    let pass = draw("show", Draw::Vertices { count: 3, instances: 1 }).takes(vertices, BufferRole::Vertex);
    small.pass(pass.draws(target, WHOLE, CLEAR));
    shows(&small, [5, 5, 1, 1]);
}

#[test]
fn indices_that_a_pass_wrote_say_which_vertices() {
    let (mut small, vertices, target) = begun();
    let indices = small.buffer("indices", 3);
    small.pass(dispatch("indices", ONE).block("indices", indices, (false, true)));
    let pass = draw("show", Draw::Vertices { count: 3, instances: 1 }).takes(vertices, BufferRole::Vertex);
    small.pass(pass.takes(indices, BufferRole::Index).draws(target, WHOLE, CLEAR));
    shows(&small, [1, 1, 6, 6]);
}

#[test]
fn counts_that_a_pass_wrote_say_how_much_is_drawn() {
    let (mut small, vertices, target) = begun();
    let counts = small.buffer("counts", 4);
    small.pass(dispatch("counts", ONE).block("counts", counts, (false, true)));
    let pass = draw("show", Draw::Indirect).takes(vertices, BufferRole::Vertex).takes(counts, BufferRole::Indirect);
    small.pass(pass.draws(target, WHOLE, CLEAR));
    // The second of two instances is on top.
    shows(&small, [1, 1, 16, 16]);
}

#[test]
fn indexed_counts_shift_indices_by_their_vertex_offset() {
    let (mut small, vertices, target) = begun();
    let [counts, indices] = [small.buffer("counts", 5), small.buffer("indices", 3)];
    small.pass(dispatch("indexed_counts", ONE).block("counts", counts, (false, true)));
    small.pass(dispatch("indices", ONE).block("indices", indices, (false, true)));
    let pass = draw("show", Draw::Indirect).takes(vertices, BufferRole::Vertex).takes(indices, BufferRole::Index);
    small.pass(pass.takes(counts, BufferRole::Indirect).draws(target, WHOLE, CLEAR));
    shows(&small, [5, 5, 1, 1]);
}
