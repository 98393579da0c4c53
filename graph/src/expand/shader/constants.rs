//! Values that a pass gives meet the specialization constants of its shader.

use super::params::shown;
use crate::base::{Code, Diagnostic, suggestion};
use crate::frame::ParamValue;
use crate::language;
use crate::ron::Name;
use crate::shader::{ParamType, ShaderInterface};
use std::sync::Arc;

/// Values as the file has them: the shader's types are put on them where it is compiled.
pub(in crate::expand) fn as_written(pass: &language::Pass) -> Vec<(Arc<str>, ParamValue)> {
    pass.constants.iter().map(|it| (it.name.text.clone(), it.value.value.clone())).collect()
}

/// Reports values of constants that the shader hasn't, and of another type.
pub(in crate::expand) fn check(pass: &language::Pass, interface: &ShaderInterface, errors: &mut Vec<Diagnostic>) {
    let Some(Name { text: shader, .. }) = pass.shader() else { return };
    let mut numbers = Vec::new();
    for given in &pass.constants {
        let name = &given.name.text;
        let called: Vec<_> = interface.constants.iter().filter(|constant| constant.is_called(name)).collect();
        if called.is_empty() {
            let known = || interface.constants.iter().map(|constant| constant.name.as_str());
            let none = "it has no specialization constants: `layout(constant_id = 0) const int TILE = 8;` is one";
            let help = suggestion(name, known()).unwrap_or_else(|| none.to_owned());
            let message = format!("shader `{shader}` has no constant named `{name}`");
            errors.push(Diagnostic::new(Code::SHADER_CONSTANT, given.name.span, message).help(help));
            continue;
        }
        if let Some(twice) = called.iter().find(|constant| numbers.contains(&constant.number)) {
            let message = format!("constant {} of shader `{shader}` has two values", twice.number);
            errors.push(Diagnostic::new(Code::SHADER_CONSTANT, given.name.span, message));
        }
        numbers.extend(called.iter().map(|constant| constant.number));
        if given.value.value.is_of_frame() {
            let message = format!("constant `{name}` of shader `{shader}` is another value in each frame");
            let wrong = Diagnostic::new(Code::FRAME_VALUE, given.value.span, message);
            errors.push(
                wrong.help("constants are the pipeline's: give it by `params`, as a member of the shader's block"),
            );
            continue;
        }
        let fits = |ty: &str| ParamType::of(ty).is_some_and(|ty| ty.take(&given.value.value).is_ok());
        if let Some(constant) = called.iter().find(|constant| !fits(&constant.ty)) {
            let (ty, value) = (&constant.ty, shown(given));
            let message = format!("constant `{name}` of shader `{shader}` has the type `{ty}` and can't be {value}");
            let wrong = Diagnostic::new(Code::SHADER_CONSTANT, given.value.span, message);
            errors.push(match ParamType::of(ty) {
                Some(_) => wrong,
                None => wrong.help("truth values, and numbers of 32 bits, can be given"),
            });
        }
    }
}
