//! `repeat`: how often an entry is repeated.

use super::diagnosed::Diagnosed;
use crate::base::Span;
use crate::language::model::Decided;
use crate::language::scope::{Context, FieldValue};
use crate::ron::{Form, Leaf, Name, PlainForm, Reader};

/// A pipeline has at most this many images, buffers, passes and uses of fragments, made and discarded ones together.
pub(crate) const MOST_THINGS: u32 = 1_000_000;

/// How `repeat` is written.
pub(crate) const REPEAT: Form = Form::Tuple(&[Form::Plain(PlainForm::Name), Form::Whole(0, MOST_THINGS as i64)]);

/// How often an entry is repeated.
pub(crate) enum Repeat {
    /// Once, under its own name.
    Once,
    /// As often as a number says.
    Times(Box<Times>),
    /// The field couldn't be read, which was reported.
    Broken,
}

/// As often as `count` says, the index counting from 0.
pub(crate) struct Times {
    /// The name of the index.
    index: Name,
    /// Where the number stands.
    pub(crate) span: Span,
    /// The number.
    pub(crate) count: Diagnosed<FieldValue<Decided<u32>>>,
}

impl Repeat {
    /// `("i", COUNT)`
    pub(crate) fn read(context: &mut Context<'_>, leaf: Option<Leaf<'_>>) -> Repeat {
        let Some(leaf) = leaf else { return Repeat::Once };
        let Context { reader, scope } = context;
        let parts: Option<[Leaf<'_>; 2]> = reader.read(leaf, "`(\"i\", count)`");
        let Some((index, count)) = parts.and_then(|[index, count]| Some((reader.name(index, "an index")?, count)))
        else {
            return Repeat::Broken;
        };
        scope.symbols.differs(reader, &index);
        let (span, most) = (count.span(), i64::from(MOST_THINGS));
        let read = |reader: &mut Reader| {
            Context { reader, scope: *scope }.whole_because(count, "number of repetitions", 0..=most)
        };
        Repeat::Times(Box::new(Times { index, span, count: Diagnosed::read(reader, read) }))
    }

    /// Whether it makes a list.
    pub(crate) const fn is_list(&self) -> bool {
        !matches!(self, Repeat::Once)
    }

    /// The name of the index, if there is one.
    pub(crate) const fn index(&self) -> Option<&Name> {
        if let Repeat::Times(times) = self { Some(&times.index) } else { None }
    }
}
