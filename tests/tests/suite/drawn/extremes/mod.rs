//! Extremes (NU-4): sizes, distances, light and shapes at the ends of what numbers hold. `docs/numbers.md` lists all of them,
//! these and those of other modules, each with its result and its test.

mod blending;
mod depth_ranges;
mod lights;
mod shapes;
mod sizes;

use framewright_passes::scene::Scene;
use framewright_tests::render::{Setup, device, render};
use framewright_vulkan::Texels;
use std::error::Error;
use std::io::Write;

/// The outputs of one frame of a pipeline that is given as text; `None`: there is no device.
fn outputs(pipeline: &str, scene: &Scene, extent: [u32; 2]) -> Result<Option<Vec<Texels>>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let mut file = tempfile::NamedTempFile::new()?;
    file.write_all(pipeline.as_bytes())?;
    let path = file.path().to_str().ok_or("no path")?;
    Ok(Some(render(device, &Setup { pipeline: path, set: &[], scene, extent })?))
}
