//! A pipeline for an engine with draws of its own, checked against the file that the engine writes (EM-5).

use crate::testing::{Outcome, Place, Vulkan, repository};

/// A folder with the engine's pipeline, shaders and interface.
fn engine() -> Place {
    let place = Place::new();
    for file in ["engine.ron", "interface.ron", "terrain.vert", "terrain.frag", "grass.vert", "grass.frag", "gust.comp"]
    {
        place.file(file, std::fs::read(repository("examples/custom_pass").join(file)).expect("the example"));
    }
    place
}

/// Replaces one piece of a file's text.
#[track_caller]
fn replace(place: &Place, file: &str, old: &str, new: &str) {
    let text = std::fs::read_to_string(place.path(file)).expect("a text");
    assert!(text.contains(old), "{file} doesn't hold {old}");
    place.file(file, text.replacen(old, new, 1));
}

/// The check of the engine with one piece of a file's text replaced.
#[track_caller]
fn with(file: &str, old: &str, new: &str) -> Outcome {
    let place = engine();
    replace(&place, file, old, new);
    place.run(&["check", "engine.ron", "--interface", "interface.ron"])
}

#[test]
fn a_pipeline_for_an_engine_is_refused_without_its_interface() {
    let err = engine().run(&["check", "engine.ron"]).exits(1).err;
    for said in [
        "error: shader `terrain` reads the vertex attribute `place`, which doesn't exist",
        "error: shader `terrain` uses `camera` (set 1, binding 0), which the draw source doesn't bring along",
        "error: shader `terrain` uses `materials` (set 2, binding 0), which the draw source doesn't bring along",
        "error: shader `grass` uses `camera` (set 1, binding 0), which the draw source doesn't bring along",
        "`check --interface` reads what the draws of another program bring along",
        "engine.ron:15:58",
    ] {
        assert!(err.contains(said), "`{said}` is not in\n{err}");
    }
}

#[test]
fn with_its_interface_it_is_checked_as_any_pipeline_is() {
    let place = engine();
    let fine = |arguments: &[&str]| place.run(&[arguments, &["--interface", "interface.ron"]].concat()).exits(0).out;
    assert!(fine(&["check", "engine.ron"]).starts_with("engine.ron: fine on lavapipe: 4 passes"));
    assert!(fine(&["check", "engine.ron", "--all-variants"]).contains("engine.ron: fine in 2 variants: grass (2)"));
    assert!(fine(&["check", "engine.ron", "--device", "all"]).contains("fine on 7 of 7 devices"));
    assert!(fine(&["inspect", "engine.ron"]).contains("`grass`"));
    assert!(fine(&["diff", "engine.ron", "--a", "grass=true", "--b", "grass=false"]).contains("`grass`"));
    assert!(!fine(&["explain", "engine.ron", "terrain"]).is_empty());
}

#[test]
fn what_the_interface_does_not_bring_is_a_mistake_of_the_pipeline_with_a_near_name() {
    with("interface.ron", "\"tint\"", "\"tints\"")
        .exits(1)
        .mentions("error: shader `terrain` reads the vertex attribute `tint`, which doesn't exist")
        .mentions("engine.ron:15:58")
        .mentions("did you mean `tints`?");
    with("interface.ron", "\"materials\"", "\"material\"")
        .exits(1)
        .mentions(
            "error: shader `terrain` uses `materials` (set 2, binding 0), which the draw source doesn't bring along",
        )
        .mentions("did you mean `material`?");
    with("interface.ron", "set: 2, binding: 0", "set: 2, binding: 5")
        .exits(1)
        .mentions("error: shader `terrain` uses `materials` (set 2, binding 0), but `materials` is at set 2, binding 5")
        .mentions("in the shader: write `layout(set = 2, binding = 5)`");
    with("interface.ron", "StorageBlock", "UniformBlock").exits(1).mentions(
        "error: shader `terrain` uses `materials` (set 2, binding 0) as something else than it is: a uniform block",
    );
    with("terrain.frag", "readonly buffer", "buffer")
        .exits(1)
        .mentions("as something else than it is: a storage block that is only read (`readonly buffer`)");
    with("terrain.vert", "in vec3 tint;", "in ivec3 tint;")
        .exits(1)
        .mentions("reads the vertex attribute `tint` as `ivec3`");
    with("interface.ron", "of: [Custom, Compute]", "of: [Sky, Compute]")
        .exits(1)
        .mentions("error: shader `grass` uses `camera` (set 1, binding 0), which the draw source doesn't bring along")
        .mentions("engine.ron:19:48");
}

#[test]
fn a_shader_declares_at_most_as_many_textures_as_the_interface_brings() {
    let place = engine();
    let textures = r#"(name: "textures", set: 2, binding: 3, kind: SampledImage, count: 16),
                (name: "materials","#;
    replace(&place, "interface.ron", r#"(name: "materials","#, textures);
    // Where a length is written, the index needs no feature.
    let check = |length: &str| {
        let index = if length == "[]" { "int(tint_of_vertex.x)" } else { "0" };
        let text = format!(
            "#version 460\n#extension GL_EXT_nonuniform_qualifier : enable\n\
            layout(location = 0) in vec3 tint_of_vertex;\n\
            layout(set = 2, binding = 3) uniform sampler2D textures{length};\n\
            layout(location = 0) out vec4 color;\n\
            void main() {{ color = texture(textures[{index}], vec2(0.5)); }}\n"
        );
        place.file("terrain.frag", text);
        place.run(&["check", "engine.ron", "--interface", "interface.ron"])
    };
    check("[16]").exits(0);
    check("[3]").exits(0);
    let said =
        "shader `terrain` uses `textures` (set 2, binding 3) as an array of 17, and the draw source brings along 16";
    check("[17]").exits(1).mentions(said).mentions("engine.ron:15:58").mentions("declare at most 16");
    check("[]")
        .exits(1)
        .mentions(
            "shader `terrain` uses `textures` (set 2, binding 3) as an array of unknown length, which isn't supported",
        )
        .mentions("write how many elements it has: `uniform sampler2D textures[64];`");
}

#[test]
fn a_compute_shader_sees_what_its_kind_brings_and_nothing_of_what_draws_bring() {
    let place = engine();
    let text = "#version 460\nlayout(local_size_x = 1) in;\n\
        layout(set = 1, binding = 0) uniform Camera { vec4 shift; } camera;\n\
        layout(set = 0, binding = 0) buffer Wind { vec4 push; } wind;\n\
        void main() { wind.push = camera.shift; }\n";
    place.file("blow.comp", text);
    let pass = r#"(name: "blow", dispatch: "blow", groups: Count(1), storage: {"wind": "wind"}), (name: "terrain","#;
    replace(&place, "engine.ron", r#"(name: "terrain","#, pass);
    let check = || place.run(&["check", "engine.ron", "--interface", "interface.ron"]);
    check().exits(0);
    replace(&place, "interface.ron", "of: [Custom, Compute]", "of: [Custom]");
    check()
        .exits(1)
        .mentions("error: shader `blow` uses `camera` (set 1, binding 0), which the draw source doesn't bring along");
}

#[test]
fn a_custom_pass_that_the_engine_does_not_record_is_a_mistake() {
    with("engine.ron", "custom: \"upload\"", "custom: \"uplaod\"")
        .exits(1)
        .mentions("error: nobody records `uplaod`, which the custom pass `upload` asks for")
        .mentions("engine.ron:12:49")
        .mentions("did you mean `upload`?");
    with("interface.ron", "[\"grass\", \"upload\"]", "[]")
        .exits(1)
        .mentions("nobody records `grass`")
        .mentions("nobody records `upload`")
        .mentions("the program that draws the pipeline records no custom passes");
    with("interface.ron", "    custom: [\"grass\", \"upload\"],\n", "").exits(0);
}

#[test]
fn the_shader_of_a_custom_pass_must_fit_its_pass() {
    with("engine.ron", "uniform: {\"wind\": \"wind\"},", "")
        .exits(1)
        .mentions("error: shader `grass` uses the uniform block `wind`, which pass `grass` doesn't give");
    // Without a shader of its name the engine brings a pipeline of its own.
    let place = engine();
    std::fs::remove_file(place.path("grass.frag")).expect("removed");
    place.run(&["check", "engine.ron", "--interface", "interface.ron"]).exits(0);
}

#[test]
fn shipped_shaders_say_what_they_lack_in_another_program() {
    with("engine.ron", "shader: \"terrain\"", "shader: \"lit\"")
        .exits(1)
        .mentions("error: shader `lit` reads the vertex attribute `position`, which doesn't exist")
        .mentions("error: shader `lit` reads the vertex attribute `normal`, which doesn't exist")
        .mentions("error: shader `lit` uses `objects` (set 1, binding 2), which the draw source doesn't bring along")
        .mentions(
            "error: shader `lit` uses `base_color_texture` (set 2, binding 0), which the draw source doesn't bring",
        );
}

#[test]
fn mistakes_of_the_file_are_told_at_their_places_in_every_form() {
    with("interface.ron", "set: 2", "set: 20")
        .exits(1)
        .mentions("error: `materials` can't be brought along in set 20: a draw source has sets 1 to 3")
        .mentions("interface.ron:13:17");
    let place = engine();
    replace(&place, "interface.ron", "offset: 8", "offset: 9");
    let check = |form: &str| place.run(&["check", "engine.ron", "--interface", "interface.ron", "--format", form]);
    for form in ["json", "sarif", "junit", "github"] {
        let out = check(form).exits(1).out;
        assert!(out.contains("interface.ron") && out.contains("doesn't fit vertices of 20 bytes"), "{form}: {out}");
    }
    place
        .run(&["check", "engine.ron", "--interface", "none.ron"])
        .exits(1)
        .mentions("the interface `none.ron` can't be read");
    place.file("binary.ron", [0xff, 0xfe]);
    place.run(&["check", "engine.ron", "--interface", "binary.ron"]).exits(1).mentions("is not text");
    place.file("large.ron", vec![b' '; (1 << 20) + 1]);
    place.run(&["check", "engine.ron", "--interface", "large.ron"]).exits(1).mentions("is larger than 1.0 MiB");
    replace(&place, "interface.ron", "offset: 9", "offset: 8");
    let written = ["inspect", "engine.ron", "--interface", "interface.ron", "-o", "interface.ron"];
    place.run(&written).exits(2).mentions("`interface.ron` is the interface itself, which would be lost");
}

#[test]
fn commands_that_draw_take_no_interface() {
    let place = engine();
    let scene = ["engine.ron", "--scene", "spheres_and_cubes", "--interface", "interface.ron"];
    for (command, more) in [
        ("run", &[][..]),
        ("serve", &["--port", "0"]),
        ("window", &[]),
        ("measure", &["--sweep", "grass=true,false", "-o", "swept"]),
        ("inspect", &["--capture", "--format", "html", "-o", "page.html"]),
    ] {
        place.run(&[&[command], &scene[..], more].concat()).exits(2).mentions("scenes of the command's own");
    }
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let run = ["run", "engine.ron", "--scene", "spheres_and_cubes", "--size", "16x16"];
    place.run_with(&variables, &run).exits(1).mentions("`check --interface` reads what the draws of another program");
}

#[test]
fn the_page_on_embedding_shows_the_example() {
    let page = std::fs::read_to_string(repository("docs/embedding.md")).expect("a page");
    let example = std::fs::read_to_string(repository("examples/custom_pass/interface.rs")).expect("the example");
    assert!(
        page.contains(&format!("```rust\n{example}```")),
        "docs/embedding.md doesn't hold examples/custom_pass/interface.rs"
    );
    let file = std::fs::read_to_string(repository("examples/custom_pass/interface.ron")).expect("the file");
    assert!(
        page.contains(&format!("```ron\n{file}```")),
        "docs/embedding.md doesn't hold examples/custom_pass/interface.ron"
    );
}

/// A table of textures that the program binds itself (DO-5).
const TABLE: &str = "sets: [(set: 2, bindings: [
    (binding: 3, kind: CombinedImageSampler, count: 16, stages: [Fragment], flags: [PartiallyBound]),
])],
    custom:";

#[test]
fn a_table_of_the_programs_is_checked_without_the_program() {
    let place = engine();
    let text = "#version 460\n#extension GL_EXT_nonuniform_qualifier : require\n\
        layout(location = 0) in vec3 tint_of_vertex;\n\
        layout(set = 2, binding = 3) uniform sampler2D textures[];\n\
        layout(location = 0) out vec4 color;\n\
        void main() { color = texture(textures[nonuniformEXT(int(tint_of_vertex.x))], vec2(0.5)); }\n";
    place.file("terrain.frag", text);
    replace(&place, "interface.ron", "custom:", TABLE);
    replace(&place, "interface.ron", r#"(name: "materials", set: 2, binding: 0, kind: StorageBlock),"#, "");
    let check = |device: &str| place.run(&["check", "engine.ron", "--interface", "interface.ron", "--device", device]);
    for device in ["swiftshader", "nvidia-rtx-2080", "amd-rx-7800-xt", "intel-arc-a770", "mali-g78", "meta-quest-3"] {
        check(device).exits(0);
    }
    // The lavapipe of Debian 12 lacks all that tables need: feature, line and device.
    check("lavapipe")
        .exits(1)
        .mentions("terrain.frag:2: the fragment stage needs the feature runtimeDescriptorArray, which `lavapipe` doesn't have")
        .mentions("terrain.frag:4: a binding of the program's set that is partially bound needs the feature");
    let wrong = |old: &str, new: &str, said: &str| {
        let text = std::fs::read_to_string(place.path("interface.ron")).expect("a text");
        replace(&place, "interface.ron", old, new);
        check("swiftshader").exits(1).mentions("[E0829]").mentions("engine.ron:15:58").mentions(said);
        place.file("interface.ron", text);
    };
    let used = "shader `terrain` uses `textures`, set 2, binding 3 (./terrain.frag:4): ";
    let what = "the program's set has no such binding; it has 5";
    wrong("binding: 3", "binding: 5", &format!("{used}{what}"));
    let what = "it is declared as a sampled image with its sampler, and is a storage image";
    wrong("CombinedImageSampler", "StorageImage", &format!("{used}{what}"));
    let what = "fragment shaders read it, and it is made for vertex shaders";
    wrong("[Fragment]", "[Vertex]", &format!("{used}{what}"));
    replace(&place, "terrain.frag", "textures[]", "textures[17]");
    let what = "it is declared as an array of 17, and has 16";
    wrong("version: 1", "version: 1", &format!("{used}{what}"));
}
