//! Parameters of a pass meet the members of its shader's block.

use crate::base::{Code, Diagnostic, OutsideChoice, nearest, shown_number, suggestion};
use crate::frame::ParamValue;
use crate::language;
use crate::ron::Name;
use crate::shader::{
    Block, FileLanguage, Member, PARAMS, PASS_SET, ParamMisfit, ParamType, ShaderInterface, ShaderName,
};
use std::sync::Arc;

/// What a type is that no pipeline file can give.
const NEITHER: &str =
    "neither a number nor a vector nor a matrix of 32 bits, nor an array of such: split it into several";

/// Of longer lists a message shows the first elements.
const SHOWN_ELEMENTS: usize = 8;

/// Values for the members of the shader's block, in the pass's order, each of its member's type. `strays`: blocks in other sets, of which
/// that is reported.
pub(in crate::expand) fn give(
    pass: &language::Pass,
    interface: &ShaderInterface,
    whole: Option<&ShaderInterface>,
    strays: &[&Block],
    errors: &mut Vec<Diagnostic>,
) -> Vec<(Arc<str>, ParamValue)> {
    let Some(Name { text: shader, span: named }) = pass.shader() else { return Vec::new() };
    if let [first, second, ..] = rivals(pass, interface)[..] {
        let message = format!(
            "shader `{shader}` has several blocks for the parameters of pass `{}`: `{first}`, `{second}`",
            pass.name.text
        );
        let help =
            format!("put their members into one block, or give one a buffer: `uniform: {{\"{second}\": \"…\"}}`");
        errors.push(Diagnostic::new(Code::PARAM_BLOCKS, *named, message).help(help));
        return Vec::new();
    }
    let none = Block::default();
    let members = block(interface).unwrap_or(&none).parameters();
    let mut given = Vec::new();
    let mut misspelt = Vec::new();
    for param in &pass.params {
        let name = &param.name.text;
        let Some(member) = members.iter().find(|member| member.name == **name) else {
            if whole.and_then(block).is_some_and(|whole| whole.parameters().iter().any(|it| it.name == **name)) {
                continue;
            }
            if strays.iter().any(|block| block.parameters().iter().any(|it| it.name == **name)) {
                continue;
            }
            misspelt.extend(nearest(name, members.iter().map(|member| &*member.name)));
            let unknown = format!("shader `{shader}` has no parameter named `{name}`");
            let help = suggestion(name, members.iter().map(|member| &*member.name)).or_else(|| Some(no_block(shader)));
            errors.push(Diagnostic { help, ..Diagnostic::new(Code::UNKNOWN_PARAM, param.name.span, unknown) });
            continue;
        };
        match convert(&param.value.value, &member.ty) {
            Ok(value) => given.push((name.clone(), value)),
            Err((code, place, help)) => {
                let of_frame = param.value.value.is_of_frame();
                let help = if of_frame { Some("`frame` is a `uint`, and `time` a `float`".to_owned()) } else { help };
                let message = format!(
                    "parameter `{name}` of shader `{shader}` has the type `{}` and can't be {}{place}",
                    member.ty,
                    shown_as(param, &member.ty)
                );
                errors.push(Diagnostic { help, ..Diagnostic::new(code, param.value.span, message) });
            }
        }
    }
    let is_given = |member: &Member| pass.params.iter().any(|param| *param.name.text == *member.name);
    if let (Some(misfit), Some(member)) =
        (interface.pushed_misfits.first(), members.iter().find(|member| !is_given(member)))
    {
        let (name, pass) = (&member.name, &pass.name.text);
        let message = format!("shader `{shader}` reads {misfit}; as parameters, pass `{pass}` gives no `{name}`");
        errors.push(Diagnostic::new(Code::PUSHED_UNFIT, *named, message).choice(OutsideChoice::DrawInterfaces));
        return given;
    }
    for member in &members {
        if !misspelt.contains(&&*member.name) && !is_given(member) {
            let (name, ty) = (&member.name, &member.ty);
            let message =
                format!("shader `{shader}` needs the parameter `{name}`, which pass `{}` doesn't give", pass.name.text);
            let help = match ParamType::of(ty) {
                Some(known) => format!("add `params: {{\"{name}\": {}}}`; its type is `{ty}`", known.form()),
                None => format!("its type is `{ty}`, {NEITHER}"),
            };
            errors.push(Diagnostic::new(Code::PARAM_MISSING, *named, message).help(help));
        }
    }
    given
}

/// That a shader has no block for parameters, in the words of its language.
fn no_block(shader: &str) -> String {
    match FileLanguage::of_shader(shader) {
        None => format!("shader `{shader}` has no block named `{PARAMS}` in set {PASS_SET}"),
        Some(FileLanguage::Hlsl | FileLanguage::Slang) => {
            format!("shader `{shader}` has no constant buffer in `space{PASS_SET}`")
        }
        Some(FileLanguage::Spirv | FileLanguage::Wgsl) => {
            format!("shader `{shader}` has no uniform block in set {PASS_SET}")
        }
    }
}

/// The blocks among which the pass's parameters have no place, since there are several and none is called `params`. Files of
/// other languages than GLSL call their blocks as they like.
pub(super) fn rivals<'i>(pass: &language::Pass, interface: &'i ShaderInterface) -> Vec<&'i str> {
    let from_file = pass.shader().is_some_and(|shader| ShaderName::has_file(&shader.text));
    if pass.params.is_empty() || !from_file || block(interface).is_some() {
        return Vec::new();
    }
    let is_given = |name: &str| pass.uniform.iter().any(|uniform| *uniform.binding.text == *name);
    let blocks = interface.bindings.iter().filter(|it| it.set == PASS_SET && it.kind.uniform_block().is_some());
    let left: Vec<&str> = blocks.map(|it| it.name.as_str()).filter(|name| !is_given(name)).collect();
    if left.len() > 1 { left } else { Vec::new() }
}

/// Values as the file has them, for passes that the embedding program records: no block says their types.
pub(in crate::expand) fn as_written(pass: &language::Pass) -> Vec<(Arc<str>, ParamValue)> {
    pass.params.iter().map(|param| (param.name.text.clone(), param.value.value.clone())).collect()
}

fn block(interface: &ShaderInterface) -> Option<&Block> {
    let mut own = interface.bindings.iter().filter(|binding| binding.set == PASS_SET && binding.name == PARAMS);
    own.find_map(|binding| binding.kind.uniform_block())
}

/// How a parameter's value is shown: "`3` (setting `steps`)".
pub(super) fn shown(param: &language::Param) -> String {
    with_words(param, &number(&param.value.value))
}

/// The same for a parameter of this type: what is given as an array is shown as one.
fn shown_as(param: &language::Param, ty: &str) -> String {
    match &param.value.value {
        ParamValue::List(values) if ty.ends_with(']') => with_words(param, &list(values, ["[", "]"])),
        _ => shown(param),
    }
}

fn with_words(param: &language::Param, value: &str) -> String {
    match &param.written {
        Some(written) => format!("`{value}` ({written})"),
        None => format!("`{value}`"),
    }
}

/// A value with its numbers as people read them.
fn number(value: &ParamValue) -> String {
    match value {
        ParamValue::Bool(_) | ParamValue::Integer(_) | ParamValue::OfFrame(_) => value.to_string(),
        ParamValue::Number(value) => shown_number(*value),
        ParamValue::List(values) => list(values, ParamValue::brackets(values)),
    }
}

/// The first values of a list, in these brackets.
fn list(values: &[ParamValue], [open, close]: [&str; 2]) -> String {
    let shown: Vec<String> = values.iter().take(SHOWN_ELEMENTS).map(number).collect();
    let more = if values.len() > shown.len() { ", …" } else { "" };
    format!("{open}{}{more}{close}", shown.join(", "))
}

/// The value as the member's type has it; else the code, what doesn't fit, and a help.
fn convert(value: &ParamValue, ty: &str) -> Result<ParamValue, (Code, String, Option<String>)> {
    let unknown = || (Code::PARAM_TYPE, String::new(), Some(format!("that is {NEITHER}")));
    let known = ParamType::of(ty).ok_or_else(unknown)?;
    known.take(value).map_err(|misfit| match misfit {
        ParamMisfit::Form => {
            let several = known.rows > 1 || known.length.is_some();
            (Code::PARAM_TYPE, String::new(), several.then(|| written_so(known)))
        }
        ParamMisfit::Length(given) => (Code::PARAM_LENGTH, format!(": it has {given} elements"), None),
        ParamMisfit::Element(at, misfit) => match *misfit {
            ParamMisfit::Component { column, row, value } => {
                let place = component(column, row).map_or_else(String::new, |place| format!("{place} of "));
                (Code::PARAM_TYPE, format!(": {place}element {at} is `{}`", number(&value)), None)
            }
            ParamMisfit::Form | ParamMisfit::Length(_) | ParamMisfit::Element(..) => {
                (Code::PARAM_TYPE, format!(": element {at} isn't written so"), Some(written_so(known)))
            }
        },
        ParamMisfit::Component { column, row, value } => {
            let place = component(column, row).map(|place| format!(": {place} is `{}`", number(&value)));
            (Code::PARAM_TYPE, place.unwrap_or_default(), None)
        }
    })
}

fn written_so(ty: ParamType) -> String {
    format!("values of this type are written `{}`", ty.form())
}

/// A component of a vector or matrix in words, by the numbers of its column and of itself.
fn component(column: Option<usize>, row: Option<usize>) -> Option<String> {
    let column = column.map_or_else(String::new, |column| format!(" of column {column}"));
    row.map(|row| format!("component {row}{column}"))
}
