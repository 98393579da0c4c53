//! Shaders found, compiled and reflected. No device is needed.

#[cfg(unix)]
mod commands;
mod coverage;
mod exact;
mod files;
#[cfg(unix)]
mod hlsl;
mod modules;
mod refusals;
mod validity;

use framewright_graph::base::Root;
use framewright_graph::device::{Need, NeedKind};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::{
    Binding, BindingKind, DrawInterface, MatrixLayout, ShaderInterface, ShaderInterfaces, ShaderProblem, Variant,
};
use framewright_graph::vulkan::{Component, Dimension, Format, ImageShape, Stages};
use framewright_vulkan::ShaderLibrary;
use std::fs;
use std::path::Path;

const SHIPPED: &[(&str, &str)] = &[
    ("full_screen.vert", "#version 460\nvoid main() { gl_Position = vec4(0.0); }\n"),
    ("plain.frag", "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n"),
    ("light/half.glsl", "const float HALF = 0.5;\n"),
];

fn library(folder: &Path) -> ShaderLibrary {
    ShaderLibrary::new(vec![Root::new(folder.to_owned())], SHIPPED, |_| DrawInterface::default())
}

/// The interface of a full-screen shader with this fragment stage (a version line comes first).
fn full_screen(fragment: &str) -> Result<ShaderInterface, ShaderProblem> {
    drawn(Draw::FullScreen, &[("test.frag", &format!("#version 460\n{fragment}"))])
}

/// The interface of the shader `test` made of these files.
fn drawn(draw: Draw, files: &[(&str, &str)]) -> Result<ShaderInterface, ShaderProblem> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    library(folder.path()).draw_shader("test", draw, &Variant::default())
}

fn reflected(fragment: &str) -> ShaderInterface {
    full_screen(fragment).expect("it compiles")
}

/// The compiler's messages without the folder's path.
fn messages(files: &[(&str, &str)]) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    let shown = format!("{}/", folder.path().display());
    match library(folder.path()).draw_shader("test", Draw::FullScreen, &Variant::default()) {
        Err(ShaderProblem::DoesNotCompile { messages }) => {
            messages.iter().map(|message| message.text.replace(&shown, "")).collect()
        }
        other => panic!("{other:?}"),
    }
}

fn unsupported(files: &[(&str, &str)]) -> String {
    match drawn(Draw::FullScreen, files) {
        Err(ShaderProblem::Unsupported { what }) => what,
        other => panic!("{other:?}"),
    }
}

const WHITE: &str = "layout(location = 0) out vec4 color; void main() { color = vec4(1.0);";

#[test]
fn a_parameter_block_has_its_members_offsets_and_types() {
    let interface = reflected(
        "layout(set = 0, binding = 2) uniform Params { float white; bool on; ivec2 steps; mat4 turn; vec3 tint; uint n; }
            params;
        layout(location = 0) out vec4 color;
        void main() { color = params.turn * vec4(params.tint * params.white, params.on ? 1.0 : float(params.steps.x + params.n)); }",
    );
    let [binding] = &interface.bindings[..] else { panic!("{interface:?}") };
    assert_eq!((binding.set, binding.binding, binding.name.as_str()), (0, 2, "params"));
    assert_eq!(binding.stages, Stages::FRAGMENT_SHADER);
    let BindingKind::UniformBlock(block) = &binding.kind else { panic!("{binding:?}") };
    let members: Vec<_> = block.members.iter().map(|it| (it.name.as_str(), it.offset, it.ty.as_str())).collect();
    let expected = [
        ("white", 0, "float"),
        ("on", 4, "uint"),
        ("steps", 8, "ivec2"),
        ("turn", 16, "mat4"),
        ("tint", 80, "vec3"),
        ("n", 92, "uint"),
    ];
    assert_eq!((members, block.bytes), (expected.to_vec(), 96));
}

#[test]
fn images_have_their_dimension_samples_and_component() {
    let interface = reflected(
        "layout(set = 0, binding = 0) uniform sampler2D flat_one;
        layout(set = 0, binding = 1) uniform sampler2DMSArray samples;
        layout(set = 0, binding = 2) uniform usampler3D volume;
        layout(set = 0, binding = 3) uniform isamplerCube cube;
        layout(set = 0, binding = 4, r32f) uniform writeonly image2D stored;
        layout(set = 0, binding = 5) uniform samplerCubeShadow shadow;
        layout(location = 0) out vec4 color; void main() { color = vec4(1.0); }",
    );
    let shape =
        |dimension, arrayed, multisampled, component| ImageShape { dimension, arrayed, multisampled, component };
    let kinds: Vec<_> = interface.bindings.into_iter().map(|it| it.kind).collect();
    let expected = [
        BindingKind::SampledImage(shape(Dimension::D2, false, false, Component::Float)),
        BindingKind::SampledImage(shape(Dimension::D2, true, true, Component::Float)),
        BindingKind::SampledImage(shape(Dimension::D3, false, false, Component::Uint)),
        BindingKind::SampledImage(shape(Dimension::Cube, false, false, Component::Int)),
        BindingKind::StorageImage {
            shape: shape(Dimension::D2, false, false, Component::Float),
            format: Some(Format::R32_SFLOAT),
            readable: false,
            writable: true,
        },
        BindingKind::ComparedDepth(shape(Dimension::Cube, false, false, Component::Float)),
    ];
    assert_eq!(kinds, expected);
}

#[test]
fn matrices_in_blocks_say_how_they_lie() {
    let interface = reflected(
        "layout(set = 0, binding = 0) uniform Params { mat2 small; layout(row_major) mat2x4 rows; } params;
        layout(location = 0) out vec4 color; void main() { color = params.rows[0] + params.small[0].xyxy; }",
    );
    let BindingKind::UniformBlock(block) = &interface.bindings[0].kind else { panic!("{interface:?}") };
    let layout = |row_major| Some(MatrixLayout { stride: 16, row_major });
    let members: Vec<_> = block.members.iter().map(|it| (it.offset, it.ty.as_str(), it.matrix)).collect();
    assert_eq!(members, [(0, "mat2", layout(false)), (32, "mat2x4", layout(true))]);
    // Two columns of two; four rows of two.
    assert_eq!(block.bytes, 32 + 64);
}

#[test]
fn what_no_pass_can_give_is_told_by_its_line_and_with_what_to_declare_instead() {
    let folder = tempfile::tempdir().expect("a folder");
    let rest = "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n";
    fs::write(folder.path().join("more.glsl"), "\nlayout(set = 0, binding = 9) uniform samplerBuffer texels;\n")
        .expect("a file");
    let declared = "#version 460
        /* uniform sampler alone;
        */ layout(set = 0, binding = 5) uniform sampler alone[2];
        layout(set = 0, binding = 6) uniform Many { vec4 value; } many[2];
        layout(set = 0, binding = 7, rgb10_a2ui) uniform writeonly uimage2D packed_one;
        #include \"more.glsl\"\n";
    fs::write(folder.path().join("test.frag"), format!("{declared}{rest}")).expect("a file");
    let interface = library(folder.path()).draw_shader("test", Draw::FullScreen, &Variant::default());
    let shown = format!("{}/", folder.path().display());
    let told = |it: Binding| {
        let BindingKind::Other(other) = it.kind else { panic!("{it:?}") };
        assert!(!other.instead.is_empty(), "{other:?}");
        format!("{} {}", other.place.expect("a place").replace(&shown, ""), other.what)
    };
    let told: Vec<String> = interface.expect("it compiles").bindings.into_iter().map(told).collect();
    let expected = [
        "test.frag:3 an array of samplers",
        "test.frag:4 an array of blocks",
        "test.frag:5 a storage image of the format `Rgb10a2ui`, which no image of a pipeline has",
        "more.glsl:2 a texel buffer",
    ];
    assert_eq!(told, expected);
}

#[test]
fn what_vulkan_1_1_promises_to_compute_shaders_is_allowed_there() {
    let subgroups = "#extension GL_KHR_shader_subgroup_basic : enable
        layout(local_size_x = 8) in;
        layout(set = 0, binding = 0) buffer Words { uint word[]; };
        void main() { if (subgroupElect()) { word[gl_SubgroupID] = gl_SubgroupSize; } subgroupBarrier(); }";
    computed(subgroups).expect("subgroups in a compute shader");
    let ballot = subgroups
        .replace("_basic", "_ballot")
        .replace("subgroupElect()", "subgroupBallotBitCount(subgroupBallot(true)) > 1");
    let needs = |interface: ShaderInterface| -> Vec<String> {
        let name = |need: Need| match need.kind {
            NeedKind::Feature { name, .. } => format!("{} {name}", need.place.rsplit('/').next().unwrap_or_default()),
            other => panic!("{other:?}"),
        };
        interface.needs.into_iter().map(name).collect()
    };
    let ballot = computed(&ballot).expect("ballots, on devices that have them");
    assert_eq!(needs(ballot), ["test.comp:2 subgroupSupportedOperations.BALLOT"]);
    let elect = "#version 460\n#extension GL_KHR_shader_subgroup_basic : enable
        layout(location = 0) out vec4 color;
        void main() { color = vec4(subgroupElect() ? 1.0 : 0.0); }";
    let drawn = drawn(Draw::FullScreen, &[("test.frag", elect)]).expect("subgroups, on devices that have them");
    assert_eq!(needs(drawn), ["test.frag:2 subgroupSupportedStages.FRAGMENT"]);
}

#[test]
fn a_storage_image_may_have_any_format_that_a_device_lists_for_it() {
    for (layout, expected) in [
        ("r8", Format::R8_UNORM),
        ("rg8", Format::R8G8_UNORM),
        ("r16f", Format::R16_SFLOAT),
        ("rg16f", Format::R16G16_SFLOAT),
        ("rgba16", Format::R16G16B16A16_UNORM),
        ("r11f_g11f_b10f", Format::B10G11R11_UFLOAT_PACK32),
        ("rgb10_a2", Format::A2B10G10R10_UNORM_PACK32),
    ] {
        let interface = computed(&format!(
            "layout(local_size_x = 8) in;
            layout(set = 0, binding = 0, {layout}) uniform writeonly image2D target;
            void main() {{ imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4(1.0)); }}"
        ));
        let interface = interface.unwrap_or_else(|problem| panic!("{layout}: {problem:?}"));
        let BindingKind::StorageImage { format, .. } = &interface.bindings[0].kind else { panic!("{interface:?}") };
        assert_eq!(*format, Some(expected), "{layout}");
    }
}

#[test]
fn in_sets_from_one_on_only_what_is_used_counts() {
    let declared = "layout(set = 1, binding = 0) uniform View { mat4 m; } view;
        layout(set = 1, binding = 1) readonly buffer Lights { vec4 light[]; };
        layout(set = 1, binding = 2) buffer Counter { uint count; } counter;
        layout(location = 0) out vec4 color;";
    let names = |body: &str| {
        let bindings = reflected(&format!("{declared} void main() {{ {body} }}")).bindings;
        bindings.into_iter().map(|it| (it.name, it.kind)).collect::<Vec<_>>()
    };
    assert_eq!(names("color = vec4(1.0);"), []);
    let read_only = BindingKind::StorageBlock { readable: true, writable: false, bytes: 0 };
    assert_eq!(names("color = light[0];"), [("Lights".to_owned(), read_only)]);
    let writable = BindingKind::StorageBlock { readable: true, writable: true, bytes: 4 };
    assert_eq!(names("color = vec4(float(counter.count));"), [("counter".to_owned(), writable)]);
}

#[test]
fn what_a_fragment_stage_does_is_seen() {
    let plain = reflected(&format!("{WHITE} }}"));
    let flags =
        |it: &ShaderInterface| [it.discards, it.uses_frag_coord, it.uses_derivatives, it.per_sample, it.writes_depth];
    assert_eq!(flags(&plain), [false; 5]);
    let seen = |body: &str| flags(&reflected(&format!("{WHITE} {body} }}")));
    assert_eq!(seen("if (color.x > 2.0) discard;"), [true, false, false, false, false]);
    assert_eq!(seen("color *= gl_FragCoord.x;"), [false, true, false, false, false]);
    assert_eq!(seen("color *= dFdx(color.x);"), [false, false, true, false, false]);
    assert_eq!(seen("color *= float(gl_SampleID);"), [false, false, false, true, false]);
    assert_eq!(seen("color *= gl_SamplePosition.x;"), [false, false, false, true, false]);
    assert_eq!(seen("gl_FragDepth = 0.5;"), [false, false, false, false, true]);
    let sampled = reflected(
        "layout(set = 0, binding = 0) uniform sampler2D source; layout(location = 0) out vec4 color;
        void main() { color = texture(source, vec2(0.5)); }",
    );
    assert!(sampled.uses_derivatives, "the mip level is chosen by derivatives");
    let fetched = reflected(
        "layout(set = 0, binding = 0) uniform sampler2D source; layout(location = 0) out vec4 color;
        void main() { color = texelFetch(source, ivec2(0), 0); }",
    );
    assert!(!fetched.uses_derivatives);
}

#[test]
fn a_discard_counts_only_where_it_can_be_reached() {
    let called = reflected(
        "layout(location = 0) out vec4 color;
        void away() { discard; } void through() { away(); }
        void main() { color = vec4(1.0); through(); }",
    );
    assert!(called.discards);
    let uncalled = reflected(
        "layout(location = 0) out vec4 color;
        void away() { discard; } void through() { away(); }
        void main() { color = vec4(1.0); }",
    );
    assert!(!uncalled.discards);
}

#[test]
fn a_sample_input_runs_once_a_sample() {
    let vertex = "#version 460
        layout(location = 1) out vec2 uv;
        void main() { uv = vec2(0.0); gl_Position = vec4(0.0); }";
    let fragment = |qualifier: &str| {
        format!(
            "#version 460
            layout(location = 1) {qualifier} in vec2 uv;
            layout(location = 0) out vec4 color;
            void main() {{ color = vec4(uv, 0.0, 1.0); }}"
        )
    };
    let per_sample = |qualifier: &str| {
        let files = [("test.vert", vertex), ("test.frag", &fragment(qualifier))];
        drawn(Draw::FullScreen, &files).expect("it compiles").per_sample
    };
    assert_eq!([per_sample(""), per_sample("sample")], [false, true]);
}

#[test]
fn vertex_inputs_and_color_outputs_are_listed_by_location() {
    let vertex = "#version 460
        layout(location = 3) in vec2 uv;
        layout(location = 1) in vec3 position;
        layout(location = 7) in vec3 unused;
        void main() { gl_Position = vec4(position, uv.x); }";
    let fragment = "#version 460
        layout(location = 2) out uvec2 id;
        layout(location = 0) out vec4 color[2];
        void main() { color[0] = color[1] = vec4(1.0); id = uvec2(1); }";
    let draw = Draw::Objects(DrawList::Opaque);
    let interface = drawn(draw, &[("test.vert", vertex), ("test.frag", fragment)]).expect("it compiles");
    let inputs: Vec<_> =
        interface.vertex_inputs.iter().map(|it| (it.location, it.name.as_str(), it.ty.as_str())).collect();
    assert_eq!(inputs, [(1, "position", "vec3"), (3, "uv", "vec2"), (7, "unused", "vec3")]);
    assert_eq!(interface.vertex_inputs.iter().map(|it| it.used).collect::<Vec<_>>(), [true, true, false]);
    let outputs: Vec<_> =
        interface.outputs.iter().map(|it| (it.location, it.name.as_str(), it.component, it.components)).collect();
    let expected =
        [(0, "color", Component::Float, 4), (1, "color", Component::Float, 4), (2, "id", Component::Uint, 2)];
    assert_eq!(outputs, expected);
}

#[test]
fn bindings_of_both_stages_are_joined() {
    let block = "layout(set = 0, binding = 0) uniform Params { float size; } params;";
    let vertex = format!("#version 460\n{block} void main() {{ gl_Position = vec4(params.size); }}");
    let fragment = format!("#version 460\n{block} {WHITE} color *= params.size; }}");
    let interface = drawn(Draw::FullScreen, &[("test.vert", &vertex), ("test.frag", &fragment)]).expect("it compiles");
    let stages: Vec<_> = interface.bindings.iter().map(|it| it.stages).collect();
    assert_eq!(stages, [Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER]);
}

#[test]
fn stages_that_do_not_fit_together_are_refused() {
    let vertex =
        "#version 460\nlayout(location = 1) out vec2 uv;\nvoid main() { uv = vec2(0.0); gl_Position = vec4(0.0); }";
    let fragment =
        |location, ty| format!("#version 460\nlayout(location = {location}) in {ty} uv; {WHITE} color.x = uv.x; }}");
    let what = |fragment: &str| {
        let what = unsupported(&[("test.vert", vertex), ("test.frag", fragment)]);
        what.split_whitespace().map(|word| word.rsplit('/').next().unwrap_or(word)).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(
        what(&fragment(2, "vec2")),
        "test.frag:2: it reads `vec2 uv` at location 2, where test.vert hands over nothing"
    );
    assert_eq!(
        what(&fragment(1, "vec3")),
        "test.frag:2: it reads `vec3 uv` at location 1, where test.vert hands over `vec2 uv`"
    );
}

/// The interface of a compute shader with this text (a version line comes first).
fn computed(text: &str) -> Result<ShaderInterface, ShaderProblem> {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("test.comp"), format!("#version 460\n{text}")).expect("a file");
    library(folder.path()).compute_shader("test", &Variant::default())
}

#[test]
fn a_compute_shader_has_a_workgroup_size_its_resources_and_nothing_of_a_draw() {
    let interface = computed(
        "layout(local_size_x = 8, local_size_y = 4) in;
        layout(set = 0, binding = 0) uniform Params { uint factor; } params;
        layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D target;
        layout(set = 0, binding = 2) readonly buffer Words { uint word[]; };
        shared uint sums[32];
        void main() {
            sums[gl_LocalInvocationIndex] = word[gl_LocalInvocationIndex] * params.factor;
            barrier();
            imageStore(target, ivec2(gl_GlobalInvocationID.xy), uvec4(sums[31 - gl_LocalInvocationIndex]));
        }",
    )
    .expect("it compiles");
    assert_eq!(interface.workgroup_size, Some([8, 4, 1]));
    let bound: Vec<_> = interface.bindings.iter().map(|it| (it.binding, it.name.as_str(), it.stages)).collect();
    let stage = Stages::COMPUTE_SHADER;
    assert_eq!(bound, [(0, "params", stage), (1, "target", stage), (2, "Words", stage)]);
    let BindingKind::StorageImage { format, readable, writable, .. } = &interface.bindings[1].kind else {
        panic!("{interface:?}")
    };
    assert_eq!((*format, *readable, *writable), (Some(Format::R32_UINT), false, true));
    assert_eq!(interface.bindings[2].kind, BindingKind::StorageBlock { readable: true, writable: false, bytes: 0 });
    assert_eq!((interface.outputs.len(), interface.vertex_inputs.len(), interface.discards), (0, 0, false));
}

#[test]
fn a_compute_shader_that_says_no_workgroup_size_is_refused_at_its_place() {
    let Err(ShaderProblem::Unsupported { what }) = computed("// local_size_x = 8\n\nvoid main() {}") else {
        panic!("it isn't refused")
    };
    assert!(
        what.contains("test.comp:4: it doesn't say how large its workgroups are; write `layout(local_size_x"),
        "{what}"
    );
    let one = computed("layout(local_size_x = 1) in; void main() {}").expect("a size of one may be said");
    assert_eq!(one.workgroup_size, Some([1; 3]));
}
