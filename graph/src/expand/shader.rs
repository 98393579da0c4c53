//! A pass and its shader meet: every name in set 0 is given, with the right shape, and every target is fed.

use super::Chosen;
use super::images::Resolved;
use crate::describe::{self, Diagnostic, Face, nearest, suggestion};
use crate::frame::{Draw, Sampled};
use crate::interface::{
    BindingKind, Component, Dimension, DrawInterface, ImageShape, PASS_SET, ShaderInterface, ShaderInterfaces,
    ShaderProblem,
};
use crate::vocabulary::{Filter, Subresources};
use std::collections::HashSet;
use std::sync::Arc;

/// The name of the block that a pass's parameters go to.
pub(super) const PARAMS: &str = "params";

/// Shader interfaces, each of whose mistakes is reported once.
pub(super) struct Checked<'s> {
    shaders: &'s mut dyn ShaderInterfaces,
    seen: HashSet<(Arc<str>, Draw)>,
    /// Shaders that have no interface, and why: one may draw several things.
    reported: Vec<(Arc<str>, ShaderProblem)>,
}

impl<'s> Checked<'s> {
    pub(super) fn new(shaders: &'s mut dyn ShaderInterfaces) -> Checked<'s> {
        Checked { shaders, seen: HashSet::new(), reported: Vec::new() }
    }

    /// The interface of a pass's shader. A shader that has none is reported where it is first named.
    pub(super) fn interface(&mut self, pass: &describe::Pass, errors: &mut Vec<Diagnostic>) -> Option<ShaderInterface> {
        let name = &pass.shader.text;
        match self.shaders.draw_shader(name, pass.draw) {
            Ok(interface) => Some(interface),
            Err(problem) => {
                let said = self.reported.iter().any(|(other, known)| other == name && *known == problem);
                if !said {
                    errors.push(report(pass, &problem));
                    self.reported.push((name.clone(), problem));
                }
                None
            }
        }
    }

    /// What whoever draws brings along, the first time that a shader draws this; then it is known to fit or not.
    pub(super) fn brought_along_first(&mut self, pass: &describe::Pass) -> Option<DrawInterface> {
        self.first_time(pass).then(|| self.shaders.brought_along(pass.draw))
    }

    fn first_time(&mut self, pass: &describe::Pass) -> bool {
        self.seen.insert((pass.shader.text.clone(), pass.draw))
    }
}

fn report(pass: &describe::Pass, problem: &ShaderProblem) -> Diagnostic {
    let (name, span) = (&pass.shader.text, pass.shader.span);
    match problem {
        ShaderProblem::Missing { looked_in, known } => {
            let mut help = suggestion(name, known.iter().map(String::as_str)).unwrap_or_default();
            if !looked_in.is_empty() {
                let break_line = if help.is_empty() { "" } else { "\n" };
                help = format!("{help}{break_line}looked for in {}", looked_in.join(", "));
            }
            let missing = Diagnostic::new(span, format!("there is no shader named `{name}`"));
            Diagnostic { help: (!help.is_empty()).then_some(help), ..missing }
        }
        ShaderProblem::DoesNotCompile { messages } => {
            Diagnostic::new(span, format!("shader `{name}` doesn't compile")).help(messages.join("\n"))
        }
        ShaderProblem::Unsupported { what } => Diagnostic::new(span, format!("shader `{name}` can't be used: {what}")),
    }
}

/// The images that a pass gives to its shader's set 0.
pub(super) fn sampled(
    chosen: &Chosen<'_>,
    images: &[Option<Resolved>],
    pass: &describe::Pass,
    interface: &ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) -> Vec<Sampled> {
    let shader = &pass.shader.text;
    let mut sampled = Vec::new();
    let mut misspelt = Vec::new();
    for sample in &pass.sample {
        let name = &sample.binding.text;
        let binding = interface.bindings.iter().find(|binding| binding.set == PASS_SET && binding.name == **name);
        let Some((binding, shape)) = binding.and_then(|binding| match binding.kind {
            BindingKind::SampledImage(shape) => Some((binding, shape)),
            _ => None,
        }) else {
            misspelt.extend(nearest(name, sampled_names(interface)));
            let unknown = format!("shader `{shader}` samples no image named `{name}`");
            let help = suggestion(name, sampled_names(interface))
                .or_else(|| Some(format!("shader `{shader}` samples no images at all in set {PASS_SET}")));
            errors.push(Diagnostic { help, ..Diagnostic::new(sample.binding.span, unknown) });
            continue;
        };
        let Some(image) = &images[sample.image.index.0 as usize] else { continue };
        shape_fits(chosen, pass, sample, shape, image, errors);
        let format = image.image.format;
        let nearest = format.is_depth() || format.is_integer() || shape.multisampled;
        let default = if nearest { Filter::Nearest } else { Filter::Linear };
        sampled.push(Sampled {
            binding: name.clone(),
            image: sample.image.index,
            range: Subresources::WHOLE,
            frames_ago: 0,
            span: sample.image.span,
            per_sample: shape.multisampled,
            own_pixel: false,
            filter: sample.filter.map_or(default, |filter| filter.value),
            stages: binding.stages,
        });
    }
    missing(pass, interface, &misspelt, errors);
    sampled
}

/// Names of images that a shader samples in set 0.
fn sampled_names(interface: &ShaderInterface) -> impl Iterator<Item = &str> + Clone {
    let of_pass = interface.bindings.iter().filter(|binding| binding.set == PASS_SET);
    of_pass.filter(|binding| matches!(binding.kind, BindingKind::SampledImage(_))).map(|binding| &*binding.name)
}

/// Reports what set 0 of the shader holds and the pass doesn't give, or only under a misspelt name.
fn missing(pass: &describe::Pass, interface: &ShaderInterface, misspelt: &[&str], errors: &mut Vec<Diagnostic>) {
    let shader = &pass.shader.text;
    for binding in interface.bindings.iter().filter(|binding| binding.set == PASS_SET) {
        let name = &binding.name;
        let what = match &binding.kind {
            BindingKind::SampledImage(_) if pass.sample.iter().any(|sample| *sample.binding.text == **name) => continue,
            BindingKind::SampledImage(_) if misspelt.contains(&&**name) => continue,
            BindingKind::SampledImage(_) => {
                let message =
                    format!("shader `{shader}` samples `{name}`, which pass `{}` doesn't give", pass.name.text);
                let help = format!("add `sample: {{\"{name}\": \"…\"}}`");
                errors.push(Diagnostic::new(pass.shader.span, message).help(help));
                continue;
            }
            BindingKind::UniformBlock(_) if name == PARAMS => continue,
            BindingKind::UniformBlock(_) => "a uniform block",
            BindingKind::StorageImage { .. } => "a storage image",
            BindingKind::StorageBlock { .. } => "a storage block",
            BindingKind::InputAttachment { .. } => "an input attachment",
            BindingKind::Other(what) => what,
        };
        let message = format!("shader `{shader}` has {what} named `{name}` in set {PASS_SET}, which a pass can't give");
        let help = format!("set {PASS_SET} holds sampled images and one uniform block named `{PARAMS}`");
        errors.push(Diagnostic::new(pass.shader.span, message).help(help));
    }
}

/// The image is what the shader's declaration says.
fn shape_fits(
    chosen: &Chosen<'_>,
    pass: &describe::Pass,
    sample: &describe::Sample,
    shape: ImageShape,
    image: &Resolved,
    errors: &mut Vec<Diagnostic>,
) {
    let (shader, name) = (&pass.shader.text, &sample.binding.text);
    let declared = chosen.image(sample.image.index);
    let (image_name, format) = (&image.image.name, image.image.format);
    if shape.dimension != Dimension::D2 || shape.arrayed {
        let message = format!("shader `{shader}` declares `{name}` as {}", shape_words(shape));
        errors.push(Diagnostic::new(sample.binding.span, message).help("images of a pipeline are two-dimensional"));
        return;
    }
    let holds = Component::of(format);
    if shape.component != holds {
        let (wanted, held) = (component_words(shape.component), component_words(holds));
        let message =
            format!("shader `{shader}` reads {wanted} from `{name}`, but `{image_name}` holds {held} ({format})");
        errors.push(Diagnostic::new(sample.image.span, message).label(declared.format.span, "its format"));
    }
    let contradicts = match sample.face {
        Face::Samples if !shape.multisampled => Some(("single samples", "one value a texel", "sampler2D")),
        Face::Resolved if shape.multisampled => Some(("one value a texel", "single samples", "sampler2DMS")),
        _ => None,
    };
    if let Some((given, wanted, declaration)) = contradicts {
        let message =
            format!("pass `{}` gives {given} of `{image_name}`, but shader `{shader}` reads {wanted}", pass.name.text);
        let help =
            format!("`{name}` is a `{declaration}` in the shader; the plain name `\"{image_name}\"` fits either");
        errors.push(Diagnostic::new(sample.image.span, message).help(help));
    } else if shape.multisampled && image.image.samples == 1 {
        let message = format!(
            "shader `{shader}` reads single samples of `{name}`, but `{image_name}` has {}",
            image.samples_words()
        );
        let fewer = "declare it `sampler2D` in the shader, or give the image more samples";
        errors
            .push(Diagnostic::new(sample.image.span, message).label(declared.samples.span, "its samples").help(fewer));
    }
    if let Some(filter) = sample.filter
        && filter.value == Filter::Linear
    {
        let why = match () {
            () if format.is_integer() => format!("`{image_name}` holds integers ({format})"),
            () if shape.multisampled => format!("shader `{shader}` reads single samples of it"),
            () => return,
        };
        errors.push(Diagnostic::new(filter.span, format!("a linear filter can't be used: {why}")));
    }
}

/// Every colour target is fed by an output of the same type.
pub(super) fn outputs(
    images: &[Option<Resolved>],
    pass: &describe::Pass,
    interface: &ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) {
    let shader = &pass.shader.text;
    for (location, target) in (0..).zip(&pass.color) {
        let Some(image) = &images[target.image.index.0 as usize] else { continue };
        let (name, format) = (&image.image.name, image.image.format);
        let Some(output) = interface.outputs.iter().find(|output| output.location == location) else {
            let message = format!("shader `{shader}` has no output at location {location} for `{name}`");
            let help = match interface.outputs.len() {
                0 => "it writes no colour at all".to_owned(),
                1 => "it writes one colour".to_owned(),
                count => format!("it writes {count} colours"),
            };
            errors.push(Diagnostic::new(target.image.span, message).help(help));
            continue;
        };
        let holds = Component::of(format);
        if output.component != holds {
            let (written, held) = (component_words(output.component), component_words(holds));
            let message = format!(
                "shader `{shader}` writes {written} to `{}`, but `{name}` holds {held} ({format})",
                output.name
            );
            errors.push(Diagnostic::new(target.image.span, message));
        } else if output.components < format.components() {
            let message = format!(
                "shader `{shader}` writes {} of the {} components of `{name}` ({format}): the others would be undefined",
                output.components,
                format.components()
            );
            errors.push(Diagnostic::new(target.image.span, message));
        }
    }
}

fn component_words(component: Component) -> &'static str {
    match component {
        Component::Float => "floating point",
        Component::Int => "signed integers",
        Component::Uint => "unsigned integers",
    }
}

fn shape_words(shape: ImageShape) -> &'static str {
    match (shape.dimension, shape.arrayed) {
        (Dimension::D1, _) => "one-dimensional",
        (Dimension::D2, true) => "an array of layers",
        (Dimension::D2, false) => "two-dimensional",
        (Dimension::D3, _) => "three-dimensional",
        (Dimension::Cube, _) => "a cube",
        (Dimension::Buffer, _) => "a texel buffer",
    }
}
