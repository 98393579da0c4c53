//! Shaders that fill the screen, each of their images full of numbers that go wrong easily.

use super::pipeline::{Pipeline, own, params};
use super::{demand_storable, draws_color, names, outputs};
use framewright_graph::frame::Draw;
use framewright_graph::shader::{BindingKind, ShaderInterface, ShaderInterfaces, Variant};
use framewright_passes::shipped::SHADERS;
use framewright_tests::render::library;
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// The value of all parameters and the filter of all images, round by round.
const ROUNDS: [(u32, &str); 3] = [(0, "Linear"), (1, "Nearest"), (16, "Linear")];

/// The interface of a shader if it is one that fills the screen.
pub(crate) fn full_screen(name: &str) -> Option<ShaderInterface> {
    let vertices = format!("{name}.vert");
    let own_vertices = SHADERS.iter().any(|(file, _)| *file == vertices);
    library().draw_shader(name, Draw::FullScreen, &Variant::default()).ok().filter(|_| !own_vertices)
}

fn pipeline(name: &str, shader: &ShaderInterface) -> String {
    let mut pipeline = Pipeline::with_extremes();
    for (round, (number, filter)) in ROUNDS.into_iter().enumerate() {
        let mut sampled = String::new();
        let mut uniform = String::new();
        for binding in own(shader) {
            match &binding.kind {
                BindingKind::SampledImage(_) => {
                    sampled += &format!("{:?}: (image: \"extremes\", filter: {filter}), ", binding.name);
                }
                BindingKind::UniformBlock(_) if binding.name != "params" => {
                    let buffer = format!("buffer_{round}_{}", binding.name);
                    pipeline.buffer(&format!("(name: \"{buffer}\", bytes: 16), "));
                    // As a float NaN, in the last round infinity.
                    let bits = if round < 2 { 0x7fc0_0000_u32 } else { 0x7f80_0000 };
                    pipeline.pass(&format!("(name: \"{buffer}\", fill: (to: \"{buffer}\", value: {bits})),"));
                    uniform += &format!("{:?}: \"{buffer}\", ", binding.name);
                }
                _ => {}
            }
        }
        let pass = format!("round_{round}");
        let targets = pipeline.targets(&pass, &shader.outputs);
        let params = params(shader, number);
        pipeline.pass(&format!(
            "(name: \"{pass}\", draw: FullScreen(\"{name}\"), color: [{targets}], sample: {{{sampled}}}, \
             uniform: {{{uniform}}}, params: {{{params}}}),\n"
        ));
    }
    pipeline.text()
}

#[test]
fn every_shipped_full_screen_shader_stores_finite_numbers_whatever_its_images_hold() -> Result<(), Box<dyn Error>> {
    let scene = empty_scene();
    let mut tried = 0;
    for name in names()? {
        let Some(shader) = full_screen(&name).filter(draws_color) else { continue };
        let Some(found) = outputs(&pipeline(&name, &shader), &scene)? else { return Ok(()) };
        demand_storable(&name, &found);
        tried += 1;
    }
    assert!(tried > 20, "only {tried} shaders of the folder fill the screen");
    Ok(())
}
