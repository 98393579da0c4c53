//! How a pass's shader is compiled: its declarations of sampled images may follow the images that the pass gives.

use super::interfaces::CheckedShaders;
use crate::base::Diagnostic;
use crate::expand::resources::{Resources, parts};
use crate::frame::{Image, Pass};
use crate::language::{self, Face};
use crate::ron::Name;
use crate::shader::Variant;
use crate::vulkan::{Aspects, Component, ImageShape, Subresources};
use std::sync::Arc;

/// The variant of its shader that a pass needs. Unknown images are left out: mistakes are reported elsewhere.
pub(in crate::expand) fn of(resources: &Resources<'_>, pass: &language::Pass) -> Variant {
    let texture = |sample: &language::Sample| {
        let image = &resources.image(sample.part.image.index)?.image;
        let range = parts::range(resources, &sample.part, &mut Vec::new());
        Some((sample.binding.text.clone(), texture(image, image.part(range), sample.face)))
    };
    let mut sampled: Vec<Arc<str>> = pass.sample.iter().map(|sample| sample.binding.text.clone()).collect();
    Variant::name_arrays(&mut sampled);
    let parts = in_part(resources, pass).map(|(binding, _)| binding.text.clone()).collect();
    let textures = pass.sample.iter().filter_map(texture).collect();
    let components = pass.sample.iter().filter_map(|sample| {
        let image = &resources.image(sample.part.image.index)?.image;
        Some((sample.binding.text.clone(), image.format.components()))
    });
    let components = components.collect();
    let bindings = (pass.sample.iter().map(|it| &it.binding))
        .chain(pass.storage.iter().map(|it| &it.binding))
        .chain(pass.uniform.iter().map(|it| &it.binding));
    let given = Variant::given_to(
        pass.shader().map_or("", |shader| &shader.text),
        bindings.map(|name| &name.text),
        pass.params.iter().map(|param| &param.name.text),
    );
    Variant {
        textures,
        sampled,
        components,
        parts,
        alpha_to_coverage: covers_samples(resources, pass),
        given,
        constants: Variant::constants(pass.constants.iter().map(|it| (&it.name.text, &it.value.value))),
        ..Variant::default()
    }
}

/// Images of a pass that its shader sees and that are only partly in use, each with the shader's name.
pub(super) fn in_part<'p>(
    resources: &'p Resources,
    pass: &'p language::Pass,
) -> impl Iterator<Item = (&'p Name, &'p language::ImagePart)> {
    let stored = pass.storage.iter().filter_map(|storage| match &storage.part {
        language::Part::Image(part) => Some((&storage.binding, part)),
        language::Part::Buffer(_) => None,
    });
    let seen = pass.sample.iter().map(|sample| (&sample.binding, &sample.part)).chain(stored);
    let allocated = |part: &language::ImagePart| resources.image(part.image.index)?.image.allocated;
    seen.filter(move |(_, part)| allocated(part).is_some())
}

/// Whether the alpha that a pass draws says how many samples are covered: its targets have several.
fn covers_samples(resources: &Resources<'_>, pass: &language::Pass) -> bool {
    let several = |color: &language::Color| {
        resources.image(color.part.image.index).is_some_and(|target| target.image.samples > 1)
    };
    pass.alpha_to_coverage.is_some() && pass.color.iter().any(several)
}

/// The variant that its shader would have if no condition left anything out; `None` where a sample that is left out has no
/// value that could tell.
pub(in crate::expand) fn with_all(resources: &Resources<'_>, pass: &language::Pass) -> Option<Variant> {
    let left_out = pass.left_out.iter().map(|left_out| left_out.sample.clone());
    let left_out: Vec<language::Sample> = left_out.collect::<Option<_>>()?;
    let whole = language::Pass { sample: [&pass.sample[..], &left_out].concat(), ..pass.clone() };
    Some(of(resources, &whole))
}

/// The texture type of a part of an image, in a shader that leaves the type to the pass.
fn texture(image: &Image, part: Subresources, face: Face) -> ImageShape {
    let stencil = part.aspects == Aspects::STENCIL;
    let component = if stencil { Component::Uint } else { Component::of(image.format) };
    let single_samples = match face {
        Face::Samples => true,
        // Single samples need no further draw.
        Face::Plain => image.format.is_depth(),
        Face::Resolved | Face::DepthOnly => false,
    };
    ImageShape::of(
        image.shape,
        part.base_layer..part.base_layer + part.layers,
        single_samples && image.samples > 1,
        component,
    )
}

/// Reports a shader that adapts to several samples, and is wrong where the device leaves its images one sample.
pub(in crate::expand) fn check_single_sampled(
    pass: &language::Pass,
    lowered: &Pass,
    variant: &Variant,
    shaders: &mut CheckedShaders<'_>,
    errors: &mut Vec<Diagnostic>,
) {
    let adapts = lowered.sampled.iter().any(|sampled| sampled.texture.is_some_and(|texture| texture.multisampled));
    if adapts || variant.alpha_to_coverage {
        let mut single = variant.clone();
        single.textures.iter_mut().for_each(|(_, texture)| texture.multisampled = false);
        single.alpha_to_coverage = false;
        shaders.interface(pass, &single, errors);
    }
}
