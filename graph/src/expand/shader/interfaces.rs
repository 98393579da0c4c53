//! A pass and its shader meet: shaders are found, and their needs are given.

use super::{arrays, params};
use crate::base::{Code, Diagnostic, FilePath, Sources};
use crate::frame::{Draw, Remark};
use crate::language::{self, Work};
use crate::ron::Name;
use crate::shader::{
    Binding, BindingKind, DrawInterface, PARAMS, PASS_SET, ProgramSet, ShaderInterface, ShaderInterfaces,
    ShaderProblem, UnbindableResource, Variant,
};
use crate::vulkan::{Dimension, ImageShape};
use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// The most bindings that are searched one by one; among more, a name is looked up.
const MANY_GIVEN: usize = 16;

/// A draw, if it is one, and the name of what the program records, if it is that.
type Asked = (Option<Draw>, Option<Arc<str>>);

/// Shader interfaces, each of whose mistakes is reported once.
pub(in crate::expand) struct CheckedShaders<'s> {
    shaders: &'s mut dyn ShaderInterfaces,
    sources: &'s Sources,
    seen: HashSet<(Arc<str>, Option<Draw>)>,
    /// What the draw source brings along for each draw that was asked about (`None`: for compute shaders), and of custom passes for each
    /// name.
    brought: RefCell<HashMap<Asked, Arc<DrawInterface>>>,
    /// The sets that the program binds itself.
    program_sets: Vec<ProgramSet>,
    /// Shaders that have no interface, and why: one may draw several things.
    reported: Vec<(Arc<str>, ShaderProblem)>,
    /// The path of the file that names a shader, if it is unknown.
    nowhere: FilePath,
    /// What is allowed in shaders, and probably a mistake.
    pub(in crate::expand) remarks: Vec<Remark>,
}

impl<'s> CheckedShaders<'s> {
    /// `sources` are the files that name the shaders.
    pub(in crate::expand) fn new(shaders: &'s mut dyn ShaderInterfaces, sources: &'s Sources) -> CheckedShaders<'s> {
        CheckedShaders {
            program_sets: shaders.program_sets(),
            shaders,
            sources,
            seen: HashSet::new(),
            brought: RefCell::default(),
            reported: Vec::new(),
            nowhere: "".into(),
            remarks: Vec::new(),
        }
    }

    /// Which shader a pass has, if it has one and it is found. One that isn't is reported where it is first named.
    pub(in crate::expand) fn find(&mut self, pass: &language::Pass, errors: &mut Vec<Diagnostic>) -> Option<Arc<str>> {
        let (shader, draw) = named(pass)?;
        // The program knows its draws by the name as it is written.
        if draw.is_some_and(Draw::is_custom) {
            return Some(shader.text.clone());
        }
        let from = shader.span.file().and_then(|file| self.sources.file(file)).map(|file| &file.path);
        let found = self.shaders.find(from.unwrap_or(&self.nowhere), &shader.text, draw);
        self.known(shader, &shader.text, found, errors)
    }

    /// The interface of a pass's shader, compiled as `variant` says, if it has one. A shader that can't be had is reported
    /// where it is first named.
    pub(in crate::expand) fn interface(
        &mut self,
        pass: &language::Pass,
        variant: &Variant,
        errors: &mut Vec<Diagnostic>,
    ) -> Option<ShaderInterface> {
        let path = self.find(pass, errors)?;
        self.found_interface(pass, &path, variant, errors)
    }

    /// As [`CheckedShaders::interface`], of a shader that was found.
    pub(in crate::expand) fn found_interface(
        &mut self,
        pass: &language::Pass,
        path: &Arc<str>,
        variant: &Variant,
        errors: &mut Vec<Diagnostic>,
    ) -> Option<ShaderInterface> {
        let (shader, draw) = named(pass)?;
        let found = match draw {
            Some(draw) => self.shaders.draw_shader(path, draw, variant),
            None => self.shaders.compute_shader(path, variant),
        };
        // The program draws with a pipeline of its own then.
        if draw.is_some_and(Draw::is_custom) && matches!(found, Err(ShaderProblem::Missing { .. })) {
            return None;
        }
        self.known(shader, path, found, errors)
    }

    /// The interface of a shader that draws, compiled as `variant` says; its problem is reported by the caller.
    pub(in crate::expand) fn drawn(
        &mut self,
        shader: &str,
        draw: Draw,
        variant: &Variant,
    ) -> Result<ShaderInterface, ShaderProblem> {
        self.shaders.draw_shader(shader, draw, variant)
    }

    /// The result of looking up a shader; `None` after a problem, which is reported once.
    fn known<T>(
        &mut self,
        shader: &Name,
        path: &Arc<str>,
        found: Result<T, ShaderProblem>,
        errors: &mut Vec<Diagnostic>,
    ) -> Option<T> {
        match found {
            Ok(found) => Some(found),
            Err(problem) => {
                let said = self.reported.iter().any(|(other, known)| other == path && *known == problem);
                if !said {
                    errors.push(problem.at(&shader.text, shader.span));
                    self.reported.push((path.clone(), problem));
                }
                None
            }
        }
    }

    /// The interface that the draw source provides, the first time that a shader draws this or is dispatched. Later it is known
    /// to fit or not.
    pub(super) fn brought_along_first(&mut self, pass: &language::Pass, path: &Arc<str>) -> Option<Arc<DrawInterface>> {
        let (_, draw) = named(pass)?;
        let first = self.seen.insert((path.clone(), draw));
        first.then(|| self.brought_along(pass)).flatten()
    }

    /// The interface that the draw source provides to a pass with a shader.
    pub(in crate::expand) fn brought_along(&self, pass: &language::Pass) -> Option<Arc<DrawInterface>> {
        let (name, draw) = named(pass)?;
        let of = (draw, draw.is_some_and(Draw::is_custom).then(|| name.text.clone()));
        let mut known = self.brought.borrow_mut();
        let brought = known.entry(of).or_insert_with(|| Arc::new(self.shaders.brought_along(draw, &name.text)));
        Some(brought.clone())
    }

    /// Whether the draw source brings attributes by instance along for what a pass draws.
    pub(in crate::expand) fn draws_by_instance(&self, pass: &language::Pass) -> bool {
        let brought = named(pass).and_then(|(_, draw)| draw).and_then(|_| self.brought_along(pass));
        brought.is_some_and(|it| it.vertex_buffers.iter().any(|buffer| buffer.rate.is_by_instance()))
    }

    /// As [`ShaderInterfaces::program_sets`].
    pub(super) fn program_sets(&self) -> &[ProgramSet] {
        &self.program_sets
    }

    /// As [`ShaderInterfaces::custom_passes`].
    pub(super) fn custom_passes(&self) -> Option<Vec<Arc<str>>> {
        self.shaders.custom_passes()
    }
}

/// The shader that a pass names, and the draw; a draw of `None`: it is a compute shader.
fn named(pass: &language::Pass) -> Option<(&Name, Option<Draw>)> {
    match &pass.work {
        Work::Draw { shader, draw, .. } => Some((shader, Some(*draw))),
        Work::Dispatch { shader, .. } => Some((shader, None)),
        Work::Custom { callback, .. } if pass.is_drawn() => Some((callback, Some(Draw::Custom))),
        Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } | Work::Custom { .. } => None,
    }
}

/// Reports bindings in set 0 of the shader that the pass doesn't give, or only under a misspelt name.
pub(in crate::expand) fn missing(
    pass: &language::Pass,
    interface: &ShaderInterface,
    misspelt: &[&str],
    errors: &mut Vec<Diagnostic>,
) {
    let Some(Name { text: shader, span }) = pass.shader() else { return };
    let given = || {
        (pass.sample.iter().map(|sample| &*sample.binding.text))
            .chain(pass.storage.iter().map(|storage| &*storage.binding.text))
            .chain(pass.uniform.iter().map(|uniform| &*uniform.binding.text))
    };
    // Few are compared one by one, many are looked up.
    let many: HashSet<&str> = if given().nth(MANY_GIVEN).is_some() { given().collect() } else { HashSet::new() };
    let is_given = |name: &str| if many.is_empty() { given().any(|given| given == name) } else { many.contains(name) };
    // They are told as one mistake.
    let rivals = params::rivals(pass, interface);
    let of_pass = interface.bindings.iter().filter(|binding| binding.set == PASS_SET);
    for binding in of_pass.filter(|binding| !rivals.contains(&&*binding.name)) {
        let name = &binding.name;
        if let Some(UnbindableResource { what, instead, place }) = binding.kind.unbindable() {
            let at = place.as_ref().map_or_else(String::new, |place| format!(" ({place})"));
            let message = format!("shader `{shader}` declares `{name}` as {what}{at}, which isn't supported");
            errors.push(Diagnostic::new(Code::SHADER_UNFIT, *span, message).help(instead));
            continue;
        }
        let missing = (0..binding.count()).find(|number| !is_given(&binding.element(*number)));
        let Some(missing) = missing.filter(|_| !misspelt.contains(&&**name)) else { continue };
        let Some((kind, _, field)) = given_in(binding) else { continue };
        let verb = match (&binding.kind, kind.split_once(' ')) {
            (BindingKind::InputAttachment { .. }, Some((_, kind))) => format!("reads the {kind}"),
            (BindingKind::SampledImage(_) | BindingKind::ComparedDepth(_), _) | (_, None) => "samples".to_owned(),
            (_, Some((_, kind))) => format!("uses the {kind}"),
        };
        let element = binding.element(missing);
        let message = format!("shader `{shader}` {verb} `{element}`, which pass `{}` doesn't give", pass.name.text);
        let entry = arrays::form(binding);
        errors.push(match arrays::last_before(pass, binding, missing) {
            Some(last) => {
                let help = format!("`{name}` is an array of {}: `{entry}`", binding.count());
                Diagnostic::new(Code::BINDING_MISSING, last, message)
                    .remark("the last before it")
                    .label(*span, "the shader")
                    .help(help)
            }
            None => Diagnostic::new(Code::BINDING_MISSING, *span, message).help(format!("add `{field}: {{{entry}}}`")),
        });
    }
}

/// The kind of a binding in the pass's own set, the thing that it takes, and the field that gives the thing. `None`: no field.
fn given_in(binding: &Binding) -> Option<(&'static str, &'static str, &'static str)> {
    match &binding.kind {
        BindingKind::UniformBlock(_) if binding.name == PARAMS => None,
        BindingKind::SampledImage(_) | BindingKind::ComparedDepth(_) => Some(("a sampled image", "an image", "sample")),
        BindingKind::InputAttachment { .. } => Some(("an input attachment", "an image", "sample")),
        BindingKind::StorageImage { .. } => Some(("a storage image", "an image", "storage")),
        BindingKind::StorageBlock { .. } => Some(("a storage block", "a buffer", "storage")),
        BindingKind::UniformBlock(_) => Some(("a uniform block", "a buffer", "uniform")),
        BindingKind::Sampler { .. } | BindingKind::Other(_) => None,
    }
}

/// The help for a name that a pass gives in the wrong field, if the shader declares it for another field. `Some(None)`: no
/// field can give it, which is reported with the shader.
pub(super) fn declared_otherwise(interface: &ShaderInterface, name: &str) -> Option<Option<String>> {
    let binding = arrays::binding(interface, name)?;
    if binding.kind.unbindable().is_some() {
        return Some(None);
    }
    if let Some((images, _)) = binding.kind.sampler() {
        let images = images.iter().map(|image| format!("`{image}`")).collect::<Vec<_>>().join(", ");
        return Some(Some(format!(
            "`{name}` is a sampler in the shader: leave it out; what is said of {images} counts"
        )));
    }
    let (kind, thing, field) = given_in(binding)?;
    Some(Some(format!("`{name}` is {kind} in the shader: give it {thing} in `{field}`")))
}

/// The image type in words.
pub(super) fn shape_words(shape: ImageShape) -> &'static str {
    match (shape.dimension, shape.arrayed) {
        (Dimension::D1, _) => "one-dimensional",
        (Dimension::D2, true) => "an array of layers",
        (Dimension::D2, false) => "two-dimensional",
        (Dimension::D3, _) => "three-dimensional",
        (Dimension::Cube, false) => "a cube",
        (Dimension::Cube, true) => "an array of cubes",
        (Dimension::Buffer, _) => "a texel buffer",
    }
}
