//! Whether the shaders of a Plan compile as its passes are drawn.

use crate::base::{Diagnostic, MOST_KEPT, Span};
use crate::frame::{Draw, Frame};
use crate::plan::{Pass, Plan};
use crate::shader::{EyeSource, PARAMS, PASS_SET, ShaderInterface, ShaderInterfaces, ShaderProblem, Variant};
use std::sync::Arc;

/// The shaders that don't compile as the passes of `plan` are drawn, or don't fit them then: for both eyes at once, into a part of an
/// image, for depth alone. The Plan was made of `frame`. Expanding a file compiles shaders too, before it is known how they are drawn.
/// Passes that the compiler inserted are among them. Each mistake is told once.
#[must_use]
pub fn wrong(plan: &Plan, frame: &Frame, shaders: &mut dyn ShaderInterfaces) -> Vec<Diagnostic> {
    let mut known: Vec<(Arc<str>, ShaderProblem)> = Vec::new();
    let mut wrong = Vec::new();
    for (pass, variant) in plan.variants() {
        let found = match pass.draw {
            Some(draw) => shaders.draw_shader(&pass.shader, draw, &variant),
            None => shaders.compute_shader(&pass.shader, &variant),
        };
        let problem = match found {
            Ok(interface) => match unmet(pass, &interface) {
                Some(what) => ShaderProblem::Unsupported { what },
                None => continue,
            },
            Err(problem) => problem,
        };
        // The program draws with a pipeline of its own then.
        let its_own = pass.draw.is_some_and(Draw::is_custom) && matches!(problem, ShaderProblem::Missing { .. });
        if its_own || known.iter().any(|(shader, other)| *shader == pass.shader && *other == problem) {
            continue;
        }
        let mistake = problem.at(&pass.shader, place(frame, pass));
        wrong.push(mistake.remark(format!("as pass `{}` is drawn{}", pass.name, how(plan, pass, &variant))));
        known.push((pass.shader.clone(), problem));
        if wrong.len() == MOST_KEPT {
            break;
        }
    }
    wrong
}

/// What the shader as it is compiled and the pass don't agree on, if there is anything: names that only one of them has.
fn unmet(pass: &Pass, interface: &ShaderInterface) -> Option<String> {
    let images = pass.accesses.iter().filter_map(|access| access.binding.as_ref()).map(|binding| &*binding.name);
    let given: Vec<&str> = images.chain(pass.buffers.iter().filter_map(|buffer| buffer.binding.as_deref())).collect();
    let own = || interface.bindings.iter().filter(|binding| binding.set == PASS_SET && !binding.kind.is_sampler());
    if let Some(surplus) = given.iter().find(|name| !own().any(|binding| binding.takes(name))) {
        return Some(format!("it has no `{surplus}`, which pass `{}` gives", pass.name));
    }
    // The values of the pass go to this block.
    let own = own().filter(|it| it.name != PARAMS || it.kind.uniform_block().is_none());
    let mut elements = own.flat_map(|binding| (0..binding.count()).map(|number| binding.element(number)));
    let missing = elements.find(|name| !given.contains(&&**name))?;
    Some(format!("it declares `{missing}`, which pass `{}` doesn't give", pass.name))
}

/// Where the file declares the pass, or the one that it draws again.
fn place(frame: &Frame, pass: &Pass) -> Span {
    let name = pass.redraws.as_ref().unwrap_or(&pass.name);
    frame.passes.iter().find(|declared| declared.name == *name).map_or(Span::NONE, |declared| declared.span)
}

/// What its shader is compiled for, beside what every pass's is.
fn how(plan: &Plan, pass: &Pass, variant: &Variant) -> String {
    let mut said = String::new();
    match (variant.form, variant.eye) {
        (Some(_), _) => said += &format!(", for both eyes at once (`{}`)", plan.stereo.name()),
        (None, Some(EyeSource::One(_))) => said += ", for one eye",
        (None, _) => {}
    }
    if pass.redraws.is_some() {
        said += ", for depth alone";
    }
    if !variant.local.is_empty() {
        said += ", with local reads";
    }
    said
}
