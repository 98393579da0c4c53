//! A shader whose declaration is left to the pass is drawn with by the command, on both software drivers.

mod support;

use support::{Place, Vulkan, repository};

/// What the texels are is held against what was drawn in the workspace's own tests, on one driver.
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
