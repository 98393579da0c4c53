//! Images and buffers that a shader reads and writes by itself, against its declarations.

use super::interfaces::{declared_otherwise, shape_words};
use super::{arrays, parts_in_use, sampled_images};
use crate::base::{Code, Diagnostic, Span, nearest, suggestion};
use crate::expand::resources::{Resources, parts};
use crate::frame::{BufferRole, BufferUse, Eye, Image, Pass, Resource, Storage};
use crate::language::{self, Part};
use crate::ron::Name;
use crate::shader::{Binding, BindingKind, PARAMS, PASS_SET, ShaderInterface};
use crate::vulkan::{Component, Format, ImageShape, Numeric, Stages, Subresources};
use std::sync::Arc;

/// The stages that use the shader's resource `name`; in passes that the embedding program records, the stages that may.
pub(in crate::expand) fn stages(interface: Option<&ShaderInterface>, name: &str, raster: bool) -> Stages {
    let Some(interface) = interface else {
        let drawn = Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER;
        return if raster { drawn } else { Stages::COMPUTE_SHADER };
    };
    of_pass(interface, name).map_or(Stages::empty(), |binding| binding.stages)
}

fn of_pass<'a>(interface: &'a ShaderInterface, name: &str) -> Option<&'a Binding> {
    arrays::binding(interface, name)
}

/// Whether a storage image or buffer is read and written: as the file says, else as the shader's declaration allows. Without
/// either, it is written. Contents of an earlier frame are only read.
fn access(storage: &language::Storage, interface: Option<&ShaderInterface>) -> (bool, bool) {
    if storage.part.previous().is_some() {
        return (true, false);
    }
    match storage.access.map(|access| access.value) {
        Some(access) => (access.reads(), access.writes()),
        None => {
            let declared = interface.and_then(|interface| of_pass(interface, &storage.binding.text));
            declared.and_then(|binding| binding.kind.storage()).unwrap_or((false, true))
        }
    }
}

/// Lets the writes of a pass that the file says nothing of keep what is there, where `holds` says that there is something.
/// Returns what they keep.
pub(in crate::expand) fn keep(
    described: &language::Pass,
    pass: &mut Pass,
    holds: impl Fn(Resource, Subresources) -> bool,
) -> Vec<KeptContents> {
    let mut kept = Vec::new();
    for storage in described.storage.iter().filter(|storage| storage.access.is_none()) {
        let language::ResourceRef { resource: of, span } = storage.part.resource();
        let name = &storage.binding.text;
        let (read, write, range) = match of {
            Resource::Image(_) => {
                let Some(used) = pass.storage.iter_mut().find(|used| used.binding == *name) else { continue };
                (&mut used.read, used.write, used.range)
            }
            Resource::Buffer(_) => {
                let mut buffers = pass.buffers.iter_mut();
                let Some(used) = buffers.find(|used| used.binding.as_ref() == Some(name)) else { continue };
                let Some((read, write)) = used.role.storage_mut() else { continue };
                (read, write, Subresources::WHOLE)
            }
        };
        if write && !*read && holds(of, range) {
            *read = true;
            kept.push(KeptContents { of, span, binding: name.clone() });
        }
    }
    kept
}

/// Adds a storage image or buffer to the frame's pass.
pub(in crate::expand) fn lower(
    resources: &Resources<'_>,
    storage: &language::Storage,
    interface: Option<&ShaderInterface>,
    raster: bool,
    lowered: &mut Pass,
    errors: &mut Vec<Diagnostic>,
) {
    let binding = storage.binding.text.clone();
    let (read, write) = access(storage, interface);
    let stages = stages(interface, &binding, raster);
    match &storage.part {
        Part::Buffer(part) => {
            let used = used(part, Some(binding), BufferRole::Storage { read, write }, stages);
            lowered.buffers.push(used);
        }
        Part::Image(part) => {
            let range = parts::range(resources, part, errors);
            let (image, span) = (part.image.index, part.image.span);
            let one_for_both = resources.image(image).is_some_and(|image| image.image.eyes.is_some());
            let eye = part.eye.filter(|_| one_for_both).map(|eye| eye.value);
            // The left eye's pass runs just before, and what it wrote into its own layer stays.
            let read = read || write && eye == Some(Eye::Right);
            lowered.storage.push(Storage { binding, image, range, span, read, write, eye, stages });
        }
    }
}

/// Names of storage images, storage blocks and uniform blocks that a shader has.
fn names(interface: &ShaderInterface) -> impl Iterator<Item = &str> + Clone {
    let of_pass = interface.bindings.iter().filter(|binding| binding.set == PASS_SET && binding.name != PARAMS);
    let fits = |kind: &BindingKind| kind.storage().is_some() || kind.uniform_block().is_some();
    of_pass.filter(move |binding| fits(&binding.kind)).map(|binding| &*binding.name)
}

/// Reports storage that doesn't fit the shader's declarations. Returns names that were probably meant by misspelt ones.
pub(in crate::expand) fn check<'i>(
    resources: &Resources<'_>,
    pass: &language::Pass,
    lowered: &Pass,
    interface: &'i ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) -> Vec<&'i str> {
    let shader = pass.shader().map_or("", |shader| &*shader.text);
    let mut misspelt = Vec::new();
    let mut unknown = |name: &Name, what: &str, errors: &mut Vec<Diagnostic>| {
        if let Some((declared, wrong)) = arrays::misfit(shader, interface, name) {
            misspelt.push(declared);
            errors.extend(wrong);
            return;
        }
        let message = format!("shader `{shader}` has {what} named `{}`", name.text);
        if let Some(otherwise) = declared_otherwise(interface, &name.text) {
            misspelt.extend(of_pass(interface, &name.text).map(|binding| &*binding.name));
            errors.extend(otherwise.map(|help| Diagnostic::new(Code::UNKNOWN_BINDING, name.span, message).help(help)));
            return;
        }
        misspelt.extend(nearest(&name.text, names(interface)));
        let help = suggestion(&name.text, names(interface))
            .or_else(|| Some(format!("shader `{shader}` has none at all in set {PASS_SET}")));
        errors.push(Diagnostic { help, ..Diagnostic::new(Code::UNKNOWN_BINDING, name.span, message) });
    };
    for storage in &pass.storage {
        let name = &storage.binding;
        let kind = of_pass(interface, &name.text).map(|binding| &binding.kind);
        match (&storage.part, kind) {
            (Part::Image(part), Some(BindingKind::StorageImage { shape, format, .. })) => {
                let Some(image) = resources.image(part.image.index).map(|image| &image.image) else { continue };
                let Some(given) = lowered.storage.iter().find(|given| given.binding == name.text) else { continue };
                let check = ImageCheck { resources, shader, name: &name.text, image, part };
                check.fits(given.range, *shape, *format, errors);
                // What is stored beyond the part nobody sees.
                if image.allocated.is_some() && kind.and_then(BindingKind::storage).is_some_and(|(reads, _)| reads) {
                    let by = parts_in_use::extent_of_part(shader, &name.text);
                    errors.extend(parts_in_use::not_asked(
                        resources,
                        interface,
                        (shader, &name.text, part),
                        ["reads", &by],
                    ));
                }
            }
            (Part::Buffer(part), Some(BindingKind::StorageBlock { bytes, .. })) => {
                let what = format!("the members of the block `{}`", name.text);
                let (buffer, span) = (&part.buffer, part.buffer.span);
                resources.holds(buffer, u64::from(*bytes), &what, span, errors);
            }
            (Part::Image(_), _) => {
                unknown(name, "no storage image", errors);
                continue;
            }
            (Part::Buffer(_), _) => {
                unknown(name, "no storage block", errors);
                continue;
            }
        }
        if let Some((readable, writable)) = kind.and_then(BindingKind::storage) {
            access_fits(shader, storage, readable, writable, errors);
        }
    }
    for uniform in &pass.uniform {
        let name = &uniform.binding;
        match of_pass(interface, &name.text).and_then(|binding| binding.kind.uniform_block()) {
            Some(block) if *name.text != *PARAMS => {
                let what = format!("the members of the block `{}`", name.text);
                let (buffer, span) = (&uniform.part.buffer, uniform.part.buffer.span);
                resources.holds(buffer, u64::from(block.bytes), &what, span, errors);
            }
            Some(_) => {
                let message = format!("the block `{PARAMS}` takes the pass's parameters, not a buffer");
                errors.push(
                    Diagnostic::new(Code::PARAMS_AS_BUFFER, name.span, message)
                        .help(format!("leave it out; parameters are given by `{PARAMS}: {{\"…\": …}}`")),
                );
            }
            None => unknown(name, "no uniform block", errors),
        }
    }
    misspelt
}

fn access_fits(
    shader: &str,
    storage: &language::Storage,
    readable: bool,
    writable: bool,
    errors: &mut Vec<Diagnostic>,
) {
    let name = &storage.binding.text;
    if storage.part.previous().is_some() && writable {
        let message = format!("shader `{shader}` may write `{name}`, but what an earlier frame left can only be read");
        let help = "declare it `readonly` in the shader";
        errors.push(Diagnostic::new(Code::EARLIER_FRAME, storage.binding.span, message).help(help));
        return;
    }
    let Some(access) = storage.access else { return };
    let (message, help) = match (access.value.writes(), writable) {
        (false, true) => ("may write", "declare it `readonly` in the shader, or say `ReadWrite`"),
        (true, false) => ("only reads", "remove `readonly` in the shader, or say `Read`"),
        (false, false) if !readable => ("doesn't read", "remove `writeonly` in the shader"),
        // A write in some places keeps the others: a shader that can't read may say `ReadWrite`.
        (true, true) | (false, false) => return,
    };
    errors.push(
        Diagnostic::new(Code::STORAGE_ACCESS, access.span, format!("shader `{shader}` {message} `{name}`")).help(help),
    );
}

struct ImageCheck<'a> {
    resources: &'a Resources<'a>,
    shader: &'a str,
    name: &'a str,
    image: &'a Image,
    part: &'a language::ImagePart,
}

impl ImageCheck<'_> {
    fn fits(&self, range: Subresources, shape: ImageShape, format: Option<Format>, errors: &mut Vec<Diagnostic>) {
        let (shader, name, image) = (self.shader, self.name, self.image);
        let declared = self.resources.declared(self.part.image.index);
        let span = parts::place(self.part);
        let part = image.part(range);
        if sampled_images::dimension(shader, name, shape, image, span, declared.shape.span, errors) {
            return;
        }
        if let Some(message) = sampled_images::layers_fit(shape, part.layers) {
            let message = format!("shader `{shader}` declares `{name}` as {}, {message}", shape_words(shape));
            errors.push(Diagnostic::new(Code::DIMENSION, span, message));
        }
        if part.mips != 1 {
            return errors.push(parts::several_levels(self.resources, self.part, image, "the shader accesses"));
        }
        let here = |code: Code, message: String| {
            Diagnostic::new(code, self.part.image.span, message).label(declared.format.span, "its format")
        };
        if image.format.is_depth() || image.format.numeric() == Numeric::Srgb {
            let what = if image.format.is_depth() { "depth" } else { "sRGB colour" };
            let message = format!("`{}` holds {what} ({}), which no shader can store", image.name, image.format);
            errors.push(
                here(Code::STORAGE_IMAGE, message)
                    .help("store into an image of another format, and copy, blit or draw from there"),
            );
            return;
        }
        if image.samples > 1 || shape.multisampled {
            let message = format!("`{}` has {} samples; shaders store one value a texel", image.name, image.samples);
            let wrong = Diagnostic::new(Code::STORAGE_IMAGE, self.part.image.span, message);
            errors.push(wrong.label(declared.samples.span, "its samples"));
            return;
        }
        let holds = Component::of(image.format);
        if shape.component != holds {
            let (wanted, held) = (shape.component.words(), holds.words());
            let message = format!(
                "shader `{shader}` takes `{name}` for {wanted}, but `{}` holds {held} ({})",
                image.name, image.format
            );
            errors.push(here(Code::COMPONENT_TYPE, message));
        } else if let Some(format) = format
            && format != image.format
        {
            let message =
                format!("shader `{shader}` declares `{name}` as {format}, but `{}` is {}", image.name, image.format);
            errors.push(
                here(Code::STORAGE_IMAGE, message).help("the format in the shader's `layout(…)` is the image's own"),
            );
        }
    }
}

/// One use of a buffer.
pub(in crate::expand) fn used(
    part: &language::BufferPart,
    binding: Option<Arc<str>>,
    role: BufferRole,
    stages: Stages,
) -> BufferUse {
    BufferUse {
        binding,
        buffer: part.buffer.index,
        frames_ago: part.previous.map_or(0, |previous| previous.value),
        span: part.buffer.span,
        role,
        stages,
    }
}

/// An image or buffer that a storage write keeps, and where it is named.
pub(in crate::expand) struct KeptContents {
    pub(in crate::expand) of: Resource,
    pub(in crate::expand) span: Span,
    /// The name in the shader.
    pub(in crate::expand) binding: Arc<str>,
}
