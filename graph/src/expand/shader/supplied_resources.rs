//! A shader meets its draw source and its program: vertex attributes, and the resources of sets from 1 on.

use super::interfaces::CheckedShaders;
use crate::base::{Code, Diagnostic, OutsideChoice, suggestion};
use crate::device::Need;
use crate::expand::resources::Resources;
use crate::frame::Draw;
use crate::language;
use crate::ron::Name;
use crate::shader::{
    AttributeMisfit, Binding, Block, DrawInterface, FileLanguage, LayoutFault, PARAMS, PASS_SET, ProgramResource,
    ProgramSet, ShaderInterface, SuppliedResource, UnbindableResource, VertexLayout, needs_in_pass,
};
use std::sync::Arc;

/// Reports inputs that the shader, found under `path`, wants and the draw source doesn't provide. Of these it gives back the blocks that
/// hold the pass's parameters, in another set than the pass's.
pub(in crate::expand) fn check<'i>(
    resources: &Resources<'_>,
    shaders: &mut CheckedShaders<'_>,
    pass: &language::Pass,
    (path, interface): (&Arc<str>, &'i ShaderInterface),
    errors: &mut Vec<Diagnostic>,
) -> Vec<&'i Block> {
    let Some(shader) = pass.shader() else { return Vec::new() };
    let own = pass.work.draws(Draw::has_own_vertices);
    if own {
        own_attributes(resources, pass, shader, interface, errors);
    }
    let Some(brought) = shaders.brought_along_first(pass, path) else { return Vec::new() };
    if !own {
        attributes(shader, interface, &brought, errors);
    }
    pushed(shader, interface, &brought, errors);
    let mut strays = Vec::new();
    for binding in interface.bindings.iter().filter(|binding| binding.set != PASS_SET) {
        match stray(pass, binding, &brought.supplied) {
            Some(block) => {
                errors.push(not_brought(shader, binding).help(moved(shader, &binding.name)));
                strays.push(block);
            }
            None => resource(shader, binding, &brought.supplied, errors),
        }
    }
    for used in &interface.program {
        of_program(shader, used, shaders.program_sets(), errors);
    }
    strays
}

/// The block at a binding, if it holds parameters of the pass and the draw source brings along nothing of that name.
fn stray<'i>(pass: &language::Pass, binding: &'i Binding, supplied: &[SuppliedResource]) -> Option<&'i Block> {
    let block = binding.kind.uniform_block().filter(|_| !supplied.iter().any(|there| there.is_called(binding)))?;
    let holds = |param: &language::Param| block.parameters().iter().any(|member| member.name == *param.name.text);
    pass.params.iter().any(holds).then_some(block)
}

/// Where a block of parameters belongs, in the words of the shader's language.
fn moved(shader: &Name, block: &str) -> String {
    match FileLanguage::of_shader(&shader.text) {
        None => format!("in the shader: move `{block}` to set {PASS_SET}, and call it `{PARAMS}`"),
        Some(FileLanguage::Hlsl | FileLanguage::Slang) => format!("in the shader: move `{block}` to `space{PASS_SET}`"),
        Some(FileLanguage::Spirv | FileLanguage::Wgsl) => format!("in the shader: move `{block}` to set {PASS_SET}"),
    }
}

/// That the draw source doesn't bring along what is at a binding.
fn not_brought(shader: &Name, binding: &Binding) -> Diagnostic {
    let message = format!(
        "shader `{}` uses `{}` (set {}, binding {}), which the draw source doesn't bring along",
        shader.text, binding.name, binding.set, binding.binding
    );
    Diagnostic::new(Code::DRAW_SOURCE_LACKS, shader.span, message).choice(OutsideChoice::DrawInterfaces)
}

/// What the shader asks of the device, and the resources that its pass and the draw source bind for it.
pub(in crate::expand) fn needs(
    shaders: &CheckedShaders<'_>,
    pass: &language::Pass,
    interface: &ShaderInterface,
) -> Vec<Need> {
    // Compute passes and draws of a pass's own vertices that read nothing of what is brought along have nothing of it bound.
    let may_do_without = pass.work.is_dispatch() || pass.work.draws(Draw::has_own_vertices);
    let binds = !may_do_without || interface.bindings.iter().any(|binding| binding.set != PASS_SET);
    let brought = binds.then(|| shaders.brought_along(pass)).flatten();
    needs_in_pass(interface, brought.as_deref(), shaders.program_sets(), pass.color.len())
}

/// A pass that brings its own vertices names their buffer, if and only if its shader declares attributes. The buffer holds as
/// many vertices as are drawn; which of them indices ask for is not known, nor how many an indirect draw asks for.
fn own_attributes(
    resources: &Resources<'_>,
    pass: &language::Pass,
    shader: &Name,
    interface: &ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) {
    match (interface.vertex_inputs.first(), &pass.vertex) {
        (Some(input), None) => {
            let message = format!(
                "shader `{}` {} the vertex attribute `{}`, and pass `{}` has no buffer of vertices",
                shader.text,
                input.verb(),
                input.name,
                pass.name.text
            );
            let help =
                if input.used { "add `vertex: \"…\"`" } else { "remove it in the shader, or add `vertex: \"…\"`" };
            errors.push(Diagnostic::new(Code::VERTEX_ATTRIBUTES, shader.span, message).help(help));
        }
        (None, Some(part)) => {
            let message = format!("shader `{}` reads no vertex attributes", shader.text);
            errors.push(
                Diagnostic::new(Code::VERTEX_ATTRIBUTES, part.buffer.span, message)
                    .help("remove `vertex`, or name it in `storage`"),
            );
        }
        (Some(_), Some(part)) => match VertexLayout::of(&interface.vertex_inputs, 1) {
            Ok(layout) => {
                let stride = layout.strides[0];
                let counts = pass.work.draw().filter(|_| pass.index.is_none()).and_then(Draw::counts);
                let (count, what) = match counts {
                    Some([count, _]) => (count, format!("{count} vertices of {stride} bytes")),
                    None => (1, format!("the attributes of one vertex of shader `{}`", shader.text)),
                };
                let bytes = u64::from(count) * u64::from(stride);
                resources.holds(&part.buffer, bytes, &what, part.buffer.span, errors);
            }
            Err(LayoutFault { message, .. }) => {
                errors.push(Diagnostic::new(
                    Code::VERTEX_ATTRIBUTES,
                    shader.span,
                    format!("shader `{}`: {message}", shader.text),
                ));
            }
        },
        (None, None) => {}
    }
}

fn attributes(shader: &Name, interface: &ShaderInterface, brought: &DrawInterface, errors: &mut Vec<Diagnostic>) {
    let Name { text: shader, span } = shader;
    for input in &interface.vertex_inputs {
        let Err(misfit) = brought.locations(input) else { continue };
        let (name, ty, verb) = (&input.name, &input.ty, input.verb());
        let reads = format!("shader `{shader}` {verb} the vertex attribute `{name}`");
        let (message, help) = match misfit {
            AttributeMisfit::Unknown => {
                let help = in_the_shader(suggestion(name, brought.attributes.iter().map(|attribute| &*attribute.name)));
                let none = || Some("what this pass draws has no vertex attributes".to_owned());
                (format!("{reads}, which doesn't exist"), help.or_else(none))
            }
            AttributeMisfit::Component => {
                (format!("{reads} as `{ty}` from another component than the first on"), misfit.help(input))
            }
            AttributeMisfit::Format(_) | AttributeMisfit::Locations(_) => {
                (format!("{reads} as `{ty}`"), misfit.help(input))
            }
        };
        let wrong = Diagnostic::new(Code::VERTEX_ATTRIBUTES, *span, message).choice(OutsideChoice::DrawInterfaces);
        errors.push(Diagnostic { help, ..wrong });
    }
}

/// Reports push constants that the draw source doesn't set, or not beside parts of images.
fn pushed(shader: &Name, interface: &ShaderInterface, brought: &DrawInterface, errors: &mut Vec<Diagnostic>) {
    for block in &interface.pushed {
        let what = match (brought.pushed_misfit(block), interface.asks_part.first()) {
            (Some(misfit), _) => misfit,
            (None, Some(part)) => {
                format!("push constants `{}` beside the part of `{part}`, which is one too", block.name)
            }
            (None, None) => continue,
        };
        let message = format!("shader `{}` reads {what}", shader.text);
        errors.push(Diagnostic::new(Code::PUSH_CONSTANTS, shader.span, message).choice(OutsideChoice::DrawInterfaces));
    }
}

/// A suggestion for a name in the shader, not in the pipeline.
fn in_the_shader(help: Option<String>) -> Option<String> {
    help.map(|help| format!("in the shader: {help}"))
}

fn resource(shader: &Name, binding: &Binding, supplied: &[SuppliedResource], errors: &mut Vec<Diagnostic>) {
    let Some(there) = supplied.iter().find(|there| there.is_called(binding)) else {
        let help = in_the_shader(suggestion(&binding.name, supplied.iter().map(|there| &*there.name)))
            .or_else(|| Some(format!("what a pass gives belongs into set {PASS_SET}")));
        errors.push(Diagnostic { help, ..not_brought(shader, binding) });
        return;
    };
    let (Name { text: shader, span }, name) = (shader, &binding.name);
    let wanted = format!("shader `{shader}` uses `{name}` (set {}, binding {})", binding.set, binding.binding);
    let here = |message: String| {
        Diagnostic::new(Code::DRAW_SOURCE_LACKS, *span, message).choice(OutsideChoice::DrawInterfaces)
    };
    if let Some(UnbindableResource { what, instead, .. }) = binding.kind.unbindable() {
        errors.push(here(format!("{wanted} as {what}, which isn't supported")).help(instead));
    } else if (there.set, there.binding) != (binding.set, binding.binding) {
        let message = format!("{wanted}, but `{name}` is at set {}, binding {}", there.set, there.binding);
        errors.push(
            here(message)
                .help(format!("in the shader: write `layout(set = {}, binding = {})`", there.set, there.binding)),
        );
    } else if there.kind.is(&binding.kind) && binding.count() > there.count {
        let message =
            format!("{wanted} as an array of {}, and the draw source brings along {}", binding.count(), there.count);
        errors.push(here(message).help(format!("in the shader: declare at most {}", there.count)));
    } else if !there.is(binding) {
        errors.push(here(format!("{wanted} as something else than it is: {}", there.kind.words())));
    }
}

/// Reports what a shader reads of a set of the program's otherwise than it is.
fn of_program(shader: &Name, used: &ProgramResource, sets: &[ProgramSet], errors: &mut Vec<Diagnostic>) {
    let Some(set) = sets.iter().find(|set| set.set == used.set) else { return };
    let Some(misfit) = set.misfit(used) else { return };
    let message = format!("shader `{}` uses {}: {misfit}", shader.text, used.words());
    errors.push(Diagnostic::new(Code::PROGRAM_SET, shader.span, message).choice(OutsideChoice::DrawInterfaces));
}

/// Reports a custom pass that the program doesn't record.
pub(in crate::expand) fn custom(shaders: &CheckedShaders<'_>, pass: &language::Pass, errors: &mut Vec<Diagnostic>) {
    let Some(Name { text, span }) = pass.work.callback() else { return };
    let Some(known) = shaders.custom_passes() else { return };
    if !known.contains(text) {
        let message = format!("nobody records `{text}`, which the custom pass `{}` asks for", pass.name.text);
        let help = suggestion(text, known.iter().map(|known| &**known))
            .or_else(|| Some("the program that draws the pipeline records no custom passes".to_owned()));
        errors.push(Diagnostic { help, ..Diagnostic::new(Code::CUSTOM_UNKNOWN, *span, message) });
    }
}
