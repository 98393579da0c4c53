//! The value of an expression, the decisions behind it, or why there is none: a loop over the program with a stack.

use super::arithmetic::{self, Trouble};
use super::environment::{Bound, Decision, MissingValue, Property, Symbol, Values};
use super::functions::Function;
use super::program::Expression;
use super::program::{Binary, Operation, shown};
use super::types::{Type, Value};
use crate::base::{Code, Diagnostic, Span, shown_number};
use crate::frame::ImageIndex;

/// The value of an expression, and the decisions behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The value; of the type of the expression.
    pub value: Value,
    /// Settings, facts and properties of the view and the device that decided it, each once, in the order of reading. A part
    /// that was not evaluated decides nothing. Where one operand alone made `&&` false or `||` true, the other decides nothing.
    pub decided: Vec<Decision>,
    /// The part that made the value `false`, if it is.
    pub failed: Option<FailedCondition>,
}

/// The smallest part of a condition that made it `false`: of `a && b` the operand that doesn't hold, else the whole.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedCondition {
    /// Where it stands.
    pub span: Span,
    /// As it was written.
    pub text: String,
    /// The decisions that were read within it.
    pub decided: Vec<Decision>,
}

impl Outcome {
    /// The decisions, for people: "msaa = 4, hdr = true"; of a condition that failed only those in the part that made it
    /// fail. Empty if there are none.
    #[must_use]
    pub fn because(&self) -> String {
        let decided = self.failed.as_ref().map_or(&self.decided, |failed| &failed.decided);
        decided.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
    }
}

/// Evaluates an expression.
pub(super) fn evaluate(expression: &Expression, values: &dyn Values) -> Result<Outcome, Vec<Diagnostic>> {
    let mut run = Run { expression, values, stack: Vec::new(), reads: Vec::new() };
    let nodes = &expression.program.nodes;
    let mut at = 0;
    while let Some(node) = nodes.get(at as usize) {
        at = match run.step(at, node.operation) {
            Ok(next) => next,
            Err(fault) => return Err(run.explain(at, fault).into_iter().collect()),
        };
    }
    let root = at.saturating_sub(1);
    let result = run.pop().and_then(|slot| match slot.value.widened(expression.ty) {
        Some(value) => Ok((value, slot.part)),
        None => Err(Fault::UNDECLARED),
    });
    match result {
        Ok((value, part)) => {
            let failed = (value == Value::Bool(false)).then(|| run.failed(part));
            Ok(Outcome { value, decided: run.decided(root), failed })
        }
        Err(fault) => Err(run.explain(root, fault).into_iter().collect()),
    }
}

/// A value on the stack, and the part that explains it: the node that left it, or the operand of `&&` that failed.
struct Slot {
    value: Value,
    part: u32,
}

/// A name or property that a node read.
struct Read {
    node: u32,
    what: Source,
    /// Whether the value depends on it. Of `hdr && bloom` with `bloom` false it doesn't depend on `hdr`.
    decides: bool,
}

enum Source {
    /// A name or an element of a list, and its value.
    Name(Symbol, Value),
    Property(ImageIndex, Property),
}

/// Why a node has no value.
enum Fault {
    /// The operation has none. `operands` are the parts that left its operands.
    Trouble { trouble: Trouble, operands: [u32; 2] },
    /// A list of `length` elements has none at `at`, which the part `index` left.
    NoElement { at: i64, index: u32, length: u64, declared: Span },
    /// A value isn't known.
    Missing(MissingValue),
}

impl Fault {
    /// A fault that the types rule out, unless [`Values`] breaks the promises of the declarations.
    const UNDECLARED: Fault = Fault::Trouble { trouble: Trouble::Undeclared, operands: [0; 2] };
}

impl From<MissingValue> for Fault {
    fn from(missing: MissingValue) -> Fault {
        Fault::Missing(missing)
    }
}

struct Run<'a> {
    expression: &'a Expression,
    values: &'a dyn Values,
    stack: Vec<Slot>,
    reads: Vec<Read>,
}

impl Run<'_> {
    /// Executes a node; returns the next node.
    fn step(&mut self, node: u32, operation: Operation) -> Result<u32, Fault> {
        let next = node + 1;
        let value = match operation {
            Operation::Literal(literal) => self.expression.program.literals[literal as usize].clone(),
            Operation::Name(name) => match self.expression.bound[name as usize] {
                Bound::Format(format) => Value::Format(format),
                Bound::Symbol(symbol) => self.read(node, symbol, self.values.value(symbol.id)?)?,
            },
            Operation::Element(name) => self.element(node, name)?,
            Operation::Not => Value::Bool(!self.pop_truth()?),
            Operation::Negate => {
                let Slot { value, part } = self.pop()?;
                arithmetic::negate(&value).map_err(|trouble| Fault::Trouble { trouble, operands: [part; 2] })?
            }
            Operation::Binary(operator) => self.binary(operator)?,
            Operation::Call(function, count) => self.call(node, function, count)?,
            Operation::IfHolds(to) => {
                if !self.truth()? {
                    return Ok(to);
                }
                self.pop()?;
                return Ok(next);
            }
            Operation::IfFails(to) => {
                if self.truth()? {
                    return Ok(to);
                }
                self.pop()?;
                return Ok(next);
            }
            // The second operand leaves the value of the whole, and the part that explains it.
            Operation::And => {
                if !self.truth()? {
                    self.first_operand_decides_nothing(node);
                }
                return Ok(next);
            }
            Operation::Or => {
                let value = self.pop()?.value;
                if value == Value::Bool(true) {
                    self.first_operand_decides_nothing(node);
                }
                value
            }
            Operation::Branch(to) => return Ok(if self.pop_truth()? { next } else { to }),
            Operation::Jump(to) => return Ok(to),
            Operation::If { widen } => {
                let value = self.pop()?.value;
                let ty = if widen { Type::Number } else { value.ty() };
                value.widened(ty).ok_or(Fault::UNDECLARED)?
            }
        };
        self.stack.push(Slot { value, part: node });
        Ok(next)
    }

    fn pop(&mut self) -> Result<Slot, Fault> {
        self.stack.pop().ok_or(Fault::UNDECLARED)
    }

    fn pop_truth(&mut self) -> Result<bool, Fault> {
        let truth = self.truth()?;
        self.pop()?;
        Ok(truth)
    }

    fn truth(&self) -> Result<bool, Fault> {
        match self.stack.last() {
            Some(Slot { value: Value::Bool(value), .. }) => Ok(*value),
            _ => Err(Fault::UNDECLARED),
        }
    }

    /// The second operand of the conjunction or disjunction `node` made its value: the reads of the first one don't count.
    fn first_operand_decides_nothing(&mut self, node: u32) {
        let program = &self.expression.program;
        let first = program.node(node).first..program.node(node.saturating_sub(1)).first;
        self.reads.iter_mut().rev().filter(|read| first.contains(&read.node)).for_each(|read| read.decides = false);
    }

    /// A value that was read, if it has the declared type and is finite.
    fn read(&mut self, node: u32, symbol: Symbol, value: Value) -> Result<Value, Fault> {
        let value = value.widened(symbol.ty).ok_or(Fault::UNDECLARED)?;
        if matches!(value, Value::Number(number) if !number.is_finite()) {
            return Err(Fault::UNDECLARED);
        }
        self.reads.push(Read { node, what: Source::Name(symbol, value.clone()), decides: true });
        Ok(value)
    }

    fn element(&mut self, node: u32, name: u32) -> Result<Value, Fault> {
        let (Slot { value: Value::Integer(at), part: index }, Bound::Symbol(symbol)) =
            (self.pop()?, self.expression.bound[name as usize])
        else {
            return Err(Fault::UNDECLARED);
        };
        let length = self.values.length(symbol.id)?;
        let Some(within) = u64::try_from(at).ok().filter(|at| *at < length) else {
            return Err(Fault::NoElement { at, index, length, declared: symbol.declared });
        };
        self.read(node, symbol, self.values.element(symbol.id, within)?)
    }

    fn binary(&mut self, operator: Binary) -> Result<Value, Fault> {
        let (right, left) = (self.pop()?, self.pop()?);
        arithmetic::binary(operator, &left.value, &right.value)
            .map_err(|trouble| Fault::Trouble { trouble, operands: [left.part, right.part] })
    }

    fn call(&mut self, node: u32, function: Function, count: u32) -> Result<Value, Fault> {
        let from = self.stack.len().saturating_sub(count as usize);
        let parts = [0, 1].map(|at| self.stack.get(from + at).map_or(node, |slot| slot.part));
        let arguments: Vec<Value> = self.stack.drain(from..).map(|slot| slot.value).collect();
        if let (Function::Of(property), [Value::Image(image)]) = (function, &arguments[..]) {
            let value = self.values.property(*image, property)?;
            self.reads.push(Read { node, what: Source::Property(*image, property), decides: true });
            return Ok(Value::Integer(value));
        }
        arithmetic::call(function, &arguments).map_err(|trouble| Fault::Trouble { trouble, operands: parts })
    }

    /// The reads within a part.
    fn read_within(&self, part: u32) -> impl Iterator<Item = &Read> {
        let first = self.expression.program.node(part).first;
        self.reads.iter().filter(move |read| (first..=part).contains(&read.node))
    }

    /// The decisions behind the value of a part.
    fn decided(&self, part: u32) -> Vec<Decision> {
        let mut decided: Vec<Decision> = Vec::new();
        for read in self.read_within(part).filter(|read| read.decides) {
            let (own, others) = match &read.what {
                Source::Name(symbol, value) if symbol.origin.decides() => {
                    (Some(self.named(read.node, *symbol, value)), &[][..])
                }
                Source::Name(symbol, _) => (None, self.values.decided_by(symbol.id)),
                Source::Property(image, property) => (None, self.values.property_decided_by(*image, *property)),
            };
            for decision in own.into_iter().chain(others.iter().cloned()) {
                if !decided.contains(&decision) {
                    decided.push(decision);
                }
            }
        }
        decided
    }

    fn named(&self, node: u32, symbol: Symbol, value: &Value) -> Decision {
        let program = &self.expression.program;
        let name = match program.node(node).operation {
            Operation::Name(name) => program.names[name as usize].0.clone(),
            _ => program.text.part(program.range(node)).into(),
        };
        Decision { name, origin: symbol.origin, value: value.clone() }
    }

    fn failed(&self, part: u32) -> FailedCondition {
        let text = &self.expression.program.text;
        let range = self.expression.program.range(part);
        FailedCondition {
            span: text.span(range.clone()),
            text: text.part(range).to_owned(),
            decided: self.decided(part),
        }
    }

    /// The values that were read within a part: "`levels` = 0, `i` = 1". Images and buffers are not shown.
    fn shown_within(&self, part: u32) -> String {
        let mut values: Vec<String> = Vec::new();
        for read in self.read_within(part) {
            let Source::Name(symbol, value) = &read.what else { continue };
            if matches!(value.ty(), Type::Image | Type::Buffer) {
                continue;
            }
            let Decision { name, value, .. } = self.named(read.node, *symbol, value);
            let value = format!("{} = {value}", shown(&name));
            if !values.contains(&value) {
                values.push(value);
            }
        }
        values.join(", ")
    }

    /// A fault of `node` for people; none if it was reported already.
    fn explain(&self, node: u32, fault: Fault) -> Option<Diagnostic> {
        let program = &self.expression.program;
        let at = |code: Code, part: u32, message: String| {
            program.text.mistake(code, program.range(part), message).remark(self.shown_within(part))
        };
        let declared = |mistake: Diagnostic, declared: Span, remark: &str| match declared.file() {
            Some(_) => mistake.label(declared, remark),
            None => mistake,
        };
        Some(match fault {
            Fault::Trouble { trouble, operands: [first, second] } => match trouble {
                Trouble::DivisionByZero => at(Code::ARITHMETIC, second, "division by zero".to_owned()),
                Trouble::Overflow => {
                    at(Code::ARITHMETIC, node, "this is too large for a whole number of 64 bits".to_owned())
                }
                Trouble::NotFinite => {
                    at(Code::ARITHMETIC, node, "this is too large for a number of 64 bits".to_owned())
                }
                Trouble::NoRoot(value) => {
                    at(Code::ARITHMETIC, first, format!("{} has no square root", shown_number(value)))
                }
                Trouble::NoLogarithm(value) => {
                    at(Code::ARITHMETIC, first, format!("{} has no logarithm", shown_number(value)))
                }
                Trouble::NoPower(base, exponent) => {
                    let [base, exponent] = [base, exponent].map(shown_number);
                    at(Code::ARITHMETIC, node, format!("{base} has no power {exponent}"))
                }
                Trouble::NotWhole(value) => at(
                    Code::ARITHMETIC,
                    node,
                    format!("{} is too large for a whole number of 64 bits", shown_number(value)),
                ),
                Trouble::Bounds(low, high) => {
                    at(Code::ARITHMETIC, node, format!("the lower bound {low} lies above the upper bound {high}"))
                }
                Trouble::Undeclared => {
                    at(Code::ARITHMETIC, node, "this has a value of another type than was declared".to_owned())
                }
            },
            Fault::NoElement { at: index, index: part, length, declared: place } => {
                let name = shown(program.element_name(node));
                let message = match length {
                    0 => format!("{name} has no elements"),
                    1 => format!("{name} has no element {index}: it has one, element 0"),
                    _ => format!("{name} has no element {index}: it has {length}, from 0 to {}", length - 1),
                };
                declared(at(Code::NO_ELEMENT, part, message), place, "declared here")
            }
            Fault::Missing(MissingValue::Below(place)) => {
                let message = format!("{} is not known yet", program.quoted(node));
                declared(at(Code::NOT_KNOWN_YET, node, message), place, "declared here, further below")
            }
            Fault::Missing(MissingValue::Reported) => return None,
        })
    }
}
