//! Parameters of a pass meet the members of its shader's block.

use super::shader::PARAMS;
use crate::base::{Diagnostic, nearest, shown_number, suggestion};
use crate::frame::ParamValue;
use crate::language;
use crate::ron::Name;
use crate::shader::{BindingKind, Block, PASS_SET, ShaderInterface};
use std::sync::Arc;

/// Values for the members of the shader's block, in the pass's order, each of its member's type.
pub(super) fn give(
    pass: &language::Pass,
    interface: &ShaderInterface,
    whole: Option<&ShaderInterface>,
    errors: &mut Vec<Diagnostic>,
) -> Vec<(Arc<str>, ParamValue)> {
    let Some(Name { text: shader, span: named }) = pass.shader() else { return Vec::new() };
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
            misspelt.extend(nearest(name, block.members.iter().map(|member| &*member.name)));
            let unknown = format!("shader `{shader}` has no parameter named `{name}`");
            let help = suggestion(name, block.members.iter().map(|member| &*member.name))
                .or_else(|| Some(format!("shader `{shader}` has no block named `{PARAMS}` in set {PASS_SET}")));
            errors.push(Diagnostic { help, ..Diagnostic::new(param.name.span, unknown) });
            continue;
        };
        match convert(param.value.value, &member.ty) {
            Some(value) => given.push((name.clone(), value)),
            None => {
                let message = format!(
                    "parameter `{name}` of shader `{shader}` has the type `{}` and can't be {}",
                    member.ty,
                    shown(param)
                );
                errors.push(Diagnostic::new(param.value.span, message));
            }
        }
    }
    for member in &block.members {
        if !misspelt.contains(&&*member.name) && pass.params.iter().all(|param| *param.name.text != *member.name) {
            let (name, ty) = (&member.name, &member.ty);
            let message =
                format!("shader `{shader}` needs the parameter `{name}`, which pass `{}` doesn't give", pass.name.text);
            let help = match ty.as_str() {
                "float" | "int" | "uint" | "bool" => format!("add `params: {{\"{name}\": …}}`; its type is `{ty}`"),
                _ => format!("its type is `{ty}`, and pipeline files give single numbers only: split it into several"),
            };
            errors.push(Diagnostic::new(*named, message).help(help));
        }
    }
    given
}

/// Values as the file has them, for passes that the embedding program records: no block says their types.
pub(super) fn as_written(pass: &language::Pass) -> Vec<(Arc<str>, ParamValue)> {
    pass.params.iter().map(|param| (param.name.text.clone(), param.value.value)).collect()
}

fn block(interface: &ShaderInterface) -> Option<&Block> {
    interface.bindings.iter().find_map(|binding| match &binding.kind {
        BindingKind::UniformBlock(block) if binding.set == PASS_SET && binding.name == PARAMS => Some(block),
        _ => None,
    })
}

/// How a parameter's value is shown: "`3` (setting `steps`)".
fn shown(param: &language::Param) -> String {
    let value = match param.value.value {
        ParamValue::Bool(value) => value.to_string(),
        ParamValue::Integer(value) => value.to_string(),
        ParamValue::Number(value) => shown_number(value),
    };
    match &param.written {
        Some(written) => format!("`{value}` ({written})"),
        None => format!("`{value}`"),
    }
}

/// The value as the member's type has it; `None` if it doesn't fit.
fn convert(value: ParamValue, ty: &str) -> Option<ParamValue> {
    #[allow(clippy::cast_possible_truncation, reason = "the test is whether single precision can hold it")]
    let finite = |number: f64| (number as f32).is_finite().then_some(ParamValue::Number(number));
    match (ty, value) {
        ("float", ParamValue::Number(number)) => finite(number),
        #[allow(clippy::cast_precision_loss, reason = "the shader's number has fewer bits anyway")]
        ("float", ParamValue::Integer(number)) => finite(number as f64),
        ("int", ParamValue::Integer(number)) => i32::try_from(number).ok().map(|_| value),
        ("uint", ParamValue::Integer(number)) => u32::try_from(number).ok().map(|_| value),
        ("int" | "uint" | "bool", ParamValue::Bool(_)) => Some(value),
        _ => None,
    }
}
