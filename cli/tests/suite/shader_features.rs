//! What shaders use follows the device: numbers of all widths, subgroups, images without a format. `check` takes it where the profile has
//! the feature, and refuses it elsewhere at its line; what is drawn is right (DO-4).

use crate::testing::{Place, Vulkan};
use framewright_graph::device::{Profile, SHIPPED_PROFILES};

/// A pipeline with an image of one colour, a buffer of one word, and a pass that draws or stores `o`.
fn pipeline(pass: &str) -> String {
    format!(
        r#"Pipeline(version: 1,
    images: [
        (name: "a", format: R8G8B8A8_UNORM, size: Output),
        (name: "o", format: R8G8B8A8_UNORM, size: Output),
    ],
    buffers: [(name: "d", bytes: 64)],
    passes: [
        (name: "color", fill: (to: "a", value: (0.2, 0.4, 0.6, 1.0))),
        (name: "word", fill: (to: "d", value: 0x04030201)),
        {pass},
    ],
    outputs: [(image: "o", encoding: Unorm)],
)"#
    )
}

/// The colour of `o` where the shader is right.
const RIGHT: [u8; 3] = [51, 102, 153];

const COMPUTED: &str = r#"(name: "k", dispatch: "k", groups: Texels("o"), storage: {"o": "o"})"#;
const OF_BUFFER: &str = r#"(name: "k", dispatch: "k", groups: Texels("o"), storage: {"o": "o", "d": "d"})"#;
const OF_UNIFORM: &str = r#"(name: "k", dispatch: "k", groups: Texels("o"), storage: {"o": "o"}, uniform: {"d": "d"})"#;
const OF_IMAGE: &str = r#"(name: "k", dispatch: "k", groups: Texels("o"), storage: {"o": "o", "a": "a"})"#;
const SAMPLED: &str = r#"(name: "k", dispatch: "k", groups: Texels("o"), storage: {"o": "o"}, sample: {"a": "a"})"#;
const FULL_SCREEN: &str = r#"(name: "k", draw: FullScreen("k"), color: ["o"])"#;
const TRIANGLE: &str =
    r#"(name: "k", draw: Vertices(3), shader: "k", color: [(image: "o", clear: (0.0, 0.0, 0.0, 0.0))])"#;

const TRIANGLES: &str =
    r#"(name: "k", draw: Vertices(6), shader: "k", color: [(image: "o", clear: (0.0, 0.0, 0.0, 0.0))])"#;

/// A compute shader that stores the right colour where `right` is true of the invocation `id`. What needs the feature stands on line 2 or
/// later.
fn computed(extensions: &str, declared: &str, right: &str) -> (&'static str, String) {
    let target = "layout(set = 0, binding = 0, rgba8) uniform writeonly image2D o;";
    (
        "k.comp",
        format!(
            "#version 460\n{extensions}\nlayout(local_size_x = 8, local_size_y = 4) in;\n{target}\n{declared}\n\
        void main() {{\n    const uint id = gl_GlobalInvocationID.x + 8u * gl_GlobalInvocationID.y;\n    {right}\n    \
        imageStore(o, ivec2(gl_GlobalInvocationID.xy), right ? vec4(0.2, 0.4, 0.6, 1.0) : vec4(0.0));\n}}\n"
        ),
    )
}

/// The features that a shader needs, the pass, and the shader's stages.
struct Case {
    needs: &'static [&'static str],
    pass: &'static str,
    stages: Vec<(&'static str, String)>,
}

fn numbers() -> Vec<Case> {
    let types = |of: &str| format!("#extension GL_EXT_shader_explicit_arithmetic_types_{of} : require");
    let case = |needs, pass, stage| Case { needs, pass, stages: vec![stage] };
    let of_16 = "#extension GL_EXT_shader_16bit_storage : require";
    let of_8 = "#extension GL_EXT_shader_8bit_storage : require";
    vec![
        case(
            &["shaderFloat64"],
            COMPUTED,
            computed(
                "",
                "",
                "double step = double(id + 1u) * 9.094947017729282e-13LF; bool right = (1.0LF + step) - 1.0LF == step;",
            ),
        ),
        case(
            &["shaderInt64"],
            COMPUTED,
            computed(
                &types("int64"),
                "",
                "uint64_t far = uint64_t(id + 1u) << 40; bool right = uint(far >> 40) == id + 1u && uint(far) == 0u;",
            ),
        ),
        case(
            &["shaderInt16"],
            COMPUTED,
            computed(
                &types("int16"),
                "",
                "uint16_t round = uint16_t(65535u) + uint16_t(id); bool right = uint(round) == ((id + 65535u) & 65535u);",
            ),
        ),
        case(
            &["shaderFloat16"],
            COMPUTED,
            computed(
                &types("float16"),
                "",
                "float16_t sum = float16_t(2048.0 + 2.0 * float(id)) + float16_t(0.5); bool right = float(sum) == 2048.0 + 2.0 * float(id);",
            ),
        ),
        case(
            &["shaderInt8"],
            COMPUTED,
            computed(
                &types("int8"),
                "",
                "uint8_t round = uint8_t(255u) + uint8_t(id); bool right = uint(round) == ((id + 255u) & 255u);",
            ),
        ),
        case(
            &["storageBuffer16BitAccess"],
            OF_BUFFER,
            computed(
                of_16,
                "layout(set = 0, binding = 1) readonly buffer D { uint16_t v[]; } d;",
                "bool right = uint(d.v[id & 31u]) == ((id & 1u) == 0u ? 0x0201u : 0x0403u);",
            ),
        ),
        case(
            &["uniformAndStorageBuffer16BitAccess"],
            OF_UNIFORM,
            computed(
                of_16,
                "layout(set = 0, binding = 1) uniform D { uint16_t v; uint16_t w; } d;",
                "bool right = uint(d.v) == 0x0201u && uint(d.w) == 0x0403u;",
            ),
        ),
        case(
            &["storageBuffer8BitAccess"],
            OF_BUFFER,
            computed(
                of_8,
                "layout(set = 0, binding = 1) readonly buffer D { uint8_t v[]; } d;",
                "bool right = uint(d.v[id & 63u]) == (id & 3u) + 1u;",
            ),
        ),
        case(
            &["uniformAndStorageBuffer8BitAccess"],
            OF_UNIFORM,
            computed(
                of_8,
                "layout(set = 0, binding = 1) uniform D { uint8_t v; uint8_t w; } d;",
                "bool right = uint(d.v) == 1u && uint(d.w) == 2u;",
            ),
        ),
        case(
            &["shaderBufferInt64Atomics", "shaderInt64"],
            OF_BUFFER,
            computed(
                &format!("{}\n#extension GL_EXT_shader_atomic_int64 : require", types("int64")),
                "layout(set = 0, binding = 1) buffer D { uint64_t v[8]; } d;",
                "bool right = uint(atomicMax(d.v[id & 7u], uint64_t(0))) == 0x04030201u;",
            ),
        ),
    ]
}

fn subgroups() -> Vec<Case> {
    let extension = |of: &str| format!("#extension GL_KHR_shader_subgroup_{of} : require");
    let case = |needs, of, right| Case { needs, pass: COMPUTED, stages: vec![computed(&extension(of), "", right)] };
    let fragment = format!(
        "#version 460\n{}\nlayout(location = 0) out vec4 color;\n\
         void main() {{ color = subgroupElect() || true ? vec4(0.2, 0.4, 0.6, 1.0) : vec4(0.0); }}\n",
        extension("basic")
    );
    let vertex = format!(
        "#version 460\n{}\nvoid main() {{\n    const vec2 at = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;\n    \
         gl_Position = vec4(at, subgroupElect() ? 0.5 : 0.25, 1.0);\n}}\n",
        extension("basic")
    );
    let plain =
        "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(0.2, 0.4, 0.6, 1.0); }\n";
    vec![
        case(
            &["subgroupSupportedOperations.VOTE"],
            "vote",
            "bool right = subgroupAny(id < 1000u) && !subgroupAll(id > 1000u);",
        ),
        case(
            &["subgroupSupportedOperations.ARITHMETIC"],
            "arithmetic",
            "uint all = subgroupAdd(1u); uint before = subgroupExclusiveAdd(1u); bool right = subgroupMax(before) == all - 1u && before < all;",
        ),
        case(
            &["subgroupSupportedOperations.BALLOT"],
            "ballot",
            "uvec4 odd = subgroupBallot((id & 1u) == 1u); bool right = subgroupInverseBallot(odd) == ((id & 1u) == 1u) && subgroupBroadcastFirst(7u) == 7u;",
        ),
        case(
            &["subgroupSupportedOperations.SHUFFLE"],
            "shuffle",
            "bool right = subgroupShuffleXor(gl_SubgroupInvocationID, 1u) == (gl_SubgroupInvocationID ^ 1u);",
        ),
        case(
            &["subgroupSupportedOperations.SHUFFLE_RELATIVE"],
            "shuffle_relative",
            "uint before = subgroupShuffleUp(gl_SubgroupInvocationID, 1u); bool right = gl_SubgroupInvocationID == 0u || before == gl_SubgroupInvocationID - 1u;",
        ),
        case(
            &["subgroupSupportedOperations.CLUSTERED"],
            "clustered",
            "bool right = subgroupClusteredAdd(gl_SubgroupInvocationID & 1u, 2u) == 1u;",
        ),
        case(
            &["subgroupSupportedOperations.QUAD"],
            "quad",
            "bool right = subgroupQuadSwapHorizontal(gl_SubgroupInvocationID) == (gl_SubgroupInvocationID ^ 1u);",
        ),
        Case { needs: &["subgroupSupportedStages.FRAGMENT"], pass: FULL_SCREEN, stages: vec![("k.frag", fragment)] },
        Case {
            needs: &["subgroupSupportedStages.VERTEX"],
            pass: TRIANGLE,
            stages: vec![("k.vert", vertex), ("k.frag", plain.to_owned())],
        },
    ]
}

fn images_and_draws() -> Vec<Case> {
    let formatless = "#version 460\n#extension GL_EXT_shader_image_load_formatted : require\n\
        layout(local_size_x = 8, local_size_y = 4) in;\n";
    let at = "ivec2(gl_GlobalInvocationID.xy)";
    let writes = format!(
        "{formatless}layout(set = 0, binding = 0) uniform writeonly image2D o;\n\
         void main() {{ imageStore(o, {at}, vec4(0.2, 0.4, 0.6, 1.0)); }}\n"
    );
    let reads = format!(
        "{formatless}layout(set = 0, binding = 0, rgba8) uniform writeonly image2D o;\n\
         layout(set = 0, binding = 1) uniform readonly image2D a;\nvoid main() {{ imageStore(o, {at}, imageLoad(a, {at})); }}\n"
    );
    let gathers = computed(
        "",
        "layout(set = 0, binding = 1) uniform sampler2D a;",
        "vec4 four = textureGatherOffset(a, vec2(0.5), ivec2(id & 1u, 0), 1); bool right = all(lessThan(abs(four - 0.4), vec4(0.01)));",
    );
    let primitive = "#version 460\nlayout(location = 0) out vec4 color;\n\
        void main() { color = gl_PrimitiveID == 0 ? vec4(0.2, 0.4, 0.6, 1.0) : vec4(0.0); }\n";
    let vertex = "#version 460\nvoid main() {\n    const vec2 at = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;\n    \
        gl_Position = vec4(at, float(gl_BaseVertex + gl_BaseInstance + gl_DrawID) + 0.5, 1.0);\n}\n";
    let plain =
        "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(0.2, 0.4, 0.6, 1.0); }\n";
    // The second triangle, of another colour, is drawn over the first, and left out.
    let distances = |name: &str| {
        format!(
            "#version 460\nlayout(location = 0) out flat float drawn;\nvoid main() {{\n    const int corner = gl_VertexIndex % 3;\n    \
             drawn = gl_VertexIndex < 3 ? 1.0 : 0.0;\n    {name}[0] = drawn - 0.5;\n    {name}[1] = 1.0;\n    \
             gl_Position = vec4(vec2(corner & 1, corner >> 1) * 4.0 - 1.0, 0.5, 1.0);\n}}\n"
        )
    };
    let of_vertex = "#version 460\nlayout(location = 0) in flat float drawn;\nlayout(location = 0) out vec4 color;\n\
        void main() { color = vec4(0.2, 0.4, 0.6, 1.0) * drawn; }\n";
    let barycentric = "#version 460\n#extension GL_EXT_fragment_shader_barycentric : require\nlayout(location = 0) out vec4 color;\n\
        void main() { color = abs(gl_BaryCoordEXT.x + gl_BaryCoordEXT.y + gl_BaryCoordEXT.z - 1.0) < 0.01 && \
        gl_BaryCoordEXT.x != gl_BaryCoordEXT.y ? vec4(0.2, 0.4, 0.6, 1.0) : vec4(0.0); }\n";
    let model = computed(
        "#pragma use_vulkan_memory_model\n#extension GL_KHR_memory_scope_semantics : require",
        "",
        "bool right = true;",
    );
    vec![
        Case { needs: &["shaderStorageImageWriteWithoutFormat"], pass: COMPUTED, stages: vec![("k.comp", writes)] },
        Case { needs: &["shaderStorageImageReadWithoutFormat"], pass: OF_IMAGE, stages: vec![("k.comp", reads)] },
        Case { needs: &["shaderImageGatherExtended"], pass: SAMPLED, stages: vec![gathers] },
        Case { needs: &["geometryShader"], pass: FULL_SCREEN, stages: vec![("k.frag", primitive.to_owned())] },
        Case {
            needs: &["shaderDrawParameters"],
            pass: TRIANGLE,
            stages: vec![("k.vert", vertex.to_owned()), ("k.frag", plain.to_owned())],
        },
        Case {
            needs: &["shaderClipDistance"],
            pass: TRIANGLES,
            stages: vec![("k.vert", distances("gl_ClipDistance")), ("k.frag", of_vertex.to_owned())],
        },
        Case {
            needs: &["shaderCullDistance"],
            pass: TRIANGLES,
            stages: vec![("k.vert", distances("gl_CullDistance")), ("k.frag", of_vertex.to_owned())],
        },
        Case {
            needs: &["fragmentShaderBarycentric"],
            pass: FULL_SCREEN,
            stages: vec![("k.frag", barycentric.to_owned())],
        },
        Case { needs: &["vulkanMemoryModel"], pass: COMPUTED, stages: vec![model] },
    ]
}

/// Every shipped profile takes each shader or names the feature that it lacks, at a line; drivers draw the right colour.
fn hold(cases: Vec<Case>) {
    for Case { needs, pass, stages } in cases {
        let place = Place::new();
        place.file("p.ron", pipeline(pass));
        for (file, text) in &stages {
            place.file(file, text);
        }
        for (name, text) in SHIPPED_PROFILES {
            let profile = Profile::from_ron(text).expect("a shipped profile");
            let check = ["check", "p.ron", "--device", name];
            let lacks: Vec<_> = needs.iter().filter(|feature| !profile.has_feature(feature)).collect();
            let said = place.run(&check).exits(i32::from(!lacks.is_empty())).err;
            let told = |feature: &&&str| said.contains(&format!("needs the feature {feature}, which"));
            assert!(lacks.iter().all(told), "{needs:?} on {name}: {said}");
            assert_eq!(said.matches(&format!("{}:", stages[0].0)).count(), lacks.len(), "{needs:?} on {name}: {said}");
        }
        // A profile that has all but one of them refuses it.
        for feature in needs {
            let mut profile = Profile::from_ron(SHIPPED_PROFILES[0].1).expect("a shipped profile");
            if *feature == "shaderClipDistance" {
                profile.max_clip_distances = Some(0);
            }
            profile.features = Some(needs.iter().filter(|it| it != &feature).map(|it| (*it).to_owned()).collect());
            place.file("mine.ron", profile.to_ron().expect("written"));
            place
                .run(&["check", "p.ron", "--device", "mine.ron"])
                .exits(1)
                .mentions(&format!("the feature {feature}, which"));
        }
        for (vulkan, shipped) in [(Vulkan::LAVAPIPE_CURRENT, "lavapipe"), (Vulkan::SWIFTSHADER_CURRENT, "swiftshader")]
        {
            let (_, text) = SHIPPED_PROFILES.iter().find(|(name, _)| *name == shipped).expect("shipped");
            let profile = Profile::from_ron(text).expect("a shipped profile");
            let Some(variables) = vulkan.variables().filter(|_| needs.iter().all(|it| profile.has_feature(it))) else {
                continue;
            };
            let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "16x8", "--validate", "-o", "o.png"];
            place.run_with(&variables, &run).exits(0);
            let picture = image::open(place.path("o.png")).expect("a picture").into_rgb8();
            assert!(
                picture.pixels().all(|texel| texel.0 == RIGHT),
                "{needs:?} on {shipped}: {:?}",
                picture.get_pixel(3, 3)
            );
        }
    }
}

#[test]
fn numbers_of_all_widths_follow_the_device() {
    hold(numbers());
}

#[test]
fn operations_of_subgroups_follow_the_device() {
    hold(subgroups());
}

#[test]
fn images_without_a_format_and_numbers_of_draws_follow_the_device() {
    hold(images_and_draws());
}
