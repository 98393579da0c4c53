//! Rays and addresses follow the device, and what the program says of itself: `check` takes shaders that use them where the profile has the
//! features, and refuses them elsewhere at their line (DO-4).

use crate::testing::Place;
use framewright_graph::device::{Profile, SHIPPED_PROFILES};

const PIPELINE: &str = r#"Pipeline(version: 1,
    images: [(name: "screen", format: R8G8B8A8_UNORM, size: Output)],
    passes: [(name: "k", draw: FullScreen("k"), color: ["screen"])],
    outputs: ["screen"],
)"#;

/// What a program tells of itself: a set with one binding, and more.
fn interface(kind: &str, more: &str) -> String {
    format!(
        "Interface(version: 1, draws: [], sets: [(set: 1, bindings: [(binding: 0, kind: {kind}, stages: [Fragment])])]{more})"
    )
}

const TRACES: &str = "#version 460
#extension GL_EXT_ray_query : require
layout(set = 1, binding = 0) uniform accelerationStructureEXT scene;
layout(location = 0) out vec4 color;
void main() {
    rayQueryEXT ray;
    rayQueryInitializeEXT(ray, scene, gl_RayFlagsTerminateOnFirstHitEXT, 0xff, vec3(gl_FragCoord.xy, 0.0), 0.0, vec3(0.0, 0.0, 1.0), 1.0);
    while (rayQueryProceedEXT(ray)) {}
    color = vec4(rayQueryGetIntersectionTypeEXT(ray, true));
}
";

const FOLLOWS: &str = "#version 460
#extension GL_EXT_buffer_reference : require
layout(buffer_reference, std430) readonly buffer Color { vec4 color; };
layout(set = 1, binding = 0) uniform Head { Color head; };
layout(location = 0) out vec4 color;
void main() { color = head.color; }
";

/// A folder with the pipeline, its shader and what the program tells.
fn place(shader: &str, interface: &str) -> Place {
    let place = Place::new();
    place.file("p.ron", PIPELINE);
    place.file("k.frag", shader);
    place.file("i.ron", interface);
    place
}

const CHECK: [&str; 4] = ["check", "p.ron", "--interface", "i.ron"];

/// Every shipped profile takes the shader, or names the features that it lacks, each at a line.
fn follows_the_device(place: &Place, needs: &[&str]) {
    let mut taken = 0;
    for (name, text) in SHIPPED_PROFILES {
        let profile = Profile::from_ron(text).expect("a shipped profile");
        let lacks: Vec<_> = needs.iter().filter(|feature| !profile.has_feature(feature)).collect();
        let said = place.run(&[&CHECK[..], &["--device", name]].concat()).exits(i32::from(!lacks.is_empty())).err;
        for feature in &lacks {
            assert!(said.contains(&format!("needs the feature {feature}, which `{}`", profile.name)), "{name}: {said}");
        }
        assert_eq!(said.matches("k.frag:").count(), lacks.len(), "{name}: {said}");
        taken += usize::from(lacks.is_empty());
    }
    assert!(taken > 0, "no shipped device takes it");
}

#[test]
fn do_4_rays_are_traced_where_the_device_traces_them() {
    let place = place(TRACES, &interface("AccelerationStructure", ""));
    follows_the_device(&place, &["rayQuery", "accelerationStructure"]);
    let said = place.run(&[&CHECK[..], &["--device", "mali-g78"]].concat()).exits(1).err;
    assert!(said.contains("k.frag:6: ") && said.contains("k.frag:3: "), "{said}");
    let another = self::place(TRACES, &interface("StorageBuffer", ""));
    let said = another.run(&[&CHECK[..], &["--device", "nvidia-rtx-2080"]].concat()).exits(1).err;
    assert!(said.contains("it is declared as an acceleration structure, and is a storage block [E0829]"), "{said}");
    // A file by itself has no structure to bind.
    let alone = place.run(&["check", "p.ron", "--device", "nvidia-rtx-2080"]).exits(1).err;
    assert!(alone.contains("uses `scene` (set 1, binding 0)"), "{alone}");
    place.file("k.frag", TRACES.replace("set = 1", "set = 0"));
    let bound = place.run(&[&CHECK[..], &["--device", "nvidia-rtx-2080"]].concat()).exits(1).err;
    assert!(
        bound.contains("an acceleration structure") && bound.contains("only sets that the program binds"),
        "{bound}"
    );
}

#[test]
fn do_4_addresses_are_followed_where_the_device_has_them_and_the_program_says_so() {
    let handed = place(FOLLOWS, &interface("UniformBuffer", ", addresses: true"));
    follows_the_device(&handed, &["bufferDeviceAddress"]);
    for said in [&interface("UniformBuffer", ""), &interface("UniformBuffer", ", addresses: false")] {
        let refused = place(FOLLOWS, said).run(&[&CHECK[..], &["--device", "nvidia-rtx-2080"]].concat()).exits(1).err;
        let what = "no program says that it hands addresses out";
        assert!(refused.contains(what) && refused.contains("k.frag:3: "), "{refused}");
    }
}

/// An acceleration structure that is found by a number would be an address that the file makes up.
#[test]
fn do_4_no_file_makes_up_the_address_of_a_structure() {
    let made_up = TRACES
        .replace("layout(set = 1, binding = 0) uniform accelerationStructureEXT scene;", "")
        .replace(
            "#extension GL_EXT_ray_query : require",
            "#extension GL_EXT_ray_query : require\n#extension GL_EXT_ray_tracing : require",
        )
        .replace("ray, scene", "ray, accelerationStructureEXT(uvec2(64, 0))");
    let nvidia = ["--device", "nvidia-rtx-2080"];
    let refused = place(&made_up, &interface("UniformBuffer", "")).run(&[&CHECK[..], &nvidia].concat()).exits(1).err;
    assert!(refused.contains("no program says that it hands addresses out"), "{refused}");
}
