//! `cargo bench --package framewright-viewer --bench open_page`: what a page that is open costs a program, as a ratio. It needs a device.
//!
//! Blocks of frames take turns: with a page that follows the program, without pictures that it asks for, and without a call of the viewer.
//! The ratio is the median over pairs of neighbours. `-- --short` makes two pairs, to see that it runs.

use framewright::{Device, DeviceOptions, Renderer, RendererOptions, SceneDrawSource, load_scene};
use framewright_viewer::Viewer;
use std::error::Error;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Instant;

/// Size of the frame.
const SIZE: [u32; 2] = [640, 360];
/// Frames of a block.
const BLOCK: u32 = 40;

fn main() -> Result<(), Box<dyn Error>> {
    let pairs = if std::env::args().any(|argument| argument == "--short") { 2 } else { 24 };
    let device = Device::open(&DeviceOptions::default())?;
    println!("{} pairs of {BLOCK} frames, {}×{}, on {}", pairs, SIZE[0], SIZE[1], device.summary().name);
    println!("| pipeline | ms a frame, without | with a page | ratio |\n|---|---|---|---|");
    for pipeline in ["forward", "deferred"] {
        let scene = load_scene("spheres_and_cubes")?;
        let mut options = RendererOptions::default();
        options.executor.timestamps = true;
        let mut renderer = Renderer::open(&device, pipeline, options)?;
        renderer.set_scene(&scene);
        renderer.set_extent(SIZE)?;
        let plan = renderer.prepare()?.plan;
        let mut objects = SceneDrawSource::for_plan(&device, &scene, SIZE, plan)?;
        let mut viewer = Viewer::serve("127.0.0.1:0")?;
        let url = viewer.url();
        std::thread::spawn(move || drop(follow(&url)));
        let mut block = |viewer: Option<&mut Viewer>| -> Result<f64, Box<dyn Error>> {
            let mut viewer = viewer;
            let begun = Instant::now();
            for _ in 0..BLOCK {
                renderer.frame(&mut objects)?;
                if let Some(viewer) = viewer.as_deref_mut() {
                    viewer.frame(&mut renderer)?;
                }
            }
            Ok(begun.elapsed().as_secs_f64() * 1e3 / f64::from(BLOCK))
        };
        block(Some(&mut viewer))?;
        let mut times = Vec::new();
        for pair in 0..pairs {
            // Which of the two comes first changes, so that neither has the warmer machine.
            let (without, with) = if pair % 2 == 0 {
                let without = block(None)?;
                (without, block(Some(&mut viewer))?)
            } else {
                let with = block(Some(&mut viewer))?;
                (block(None)?, with)
            };
            times.push([without, with, with / without]);
        }
        let [without, with, ratio] = [0, 1, 2].map(|column| median(times.iter().map(|row| row[column])));
        println!("| {pipeline} | {without:.2} | {with:.2} | {ratio:.3} |");
    }
    Ok(())
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

/// Asks for state after state, as a page does.
fn follow(url: &str) -> std::io::Result<()> {
    let (host, path) = url.trim_start_matches("http://").split_once('/').unwrap_or_default();
    let mut version = 0_u64;
    loop {
        let mut stream = TcpStream::connect(host)?;
        write!(stream, "GET /{path}state/{version} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n")?;
        let mut answer = String::new();
        stream.read_to_string(&mut answer)?;
        let told = answer.split_once("\"version\":").map(|(_, rest)| rest);
        let digits = told.map(|rest| rest.chars().take_while(char::is_ascii_digit).collect::<String>());
        version = digits.and_then(|digits| digits.parse().ok()).unwrap_or(version);
    }
}
