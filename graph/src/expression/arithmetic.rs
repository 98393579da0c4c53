//! Operators and functions on values. All are total: an operation without a value says why.

use super::functions::Function;
use super::program::Binary;
use super::types::{Type, Value};

/// Why an operation has no value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Trouble {
    /// The second operand is 0.
    DivisionByZero,
    /// A whole number beyond 64 bits.
    Overflow,
    /// A number beyond double precision.
    NotFinite,
    /// The root of a negative number.
    NoRoot(f64),
    /// The logarithm of 0 or less.
    NoLogarithm(f64),
    /// A power that is no real number.
    NoPower(f64, f64),
    /// A number that no whole number is near.
    NotWhole(f64),
    /// Bounds in the wrong order.
    Bounds(Value, Value),
    /// A value that is not of the type that was declared.
    Undeclared,
}

/// Operands that are calculated with.
enum Pair {
    Integers(i64, i64),
    Numbers(f64, f64),
}

fn pair(left: &Value, right: &Value) -> Result<Pair, Trouble> {
    match (left, right) {
        (Value::Integer(left), Value::Integer(right)) => Ok(Pair::Integers(*left, *right)),
        (left, right) => Ok(Pair::Numbers(number(left)?, number(right)?)),
    }
}

/// A value as a number.
fn number(value: &Value) -> Result<f64, Trouble> {
    match value.clone().widened(Type::Number) {
        Some(Value::Number(number)) => Ok(number),
        _ => Err(Trouble::Undeclared),
    }
}

/// A number, unless it is infinite or NaN.
fn finite(number: f64) -> Result<Value, Trouble> {
    if number.is_finite() { Ok(Value::Number(number)) } else { Err(Trouble::NotFinite) }
}

fn integer(value: Option<i64>) -> Result<Value, Trouble> {
    value.map(Value::Integer).ok_or(Trouble::Overflow)
}

/// The value of `left`, operator, `right`.
pub(super) fn binary(operator: Binary, left: &Value, right: &Value) -> Result<Value, Trouble> {
    match operator {
        Binary::Equal => equal(left, right).map(Value::Bool),
        Binary::NotEqual => equal(left, right).map(|equal| Value::Bool(!equal)),
        Binary::Less => less(left, right).map(Value::Bool),
        Binary::Greater => less(right, left).map(Value::Bool),
        // Numbers are finite, so that one of two is the lesser or they are equal.
        Binary::LessOrEqual => less(right, left).map(|greater| Value::Bool(!greater)),
        Binary::GreaterOrEqual => less(left, right).map(|less| Value::Bool(!less)),
        Binary::Add => match pair(left, right)? {
            Pair::Integers(left, right) => integer(left.checked_add(right)),
            Pair::Numbers(left, right) => finite(left + right),
        },
        Binary::Subtract => match pair(left, right)? {
            Pair::Integers(left, right) => integer(left.checked_sub(right)),
            Pair::Numbers(left, right) => finite(left - right),
        },
        Binary::Multiply => match pair(left, right)? {
            Pair::Integers(left, right) => integer(left.checked_mul(right)),
            Pair::Numbers(left, right) => finite(left * right),
        },
        Binary::Divide => match (number(left)?, number(right)?) {
            (_, 0.0) => Err(Trouble::DivisionByZero),
            (left, right) => finite(left / right),
        },
        Binary::Remainder => match pair(left, right)? {
            Pair::Integers(_, 0) | Pair::Numbers(_, 0.0) => Err(Trouble::DivisionByZero),
            // Only the least whole number by -1 wraps, and its remainder is 0 all the same.
            Pair::Integers(left, right) => Ok(Value::Integer(left.wrapping_rem_euclid(right))),
            Pair::Numbers(left, right) => finite(left.rem_euclid(right)),
        },
    }
}

fn equal(left: &Value, right: &Value) -> Result<bool, Trouble> {
    if left.ty() == right.ty() {
        return Ok(left == right);
    }
    Ok(number(left)? == number(right)?)
}

fn less(left: &Value, right: &Value) -> Result<bool, Trouble> {
    Ok(match pair(left, right)? {
        Pair::Integers(left, right) => left < right,
        Pair::Numbers(left, right) => left < right,
    })
}

/// The value with the other sign.
pub(super) fn negate(value: &Value) -> Result<Value, Trouble> {
    match value {
        Value::Integer(value) => integer(value.checked_neg()),
        value => finite(-number(value)?),
    }
}

/// The value of a function other than those of images.
pub(super) fn call(function: Function, arguments: &[Value]) -> Result<Value, Trouble> {
    match (function, arguments) {
        (Function::Min | Function::Max, [first, rest @ ..]) => {
            let mut best = first.clone();
            for value in rest {
                let better = if function == Function::Min { less(value, &best)? } else { less(&best, value)? };
                best = if better { value.clone() } else { best };
            }
            as_all(best, arguments)
        }
        (Function::Clamp, [value, low, high]) => {
            if less(high, low)? {
                return Err(Trouble::Bounds(low.clone(), high.clone()));
            }
            let bounded = if less(value, low)? {
                low
            } else if less(high, value)? {
                high
            } else {
                value
            };
            as_all(bounded.clone(), arguments)
        }
        (Function::Abs, [Value::Integer(value)]) => integer(value.checked_abs()),
        (Function::Abs, [value]) => finite(number(value)?.abs()),
        (Function::Floor | Function::Ceil | Function::Round, [Value::Integer(value)]) => Ok(Value::Integer(*value)),
        (Function::Floor, [value]) => whole(number(value)?.floor()),
        (Function::Ceil, [value]) => whole(number(value)?.ceil()),
        (Function::Round, [value]) => whole(number(value)?.round()),
        (Function::Sqrt, [value]) => match number(value)? {
            negative if negative < 0.0 => Err(Trouble::NoRoot(negative)),
            value => finite(value.sqrt()),
        },
        (Function::Log2, [value]) => match number(value)? {
            value if value <= 0.0 => Err(Trouble::NoLogarithm(value)),
            value => finite(value.log2()),
        },
        (Function::Exp2, [value]) => finite(number(value)?.exp2()),
        (Function::Pow, [base, exponent]) => {
            let (base, exponent) = (number(base)?, number(exponent)?);
            match base.powf(exponent) {
                power if power.is_nan() => Err(Trouble::NoPower(base, exponent)),
                // 0 to a negative power.
                power if power.is_infinite() && base == 0.0 => Err(Trouble::NoPower(base, exponent)),
                power => finite(power),
            }
        }
        _ => Err(Trouble::Undeclared),
    }
}

/// One of several values as their common type: a number if any of them is.
fn as_all(value: Value, all: &[Value]) -> Result<Value, Trouble> {
    let ty = if all.iter().any(|value| value.ty() == Type::Number) { Type::Number } else { value.ty() };
    value.widened(ty).ok_or(Trouble::Undeclared)
}

/// A number without a fraction as a whole number.
fn whole(number: f64) -> Result<Value, Trouble> {
    // 2^63, the first that is too large; its negative still fits.
    const LIMIT: f64 = 9_223_372_036_854_775_808.0;
    if !(-LIMIT..LIMIT).contains(&number) {
        return Err(Trouble::NotWhole(number));
    }
    #[allow(clippy::cast_possible_truncation, reason = "it lies within the range and has no fraction")]
    Ok(Value::Integer(number as i64))
}
