//! `copy`, `blit` and `fill`, and what `custom` reads and writes by transfer.

use super::bindings::{self, FILTERS};
use super::{parts, values};
use crate::fields;
use crate::language::model::{Part, Work};
use crate::language::scope::Scope;
use crate::ron::{Described, Form, Leaf, Reader, Shape};

fields! {
    /// A copy: bits as they are.
    /// ```ron
    /// (from: "image", to: "target")
    /// ```
    struct CopyFields<'src> {
        /// What is copied.
        from: Leaf<'src> => parts::ANY,
        /// To where.
        to: Leaf<'src> => parts::ANY,
    }
}

/// What `copy` takes.
pub(crate) const COPY: Form = Form::Fields(CopyFields::<'static>::table);

fields! {
    /// A blit: an image is copied and scaled.
    /// ```ron
    /// (from: (image: "image", mip: 0), to: (image: "image", mip: 1), filter: Linear)
    /// ```
    struct BlitFields<'src> {
        /// What is copied: one mip level.
        from: Leaf<'src> => parts::IMAGE,
        /// To where: one mip level.
        to: Leaf<'src> => parts::IMAGE,
        /// How texels are mixed; `Linear` for colour and else `Nearest` if left out.
        filter: Option<Leaf<'src>> => bindings::FILTER,
    }
}

/// What `blit` takes.
pub(crate) const BLIT: Form = Form::Fields(BlitFields::<'static>::table);

fields! {
    /// A fill: an image or buffer is set to a value.
    /// ```ron
    /// (to: "buffer", value: 0)
    /// ```
    struct FillFields<'src> {
        /// What is set.
        to: Leaf<'src> => parts::ANY,
        /// To what: a number for every component or word, depth and stencil, or red, green, blue and alpha.
        value: Leaf<'src> => values::FILL,
    }
}

/// What `fill` takes.
pub(crate) const FILL: Form = Form::Fields(FillFields::<'static>::table);

/// What `reads` and `writes` take.
pub(crate) const TRANSFERRED: Form = Form::Either(&[parts::WHOLE_RESOURCE, Form::List(&parts::ANY)]);

/// `copy: (from: …, to: …)`
pub(crate) fn copy<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Work> {
    let fields: CopyFields<'_> = reader.read(leaf, "a copy")?;
    let (from, to) = (parts::any(reader, scope, fields.from), parts::any(reader, scope, fields.to));
    Some(Work::Copy { from: from?, to: to? })
}

/// `blit: (from: …, to: …)`
pub(crate) fn blit<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Work> {
    let fields: BlitFields<'_> = reader.read(leaf, "a blit")?;
    let (from, to) = (parts::image(reader, scope, fields.from), parts::image(reader, scope, fields.to));
    let filter = match fields.filter {
        Some(leaf) => values::choice(reader, leaf, "a filter", &FILTERS).map(|filter| Some(leaf.spanned(filter))),
        None => Some(None),
    };
    Some(Work::Blit { from: Part::Image(from?), to: Part::Image(to?), filter: filter? })
}

/// `fill: (to: …, value: …)`
pub(crate) fn fill<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Work> {
    let fields: FillFields<'_> = reader.read(leaf, "a fill")?;
    let to = parts::any(reader, scope, fields.to);
    let value = values::fill(reader, scope, fields.value).map(|value| fields.value.spanned(value));
    Some(Work::Fill { to: to?, value: value? })
}

/// Parts of images and buffers in a list.
pub(crate) fn listed<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Option<Leaf<'src>>,
    field: &str,
) -> Option<Vec<Part>> {
    let Some(leaf) = leaf else { return Some(Vec::new()) };
    let entries = match leaf.shape() {
        Shape::List => reader.list(leaf, field)?,
        _ => vec![leaf],
    };
    let parts: Vec<Option<Part>> = entries.into_iter().map(|entry| parts::any(reader, scope, entry)).collect();
    parts.into_iter().collect()
}
