//! Two eyes, drawn into images as an OpenXR runtime hands them out (`XR_KHR_vulkan_enable2`): layers of one (`imageArrayIndex`), or halves
//! of one (`imageRect`). No runtime was at hand: `openxr/runtime.rs` plays its part, with images of its own.
//!
//! `cargo run --package framewright-vulkan --example openxr_layers` writes `out/layers.png` and `out/halves.png`, what the eyes are shown
//! side by side. With an argument behind it the validation layer watches.

use framewright::vulkan::ash::vk;
use framewright::{Device, DeviceOptions, Renderer, RendererOptions, SceneDrawSource, Stereo, Submission, load_scene};
use runtime::{EYE, HANDED, Runtime};
use std::error::Error;

#[path = "openxr/runtime.rs"]
mod runtime;

/// Draws frames in the first of these ways that the device has, and returns what the eyes are shown at last.
fn draw(device: &Device, ways: &[Stereo]) -> Result<Vec<u8>, Box<dyn Error>> {
    let scene = load_scene("spheres_and_cubes")?;
    let mut renderer = Renderer::open(device, "forward", RendererOptions::default())?;
    renderer.set_scene(&scene);
    renderer.set_extent(EYE)?;
    renderer.set_stereo(Stereo::first_fit(ways, &device.profile())?)?;

    // The swapchain's images are as the Plan says: with two layers, or of twice the width.
    let executor = renderer.executor_mut()?;
    let info = executor.image_info("screen").ok_or("the pipeline has no `screen`")?;
    let states = executor.external_states("screen").ok_or("the pipeline has no `screen`")?;
    println!("{} layers of {}×{}", info.array_layers, info.extent.width, info.extent.height);
    // A frame takes an image as the runtime hands it out, or doesn't care, and leaves it as the runtime wants it back.
    assert!(states.before.layout == HANDED.2 || states.before.layout == vk::ImageLayout::UNDEFINED);
    assert_eq!(states.after.layout, HANDED.2);
    let mut runtime = Runtime::create_swapchain(device, &info)?;
    // SAFETY: they are as the Plan says, and outlive the renderer.
    unsafe { executor.import_images("screen", &runtime.images())? };

    let plan = renderer.prepare()?.plan;
    let mut objects = SceneDrawSource::for_eyes(device, &scene, EYE, plan, &Runtime::locate_views(&scene))?;
    let mut shown = Vec::new();
    for _ in 0..4 {
        let images = [("screen", runtime.acquire())];
        let among = Submission { images: &images, ..Submission::default() };
        // SAFETY: nobody reads the image, and no semaphore is waited for or signalled.
        unsafe { renderer.executor_mut()?.submit_with(&mut objects, &among)? };
        // A runtime reads the image after all that was submitted before.
        shown = runtime.release_and_show()?;
    }
    drop(renderer);
    Ok(shown)
}

fn main() -> Result<(), Box<dyn Error>> {
    let validation = std::env::args().len() > 1;
    let device = Device::open(&DeviceOptions { validation, ..DeviceOptions::default() })?;
    std::fs::create_dir_all("out")?;
    for (name, ways) in [("layers", &[Stereo::Multiview, Stereo::Instanced][..]), ("halves", &[Stereo::DoubleWide][..])]
    {
        let shown = draw(&device, ways)?;
        let [width, height] = EYE;
        image::save_buffer(format!("out/{name}.png"), &shown, 2 * width, height, image::ExtendedColorType::Rgba8)?;
    }
    let messages = device.messages();
    drop(device);
    match messages.list().iter().find(|message| message.is_finding()) {
        Some(finding) => Err(finding.text.clone().into()),
        None => Ok(()),
    }
}
