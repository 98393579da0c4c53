//! Shaders of HLSL read the vertices of a draw source (DO-5), by the names that their compilers keep, or by their locations. Each picture
//! equals that of GLSL.

use crate::engine_vertices::{OBJECTS, Plain, QUARTERS, SHADERS, drawn, plain, plan, value};
use crate::frames::{on_each_driver, texels};
use framewright_graph::base::Root;
use framewright_graph::frame::{Draw, Pass, RasterState};
use framewright_graph::shader::{DrawInterface, PushConstants};
use framewright_graph::vulkan::{PrimitiveTopology, Stages};
use framewright_vulkan::{Device, DrawSource, Error, Executor, ExecutorOptions, Recorder, ShaderLibrary};
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

/// Draws a square of a number in each quarter, told by push constants.
struct Pushes;

impl DrawSource for Pushes {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        for quarter in QUARTERS {
            let number = [value(quarter), 0, 0, 0].into_iter().flat_map(u32::to_ne_bytes);
            let place = quarter.0.into_iter().flat_map(|it| (it + 0.5).to_ne_bytes());
            recorder.push_constants(0, &number.chain(place).collect::<Vec<u8>>());
            recorder.draw(0..4, 0..1);
        }
        Ok(4)
    }
}

#[test]
fn do_5_push_constants_of_a_draw_tell_hlsl_and_spirv_what_they_tell_glsl() {
    on_each_driver(|device| {
        let wanted = drawn(device, "plain", plain(), &mut Plain::quarters(device)).expect("a picture");
        let raster = RasterState { topology: PrimitiveTopology::TriangleStrip, ..RasterState::default() };
        let here: &[&str] = match cfg!(feature = "shader-compiler") {
            true => &[
                "vertex pushed_draw_vertices.spv:VSMain, fragment pushed_draw.spv:PSMain",
                "vertex pushed_draw.hlsl:VSMain, fragment pushed_draw.hlsl:PSMain",
            ],
            false => &["vertex pushed_draw_vertices.spv:VSMain, fragment pushed_draw.spv:PSMain"],
        };
        for shader in here {
            let plan = plan(device, |pass| Pass { raster, ..pass }, (shader, OBJECTS));
            let executor = |ranges: &[PushConstants]| {
                let draws = DrawInterface { push_constants: ranges.to_vec(), ..DrawInterface::default() };
                let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/shaders/spirv");
                let mut shaders = ShaderLibrary::new(vec![Root::new(folder)], &[], move |_| draws.clone());
                let options = ExecutorOptions { readback: true, ..ExecutorOptions::default() };
                Executor::new(device, &plan, &mut shaders, &options)
            };
            let mut drawn = executor(&[PushConstants::new(0, 24)]).expect("an executor");
            drawn.frame(&mut Pushes).expect("a frame");
            assert_eq!(texels(&mut drawn, "shown", 0), wanted, "{shader}");
            // What the draw brings too little of, or to another stage, and what it doesn't bring are parameters.
            let vertices = PushConstants::new(0, 24).for_stages(Stages::VERTEX_SHADER);
            for ranges in [&[PushConstants::new(0, 20)][..], &[vertices], &[]] {
                let said = executor(ranges).map(drop).expect_err("a refusal").to_string();
                assert!(said.contains("of the block `params` has no value"), "{shader}, {ranges:?}: {said}");
            }
        }
    });
}
