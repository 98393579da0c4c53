//! Values of interface files.

use crate::base::Code;
use crate::ron::{Leaf, Reader};

/// The entries of a list; none if it was left out or is none.
pub(super) fn list<'t>(reader: &mut Reader, leaf: Option<Leaf<'t>>, what: &str) -> Vec<Leaf<'t>> {
    leaf.and_then(|leaf| reader.list(leaf, what)).unwrap_or_default()
}

/// A whole number that isn't negative.
pub(super) fn number(reader: &mut Reader, leaf: Leaf<'_>, what: &str) -> Option<u32> {
    let number = reader.integer(leaf)?;
    let small = u32::try_from(number).ok();
    if small.is_none() {
        reader.wrong(Code::NUMBER_OUTSIDE, leaf, format!("{what} can't be {number}"), "");
    }
    small
}
