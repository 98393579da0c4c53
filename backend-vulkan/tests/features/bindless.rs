//! The example of docs/bindless.md: all textures of an engine in one table, which it binds itself (DO-5).

use crate::frames::{Small, Uses, draw, on_each_driver, planned, texels};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, DrawList, Frame};
use framewright_graph::shader::{
    BindingFlags, DescriptorType, DrawInterfaces, ProgramBinding, ProgramSet, ShaderInterfaces, Variant,
};
use framewright_graph::vulkan::{Format, Stages, Subresources};
use framewright_vulkan::{
    Device, DrawSource, Error, Executor, ExecutorOptions, RawSet, Recorder, SamplerDescriptor, ShaderLibrary, Texture,
};

// docs/bindless.md begins
use framewright_vulkan::ash::vk;

/// The set of the table, and as many textures as it has room for.
const TABLE: u32 = 1;
const ROOM: u32 = 1024;

/// What Framewright knows of the table. `to_ron()` writes it to a file for `check --interface`.
fn interfaces() -> DrawInterfaces {
    let flags = BindingFlags {
        partially_bound: true,
        update_after_bind: true,
        update_unused_while_pending: true,
        ..BindingFlags::default()
    };
    let textures = ProgramBinding::new(0, DescriptorType::CombinedImageSampler)
        .with_count(ROOM)
        .with_stages(Stages::FRAGMENT_SHADER)
        .with_flags(flags);
    DrawInterfaces::default().with_set(ProgramSet::new(TABLE, [textures]))
}

/// All textures of the engine, in a set of its own.
struct Table<'d> {
    device: &'d Device,
    layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    textures: Vec<Texture>,
}

impl<'d> Table<'d> {
    fn new(device: &'d Device) -> Result<Table<'d>, vk::Result> {
        let raw = device.raw();
        let flags = [vk::DescriptorBindingFlags::PARTIALLY_BOUND
            | vk::DescriptorBindingFlags::UPDATE_AFTER_BIND
            | vk::DescriptorBindingFlags::UPDATE_UNUSED_WHILE_PENDING];
        let mut flags = vk::DescriptorSetLayoutBindingFlagsCreateInfo::default().binding_flags(&flags);
        let bindings = [vk::DescriptorSetLayoutBinding::default()
            .binding(0)
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .descriptor_count(ROOM)
            .stage_flags(vk::ShaderStageFlags::FRAGMENT)];
        let layout = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(vk::DescriptorSetLayoutCreateFlags::UPDATE_AFTER_BIND_POOL)
            .bindings(&bindings)
            .push_next(&mut flags);
        let sizes = [vk::DescriptorPoolSize { ty: vk::DescriptorType::COMBINED_IMAGE_SAMPLER, descriptor_count: ROOM }];
        let pool = vk::DescriptorPoolCreateInfo::default()
            .flags(vk::DescriptorPoolCreateFlags::UPDATE_AFTER_BIND)
            .max_sets(1)
            .pool_sizes(&sizes);
        // SAFETY: the device has the features, or the pipeline had been refused.
        unsafe {
            let layout = raw.create_descriptor_set_layout(&layout, None)?;
            let pool = raw.create_descriptor_pool(&pool, None)?;
            let layouts = [layout];
            let set = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            let set = raw.allocate_descriptor_sets(&set)?[0];
            Ok(Table { device, layout, pool, set, textures: Vec::new() })
        }
    }

    /// Adds a texture, and returns its number. Frames on their way don't read it, so it can be written at any time.
    fn add(&mut self, texture: Texture) -> u32 {
        let number = self.textures.len() as u32;
        let (view, sampler) = texture.raw();
        let image = [vk::DescriptorImageInfo::default()
            .image_view(view)
            .sampler(sampler)
            .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.set)
            .dst_array_element(number)
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .image_info(&image);
        // SAFETY: the set has room, nothing reads this element yet, and the table keeps the texture.
        unsafe { self.device.raw().update_descriptor_sets(&[write], &[]) };
        self.textures.push(texture);
        number
    }
}

impl Drop for Table<'_> {
    fn drop(&mut self) {
        // SAFETY: the frames were waited for.
        unsafe {
            self.device.raw().destroy_descriptor_pool(self.pool, None);
            self.device.raw().destroy_descriptor_set_layout(self.layout, None);
        }
    }
}

/// Draws an object with four materials beside each other; the first one's number is that of the instance.
struct Objects {
    first_material: u32,
}

impl DrawSource for Objects {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        recorder.draw(0..3, self.first_material..self.first_material + 1);
        Ok(1)
    }
}
// docs/bindless.md ends

const SHADERS: &[(&str, &str)] = &[
    (
        "material.vert",
        "#version 460
layout(location = 0) flat out uint first;
void main() {
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0);
    first = gl_InstanceIndex;
}",
    ),
    (
        "material.frag",
        "#version 460
#extension GL_EXT_nonuniform_qualifier : require
layout(location = 0) flat in uint first;
layout(set = 1, binding = 0) uniform sampler2D textures[];
layout(location = 0) out vec4 color;
void main() {
    uint material = first + uint(gl_FragCoord.x);
    color = textureLod(textures[nonuniformEXT(material)], vec2(0.5), 0.0);
}",
    ),
];

fn frame() -> Frame {
    let mut small = Small::default();
    let shown = small.image("shown", Format::R8G8B8A8_UNORM, [4, 1]);
    let pass = draw("material", Draw::Objects(DrawList::Opaque));
    small.pass(pass.draws(shown, Subresources::WHOLE, Some([0.0; 4])));
    small.image_output(shown);
    small.frame
}

/// The features that the shader and the table need.
const NEEDED: [&str; 6] = [
    "shaderSampledImageArrayDynamicIndexing",
    "shaderSampledImageArrayNonUniformIndexing",
    "runtimeDescriptorArray",
    "descriptorBindingSampledImageUpdateAfterBind",
    "descriptorBindingPartiallyBound",
    "descriptorBindingUpdateUnusedWhilePending",
];

#[test]
fn the_shader_and_its_table_need_features_by_name_and_line() {
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
    let draw = Draw::Objects(DrawList::Opaque);
    let interface = shaders.draw_shader("material", draw, &Variant::default()).expect("it compiles");
    let [table] = &interface.program[..] else { panic!("one table: {:?}", interface.program) };
    assert_eq!((table.set, table.binding, table.count), (1, 0, None));
    assert_eq!(table.place.as_deref(), Some("shipped:material.frag:4"));
    assert!(interface.bindings.is_empty());
}

#[test]
fn a_table_of_all_textures_is_drawn_and_grows_while_frames_are_on_their_way() {
    on_each_driver(|device| {
        let features = device.profile().features.expect("they are known");
        let lacking = NEEDED.iter().find(|needed| !features.iter().any(|it| it == *needed));
        let plan = planned(device, &frame(), &Options::default());
        let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
        let options = ExecutorOptions { frames_in_flight: 2, ..ExecutorOptions::default() };
        let executor = Executor::new(device, &plan, &mut shaders, &options);
        if lacking.is_some() {
            let said = executor.err().expect("it is refused").to_string();
            assert!(said.contains("needs the feature ") && said.contains("material.frag:"), "{said}");
            return;
        }
        let mut executor = executor.expect("an executor");
        let mut table = Table::new(device).expect("a table");
        let add = |table: &mut Table<'_>, red: u8| {
            let sampler = SamplerDescriptor::default();
            let texel = [red, 0, 0, 255];
            table.add(device.texture(1, 1, Format::R8G8B8A8_UNORM, &texel, &sampler, false).expect("a texture"))
        };
        let red = |executor: &mut Executor| texels(executor, "shown", 0).iter().map(|it| it & 0xff).collect::<Vec<_>>();
        for red in [10, 20, 30, 40] {
            add(&mut table, red);
        }
        // SAFETY: the set fits, and lives longer than the executor.
        executor.bind_set(TABLE, unsafe { RawSet::new(table.set) }, &[]);
        let first = executor.submit(&mut Objects { first_material: 0 }).expect("a frame");
        // The frame may be on its way.
        let fifth = add(&mut table, 50);
        executor.wait(first).expect("it ends");
        assert_eq!(red(&mut executor), [10, 20, 30, 40]);
        executor.frame(&mut Objects { first_material: fifth - 3 }).expect("a frame");
        assert_eq!(red(&mut executor), [20, 30, 40, 50]);
        drop(executor);
    });
}

#[test]
fn the_page_shows_this_example() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/bindless.md");
    let page = std::fs::read_to_string(page).expect("the page");
    let (begin, end) = ("// docs/bindless.md begins\n", "// docs/bindless.md ends\n");
    let own = include_str!("bindless.rs");
    let shown = own.split_once(begin).and_then(|(_, rest)| rest.split_once(end)).expect("the marks").0;
    assert!(page.contains(shown.trim()), "docs/bindless.md doesn't show the example as it is drawn");
    for (_, shader) in SHADERS {
        assert!(page.contains(shader), "docs/bindless.md doesn't show\n{shader}");
    }
    let file = interfaces().to_ron();
    assert!(page.contains(file.trim()), "docs/bindless.md doesn't show\n{file}");
}
