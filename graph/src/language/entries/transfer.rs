//! `copy`, `blit` and `fill`, and the transfers of `custom`.

use super::bindings::{self, FILTERS};
use super::parts;
use super::values;
use crate::fields;
use crate::language::model::{Part, Work};
use crate::language::scope::{Context, FieldValue, combined};
use crate::ron::{FieldTable, Form, Leaf, Shape};

fields! {
    /// A copy: bits as they are.
    /// ```ron
    /// (from: "image", to: "target")
    /// ```
    struct CopyFields<'src> {
        /// The source.
        from: Leaf<'src> => parts::ANY,
        /// The target.
        to: Leaf<'src> => parts::ANY,
    }
}

/// The fields of `copy`.
pub(crate) const COPY: Form = Form::Fields(CopyFields::<'static>::table);

fields! {
    /// A blit: an image is copied and scaled.
    /// ```ron
    /// (from: (image: "image", mip: 0), to: (image: "image", mip: 1), filter: Linear)
    /// ```
    struct BlitFields<'src> {
        /// The source: one mip level.
        from: Leaf<'src> => parts::IMAGE,
        /// The target: one mip level.
        to: Leaf<'src> => parts::IMAGE,
        /// The filter between texels; `Linear` for colour and else `Nearest` if left out.
        filter: Option<Leaf<'src>> => bindings::FILTER,
    }
}

/// The fields of `blit`.
pub(crate) const BLIT: Form = Form::Fields(BlitFields::<'static>::table);

fields! {
    /// A fill: an image or buffer is set to a value.
    /// ```ron
    /// (to: "buffer", value: 0)
    /// ```
    struct FillFields<'src> {
        /// The target.
        to: Leaf<'src> => parts::ANY,
        /// The value: a number for every component or word, depth and stencil, or red, green, blue and alpha. A number fills depth, or the
        /// one plane that `to` names. The image's format must hold it.
        value: Leaf<'src> => values::FILL,
    }
}

/// The fields of `fill`.
pub(crate) const FILL: Form = Form::Fields(FillFields::<'static>::table);

/// The form of `reads` and `writes`: an image or buffer, or a list of them and their parts.
pub(crate) const TRANSFERRED: Form = Form::Either(&[parts::WHOLE_RESOURCE, Form::List(&parts::ANY)]);

impl Context<'_> {
    /// `copy: (from: …, to: …)`
    pub(crate) fn copy_work(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Work>> {
        let fields: CopyFields<'_> = self.reader.read(leaf, "a copy")?;
        let (from, to) = (self.part(fields.from), self.part(fields.to));
        Some(combined((from?, to?), |(from, to)| Work::Copy { from, to }))
    }

    /// `blit: (from: …, to: …)`
    pub(crate) fn blit_work(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Work>> {
        let fields: BlitFields<'_> = self.reader.read(leaf, "a blit")?;
        let (from, to) = (self.image_part(fields.from), self.image_part(fields.to));
        let filter = values::optional_choice(self.reader, fields.filter, "a filter", &FILTERS)?;
        Some(combined((from?, to?), move |(from, to)| Work::Blit {
            from: Part::Image(from),
            to: Part::Image(to),
            filter,
        }))
    }

    /// `fill: (to: …, value: …)`
    pub(crate) fn fill_work(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Work>> {
        let fields: FillFields<'_> = self.reader.read(leaf, "a fill")?;
        let (to, value) = (self.part(fields.to), self.fill(fields.value));
        Some(combined((to?, value?), |(to, value)| Work::Fill { to, value }))
    }

    /// Parts of images and buffers in a list.
    pub(crate) fn listed_parts(&mut self, leaf: Option<Leaf<'_>>, field: &str) -> Option<Vec<FieldValue<Part>>> {
        let Some(leaf) = leaf else { return Some(Vec::new()) };
        let entries = match leaf.shape() {
            Shape::List => self.reader.list(leaf, field)?,
            _ => vec![leaf],
        };
        let parts: Vec<Option<FieldValue<Part>>> = entries.into_iter().map(|entry| self.part(entry)).collect();
        parts.into_iter().collect()
    }
}
