//! A shader whose declaration is left to the pass is drawn with by the command, on both software drivers.

use crate::testing::{Place, Vulkan, repository};

/// The texels are compared with those that were drawn in the workspace's own tests, on one driver.
#[test]
fn one_shader_draws_the_same_of_every_kind_of_image_on_both_drivers_and_the_layer_is_silent() {
    let place = Place::new();
    for file in ["pipelines/textures.ron", "shaders/sample_values.frag", "shaders/any_texture.frag"] {
        let text = std::fs::read(repository("tests").join(file)).expect("the file is there");
        place.file(file.rsplit('/').next().expect("a name"), text);
    }
    for msaa in ["msaa=4", "msaa=1"] {
        let drivers = [("lavapipe", Vulkan::LAVAPIPE_CURRENT), ("swiftshader", Vulkan::SWIFTSHADER_CURRENT)];
        for (name, vulkan) in drivers {
            let Some(variables) = vulkan.variables() else { return };
            let dumped = ["layered", "sampled"].map(|kind| format!("of_{kind}={name}_{kind}.exr"));
            let [layered, sampled] = dumped.each_ref().map(String::as_str);
            let file = format!("{name}_flat.exr");
            let outcome = place.run_with(
                &variables,
                &[
                    "run",
                    "textures.ron",
                    "--scene",
                    "spheres_and_cubes",
                    "--size",
                    "32x24",
                    "--set",
                    msaa,
                    "--validate",
                    "-o",
                    &file,
                    "--dump",
                    layered,
                    "--dump",
                    sampled,
                ],
            );
            let said = outcome.exits(0).out;
            assert!(said.contains("validation: silent; "), "{said}");
        }
        for kind in ["flat", "layered", "sampled"] {
            let file = |name: &str| std::fs::read(place.path(format!("{name}_{kind}.exr"))).expect("it is written");
            assert!(file("lavapipe") == file("swiftshader"), "{kind} with {msaa}");
        }
    }
}

/// An image that is left out has a type too: with all that a pass may be given its shader is compiled as it would be then.
#[test]
fn an_image_of_layers_may_be_left_out_and_what_it_needs_with_it() {
    let place = Place::new();
    place.file(
        "p.ron",
        r#"Pipeline(
            version: 1,
            settings: [(name: "on", value: Bool(default: true))],
            images: [
                (name: "layers", format: R8G8B8A8_UNORM, size: Fixed(4, 4), layers: 2),
                (name: "screen", format: Output, size: Output),
            ],
            passes: [
                (name: "fill", fill: (to: "layers", value: (1.0, 0.0, 0.0, 1.0))),
                (name: "show", draw: FullScreen("show"), sample: {"extra": (image: "layers", when: "on")},
                    params: {"share": 0.5}, color: ["screen"]),
            ],
            outputs: ["screen"],
        )"#,
    );
    let shader = "#version 460\n#ifdef HAS_extra\nlayout(set = 0, binding = 0) uniform TEXTURE_extra extra;\n\
                  layout(set = 0, binding = 1) uniform Params { float share; } params;\n#endif\n\
                  layout(location = 0) in vec2 uv;\nlayout(location = 0) out vec4 color;\nvoid main() {\n\
                  color = vec4(0.0);\n#ifdef HAS_extra\ncolor = params.share * texture(extra, vec3(uv, 1.0));\n#endif\n}\n";
    place.file("show.frag", shader);
    for on in ["on=true", "on=false"] {
        place.run(&["check", "p.ron", "--set", on]).exits(0);
    }
    let plan = place.run(&["inspect", "p.ron", "--set", "on=false"]).exits(0).out;
    assert!(plan.contains("`show`: is compiled without `extra`: on = false (p.ron:"), "{plan}");
    assert!(!plan.contains("share") && !plan.contains("extra ="), "{plan}");
    // A name that the shader doesn't have either is a mistake all the same.
    let text = std::fs::read_to_string(place.path("p.ron")).expect("written");
    place.file("wrong.ron", text.replace("\"share\"", "\"shore\""));
    place.run(&["check", "wrong.ron", "--set", "on=false"]).exits(1).mentions("has no parameter named `shore`");
    place.file("wrong.ron", text.replace("{\"extra\"", "{\"extras\""));
    place.run(&["check", "wrong.ron", "--set", "on=false"]).exits(1).mentions("samples no image named `extras`");
}
