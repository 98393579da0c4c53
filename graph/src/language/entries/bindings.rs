//! `sample`, `storage`, `uniform` and `params`: the bindings and parameters of a shader, by the shader's own names.

use super::condition::{self, Condition};
use super::firsts::Firsts;
use super::parts::{self, AnyPart, PartSelection};
use super::raster;
use super::targets;
use super::values::{self, optional};
use crate::base::{Code, Diagnostic};
use crate::fields;
use crate::language::model::{Face, LeftOutSample, Param, Sample, SamplerState, Storage, StorageAccess, Uniform};
use crate::language::scope::{Context, FieldContents, FieldValue, FieldValueTuple, combined};
use crate::ron::{FieldTable, Form, Leaf, Name, Reader, Shape, Spanned, Word, WordContents, Words, names};
use crate::shader::element_name;
use crate::vulkan::{AddressMode, BorderColor, Filter, SamplerReductionMode};
use std::sync::Arc;

fields! {
    /// A sampled image: an image that a shader samples, under the shader's own name for it. An array of images is a list of them.
    /// ```ron
    /// (image: Resolved("image"), mip: 1, filter: Nearest)
    /// ```
    struct SampleFields<'src> {
        /// The image, or a face of it.
        image: Leaf<'src> => FACE,
        /// The first mip level, from 0.
        mip: Option<Leaf<'src>> => parts::FIRST,
        /// How many mip levels; one if `mip` stands alone, all if neither stands there.
        mips: Option<Leaf<'src>> => parts::COUNT,
        /// The first layer, from 0.
        layer: Option<Leaf<'src>> => parts::FIRST,
        /// How many layers; one if `layer` stands alone, all if neither stands there.
        layers: Option<Leaf<'src>> => parts::COUNT,
        /// Depth or stencil; the plane that the shader's declaration asks for if left out.
        plane: Option<Leaf<'src>> => parts::PLANE,
        /// How many frames back; only for images with history.
        previous: Option<Leaf<'src>> => parts::PREVIOUS,
        /// Between texels: the nearest, or a weighted mean of those around; `Linear` for colour and else `Nearest` if left out.
        filter: Option<Leaf<'src>> => SAMPLER_FILTER,
        /// Between mip levels: the nearest, or a weighted mean of two; `Nearest` if left out.
        mip_filter: Option<Leaf<'src>> => SAMPLER_FILTER,
        /// Beyond the edges: the texels at the edge, the image again, the image mirrored, again and again, a border, or the image
        /// mirrored once and then the texels at its edge; `Clamp` if left out.
        address: Option<Leaf<'src>> => ADDRESS,
        /// The colour beyond the edges, with `address: Border`; zeros if left out.
        border: Option<Leaf<'src>> => BORDER,
        /// What a linear filter makes of the texels around: their weighted mean, or the least or greatest of each channel;
        /// `WeightedAverage` if left out.
        reduction: Option<Leaf<'src>> => REDUCTION,
        /// Up to how many samples are taken along the direction in which the image is seen at a slant; 1 if left out.
        anisotropy: Option<Leaf<'src>> => Form::Whole(1, 16),
        /// What is added to the mip level; 0 if left out.
        lod_bias: Option<Leaf<'src>> => Form::Number,
        /// The least mip level, from `mip` on; 0 if left out.
        min_lod: Option<Leaf<'src>> => Form::Number,
        /// The greatest mip level, from `mip` on; the last if left out.
        max_lod: Option<Leaf<'src>> => Form::Number,
        /// How the shader's depth is compared with that of the image, which it declares as `sampler2DShadow`: 1 where it passes, and
        /// with `filter: Linear` the share of four texels where it does.
        compare: Option<Leaf<'src>> => COMPARE,
        /// A promise that each fragment reads only the texel at its own position.
        own_pixel: Option<Leaf<'src>> => Form::Truth,
        /// A condition: if it is false, the shader is compiled without it.
        when: Option<Leaf<'src>> => condition::CONDITION,
    }
}

/// Sampled images, by the shader's names.
pub(crate) const SAMPLE: Form = Form::Map(
    "shader's name",
    &Form::Either(&[FACE, Form::Fields(SampleFields::<'static>::table), Form::List(&SAMPLED)]),
);

/// A sampled image.
const SAMPLED: Form = Form::Either(&[FACE, Form::Fields(SampleFields::<'static>::table)]);

/// An image or a face of it.
const FACE: Form = Form::Words(&FACES);

static FACES: Words = Words {
    name: "Face",
    what: "a face of an image",
    or: &[parts::EYE_IMAGE],
    all: &[
        Word::new(
            "Samples",
            &[WordContents::Values(&[parts::EYE_IMAGE])],
            &["Samples(\"image\")"],
            "Each sample by itself.",
        ),
        Word::new(
            "Resolved",
            &[WordContents::Values(&[parts::EYE_IMAGE])],
            &["Resolved(\"image\")"],
            "One value a texel. Where the image has several samples its `resolve` says what becomes of them.",
        ),
        Word::new(
            "DepthOnly",
            &[WordContents::Values(&[parts::EYE_IMAGE])],
            &["DepthOnly(\"image\")"],
            "One value of depth a texel. Where the image has several samples, whatever drew it is drawn again with one, and \
             nothing but its depth: that of the middle of each texel.",
        ),
    ],
};

/// The filter between texels.
pub(crate) const FILTER: Form = Form::Choice("a filter", || names(&FILTERS));

/// The filter of a sampler.
const SAMPLER_FILTER: Form = Form::Either(&[FILTER, Form::Expression("a filter")]);

/// The address mode beyond the edges.
const ADDRESS: Form =
    Form::Either(&[Form::Choice("an address mode", || names(&ADDRESSES)), Form::Expression("an address mode")]);

/// The border of a sampler.
const BORDER: Form =
    Form::Either(&[Form::Choice("a border", || names(BorderColor::NAMED)), Form::Expression("a border")]);

/// The reduction of a sampler.
const REDUCTION: Form = Form::Either(&[
    Form::Choice("a reduction", || names(SamplerReductionMode::NAMED)),
    Form::Expression("a reduction"),
]);

/// The comparison of a sampler.
const COMPARE: Form = Form::Either(&[targets::TEST, Form::Expression("a comparison")]);

/// Storage images and buffers, by the shader's names.
pub(crate) const STORAGE: Form = Form::Map(
    "shader's name",
    &Form::Either(&[
        parts::WHOLE_RESOURCE,
        Form::Fields(StorageFields::<'static>::table),
        Form::List(&Form::Either(&[parts::WHOLE_RESOURCE, Form::Fields(StorageFields::<'static>::table)])),
    ]),
);

/// Uniform blocks, by the shader's names.
pub(crate) const UNIFORM: Form = Form::Map("shader's name", &parts::BUFFER);

/// Parameters, by the shader's names.
pub(crate) const PARAMS: Form = Form::Map("shader's name", &values::PARAM);

/// Specialization constants, by the shader's names.
pub(crate) const CONSTANTS: Form = Form::Map("shader's name", &values::PARAM);

fields! {
    /// A storage image or buffer: a shader reads and writes it, under the shader's own name for it. An array of images is a list of them.
    /// ```ron
    /// (buffer: "buffer", access: ReadWrite)
    /// ```
    struct StorageFields<'src> {
        /// Which image.
        image: Option<Leaf<'src>> => parts::EYE_IMAGE,
        /// Or which buffer.
        buffer: Option<Leaf<'src>> => parts::WHOLE_BUFFER,
        /// The mip level, from 0; it must be named if there are several.
        mip: Option<Leaf<'src>> => parts::FIRST,
        /// The first layer, from 0.
        layer: Option<Leaf<'src>> => parts::FIRST,
        /// How many layers; one if `layer` stands alone, all if neither stands there.
        layers: Option<Leaf<'src>> => parts::COUNT,
        /// How many frames back; only for buffers with history, and only to read.
        previous: Option<Leaf<'src>> => parts::PREVIOUS,
        /// The access; as the shader declares it if left out. `Write` promises that all of it is written and nothing of
        /// it read before: `ReadWrite` is for atomics, and for writes here and there. A shader that declares it `writeonly`
        /// promises nothing: what it doesn't write is kept.
        access: Option<Leaf<'src>> => Form::Choice("an access", || names(&ACCESSES)),
    }
}

/// Filters, by name.
pub(crate) static FILTERS: [(&str, Filter); 2] = [("Nearest", Filter::Nearest), ("Linear", Filter::Linear)];

static ADDRESSES: [(&str, AddressMode); 5] = [
    ("Clamp", AddressMode::ClampToEdge),
    ("Repeat", AddressMode::Repeat),
    ("Mirror", AddressMode::MirroredRepeat),
    ("Border", AddressMode::ClampToBorder),
    ("MirrorOnce", AddressMode::MirrorClampToEdge),
];

const ACCESSES: [(&str, StorageAccess); 3] =
    [("Read", StorageAccess::Read), ("Write", StorageAccess::Write), ("ReadWrite", StorageAccess::ReadWrite)];

impl Context<'_> {
    /// Images by the shader's names, and those that conditions leave out.
    pub(crate) fn sampled(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<(Vec<Sample>, Vec<LeftOutSample>)>> {
        let all = self.elements(leaf, "`sample`", "a sampled image", |context, binding, value| {
            let fields = match value.shape() {
                Shape::Parentheses => context.reader.read(value, "a sampled image")?,
                _ => SampleFields::plain(value),
            };
            let condition = optional(fields.when, |leaf| context.when(leaf));
            let sample = context.sampled_image(binding.clone(), fields);
            let (binding, condition, sample) = (binding?, condition?, sample?);
            let Some(condition) = condition else { return Some(sample.map(Ok)) };
            Some(FieldValue::computed(move |evaluator| {
                let condition = condition.evaluate(evaluator);
                let is_off = condition.as_ref().is_some_and(|condition| condition.off.is_some());
                let before = evaluator.reader.errors.len();
                let sample = evaluator.leniently(is_off, |evaluator| sample.evaluate(evaluator));
                let Condition { off, by } = condition?;
                evaluator.chosen = evaluator.chosen.and(&by);
                match off {
                    None => sample.map(Ok),
                    // An image that has no value because it is left out is no mistake.
                    Some(off) if evaluator.reader.errors.len() == before => {
                        Some(Err(LeftOutSample { binding: binding.clone(), sample, off }))
                    }
                    Some(_) => None,
                }
            }))
        })?;
        Some(combined(all, |all| {
            let (mut samples, mut left_out) = (Vec::with_capacity(all.len()), Vec::new());
            for sample in all {
                match sample {
                    Ok(sample) => samples.push(sample),
                    Err(off) => left_out.push(off),
                }
            }
            (samples, left_out)
        }))
    }

    fn sampled_image(&mut self, binding: Option<Name>, fields: SampleFields<'_>) -> Option<FieldValue<Sample>> {
        let SampleFields { image, mip, mips, layer, layers, plane, previous, .. } = fields;
        let SampleFields { filter, mip_filter, address, compare, own_pixel, .. } = fields;
        let selected = PartSelection { mip, mips, layer, layers, plane, previous };
        let image = face(self.reader, image).map(|(name, face)| (self.selected_image(name, selected), face));
        let filter = self.sampler_word(filter, "a filter", &FILTERS);
        let mip_filter = self.sampler_word(mip_filter, "a filter", &FILTERS);
        let address = self.sampler_word(address, "an address mode", &ADDRESSES);
        let compare = self.sampler_word(compare, "a comparison", &targets::TESTS);
        let state = self.sampler_state(&fields);
        let own_pixel = optional(own_pixel, |leaf| self.truth(leaf).map(FieldValue::spanned));
        let (part, face) = image?;
        let words = (filter?, mip_filter?, address?, compare?);
        let (binding, parts) = (binding?, (part?, words, state?, own_pixel?));
        Some(combined(parts, move |(part, (filter, mip_filter, address, compare), state, own_pixel)| Sample {
            binding: binding.clone(),
            part,
            face,
            filter,
            mip_filter,
            address,
            state,
            compare,
            own_pixel,
        }))
    }

    /// The rest of a sampler.
    fn sampler_state(&mut self, fields: &SampleFields<'_>) -> Option<FieldValue<SamplerState>> {
        let SampleFields { border, reduction, anisotropy, lod_bias, min_lod, max_lod, .. } = *fields;
        let border = self.optional_word(border, "a border", BorderColor::NAMED);
        let reduction = self.optional_word(reduction, "a reduction", SamplerReductionMode::NAMED);
        let anisotropy = raster::optional(anisotropy, |leaf| self.whole(leaf, "number of samples", 1..=16));
        let lod_bias = raster::optional(lod_bias, |leaf| self.real(leaf, "a mip level"));
        let min_lod = raster::optional(min_lod, |leaf| self.real(leaf, "a mip level"));
        let max_lod = raster::optional(max_lod, |leaf| self.real(leaf, "a mip level"));
        let parts = (border?, reduction?, anisotropy?, lod_bias?, min_lod?, max_lod?);
        Some(combined(parts, |(border, reduction, anisotropy, lod_bias, min_lod, max_lod)| SamplerState {
            border,
            reduction,
            anisotropy,
            lod_bias,
            min_lod,
            max_lod,
        }))
    }

    /// A filter or address mode, if the field is there: `None` if the word is not known.
    fn sampler_word<T: Copy + FieldContents>(
        &mut self,
        leaf: Option<Leaf<'_>>,
        what: &'static str,
        choices: &'static [(&'static str, T)],
    ) -> Option<Option<FieldValue<Spanned<T>>>> {
        optional(leaf, |leaf| self.word(leaf, what, choices).map(FieldValue::spanned))
    }

    /// Images and buffers that the shader reads and writes, by its names.
    pub(crate) fn storage(&mut self, leaf: Leaf<'_>) -> Option<Vec<FieldValue<Storage>>> {
        self.elements(leaf, "`storage`", "a storage image or buffer", |context, binding, value| {
            let Shape::Parentheses = value.shape() else {
                let part = context.part(value);
                let binding = binding?;
                return Some(part?.map(move |part| Storage { binding: binding.clone(), part, access: None }));
            };
            let fields: StorageFields<'_> = context.reader.read(value, "a storage image or buffer")?;
            let StorageFields { image, buffer, mip, layer, layers, previous, access } = fields;
            let selected = PartSelection { mip, layer, layers, previous, ..PartSelection::default() };
            let part = context.part_of_either(value, image, buffer, selected);
            let access = values::optional_choice(context.reader, access, "an access", &ACCESSES);
            let (part, access) = (part?, access?);
            let of_image = matches!(part, AnyPart::Image(_));
            if let (Some(previous), Some(access)) = (previous, access)
                && access.value.writes()
            {
                let written =
                    Diagnostic::new(Code::EARLIER_FRAME, access.span, "what an earlier frame left can only be read");
                context.reader.report(written.label(previous.span(), "an earlier frame"));
                return None;
            }
            if let (Some(previous), Some(image)) = (previous, image.filter(|_| of_image)) {
                let sampled = Diagnostic::new(
                    Code::EARLIER_FRAME,
                    previous.span(),
                    "images of earlier frames can be sampled, not read as storage",
                );
                context.reader.report(sampled.label(image.span(), "this image").help("name it in `sample`"));
                return None;
            }
            let binding = binding?;
            Some(part.part().map(move |part| Storage { binding: binding.clone(), part, access }))
        })
    }

    /// Buffers that the shader reads as uniform blocks, by its names.
    pub(crate) fn uniforms(&mut self, leaf: Leaf<'_>) -> Option<Vec<FieldValue<Uniform>>> {
        self.entries(leaf, "`uniform`", "a uniform block", |context, binding, value| {
            let (part, binding) = (context.buffer_part(value), binding?);
            Some(part?.map(move |part| Uniform { binding: binding.clone(), part }))
        })
    }

    /// Values by the names of the shader's parameters.
    pub(crate) fn params(&mut self, leaf: Leaf<'_>) -> Option<Vec<FieldValue<Param>>> {
        self.values(leaf, "`params`", "a parameter")
    }

    /// Values by the names of the shader's specialization constants.
    pub(crate) fn constants(&mut self, leaf: Leaf<'_>) -> Option<Vec<FieldValue<Param>>> {
        self.values(leaf, "`constants`", "a constant")
    }

    fn values(&mut self, leaf: Leaf<'_>, map: &str, what: &str) -> Option<Vec<FieldValue<Param>>> {
        self.entries(leaf, map, what, |context, name, leaf| {
            let (value, name) = (context.param(leaf)?, name?);
            Some(value.map(move |value| Param {
                name: name.clone(),
                written: value.because.clone(),
                value: value.spanned(),
            }))
        })
    }

    /// The entries of a map whose keys are names, each once. The values of a list are the elements of an array.
    fn elements<'src, T>(
        &mut self,
        leaf: Leaf<'src>,
        map: &str,
        what: &str,
        mut read: impl FnMut(&mut Self, Option<Name>, Leaf<'src>) -> Option<T>,
    ) -> Option<Vec<T>> {
        let mut all = Vec::with_capacity(leaf.entries().map_or(0, Iterator::count));
        let mut elements = Vec::new();
        self.entries(leaf, map, what, |context, name, value| {
            if let Some(name) = name.as_ref().filter(|name| name.text.contains('[')) {
                let message = format!("`{}` can't be {what}: elements of an array have no names", name.text);
                let wrong = Diagnostic::new(Code::BINDING_ARRAY, name.span, message);
                context.reader.report(wrong.help("write a list under the array's name: `\"taps\": [\"…\", \"…\"]`"));
                return None;
            }
            let Shape::List = value.shape() else {
                all.push(read(context, name, value)?);
                return Some(());
            };
            let mut complete = true;
            let mut is_empty = true;
            for (number, value) in (0..).zip(value.values()?) {
                is_empty = false;
                let element = |name: &Name| element_name(&name.text, number).into();
                let name = name.as_ref().map(|name| Name { text: element(name), span: value.span() });
                match read(context, name, value) {
                    Some(value) => elements.push(value),
                    None => complete = false,
                }
            }
            if is_empty {
                context.reader.wrong(Code::BINDING_ARRAY, value, "an array has one element at least", "");
            }
            (complete && !is_empty).then_some(())
        })?;
        all.append(&mut elements);
        Some(all)
    }

    /// The entries of a map whose keys are names, each once.
    fn entries<'src, T>(
        &mut self,
        leaf: Leaf<'src>,
        map: &str,
        what: &str,
        mut read: impl FnMut(&mut Self, Option<Name>, Leaf<'src>) -> Option<T>,
    ) -> Option<Vec<T>> {
        let mut names = Firsts::default();
        let mut complete = true;
        let entries = self.reader.map(leaf, map)?;
        let mut list = Vec::with_capacity(leaf.entries().map_or(0, Iterator::count));
        for (key, value) in entries {
            let name = self.reader.reference(key, what);
            if let Some(name) = &name
                && let Some(first) = names.insert(Arc::clone(&name.text), name.span)
            {
                let twice =
                    Diagnostic::new(Code::LISTED_TWICE, name.span, format!("{map} names `{}` twice", name.text));
                self.reader.report(twice.remark("again here").label(first, "first here"));
                complete = false;
            }
            match read(self, name, value) {
                Some(value) => list.push(value),
                None => complete = false,
            }
        }
        complete.then_some(list)
    }
}

impl<'src> SampleFields<'src> {
    /// The fields that an image's plain name stands for.
    const fn plain(image: Leaf<'src>) -> SampleFields<'src> {
        SampleFields {
            image,
            mip: None,
            mips: None,
            layer: None,
            layers: None,
            plane: None,
            previous: None,
            filter: None,
            mip_filter: None,
            address: None,
            border: None,
            reduction: None,
            anisotropy: None,
            lod_bias: None,
            min_lod: None,
            max_lod: None,
            compare: None,
            own_pixel: None,
            when: None,
        }
    }
}

/// An image's name, and the face that is meant.
fn face<'src>(reader: &mut Reader, leaf: Leaf<'src>) -> Option<(Leaf<'src>, Face)> {
    if let Shape::Text | Shape::Word("Eye", _) = leaf.shape() {
        return Some((leaf, Face::Plain));
    }
    let (word, rest) = reader.one_of(leaf, &FACES)?;
    let [inner]: [Leaf<'_>; 1] = reader.inside(leaf, rest, &format!("{word}(\"image\")"))?;
    let face = match word {
        "Samples" => Face::Samples,
        "Resolved" => Face::Resolved,
        _ => Face::DepthOnly,
    };
    Some((inner, face))
}
