//! Shaders of HLSL read the vertices of a draw source (DO-5), by the names that their compilers keep, or by their locations. Each picture
//! equals that of GLSL.

use crate::engine_vertices::{OBJECTS, Plain, SHADERS, drawn, plain, plan};
use crate::frames::{on_each_driver, texels};
use framewright_graph::base::Root;
use framewright_graph::shader::DrawInterface;
use framewright_vulkan::{Device, Error, Executor, ExecutorOptions, ShaderLibrary};
use std::path::Path;

/// What this vertex stage draws with vertices of these names, each with the location at which shaders may read it.
fn drawn_by(device: &Device, vertex: &str, names: [(&'static str, Option<u32>); 2]) -> Result<Vec<u32>, Error> {
    let mut draws = plain();
    for (attribute, (name, location)) in draws.attributes.iter_mut().zip(names) {
        (attribute.name, attribute.location) = (name.into(), location);
    }
    let plan = plan(device, |pass| pass, (&format!("vertex {vertex}, fragment plain"), OBJECTS));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/shaders/spirv");
    let draws = move |_| -> DrawInterface { draws.clone() };
    let mut library = ShaderLibrary::new(vec![Root::new(folder)], SHADERS, draws);
    let options = ExecutorOptions { readback: true, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plan, &mut library, &options)?;
    executor.frame(&mut Plain::quarters(device))?;
    Ok(texels(&mut executor, "shown", 0))
}

#[test]
fn do_5_hlsl_of_each_compiler_draws_the_vertices_of_an_engine() {
    on_each_driver(|device| {
        let wanted = drawn(device, "plain", plain(), &mut Plain::quarters(device)).expect("a picture");
        let here: &[&str] = match cfg!(feature = "shader-compiler") {
            true => &["mesh_dxc.spv:VSMain", "mesh.hlsl:VSMain"],
            false => &["mesh_dxc.spv:VSMain"],
        };
        for vertex in here {
            // The shader's first input is the number, and the interface's first attribute the place.
            let by_name = drawn_by(device, vertex, [("place", None), ("given", None)]);
            assert_eq!(by_name.expect("a picture"), wanted, "{vertex}, by names");
            let by_location = drawn_by(device, vertex, [("position", Some(1)), ("number", Some(0))]);
            assert_eq!(by_location.expect("a picture"), wanted, "{vertex}, by locations");
            let crossed = drawn_by(device, vertex, [("place", Some(0)), ("given", Some(1))]);
            assert_eq!(crossed.expect("a picture"), wanted, "{vertex}, names come first");
            let said = drawn_by(device, vertex, [("position", None), ("given", None)]).expect_err("a refusal");
            assert!(said.to_string().to_lowercase().contains("place`"), "{vertex}: {said}");
        }
    });
}
