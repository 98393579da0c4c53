//! `outputs`: images and buffers that leave the frame, and their states.

use super::values::{self, optional};
use super::{lifetimes, parts};
use crate::base::{Code, Diagnostic};
use crate::fields;
use crate::frame::Resource;
use crate::language::model::{Output, ResourceRef};
use crate::language::scope::{Context, Evaluator, FieldValue};
use crate::ron::{FieldTable, Form, Leaf, Shape, names};
use crate::vulkan::Encoding;
use crate::vulkan::access::StateSubject;
use std::collections::HashMap;

fields! {
    /// An output: an image or buffer that leaves the frame.
    /// ```ron
    /// (image: "image", after: Present)
    /// ```
    struct OutputFields<'src> {
        /// Which image.
        image: Option<Leaf<'src>> => parts::WHOLE_IMAGE,
        /// Or which buffer.
        buffer: Option<Leaf<'src>> => parts::WHOLE_BUFFER,
        /// The state in which it is left; the state of its last use if left out.
        after: Option<Leaf<'src>> => lifetimes::STATE,
        /// The encoding of an image's numbers, for display and for files. If left out, the format tells it, as far as it
        /// does. An encoding that the format can't hold is refused.
        encoding: Option<Leaf<'src>> => Form::Choice("an encoding", || names(&ENCODINGS)),
    }
}

/// The form of `outputs`: a list of images and buffers.
pub(crate) const OUTPUTS: Form =
    Form::List(&Form::Either(&[parts::WHOLE_RESOURCE, Form::Fields(OutputFields::<'static>::table)]));

/// Encodings of an output's numbers, by name.
const ENCODINGS: [(&str, Encoding); 4] = [
    (Encoding::Srgb.name(), Encoding::Srgb),
    (Encoding::Unorm.name(), Encoding::Unorm),
    (Encoding::Linear.name(), Encoding::Linear),
    (Encoding::Hdr10.name(), Encoding::Hdr10),
];

const NAME_ONE: &str = "name the image that is shown: `outputs: [\"…\"]`, in an extension `Insert(outputs: [\"…\"])`";

impl Context<'_> {
    /// The images and buffers that leave the frame.
    pub(crate) fn outputs(&mut self, list: Leaf<'_>) -> Option<Vec<Option<FieldValue<Output>>>> {
        let leaves = self.reader.list(list, "`outputs`")?;
        if leaves.is_empty() {
            self.reader.wrong(Code::NO_OUTPUTS, list, "a frame without outputs shows nothing", NAME_ONE);
            return None;
        }
        Some(leaves.into_iter().map(|leaf| self.output(leaf)).collect())
    }

    fn output(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Output>> {
        let Shape::Parentheses = leaf.shape() else {
            let resource = self.resource(leaf)?;
            return Some(resource.map(|resource| Output { resource, after: None, encoding: None, eye: None }));
        };
        let fields: OutputFields<'_> = self.reader.read(leaf, "an output")?;
        let (resource, of) = match (fields.image, fields.buffer) {
            (Some(image), None) => (self.image(image).map(|image| image.map(ResourceRef::from)), StateSubject::Image),
            (None, Some(buffer)) => {
                (self.buffer(buffer).map(|buffer| buffer.map(ResourceRef::from)), StateSubject::Buffer)
            }
            _ => {
                let help = "write `(image: \"…\", after: …)` or `(buffer: \"…\", after: …)`";
                self.reader.wrong(Code::IMAGE_OR_BUFFER, leaf, "an output is one image or one buffer", help);
                return None;
            }
        };
        let after = optional(fields.after, |after| lifetimes::state(self.reader, after, of));
        let encoding = match (fields.encoding, of) {
            (Some(leaf), StateSubject::Buffer) => {
                self.reader.wrong(
                    Code::ENCODING,
                    leaf,
                    "the bytes of a buffer have no encoding",
                    "leave `encoding` out",
                );
                None
            }
            (encoding, _) => values::optional_choice(self.reader, encoding, "an encoding", &ENCODINGS),
        };
        let (after, encoding) = (after?, encoding?);
        Some(resource?.map(move |resource| Output { resource, after, encoding, eye: None }))
    }
}

impl Evaluator<'_, '_> {
    /// The images and buffers that leave the frame, each once.
    pub(crate) fn outputs(&mut self, outputs: &[Option<FieldValue<Output>>]) -> Option<Vec<Output>> {
        let outputs: Vec<Option<Output>> = outputs.iter().map(|output| self.put_in(output)).collect();
        let mut first = HashMap::new();
        for output in outputs.iter().flatten() {
            let ResourceRef { resource, span } = output.resource;
            if let Some(first) = first.insert(resource, span) {
                let what = if matches!(resource, Resource::Image(_)) { "image" } else { "buffer" };
                let twice = Diagnostic::new(Code::LISTED_TWICE, span, format!("this {what} is an output twice"));
                self.reader.report(twice.remark("again here").label(first, "first here"));
            }
        }
        outputs.into_iter().collect()
    }
}
