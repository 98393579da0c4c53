//! The bytes of a pass's parameter block.

use framewright_graph::frame::ParamValue;
use framewright_graph::plan;
use framewright_graph::shader::Block;

/// Name of the block that holds a pass's parameters.
pub(crate) const PARAMS: &str = "params";

/// The bytes of a parameter block.
///
/// # Errors
/// In words: a member without value, a value without member, or one that the member's type can't hold.
pub(crate) fn fill(block: &Block, params: &[plan::Param]) -> Result<Vec<u8>, String> {
    if let Some(surplus) = params.iter().find(|param| block.members.iter().all(|it| *it.name != *param.name)) {
        return Err(format!("the block `{PARAMS}` has no member `{}`", surplus.name));
    }
    let mut bytes = vec![0; block.bytes.max(16) as usize];
    for member in &block.members {
        let param = params.iter().find(|it| *it.name == *member.name);
        let param = param.ok_or_else(|| format!("`{}` of the block `{PARAMS}` has no value", member.name))?;
        let value = value(&member.ty, param.value)
            .ok_or_else(|| format!("`{}` is a {}, and {:?} is none", member.name, member.ty, param.value))?;
        let at = member.offset as usize;
        bytes
            .get_mut(at..at + value.len())
            .ok_or_else(|| format!("`{}` lies outside its block", member.name))?
            .copy_from_slice(&value);
    }
    Ok(bytes)
}

/// A value as a member of type `ty` holds it; `None` if it can't.
fn value(ty: &str, value: ParamValue) -> Option<[u8; 4]> {
    let number = match value {
        ParamValue::Bool(value) => f64::from(u8::from(value)),
        // Beyond 2^53 no 32-bit type holds it anyway.
        ParamValue::Integer(value) => {
            i32::try_from(value).map(f64::from).or_else(|_| u32::try_from(value).map(f64::from)).ok()?
        }
        ParamValue::Number(value) => value,
    };
    match ty {
        "float" => {
            #[allow(clippy::cast_possible_truncation, reason = "shaders compute in 32 bits")]
            let narrowed = number as f32;
            narrowed.is_finite().then(|| narrowed.to_ne_bytes())
        }
        "int" if number.fract() == 0.0 && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&number) => {
            #[allow(clippy::cast_possible_truncation, reason = "the range was checked")]
            let whole = number as i32;
            Some(whole.to_ne_bytes())
        }
        "uint" if number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number) => {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range was checked")]
            let whole = number as u32;
            Some(whole.to_ne_bytes())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::shader::Member;

    fn member(name: &str, offset: u32, ty: &str) -> Member {
        Member { name: name.to_owned(), offset, ty: ty.to_owned() }
    }

    fn param(name: &str, value: ParamValue) -> plan::Param {
        plan::Param { name: name.into(), value }
    }

    #[test]
    fn parameters_land_at_their_members_offsets_in_their_members_types() {
        let members = vec![member("white", 0, "float"), member("steps", 4, "int"), member("on", 12, "uint")];
        let block = Block { bytes: 16, members };
        let params = [
            param("on", ParamValue::Bool(true)),
            param("white", ParamValue::Integer(3)),
            param("steps", ParamValue::Number(-2.0)),
        ];
        let mut expected = Vec::new();
        expected.extend(3.0_f32.to_ne_bytes());
        expected.extend((-2_i32).to_ne_bytes());
        expected.extend([0; 4]);
        expected.extend(1_u32.to_ne_bytes());
        assert_eq!(fill(&block, &params), Ok(expected));
    }

    #[test]
    fn parameters_that_do_not_fit_are_named() {
        let block = Block { bytes: 16, members: vec![member("steps", 0, "int")] };
        let message = |params: &[plan::Param]| fill(&block, params).err().unwrap_or_default();
        assert_eq!(message(&[]), "`steps` of the block `params` has no value");
        assert_eq!(message(&[param("steps", ParamValue::Number(0.5))]), "`steps` is a int, and Number(0.5) is none");
        let two = [param("steps", ParamValue::Integer(1)), param("speed", ParamValue::Integer(1))];
        assert_eq!(message(&two), "the block `params` has no member `speed`");
    }
}
