//! References to images and buffers: plain names, or expressions.

use super::context::Context;
use super::field_value::FieldValue;
use crate::base::{Code, Diagnostic};
use crate::expression::{Expression, Type, WantedTypes};
use crate::frame::Resource;
use crate::language::model::{BufferRef, ImageRef, ResourceRef};
use crate::ron::{Leaf, Name};

impl Context<'_> {
    /// An image that is referred to.
    pub(crate) fn image(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<ImageRef>> {
        self.reference(leaf, WantedTypes::IMAGE, "an image")?.then(|of| match of.resource {
            Resource::Image(index) => Some(ImageRef { index, span: of.span }),
            Resource::Buffer(_) => None,
        })
    }

    /// A buffer that is referred to.
    pub(crate) fn buffer(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<BufferRef>> {
        self.reference(leaf, WantedTypes::BUFFER, "a buffer")?.then(|of| match of.resource {
            Resource::Buffer(index) => Some(BufferRef { index, span: of.span }),
            Resource::Image(_) => None,
        })
    }

    /// An image or buffer that is referred to.
    pub(crate) fn resource(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<ResourceRef>> {
        self.reference(leaf, WantedTypes::RESOURCE, "an image or buffer")
    }

    fn reference(&mut self, leaf: Leaf<'_>, wanted: WantedTypes<'_>, what: &str) -> Option<FieldValue<ResourceRef>> {
        let span = leaf.span();
        let found = move |resource: Resource| ResourceRef { resource, span };
        if let Some(plain) = leaf.plain()
            && let Some(declared) = self.scope.plain_reference(plain, wanted)
        {
            if let Some(fixed) = self.scope.fixed(declared) {
                return Some(FieldValue::Constant(found(fixed)));
            }
            // The expression reports an image or buffer that isn't evaluated yet.
            let expression = Expression::new(plain, leaf.span_of(plain), &self.scope, wanted).ok();
            return Some(FieldValue::computed(move |evaluator| {
                let known = evaluator.declared(declared);
                known.or_else(|| evaluator.resource(expression.as_ref()?)).map(found)
            }));
        }
        if !self.scope.refers_by_expression(leaf, wanted) {
            let name = self.reader.reference(leaf, what)?;
            self.unknown(&name, wanted);
            return None;
        }
        let expression = self.expression(leaf, wanted)?;
        Some(FieldValue::computed(move |evaluator| evaluator.resource(&expression).map(found)))
    }

    /// Reports a name of another kind, or a name that nothing has.
    fn unknown(&mut self, name: &Name, wanted: WantedTypes<'_>) {
        let (image, buffer) = (wanted.types.contains(&Type::Image), wanted.types.contains(&Type::Buffer));
        let others =
            if image { (&self.scope.symbols.buffers, "a buffer") } else { (&self.scope.symbols.images, "an image") };
        if image != buffer
            && let Some(other) = others.0.find_name(&name.text)
        {
            let message = format!("`{}` is {}; {} is needed here", name.text, others.1, wanted.words);
            self.reader
                .report(Diagnostic::new(Code::WRONG_KIND, name.span, message).label(other.span, "declared here"));
            return;
        }
        if !(self.scope.symbols.images.complete() && self.scope.symbols.buffers.complete()) {
            return;
        }
        let no_buffers = self.scope.symbols.buffers.in_order().next().is_none();
        let (code, what) = match (image, buffer) {
            (true, true) if !no_buffers => (Code::UNKNOWN_IMAGE_OR_BUFFER, "image or buffer"),
            (true, _) => (Code::UNKNOWN_IMAGE, "image"),
            _ => (Code::UNKNOWN_BUFFER, "buffer"),
        };
        let images = if image { Some(self.scope.symbols.all_of(Type::Image)) } else { None };
        let buffers = if buffer { Some(self.scope.symbols.all_of(Type::Buffer)) } else { None };
        let known = images.into_iter().flatten().chain(buffers.into_iter().flatten());
        let help = self.reader.known(&name.text, known);
        self.reader.report(Diagnostic { help, ..Diagnostic::unknown_name(code, what, &name.text).at(name.span) });
    }
}
