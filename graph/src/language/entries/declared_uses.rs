//! `uses` of a custom pass: the stages, accesses and layouts of what the program records.

use super::lifetimes::{ACCESSES, LAYOUT, STAGES, StateLeaves, named_state};
use super::parts::{self, AnyPart, PartSelection};
use crate::fields;
use crate::language::model::DeclaredUse;
use crate::language::scope::{Context, FieldValue};
use crate::ron::{FieldTable, Form, Leaf, names};
use crate::vulkan::access::StateSubject;

fields! {
    /// A declared use: how the program's commands touch something that their pass names.
    /// ```ron
    /// (image: "image", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)
    /// ```
    struct DeclaredUseFields<'src> {
        /// Which image.
        image: Option<Leaf<'src>> => parts::EYE_IMAGE,
        /// Or which buffer.
        buffer: Option<Leaf<'src>> => parts::WHOLE_BUFFER,
        /// The first mip level, from 0.
        mip: Option<Leaf<'src>> => parts::FIRST,
        /// How many mip levels; one if `mip` stands alone, all if neither stands there.
        mips: Option<Leaf<'src>> => parts::COUNT,
        /// The first layer, from 0.
        layer: Option<Leaf<'src>> => parts::FIRST,
        /// How many layers; one if `layer` stands alone, all if neither stands there.
        layers: Option<Leaf<'src>> => parts::COUNT,
        /// Depth or stencil; all planes of the image if left out.
        plane: Option<Leaf<'src>> => parts::PLANE,
        /// How many frames back, as the pass names it.
        previous: Option<Leaf<'src>> => parts::PREVIOUS,
        /// The pipeline stages of the commands: `VK_PIPELINE_STAGE_2_…`.
        stages: Leaf<'src> => STAGES,
        /// Their accesses: `VK_ACCESS_2_…`.
        accesses: Leaf<'src> => ACCESSES,
        /// The layout of an image during the pass, `VK_IMAGE_LAYOUT_…`; a buffer has none.
        layout: Option<Leaf<'src>> => LAYOUT,
    }
}

/// The form of `uses`.
pub(crate) const USES: Form = Form::List(&Form::Fields(DeclaredUseFields::<'static>::table));

/// The form of `queue`.
pub(crate) const QUEUE: Form = Form::Choice("a queue", || names(&QUEUES));

/// Queues that a custom pass can be recorded for: whether it may be any.
pub(crate) const QUEUES: [(&str, bool); 2] = [("Graphics", false), ("Any", true)];

impl Context<'_> {
    /// The declared uses of a custom pass.
    pub(crate) fn declared_uses(&mut self, leaf: Leaf<'_>) -> Option<Vec<FieldValue<DeclaredUse>>> {
        let entries = self.reader.list(leaf, "`uses`")?;
        let uses: Vec<Option<FieldValue<DeclaredUse>>> =
            entries.into_iter().map(|entry| self.declared_use(entry)).collect();
        uses.into_iter().collect()
    }

    fn declared_use(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<DeclaredUse>> {
        let fields: DeclaredUseFields<'_> = self.reader.read(leaf, "a declared use")?;
        let DeclaredUseFields { image, buffer, mip, mips, layer, layers, plane, previous, .. } = fields;
        let selected = PartSelection { mip, mips, layer, layers, plane, previous };
        let part = self.part_of_either(leaf, image, buffer, selected);
        let of = if image.is_some() { StateSubject::Image } else { StateSubject::Buffer };
        let leaves = StateLeaves { stages: fields.stages, accesses: fields.accesses, layout: fields.layout };
        let state = named_state(self.reader, leaf, leaves, of);
        let (part, state, span) = (part?, state?, leaf.span());
        Some(AnyPart::part(part).map(move |part| DeclaredUse { part, span, state }))
    }
}
