//! What a device must have for a shader is told by `check`, with the shader's line, and not by the device's refusal later: features,
//! limits, and whether it is valid SPIR-V at all.

use crate::testing::{Outcome, Place, Vulkan};
use framewright_graph::device::{Limits, Profile, SHIPPED_PROFILES};

/// A pipeline with one compute shader that stores into `o`.
const STORES: &str = r#"Pipeline(version: 1,
    images: [(name: "o", format: R8G8B8A8_UNORM, size: Output)],
    passes: [(name: "k", dispatch: "k", groups: Texels("o"), storage: {"o": "o"})],
    outputs: [(image: "o", encoding: Unorm)],
)"#;

/// A compute shader that stores into `o`: its extensions, its declarations, its entry point, and the value.
fn stores(extensions: &str, size: &str, declared: &str, main: &str) -> String {
    format!(
        "#version 460\n{extensions}\nlayout({size}) in;\nlayout(set = 0, binding = 0, rgba8) uniform writeonly image2D o;\n{declared}\n{main}\n"
    )
}

const SMALL: &str = "local_size_x = 8, local_size_y = 8";
const MAIN: &str = "void main() { imageStore(o, ivec2(gl_GlobalInvocationID.xy), vec4(1.0)); }";

/// A place with a pipeline and its compute shader.
fn place(pipeline: &str, shader: &str) -> Place {
    let place = Place::new();
    place.file("p.ron", pipeline);
    place.file("k.comp", shader);
    place
}

fn check(place: &Place, device: &str) -> Outcome {
    place.run(&["check", "p.ron", "--device", device])
}

/// A profile of lavapipe's, changed, as a file.
fn device(place: &Place, change: impl FnOnce(&mut Profile)) {
    let mut profile = Profile::from_ron(SHIPPED_PROFILES[0].1).expect("a shipped profile");
    "mine".clone_into(&mut profile.name);
    change(&mut profile);
    place.file("mine.ron", profile.to_ron().expect("written"));
}

/// Draws with validation on lavapipe: nothing is found.
fn draws(place: &Place) {
    if let Some(variables) = Vulkan::LAVAPIPE.variables() {
        let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "16x16", "--validate"];
        place.run_with(&variables, &run).exits(0);
    }
}

#[test]
fn features_that_no_capability_tells_of_are_switched_on_or_refused_at_their_line() {
    let scalar = "#extension GL_EXT_scalar_block_layout : require";
    let cases = [
        (
            "scalarBlockLayout",
            stores(
                scalar,
                SMALL,
                "layout(set = 0, binding = 1, scalar) readonly buffer D { vec3 v[]; } d;",
                "void main() {
    imageStore(o, ivec2(gl_GlobalInvocationID.xy), vec4(d.v[gl_GlobalInvocationID.x & 3u], 1.0)); }",
            ),
            true,
        ),
        (
            "uniformBufferStandardLayout",
            stores(
                scalar,
                SMALL,
                "layout(set = 0, binding = 1, std430) uniform D { float v[16]; } d;",
                "void main() {
    imageStore(o, ivec2(gl_GlobalInvocationID.xy), vec4(d.v[gl_GlobalInvocationID.x & 3u])); }",
            ),
            true,
        ),
        (
            "shaderZeroInitializeWorkgroupMemory",
            stores(
                "#extension GL_EXT_null_initializer : require",
                SMALL,
                "shared uint bins[64] = {};",
                "void main() {
    atomicAdd(bins[gl_LocalInvocationIndex], 1u);
    barrier();
    imageStore(o, ivec2(gl_GlobalInvocationID.xy), vec4(float(bins[gl_LocalInvocationIndex]))); }",
            ),
            false,
        ),
    ];
    for (feature, shader, buffer) in cases {
        let pipeline = if buffer {
            let field = if feature == "scalarBlockLayout" { "storage" } else { "uniform" };
            let bound = if field == "storage" {
                r#"storage: {"o": "o", "d": "d"}"#
            } else {
                r#"storage: {"o": "o"}, uniform: {"d": "d"}"#
            };
            STORES
                .replace("    passes: [", "    buffers: [(name: \"d\", bytes: 64)],\n    passes: [(name: \"z\", fill: (to: \"d\", value: 0)), ")
                .replace(r#"storage: {"o": "o"}"#, bound)
        } else {
            STORES.to_owned()
        };
        let place = place(&pipeline, &shader);
        check(&place, "all").exits(0);
        draws(&place);
        device(&place, |profile| profile.features.as_mut().expect("known").retain(|it| it != feature));
        let said = format!("k.comp:5: it needs the feature {feature}, which `mine` doesn't have");
        check(&place, "mine.ron")
            .exits(1)
            .mentions("error: the shader of `k` can't be used on `mine`: ")
            .mentions(&said);
        // Where nothing is known of a device's features none is missed.
        device(&place, |profile| profile.features = None);
        check(&place, "mine.ron").exits(0);
    }
}

#[test]
fn elements_of_arrays_and_arrays_of_cubes_need_their_features_on_the_device_that_is_asked_about() {
    let pipeline = r#"Pipeline(version: 1,
    images: [(name: "a", format: R8G8B8A8_UNORM, size: Output), (name: "screen", format: Output, size: Output)],
    passes: [
        (name: "z", fill: (to: "a", value: (0.0, 0.0, 0.0, 0.0))),
        (name: "k", draw: FullScreen("k"), sample: {"maps": ["a", "a"]}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#;
    let place = Place::new();
    place.file("p.ron", pipeline);
    place.file(
        "k.frag",
        "#version 460\nlayout(set = 0, binding = 0) uniform sampler2D maps[2];\nlayout(location = 0) out vec4 color;\n\
         void main() { color = texture(maps[int(gl_FragCoord.x) & 1], vec2(0.5)); }\n",
    );
    check(&place, "swiftshader").exits(0);
    let said = "k.frag:2: the fragment stage needs the feature shaderSampledImageArrayDynamicIndexing, which `lavapipe";
    check(&place, "lavapipe").exits(1).mentions(said);
}

#[test]
fn parameters_may_lie_in_scalar_layout_where_the_device_can() {
    let shader = stores(
        "#extension GL_EXT_scalar_block_layout : require",
        SMALL,
        "layout(set = 0, binding = 1, scalar) uniform Params { vec2 b; vec3 a; vec3 c; float d; } params;",
        "void main() { imageStore(o, ivec2(gl_GlobalInvocationID.xy), vec4(params.b.y, params.a.z, params.c.x, params.d)); }",
    );
    let params = r#"params: {"a": (0, 0, 0.4), "b": (0, 0.2), "c": (0.6, 0, 0), "d": 1}, storage"#;
    let place = place(&STORES.replace("storage", params), &shader);
    check(&place, "all").exits(0);
    for vulkan in [Vulkan::LAVAPIPE_CURRENT, Vulkan::SWIFTSHADER_CURRENT] {
        let Some(variables) = vulkan.variables() else { continue };
        let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "8x8", "--validate", "-o", "o.png"];
        place.run_with(&variables, &run).exits(0);
        let picture = image::open(place.path("o.png")).expect("a picture").into_rgb8();
        assert!(picture.pixels().all(|texel| texel.0 == [51, 102, 153]), "{:?}", picture.get_pixel(0, 0));
    }
    device(&place, |profile| profile.features.as_mut().expect("known").retain(|it| it != "scalarBlockLayout"));
    check(&place, "mine.ron").exits(1).mentions("k.comp:5: it needs the feature scalarBlockLayout");
}

#[test]
fn workgroups_and_shared_memory_are_held_to_the_devices_limits_at_their_line() {
    let shader = stores("", "local_size_x = 32, local_size_y = 32", "", MAIN);
    let big = place(STORES, &shader);
    check(&big, "lavapipe").exits(0);
    let said = "k.comp:3: its workgroups of 32×32×1 have 1024 invocations; `swiftshader` allows 256 \
        (maxComputeWorkGroupInvocations)";
    check(&big, "swiftshader").exits(1).mentions(said);
    check(&big, "mali-g78").exits(1).mentions("`Mali-G78` allows 512 (maxComputeWorkGroupInvocations)");
    let deep = place(STORES, &stores("", "local_size_z = 65", "", MAIN));
    // The compiler itself allows 64 at most.
    check(&deep, "lavapipe").exits(1).mentions("k.comp:3");

    let shared = |bytes: u32| {
        stores(
            "",
            SMALL,
            &format!("shared uint many[{}];", bytes / 4),
            "void main() {
    many[gl_LocalInvocationIndex] = 1u;
    barrier();
    imageStore(o, ivec2(gl_GlobalInvocationID.xy), vec4(float(many[gl_LocalInvocationIndex ^ 1u]))); }",
        )
    };
    check(&place(STORES, &shared(32 << 10)), "all").exits(0);
    let said = "k.comp:5: its shared variables take 49152 bytes; `Mali-G78` allows 32768 (maxComputeSharedMemorySize)";
    let large = place(STORES, &shared(48 << 10));
    check(&large, "mali-g78").exits(1).mentions(said);
    check(&large, "nvidia-rtx-2080").exits(0);
    // Where nothing is known of a device's limits nothing exceeds them.
    device(&large, |profile| profile.limits = None);
    check(&large, "mine.ron").exits(0);
}

#[test]
fn buffers_are_held_to_the_devices_ranges_where_a_pass_names_them() {
    let uniform = r#"Pipeline(version: 1,
    images: [(name: "o", format: R8G8B8A8_UNORM, size: Output)],
    buffers: [(name: "b", bytes: 131072)],
    passes: [
        (name: "zero", fill: (to: "b", value: 0)),
        (name: "k", draw: FullScreen("k"), uniform: {"t": "b"}, color: ["o"]),
    ],
    outputs: ["o"],
)"#;
    let place = Place::new();
    place.file("p.ron", uniform);
    let text = "#version 460\nlayout(set = 0, binding = 0) uniform T { vec4 v[8192]; } t;\nlayout(location = 0) out vec4 c;\n\
        void main() { c = t.v[int(gl_FragCoord.x) + 8000]; }\n";
    place.file("k.frag", text);
    check(&place, "amd-rx-7800-xt").exits(0);
    check(&place, "lavapipe")
        .exits(1)
        .mentions("k.frag:2: the uniform block `t` takes 131072 bytes; `lavapipe` allows 65536 (maxUniformBufferRange)")
        .mentions("error: `b` has 131072 bytes, and `k` sees it as a uniform block; ")
        .mentions("p.ron:6:");

    place.file("p.ron", uniform.replace("131072", "268435456").replace("uniform:", "storage:"));
    place.file("k.frag", text.replace("uniform T { vec4 v[8192]", "readonly buffer T { vec4 v[]"));
    check(&place, "swiftshader").exits(0);
    let said = "error: `b` has 268435456 bytes, and `k` sees it as a storage block; `lavapipe` allows \
        134217728 (maxStorageBufferRange)";
    check(&place, "lavapipe").exits(1).mentions(said);
    device(&place, |profile| {
        profile.limits = Some(Limits { storage_bytes: u64::MAX, buffer_bytes: 1000, ..Limits::LEAST })
    });
    check(&place, "mine.ron").exits(1).mentions("error: `b` has 268435456 bytes; `mine` allows 1000 (maxBufferSize)");

    // The device that draws says the same, without names of Rust's.
    if let Some(variables) = Vulkan::LAVAPIPE.variables() {
        let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "16x16"];
        let outcome = place.run_with(&variables, &run).exits(1).mentions("maxStorageBufferRange");
        assert!(!outcome.err.contains("BufferDescriptor"), "{}", outcome.err);
    }
}

#[test]
fn as_many_resources_are_bound_as_the_device_allows_a_stage() {
    let place = Place::new();
    let names: Vec<String> = (0..16).map(|number| format!("b{number}")).collect();
    let listed = |each: &dyn Fn(&str) -> String| names.iter().map(|name| each(name)).collect::<Vec<_>>().join(", ");
    place.file(
        "p.ron",
        format!(
            "Pipeline(version: 1, images: [(name: \"o\", format: Output, size: Output)], buffers: [{}],\n    passes: [{},\n        \
             (name: \"k\", draw: FullScreen(\"k\"), uniform: {{{}}}, color: [\"o\"])], outputs: [\"o\"])",
            listed(&|name| format!("(name: \"{name}\", bytes: 16)")),
            listed(&|name| format!("(name: \"z_{name}\", fill: (to: \"{name}\", value: 0))")),
            listed(&|name| format!("\"{name}\": \"{name}\"")),
        ),
    );
    let declared = names.iter().enumerate();
    let declared =
        declared.map(|(at, name)| format!("layout(set = 0, binding = {at}) uniform T{at} {{ vec4 v; }} {name};\n"));
    let sum = names.iter().map(|name| format!("{name}.v")).collect::<Vec<_>>().join(" + ");
    let declared: String = declared.collect();
    place.file(
        "k.frag",
        format!("#version 460\n{declared}layout(location = 0) out vec4 c;\nvoid main() {{ c = {sum}; }}\n"),
    );
    check(&place, "mali-g78").exits(0);
    let said = "18 uniform blocks are bound; `swiftshader` allows 15 (maxPerStageDescriptorUniformBuffers)";
    check(&place, "swiftshader").exits(1).mentions(said).mentions("p.ron:3:");
}

#[test]
fn draws_with_a_first_instance_in_their_counts_need_a_feature_and_a_device_without_is_told_of() {
    let place = Place::new();
    place.file(
        "p.ron",
        r#"Pipeline(version: 1,
    images: [(name: "o", format: R8G8B8A8_UNORM, size: Output)],
    buffers: [(name: "counts", bytes: 16)],
    passes: [
        (name: "make", dispatch: "k", groups: Count(1), storage: {"counts": "counts"}),
        (name: "draw", draw: Indirect("counts"), shader: "d", color: [(image: "o", clear: (0.0, 0.0, 1.0, 1.0))]),
    ],
    outputs: [(image: "o", encoding: Unorm)],
)"#,
    );
    place.file("k.comp", "#version 460\nlayout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) writeonly buffer Counts { uint of[4]; } counts;\n\
        void main() { counts.of[0] = 3u; counts.of[1] = 1u; counts.of[2] = 0u; counts.of[3] = 7u; }\n");
    place.file("d.vert", "#version 460\nvoid main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.5, 1.0); }\n");
    place.file(
        "d.frag",
        "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(0.0, 1.0, 0.0, 1.0); }\n",
    );
    let fine = check(&place, "lavapipe").exits(0);
    assert!(!fine.out.contains("first instance") && !fine.err.contains("first instance"), "{fine:?}");
    device(&place, |profile| profile.features = Some(Vec::new()));
    let told = check(&place, "mine.ron").exits(0);
    let said = "`draw`: the first instance in its counts must be 0: `mine` lacks drawIndirectFirstInstance (p.ron:6:";
    assert!(format!("{}{}", told.out, told.err).contains(said), "{told:?}");
    draws(&place);
}

#[test]
fn extensions_of_spirv_that_no_device_is_asked_for_are_refused_at_their_line() {
    let shader = stores(
        "#extension GL_EXT_subgroup_uniform_control_flow : require",
        SMALL,
        "",
        &MAIN.replace("void main()", "void main() [[subgroup_uniform_control_flow]]"),
    );
    let said = "k.comp:2: it needs SPIR-V's extension SPV_KHR_subgroup_uniform_control_flow, which isn't supported";
    check(&place(STORES, &shader), "all").exits(1).mentions(said);
}

#[test]
fn input_attachments_without_a_local_read_are_refused_with_the_reason() {
    let place = Place::new();
    place.file(
        "p.ron",
        r#"Pipeline(version: 1,
    images: [(name: "a", format: R8G8B8A8_UNORM, size: Output), (name: "screen", format: Output, size: Output)],
    passes: [
        (name: "z", fill: (to: "a", value: (0.0, 0.0, 0.0, 0.0))),
        (name: "k", draw: FullScreen("k"), sample: {"a": "a"}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#,
    );
    place.file(
        "k.frag",
        "#version 460\nlayout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInput a;\n\
        layout(location = 0) out vec4 color;\nvoid main() { color = subpassLoad(a); }\n",
    );
    for device in ["lavapipe", "swiftshader"] {
        check(&place, device)
            .exits(1)
            .mentions("error: shader `k` declares `a` as an input attachment where it is none")
            .mentions("help: declare it `subpassInput` where `LOCAL_READ_a` is defined, and else `sampler2D`");
    }
}

/// A pipeline of one full-screen pass.
const DRAWN: &str = r#"Pipeline(version: 1,
    images: [(name: "o", format: R8G8B8A8_UNORM, size: Output)],
    passes: [(name: "draw", draw: FullScreen("k"), color: ["o"])],
    outputs: [(image: "o", encoding: Unorm)],
)"#;

/// Puts a decoration that no validator knows upon the output of a stage that was compiled ahead.
fn decorate(spirv: &std::path::Path) {
    const DECORATE: u32 = 71;
    const VARIABLE: u32 = 59;
    const OUTPUT: u32 = 3;
    const BANK_NV: u32 = 5397;
    let bytes = std::fs::read(spirv).expect("read");
    let mut words: Vec<u32> = bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let (mut decorations, mut output) = (None, None);
    let mut at = 5;
    while at < words.len() {
        match words[at] & 0xffff {
            DECORATE => decorations = decorations.or(Some(at)),
            VARIABLE if words[at + 3] == OUTPUT => output = Some(words[at + 2]),
            _ => {}
        }
        at += words[at] as usize >> 16;
    }
    let at = decorations.expect("a decoration");
    words.splice(at..at, [(4 << 16) | DECORATE, output.expect("an output"), BANK_NV, 0]);
    std::fs::write(spirv, words.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<u8>>()).expect("written");
}

#[test]
fn a_word_that_the_validator_does_not_know_is_a_note() {
    let place = Place::new();
    place.file("p.ron", DRAWN);
    place.file("k.frag", "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n");
    let check = || place.run(&["check", "p.ron", "--precompiled", "spirv", "--device", "all"]).exits(0).out;
    assert!(!check().contains("SPIR-V"));
    let mut files = std::fs::read_dir(place.path("spirv")).expect("a folder").map(|file| file.expect("listed").path());
    let is_fragment =
        |file: &std::path::PathBuf| file.file_name().is_some_and(|name| name.to_string_lossy().starts_with("k.frag."));
    decorate(&files.find(is_fragment).expect("compiled ahead"));
    let out = check();
    let note = "k.frag is valid SPIR-V isn't known: Invalid decoration operand: 5397 (p.ron:3:";
    assert!(out.contains("note: `draw`: whether ") && out.matches(note).count() == 1, "{out}");
    let devices = SHIPPED_PROFILES.len();
    assert!(out.ends_with(&format!("fine on {devices} of {devices} devices\n")), "{out}");
}

#[test]
fn invalid_spirv_is_refused_by_check_and_a_cached_shader_is_judged_too() {
    let place = Place::new();
    place.file("p.ron", DRAWN);
    place.file(
        "k.frag",
        "#version 460\nlayout(pixel_center_integer) in vec4 gl_FragCoord;\nlayout(location = 0) out vec4 color;\n\
        void main() { color = vec4(gl_FragCoord.xy / 64.0, 0.0, 1.0); }\n",
    );
    let cached = [("XDG_CACHE_HOME", "cache")];
    for _ in 0..2 {
        place
            .run_with(&cached, &["check", "p.ron", "--device", "all"])
            .exits(1)
            .mentions("error: shader `k` can't be used: ")
            .mentions("k.frag:2: SPIR-V that Vulkan 1.3 doesn't allow: ")
            .mentions("(VUID-StandaloneSpirv-PixelCenterInteger-04654)");
    }
}
