//! Names of the elements of arrays: `taps[2]` is the third of `taps`.

use super::Binding;
use std::borrow::Cow;

/// The name of an element of the array `array`, numbered from 0.
#[must_use]
pub fn element_name(array: &str, element: u32) -> String {
    format!("{array}[{element}]")
}

/// The array of which `name` is an element, and the element's number; `None`: it is the name of no element.
#[must_use]
pub fn element_of(name: &str) -> Option<(&str, u32)> {
    let (array, number) = name.strip_suffix(']')?.rsplit_once('[')?;
    let plain = number == "0" || !number.starts_with(['0', '+']);
    Some((array, number.parse().ok().filter(|_| plain)?))
}

/// The name of the array, if `name` is that of an element, else the name itself.
#[must_use]
pub fn declared_name(name: &str) -> &str {
    element_of(name).map_or(name, |(array, _)| array)
}

impl Binding {
    /// How many descriptors it takes: one for each element of an array.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.length.unwrap_or(1)
    }

    /// The name under which a pass gives the element of this number; of what is no array its own name.
    #[must_use]
    pub fn element(&self, number: u32) -> Cow<'_, str> {
        match self.length {
            None => Cow::Borrowed(&self.name),
            Some(_) => Cow::Owned(element_name(&self.name, number)),
        }
    }

    /// Whether a pass that gives something under `name` gives it to this, or to an element of this.
    #[must_use]
    pub fn takes(&self, name: &str) -> bool {
        match self.length {
            None => self.name == name,
            Some(length) => element_of(name).is_some_and(|(array, element)| array == self.name && element < length),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{BindingKind, Block};
    use crate::vulkan::Stages;

    #[test]
    fn an_element_has_the_name_of_its_array_and_a_number_in_one_spelling() {
        assert_eq!(element_name("taps", 12), "taps[12]");
        assert_eq!(element_of("taps[12]"), Some(("taps", 12)));
        assert_eq!(element_of("taps[0]"), Some(("taps", 0)));
        for other in ["taps", "taps[]", "taps[01]", "taps[+1]", "taps[-1]", "taps[1", "taps1]", "taps[4294967296]", "]"]
        {
            assert_eq!(element_of(other), None, "{other}");
        }
        assert_eq!([declared_name("taps[3]"), declared_name("taps")], ["taps"; 2]);
    }

    #[test]
    fn a_binding_takes_its_own_name_or_those_of_its_elements() {
        let taking = |length| {
            let kind = BindingKind::UniformBlock(Block::default());
            let (name, stages) = ("taps".to_owned(), Stages::empty());
            let binding = Binding { set: 0, binding: 0, name, kind, length, adapts: false, separate: false, stages };
            ["taps", "taps[0]", "taps[2]", "taps[3]", "other[0]"].map(|name| binding.takes(name))
        };
        assert_eq!(taking(None), [true, false, false, false, false]);
        assert_eq!(taking(Some(3)), [false, true, true, false, false]);
    }
}
