//! The scope of an entry: settings or parameters, images, buffers, the scene, the view and the device.

use super::level::{DecidedValue, Elements, LevelValues, Properties};
use super::parameter::Parameter;
use super::symbols::Symbols;
use crate::base::Span;
use crate::expression::{Decision, Expression, Type, Wanted};
use crate::frame::{BufferIndex, ImageIndex, Resource};
use crate::language::inputs::Surroundings;
use crate::ron::{Leaf, Name, Names};
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// Expressions that were checked, by their place; `None` where a mistake was reported.
pub(crate) type Checked = RefCell<HashMap<Span, Option<Rc<Expression>>>>;

/// Everything that a name in quotes may refer to. A handle, copied freely.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    pub(crate) symbols: &'a Symbols,
    pub(crate) level: &'a LevelValues,
    /// Settings as the view at hand has them, or parameters; `None` where one has no value, which was reported.
    pub(crate) values: &'a [Option<DecidedValue>],
    pub(crate) surroundings: &'a Surroundings<'a>,
    /// Of the images that were evaluated so far, `None` where a mistake was reported; `None`: they are put off.
    pub(crate) properties: Option<&'a [Option<Properties>]>,
    /// The index of the repetition at hand.
    pub(crate) index: Option<(&'a Name, u32)>,
    pub(crate) checked: &'a Checked,
    /// Whether an expression without a value is no mistake, because it belongs to something that is off.
    pub(crate) lenient: bool,
    /// The view that the entry is for, unless it is the main one.
    pub(crate) view: Option<&'a Name>,
}

/// Whether a text in quotes is more than a name.
pub(super) fn is_expression(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit()) || text.contains(|c: char| " ()[].,+-*/%!<>=&|'".contains(c))
}

impl Scope<'_> {
    /// Whether a text is a plain name, and nothing that an expression can name is called so.
    pub(crate) fn names_nothing(&self, text: &str) -> bool {
        let Symbols { names, images, buffers, .. } = self.symbols;
        let one = |names: &Names| names.complete() && names.at(text).is_none();
        let index = self.index.is_some_and(|(index, _)| *index.text == *text);
        let word = !text.is_empty() && !is_expression(text) && !matches!(text, "true" | "false");
        word && !index && [names, images, buffers].into_iter().all(one)
    }

    /// What decided a value, with the view that it is of if that isn't the main one.
    pub(crate) fn within_view(&self, because: &str) -> String {
        match self.view {
            Some(name) if !because.is_empty() => format!("{because} in view `{}`", name.text),
            _ => because.to_owned(),
        }
    }

    /// What decided the value of a setting or parameter: "msaa = 4".
    pub(crate) fn because(&self, parameter: &Parameter, value: &DecidedValue) -> Option<Arc<str>> {
        if self.symbols.settings {
            return Some(format!("{} = {}", parameter.name.text, value.value).into());
        }
        joined(&value.decided)
    }

    /// The image or buffer with a plain name; most references are no more.
    pub(super) fn plain_reference(&self, plain: &str, wanted: Wanted<'_>) -> Option<Resource> {
        let Symbols { images, image_lists, buffers, buffer_lists, .. } = self.symbols;
        let one = |at: usize, lists: &[bool], blocks: &[Elements]| match (lists.get(at)?, blocks.get(at)?) {
            (false, Elements::At { first, .. }) => Some(*first),
            _ => None,
        };
        if wanted.types.contains(&Type::Image)
            && let Some(at) = images.at(plain)
        {
            return one(at, image_lists, &self.level.images).map(|index| Resource::Image(ImageIndex(index)));
        }
        if wanted.types.contains(&Type::Buffer)
            && let Some(at) = buffers.at(plain)
        {
            return one(at, buffer_lists, &self.level.buffers).map(|index| Resource::Buffer(BufferIndex(index)));
        }
        None
    }

    /// Whether a reference is an expression, or the name of something that isn't plainly an image or buffer.
    pub(super) fn refers_by_expression(&self, leaf: Leaf<'_>, wanted: Wanted<'_>) -> bool {
        let Some(plain) = leaf.plain() else { return false };
        let has = |ty: Type| wanted.types.contains(&ty);
        is_expression(plain)
            || has(Type::Image) && self.symbols.images.at(plain).is_some()
            || has(Type::Buffer) && self.symbols.buffers.at(plain).is_some()
            || self.index.is_some_and(|(index, _)| *index.text == *plain)
            || self.symbols.names.at(plain).is_some_and(|at| {
                !self.symbols.settings && (self.symbols.parameters.get(at).is_none_or(Option::is_none))
                    || [Type::Image, Type::Buffer].into_iter().any(|ty| self.symbols.stands_for(at, ty))
            })
    }
}

/// What decided, for people: "msaa = 4, hdr = true".
pub(crate) fn joined(decided: &[Decision]) -> Option<Arc<str>> {
    if decided.is_empty() {
        return None;
    }
    Some(decided.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ").into())
}
