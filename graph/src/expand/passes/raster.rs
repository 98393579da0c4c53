//! Raster state of passes: what the draw source says of it, and whether it goes with what they draw and with their shaders.

use crate::base::{Code, Diagnostic};
use crate::frame::check::raster::{self, RasterPlace};
use crate::frame::{Draw, Pass};
use crate::language;
use crate::shader::{DrawInterface, ShaderInterface};
use crate::vulkan::{PrimitiveTopology, name_of};

/// Takes over what the draw source says of its vertices, and reports what the file says otherwise.
pub(super) fn join(pass: &language::Pass, brought: &DrawInterface, lowered: &mut Pass, errors: &mut Vec<Diagnostic>) {
    let said = lowered.raster.topology;
    let own = pass.work.draws(Draw::has_own_vertices) || pass.work.callback().is_some();
    if let Some(raster) = &pass.raster
        && said != PrimitiveTopology::TriangleList
        && brought.topology.map_or(!own, |topology| topology != said)
        && pass.is_drawn()
    {
        let drawn = match brought.topology {
            Some(topology) => name_of(&topology),
            None => "triangles".to_owned(),
        };
        let message = format!("pass `{}` has the topology {}, and draws {drawn}", pass.name.text, name_of(&said));
        let help = match brought.topology {
            Some(_) => "leave `topology` out: the program says it of what it draws",
            None => "leave `topology` out: it goes with `Vertices(…)` and `Indirect(…)`",
        };
        errors.push(Diagnostic::new(Code::RASTER_UNFIT, raster.span, message).help(help));
        lowered.raster.topology = PrimitiveTopology::TriangleList;
    }
    if let Some(topology) = brought.topology {
        lowered.raster.topology = topology;
        lowered.raster.primitive_restart |= brought.primitive_restart;
    }
}

/// Reports raster state and blends that don't go with the pass.
pub(super) fn check(
    pass: &language::Pass,
    lowered: &Pass,
    interface: Option<&ShaderInterface>,
    errors: &mut Vec<Diagnostic>,
) {
    let (name, shader) = (&pass.name.text, pass.shader().map_or("", |shader| &*shader.text));
    let state = pass.raster.as_ref().map_or(pass.name.span, |raster| raster.span);
    if pass.raster.is_some() && !pass.is_drawn() {
        return errors.push(raster::draws_into_nothing(name, state));
    }
    let at = |place| match place {
        RasterPlace::State => state,
        RasterPlace::Blend(number) => pass.color[number].blend.span,
    };
    raster::check(lowered, at, errors);
    let Some(interface) = interface else { return };
    if lowered.raster.topology == PrimitiveTopology::PointList && !interface.point_size {
        let message = format!("pass `{name}` draws points, and shader `{shader}` doesn't say how large they are");
        let wrong = Diagnostic::new(Code::RASTER_UNFIT, state, message);
        errors.push(wrong.help("write `gl_PointSize = 1.0;` in its vertex stage"));
    }
    let second = pass.color.iter().filter(|target| target.blend.value.takes_second_source() && pass.color.len() == 1);
    for target in second.filter(|_| !interface.second_source) {
        let message = format!("pass `{name}` blends with the shader's second colour, and shader `{shader}` has none");
        let wrong = Diagnostic::new(Code::RASTER_UNFIT, target.blend.span, message);
        errors.push(wrong.help("declare it: `layout(location = 0, index = 1) out vec4 second;`"));
    }
}
