//! An engine in small: it has its own Vulkan device, its own command buffers and images, and two threads. Framewright draws its frame.
//!
//! `cargo run --package framewright-vulkan --example engine` writes `out/engine_frame.png`.
//!
//! - This file: the world, and the thread that moves it.
//! - `gpu.rs`: instance, device and queues.
//! - `interface.rs`: what the passes of `frame.ron` see of the engine.
//! - `materials.rs`: all textures in one table, which shaders in HLSL index.
//! - `sparks.rs`: a compute pipeline of the engine's own, in a custom pass that may run on a queue for compute.
//! - `screens.rs`: the images that frames are drawn into, and the commands that copy them.
//! - `render.rs`: the thread that draws.

mod gpu;
mod interface;
mod materials;
mod render;
mod screens;
mod sparks;

use std::error::Error;
use std::process::ExitCode;
use std::sync::mpsc::sync_channel;
use std::thread;

/// What the thread that draws is told of a frame.
struct World {
    seconds: f32,
    objects: Vec<Object>,
}

/// A cube.
struct Object {
    place: [f32; 3],
    /// Radians about the upright axis.
    turned: f32,
    material: u32,
}

const FRAMES: u32 = 8;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    // The world is one frame ahead of what is drawn.
    let (worlds, told) = sync_channel(1);
    let drawing = thread::spawn(move || render::draw(&told).map_err(|error| error.to_string()));
    for frame in 0..FRAMES {
        if worlds.send(world(frame)).is_err() {
            break;
        }
    }
    drop(worlds);
    let picture = drawing.join().map_err(|_| "the thread that draws panicked")??;
    std::fs::create_dir_all("out")?;
    let [width, height] = render::EXTENT;
    image::save_buffer("out/engine_frame.png", &picture.texels, width, height, image::ExtendedColorType::Rgba8)?;
    println!("{FRAMES} frames drawn by {}; out/engine_frame.png", picture.device);
    Ok(())
}

/// The world at a frame: a square of cubes that turn.
fn world(frame: u32) -> World {
    let seconds = frame as f32 / 30.0;
    let objects = (0..materials::COUNT).map(|number| {
        let (column, row) = (number % 5, number / 5);
        let place = [column as f32 * 1.6 - 3.2, 0.0, row as f32 * -1.6 + 1.6];
        Object { place, turned: seconds + number as f32, material: number }
    });
    World { seconds, objects: objects.collect() }
}
