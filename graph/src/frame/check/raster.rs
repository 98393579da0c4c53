//! Raster state of a pass: whether it goes with what the pass draws, and into what.

use crate::base::{Code, Diagnostic, Span};
use crate::frame::{BufferRole, Draw, Pass};
use crate::vulkan::{PrimitiveTopology, name_of};

/// A place of a mistake.
#[derive(Debug, Clone, Copy)]
pub(crate) enum RasterPlace {
    /// The raster state.
    State,
    /// The blend of a colour target, by its number.
    Blend(usize),
}

/// Reports raster state and blends that don't go with the pass. `at`: where they are said.
#[inline]
pub(crate) fn check(pass: &Pass, at: impl Fn(RasterPlace) -> Span, errors: &mut Vec<Diagnostic>) {
    let second = pass.color.iter().position(|target| target.blend.takes_second_source());
    if !pass.raster.is_usual() {
        state(pass, at(RasterPlace::State), errors);
    }
    if let Some(number) = second.filter(|_| pass.color.len() > 1) {
        let message = format!(
            "pass `{}` blends with the shader's second colour, and draws into {} colour targets",
            pass.name,
            pass.color.len()
        );
        let wrong = Diagnostic::new(Code::RASTER_UNFIT, at(RasterPlace::Blend(number)), message);
        errors.push(wrong.help("devices blend so into one target: split the pass"));
    }
}

/// What is wrong with a raster state that a pass has though it draws into nothing.
pub(crate) fn draws_into_nothing(name: &str, here: Span) -> Diagnostic {
    let message = format!("pass `{name}` has a raster state and draws into nothing");
    Diagnostic::new(Code::RASTER_UNFIT, here, message).help("leave `raster` out, or give it `color` or `depth`")
}

#[cold]
fn state(pass: &Pass, here: Span, errors: &mut Vec<Diagnostic>) {
    let name = &pass.name;
    let mut wrong = |message: String, help: &str| {
        errors.push(Diagnostic::new(Code::RASTER_UNFIT, here, message).help(help));
    };
    let topology = pass.raster.topology;
    if topology != PrimitiveTopology::TriangleList && pass.work.draws(Draw::is_full_screen) {
        let message = format!("pass `{name}` has the topology {}, and draws triangles", name_of(&topology));
        wrong(message, "leave `topology` out: it goes with `Vertices(…)` and `Indirect(…)`");
    }
    if pass.raster.primitive_restart {
        let indexed = pass.buffers.iter().any(|used| used.role == BufferRole::Index);
        if !topology.is_joined() {
            let message = format!("pass `{name}` begins strips anew, and draws {}", name_of(&topology));
            wrong(message, "`primitive_restart` goes with `LineStrip`, `TriangleStrip` and `TriangleFan`");
        } else if pass.work.draws(Draw::has_own_vertices) && !indexed {
            let message = format!("pass `{name}` begins strips anew by an index, and has no indices");
            wrong(message, "leave `primitive_restart` out, or add `index: \"…\"`");
        }
    }
    if pass.covers && pass.raster.draws_nothing() {
        let message = format!("pass `{name}` promises to cover its targets, and leaves out all faces");
        wrong(message, "leave `covers` out, or choose another `cull_mode`");
    }
    if f32::from(pass.raster.line_width) < 1.0 {
        let width = f32::from(pass.raster.line_width);
        wrong(format!("pass `{name}` draws lines {width} texels wide"), "lines are 1 texel wide at least");
    }
}
