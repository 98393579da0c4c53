//! A pipeline whose file changes while it is drawn: it extends a shipped pipeline, and its history goes on.
//!
//! `cargo run --package framewright --example embed_changing` writes `out/changing.ron` three times, and pictures beside it. A program
//! of its own would ask for changes between frames.

use framewright::{
    Change, Device, DeviceOptions, Helper, Renderer, RendererOptions, Scene, SceneDrawSource, load_scene,
    vulkan::helper,
};
use std::path::Path;

const EXTENT: [u32; 2] = [320, 180];

/// `temporal` averages frames; `temporal.ron` isn't beside the file, so it is the shipped one.
const PLAIN: &str = r#"Pipeline(
    version: 1,
    extends: "temporal.ron",
)
"#;

/// A fragment of the shipped library shows in a corner how far everything is.
const WITH_OVERLAY: &str = r#"Pipeline(
    version: 1,
    extends: "temporal.ron",
    include: ["library/overlay.ron"],
    changes: [
        Insert(after: "map", passes: [
            (use: "overlay", name: "show_depth", with: {"shown": "depth", "target": "screen", "farthest": 20.0}),
        ]),
    ],
)
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Shaders of files that change are compiled by a process of their own: see docs/embedding.md.
    helper::serve();
    let mut options = RendererOptions::default();
    options.helper = Some(Helper::this_program(helper::Limits::default())?);

    let file = Path::new("out/changing.ron");
    std::fs::create_dir_all("out")?;
    std::fs::write(file, PLAIN)?;
    let device = Device::open(&DeviceOptions { helper: options.helper.clone(), ..DeviceOptions::default() })?;
    let scene = load_scene("spheres_and_cubes")?;
    let mut renderer = Renderer::open(&device, file, options)?;
    renderer.set_scene(&scene);
    renderer.set_extent(EXTENT)?;
    draw(&mut renderer, &scene, "out/plain.png")?;

    std::fs::write(file, WITH_OVERLAY.replace("show_depth", "show depth"))?;
    look(&mut renderer);
    draw(&mut renderer, &scene, "out/still_plain.png")?;

    std::fs::write(file, WITH_OVERLAY)?;
    look(&mut renderer);
    draw(&mut renderer, &scene, "out/overlay.png")?;
    Ok(())
}

/// Reads the files again if they changed. A mistake in them is told, and what was drawn before is drawn on.
fn look(renderer: &mut Renderer) {
    if renderer.files_changed() {
        match renderer.reload() {
            Ok(Change::Executor { carried_over }) => println!("carried over: {}", carried_over.join(", ")),
            Ok(_) => {}
            Err(mistake) => println!("{mistake}"),
        }
    }
}

/// Draws eight frames, and writes the last.
fn draw(renderer: &mut Renderer, scene: &Scene, path: &str) -> Result<(), Box<dyn std::error::Error>> {
    let device = renderer.device().clone();
    let mut objects = SceneDrawSource::for_plan(&device, scene, EXTENT, renderer.prepare()?.plan)?;
    for _ in 0..8 {
        renderer.frame(&mut objects)?;
    }
    let texels = renderer.read("screen")?;
    image::save_buffer(path, &texels.bytes, EXTENT[0], EXTENT[1], image::ExtendedColorType::Rgba8)?;
    Ok(())
}
