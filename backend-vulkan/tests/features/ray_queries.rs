//! Rays that shaders of a pipeline trace, and acceleration structures that custom passes build of the Plan's buffers (DO-4, DO-8).

use crate::acceleration_structures::{Made, Scene, Structures, corners, instances, picture};
use crate::addressed::{Addressed, OwnSet, address};
use crate::frames::{
    Custom, Shaders, Small, Uses, dispatch, draw, on_each_driver, placeless, planned, texels, transfer, words,
};
use crate::testing::OVER_ALL;
use ash::vk;
use framewright_graph::compile::Options;
use framewright_graph::frame::{DeclaredUse, Draw, DrawList, Frame, Groups, Resource, Work};
use framewright_graph::shader::{DescriptorType, DrawInterfaces, ProgramBinding, ProgramSet};
use framewright_graph::vulkan::{Accesses, Format, Layout, Stages, State, Subresources};
use framewright_vulkan::{
    CustomRecorder, Device, DrawSource, Error, Executor, ExecutorOptions, Recorder, ShaderLibrary,
};
use std::cell::RefCell;

const WHOLE: Subresources = Subresources::WHOLE;
const SIZE: [u32; 2] = [48, 32];

/// A ray along z from a place, and what it meets first.
macro_rules! traced {
    ($set:literal) => {
        concat!(
            "#version 460
#extension GL_EXT_ray_query : require
layout(set = ",
            $set,
            ", binding = 0) uniform accelerationStructureEXT scene;
uint met(vec2 at) {
    rayQueryEXT ray;
    rayQueryInitializeEXT(ray, scene, gl_RayFlagsOpaqueEXT, 0xff, vec3(at, -1.0), 0.0, vec3(0.0, 0.0, 1.0), 10.0);
    while (rayQueryProceedEXT(ray)) {}
    if (rayQueryGetIntersectionTypeEXT(ray, true) == gl_RayQueryCommittedIntersectionNoneEXT) return 0;
    return 1 + rayQueryGetIntersectionPrimitiveIndexEXT(ray, true)
        + 2 * rayQueryGetIntersectionInstanceCustomIndexEXT(ray, true);
}
"
        )
    };
}

const DRAWN: &str = concat!(
    traced!("1"),
    "layout(location = 0) out uint color;
void main() { color = met(gl_FragCoord.xy); }"
);

const SHADERS: Shaders = &[
    ("full_screen.vert", OVER_ALL),
    ("full.frag", DRAWN),
    ("objects.vert", OVER_ALL),
    ("objects.frag", DRAWN),
    (
        "computed.comp",
        concat!(
            traced!("1"),
            "layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32ui) uniform writeonly uimage2D target;
void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), uvec4(met(vec2(gl_GlobalInvocationID.xy) + 0.5))); }"
        ),
    ),
    (
        "unbound.frag",
        concat!(
            traced!("0"),
            "layout(location = 0) out uint color;
void main() { color = met(gl_FragCoord.xy); }"
        ),
    ),
];

/// The program's set, of which all stages see the scene.
fn interfaces() -> DrawInterfaces {
    let scene = ProgramBinding::new(0, DescriptorType::AccelerationStructure);
    DrawInterfaces::default().with_set(ProgramSet::new(1, [scene]))
}

/// A full-screen draw, objects and a dispatch, each of which traces.
fn frame() -> Frame {
    let mut small = Small::default();
    let [full, objects, computed] =
        ["full", "objects", "computed"].map(|name| small.image(name, Format::R32_UINT, SIZE));
    small.pass(draw("full", Draw::FullScreen).draws(full, WHOLE, None));
    small.pass(draw("objects", Draw::Objects(DrawList::Opaque)).draws(objects, WHOLE, Some([0.0; 4])));
    let groups = Groups::Count([SIZE[0] / 8, SIZE[1] / 8, 1]);
    small.pass(dispatch("computed", groups).stores("target", computed, WHOLE));
    [full, objects, computed].into_iter().for_each(|image| small.image_output(image));
    small.frame
}

/// Draws one triangle as an object.
struct Objects;

impl DrawSource for Objects {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        recorder.draw(0..3, 0..1);
        Ok(1)
    }
}

#[test]
fn do_4_rays_of_all_kinds_of_passes_meet_what_geometry_says() {
    on_each_driver(|device| {
        let plan = planned(device, &frame(), &Options::default());
        let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
        let made = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default());
        let Some(structures) = Structures::of(device) else {
            let said = made.err().expect("it is refused").to_string();
            let needs = "needs the feature rayQuery, which this device doesn't have";
            assert!(said.contains(".frag:5: ") && placeless(&said).contains(needs), "{said}");
            return;
        };
        let mut executor = made.expect("an executor");
        let scene = Scene::new(device, &structures);
        let set = OwnSet::new(device, &[vk::DescriptorType::ACCELERATION_STRUCTURE_KHR]);
        set.write_structure(0, scene.top());
        executor.bind_set(1, set.set(), &[]);
        executor.frame(&mut Objects).expect("a frame");
        let expected = picture(SIZE);
        // Nothing, and each of the triangles of each instance.
        assert!((0..5).all(|met| expected.iter().filter(|it| **it == met).count() > 20), "{expected:?}");
        for image in ["full", "objects", "computed"] {
            assert_eq!(texels(&mut executor, image, 0), expected, "{image}");
        }
        drop(executor);
    });
}

#[test]
fn do_4_what_uses_an_acceleration_structure_says_so() {
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
    on_each_driver(|device| {
        let plan = planned(device, &frame(), &Options::default());
        let used = plan.features(&mut shaders_of(interfaces())).expect("the shaders are usable");
        let by = |name: &str| used.iter().find(|it| it.name == name).map(|it| it.by.clone());
        let by = ["rayQuery", "accelerationStructure"].map(|name| by(name).unwrap_or_default());
        assert_eq!(by[0], "pass `full`: the fragment stage (shipped:full.frag:5)");
        assert_eq!(by[1], "pass `full`: an acceleration structure in the program's set (shipped:full.frag:3)");
    });
    use framewright_graph::shader::{ShaderInterfaces, Variant};
    let full = shaders.draw_shader("full", Draw::FullScreen, &Variant::default()).expect("it compiles");
    let [scene] = &full.program[..] else { panic!("one: {:?}", full.program) };
    assert_eq!((scene.set, scene.kind, scene.writable), (1, Some(DescriptorType::AccelerationStructure), false));
    let unbound = shaders.draw_shader("unbound", Draw::FullScreen, &Variant::default());
    let said = format!("{unbound:?}");
    assert!(
        said.contains("an acceleration structure") && said.contains("only sets that the program binds itself"),
        "{said}"
    );
}

fn shaders_of(interfaces: DrawInterfaces) -> ShaderLibrary {
    ShaderLibrary::new(Vec::new(), SHADERS, interfaces)
}

/// What writes the corners in the frame.
fn writes_corners() -> &'static str {
    let numbers: Vec<String> = corners().iter().map(|it| format!("{it:?}")).collect();
    let text = format!(
        "#version 460
layout(local_size_x = 18) in;
layout(set = 0, binding = 0) writeonly buffer Corners {{ float corners[18]; }};
void main() {{ const float all[] = {{ {} }}; corners[gl_LocalInvocationIndex] = all[gl_LocalInvocationIndex]; }}",
        numbers.join(", ")
    );
    text.leak()
}

const TRACE: &str = concat!(
    traced!("0"),
    "layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 1) writeonly buffer Hits { uint hits[]; };
void main() { hits[gl_GlobalInvocationID.x + 48 * gl_GlobalInvocationID.y] = met(vec2(gl_GlobalInvocationID.xy) + 0.5); }"
);

/// What a program records: builds of what the frame has written, and rays through them.
struct Program<'d> {
    device: &'d Device,
    structures: &'d Structures,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    /// Of each frame.
    made: RefCell<Vec<Frames<'d>>>,
}

struct Frames<'d> {
    bottom: vk::AccelerationStructureKHR,
    top: vk::AccelerationStructureKHR,
    _instances: Addressed<'d>,
    set: OwnSet<'d>,
}

const TYPES: [vk::DescriptorType; 2] =
    [vk::DescriptorType::ACCELERATION_STRUCTURE_KHR, vk::DescriptorType::STORAGE_BUFFER];

impl<'d> Program<'d> {
    fn new(device: &'d Device, structures: &'d Structures) -> Program<'d> {
        let raw = device.raw();
        let compiler = shaderc::Compiler::new().expect("a compiler");
        let mut options = shaderc::CompileOptions::new().expect("options");
        options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_3 as u32);
        let spirv = compiler.compile_into_spirv(TRACE, shaderc::ShaderKind::Compute, "trace", "main", Some(&options));
        let spirv = spirv.expect("it compiles");
        let like = OwnSet::new(device, &TYPES);
        let layouts = [like.layout];
        // SAFETY: the device lives, all that is pointed to outlives the calls, and the SPIR-V comes from the compiler.
        unsafe {
            let layout = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts);
            let layout = raw.create_pipeline_layout(&layout, None).expect("a layout");
            let module = vk::ShaderModuleCreateInfo::default().code(spirv.as_binary());
            let module = raw.create_shader_module(&module, None).expect("a module");
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(module)
                .name(c"main");
            let info = [vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout)];
            let pipeline = raw.create_compute_pipelines(vk::PipelineCache::null(), &info, None).expect("a pipeline")[0];
            raw.destroy_shader_module(module, None);
            Program { device, structures, layout, pipeline, made: RefCell::default() }
        }
    }

    /// Builds the triangles of the frame's corners; their instances stand in a buffer of the program's.
    fn build_bottom(&self, recorder: &mut CustomRecorder<'_>) {
        let [corners, scratch, bottom] =
            ["corners", "scratch", "bottom"].map(|name| recorder.buffer(name).expect("named"));
        let triangles = Made::Triangles(address(self.device, corners));
        let bottom = self.structures.make(triangles, bottom);
        let scratch = address(self.device, scratch);
        self.structures.build(recorder.raw(), triangles, bottom, scratch);
        let given = instances(self.structures.address(bottom));
        let made = Frames {
            bottom,
            top: vk::AccelerationStructureKHR::null(),
            _instances: Addressed::new(self.device, crate::acceleration_structures::INPUT, 0, &given),
            set: OwnSet::new(self.device, &TYPES),
        };
        self.made.borrow_mut().push(made);
    }

    fn build_top(&self, recorder: &mut CustomRecorder<'_>) {
        let mut all = self.made.borrow_mut();
        let made = all.last_mut().expect("the bottom was built");
        let [scratch, top] = ["scratch", "top"].map(|name| recorder.buffer(name).expect("named"));
        let of = Made::Instances(made._instances.address);
        made.top = self.structures.make(of, top);
        let scratch = address(self.device, scratch);
        self.structures.build(recorder.raw(), of, made.top, scratch);
    }

    fn trace(&self, recorder: &mut CustomRecorder<'_>) {
        let all = self.made.borrow();
        let made = all.last().expect("the top was built");
        made.set.write_structure(0, made.top);
        made.set.write_buffer(1, TYPES[1], recorder.buffer("hits").expect("named"));
        let (raw, commands, point) = (self.device.raw(), recorder.raw(), vk::PipelineBindPoint::COMPUTE);
        // SAFETY: the pass is outside of rendering scopes, and all that is bound lives as long as the program.
        unsafe {
            raw.cmd_bind_pipeline(commands, point, self.pipeline);
            raw.cmd_bind_descriptor_sets(commands, point, self.layout, 0, &[made.set.set], &[]);
            raw.cmd_dispatch(commands, SIZE[0] / 8, SIZE[1] / 8, 1);
        }
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        for made in self.made.borrow().iter() {
            self.structures.destroy(made.bottom);
            self.structures.destroy(made.top);
        }
        // SAFETY: the frames were waited for.
        unsafe {
            self.device.raw().destroy_pipeline(self.pipeline, None);
            self.device.raw().destroy_pipeline_layout(self.layout, None);
        }
    }
}

/// A frame that writes corners, builds a structure of them and one of its instances, and traces that.
fn built_frame(structures: &Structures) -> Frame {
    let mut small = Small::default();
    let [(bottom, own), (top, other)] = [Made::Triangles(0), Made::Instances(0)].map(|made| structures.bytes(made));
    let buffers = [("corners", 72), ("bottom", bottom), ("top", top), ("scratch", own.max(other))];
    let [corners, bottom, top, scratch] = buffers.map(|(name, bytes)| small.buffer(name, bytes.div_ceil(4)));
    let hits = small.buffer("hits", u64::from(SIZE[0] * SIZE[1]));
    small.pass(dispatch("corners", Groups::Count([1, 1, 1])).block("Corners", corners, (false, true)));
    let build = Stages::ACCELERATION_STRUCTURE_BUILD_KHR;
    let [reads, writes] = [Accesses::ACCELERATION_STRUCTURE_READ_KHR, Accesses::ACCELERATION_STRUCTURE_WRITE_KHR];
    let declared = |buffer, stages, accesses| {
        DeclaredUse::new(Resource::Buffer(buffer), State { stages, accesses, layout: Layout::Undefined })
    };
    let custom = |name: &'static str, sides: &[_], uses: Vec<DeclaredUse>| {
        let sides: Vec<_> = sides.iter().map(|(buffer, write)| (Resource::Buffer(*buffer), WHOLE, *write)).collect();
        let mut pass = transfer(name, Work::Custom { callback: name.into() }, &sides);
        pass.uses = uses;
        pass
    };
    let uses = vec![
        declared(corners, build, Accesses::SHADER_READ),
        declared(bottom, build, writes),
        declared(scratch, build, writes),
    ];
    small.pass(custom("build_bottom", &[(corners, false), (bottom, true), (scratch, true)], uses));
    let uses = vec![declared(bottom, build, reads), declared(top, build, writes), declared(scratch, build, writes)];
    small.pass(custom("build_top", &[(bottom, false), (top, true), (scratch, true)], uses));
    let compute = Stages::COMPUTE_SHADER;
    let uses = vec![
        declared(bottom, compute, reads),
        declared(top, compute, reads),
        declared(hits, compute, Accesses::SHADER_STORAGE_WRITE),
    ];
    small.pass(custom("trace", &[(bottom, false), (top, false), (hits, true)], uses));
    small.buffer_output(hits);
    small.frame
}

#[test]
fn do_8_structures_are_built_of_what_the_frame_writes_with_barriers_for_builds_alone() {
    on_each_driver(|device| {
        let Some(structures) = Structures::of(device) else {
            eprintln!("SKIPPED: {} has no ray queries", device.summary().name);
            return;
        };
        let frame = built_frame(&structures);
        let plan = planned(device, &frame, &Options::default());
        let build = Stages::ACCELERATION_STRUCTURE_BUILD_KHR;
        let barriers = plan.steps.iter().flat_map(|step| &step.memory_barriers);
        let reads: Vec<_> = barriers.clone().filter(|it| it.dst_accesses.contains(Accesses::SHADER_READ)).collect();
        assert!(reads.iter().any(|it| it.src_stages.contains(Stages::COMPUTE_SHADER)), "{}", plan.tree());
        assert!(reads.iter().all(|it| it.dst_stages == build), "{}", plan.tree());
        assert!(
            barriers.clone().all(|it| !(it.src_stages | it.dst_stages).contains(Stages::ALL_COMMANDS)),
            "{}",
            plan.tree()
        );
        let used = plan.own_features();
        for name in ["accelerationStructure", "bufferDeviceAddress"] {
            assert!(used.iter().any(|it| it.name == name), "{used:?}");
        }
        let program = Program::new(device, &structures);
        let shaders: Shaders = vec![("corners.comp", writes_corners())].leak();
        let mut library = ShaderLibrary::new(Vec::new(), shaders, DrawInterfaces::default());
        let mut executor =
            Executor::new(device, &plan, &mut library, &ExecutorOptions::default()).expect("an executor");
        for _ in 0..3 {
            let mut record = Custom(|recorder: &mut CustomRecorder<'_>| match recorder.pass() {
                "build_bottom" => program.build_bottom(recorder),
                "build_top" => program.build_top(recorder),
                _ => program.trace(recorder),
            });
            executor.frame(&mut record).expect("a frame");
            assert_eq!(words(&mut executor, "hits"), picture(SIZE));
        }
        drop(executor);
    });
}
