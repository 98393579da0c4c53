//! `run --renderdoc`: whether RenderDoc is there, and what it took (LV-10).

use crate::testing::{Place, Vulkan};

const RUN: [&str; 6] = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "32x32"];

/// Debian's package librenderdoc has it.
const LIBRARY: &str = "/usr/lib/librenderdoc.so";

#[test]
fn lv_10_without_renderdoc_the_command_that_helps_is_told_before_anything_is_drawn() {
    let place = Place::new();
    let frames = ["--frames", "2", "--renderdoc", "2", "-o", "x.png"];
    let refused = place.run(&[&RUN[..], &frames].concat()).exits(3);
    let refused = refused.mentions("RenderDoc isn't loaded").mentions("renderdoccmd capture --wait-for-exit");
    assert!(refused.err.contains("[E1616]") && !place.path("x.png").exists(), "{}", refused.err);
    let beyond = [&RUN[..], &["--renderdoc", "2"]].concat();
    place.run(&beyond).exits(2).mentions("`--renderdoc` asks for frame 2, and `--frames` draws 1");
    place.run(&[&RUN[..], &["--renderdoc", "0"]].concat()).exits(2);
}

#[test]
fn lv_10_a_frame_that_renderdoc_cannot_take_is_told() {
    let Some(mut variables) = Vulkan::LAVAPIPE.variables() else { return };
    if !std::path::Path::new(LIBRARY).exists() {
        eprintln!("skipped: {LIBRARY} is missing");
        return;
    }
    let place = Place::new();
    // It is in the way to the device, which it can't replay.
    variables.push(("LD_PRELOAD", LIBRARY));
    let asked = [&RUN[..], &["--renderdoc", "1"]].concat();
    let hidden = place.run_with(&variables, &asked).exits(3);
    hidden.mentions("lacks Vulkan 1.3.0").mentions("RenderDoc is loaded: it hides Vulkan 1.3");
    // It is in the process, and not in the way.
    variables.push(("VK_LOADER_LAYERS_DISABLE", "VK_LAYER_RENDERDOC_Capture"));
    let taken = place.run_with(&variables, &asked).exits(3);
    taken.mentions("RenderDoc took nothing of frame 1").mentions("[E1616]");
    // Where nobody asks for it, nothing is taken.
    place.run_with(&variables, &RUN).exits(0);
}
