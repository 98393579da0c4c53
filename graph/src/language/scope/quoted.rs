//! What stands in quotes: names of what the level at hand declares, and expressions over them.

use super::level::{Block, Given, Level, Properties};
use super::parameter::{Parameter, ParameterKind};
use super::symbols::Known;
use crate::base::{Diagnostic, Label, Span};
use crate::expression::{Decision, Expression, Outcome, Type, Value, Wanted};
use crate::frame::{BufferIndex, ImageIndex, Resource};
use crate::language::inputs::Surroundings;
use crate::language::model::{BufferRef, ImageRef, ResourceRef, SettingKind};
use crate::ron::{Leaf, Name, Names, Reader, Shape};
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

/// Expressions that were checked, by their place; `None` where a mistake was reported.
pub(crate) type Checked = RefCell<HashMap<Span, Option<Rc<Expression>>>>;

/// Everything that a name in quotes may stand for. A handle, copied freely.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    pub(crate) known: &'a Known,
    pub(crate) level: &'a Level,
    /// Settings as the view at hand has them, or parameters; `None` where one has no value, which was reported.
    pub(crate) given: &'a [Option<Given>],
    pub(crate) surroundings: &'a Surroundings<'a>,
    /// Of the images that were lowered so far; `None` where a mistake was reported.
    pub(crate) properties: &'a [Option<Properties>],
    /// The index of the repetition at hand.
    pub(crate) index: Option<(&'a Name, u32)>,
    pub(crate) checked: &'a Checked,
    /// Whether values that there are not are no mistake: what they are for is off.
    pub(crate) lenient: bool,
    /// Whether any value was missing leniently.
    pub(crate) forgave: &'a Cell<bool>,
    /// Whether properties of images are to be put off.
    pub(crate) early: bool,
    /// The view that the entry is for, unless it is the main one.
    pub(crate) view: Option<&'a Name>,
}

/// What a text in quotes is, where a value is wanted.
pub(crate) enum Quoted<'a> {
    /// The plain name of a setting or parameter, and its value.
    Given(&'a Parameter, &'a Given),
    /// Anything else.
    Expression,
}

/// Whether a text in quotes is more than a name.
fn is_expression(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit()) || text.contains(|c: char| " ()[].,+-*/%!<>=&|'".contains(c))
}

impl<'a> Scope<'a> {
    /// The value of an expression, and what decided it.
    pub(crate) fn evaluate(&self, reader: &mut Reader, leaf: Leaf<'_>, wanted: Wanted<'_>) -> Option<Outcome> {
        let expression = self.check(reader, leaf, wanted)?;
        match expression.evaluate(self) {
            Ok(outcome) => Some(outcome),
            Err(errors) => {
                for mut error in errors {
                    if let Some(Label { text, .. }) = error.labels.first_mut() {
                        *text = self.within_view(text);
                    }
                    self.fault(reader, leaf, error);
                }
                self.forgave.set(true);
                None
            }
        }
    }

    /// A condition: `Some(None)` if it holds, else what made it fail.
    pub(crate) fn condition(&self, reader: &mut Reader, leaf: Leaf<'_>) -> Option<Option<String>> {
        let fits = |kind: &SettingKind| matches!(kind, SettingKind::Bool { .. });
        if let Quoted::Given(parameter, given) = self.quoted_or(reader, leaf, fits, "`true` or `false`", None)? {
            let failed = || self.because(parameter, given).map(|because| because.to_string());
            let holds = given.value == Value::Bool(true);
            return Some((!holds).then(|| failed().unwrap_or_else(|| format!("`{}` is false", parameter.name.text))));
        }
        let outcome = self.evaluate(reader, leaf, Wanted::BOOL)?;
        let Some(failed) = &outcome.failed else { return Some(None) };
        let because = outcome.because();
        Some(Some(if because.is_empty() { format!("`{}` does not hold", failed.text) } else { because }))
    }

    /// The expression that stands at `leaf`, checked once.
    fn check(&self, reader: &mut Reader, leaf: Leaf<'_>, wanted: Wanted<'_>) -> Option<Rc<Expression>> {
        if let Some(known) = self.checked.borrow().get(&leaf.span()) {
            return known.clone();
        }
        let expression = match (leaf.shape(), leaf.plain()) {
            (Shape::Text, Some(text)) => match Expression::new(text, leaf.span_of(text), self, wanted) {
                Ok(expression) => Some(Rc::new(expression)),
                Err(errors) => {
                    errors.into_iter().for_each(|error| reader.report(error));
                    None
                }
            },
            (Shape::Text, None) => {
                reader.wrong(leaf, "expressions take no escapes", "write the characters themselves");
                None
            }
            _ => {
                reader.expected(leaf, &format!("{}, or an expression in quotes", wanted.words));
                None
            }
        };
        self.checked.borrow_mut().insert(leaf.span(), expression.clone());
        expression
    }

    /// Reports what is wrong with a value, unless an expression says one for something that is off.
    pub(crate) fn fault(&self, reader: &mut Reader, leaf: Leaf<'_>, diagnostic: Diagnostic) {
        if self.lenient && matches!(leaf.shape(), Shape::Text) {
            self.forgave.set(true);
        } else {
            reader.report(diagnostic);
        }
    }

    /// What a text in quotes is. Reports a plain name that nothing has, and a setting whose kind doesn't fit; `wanted`
    /// says what would: a number, which may stand there without quotes.
    pub(crate) fn quoted(
        &self,
        reader: &mut Reader,
        leaf: Leaf<'_>,
        fits: impl Fn(&SettingKind) -> bool + Copy,
        wanted: &str,
    ) -> Option<Quoted<'a>> {
        self.quoted_or(reader, leaf, fits, wanted, Some(wanted))
    }

    /// The same, with what may stand there without quotes, if anything may.
    pub(crate) fn quoted_or(
        &self,
        reader: &mut Reader,
        leaf: Leaf<'_>,
        fits: impl Fn(&SettingKind) -> bool + Copy,
        wanted: &str,
        literal: Option<&str>,
    ) -> Option<Quoted<'a>> {
        let plain = leaf.plain().unwrap_or_default();
        let index = self.index.is_some_and(|(index, _)| *index.text == *plain);
        let thing = self.known.images.at(plain).is_some() || self.known.buffers.at(plain).is_some();
        let other = thing && self.known.given.at(plain).is_none();
        if plain.is_empty() || is_expression(plain) || index || other {
            return Some(Quoted::Expression);
        }
        if matches!(plain, "true" | "false") || crate::vulkan::Format::from_name(plain).is_some() {
            return Some(Quoted::Expression);
        }
        let name = reader.reference(leaf, if self.known.settings { "a setting" } else { "a parameter" })?;
        let fitting = |at: usize| match self.known.parameters.get(at).and_then(Option::as_ref) {
            Some(Parameter { kind: ParameterKind::Value(kind), .. }) => fits(kind),
            _ => false,
        };
        let at = self.known.given.find_fitting(reader, &name, fitting, literal)?;
        let parameter = self.known.parameters.get(at)?.as_ref()?;
        let ParameterKind::Value(kind) = &parameter.kind else { return Some(Quoted::Expression) };
        if !fits(kind) {
            let (word, text) = (self.known.given_word(), &name.text);
            let message = format!("{word} `{text}` is {}; {wanted} is needed here", kind.words());
            reader.report(Diagnostic::new(name.span, message).label(parameter.name.span, "declared here"));
            return None;
        }
        self.given.get(at)?.as_ref().map(|given| Quoted::Given(parameter, given))
    }

    /// Whether a text is a plain name, and nothing that an expression can name is called so.
    pub(crate) fn names_nothing(&self, text: &str) -> bool {
        let Known { given, images, buffers, .. } = self.known;
        let one = |names: &Names| names.complete() && names.at(text).is_none();
        let index = self.index.is_some_and(|(index, _)| *index.text == *text);
        let word = !text.is_empty() && !is_expression(text) && !matches!(text, "true" | "false");
        word && !index && [given, images, buffers].into_iter().all(one)
    }

    /// What decided a value, with the view that it is of if that isn't the main one.
    pub(crate) fn within_view(&self, because: &str) -> String {
        match self.view {
            Some(name) if !because.is_empty() => format!("{because} in view `{}`", name.text),
            _ => because.to_owned(),
        }
    }

    /// What decided the value of a setting or parameter: "msaa = 4".
    pub(crate) fn because(&self, parameter: &Parameter, given: &Given) -> Option<Arc<str>> {
        if self.known.settings {
            return Some(format!("{} = {}", parameter.name.text, given.value).into());
        }
        joined(&given.decided)
    }

    /// An image that is referred to.
    pub(crate) fn image(&self, reader: &mut Reader, leaf: Leaf<'_>) -> Option<ImageRef> {
        match self.reference(reader, leaf, Wanted::IMAGE, "an image")?.resource {
            Resource::Image(index) => Some(ImageRef { index, span: leaf.span() }),
            Resource::Buffer(_) => None,
        }
    }

    /// A buffer that is referred to.
    pub(crate) fn buffer(&self, reader: &mut Reader, leaf: Leaf<'_>) -> Option<BufferRef> {
        match self.reference(reader, leaf, Wanted::BUFFER, "a buffer")?.resource {
            Resource::Buffer(index) => Some(BufferRef { index, span: leaf.span() }),
            Resource::Image(_) => None,
        }
    }

    /// An image or buffer that is referred to.
    pub(crate) fn resource(&self, reader: &mut Reader, leaf: Leaf<'_>) -> Option<ResourceRef> {
        self.reference(reader, leaf, Wanted::RESOURCE, "an image or buffer")
    }

    fn reference(&self, reader: &mut Reader, leaf: Leaf<'_>, wanted: Wanted<'_>, what: &str) -> Option<ResourceRef> {
        let span = leaf.span();
        if let Some(resource) = leaf.plain().and_then(|plain| self.plain_reference(plain, wanted)) {
            return Some(ResourceRef { resource, span });
        }
        if !self.refers_by_expression(leaf, wanted) {
            let name = reader.reference(leaf, what)?;
            self.unknown(reader, &name, wanted);
            return None;
        }
        match self.evaluate(reader, leaf, wanted)?.value {
            Value::Image(index) => Some(ResourceRef { resource: Resource::Image(index), span }),
            Value::Buffer(index) => Some(ResourceRef { resource: Resource::Buffer(index), span }),
            _ => None,
        }
    }

    /// The image or buffer with a plain name; most references are no more.
    fn plain_reference(&self, plain: &str, wanted: Wanted<'_>) -> Option<Resource> {
        let Known { images, image_lists, buffers, buffer_lists, .. } = self.known;
        let one = |at: usize, lists: &[bool], blocks: &[Block]| match (lists.get(at)?, blocks.get(at)?) {
            (false, Block::At { first, .. }) => Some(*first),
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
    fn refers_by_expression(&self, leaf: Leaf<'_>, wanted: Wanted<'_>) -> bool {
        let Some(plain) = leaf.plain() else { return false };
        let has = |ty: Type| wanted.types.contains(&ty);
        is_expression(plain)
            || has(Type::Image) && self.known.images.at(plain).is_some()
            || has(Type::Buffer) && self.known.buffers.at(plain).is_some()
            || self.index.is_some_and(|(index, _)| *index.text == *plain)
            || self.known.given.at(plain).is_some_and(|at| {
                !self.known.settings && (self.known.parameters.get(at).is_none_or(Option::is_none))
                    || [Type::Image, Type::Buffer].into_iter().any(|ty| self.known.stands_for(at, ty))
            })
    }

    /// Reports a name of another kind, or that nothing has.
    fn unknown(&self, reader: &mut Reader, name: &Name, wanted: Wanted<'_>) {
        let (image, buffer) = (wanted.types.contains(&Type::Image), wanted.types.contains(&Type::Buffer));
        let others = if image { (&self.known.buffers, "a buffer") } else { (&self.known.images, "an image") };
        if image != buffer
            && let Some(other) = others.0.find_name(&name.text)
        {
            let message = format!("`{}` is {}; {} is needed here", name.text, others.1, wanted.words);
            reader.report(Diagnostic::new(name.span, message).label(other.span, "declared here"));
            return;
        }
        if !(self.known.images.complete() && self.known.buffers.complete()) {
            return;
        }
        let no_buffers = self.known.buffers.in_order().next().is_none();
        let what = match (image, buffer) {
            (true, true) if !no_buffers => "image or buffer",
            (true, _) => "image",
            _ => "buffer",
        };
        let images = if image { Some(self.known.all_of(Type::Image)) } else { None };
        let buffers = if buffer { Some(self.known.all_of(Type::Buffer)) } else { None };
        let known = images.into_iter().flatten().chain(buffers.into_iter().flatten());
        let help = reader.known(&name.text, known);
        let unknown = Diagnostic::new(name.span, format!("there is no {what} named `{}`", name.text));
        reader.report(Diagnostic { help, ..unknown });
    }
}

/// What decided, for people: "msaa = 4, hdr = true".
pub(crate) fn joined(decided: &[Decision]) -> Option<Arc<str>> {
    if decided.is_empty() {
        return None;
    }
    Some(decided.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ").into())
}
