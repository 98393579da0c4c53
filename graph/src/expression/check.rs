//! Names are bound, and types checked: one pass over the program, with a stack of types in place of values.

use super::environment::{Bound, Declarations, NameMeaning, Origin, Symbol};
use super::functions::{Callee, Function};
use super::program::Expression;
use super::program::{Binary, Operation, Program, shown};
use super::types::{Type, Value, WantedTypes};
use crate::base::{Code, Diagnostic, Span, nearest, suggestion, without_quotes};
use crate::frame::FrameValue;
use crate::vulkan::{Format, vulkans_name};
use std::ops::Range;

/// Binds the names of a program, and checks its types and its value's.
pub(super) fn check(
    program: Program,
    declarations: &dyn Declarations,
    wanted: WantedTypes<'_>,
) -> Result<Expression, Vec<Diagnostic>> {
    let mut check = Check { program, declarations, names: Vec::new(), stack: Vec::new(), errors: Vec::new() };
    check.bind(wanted);
    for node in (0..).take(check.program.nodes.len()) {
        let ty = check.node(node);
        check.stack.extend(ty.map(|ty| Operand { ty: ty.known(), node }));
    }
    let ty = check.stack.pop().and_then(|value| check.result(value, wanted));
    let Check { program, names, mut errors, .. } = check;
    let bound = names.into_iter().map(|name| if let Name::Bound(bound) = name { Some(bound) } else { None });
    match (ty, bound.collect::<Option<Vec<Bound>>>()) {
        (Some(ty), Some(bound)) if errors.is_empty() => Ok(Expression { program, bound, ty }),
        _ => {
            errors.sort_by_key(|error| error.labels.first().map_or(0, |label| label.span.start));
            Err(errors)
        }
    }
}

/// The type of the value that a node leaves.
#[derive(Clone, Copy)]
enum NodeType {
    Known(Type),
    /// Unknown, since a mistake was reported.
    Unknown,
}

impl NodeType {
    fn known(self) -> Option<Type> {
        match self {
            NodeType::Known(ty) => Some(ty),
            NodeType::Unknown => None,
        }
    }

    fn of(ty: Option<Type>) -> NodeType {
        ty.map_or(NodeType::Unknown, NodeType::Known)
    }
}

/// A type on the stack, `None` if a mistake in it was reported, and the node that left it.
#[derive(Clone, Copy)]
struct Operand {
    ty: Option<Type>,
    node: u32,
}

/// The result of binding a name.
#[derive(Clone, Copy)]
enum Name {
    Bound(Bound),
    /// Reported where its declaration was read, or here with all that can be said.
    Reported,
    /// Reported here: the number of the mistake.
    Unknown(usize),
}

struct Check<'a> {
    program: Program,
    declarations: &'a dyn Declarations,
    names: Vec<Name>,
    stack: Vec<Operand>,
    errors: Vec<Diagnostic>,
}

impl Check<'_> {
    fn bind(&mut self, wanted: WantedTypes<'_>) {
        // The wanted type is known only for a name that is the whole expression.
        let alone = matches!(&self.program.nodes[..], [node] if matches!(node.operation, Operation::Name(_)));
        let wanted = alone.then_some(wanted);
        for (name, range) in &self.program.names {
            let format = || Format::ALL.iter().find(|format| format.name() == &**name).copied();
            let bound = match self.declarations.find(name) {
                NameMeaning::Symbol(symbol) => Name::Bound(Bound::Symbol(symbol)),
                NameMeaning::Reported => Name::Reported,
                NameMeaning::Unknown => match (format(), FrameValue::named(name)) {
                    (Some(format), _) => Name::Bound(Bound::Format(format)),
                    (None, Some(value)) => {
                        self.errors.push(of_frame(&self.program, value, range.clone()));
                        Name::Reported
                    }
                    (None, None) => {
                        let message = format!("there is nothing named {}", shown(name));
                        let help = unknown(name, self.declarations, wanted, alone);
                        let unknown = self.program.text.mistake(Code::UNKNOWN_VALUE, range.clone(), message);
                        self.errors.push(Diagnostic { help, ..unknown });
                        Name::Unknown(self.errors.len() - 1)
                    }
                },
            };
            self.names.push(bound);
        }
    }

    /// The type that a node leaves, if it leaves a value. Takes its operands off the stack.
    fn node(&mut self, node: u32) -> Option<NodeType> {
        Some(match self.program.node(node).operation {
            Operation::Literal(literal) => NodeType::Known(self.program.literals[literal as usize].ty()),
            Operation::Name(name) => self.name(node, name),
            Operation::Element(name) => self.element(node, name),
            Operation::Not => {
                let operand = self.stack.pop()?;
                self.needs("`!`", operand, WantedTypes::BOOL);
                NodeType::Known(Type::Bool)
            }
            Operation::Negate => {
                let operand = self.stack.pop()?;
                NodeType::of(self.number("`-`", operand))
            }
            Operation::Binary(binary) => {
                let (right, left) = (self.stack.pop()?, self.stack.pop()?);
                self.binary(node, binary, left, right)
            }
            Operation::Call(function, count) => {
                let arguments = self.stack.split_off(self.stack.len().saturating_sub(count as usize));
                self.call(function, &arguments)
            }
            Operation::IfHolds(_) | Operation::IfFails(_) => {
                let left = *self.stack.last()?;
                self.needs(self.sign(node), left, WantedTypes::BOOL);
                return None;
            }
            Operation::And | Operation::Or => {
                let (right, _) = (self.stack.pop()?, self.stack.pop()?);
                self.needs(self.sign(node), right, WantedTypes::BOOL);
                NodeType::Known(Type::Bool)
            }
            Operation::Branch(_) => {
                let condition = self.stack.pop()?;
                self.needs("the condition of `if`", condition, WantedTypes::BOOL);
                return None;
            }
            Operation::Jump(_) => return None,
            Operation::If { .. } => {
                let (second, first) = (self.stack.pop()?, self.stack.pop()?);
                self.choice(node, first, second)
            }
        })
    }

    fn sign(&self, node: u32) -> &'static str {
        match self.program.node(node).operation {
            Operation::IfHolds(_) | Operation::And => "`&&`",
            _ => "`||`",
        }
    }

    fn name(&mut self, node: u32, name: u32) -> NodeType {
        match self.names[name as usize] {
            Name::Bound(Bound::Format(_)) => NodeType::Known(Type::Format),
            Name::Bound(Bound::Symbol(Symbol { ty, list: false, .. })) => NodeType::Known(ty),
            Name::Bound(Bound::Symbol(symbol)) => {
                let quoted = self.program.quoted(node);
                let message = format!("{quoted} is a list of {}: it takes an index", symbol.ty.several());
                let help = format!("write `{}[…]`, counted from 0", quoted.trim_matches('`'));
                self.report(Code::INDEX, node, message, symbol.declared, Some(help));
                NodeType::Unknown
            }
            Name::Reported | Name::Unknown(_) => NodeType::Unknown,
        }
    }

    fn element(&mut self, node: u32, name: u32) -> NodeType {
        let index = self.stack.pop();
        if let Some(index) = index {
            self.needs("an index", index, WantedTypes::INTEGER);
        }
        let declared = match self.names[name as usize] {
            Name::Bound(Bound::Symbol(Symbol { ty, list: true, .. })) => return NodeType::Known(ty),
            Name::Bound(Bound::Symbol(symbol)) => symbol.declared,
            Name::Bound(Bound::Format(_)) => Span::NONE,
            Name::Reported | Name::Unknown(_) => return NodeType::Unknown,
        };
        let message = format!("{} is no list: it takes no index", shown(&self.program.names[name as usize].0));
        self.report(Code::INDEX, node, message, declared, None);
        NodeType::Unknown
    }

    fn binary(&mut self, node: u32, binary: Binary, left: Operand, right: Operand) -> NodeType {
        match binary {
            Binary::Equal | Binary::NotEqual => {
                self.equal(node, left, right);
                NodeType::Known(Type::Bool)
            }
            Binary::Less | Binary::LessOrEqual | Binary::Greater | Binary::GreaterOrEqual => {
                for operand in [left, right] {
                    self.number(&format!("`{}`", binary.sign()), operand);
                }
                NodeType::Known(Type::Bool)
            }
            Binary::Add | Binary::Subtract | Binary::Multiply | Binary::Divide | Binary::Remainder => {
                let by = format!("`{}`", binary.sign());
                let (left, right) = (self.number(&by, left), self.number(&by, right));
                NodeType::of(left.zip(right).and_then(|(left, right)| match binary {
                    Binary::Divide => Some(Type::Number),
                    _ => left.meet(right),
                }))
            }
        }
    }

    /// Reports compared values of different types, and comparisons with a text that can't occur.
    fn equal(&mut self, node: u32, left: Operand, right: Operand) {
        for (name, text) in [(left, right), (right, left)] {
            self.text(name, text);
        }
        let (Some(left_type), Some(right_type)) = (left.ty, right.ty) else { return };
        if left_type.meet(right_type).is_none() {
            let (left, right) = (self.is(left.node, left_type), self.is(right.node, right_type));
            self.report(
                Code::WRONG_TYPE,
                node,
                format!("these can't be compared: {left}, and {right}"),
                Span::NONE,
                None,
            );
        }
    }

    /// Reports mistakes in a comparison of `text` with `name`: a text without quotes, a text that never occurs.
    fn text(&mut self, name: Operand, text: Operand) {
        let Operation::Name(name) = self.program.node(name.node).operation else { return };
        if let (Name::Unknown(mistake), Some(Type::Text)) = (self.names[name as usize], text.ty) {
            self.unquoted(mistake, name, text);
        }
        let Name::Bound(Bound::Symbol(symbol @ Symbol { ty: Type::Text, list: false, .. })) = self.names[name as usize]
        else {
            return;
        };
        let Operation::Literal(literal) = self.program.node(text.node).operation else { return };
        let Value::Text(found) = &self.program.literals[literal as usize] else { return };
        let Some(choices) = self.declarations.choices(symbol.id).filter(|choices| !choices.contains(&&**found)) else {
            return;
        };
        let name = shown(&self.program.names[name as usize].0);
        let message = format!("{} {name} is never {}", symbol.origin.words(), self.program.quoted(text.node));
        let quoted: Vec<String> = choices.into_iter().map(|choice| format!("'{choice}'")).collect();
        let help = suggestion(&format!("'{found}'"), quoted.iter().map(String::as_str));
        self.report(Code::NEVER_EQUAL, text.node, message, symbol.declared, help);
    }

    /// A name that nothing has is compared with a text: it may be a near name, or a text without its quotes.
    fn unquoted(&mut self, mistake: usize, name: u32, text: Operand) {
        let written = &self.program.names[name as usize].0;
        let choices = match self.program.node(text.node).operation {
            Operation::Name(other) => match self.names[other as usize] {
                Name::Bound(Bound::Symbol(symbol)) => self.declarations.choices(symbol.id),
                _ => None,
            },
            _ => None,
        };
        let near = choices.as_ref().and_then(|choices| nearest(written, choices.iter().copied()));
        let is_text = |name: &&str| {
            matches!(self.declarations.find(name), NameMeaning::Symbol(Symbol { ty: Type::Text, list: false, .. }))
        };
        let texts: Vec<&str> = self.declarations.names().into_iter().filter(is_text).collect();
        let help = match (near, choices) {
            (Some(near), _) => Some(format!("texts stand in single quotes: `'{near}'`")),
            (None, Some(choices)) if nearest(written, texts.iter().copied()).is_none() => {
                let all: Vec<String> = choices.into_iter().map(|choice| format!("'{choice}'")).collect();
                suggestion("", all.iter().map(String::as_str))
            }
            (None, _) => suggestion(written, texts),
        };
        self.errors[mistake].help = help;
    }

    fn call(&mut self, function: Function, arguments: &[Operand]) -> NodeType {
        let by = format!("`{}`", function.name());
        if let Function::Of(_) = function {
            for argument in arguments {
                self.needs(&by, *argument, WantedTypes::IMAGE);
            }
            return NodeType::Known(Type::Integer);
        }
        let types: Vec<Option<Type>> = arguments.iter().map(|argument| self.number(&by, *argument)).collect();
        match function {
            Function::Min | Function::Max | Function::Clamp | Function::Abs => {
                let met = types.into_iter().reduce(|met, ty| met.zip(ty).and_then(|(met, ty)| met.meet(ty)));
                NodeType::of(met.flatten())
            }
            Function::Floor | Function::Ceil | Function::Round | Function::Of(_) => NodeType::Known(Type::Integer),
            Function::Sqrt | Function::Exp2 | Function::Log2 | Function::Pow => NodeType::Known(Type::Number),
        }
    }

    /// The type that both values of an `if` have; a whole number beside a number becomes a number.
    fn choice(&mut self, node: u32, first: Operand, second: Operand) -> NodeType {
        let (Some(first_type), Some(second_type)) = (first.ty, second.ty) else { return NodeType::Unknown };
        let Some(met) = first_type.meet(second_type) else {
            let (first, second) = (self.is(first.node, first_type), self.is(second.node, second_type));
            let message = format!("the values of `if` have different types: {first}, and {second}");
            self.report(Code::WRONG_TYPE, node, message, Span::NONE, None);
            return NodeType::Unknown;
        };
        self.program.nodes[node as usize].operation = Operation::If { widen: met == Type::Number };
        NodeType::Known(met)
    }

    /// The type of the whole expression. Reports a type that is not wanted.
    fn result(&mut self, value: Operand, wanted: WantedTypes<'_>) -> Option<Type> {
        let ty = value.ty?;
        let widened = ty == Type::Integer && wanted.types.contains(&Type::Number);
        if wanted.types.contains(&ty) {
            return Some(ty);
        }
        if widened {
            return Some(Type::Number);
        }
        self.mismatch(&format!("expected {}", wanted.words), value.node, ty, wanted.types);
        None
    }

    /// Reports an operand that isn't a number.
    fn number(&mut self, by: &str, operand: Operand) -> Option<Type> {
        self.needs(by, operand, WantedTypes::NUMBER)
    }

    /// The type of an operand. Reports a type that is not wanted.
    fn needs(&mut self, by: &str, operand: Operand, wanted: WantedTypes<'_>) -> Option<Type> {
        let Some(ty) = operand.ty else {
            self.suggest_fitting(operand, wanted);
            return None;
        };
        if wanted.types.contains(&ty) || ty == Type::Integer && wanted.types.contains(&Type::Number) {
            return Some(ty);
        }
        self.mismatch(&format!("{by} needs {}", wanted.words), operand.node, ty, wanted.types);
        None
    }

    /// Suggests only names of a wanted type, if the operand is a name that nothing has.
    fn suggest_fitting(&mut self, operand: Operand, wanted: WantedTypes<'_>) {
        let Operation::Name(name) = self.program.node(operand.node).operation else { return };
        if let Name::Unknown(mistake) = self.names[name as usize] {
            self.errors[mistake].help =
                unknown(&self.program.names[name as usize].0, self.declarations, Some(wanted), false);
        }
    }

    fn mismatch(&mut self, needs: &str, node: u32, ty: Type, wanted: &[Type]) {
        let is = self.is(node, ty);
        let (message, declared) = match self.program.node(node).operation {
            Operation::Literal(_) => (format!("{needs}, found {}", self.program.quoted(node)), Span::NONE),
            Operation::Name(name) => match self.names[name as usize] {
                // The message needn't say twice that an image is an image.
                Name::Bound(Bound::Symbol(symbol)) if matches!(symbol.origin, Origin::Image | Origin::Buffer) => {
                    (format!("{needs}, but {is}"), symbol.declared)
                }
                Name::Bound(Bound::Symbol(symbol)) => {
                    (format!("{needs}, but {} {is}", symbol.origin.words()), symbol.declared)
                }
                _ => (format!("{needs}, but {is}"), Span::NONE),
            },
            _ => (format!("{needs}, but {is}"), Span::NONE),
        };
        let written = self.program.short(node);
        let help = match (ty, wanted, written) {
            (Type::Number, [Type::Integer], Some(written)) => {
                Some(format!("write `floor({written})`, `round({written})` or `ceil({written})`"))
            }
            (Type::Number, [Type::Integer], None) => Some("round it: `floor(…)`, `round(…)` or `ceil(…)`".to_owned()),
            // The parentheses are for operators around it that bind more tightly than `>`.
            (Type::Integer | Type::Number, [Type::Bool], Some(written)) => {
                Some(format!("compare it: `({written} > 0)`"))
            }
            (Type::Integer | Type::Number, [Type::Bool], None) => Some("compare it: `(… > 0)`".to_owned()),
            (Type::Text, [.., Type::Image | Type::Buffer], _) => {
                Some("names of images and buffers stand without quotes".to_owned())
            }
            _ => None,
        };
        self.report(Code::WRONG_TYPE, node, message, declared, help);
    }

    /// "`levels` is a whole number"
    fn is(&self, node: u32, ty: Type) -> String {
        format!("{} is {}", self.program.quoted(node), ty.words())
    }

    fn report(&mut self, code: Code, node: u32, message: String, declared: Span, help: Option<String>) {
        let mistake = self.program.text.mistake(code, self.program.range(node), message);
        let mistake = if declared.file().is_some() { mistake.label(declared, "declared here") } else { mistake };
        self.errors.push(Diagnostic { help, ..mistake });
    }
}

/// What is wrong with a value that each frame has its own of.
fn of_frame(program: &Program, value: FrameValue, range: Range<u32>) -> Diagnostic {
    let message = format!("`{}` is another value in each frame, and a Plan holds for all", value.word());
    let help = "it stands alone in `params`, where the shader computes with it; `run: Once` or `run: Every(4)` says in which frames \
                a pass runs; let a setting decide anything else";
    program.text.mistake(Code::FRAME_VALUE, range, message).help(help)
}

/// The help for a name that nothing has. `wanted` is the type that is wanted there, if that is known; `alone`: the name is
/// the whole expression.
fn unknown(
    name: &str,
    declarations: &dyn Declarations,
    wanted: Option<WantedTypes<'_>>,
    alone: bool,
) -> Option<String> {
    if let Some(callee) = Callee::find(name) {
        return Some(format!("the function is written `{}`", callee.form));
    }
    let fits = |ty: Type| {
        let widened = ty == Type::Integer && wanted.is_some_and(|wanted| wanted.types.contains(&Type::Number));
        wanted.is_none_or(|wanted| wanted.types.contains(&ty)) || widened
    };
    let fitting = |name: &&str| matches!(declarations.find(name), NameMeaning::Symbol(symbol) if fits(symbol.ty));
    let known: Vec<&str> = declarations.names().into_iter().filter(fitting).collect();
    let formats = Format::ALL.iter().map(|format| format.name()).filter(|_| fits(Type::Format));
    let near = vulkans_name(name).filter(|_| fits(Type::Format));
    match (near.or_else(|| nearest(name, known.iter().copied().chain(formats))), wanted) {
        (Some(near), _) => Some(format!("did you mean `{near}`?")),
        (None, Some(wanted)) if alone && fits(Type::Integer) && !name.contains('.') => {
            Some(without_quotes(wanted.words, suggestion(name, known)))
        }
        (None, Some(wanted)) if known.is_empty() => Some(format!("{} is wanted here", wanted.words)),
        (None, _) => suggestion(name, known),
    }
}
