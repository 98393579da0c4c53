//! Parameters of a pass meet the members of its shader's block.

use crate::base::{Code, Diagnostic, nearest, shown_number, suggestion};
use crate::frame::ParamValue;
use crate::language;
use crate::ron::Name;
use crate::shader::{Block, FileLanguage, PARAMS, PASS_SET, ParamMisfit, ParamType, ShaderInterface, ShaderName};
use std::sync::Arc;

/// What a type is that no pipeline file can give.
const NEITHER: &str = "neither a number nor a vector nor a matrix of 32 bits: split it into several";

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
    let block = block(interface).unwrap_or(&none);
    let mut given = Vec::new();
    let mut misspelt = Vec::new();
    for param in &pass.params {
        let name = &param.name.text;
        let Some(member) = block.members.iter().find(|member| member.name == **name) else {
            if whole.and_then(self::block).is_some_and(|whole| whole.members.iter().any(|it| it.name == **name)) {
                continue;
            }
            if strays.iter().any(|block| block.members.iter().any(|it| it.name == **name)) {
                continue;
            }
            misspelt.extend(nearest(name, block.members.iter().map(|member| &*member.name)));
            let unknown = format!("shader `{shader}` has no parameter named `{name}`");
            let help =
                suggestion(name, block.members.iter().map(|member| &*member.name)).or_else(|| Some(no_block(shader)));
            errors.push(Diagnostic { help, ..Diagnostic::new(Code::UNKNOWN_PARAM, param.name.span, unknown) });
            continue;
        };
        match convert(&param.value.value, &member.ty) {
            Ok(value) => given.push((name.clone(), value)),
            Err((place, help)) => {
                let of_frame = param.value.value.is_of_frame();
                let help = if of_frame { Some("`frame` is a `uint`, and `time` a `float`".to_owned()) } else { help };
                let message = format!(
                    "parameter `{name}` of shader `{shader}` has the type `{}` and can't be {}{place}",
                    member.ty,
                    shown(param)
                );
                errors.push(Diagnostic { help, ..Diagnostic::new(Code::PARAM_TYPE, param.value.span, message) });
            }
        }
    }
    for member in &block.members {
        if !misspelt.contains(&&*member.name) && pass.params.iter().all(|param| *param.name.text != *member.name) {
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
    let value = number(&param.value.value);
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
        ParamValue::List(values) => format!("({})", values.iter().map(number).collect::<Vec<_>>().join(", ")),
    }
}

/// The value as the member's type has it; else which component doesn't fit, and a help.
fn convert(value: &ParamValue, ty: &str) -> Result<ParamValue, (String, Option<String>)> {
    let known = ParamType::of(ty).ok_or_else(|| (String::new(), Some(format!("that is {NEITHER}"))))?;
    known.take(value).map_err(|misfit| match misfit {
        ParamMisfit::Form => {
            let several = known.rows > 1;
            (String::new(), several.then(|| format!("values of this type are written `{}`", known.form())))
        }
        ParamMisfit::Component { column, row, value } => {
            let column = column.map_or_else(String::new, |column| format!(" of column {column}"));
            let place = row.map(|row| format!(": component {row}{column} is `{}`", number(&value)));
            (place.unwrap_or_default(), None)
        }
    })
}
