//! The bytes of a pass's parameter block.

use framewright_graph::frame::{FrameValue, ParamValue};
use framewright_graph::plan;
use framewright_graph::shader::{Block, MatrixLayout, Member, PARAMS, ParamScalar, ParamType};

/// The bytes of a parameter block.
///
/// # Errors
/// In words: a member without value, a value without member, or one that the member's type can't hold.
pub(crate) fn fill(block: &Block, params: &[plan::Param]) -> Result<Vec<u8>, String> {
    let members = block.parameters();
    if let Some(surplus) = params.iter().find(|param| members.iter().all(|it| *it.name != *param.name)) {
        return Err(format!("the block `{PARAMS}` has no member `{}`", surplus.name));
    }
    let mut bytes = vec![0; block.bytes.max(16) as usize];
    for member in &members {
        let param = params.iter().find(|it| *it.name == *member.name);
        let param = param.ok_or_else(|| format!("`{}` of the block `{PARAMS}` has no value", member.name))?;
        write(&mut bytes, member, &param.value)?;
    }
    Ok(bytes)
}

/// The values of a block that each frame has its own of, and where they lie in it. The block was filled with these parameters.
pub(crate) fn frame_values(block: &Block, params: &[plan::Param]) -> Vec<(usize, FrameValue)> {
    let mut found = Vec::new();
    for member in &block.parameters() {
        let given = params.iter().find(|it| *it.name == *member.name);
        let visited = given.map(|given| {
            for_each_component(member, &given.value, |place, _, component| {
                if let ParamValue::OfFrame(value) = component {
                    found.push((place, *value));
                }
                Some(())
            })
        });
        debug_assert!(visited.is_none_or(|it| it.is_ok()), "the block was filled");
    }
    found
}

/// Writes a value where its member lies in a block.
fn write(bytes: &mut [u8], member: &Member, value: &ParamValue) -> Result<(), String> {
    let name = &member.name;
    let mut outside = false;
    for_each_component(member, value, |place, scalar, component| {
        let word = word(scalar, component)?;
        match bytes.get_mut(place..place.saturating_add(4)) {
            Some(bytes) => bytes.copy_from_slice(&word),
            None => outside = true,
        }
        Some(())
    })?;
    if outside { Err(format!("`{name}` lies outside its block")) } else { Ok(()) }
}

/// Calls `visit` with the components of a member's value: where each lies in the block, and its type. `None` of it is a value that the
/// type can't hold.
fn for_each_component(
    member: &Member,
    value: &ParamValue,
    mut visit: impl FnMut(usize, ParamScalar, &ParamValue) -> Option<()>,
) -> Result<(), String> {
    let Member { name, ty, offset, matrix, stride: array_stride, within: _ } = member;
    let misfit = || format!("`{name}` is a {ty}, and {value} is none");
    let known = ParamType::of(ty).ok_or_else(misfit)?;
    let MatrixLayout { stride, row_major } = matrix.unwrap_or(MatrixLayout { stride: 16, row_major: false });
    for (element, value) in (0_u32..).zip(known.elements_of(value).ok_or_else(misfit)?) {
        let offset = offset.saturating_add(element.saturating_mul(array_stride.unwrap_or(16)));
        for (column, components) in (0_u32..).zip(known.element().columns_of(value).ok_or_else(misfit)?) {
            for (row, component) in (0_u32..).zip(components) {
                let (line, at) = if row_major { (row, column) } else { (column, row) };
                let place = offset.saturating_add(line.saturating_mul(stride)).saturating_add(4 * at) as usize;
                visit(place, known.scalar, component).ok_or_else(misfit)?;
            }
        }
    }
    Ok(())
}

/// A value as a component of such a type holds it; `None` if it can't.
fn word(scalar: ParamScalar, value: &ParamValue) -> Option<[u8; 4]> {
    let number = match value {
        ParamValue::Bool(value) => f64::from(u8::from(*value)),
        // Beyond 2^53 no 32-bit type holds it anyway.
        ParamValue::Integer(value) => {
            i32::try_from(*value).map(f64::from).or_else(|_| u32::try_from(*value).map(f64::from)).ok()?
        }
        ParamValue::Number(value) => *value,
        // Each frame writes its own.
        ParamValue::OfFrame(value) => return value.fits(scalar).then_some([0; 4]),
        ParamValue::List(_) => return None,
    };
    match scalar {
        ParamScalar::Float => {
            #[allow(clippy::cast_possible_truncation, reason = "shaders compute in 32 bits")]
            let narrowed = number as f32;
            narrowed.is_finite().then(|| narrowed.to_ne_bytes())
        }
        ParamScalar::Int if number.fract() == 0.0 && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&number) => {
            #[allow(clippy::cast_possible_truncation, reason = "the range was checked")]
            let whole = number as i32;
            Some(whole.to_ne_bytes())
        }
        ParamScalar::Uint if number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number) => {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range was checked")]
            let whole = number as u32;
            Some(whole.to_ne_bytes())
        }
        // SPIR-V has no truth values in blocks.
        ParamScalar::Int | ParamScalar::Uint | ParamScalar::Bool => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn member(name: &str, offset: u32, ty: &str) -> Member {
        Member { name: name.to_owned(), offset, ty: ty.to_owned(), ..Member::default() }
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
    fn vectors_and_matrices_lie_as_their_block_says() {
        let numbers = |from: i64, count: i64| ParamValue::list((from..from + count).map(ParamValue::Integer));
        let columns = || ParamValue::list([numbers(1, 3), numbers(4, 3)]);
        let matrix = |offset, stride, row_major| Member {
            matrix: Some(MatrixLayout { stride, row_major }),
            ..member("m", offset, "mat2x3")
        };
        let floats = |members: Vec<Member>, given: &[plan::Param]| -> Vec<f32> {
            let bytes = fill(&Block { bytes: 64, members }, given).expect("it fits");
            bytes.as_chunks().0.iter().map(|word| f32::from_ne_bytes(*word)).collect()
        };
        let vector = [param("v", numbers(7, 3))];
        assert_eq!(floats(vec![member("v", 16, "vec3")], &vector)[3..8], [0.0, 7.0, 8.0, 9.0, 0.0]);
        let given = [param("m", columns())];
        assert_eq!(floats(vec![matrix(0, 16, false)], &given)[..8], [1.0, 2.0, 3.0, 0.0, 4.0, 5.0, 6.0, 0.0]);
        // Three rows of two.
        let rows = [1.0, 4.0, 0.0, 0.0, 2.0, 5.0, 0.0, 0.0, 3.0, 6.0];
        assert_eq!(floats(vec![matrix(0, 16, true)], &given)[..10], rows);
        assert_eq!(floats(vec![matrix(4, 12, false)], &given)[1..7], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let outside = fill(&Block { bytes: 16, members: vec![matrix(0, 16, false)] }, &given);
        assert_eq!(outside, Err("`m` lies outside its block".to_owned()));
        let short = fill(&Block { bytes: 64, members: vec![member("v", 0, "vec4")] }, &vector);
        assert!(short.is_err_and(|said| said.starts_with("`v` is a vec4, and (7, 8, 9) is none")));
    }

    #[test]
    fn elements_of_arrays_lie_a_stride_apart_and_members_of_structures_behind_it() {
        let floats = |member: Member, name: &str, value: ParamValue| -> Vec<f32> {
            let block = Block { bytes: 64, members: vec![member] };
            let bytes = fill(&block, &[param(name, value)]).expect("it fits");
            bytes.as_chunks().0.iter().map(|word| f32::from_ne_bytes(*word)).collect()
        };
        let numbers = |numbers: &[i64]| ParamValue::list(numbers.iter().map(|number| ParamValue::Integer(*number)));
        let array = |ty, stride, matrix| Member { stride: Some(stride), matrix, ..member("a", 4, ty) };
        let std140 = floats(array("float[3]", 16, None), "a", numbers(&[7, 8, 9]));
        assert_eq!(std140[..10], [0.0, 7.0, 0.0, 0.0, 0.0, 8.0, 0.0, 0.0, 0.0, 9.0]);
        let scalar = floats(array("float[3]", 4, None), "a", numbers(&[7, 8, 9]));
        assert_eq!(scalar[..5], [0.0, 7.0, 8.0, 9.0, 0.0]);
        let pairs = ParamValue::list([numbers(&[1, 2]), numbers(&[3, 4])]);
        assert_eq!(floats(array("vec2[2]", 12, None), "a", pairs.clone())[..6], [0.0, 1.0, 2.0, 0.0, 3.0, 4.0]);
        let rows = Some(MatrixLayout { stride: 8, row_major: true });
        let matrices = floats(array("mat2[2]", 20, rows), "a", ParamValue::list([pairs.clone(), pairs]));
        assert_eq!(matrices[..10], [0.0, 1.0, 3.0, 2.0, 4.0, 0.0, 1.0, 3.0, 2.0, 4.0]);

        let light = Member { within: vec![array("float[2]", 4, None)], ..member("light", 8, "Light") };
        assert_eq!(floats(light.clone(), "light.a", numbers(&[5, 6]))[2..6], [0.0, 5.0, 6.0, 0.0]);
        let block = Block { bytes: 64, members: vec![light] };
        let seed = ParamValue::list([ParamValue::Integer(1), ParamValue::OfFrame(FrameValue::Time)]);
        assert_eq!(frame_values(&block, &[param("light.a", seed)]), [(16, FrameValue::Time)]);
    }

    #[test]
    fn parameters_that_do_not_fit_are_named() {
        let block = Block { bytes: 16, members: vec![member("steps", 0, "int")] };
        let message = |params: &[plan::Param]| fill(&block, params).err().unwrap_or_default();
        assert_eq!(message(&[]), "`steps` of the block `params` has no value");
        assert_eq!(message(&[param("steps", ParamValue::Number(0.5))]), "`steps` is a int, and 0.5 is none");
        let two = [param("steps", ParamValue::Integer(1)), param("speed", ParamValue::Integer(1))];
        assert_eq!(message(&two), "the block `params` has no member `speed`");
    }
}
