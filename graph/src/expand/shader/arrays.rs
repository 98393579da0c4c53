//! Arrays of images that a shader declares: a pass gives an image to each element.

use crate::base::{Code, Diagnostic, Span};
use crate::language;
use crate::ron::Name;
use crate::shader::{Binding, PASS_SET, ShaderInterface, element_of};

/// What a pass gives under `name` goes to this binding of its shader.
pub(in crate::expand) fn binding<'i>(interface: &'i ShaderInterface, name: &str) -> Option<&'i Binding> {
    interface.bindings.iter().find(|binding| binding.set == PASS_SET && binding.takes(name))
}

/// Finds a binding whose use as an array or as a single thing doesn't match the shader, or that is beyond the end of an array.
/// Returns its name in the shader, and the mistake: of an array, that of the first such element.
pub(super) fn misfit<'i>(
    shader: &str,
    interface: &'i ShaderInterface,
    given: &Name,
) -> Option<(&'i str, Option<Diagnostic>)> {
    let (name, element) = element_of(&given.text).map_or((&*given.text, None), |(name, at)| (name, Some(at)));
    let binding = interface.bindings.iter().find(|binding| binding.set == PASS_SET && binding.name == name)?;
    if binding.kind.unbindable().is_some() {
        // It is reported with the shader.
        return Some((&binding.name, None));
    }
    let (at, said, help) = match (binding.length, element) {
        (Some(length), None) => {
            (0, format!("as an array of {length}, and is given no list"), format!("write a list: `{}`", form(binding)))
        }
        (None, Some(_)) => (0, "as no array, and is given a list".to_owned(), format!("write `{}`", form(binding))),
        (Some(length), Some(at)) if at >= length => {
            (length, format!("as an array of {length}, and is given more"), "leave this one out".to_owned())
        }
        _ => return None,
    };
    let message = format!("shader `{shader}` declares `{name}` {said}");
    let first = element.is_none_or(|element| element == at);
    Some((&binding.name, first.then(|| Diagnostic::new(Code::BINDING_ARRAY, given.span, message).help(help))))
}

/// How a pipeline file gives something to a binding: `"source": "…"`, or `"taps": ["…", "…"]`.
pub(in crate::expand) fn form(binding: &Binding) -> String {
    if binding.length.is_none() {
        return format!("\"{}\": \"…\"", binding.name);
    }
    const MOST_SHOWN: u32 = 4;
    let shown = vec!["\"…\""; binding.count().min(MOST_SHOWN) as usize].join(", ");
    let more = if binding.count() > MOST_SHOWN { ", …" } else { "" };
    format!("\"{}\": [{shown}{more}]", binding.name)
}

/// Where a pass gives the element of this binding before the one with a number; `None`: nowhere.
pub(in crate::expand) fn last_before(pass: &language::Pass, binding: &Binding, number: u32) -> Option<Span> {
    let before = binding.element(number.checked_sub(1)?);
    let names = pass.sample.iter().map(|it| &it.binding).chain(pass.storage.iter().map(|it| &it.binding));
    names.into_iter().find(|name| *name.text == *before).map(|name| name.span)
}
