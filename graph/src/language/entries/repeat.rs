//! `repeat`: how often an entry stands there.

use crate::base::Span;
use crate::ron::{Form, Leaf, Name, Plain, Reader};

/// A pipeline has at most this many images, buffers, passes and uses of fragments, made and discarded ones together.
pub(crate) const MOST_THINGS: u32 = 1_000_000;

/// How `repeat` is written.
pub(crate) const REPEAT: Form = Form::Tuple(&[Form::Plain(Plain::Name), Form::Whole(0, MOST_THINGS as i64)]);

/// How often something stands there.
#[derive(Debug, Clone)]
pub(crate) enum Repeat<T> {
    /// Once, under its own name.
    Once,
    /// As often as `count` says, the index counting from 0.
    Times {
        /// The name of the index.
        index: Name,
        /// Where the number stands.
        span: Span,
        /// The number, or an expression.
        count: T,
    },
    /// That couldn't be read, which was reported.
    Broken,
}

impl<'t> Repeat<Leaf<'t>> {
    /// `("i", COUNT)`
    pub(crate) fn read(reader: &mut Reader, leaf: Option<Leaf<'t>>) -> Self {
        let Some(leaf) = leaf else { return Repeat::Once };
        let parts: Option<[Leaf<'t>; 2]> = reader.read(leaf, "`(\"i\", count)`");
        match parts.and_then(|[index, count]| Some((reader.name(index, "an index")?, count))) {
            Some((index, count)) => Repeat::Times { index, span: count.span(), count },
            None => Repeat::Broken,
        }
    }
}

impl<T> Repeat<T> {
    /// Whether it makes a list.
    pub(crate) const fn is_list(&self) -> bool {
        !matches!(self, Repeat::Once)
    }

    /// The name of the index, if there is one.
    pub(crate) const fn index(&self) -> Option<&Name> {
        if let Repeat::Times { index, .. } = self { Some(index) } else { None }
    }
}
