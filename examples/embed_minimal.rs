//! Framewright within a program: from a pipeline file to a picture in ten lines.
//!
//! `cargo run --package framewright --example embed_minimal` writes `out/embedded.png`.

use framewright::{Device, DeviceOptions, Renderer, RendererOptions, SceneDrawSource, load_scene};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let device = Device::open(&DeviceOptions::default())?;
    let scene = load_scene("spheres_and_cubes")?;
    let mut renderer = Renderer::open(&device, "forward", RendererOptions::default())?;
    renderer.set("msaa", 4)?;
    renderer.set_scene(&scene);
    renderer.set_extent([640, 360])?;
    let plan = renderer.prepare()?.plan;
    let mut objects = SceneDrawSource::for_plan(&device, &scene, [640, 360], plan)?;
    renderer.frame(&mut objects)?;
    let texels = renderer.read("screen")?;

    std::fs::create_dir_all("out")?;
    image::save_buffer("out/embedded.png", &texels.bytes, 640, 360, image::ExtendedColorType::Rgba8)?;
    Ok(())
}
