//! Very many small pictures with one device: sizes and settings change, and memory stays bounded.
//!
//! `cargo run --package framewright --example headless_batch` writes a thousand pictures to `out/batch`, or as many as an argument says.

use framewright::{Change, Device, DeviceOptions, Renderer, RendererOptions, SceneDrawSource, load_scene};
use std::error::Error;

/// A size is another Plan, with an executor of its own.
const SIZES: [[u32; 2]; 4] = [[96, 54], [64, 64], [54, 96], [128, 72]];
/// A value is the same Plan with another number in it.
const WHITE_POINTS: [f64; 3] = [1.0, 4.0, 16.0];

fn main() -> Result<(), Box<dyn Error>> {
    let count = std::env::args().nth(1).map_or(Ok(1000), |argument| argument.parse())?;
    let device = Device::open(&DeviceOptions::default())?;
    let scene = load_scene("spheres_and_cubes")?;
    let mut renderer = Renderer::open(&device, "forward", RendererOptions::default())?;
    renderer.set_scene(&scene);
    std::fs::create_dir_all("out/batch")?;

    let mut objects = None;
    let (mut number, mut first_rounds, mut most) = (0, 0, 0);
    'pictures: for round in 0_u32.. {
        for extent in SIZES {
            renderer.set_extent(extent)?;
            for white_point in WHITE_POINTS {
                if number == count {
                    break 'pictures;
                }
                renderer.set("white_point", white_point)?;
                let prepared = renderer.prepare()?;
                if matches!(prepared.change, Change::Executor { .. }) {
                    objects = Some(SceneDrawSource::for_plan(&device, &scene, extent, prepared.plan)?);
                }
                renderer.frame(objects.as_mut().ok_or("the first Plan has an executor")?)?;
                let (path, texels) = (format!("out/batch/{number:04}.png"), renderer.read("screen")?);
                let color = image::ExtendedColorType::Rgba8;
                image::save_buffer(path, &texels.bytes, extent[0], extent[1], color)?;
                number += 1;
                most = most.max(device.memory_in_use().bytes);
            }
        }
        // From the second round on each size follows another one.
        if round == 1 {
            first_rounds = most;
        }
    }
    println!("{number} pictures; device memory at most {first_rounds} bytes in the first rounds, {most} in all");
    Ok(())
}
