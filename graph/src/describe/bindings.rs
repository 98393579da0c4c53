//! `sample`, `storage`, `uniform` and `params`: what a pass gives to its shader, by the shader's own names.

use super::leaf::{Leaf, Shape};
use super::parts::{self, Selected};
use super::pass::{Face, Param, Part, Sample, Storage, StorageAccess, Uniform};
use super::pipeline::Name;
use super::reader::Reader;
use super::scope::Scope;
use super::values;
use super::{Diagnostic, Spanned};
use crate::fields;
use crate::vocabulary::{AddressMode, Filter};
use std::collections::HashMap;

fields! {
    struct SampleFields<'src> {
        image: Leaf<'src>,
        mip: Option<Leaf<'src>>,
        mips: Option<Leaf<'src>>,
        layer: Option<Leaf<'src>>,
        layers: Option<Leaf<'src>>,
        plane: Option<Leaf<'src>>,
        previous: Option<Leaf<'src>>,
        filter: Option<Leaf<'src>>,
        mip_filter: Option<Leaf<'src>>,
        address: Option<Leaf<'src>>,
        own_pixel: Option<Leaf<'src>>,
    }
}

fields! {
    struct StorageFields<'src> {
        image: Option<Leaf<'src>>,
        buffer: Option<Leaf<'src>>,
        mip: Option<Leaf<'src>>,
        layer: Option<Leaf<'src>>,
        layers: Option<Leaf<'src>>,
        previous: Option<Leaf<'src>>,
        access: Option<Leaf<'src>>,
    }
}

const IMAGES: &str = "a sampled image is `\"image\"`, `Samples(\"image\")`, `Resolved(\"image\")` or \
                      `(image: \"image\", mip: 0, filter: Nearest)`";

/// Filters, by name.
pub(super) const FILTERS: [(&str, Filter); 2] = [("Nearest", Filter::Nearest), ("Linear", Filter::Linear)];

const ADDRESSES: [(&str, AddressMode); 3] =
    [("Clamp", AddressMode::ClampToEdge), ("Repeat", AddressMode::Repeat), ("Mirror", AddressMode::MirroredRepeat)];

const ACCESSES: [(&str, StorageAccess); 3] =
    [("Read", StorageAccess::Read), ("Write", StorageAccess::Write), ("ReadWrite", StorageAccess::ReadWrite)];

/// Images by the shader's names.
pub(super) fn samples<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Vec<Sample>> {
    entries(reader, leaf, "`sample`", "a sampled image", |reader, binding, value| {
        let fields = match value.shape() {
            Shape::Parentheses => reader.read(value, "a sampled image")?,
            _ => SampleFields::plain(value),
        };
        let SampleFields { image, mip, mips, layer, layers, plane, previous, filter, mip_filter, address, own_pixel } =
            fields;
        let selected = Selected { mip, mips, layer, layers, plane, previous };
        let image = face(reader, image).map(|(name, face)| (parts::image_part(reader, scope, name, selected), face));
        let filter = chosen(reader, filter, "a filter", &FILTERS);
        let mip_filter = chosen(reader, mip_filter, "a filter", &FILTERS);
        let address = chosen(reader, address, "an address mode", &ADDRESSES);
        let own_pixel = match own_pixel {
            Some(leaf) => values::truth(reader, scope, leaf).map(|own| Some(leaf.spanned(own))),
            None => Some(None),
        };
        let (part, face) = image?;
        let (binding, part, own_pixel) = (binding?, part?, own_pixel?);
        Some(Sample { binding, part, face, filter: filter?, mip_filter: mip_filter?, address: address?, own_pixel })
    })
}

impl<'src> SampleFields<'src> {
    /// What an image's plain name says.
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
            own_pixel: None,
        }
    }
}

/// One of several words, if it is there: `None` if it is none of them.
fn chosen<T: Copy>(
    reader: &mut Reader,
    leaf: Option<Leaf<'_>>,
    what: &str,
    choices: &[(&'static str, T)],
) -> Option<Option<Spanned<T>>> {
    let Some(leaf) = leaf else { return Some(None) };
    values::choice(reader, leaf, what, choices).map(|value| Some(leaf.spanned(value)))
}

/// An image's name, and which of its faces is meant.
fn face<'src>(reader: &mut Reader, leaf: Leaf<'src>) -> Option<(Leaf<'src>, Face)> {
    if let Shape::Text = leaf.shape() {
        return Some((leaf, Face::Plain));
    }
    let (word, rest) = reader.word(leaf, "a face of an image", &["Samples", "Resolved"], IMAGES)?;
    let [inner]: [Leaf<'_>; 1] = reader.inside(leaf, rest, &format!("{word}(\"image\")"))?;
    Some((inner, if word == "Samples" { Face::Samples } else { Face::Resolved }))
}

/// Images and buffers that the shader reads and writes, by its names.
pub(super) fn storage<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Vec<Storage>> {
    entries(reader, leaf, "`storage`", "a storage image or buffer", |reader, binding, value| {
        let Shape::Parentheses = value.shape() else {
            let part = parts::any(reader, scope, value);
            return Some(Storage { binding: binding?, part: part?, access: None });
        };
        let fields: StorageFields<'_> = reader.read(value, "a storage image or buffer")?;
        let StorageFields { image, buffer, mip, layer, layers, previous, access } = fields;
        let selected = Selected { mip, layer, layers, previous, ..Selected::default() };
        let part = parts::one_of(reader, scope, value, image, buffer, selected);
        let access = chosen(reader, access, "an access", &ACCESSES);
        let (part, access) = (part?, access?);
        if let (Some(previous), Some(access)) = (part.previous(), access)
            && access.value != StorageAccess::Read
        {
            let written = Diagnostic::new(access.span, "what an earlier frame left can only be read");
            reader.report(written.label(previous.span, "an earlier frame"));
            return None;
        }
        if let (Part::Image(image), Some(previous)) = (part, part.previous()) {
            let sampled =
                Diagnostic::new(previous.span, "images of earlier frames can be sampled, not read as storage");
            reader.report(sampled.label(image.image.span, "this image").help("name it in `sample`"));
            return None;
        }
        Some(Storage { binding: binding?, part, access })
    })
}

/// Buffers that the shader reads as uniform blocks, by its names.
pub(super) fn uniforms<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Vec<Uniform>> {
    entries(reader, leaf, "`uniform`", "a uniform block", |reader, binding, value| {
        let part = parts::buffer(reader, scope, value);
        Some(Uniform { binding: binding?, part: part? })
    })
}

/// Values by the names of the shader's parameters.
pub(super) fn params<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Vec<Param>> {
    entries(reader, leaf, "`params`", "a parameter", |reader, name, leaf| {
        let (value, written) = values::param(reader, scope, leaf)?;
        Some(Param { name: name?, value: leaf.spanned(value), written })
    })
}

/// The entries of a map whose keys are names, each once.
fn entries<'src, T>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    map: &str,
    what: &str,
    mut lower: impl FnMut(&mut Reader, Option<Name>, Leaf<'src>) -> Option<T>,
) -> Option<Vec<T>> {
    let mut names = HashMap::new();
    let mut list = Vec::new();
    let mut complete = true;
    for (key, value) in reader.map(leaf, map)? {
        let name = reader.reference(key, what);
        if let Some(name) = &name
            && let Some(first) = names.insert(name.text.clone(), name.span)
        {
            let twice = Diagnostic::new(name.span, format!("{map} names `{}` twice", name.text));
            reader.report(twice.remark("again here").label(first, "first here"));
            complete = false;
        }
        match lower(reader, name, value) {
            Some(value) => list.push(value),
            None => complete = false,
        }
    }
    complete.then_some(list)
}
