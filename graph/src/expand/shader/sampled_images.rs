//! Images that a shader samples: the parts that the pass gives, against the shader's declarations.

use super::interfaces::{declared_otherwise, shape_words};
use super::{arrays, compared_depth, parts_in_use, storage};
use crate::base::{Code, Diagnostic, nearest, suggestion};
use crate::expand::resources::{FrameImage, Resources, parts};
use crate::frame::check::targets::size_words;
use crate::frame::{self, EyeForm, Pass, SampledImage};
use crate::language::{self, Face};
use crate::shader::{BindingKind, PASS_SET, ShaderInterface, element_of};
use crate::vulkan::{
    AddressMode, Aspects, BorderColor, Component, Dimension, Filter, Format, ImageShape, Sampler, Shape, Subresources,
};

/// A sampled image as its shader declares it.
#[derive(Clone, Copy)]
struct DeclaredImage {
    shape: ImageShape,
    /// Whether the shader leaves the declared type to the pass.
    adapts: bool,
    /// Whether it is an input attachment, even where no local read is asked for.
    input: bool,
    /// Whether it is compared with a depth.
    compares: bool,
}

/// The shader's declaration of the sampled image `name`.
fn declared(interface: &ShaderInterface, name: &str) -> Option<DeclaredImage> {
    let binding = arrays::binding(interface, name)?;
    let adapts = binding.adapts;
    match binding.kind {
        BindingKind::SampledImage(shape) => Some(DeclaredImage { shape, adapts, input: false, compares: false }),
        BindingKind::ComparedDepth(shape) => Some(DeclaredImage { shape, adapts, input: false, compares: true }),
        BindingKind::InputAttachment { multisampled, component } => {
            let shape = ImageShape { dimension: Dimension::D2, arrayed: false, multisampled, component };
            Some(DeclaredImage { shape, adapts: false, input: true, compares: false })
        }
        BindingKind::StorageImage { .. }
        | BindingKind::Sampler { .. }
        | BindingKind::UniformBlock(_)
        | BindingKind::StorageBlock { .. }
        | BindingKind::Other(_) => None,
    }
}

/// Names of images that a shader samples.
fn names(interface: &ShaderInterface) -> impl Iterator<Item = &str> + Clone {
    let of_pass = interface.bindings.iter().filter(|binding| binding.set == PASS_SET);
    let sampled = |kind: &BindingKind| kind.is_sampled() || kind.is_input_attachment();
    of_pass.filter(move |binding| sampled(&binding.kind)).map(|binding| &*binding.name)
}

/// A sampled image of the frame. `None` if the image or the shader's name isn't known; mistakes are reported elsewhere.
pub(in crate::expand) fn lower(
    resources: &Resources<'_>,
    sample: &language::Sample,
    mut range: Subresources,
    interface: Option<&ShaderInterface>,
    raster: bool,
) -> Option<SampledImage> {
    let image = &resources.image(sample.part.image.index)?.image;
    let name = &sample.binding.text;
    let declared = match interface {
        Some(interface) => Some(declared(interface, name)?),
        None => None,
    };
    let shape = declared.map(|known| known.shape);
    let both = Aspects::DEPTH | Aspects::STENCIL;
    if range.aspects.is_empty() && image.format.aspects() == both {
        // A shader that reads integers of depth and stencil wants the stencil.
        let integers = shape.is_some_and(|shape| shape.component != Component::Float);
        range.aspects = if integers { Aspects::STENCIL } else { Aspects::DEPTH };
    }
    let per_sample = shape.map_or(sample.face == Face::Samples, |shape| shape.multisampled);
    let face = match (per_sample, sample.face) {
        (true, _) => frame::Face::Samples,
        (false, Face::DepthOnly) => frame::Face::DepthOnly,
        (false, Face::Plain | Face::Samples | Face::Resolved) => frame::Face::Resolved,
    };
    let exact = image.format.is_depth() || image.format.is_integer() || per_sample;
    let default = if exact { Filter::Nearest } else { Filter::Linear };
    let texture = declared.filter(|known| known.adapts).map(|known| known.shape);
    Some(SampledImage {
        binding: name.clone(),
        image: sample.part.image.index,
        range,
        frames_ago: sample.part.previous.map_or(0, |previous| previous.value),
        span: sample.part.image.span,
        eye: sample.part.eye.filter(|_| image.eyes.is_some()).map(|eye| eye.value),
        face,
        texture,
        own_pixel: sample.own_pixel.is_some_and(|own| own.value && element_of(name).is_none()),
        sampler: sampler(sample, texture, default, image.format),
        stages: storage::stages(interface, name, raster),
    })
}

/// The sampler that the file chooses, else one that ends at the image's edges and takes the nearest mip level.
fn sampler(sample: &language::Sample, texture: Option<ImageShape>, filter: Filter, format: Format) -> Sampler {
    // Where a shader that adapts reads single samples there is nothing between them.
    if texture.is_some_and(|texture| texture.multisampled) {
        return Sampler::new(Filter::Nearest);
    }
    let usual = Sampler::new(sample.filter.map_or(filter, |filter| filter.value));
    let address = sample.address.map_or(usual.address, |address| address.value);
    let borders = address == AddressMode::ClampToBorder;
    let language::SamplerState { border, reduction, anisotropy, lod_bias, min_lod, max_lod } = sample.state;
    Sampler {
        filter: usual.filter,
        mips: sample.mip_filter.map_or(usual.mips, |mips| mips.value),
        address,
        compare: sample.compare.map(|compare| compare.value),
        border: border.or_else(|| borders.then(|| BorderColor::transparent(format))),
        reduction: reduction.unwrap_or_default(),
        anisotropy: anisotropy.unwrap_or(usual.anisotropy),
        lod_bias: lod_bias.unwrap_or(usual.lod_bias),
        min_lod: min_lod.unwrap_or(usual.min_lod),
        max_lod,
    }
}

/// Reports images that don't fit the shader's declarations. Returns names that were probably meant by misspelt ones.
pub(in crate::expand) fn check<'i>(
    resources: &Resources<'_>,
    pass: &language::Pass,
    lowered: &Pass,
    interface: &'i ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) -> Vec<&'i str> {
    let shader = pass.shader().map_or("", |shader| &*shader.text);
    let mut misspelt = Vec::new();
    for sample in &pass.sample {
        let name = &sample.binding.text;
        let Some(declared) = declared(interface, name) else {
            if let Some((declared, wrong)) = arrays::misfit(shader, interface, &sample.binding) {
                misspelt.push(declared);
                errors.extend(wrong);
                continue;
            }
            let unknown = format!("shader `{shader}` samples no image named `{name}`");
            if let Some(otherwise) = declared_otherwise(interface, name) {
                let binding = arrays::binding(interface, name);
                misspelt.extend(binding.map(|binding| &*binding.name));
                errors.extend(
                    otherwise
                        .map(|help| Diagnostic::new(Code::UNKNOWN_BINDING, sample.binding.span, unknown).help(help)),
                );
                continue;
            }
            misspelt.extend(nearest(name, names(interface)));
            let help = suggestion(name, names(interface))
                .or_else(|| Some(format!("shader `{shader}` samples no images at all in set {PASS_SET}")));
            errors.push(Diagnostic { help, ..Diagnostic::new(Code::UNKNOWN_BINDING, sample.binding.span, unknown) });
            continue;
        };
        if declared.input {
            let message = format!("shader `{shader}` declares `{name}` as an input attachment where it is none");
            let help = format!("declare it `subpassInput` where `LOCAL_READ_{name}` is defined, and else `sampler2D`");
            errors.push(Diagnostic::new(Code::OWN_PIXEL, sample.binding.span, message).help(help));
            continue;
        }
        let Some(image) = resources.image(sample.part.image.index) else { continue };
        let Some(sampled) = lowered.sampled.iter().find(|sampled| sampled.binding == *name) else { continue };
        let mut out_of_range = Vec::new();
        parts::range(resources, &sample.part, &mut out_of_range);
        if !out_of_range.is_empty() {
            // It is reported with the pass.
            continue;
        }
        let part = image.image.part(sampled.range);
        let check = Check { resources, pass, sample, shader, image, part, declared };
        let before = errors.len();
        check.dimension(errors);
        if errors.len() == before {
            check.component(errors);
            check.samples(errors);
            check.filters(errors);
            let format = resources.declared(sample.part.image.index).format.span;
            compared_depth::check(pass, sample, declared.compares, (&image.image, format), errors);
            check.address(errors);
            check.own_pixel(resources, lowered, sampled.own_pixel, errors);
            check.part(interface, errors);
        }
    }
    parts_in_use::too_many(resources, pass, errors);
    misspelt
}

/// Reports samples that conditions leave out and that the shader wouldn't sample anyway. `whole`: the shader with all samples.
pub(in crate::expand) fn check_left_out(
    pass: &language::Pass,
    whole: Option<&ShaderInterface>,
    errors: &mut Vec<Diagnostic>,
) {
    let (Some(whole), Some(shader)) = (whole, pass.shader()) else { return };
    for language::LeftOutSample { binding, .. } in &pass.left_out {
        if declared(whole, &binding.text).is_some() {
            continue;
        }
        if let Some((_, wrong)) = arrays::misfit(&shader.text, whole, binding) {
            errors.extend(wrong);
        } else {
            let unknown = format!("shader `{}` samples no image named `{}`", shader.text, binding.text);
            let help = suggestion(&binding.text, names(whole));
            errors.push(Diagnostic { help, ..Diagnostic::new(Code::UNKNOWN_BINDING, binding.span, unknown) });
        }
    }
}

struct Check<'a> {
    resources: &'a Resources<'a>,
    pass: &'a language::Pass,
    sample: &'a language::Sample,
    shader: &'a str,
    image: &'a FrameImage,
    /// The part that is given, with planes named.
    part: Subresources,
    declared: DeclaredImage,
}

impl Check<'_> {
    /// The part has the shape that the shader declares.
    fn dimension(&self, errors: &mut Vec<Diagnostic>) {
        let (name, image) = (&self.sample.binding.text, &self.image.image);
        let layers = self.part.layers;
        let span = parts::place(&self.sample.part);
        let shape = self.resources.declared(self.sample.part.image.index).shape.span;
        if dimension(self.shader, name, self.declared.shape, image, span, shape, errors) {
            return;
        }
        if let Some(message) = layers_fit(self.declared.shape, layers) {
            let message = format!(
                "shader `{}` declares `{name}` as {}, {message}",
                self.shader,
                shape_words(self.declared.shape)
            );
            let help = format!("say which: `(image: \"{}\", layer: 0)`", image.name);
            let wrong = Diagnostic::new(Code::DIMENSION, span, message);
            errors.push(if layers > 1 { wrong.help(help) } else { wrong });
        }
    }

    /// The part has the component type that the shader reads.
    fn component(&self, errors: &mut Vec<Diagnostic>) {
        let (name, image) = (&self.sample.binding.text, &self.image.image);
        let stencil = self.part.aspects == Aspects::STENCIL;
        let holds = if stencil { Component::Uint } else { Component::of(image.format) };
        if self.declared.shape.component != holds {
            let (wanted, held) = (self.declared.shape.component.words(), holds.words());
            let shader = self.shader;
            let message = format!(
                "shader `{shader}` reads {wanted} from `{name}`, but `{}` holds {held} ({})",
                image.name, image.format
            );
            let declared = self.resources.declared(self.sample.part.image.index).format.span;
            errors.push(
                Diagnostic::new(Code::COMPONENT_TYPE, self.sample.part.image.span, message)
                    .label(declared, "its format"),
            );
        }
    }

    /// Single samples are read where there are several, and where the pass gives them.
    fn samples(&self, errors: &mut Vec<Diagnostic>) {
        let (name, image_name, shader) = (&self.sample.binding.text, &self.image.image.name, self.shader);
        let multisampled = self.declared.shape.multisampled;
        let contradicts = match self.sample.face {
            Face::Samples if !multisampled && !self.declared.adapts => {
                Some(("single samples", "one value a texel", "sampler2D"))
            }
            Face::Resolved | Face::DepthOnly if multisampled => {
                Some(("one value a texel", "single samples", "sampler2DMS"))
            }
            _ => None,
        };
        let span = self.sample.part.image.span;
        self.depth_only(errors);
        if let Some((given, wanted, declaration)) = contradicts {
            let message = format!(
                "pass `{}` gives {given} of `{image_name}`, but shader `{shader}` reads {wanted}",
                self.pass.name.text
            );
            let face = match self.sample.face {
                Face::Samples => "Samples",
                // A plain name contradicts nothing.
                Face::Resolved | Face::Plain => "Resolved",
                Face::DepthOnly => "DepthOnly",
            };
            let help = format!(
                "write `\"{image_name}\"` in place of `{face}(…)`: `{name}` is a `{declaration}` in the shader"
            );
            errors.push(Diagnostic::new(Code::SINGLE_SAMPLES, span, message).help(help));
        } else if multisampled && self.image.image.samples == 1 {
            let message = format!(
                "shader `{shader}` reads single samples of `{name}`, but `{image_name}` has {}",
                self.image.samples_words()
            );
            let fewer = format!(
                "declare it `sampler2D`, or `TEXTURE_{name}`, which fits any number of samples; or give the image more"
            );
            let declared = self.resources.declared(self.sample.part.image.index).samples.span;
            errors
                .push(Diagnostic::new(Code::SINGLE_SAMPLES, span, message).label(declared, "its samples").help(fewer));
        }
    }

    /// `DepthOnly` needs an image with depth: only depth can be drawn again.
    fn depth_only(&self, errors: &mut Vec<Diagnostic>) {
        let image = &self.image.image;
        if self.sample.face == Face::DepthOnly && (!image.format.is_depth() || self.part.aspects == Aspects::STENCIL) {
            let message = format!("`{}` is no depth: it is {}", image.name, image.format);
            let declared = self.resources.declared(self.sample.part.image.index).format.span;
            let wrong =
                Diagnostic::new(Code::TARGET_UNFIT, self.sample.part.image.span, message).label(declared, "its format");
            errors.push(wrong.help(format!("write `\"{}\"` in place of `DepthOnly(…)`", image.name)));
        }
    }

    /// Reports a linear filter on an image that can't be filtered.
    fn filters(&self, errors: &mut Vec<Diagnostic>) {
        let (image, shader, multisampled) = (&self.image.image, self.shader, self.declared.shape.multisampled);
        let why = match () {
            () if image.format.is_integer() => format!("`{}` holds integers ({})", image.name, image.format),
            () if self.part.aspects == Aspects::STENCIL => format!("the stencil of `{}` holds integers", image.name),
            () if multisampled && !self.declared.adapts => format!("shader `{shader}` reads single samples of it"),
            () => return,
        };
        for filter in [self.sample.filter, self.sample.mip_filter].into_iter().flatten() {
            if filter.value == Filter::Linear {
                errors.push(Diagnostic::new(
                    Code::LINEAR_FILTER,
                    filter.span,
                    format!("a linear filter can't be used: {why}"),
                ));
            }
        }
    }

    /// Reports `address` where the shader reads single samples by number: such reads never go beyond the edges.
    fn address(&self, errors: &mut Vec<Diagnostic>) {
        let single_samples = self.declared.shape.multisampled && !self.declared.adapts;
        let Some(address) = self.sample.address.filter(|_| single_samples) else { return };
        let why = format!("shader `{}` reads single samples of it, each by its number", self.shader);
        let message = format!("nothing lies beyond the edges of `{}`: {why}", self.image.image.name);
        errors.push(Diagnostic::new(Code::SINGLE_SAMPLES, address.span, message).help("leave `address` out"));
    }

    /// Reports a shader that samples an image of which only a part is in use, and doesn't ask for that part.
    fn part(&self, interface: &ShaderInterface, errors: &mut Vec<Diagnostic>) {
        let (name, image) = (&self.sample.binding.text, &self.image.image);
        let halves = image.eyes == Some(EyeForm::Halves);
        if image.allocated.is_none() && !halves {
            return;
        }
        if halves && image.allocated.is_none() {
            return self.half(interface, errors);
        }
        let declared = self.resources.declared(self.sample.part.image.index).size.span;
        let seen = (self.shader, &**name, &self.sample.part);
        let by = parts_in_use::within_part(self.shader, name);
        errors.extend(parts_in_use::not_asked(self.resources, interface, seen, ["samples", &by]));
        if element_of(name).is_some() {
            return;
        }
        if let Some(address) = self.sample.address.filter(|address| address.value != AddressMode::ClampToEdge) {
            let message = format!("`{}` is used in part, and beyond that it holds nothing", image.name);
            let wrong =
                Diagnostic::new(Code::PART_NOT_ASKED, address.span, message).label(declared, "its size may change");
            errors.push(wrong.help("write `Clamp`: it ends at the part's edges"));
        }
        if self.sample.state.reaches_out() {
            let message = format!("`{}` is used in part, and such a sampler looks beyond that", image.name);
            let wrong = Diagnostic::new(Code::PART_NOT_ASKED, self.sample.part.image.span, message);
            let wrong = wrong.label(declared, "its size may change");
            errors.push(wrong.help("leave out `anisotropy`, `lod_bias` and `min_lod`"));
        }
    }

    /// If both eyes' parts lie side by side, the shader must ask for its half.
    fn half(&self, interface: &ShaderInterface, errors: &mut Vec<Diagnostic>) {
        let (name, image) = (&self.sample.binding.text, &self.image.image);
        if interface.asks_part.iter().any(|asked| **asked == **name) {
            return;
        }
        let message = format!(
            "shader `{}` samples `{name}` and doesn't ask which half of `{}` is its eye's",
            self.shader, image.name
        );
        let declared = self.resources.declared(self.sample.part.image.index).name.span;
        let wrong = Diagnostic::new(Code::EYE_HALF, self.sample.part.image.span, message);
        let wrong = wrong.label(declared, "both eyes' pictures lie side by side in it");
        errors.push(wrong.help(parts_in_use::half_help(self.shader, name)));
    }

    /// A fragment can read its own texel only of an image that lies under the pass's targets.
    fn own_pixel(&self, resources: &Resources<'_>, lowered: &Pass, own_pixel: bool, errors: &mut Vec<Diagnostic>) {
        let (name, image) = (&self.sample.binding.text, &self.image.image);
        if let Some(own) = self.sample.own_pixel.filter(|own| own.value && element_of(name).is_some()) {
            let message =
                format!("`{name}` is an element of an array, and no device reads those from its own position");
            errors.push(Diagnostic::new(Code::OWN_PIXEL, own.span, message).help("leave `own_pixel` out"));
        }
        if !own_pixel {
            return;
        }
        let span = self.sample.own_pixel.map_or(self.sample.part.image.span, |own| own.span);
        let Some((target, range)) = lowered.attachments().next() else {
            let message = format!("pass `{}` draws no pixels, so it has no own ones", self.pass.name.text);
            errors.push(
                Diagnostic::new(Code::OWN_PIXEL, span, message)
                    .help("leave `own_pixel` out: it is for passes that draw"),
            );
            return;
        };
        let Some(target) = resources.image(target).map(|target| &target.image) else { return };
        let (own, drawn) = (image.target_shape(self.part), target.target_shape(range));
        let sizes = [own.extent, drawn.extent];
        let same = (&sizes[0][..2], own.allocated) == (&sizes[1][..2], drawn.allocated);
        let another = self.sample.part.previous.is_some() && own.allocated.is_some();
        if !same || another || self.part.mips > 1 || self.part.layers > 1 {
            let [own, drawn] = sizes;
            let message = format!(
                "`{}` can't be read at the fragment's own position: it isn't the size of what pass `{}` draws into",
                image.name, self.pass.name.text
            );
            let levels = self.part.mips;
            let more =
                size_words(own, image) + &if levels > 1 { format!(", {levels} mip levels") } else { String::new() };
            let targets = format!("`{}` is {}", target.name, size_words(drawn, target));
            errors.push(Diagnostic::new(Code::OWN_PIXEL, span, message).remark(more).help(targets));
        }
    }
}

/// Reports an image of another dimension than the shader declares.
pub(super) fn dimension(
    shader: &str,
    name: &str,
    shape: ImageShape,
    image: &crate::frame::Image,
    span: crate::base::Span,
    declared: crate::base::Span,
    errors: &mut Vec<Diagnostic>,
) -> bool {
    let is = match image.shape {
        Shape::D2 => "two-dimensional",
        Shape::D3 => "three-dimensional",
        Shape::Cube => "a cube",
    };
    let fits = match shape.dimension {
        Dimension::D2 => image.shape != Shape::D3,
        Dimension::D3 => image.shape == Shape::D3,
        Dimension::Cube => image.shape == Shape::Cube,
        Dimension::D1 | Dimension::Buffer => false,
    };
    if !fits {
        let message =
            format!("shader `{shader}` declares `{name}` as {}, but `{}` is {is}", shape_words(shape), image.name);
        errors.push(Diagnostic::new(Code::DIMENSION, span, message).label(declared, "declared here"));
    }
    !fits
}

/// Why this number of layers doesn't fit the declared shape.
pub(super) fn layers_fit(shape: ImageShape, layers: u32) -> Option<String> {
    let fits = match (shape.dimension, shape.arrayed) {
        (Dimension::Cube, false) => layers == 6,
        (Dimension::Cube, true) => layers.is_multiple_of(6),
        (_, true) => true,
        (_, false) => layers == 1,
    };
    (!fits).then(|| format!("but is given {layers} {}", if layers == 1 { "layer" } else { "layers" }))
}
