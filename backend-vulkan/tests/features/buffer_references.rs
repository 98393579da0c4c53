//! Shaders that follow addresses of the program's: where it says so, on devices that have them (DO-4).

use crate::addressed::{Addressed, OwnSet};
use crate::frames::{Shaders, Small, Uses, dispatch, draw, on_each_driver, placeless, planned, texels};
use crate::testing::{Nothing, OVER_ALL};
use ash::vk;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame, Groups};
use framewright_graph::shader::{
    DescriptorType, DrawInterfaces, ProgramBinding, ProgramSet, ShaderInterfaces, Variant,
};
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::{Device, Error, Executor, ExecutorOptions, ShaderLibrary};

/// A list of nodes, each at its own address: the sum of their values is shown, and each counts who came by.
macro_rules! list {
    ($qualifier:literal) => {
        concat!(
            "#version 460
#extension GL_EXT_buffer_reference : require
layout(buffer_reference) buffer Node;
layout(buffer_reference, std430, buffer_reference_align = 16) ",
            $qualifier,
            " buffer Node { uint value; uint visits; Node next; };
layout(set = 1, binding = 0, std140) uniform Head { Node head; uint nodes; };
"
        )
    };
}

const SHADERS: Shaders = &[
    ("full_screen.vert", OVER_ALL),
    (
        "sum.frag",
        concat!(
            list!("readonly"),
            "layout(location = 0) out uint color;
void main() {
    color = nodes == 3 ? head.value + head.next.value + head.next.next.value : 0;
}"
        ),
    ),
    (
        "visit.comp",
        concat!(
            list!(""),
            "layout(local_size_x = 1) in;
layout(set = 0, binding = 0, r32ui) uniform writeonly uimage2D target;
void main() {
    uint sum = head.value + head.next.value + head.next.next.value;
    atomicAdd(head.visits, 1);
    atomicAdd(head.next.visits, 1);
    atomicAdd(head.next.next.visits, 1);
    imageStore(target, ivec2(gl_GlobalInvocationID.xy), uvec4(sum));
}"
        ),
    ),
    (
        "store.frag",
        concat!(
            list!(""),
            "layout(location = 0) out uint color;
void main() { color = head.value; head.visits = 1; }"
        ),
    ),
    ("early.vert", concat!(list!(""), "void main() { head.visits = 1; gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }")),
    ("early.frag", crate::testing::WHITE),
    (
        "scalar.frag",
        "#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
layout(buffer_reference, scalar) readonly buffer Node { uvec2 values; vec3 dense; };
layout(set = 1, binding = 0) uniform Head { Node head; };
layout(location = 0) out uint color;
void main() { color = head.values.x + uint(head.dense.z); }",
    ),
];

fn head() -> DrawInterfaces {
    DrawInterfaces::default().with_set(ProgramSet::new(1, [ProgramBinding::new(0, DescriptorType::UniformBuffer)]))
}

fn library(interfaces: DrawInterfaces) -> ShaderLibrary {
    ShaderLibrary::new(Vec::new(), SHADERS, interfaces)
}

fn frame() -> Frame {
    let mut small = Small::default();
    let [shown, computed] = ["shown", "computed"].map(|name| small.image(name, Format::R32_UINT, [4, 1]));
    small.pass(draw("sum", Draw::FullScreen).draws(shown, Subresources::WHOLE, None));
    small.pass(dispatch("visit", Groups::Count([4, 1, 1])).stores("target", computed, Subresources::WHOLE));
    small.image_output(shown);
    small.image_output(computed);
    small.frame
}

fn executor(device: &Device, interfaces: DrawInterfaces) -> Result<Executor, Error> {
    let plan = planned(device, &frame(), &Options::default());
    Executor::new(device, &plan, &mut library(interfaces), &ExecutorOptions::default())
}

#[test]
fn do_4_lists_of_buffers_are_read_and_written_by_their_addresses() {
    on_each_driver(|device| {
        let features = device.profile().features.expect("they are known");
        let made = executor(device, head().with_addresses());
        if !features.iter().any(|it| it == "bufferDeviceAddress") {
            let said = placeless(&made.err().expect("it is refused").to_string());
            let needs = "the fragment stage needs the feature bufferDeviceAddress, which this device doesn't have";
            assert!(said.contains(needs), "{said}");
            return;
        }
        let mut executor = made.expect("an executor");
        // From the last one on, each knows the address of the next.
        let mut nodes: Vec<Addressed<'_>> = Vec::new();
        for value in [300_u32, 20, 1] {
            let next = nodes.last().map_or(0, |it| it.address);
            let mut node = [value.to_ne_bytes(), [0; 4]].concat();
            node.extend(next.to_ne_bytes());
            nodes.push(Addressed::new(device, vk::BufferUsageFlags::STORAGE_BUFFER, 16, &node));
        }
        let mut first = nodes[2].address.to_ne_bytes().to_vec();
        first.extend([3_u32, 0].iter().flat_map(|it| it.to_ne_bytes()));
        let head = Addressed::new(device, vk::BufferUsageFlags::UNIFORM_BUFFER, 16, &first);
        let set = OwnSet::new(device, &[vk::DescriptorType::UNIFORM_BUFFER]);
        set.write_buffer(0, vk::DescriptorType::UNIFORM_BUFFER, head.raw);
        executor.bind_set(1, set.set(), &[]);
        for frame in 1..3 {
            executor.frame(&mut Nothing).expect("a frame");
            assert_eq!(texels(&mut executor, "shown", 0), [321; 4]);
            assert_eq!(texels(&mut executor, "computed", 0), [321; 4]);
            for (node, value) in nodes.iter().zip([300, 20, 1]) {
                assert_eq!(node.words(2), [value, 4 * frame]);
            }
        }
        drop(executor);
    });
}

#[test]
fn do_4_addresses_are_followed_only_where_the_program_hands_them_out() {
    let said = |shader: &str, interfaces: DrawInterfaces| {
        let refused = library(interfaces).draw_shader(shader, Draw::FullScreen, &Variant::default());
        refused.map(|it| it.needs).map_err(|problem| format!("{problem:?}"))
    };
    let refused = said("sum", head()).expect_err("nobody says so");
    let why = "sum.frag:3: it needs SPIR-V's capability PhysicalStorageBufferAddresses, which isn't supported: nothing bounds what is \
               behind an address, and no program says that it hands addresses out";
    assert!(refused.contains(why), "{refused}");
    let named = |shader: &str| {
        let needs = said(shader, head().with_addresses()).expect("it is used");
        needs.iter().map(|need| format!("{:?} {}", need.kind, need.place)).collect::<Vec<_>>().join("\n")
    };
    let needs = named("sum");
    assert!(needs.contains("bufferDeviceAddress") && needs.contains("sum.frag:3"), "{needs}");
    assert!(!needs.contains("fragmentStoresAndAtomics") && !needs.contains("scalarBlockLayout"), "{needs}");
    assert!(named("store").contains("fragmentStoresAndAtomics"));
    assert!(named("scalar").contains("scalarBlockLayout"));
}

#[test]
fn do_4_a_vertex_stage_stores_behind_no_address() {
    let draw = Draw::Vertices { count: 3, instances: 1 };
    let stored = library(head().with_addresses()).draw_shader("early", draw, &Variant::default());
    let said = format!("{:?}", stored.expect_err("not every device can"));
    assert!(said.contains("a vertex shader stores behind an address: not every device can"), "{said}");
}
