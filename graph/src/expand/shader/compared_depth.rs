//! Depth that a sampler compares: pass and shader must both mean that, and the image must hold depth.

use crate::base::{Code, Diagnostic, Span};
use crate::frame::Image;
use crate::language;

/// Reports where only one of pass and shader compares, and images without depth. `compares`: the shader does; `image` has the place
/// of its format.
pub(in crate::expand) fn check(
    pass: &language::Pass,
    sample: &language::Sample,
    compares: bool,
    (image, format): (&Image, Span),
    errors: &mut Vec<Diagnostic>,
) {
    let (name, place) = (&sample.binding.text, sample.part.image.span);
    let shader = pass.shader().map_or("", |shader| &*shader.text);
    match sample.compare {
        None if compares => {
            let pass = &pass.name.text;
            let message =
                format!("shader `{shader}` compares a depth with `{name}`, and pass `{pass}` doesn't say how");
            let help = format!(
                "`(image: \"{}\", compare: GreaterOrEqual)` gives 1 where the shader's depth is no farther than the image's",
                image.name
            );
            errors.push(Diagnostic::new(Code::COMPARE, place, message).help(help));
        }
        Some(compare) if !compares => {
            let message = format!("shader `{shader}` reads `{name}`, and compares nothing with it");
            let help = format!("leave `compare` out, or declare `{name}` in the shader as `sampler2DShadow`");
            errors.push(Diagnostic::new(Code::COMPARE, compare.span, message).help(help));
        }
        // That stencil and integers are no depth is said already.
        Some(_) if !image.format.is_depth() && !image.format.is_integer() => {
            let message =
                format!("shader `{shader}` compares a depth with `{name}`, and `{}` holds colour", image.name);
            errors.push(Diagnostic::new(Code::COMPARE, place, message).label(format, "its format"));
        }
        None | Some(_) => {}
    }
}
