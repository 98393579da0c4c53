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

/// What can be called.
pub(super) struct Callee {
    pub(super) name: &'static str,
    /// How it is written: `clamp(x, low, high)`.
    pub(super) form: &'static str,
    /// How many arguments it takes.
    pub(super) takes: RangeInclusive<usize>,
    /// `None` for `if`, which evaluates only what it needs.
    pub(super) function: Option<Function>,
}

const fn callee(name: &'static str, form: &'static str, least: usize, most: usize, function: Function) -> Callee {
    Callee { name, form, takes: least..=most, function: Some(function) }
}

/// Everything that can be called.
pub(super) static CALLEES: [Callee; 17] = [
    Callee { name: "if", form: "if(condition, a, b)", takes: 3..=3, function: None },
    callee("min", "min(a, b, …)", 2, usize::MAX, Function::Min),
    callee("max", "max(a, b, …)", 2, usize::MAX, Function::Max),
    callee("clamp", "clamp(x, low, high)", 3, 3, Function::Clamp),
    callee("abs", "abs(x)", 1, 1, Function::Abs),
    callee("floor", "floor(x)", 1, 1, Function::Floor),
    callee("ceil", "ceil(x)", 1, 1, Function::Ceil),
    callee("round", "round(x)", 1, 1, Function::Round),
    callee("sqrt", "sqrt(x)", 1, 1, Function::Sqrt),
    callee("exp2", "exp2(x)", 1, 1, Function::Exp2),
    callee("log2", "log2(x)", 1, 1, Function::Log2),
    callee("pow", "pow(a, b)", 2, 2, Function::Pow),
    callee("width", "width(image)", 1, 1, Function::Of(Property::Width)),
    callee("height", "height(image)", 1, 1, Function::Of(Property::Height)),
    callee("mips", "mips(image)", 1, 1, Function::Of(Property::Mips)),
    callee("layers", "layers(image)", 1, 1, Function::Of(Property::Layers)),
    callee("samples", "samples(image)", 1, 1, Function::Of(Property::Samples)),
];

impl Callee {
    /// What is called by this name.
    pub(super) fn find(name: &str) -> Option<&'static Callee> {
        CALLEES.iter().find(|callee| callee.name == name)
    }
}

impl Function {
    pub(super) fn name(self) -> &'static str {
        CALLEES.iter().find(|callee| callee.function == Some(self)).map_or("", |callee| callee.name)
    }
}
