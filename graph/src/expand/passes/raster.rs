//! Raster state of passes: whether it goes with what they draw, and with their shaders.

use crate::base::{Code, Diagnostic};
use crate::frame::Draw;
use crate::language;
use crate::shader::ShaderInterface;
use crate::vulkan::{PrimitiveTopology, name_of};

/// Reports raster state and blends that don't go with the pass.
pub(super) fn check(pass: &language::Pass, interface: Option<&ShaderInterface>, errors: &mut Vec<Diagnostic>) {
    let (name, shader) = (&pass.name.text, pass.shader().map_or("", |shader| &*shader.text));
    let mut wrong = |span, message: String, help: &str| {
        errors.push(Diagnostic::new(Code::RASTER_UNFIT, span, message).help(help));
    };
    if let Some(raster) = &pass.raster {
        let topology = raster.value.topology;
        let own = pass.work.draws(Draw::has_own_vertices) || pass.work.callback().is_some();
        if !pass.is_drawn() {
            let message = format!("pass `{name}` has a raster state and draws into nothing");
            wrong(raster.span, message, "leave `raster` out, or give it `color` or `depth`");
        } else if topology != PrimitiveTopology::TriangleList && !own {
            let message = format!("pass `{name}` has the topology {}, and draws triangles", name_of(&topology));
            wrong(raster.span, message, "leave `topology` out: it goes with `Vertices(…)` and `Indirect(…)`");
        } else if topology == PrimitiveTopology::PointList && interface.is_some_and(|it| !it.point_size) {
            let message = format!("pass `{name}` draws points, and shader `{shader}` doesn't say how large they are");
            wrong(raster.span, message, "write `gl_PointSize = 1.0;` in its vertex stage");
        }
        if pass.covers && raster.value.draws_nothing() {
            let message = format!("pass `{name}` promises to cover its targets, and leaves out all faces");
            wrong(raster.span, message, "leave `covers` out, or choose another `cull_mode`");
        }
    }
    for target in pass.color.iter().filter(|target| target.blend.value.takes_second_source()) {
        if pass.color.len() > 1 {
            let message = format!(
                "pass `{name}` blends with the shader's second colour, and draws into {} colour targets",
                pass.color.len()
            );
            wrong(target.blend.span, message, "devices blend so into one target: split the pass");
        } else if interface.is_some_and(|it| !it.second_source) {
            let message =
                format!("pass `{name}` blends with the shader's second colour, and shader `{shader}` has none");
            wrong(target.blend.span, message, "declare it: `layout(location = 0, index = 1) out vec4 second;`");
        }
    }
}
