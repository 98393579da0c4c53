//! Numbers that shipped shaders store: each is one that a half float holds, for all images, materials and lights that a shader
//! is given. The shaders are those of the folder, so a new one is held to the rule from the start.

mod filters;
mod full_screen;
mod pipeline;
mod scales;
mod scenes;

use framewright_graph::shader::{FragmentOutput, ShaderInterface};
use framewright_graph::vulkan::Component;
use framewright_passes::scene::Scene;
use framewright_tests::render::{Setup, device, floats, in_repository, render};
use std::error::Error;
use std::io::Write;

/// The outputs of one frame of a pipeline, given as text, channel by channel; `None`: there is no device.
fn outputs(pipeline: &str, scene: &Scene) -> Result<Option<Vec<Vec<f64>>>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let mut file = tempfile::NamedTempFile::new()?;
    file.write_all(pipeline.as_bytes())?;
    let path = file.path().to_str().ok_or("no path")?;
    let setup = Setup { pipeline: path, set: &[], scene, extent: pipeline::EXTENT };
    let drawn = render(device, &setup).map_err(|problem| format!("{problem}\n{pipeline}"))?;
    Ok(Some(drawn.iter().map(floats).collect()))
}

/// That every number is one that a half float holds.
fn demand_storable(what: &str, outputs: &[Vec<f64>]) {
    for (output, numbers) in outputs.iter().enumerate() {
        for (at, number) in numbers.iter().enumerate() {
            assert!(number.abs() <= 65504.0, "{what}, output {output}, number {at}: {number}");
        }
    }
}

/// The name of every fragment shader in the folder of those that are shipped.
fn names() -> Result<Vec<String>, Box<dyn Error>> {
    let mut names = Vec::new();
    for file in std::fs::read_dir(in_repository("shaders"))? {
        let name = file?.file_name().into_string().map_err(|name| format!("{name:?}"))?;
        names.extend(name.strip_suffix(".frag").map(str::to_owned));
    }
    names.sort();
    Ok(names)
}

/// Whether a shader writes colour, in floating point.
fn draws_color(shader: &ShaderInterface) -> bool {
    let is_float = |output: &FragmentOutput| output.component == Component::Float;
    !shader.outputs.is_empty() && shader.outputs.iter().all(is_float)
}
