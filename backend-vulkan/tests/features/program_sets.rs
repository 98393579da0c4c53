//! Sets that the program makes and binds itself: for all passes, and within one (DO-5).

use crate::frames::{Small, Uses, dispatch, draw, on_each_driver, planned, texels};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, DrawList, Frame, Groups};
use framewright_graph::shader::{
    BindingFlags, DescriptorType, DrawInterface, DrawInterfaces, DrawKind, ProgramBinding, ProgramSet, SuppliedKind,
    SuppliedResource,
};
use framewright_graph::vulkan::{Format, Stages, Subresources};
use framewright_vulkan::ash::vk;
use framewright_vulkan::{
    Buffer, BufferUsage, Device, DispatchRecorder, DrawSource, Error, Executor, ExecutorOptions, ProgramBuffer,
    ProgramView, RawSet, Recorder, Resource, SamplerDescriptor, SetLayouts, ShaderLibrary, Texture,
};

const OBJECTS: Draw = Draw::Objects(DrawList::Opaque);
/// The program's set.
const SET: u32 = 2;
/// Bytes from value to value in the uniform buffer: a multiple of every device's alignment.
const STRIDE: u32 = 256;

/// What all shaders declare: `value + offset + texel` is shown.
macro_rules! declared {
    () => {
        "layout(set = 2, binding = 0) uniform Value { uint value; };
        layout(set = 2, binding = 1) readonly buffer Offset { uint offset; };
        layout(set = 2, binding = 2) uniform texture2D image;
        layout(set = 2, binding = 3) uniform sampler point;
        uint shown() {
            return value + offset + uint(round(textureLod(sampler2D(image, point), vec2(1.25, 0.5), 0.0).r * 255.0));
        }
        "
    };
}

const SHADERS: &[(&str, &str)] = &[
    ("full_screen.vert", crate::testing::OVER_ALL),
    (
        "objects.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }",
    ),
    (
        "shown.frag",
        concat!(
            "#version 460\n",
            declared!(),
            "layout(location = 0) out uint color;
            void main() { color = shown(); }"
        ),
    ),
    (
        "both.frag",
        concat!(
            "#version 460\n",
            declared!(),
            "layout(set = 1, binding = 0) uniform Brought { uint brought; };
            layout(location = 0) out uint color;
            void main() { color = shown() + brought; }"
        ),
    ),
    (
        "computed.comp",
        concat!(
            "#version 460\nlayout(local_size_x = 4) in;\n",
            declared!(),
            "layout(set = 0, binding = 0, r32ui) uniform writeonly uimage2D target;
            void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), uvec4(shown())); }"
        ),
    ),
    (
        "vertices.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }",
    ),
    (
        "vertices.frag",
        concat!(
            "#version 460\n",
            declared!(),
            "layout(location = 0) out uint color;
            void main() { color = shown(); }"
        ),
    ),
    // Each is wrong in one way.
    (
        "of_another_type.frag",
        "#version 460
        layout(set = 2, binding = 0) readonly buffer Value { uint value; };
        layout(location = 0) out uint color;
        void main() { color = value; }",
    ),
    (
        "too_long.frag",
        "#version 460
        layout(set = 2, binding = 2) uniform texture2D images[2];
        layout(location = 0) out uint color;
        layout(set = 2, binding = 3) uniform sampler point;
        void main() { color = uint(textureLod(sampler2D(images[1], point), vec2(0.0), 0.0).r); }",
    ),
    (
        "nothing_there.frag",
        "#version 460
        layout(set = 2, binding = 7) uniform Value { uint value; };
        layout(location = 0) out uint color;
        void main() { color = value; }",
    ),
    (
        "in_the_vertex_stage.vert",
        "#version 460
        layout(set = 2, binding = 0) uniform Value { uint value; };
        void main() { gl_Position = vec4(vec2(value), 0.0, 1.0); }",
    ),
    (
        "in_the_vertex_stage.frag",
        "#version 460
        layout(location = 0) out uint color;
        void main() { color = 0; }",
    ),
];

fn set() -> ProgramSet {
    use DescriptorType as Is;
    let stages = Stages::FRAGMENT_SHADER | Stages::COMPUTE_SHADER;
    let kinds = [Is::UniformBufferDynamic, Is::StorageBuffer, Is::SampledImage, Is::Sampler];
    let binding = |(number, kind)| ProgramBinding::new(number, kind).with_stages(stages);
    ProgramSet::new(SET, (0..).zip(kinds).map(binding).collect::<Vec<_>>())
}

fn brought() -> DrawInterface {
    DrawInterface {
        supplied: vec![SuppliedResource::new(1, 0, "Brought", SuppliedKind::UniformBlock)],
        ..DrawInterface::default()
    }
}

fn interfaces() -> DrawInterfaces {
    DrawInterfaces::default().with(DrawKind::Objects(DrawList::Opaque), brought()).with_set(set())
}

/// The program's set, with values 1, 2, 3 and 4 at the offsets, the offset 10, and the texels 100 and 200.
struct Program<'d> {
    device: &'d Device,
    layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    raw: vk::DescriptorSet,
    _kept: (Buffer, Buffer, Texture),
}

impl<'d> Program<'d> {
    fn new(device: &'d Device, immutable: bool) -> Program<'d> {
        use vk::DescriptorType as Is;
        let texel = [[100, 0, 0, 255], [200, 0, 0, 255]];
        let filter =
            SamplerDescriptor { magnify: framewright_graph::vulkan::Filter::Nearest, ..SamplerDescriptor::default() };
        let texture = device.texture(2, 1, Format::R8G8B8A8_UNORM, texel.as_flattened(), &filter, false).expect("one");
        let mut values = vec![0; 4 * STRIDE as usize];
        (0..4).for_each(|at: u8| values[usize::from(at) * STRIDE as usize] = at + 1);
        let values = device.buffer(BufferUsage::Uniform, &values).expect("memory");
        let offset = device.buffer(BufferUsage::Storage, &10_u32.to_ne_bytes()).expect("memory");
        let (view, sampler) = texture.raw();
        let stages = vk::ShaderStageFlags::FRAGMENT | vk::ShaderStageFlags::COMPUTE;
        let types = [Is::UNIFORM_BUFFER_DYNAMIC, Is::STORAGE_BUFFER, Is::SAMPLED_IMAGE, Is::SAMPLER];
        let samplers = [sampler];
        let binding = |(number, ty)| {
            let plain = vk::DescriptorSetLayoutBinding::default().binding(number).descriptor_type(ty);
            let plain = plain.descriptor_count(1).stage_flags(stages);
            if immutable && ty == Is::SAMPLER { plain.immutable_samplers(&samplers) } else { plain }
        };
        let bindings: Vec<_> = (0..).zip(types).map(binding).collect();
        let sizes = types.map(|ty| vk::DescriptorPoolSize { ty, descriptor_count: 1 });
        let raw = device.raw();
        // SAFETY: the device lives, and all that is written lives in the program.
        unsafe {
            let layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let layout = raw.create_descriptor_set_layout(&layout, None).expect("a layout");
            let pool = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
            let pool = raw.create_descriptor_pool(&pool, None).expect("a pool");
            let layouts = [layout];
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            let set = raw.allocate_descriptor_sets(&info).expect("a set")[0];
            let value = [vk::DescriptorBufferInfo::default().buffer(values.raw()).range(16)];
            let more = [vk::DescriptorBufferInfo::default().buffer(offset.raw()).range(vk::WHOLE_SIZE)];
            let seen = [vk::DescriptorImageInfo::default()
                .image_view(view)
                .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)];
            let point = [vk::DescriptorImageInfo::default().sampler(sampler)];
            let write = |number: u32, ty| {
                vk::WriteDescriptorSet::default().dst_set(set).dst_binding(number).descriptor_type(ty)
            };
            let writes = [
                write(0, types[0]).buffer_info(&value),
                write(1, types[1]).buffer_info(&more),
                write(2, types[2]).image_info(&seen),
                write(3, types[3]).image_info(&point),
            ];
            raw.update_descriptor_sets(if immutable { &writes[..3] } else { &writes }, &[]);
            Program { device, layout, pool, raw: set, _kept: (values, offset, texture) }
        }
    }

    fn set(&self) -> RawSet {
        // SAFETY: it fits, and lives longer than the executors of the tests.
        unsafe { RawSet::new(self.raw) }
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        // SAFETY: the frames were waited for.
        unsafe {
            self.device.raw().destroy_descriptor_pool(self.pool, None);
            self.device.raw().destroy_descriptor_set_layout(self.layout, None);
        }
    }
}

/// Binds sets in the pass, and draws; the second time in the right half.
struct Source {
    /// The offsets of two draws.
    offsets: Vec<Vec<u32>>,
    set: Option<RawSet>,
    number: u32,
    group: Option<framewright_vulkan::BindGroup>,
}

impl Source {
    fn of(set: Option<RawSet>, offsets: &[&[u32]]) -> Source {
        let offsets = offsets.iter().map(|it| it.to_vec()).collect();
        Source { offsets, set, number: SET, group: None }
    }
}

impl DrawSource for Source {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        if let Some(group) = &self.group {
            recorder.bind_group(1, group);
        }
        if self.offsets.is_empty() {
            recorder.draw(0..3, 0..1);
        }
        for (at, offsets) in (0..).zip(&self.offsets) {
            if let Some(set) = self.set {
                recorder.bind_set(self.number, set, offsets);
            }
            recorder.set_scissor([2 * at, 0], [4, 1]);
            recorder.draw(0..3, 0..1);
        }
        Ok(2)
    }

    fn dispatch(&mut self, recorder: &mut DispatchRecorder<'_>) -> Result<(), Error> {
        if let (Some(set), Some(offsets)) = (self.set, self.offsets.first()) {
            recorder.bind_set(self.number, set, offsets);
        }
        Ok(())
    }
}

/// A pass over four pixels.
fn frame(shader: &str, kind: Draw) -> Frame {
    let mut small = Small::default();
    let shown = small.image("shown", Format::R32_UINT, [4, 1]);
    let whole = Subresources::WHOLE;
    if shader == "computed" {
        small.pass(dispatch(shader, Groups::Count([1, 1, 1])).stores("target", shown, whole));
    } else {
        small.pass(draw(shader, kind).draws(shown, whole, Some([0.0; 4])));
    }
    small.image_output(shown);
    small.frame
}

fn executor(device: &Device, frame: &Frame, layouts: SetLayouts) -> Result<Executor, Error> {
    let plan = planned(device, frame, &Options::default());
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces()).with_set_layouts(layouts);
    Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())
}

#[test]
fn a_set_is_bound_for_full_screen_draws_objects_vertices_and_dispatches_alike() {
    on_each_driver(|device| {
        let program = Program::new(device, false);
        let kinds = [("shown", Draw::FullScreen), ("shown", OBJECTS), ("computed", OBJECTS)];
        for (shader, kind) in kinds.into_iter().chain([("vertices", Draw::Vertices { count: 3, instances: 1 })]) {
            let mut executor = executor(device, &frame(shader, kind), SetLayouts::default()).expect("an executor");
            let mut source = Source::of(None, &[]);
            for (at, value) in [(0, 1), (3, 4)] {
                executor.bind_set(SET, program.set(), &[at * STRIDE]);
                executor.frame(&mut source).expect("a frame");
                // Beyond its edge the texture begins anew: it is the sampler of the set that says so.
                assert_eq!(texels(&mut executor, "shown", 0), [value + 10 + 100; 4], "{shader}, {kind:?}");
            }
        }
    });
}

#[test]
fn a_pass_binds_sets_of_its_own_beside_its_groups_with_other_offsets_for_each_draw() {
    on_each_driver(|device| {
        let program = Program::new(device, false);
        let mut executor = executor(device, &frame("both", OBJECTS), SetLayouts::default()).expect("an executor");
        let camera = device.buffer(BufferUsage::Uniform, &1000_u32.to_ne_bytes().repeat(4)).expect("memory");
        let group = device.bind_group(&brought(), 1, &[(0, Resource::Buffer(&camera))]).expect("a group");
        let mut source = Source::of(Some(program.set()), &[&[0], &[2 * STRIDE]]);
        source.group = Some(group);
        executor.frame(&mut source).expect("a frame");
        assert_eq!(texels(&mut executor, "shown", 0), [1111, 1111, 1113, 1113]);

        let computed = frame("computed", OBJECTS);
        let mut executor = self::executor(device, &computed, SetLayouts::default()).expect("an executor");
        executor.frame(&mut Source::of(Some(program.set()), &[&[STRIDE]])).expect("a frame");
        assert_eq!(texels(&mut executor, "shown", 0), [112; 4]);
    });
}

#[test]
fn immutable_samplers_come_with_a_layout_of_the_programs() {
    on_each_driver(|device| {
        let program = Program::new(device, true);
        // SAFETY: it is made as the set says, and lives longer than the executor.
        let layouts = unsafe { SetLayouts::default().with(SET, program.layout) };
        let mut executor = executor(device, &frame("shown", Draw::FullScreen), layouts).expect("an executor");
        executor.bind_set(SET, program.set(), &[0]);
        executor.frame(&mut Source::of(None, &[])).expect("a frame");
        assert_eq!(texels(&mut executor, "shown", 0), [111; 4]);
        drop(executor);
    });
}

#[test]
fn shaders_that_do_not_fit_the_set_are_refused_in_words() {
    on_each_driver(|device| {
        let said = |shader: &str| {
            let made = executor(device, &frame(shader, Draw::FullScreen), SetLayouts::default());
            made.err().expect("it is refused").to_string()
        };
        for (shader, what) in [
            (
                "of_another_type",
                "`Value`, set 2, binding 0 (shipped:of_another_type.frag:2): it is declared as a storage block, and is a \
                 uniform block with a dynamic offset",
            ),
            (
                "too_long",
                "`images`, set 2, binding 2 (shipped:too_long.frag:2): it is declared as an array of 2, and has 1",
            ),
            (
                "nothing_there",
                "`Value`, set 2, binding 7 (shipped:nothing_there.frag:2): the program's set has no such binding; it has \
                 0, 1, 2, 3",
            ),
            (
                "in_the_vertex_stage",
                "`Value`, set 2, binding 0 (shipped:in_the_vertex_stage.vert:2): vertex shaders read it, and it is made \
                 for fragment and compute shaders",
            ),
        ] {
            assert_eq!(said(shader), format!("pass `{shader}`: the shader uses {what}"));
        }
    });
}

#[test]
fn a_set_that_is_not_bound_or_does_not_fit_is_an_error_of_the_frame() {
    on_each_driver(|device| {
        let program = Program::new(device, false);
        let said = |shader: &str, kind, bound: Option<(RawSet, &[u32])>, mut source: Source| {
            let mut executor = executor(device, &frame(shader, kind), SetLayouts::default()).expect("an executor");
            if let Some((set, offsets)) = bound {
                executor.bind_set(SET, set, offsets);
            }
            let said = executor.frame(&mut source).expect_err("it is refused").to_string();
            said.strip_prefix(&format!("pass `{shader}`, while recording: ")).map(str::to_owned).unwrap_or(said)
        };
        let nothing = || Source::of(None, &[]);
        let (full, own) = (Draw::FullScreen, Draw::Vertices { count: 3, instances: 1 });
        let unbound = "a draw without set 2, which the program binds itself by `Executor::bind_set`";
        assert_eq!(said("shown", full, None, nothing()), unbound);
        assert_eq!(said("vertices", own, None, nothing()), unbound);
        let unbound = "without set 2, which the program binds itself by `bind_set`";
        assert_eq!(said("shown", OBJECTS, None, nothing()), format!("a draw {unbound}"));
        assert_eq!(said("computed", full, None, nothing()), format!("a dispatch {unbound}"));
        // SAFETY: no set is bound.
        let null = unsafe { RawSet::new(vk::DescriptorSet::null()) };
        let of_null = "set 2 of the program is VK_NULL_HANDLE";
        assert_eq!(said("shown", full, Some((null, &[0])), nothing()), of_null);
        assert_eq!(said("shown", OBJECTS, None, Source::of(Some(null), &[&[0]])), of_null);
        let set = program.set();
        let few = "set 2 of the program takes 1 dynamic offsets and was given 0";
        assert_eq!(said("computed", full, Some((set, &[])), nothing()), few);
        assert_eq!(said("shown", OBJECTS, None, Source::of(Some(set), &[&[]])), few);
        let odd = said("shown", full, Some((set, &[1])), nothing());
        assert!(odd.starts_with("the dynamic offset 1 of set 2 is no multiple of "), "{odd}");
        let of_source = Source { number: 1, ..Source::of(Some(set), &[&[0]]) };
        assert_eq!(said("both", OBJECTS, None, of_source), "set 1 is the draw source's: `bind_group` takes it");
        // A number that the program has told no set of is told, wherever it is bound.
        let far = Source { number: 9, ..Source::of(Some(set), &[&[0]]) };
        let mut executor = executor(device, &frame("shown", OBJECTS), SetLayouts::default()).expect("an executor");
        executor.bind_set(7, set, &[1, 2, 3]);
        executor.bind_set(SET, set, &[0]);
        let stray = executor.frame(&mut nothing()).expect_err("it is refused").to_string();
        assert!(stray.contains("set 7 is bound, and the program has told of none of that number"), "{stray}");
        executor.unbind_set(7);
        let stray = executor.frame(&mut { far }).expect_err("it is refused").to_string();
        assert!(stray.contains("set 9 is bound, and the program has told of none of that number"), "{stray}");
        executor.frame(&mut nothing()).expect("a frame");
        executor.unbind_set(SET);
        let gone = executor.frame(&mut nothing()).expect_err("it is refused").to_string();
        assert!(gone.ends_with(unbound), "{gone}");
    });
}

#[test]
fn sets_that_no_device_binds_are_refused_in_words() {
    on_each_driver(|device| {
        let said = |interfaces: DrawInterfaces| {
            let plan = planned(device, &frame("shown", Draw::FullScreen), &Options::default());
            let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces);
            let made = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default());
            made.err().expect("it is refused").to_string()
        };
        let taken = SuppliedResource::new(SET, 0, "taken", SuppliedKind::UniformBlock);
        let taken = DrawInterface { supplied: vec![taken], ..DrawInterface::default() };
        let twice = interfaces().with(DrawKind::Sky, taken);
        let what = "set 2 is the draw source's: it brings resources in it along for `Sky`";
        assert_eq!(said(twice), format!("pass `shown`: {what}"));
        let mut updated = set();
        updated.bindings[1].flags = BindingFlags { update_after_bind: true, ..BindingFlags::default() };
        let what = "binding 0 is a uniform block with a dynamic offset, which a set has not if some of it is updated \
                    after it was bound";
        assert_eq!(said(DrawInterfaces::default().with_set(updated)), format!("pass `shown`: {what}"));
        let mut many = set();
        many.bindings.push(ProgramBinding::new(9, DescriptorType::Sampler).with_count(u32::MAX));
        let many = said(DrawInterfaces::default().with_set(many));
        assert!(many.contains("4294967295 of them as `set 2 binding 9`"), "{many}");
    });
}

#[test]
fn buffers_and_views_of_the_programs_are_resources_of_groups() {
    let interface = DrawInterface {
        supplied: vec![
            SuppliedResource::new(1, 0, "Brought", SuppliedKind::UniformBlock),
            SuppliedResource::new(1, 1, "seen", SuppliedKind::SampledImage).with_count(2),
        ],
        ..DrawInterface::default()
    };
    let shader = "#version 460
        layout(set = 1, binding = 0) uniform Brought { uint brought; };
        layout(set = 1, binding = 1) uniform sampler2D seen[2];
        layout(location = 0) out uint color;
        void main() { color = brought + uint(round(textureLod(seen[1], vec2(0.75, 0.5), 0.0).r * 255.0)); }";
    let shaders: &[(&str, &str)] = &[SHADERS[0], SHADERS[1], ("seen.frag", shader)];
    let shaders: &'static [(&'static str, &'static str)] = shaders.to_vec().leak();
    on_each_driver(|device| {
        let program = Program::new(device, false);
        let (values, _, texture) = &program._kept;
        let (view, sampler) = texture.raw();
        // SAFETY: they live longer than the frames.
        let (buffer, odd, null, view, none) = unsafe {
            let layout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
            (
                ProgramBuffer::new(values.raw(), 2 * u64::from(STRIDE), 16),
                ProgramBuffer::new(values.raw(), 1, 16),
                ProgramBuffer::new(vk::Buffer::null(), 0, 16),
                ProgramView::new(view, layout, sampler),
                ProgramView::new(vk::ImageView::null(), layout, sampler),
            )
        };
        let group = |buffer, views: &[ProgramView]| {
            let resources = [(0, Resource::ProgramBuffer(buffer)), (1, Resource::ProgramViews(views))];
            device.bind_group(&interface, 1, &resources)
        };
        let plan = planned(device, &frame("seen", OBJECTS), &Options::default());
        let brought = interface.clone();
        let mut library = ShaderLibrary::new(Vec::new(), shaders, move |_| brought.clone());
        let mut executor = Executor::new(device, &plan, &mut library, &ExecutorOptions::default()).expect("one");
        let mut source =
            Source { group: Some(group(buffer, &[view, view]).expect("a group")), ..Source::of(None, &[]) };
        executor.frame(&mut source).expect("a frame");
        assert_eq!(texels(&mut executor, "shown", 0), [203; 4]);

        let said = |buffer, views: &[ProgramView]| {
            let said = group(buffer, views).err().expect("it is refused").to_string();
            said.strip_prefix("bind group for set 1: ").map(str::to_owned).unwrap_or(said)
        };
        assert!(said(odd, &[view; 2]).starts_with("`Brought`: the offset 1 is no multiple of "));
        assert_eq!(said(null, &[view; 2]), "`Brought`: the buffer is VK_NULL_HANDLE");
        // SAFETY: it isn't bound.
        let empty = said(unsafe { ProgramBuffer::new(values.raw(), 0, 0) }, &[view; 2]);
        assert!(empty.starts_with("`Brought`: 0 bytes of a buffer: "), "{empty}");
        assert_eq!(said(buffer, &[view]), "`seen` takes 2 views and was given 1");
        assert_eq!(said(buffer, &[view, none]), "a view or sampler of `seen` is VK_NULL_HANDLE");
        let swapped = [(0, Resource::ProgramViews(&[view])), (1, Resource::ProgramBuffer(buffer))];
        let swapped = device.bind_group(&interface, 1, &swapped).err().expect("it is refused").to_string();
        assert_eq!(swapped, "bind group for set 1: `Brought` is a uniform block, and something else was given");
    });
}
