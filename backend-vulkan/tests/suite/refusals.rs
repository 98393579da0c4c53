//! Plans that Vulkan or a device has no way to execute are refused before the driver is asked.

use crate::testing;
use crate::testing::plans::{EXTENT, FORMAT, add_up, resolve_then_sample};
use framewright_graph::device::{FormatSupport, ImageDescriptor, MemoryNeeds, MemoryProvider};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::plan::{
    Access, Attachment, AttachmentKind, AttachmentResolve, Binding, BindingKind, Cause, Heap, Image, ImageId,
    Placement, Plan, Role, StepId, Work,
};
use framewright_graph::shader::{
    Attribute, BINDINGS, DrawInterface, DrawKind, SuppliedKind, SuppliedResource, VertexBuffer,
};
use framewright_graph::vulkan::{
    Filter, Format, Layout, ResolveMode, Sampler, Shape, Sharing, Subresources, Usage, name_of,
};
use framewright_vulkan::{BufferUsage, Device, Executor, ExecutorOptions, Resource, ShaderLibrary};

const SHADERS: &[(&str, &str)] = &[
    ("full_screen.vert", "#version 460\nvoid main() { gl_Position = vec4(0.0); }"),
    (
        "objects.vert",
        "#version 460
        layout(location = 0) in vec2 place;
        void main() { gl_Position = vec4(place, 0.0, 1.0); }",
    ),
    ("white.frag", "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }"),
    ("whole.frag", "#version 460\nlayout(location = 0) out uvec4 color;\nvoid main() { color = uvec4(1); }"),
    ("vertices.vert", "#version 460\nvoid main() { gl_Position = vec4(gl_VertexIndex); }"),
    (
        "brought.frag",
        "#version 460
        layout(set = 1, binding = 0) uniform sampler2D picture;
        layout(location = 0) out vec4 color;
        void main() { color = texture(picture, vec2(0.5)); }",
    ),
    (
        "cube.frag",
        "#version 460
        layout(set = 1, binding = 0) uniform samplerCube picture;
        layout(location = 0) out vec4 color;
        void main() { color = texture(picture, vec3(1.0)); }",
    ),
    (
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D source;
        layout(set = 0, binding = 1) uniform Params { bool invert; } params;
        layout(location = 0) out vec4 color;
        void main() { color = texture(source, vec2(params.invert ? 0.5 : 0.0)); }",
    ),
    (
        "show_whole.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(set = 0, binding = 1) uniform Params { bool invert; } params;
        layout(location = 0) out vec4 color;
        void main() { color = vec4(texture(source, vec2(params.invert ? 0.5 : 0.0))); }",
    ),
];

const PLACE: Attribute = Attribute::new("place", 2, 0);
const PICTURE: SuppliedResource = SuppliedResource::new(1, 0, "picture", SuppliedKind::SampledImage);

fn plain(_: Draw) -> DrawInterface {
    DrawInterface {
        vertex_buffers: vec![VertexBuffer::of_vertices(8)],
        attributes: vec![PLACE],
        supplied: vec![PICTURE],
        ..DrawInterface::default()
    }
}

/// Why a Plan that draws objects with the shader `first` and shows them with `second` is refused; empty if it isn't.
fn refusal(device: &Device, first: &str, second: &str, draws: fn(Draw) -> DrawInterface) -> String {
    refusal_of(device, &resolve_then_sample(device, (first, Draw::Objects(DrawList::Opaque)), second), draws)
}

/// Why a Plan is refused; empty if it isn't.
fn refusal_of(device: &Device, plan: &Plan, draws: fn(Draw) -> DrawInterface) -> String {
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, draws);
    let refused = Executor::new(device, plan, &mut shaders, &ExecutorOptions::default()).err();
    refused.map(|error| error.to_string()).unwrap_or_default()
}

#[test]
fn a_draw_interface_that_vulkan_can_not_bind_is_refused() {
    let Some(device) = testing::device() else { return };
    assert_eq!(refusal(device, "white", "show", plain), "");
    let no_buffer = refusal(device, "white", "show", |draw| DrawInterface { vertex_buffers: vec![], ..plain(draw) });
    assert_eq!(no_buffer, "pass `draw`: the vertex attribute `place` doesn't fit vertices of 0 bytes");
    let beyond = refusal(device, "white", "show", |draw| DrawInterface {
        attributes: vec![Attribute { offset: 4, ..PLACE }],
        ..plain(draw)
    });
    assert_eq!(beyond, "pass `draw`: the vertex attribute `place` doesn't fit vertices of 8 bytes");
    let askew = refusal(device, "white", "show", |draw| DrawInterface {
        vertex_buffers: vec![VertexBuffer::of_vertices(10)],
        ..plain(draw)
    });
    assert_eq!(
        askew,
        "pass `draw`: the vertex attribute `place` doesn't fit vertices of 10 bytes: places of R32G32_SFLOAT are multiples of 4 bytes"
    );
    let wide = refusal(device, "white", "show", |draw| DrawInterface {
        vertex_buffers: vec![VertexBuffer::of_vertices(u32::MAX - 3)],
        ..plain(draw)
    });
    let said = "pass `draw`: the bytes from vertex to vertex are 4294967292; this device allows ";
    assert!(wide.starts_with(said) && wide.ends_with("(maxVertexInputBindingStride)"), "{wide}");
    let far = refusal(device, "white", "show", |draw| DrawInterface {
        supplied: vec![SuppliedResource { set: u32::MAX, ..PICTURE }],
        ..plain(draw)
    });
    assert_eq!(far, "pass `draw`: `picture` can't be brought along in set 4294967295: a draw source has sets 1 to 3");
    let twice = refusal(device, "white", "show", |draw| DrawInterface {
        supplied: vec![PICTURE, SuppliedResource::new(1, 0, "other", SuppliedKind::UniformBlock)],
        ..plain(draw)
    });
    assert_eq!(twice, "pass `draw`: `other` is brought along where something else is");
    let buffer = device.buffer(BufferUsage::Uniform, &[0; 16]).expect("a buffer");
    let block = SuppliedResource { kind: SuppliedKind::UniformBlock, ..PICTURE };
    let interface = DrawInterface { supplied: vec![block.clone(), block], ..DrawInterface::default() };
    let group = device.bind_group(&interface, 1, &[(0, Resource::Buffer(&buffer))]).err();
    let said = group.map(|error| error.to_string()).unwrap_or_default();
    assert_eq!(said, "bind group for set 1: `picture` is brought along where something else is");
}

#[test]
fn a_pass_with_vertices_of_its_own_reads_what_a_draw_source_brings_along_for_it() {
    let Some(device) = testing::device() else { return };
    let for_objects = |draw: Draw| match DrawKind::of(draw) {
        DrawKind::Vertices => DrawInterface::default(),
        DrawKind::Objects(_)
        | DrawKind::Casters(_)
        | DrawKind::Sky
        | DrawKind::FullScreen
        | DrawKind::Custom
        | DrawKind::Compute => plain(draw),
    };
    let own = Draw::Vertices { count: 3, instances: 1 };
    let said = |shader, draw, draws| refusal_of(device, &resolve_then_sample(device, (shader, draw), "show"), draws);
    assert_eq!(said("white", own, plain), "");
    assert_eq!(said("brought", Draw::Objects(DrawList::Opaque), for_objects), "");
    assert_eq!(said("brought", own, plain), "");
    let refused =
        "pass `draw`: the shader reads `picture` at set 1, binding 0, where this kind of draw brings along nothing";
    assert_eq!(said("brought", own, for_objects), refused);
}

#[test]
fn more_resources_than_a_stage_may_have_are_refused() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let said = refusal(&device, "white", "show", |draw| {
        let block = |number| SuppliedResource {
            name: format!("block_{number}").into(),
            ..SuppliedResource::new(1 + number / BINDINGS, number % BINDINGS, "", SuppliedKind::StorageBlock)
        };
        DrawInterface { supplied: (0..3 * BINDINGS).map(block).collect(), ..plain(draw) }
    });
    let refused = said.starts_with("pass `draw`: 768 storage blocks are bound; this device allows ");
    assert!(refused || said.is_empty(), "{said}");
    drop(device);
    // A device that allows them has nothing against them.
    assert_eq!(testing::findings(&messages), []);
}

#[test]
fn a_filter_that_a_format_does_not_have_is_refused() {
    let Some(device) = testing::device() else { return };
    let lacks = |format: &&FormatSupport| !format.linear_filter && format.usage.contains(Usage::SAMPLED);
    let formats = device.profile().formats;
    let Some(format) = formats.iter().filter(lacks).map(|it| it.format).find(|it| it.is_depth()) else {
        eprintln!("SKIPPED: this device filters depth");
        return;
    };
    let message = |filter| {
        let mut plan = resolve_then_sample(device, ("white", Draw::FullScreen), "show");
        let depth = depth_image(&mut plan, device, format, 1);
        if let Work::Render(scope) = &mut plan.steps[1].work {
            let pass = &mut scope.passes[0];
            let range = Subresources::all(format, 1, 1);
            let binding = Some(Binding {
                name: "source".into(),
                kind: BindingKind::Sampled(Sampler::new(filter)),
                texture: None,
            });
            pass.accesses[1] = Access { image: depth, range, binding, ..pass.accesses[1].clone() };
        }
        add_up(&mut plan);
        hazardous(device, &plan)
    };
    assert_eq!(message(Filter::Nearest), "");
    let said = message(Filter::Linear);
    assert!(said.ends_with(&format!("can't filter `depth 1` ({format})")), "{said}");
}

#[test]
fn a_depth_resolve_that_a_device_does_not_have_is_refused() {
    let Some(device) = testing::device() else { return };
    let message = |mode| {
        let mut plan = resolve_then_sample(device, ("white", Draw::FullScreen), "show");
        let [source, target] = [4, 1].map(|samples| depth_image(&mut plan, device, Format::D32_SFLOAT, samples));
        let (layout, range) = (Layout::DepthStencilAttachmentOptimal, Subresources::all(Format::D32_SFLOAT, 1, 1));
        if let Work::Render(scope) = &mut plan.steps[0].work {
            let cause = Cause::Written(None);
            scope.attachments.push(Attachment {
                kind: AttachmentKind::Depth,
                image: source,
                range,
                layout,
                clear: Some([0.0; 4]),
                resolve: Some(AttachmentResolve { image: target, range, layout, mode, cause }),
                ..scope.attachments[0].clone()
            });
        }
        add_up(&mut plan);
        hazardous(device, &plan)
    };
    assert_eq!(message(ResolveMode::SampleZero), "");
    // Devices need to have no other one. Those that have both of these can't show a refusal.
    let has = device.profile().depth_resolve;
    let lacking: Vec<_> = [ResolveMode::Min, ResolveMode::Max].into_iter().filter(|it| !has.contains(it)).collect();
    if lacking.is_empty() {
        eprintln!("SKIPPED: this device resolves depth by its least and its largest sample");
    }
    for mode in lacking {
        let said = message(mode);
        assert!(said.ends_with(&format!("can't resolve depth into `depth 1` by {}", name_of(&mode))), "{said}");
    }
}

/// Adds a depth image with memory of its own.
fn depth_image(plan: &mut Plan, device: &Device, format: Format, samples: u32) -> ImageId {
    let usage = Usage::DEPTH_STENCIL_ATTACHMENT | Usage::SAMPLED;
    let extent = [EXTENT[0], EXTENT[1], 1];
    let needs = device.memory().image(&ImageDescriptor {
        format,
        shape: Shape::D2,
        extent,
        mips: 1,
        layers: 1,
        samples,
        usage,
        sharing: Sharing::Exclusive,
    });
    let MemoryNeeds { bytes, alignment, type_bits } = needs;
    let heap = u32::try_from(plan.heaps.len()).expect("few heaps");
    plan.heaps.push(Heap { bytes, alignment, type_bits, lazily_allocated: false });
    let lifetime = [StepId(0), StepId(1)];
    let role = Role::Transient(Placement { heap, offset: 0, bytes, alignment, type_bits, lifetime });
    let id = ImageId(u32::try_from(plan.images.len()).expect("few images"));
    let name = format!("depth {samples}").into();
    plan.images.push(Image { id, name, format, samples, usage, role, ..plan.images[0].clone() });
    id
}

/// Why a Plan that lacks barriers, and is never drawn, is refused; empty if it isn't.
fn hazardous(device: &Device, plan: &Plan) -> String {
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, plain);
    // SAFETY: no frame is drawn.
    let refused = unsafe { Executor::with_hazards(device, plan, &mut shaders, &ExecutorOptions::default()) }.err();
    refused.map(|error| error.to_string()).unwrap_or_default()
}

#[test]
fn images_and_outputs_of_another_type_than_the_shader_s_are_refused() {
    let Some(device) = testing::device() else { return };
    let cube = refusal(device, "cube", "show", plain);
    assert!(cube.starts_with("pass `draw`: the shader reads `picture` at set 1, binding 0"), "{cube}");
    let output = refusal(device, "whole", "show", plain);
    assert_eq!(output, "pass `draw`: the shader writes unsigned integers to `color`, which is R8G8B8A8_UNORM");
    let source = refusal(device, "white", "show_whole", plain);
    assert_eq!(source, "pass `show`: the shader reads unsigned integers from `source`, which is R8G8B8A8_UNORM");
}

#[test]
fn an_image_that_can_not_be_takes_more_memory_than_there_is() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let [width, height] = EXTENT;
    let possible = ImageDescriptor {
        format: FORMAT,
        shape: Shape::D2,
        extent: [width, height, 1],
        mips: 1,
        layers: 1,
        samples: 1,
        usage: Usage::COLOR_ATTACHMENT,
        sharing: Sharing::Exclusive,
    };
    let mut memory = device.memory();
    assert!(memory.image(&possible).bytes < 1 << 20);
    for impossible in [
        ImageDescriptor { extent: [0, height, 1], ..possible },
        ImageDescriptor { extent: [u32::MAX, height, 1], ..possible },
        ImageDescriptor { mips: 6, ..possible },
        ImageDescriptor { layers: 0, ..possible },
        ImageDescriptor { samples: 3, ..possible },
        ImageDescriptor { usage: Usage::empty(), ..possible },
        ImageDescriptor { usage: Usage::DEPTH_STENCIL_ATTACHMENT, ..possible },
    ] {
        assert_eq!(memory.image(&impossible).bytes, u64::MAX, "{impossible:?}");
    }
    drop((memory, device));
    assert_eq!(testing::findings(&messages), []);
}
