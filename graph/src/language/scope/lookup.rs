//! The scope of an entry: settings or parameters, images, buffers, the scene, the view and the device.

use super::symbols::Symbols;
use crate::expression::{Type, WantedTypes};
use crate::frame::{BufferIndex, ImageIndex, Resource};
use crate::ron::{Leaf, Name, Names};

/// Everything that a name in quotes may refer to. A handle, copied freely.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    pub(crate) symbols: &'a Symbols,
    /// The index of the repetition at hand.
    pub(crate) index: Option<&'a Name>,
}

/// An image or buffer that is declared at a level, by number.
#[derive(Clone, Copy)]
pub(super) enum DeclaredResource {
    Image(usize),
    Buffer(usize),
}

/// Whether a text in quotes is more than a name.
pub(super) fn is_expression(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit()) || text.contains(|c: char| " ()[].,+-*/%!<>=&|'".contains(c))
}

impl Scope<'_> {
    /// Whether a text is the name of the index of the repetition at hand.
    pub(super) fn is_index(&self, text: &str) -> bool {
        self.index.is_some_and(|index| *index.text == *text)
    }

    /// Whether a text is a plain name, and nothing that an expression can name is called so.
    pub(crate) fn names_nothing(&self, text: &str) -> bool {
        let Symbols { names, images, buffers, .. } = self.symbols;
        let one = |names: &Names| names.complete() && names.at(text).is_none();
        let word = !text.is_empty() && !is_expression(text) && !matches!(text, "true" | "false");
        word && !self.is_index(text) && [names, images, buffers].into_iter().all(one)
    }

    /// The image or buffer with a plain name; most references are no more.
    pub(super) fn plain_reference(&self, plain: &str, wanted: WantedTypes<'_>) -> Option<DeclaredResource> {
        let Symbols { images, image_lists, buffers, buffer_lists, .. } = self.symbols;
        let one = |at: usize, lists: &[bool]| (lists.get(at) == Some(&false)).then_some(at);
        if wanted.types.contains(&Type::Image)
            && let Some(at) = images.at(plain)
        {
            return one(at, image_lists).map(DeclaredResource::Image);
        }
        if wanted.types.contains(&Type::Buffer)
            && let Some(at) = buffers.at(plain)
        {
            return one(at, buffer_lists).map(DeclaredResource::Buffer);
        }
        None
    }

    /// The image or buffer that a declaration stands for, if its index is the same at every evaluation.
    pub(super) fn fixed(&self, declared: DeclaredResource) -> Option<Resource> {
        let one = |at: usize, fixed: usize| if at < fixed { u32::try_from(at).ok() } else { None };
        match declared {
            DeclaredResource::Image(at) => one(at, self.symbols.fixed_images).map(|at| Resource::Image(ImageIndex(at))),
            DeclaredResource::Buffer(at) => {
                one(at, self.symbols.fixed_buffers).map(|at| Resource::Buffer(BufferIndex(at)))
            }
        }
    }

    /// Whether a reference is an expression, or the name of something that isn't plainly an image or buffer.
    pub(super) fn refers_by_expression(&self, leaf: Leaf<'_>, wanted: WantedTypes<'_>) -> bool {
        let Some(plain) = leaf.plain() else { return false };
        let has = |ty: Type| wanted.types.contains(&ty);
        is_expression(plain)
            || has(Type::Image) && self.symbols.images.at(plain).is_some()
            || has(Type::Buffer) && self.symbols.buffers.at(plain).is_some()
            || self.is_index(plain)
            || self.symbols.names.at(plain).is_some_and(|at| {
                !self.symbols.settings && (self.symbols.parameters.get(at).is_none_or(Option::is_none))
                    || [Type::Image, Type::Buffer].into_iter().any(|ty| self.symbols.stands_for(at, ty))
            })
    }
}
