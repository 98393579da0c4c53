//! The functions that expressions call.

use super::environment::Property;
use std::ops::RangeInclusive;

/// A function that evaluates all its arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Min,
    Max,
    Clamp,
    Abs,
    Floor,
    Ceil,
    Round,
    Sqrt,
    Exp2,
    Log2,
    Pow,
    Of(Property),
}

/// A function that can be called, or `if`.
pub(super) struct Callee {
    pub(super) name: &'static str,
    /// How it is written: `clamp(x, low, high)`.
    pub(super) form: &'static str,
    /// The meaning of its value.
    pub(super) about: &'static str,
    /// How many arguments it takes.
    pub(super) takes: RangeInclusive<usize>,
    /// `None` for `if`, which evaluates only what it needs.
    pub(super) function: Option<Function>,
}

const fn callee(
    name: &'static str,
    form: &'static str,
    about: &'static str,
    (least, most): (usize, usize),
    function: Function,
) -> Callee {
    Callee { name, form, about, takes: least..=most, function: Some(function) }
}

/// All functions, and `if`.
pub(super) static CALLEES: [Callee; 17] = [
    Callee {
        name: "if",
        form: "if(condition, a, b)",
        about: "`a` if the condition holds, else `b`; only that one is evaluated",
        takes: 3..=3,
        function: None,
    },
    callee("min", "min(a, b, …)", "the least; whole if all are whole", (2, usize::MAX), Function::Min),
    callee("max", "max(a, b, …)", "the greatest; whole if all are whole", (2, usize::MAX), Function::Max),
    callee(
        "clamp",
        "clamp(x, low, high)",
        "`x`, but not below `low` and not above `high`; whole if all are whole",
        (3, 3),
        Function::Clamp,
    ),
    callee("abs", "abs(x)", "without its sign; whole if it is whole", (1, 1), Function::Abs),
    callee("floor", "floor(x)", "the next whole number below", (1, 1), Function::Floor),
    callee("ceil", "ceil(x)", "the next whole number above", (1, 1), Function::Ceil),
    callee("round", "round(x)", "the nearest whole number; halves are rounded away from 0", (1, 1), Function::Round),
    callee("sqrt", "sqrt(x)", "the square root", (1, 1), Function::Sqrt),
    callee("exp2", "exp2(x)", "2 to the power of `x`", (1, 1), Function::Exp2),
    callee("log2", "log2(x)", "the logarithm to base 2", (1, 1), Function::Log2),
    callee("pow", "pow(a, b)", "`a` to the power of `b`", (2, 2), Function::Pow),
    callee("width", "width(image)", "its width in texels", (1, 1), Function::Of(Property::Width)),
    callee("height", "height(image)", "its height in texels", (1, 1), Function::Of(Property::Height)),
    callee("mips", "mips(image)", "its number of mip levels", (1, 1), Function::Of(Property::Mips)),
    callee("layers", "layers(image)", "its number of layers", (1, 1), Function::Of(Property::Layers)),
    callee("samples", "samples(image)", "its number of samples", (1, 1), Function::Of(Property::Samples)),
];

impl Callee {
    /// The function of this name, or `if`.
    pub(super) fn find(name: &str) -> Option<&'static Callee> {
        CALLEES.iter().find(|callee| callee.name == name)
    }
}

/// The form of each function, and the meaning of its value.
pub fn functions() -> impl Iterator<Item = (&'static str, &'static str)> {
    CALLEES.iter().map(|callee| (callee.form, callee.about))
}

impl Function {
    pub(super) fn name(self) -> &'static str {
        CALLEES.iter().find(|callee| callee.function == Some(self)).map_or("", |callee| callee.name)
    }
}
