//! Plans written by hand, executed under the validation layer.

use crate::testing::plans::{EXTENT, RESOLVED, add_up, resolve_then_sample};
use crate::testing::{self, Nothing, OVER_ALL, WHITE};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::plan::{ImageBarrier, Plan, Role, Work};
use framewright_graph::shader::{Attribute, DrawInterface, SuppliedKind, SuppliedResource, VertexBuffer};
use framewright_graph::vulkan::{Accesses, LoadOp, Stages};
use framewright_vulkan::{
    BufferUsage, Device, DrawSource, Error, Executor, ExecutorOptions, IndexType, Recorder, Resource, ShaderLibrary,
};

const SHADERS: &[(&str, &str)] = &[
    ("full_screen.vert", OVER_ALL),
    (
        "objects.vert",
        "#version 460
        layout(location = 4) in vec2 place;
        layout(set = 1, binding = 0) uniform View { vec4 shift; } view;
        void main() { gl_Position = vec4(place + view.shift.xy * gl_InstanceIndex, 0.0, 1.0); }",
    ),
    (
        "one_sample.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() {
            if (gl_FragCoord.x < 8.0) discard;
            color = vec4(vec3(gl_SampleID == 0 ? 1.0 : 0.0), 1.0);
        }",
    ),
    ("white.frag", WHITE),
    ("larger.frag", WHITE),
    (
        "larger.vert",
        "#version 460
        layout(location = 4) in vec2 place;
        layout(set = 1, binding = 0) uniform View { vec4 shift; mat4 more; } view;
        void main() { gl_Position = view.more * vec4(place + view.shift.xy, 0.0, 1.0); }",
    ),
    (
        "show.frag",
        "#version 460
        layout(set = 0, binding = 3) uniform sampler2D source;
        layout(set = 0, binding = 1) uniform Params { bool invert; } params;
        layout(location = 0) out vec4 color;
        void main() {
            vec3 seen = texture(source, gl_FragCoord.xy / vec2(16.0, 4.0)).rgb;
            color = vec4(params.invert ? 1.0 - seen : seen, 1.0);
        }",
    ),
];

fn interface(draw: Draw) -> DrawInterface {
    match draw {
        Draw::Objects(_) => DrawInterface {
            vertex_buffers: vec![VertexBuffer::of_vertices(12)],
            attributes: vec![Attribute::new("place", 2, 4)],
            supplied: vec![SuppliedResource::new(1, 0, "view", SuppliedKind::UniformBlock)],
            ..DrawInterface::default()
        },
        _ => DrawInterface::default(),
    }
}

fn library() -> ShaderLibrary {
    ShaderLibrary::new(Vec::new(), SHADERS, interface)
}

fn plan(device: &Device) -> Plan {
    let mut plan = resolve_then_sample(device, ("one_sample", Draw::FullScreen), "show");
    for pass in plan.steps[0].work.passes_mut() {
        pass.discards = true;
    }
    plan
}

/// Runs a frame with any source.
struct With<F>(F);

impl<F: FnMut(&mut Recorder<'_>) -> u32> DrawSource for With<F> {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        assert_eq!(draw, Draw::Objects(DrawList::Opaque));
        Ok((self.0)(recorder))
    }
}

fn picture(device: &Device, plan: &Plan, options: &ExecutorOptions) -> Vec<[u8; 4]> {
    let mut executor = Executor::new(device, plan, &mut library(), options).expect("an executor");
    for _ in 0..2 {
        executor.frame(&mut Nothing).expect("a frame");
    }
    let texels = executor.read(0).expect("texels");
    assert_eq!(texels.extent, [EXTENT[0], EXTENT[1], 1]);
    texels.bytes.as_chunks().0.to_vec()
}

/// The picture of [`plan`]: the inverted clear colour on the left, a quarter of white, inverted, on the right.
fn expected() -> Vec<[u8; 4]> {
    let row = [[255, 255, 0, 255]; 8].into_iter().chain([[191, 191, 191, 255]; 8]);
    row.collect::<Vec<_>>().repeat(EXTENT[1] as usize)
}

#[test]
fn a_folded_resolve_is_sampled_exactly_and_in_silence() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    assert_eq!(picture(&device, &plan(&device), &ExecutorOptions::default()), expected());
    drop(device);
    assert_eq!(testing::findings(&messages), []);
}

#[test]
fn poison_does_not_change_a_picture_that_reads_only_what_was_written() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let options = ExecutorOptions { poison: true, ..ExecutorOptions::default() };
    assert_eq!(picture(&device, &plan(&device), &options), expected());
    drop(device);
    assert_eq!(testing::findings(&messages), []);
}

#[test]
fn poison_shows_where_nobody_wrote() {
    let Some(device) = testing::device() else { return };
    let mut plan = plan(device);
    if let Work::Render(scope) = &mut plan.steps[0].work {
        scope.attachments[0].load = LoadOp::Load;
        scope.attachments[0].clear = None;
    }
    let options = ExecutorOptions { poison: true, ..ExecutorOptions::default() };
    // SAFETY: the tests run on software drivers, and reading what nobody wrote is all that is wrong.
    let executor = unsafe { Executor::with_hazards(device, &plan, &mut library(), &options) };
    let mut executor = executor.expect("an executor");
    executor.frame(&mut Nothing).expect("a frame");
    let texels = executor.read(0).expect("texels");
    assert_eq!(texels.bytes[..4], [0, 255, 0, 255], "magenta, inverted");
}

#[test]
fn a_plan_without_poison_in_mind_is_not_poisoned() {
    let Some(device) = testing::device() else { return };
    let mut plan = plan(device);
    plan.images[0].usage.remove(framewright_graph::vulkan::Usage::TRANSFER_DST);
    let options = ExecutorOptions { poison: true, ..ExecutorOptions::default() };
    let refused = Executor::new(device, &plan, &mut library(), &options).err();
    let message = refused.map(|error| error.to_string()).unwrap_or_default();
    assert!(
        message.contains("`color` can't be poisoned") || message.contains("compile it for this device"),
        "{message}"
    );
}

#[test]
fn the_canary_is_heard_and_kept_apart() {
    let Some(device) = testing::open() else { return };
    let canary = device.canary().expect("the layer is awake");
    eprintln!("{}: sees attachments: {}", canary.layer, canary.sees_attachments);
    assert!(!canary.messages.is_empty());
    assert_eq!(testing::findings(&device.messages()), []);
}

#[test]
fn a_device_without_validation_has_no_canary() {
    let Some(device) = testing::device() else { return };
    let choice = framewright_vulkan::DeviceChoice::Index(device.summary().index);
    let options = framewright_vulkan::DeviceOptions { choice, ..Default::default() };
    let silent = Device::open(&options).expect("the same device");
    assert!(matches!(silent.canary(), Err(Error::NoValidationLayer { .. })));
}

/// The messages about `plan`, run although it is wrong; `None` where the layer is too old to judge attachments.
fn messages_about(change: impl FnOnce(&mut Vec<ImageBarrier>)) -> Option<Vec<String>> {
    let device = testing::open()?;
    if !device.canary().expect("the layer is awake").sees_attachments {
        eprintln!("SKIPPED: this layer sees no hazards of rendering attachments");
        return None;
    }
    let mut plan = plan(&device);
    change(&mut plan.steps[1].image_barriers);
    // SAFETY: the tests run on software drivers, which execute commands in order.
    let executor = unsafe { Executor::with_hazards(&device, &plan, &mut library(), &ExecutorOptions::default()) };
    executor.expect("an executor").frame(&mut Nothing).expect("a frame");
    Some(testing::findings(&device.messages()).into_iter().map(|message| message.id).collect())
}

#[test]
fn a_missing_barrier_is_reported() {
    let Some(ids) = messages_about(|barriers| barriers.retain(|barrier| barrier.image != RESOLVED)) else { return };
    assert!(!ids.is_empty());
}

#[test]
fn a_barrier_that_waits_for_nothing_is_reported_as_a_hazard() {
    let changed = messages_about(|barriers| {
        let barrier = barriers.iter_mut().find(|barrier| barrier.image == RESOLVED).expect("it is there");
        barrier.src_stages = Stages::empty();
        barrier.src_accesses = Accesses::empty();
    });
    let Some(ids) = changed else { return };
    assert!(ids.iter().any(|id| id.starts_with("SYNC-HAZARD")), "{ids:?}");
}

#[test]
fn a_plan_for_other_memory_needs_is_refused() {
    let Some(device) = testing::device() else { return };
    let mut plan = plan(device);
    for image in &mut plan.images {
        if let Role::Transient(place) = &mut image.role
            && image.id == RESOLVED
        {
            place.bytes -= 4;
        }
    }
    add_up(&mut plan);
    let refused = Executor::new(device, &plan, &mut library(), &ExecutorOptions::default()).err();
    match refused {
        Some(Error::OtherMemoryNeeds { resource, actual, planned, .. }) => {
            assert_eq!((resource.as_str(), actual.bytes), ("color resolved", planned.bytes + 4));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_estimated_plan_runs_if_there_is_room_enough() {
    let Some(device) = testing::device() else { return };
    let mut plan = plan(device);
    plan.device.exact_memory = false;
    if let Role::Transient(place) = &mut plan.images[1].role {
        place.bytes += 4096;
        plan.heaps[0].bytes = plan.heaps[0].bytes.max(place.offset + place.bytes);
    }
    add_up(&mut plan);
    assert_eq!(picture(device, &plan, &ExecutorOptions::default()), expected());
}

#[test]
fn a_report_names_every_pass_with_its_draws_and_time() {
    let Some(device) = testing::device() else { return };
    let plan = plan(device);
    let options = ExecutorOptions { timestamps: true, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plan, &mut library(), &options).expect("an executor");
    assert!(executor.read(0).is_err(), "nothing to read before the first frame");
    let frame = executor.frame(&mut Nothing).expect("a frame");
    let report = executor.report(frame).expect("its report");
    let names: Vec<_> =
        report.steps.iter().flat_map(|step| &step.passes).map(|it| (it.name.as_str(), it.draws)).collect();
    assert_eq!(names, [("draw", 1), ("show", 1)]);
    let sum: f64 = report.steps.iter().map(|step| step.milliseconds).sum();
    assert!(report.milliseconds > 0.0 && (sum - report.milliseconds).abs() < 1e-6);
    assert!(report.steps.iter().all(|step| step.passes.iter().all(|pass| pass.milliseconds <= step.milliseconds)));
    assert!(executor.read(1).is_err(), "there is one output");
    assert!(executor.report(frame + 1).is_err(), "it was not submitted");
}

#[test]
fn a_report_counts_fragments_where_the_device_does_and_it_is_asked_for() {
    let Some(device) = testing::device() else { return };
    let plan = plan(device);
    let report = |fragment_counts: bool| {
        let options = ExecutorOptions { fragment_counts, ..ExecutorOptions::default() };
        let mut executor = Executor::new(device, &plan, &mut library(), &options).expect("an executor");
        (0..2)
            .map(|_| {
                let frame = executor.frame(&mut Nothing).expect("a frame");
                executor.report(frame).expect("its report").fragment_invocations
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(report(false), [None, None]);
    let counts = report(true);
    if device.summary().name.contains("SwiftShader") {
        assert_eq!(counts, [None, None]);
        return;
    }
    // Both passes cover all 16×4 texels, the first one once for each of four samples. Devices run shaders for whole blocks.
    let count = counts[0].expect("a count");
    assert_eq!(counts, [Some(count), Some(count)], "each frame has a count of its own");
    assert!((320..=640).contains(&count), "{count}");
}

#[test]
fn a_report_without_timestamps_says_no_time() {
    let Some(device) = testing::device() else { return };
    let mut executor =
        Executor::new(device, &plan(device), &mut library(), &ExecutorOptions::default()).expect("an executor");
    let frame = executor.frame(&mut Nothing).expect("a frame");
    let report = executor.report(frame).expect("its report");
    let passes = report.steps.iter().flat_map(|step| &step.passes);
    let times = report.steps.iter().map(|step| step.milliseconds).chain(passes.map(|pass| pass.milliseconds));
    assert_eq!(times.chain([report.milliseconds]).fold(0.0, f64::max), 0.0);
    assert_eq!(report.steps.iter().map(|step| step.passes.len()).sum::<usize>(), 2);
}

#[test]
fn a_draw_source_draws_where_its_vertices_and_instances_say() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let plan = resolve_then_sample(&device, ("white", Draw::Objects(DrawList::Opaque)), "show");
    let corners = [[-1.0, -1.0], [-0.5, -1.0], [-1.0, 1.0], [-0.5, 1.0_f32]];
    let vertices: Vec<u8> = corners.iter().flat_map(|[x, y]| [0.0, *x, *y]).flat_map(f32::to_ne_bytes).collect();
    let indices: Vec<u8> = [0, 1, 2, 2, 1, 3_u16].iter().flat_map(|index| index.to_ne_bytes()).collect();
    let view: Vec<u8> = [0.5, 0.0, 0.0, 0.0_f32].iter().flat_map(|shift| shift.to_ne_bytes()).collect();
    let vertices = device.buffer(BufferUsage::Vertex, &vertices).expect("vertices");
    let indices = device.buffer(BufferUsage::Index, &indices).expect("indices");
    let view = device.buffer(BufferUsage::Uniform, &view).expect("view");
    let group = device
        .bind_group(&interface(Draw::Objects(DrawList::Opaque)), 1, &[(0, Resource::Buffer(&view))])
        .expect("a bind group");
    let mut source = With(|recorder: &mut Recorder<'_>| {
        assert_eq!(recorder.extent(), EXTENT);
        recorder.bind_group(1, &group);
        recorder.bind_vertex_buffer(&vertices);
        recorder.bind_index_buffer(&indices, IndexType::U16);
        recorder.draw_indexed(0..6, 0, 2..3);
        1
    });
    let mut executor = Executor::new(&device, &plan, &mut library(), &ExecutorOptions::default()).expect("an executor");
    executor.frame(&mut source).expect("a frame");
    let texels = executor.read(0).expect("texels");
    // The third instance is shifted by two quarters of the width. White is shown black, the clear colour yellow.
    let row: Vec<bool> = texels.bytes.as_chunks::<4>().0[..16].iter().map(|texel| *texel == [0, 0, 0, 255]).collect();
    assert_eq!(row, (0..16).map(|x| (8..12).contains(&x)).collect::<Vec<_>>());
    drop((executor, group, vertices, indices, view, device));
    assert_eq!(testing::findings(&messages), []);
}

#[test]
fn a_block_that_is_larger_than_its_buffer_is_an_error() {
    let Some(device) = testing::device() else { return };
    let plan = resolve_then_sample(device, ("larger", Draw::Objects(DrawList::Opaque)), "show");
    let mut executor = Executor::new(device, &plan, &mut library(), &ExecutorOptions::default()).expect("an executor");
    let interface = interface(Draw::Objects(DrawList::Opaque));
    let mut bind = |resource: Resource<'_>| {
        let group = device.bind_group(&interface, 1, &[(0, resource)]).expect("a bind group");
        let mut source = With(|recorder: &mut Recorder<'_>| {
            recorder.bind_group(1, &group);
            0
        });
        executor.frame(&mut source).err().map(|error| error.to_string()).unwrap_or_default()
    };
    let small = device.buffer(BufferUsage::Uniform, &[0; 64]).expect("a buffer");
    let said = "pass `draw`, while recording: the block `view` takes 80 bytes, and its buffer holds 64";
    assert_eq!(bind(Resource::Buffer(&small)), said);
    assert_eq!(bind(Resource::Dynamic(&device.dynamic_buffer(BufferUsage::Uniform, 64).expect("a buffer"))), said);
    let large = device.buffer(BufferUsage::Uniform, &[0; 80]).expect("a buffer");
    assert_eq!(bind(Resource::Buffer(&large)), "");
}

#[test]
fn misuse_of_the_recorder_is_an_error_and_no_crash() {
    let Some(device) = testing::device() else { return };
    let plan = resolve_then_sample(device, ("white", Draw::Objects(DrawList::Opaque)), "show");
    let mut executor = Executor::new(device, &plan, &mut library(), &ExecutorOptions::default()).expect("an executor");
    let vertices = device.buffer(BufferUsage::Vertex, &[0; 36]).expect("vertices");
    let view = device.buffer(BufferUsage::Uniform, &[0; 16]).expect("view");
    let group = device
        .bind_group(&interface(Draw::Objects(DrawList::Opaque)), 1, &[(0, Resource::Buffer(&view))])
        .expect("a bind group");
    let mut message = |work: &dyn Fn(&mut Recorder<'_>)| {
        let mut source = With(|recorder: &mut Recorder<'_>| {
            work(recorder);
            0
        });
        executor.frame(&mut source).err().map(|error| error.to_string()).unwrap_or_default()
    };
    let said = "pass `draw`, while recording: ";
    assert_eq!(message(&|it| it.draw(0..3, 0..1)), format!("{said}a draw without a bind group for set 1"));
    assert_eq!(message(&|it| it.bind_group(2, &group)), format!("{said}the draw interface has no set 2"));
    assert_eq!(
        message(&|it| it.bind_vertex_buffer(&view)),
        format!("{said}the buffer was not made for vertices, or not by this device")
    );
    assert_eq!(
        message(&|it| {
            it.bind_group(1, &group);
            it.draw(0..3, 0..1);
        }),
        format!("{said}a draw without vertex buffer")
    );
    assert_eq!(
        message(&|it| {
            it.bind_group(1, &group);
            it.bind_vertex_buffer(&vertices);
            it.draw(1..4, 0..1);
        }),
        format!("{said}vertices 1 to 3 lie beyond the vertex buffer")
    );
    assert_eq!(message(&|it| it.draw_indexed(0..3, 0, 0..1)), format!("{said}an indexed draw without index buffer"));
    assert_eq!(message(&|_| ()), "", "the executor still works");
}

#[test]
fn a_shader_that_does_not_fit_its_pass_is_refused_by_name() {
    let Some(device) = testing::device() else { return };
    let message = |change: &dyn Fn(&mut Plan)| {
        let mut plan = plan(device);
        change(&mut plan);
        let refused = Executor::new(device, &plan, &mut library(), &ExecutorOptions::default()).err();
        refused.map(|error| error.to_string()).unwrap_or_default()
    };
    let second = |plan: &mut Plan, change: &dyn Fn(&mut framewright_graph::plan::Pass)| {
        if let Work::Render(scope) = &mut plan.steps[1].work {
            change(&mut scope.passes[0]);
        }
    };
    let no_param = message(&|plan| second(plan, &|pass| pass.params.clear()));
    assert_eq!(no_param, "pass `show`: `invert` of the block `params` has no value");
    let other_shader = message(&|plan| second(plan, &|pass| pass.shader = "white".into()));
    assert_eq!(other_shader, "pass `show`: the shader has no `source`");
    let no_shader = message(&|plan| second(plan, &|pass| pass.shader = "shwo".into()));
    assert_eq!(
        no_shader,
        "shader `shwo`: not found in the shipped shaders; known shaders: larger; one_sample; show; white"
    );
}
