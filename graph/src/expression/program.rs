//! The compact form of an expression: its parts in the order in which they are evaluated, operands before operators.

use super::environment::Bound;
use super::functions::Function;
use super::types::{Type, Value};
use crate::base::{Code, Diagnostic, Span};
use std::ops::Range;
use std::sync::Arc;

/// An expression with the meaning of its names: evaluated as often as there are values.
#[derive(Debug, Clone)]
pub struct Expression {
    pub(super) program: Program,
    /// The bindings of the program's names.
    pub(super) bound: Vec<Bound>,
    pub(super) ty: Type,
}

/// An operator between two values; `&&` and `||` are jumps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Binary {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
}

impl Binary {
    pub(super) const fn sign(self) -> &'static str {
        match self {
            Binary::Equal => "==",
            Binary::NotEqual => "!=",
            Binary::Less => "<",
            Binary::LessOrEqual => "<=",
            Binary::Greater => ">",
            Binary::GreaterOrEqual => ">=",
            Binary::Add => "+",
            Binary::Subtract => "-",
            Binary::Multiply => "*",
            Binary::Divide => "/",
            Binary::Remainder => "%",
        }
    }
}

/// The operation of a part on the values that the parts before it left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operation {
    /// Leaves the literal of this number.
    Literal(u32),
    /// Leaves the value of the name of this number.
    Name(u32),
    /// Takes an index, leaves that element of the list which the name of this number stands for.
    Element(u32),
    Not,
    Negate,
    Binary(Binary),
    /// Takes this many values.
    Call(Function, u32),
    /// Between the operands of `&&`: if the first doesn't hold it is the result, and evaluation goes on there.
    IfHolds(u32),
    /// Between the operands of `||`: if the first holds it is the result, and evaluation goes on there.
    IfFails(u32),
    And,
    Or,
    /// After the condition of `if`: if it doesn't hold, evaluation goes on there.
    Branch(u32),
    /// After the first value of `if`: evaluation goes on there.
    Jump(u32),
    /// The end of `if`: whether its value is a whole number that becomes a number.
    If {
        widen: bool,
    },
}

/// A part of an expression.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub(super) operation: Operation,
    /// The first node of this part: the part is the nodes from there to this one.
    pub(super) first: u32,
    /// First byte within the text.
    pub(super) start: u32,
    /// One past the last byte.
    pub(super) end: u32,
}

/// An expression's text and where it stands.
#[derive(Debug, Clone)]
pub(super) struct Text {
    pub(super) text: Arc<str>,
    span: Span,
}

impl Text {
    pub(super) fn new(text: &str, span: Span) -> Text {
        Text { text: text.into(), span }
    }

    /// Where the whole stands.
    pub(super) fn whole(&self) -> Span {
        self.span
    }

    /// Where some bytes stand. An escape is longer than its character: where lengths differ, places within the
    /// text can't be told and the whole stands for them.
    pub(super) fn span(&self, range: Range<u32>) -> Span {
        let mut span = self.span;
        if (span.end.saturating_sub(span.start)) as usize == self.text.len() {
            (span.start, span.end) = (self.span.start + range.start, self.span.start + range.end);
        }
        span
    }

    pub(super) fn part(&self, range: Range<u32>) -> &str {
        self.text.get(range.start as usize..range.end as usize).unwrap_or_default()
    }

    pub(super) fn mistake(&self, code: Code, range: Range<u32>, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, self.span(range), message)
    }
}

/// An expression that was parsed.
#[derive(Debug, Clone)]
pub(super) struct Program {
    pub(super) text: Text,
    pub(super) nodes: Vec<Node>,
    pub(super) literals: Vec<Value>,
    /// Names and where they stand first.
    pub(super) names: Vec<(Arc<str>, Range<u32>)>,
}

impl Program {
    pub(super) fn names(&self) -> impl Iterator<Item = (&str, Span)> {
        self.names.iter().map(|(name, range)| (&**name, self.text.span(range.clone())))
    }

    pub(super) fn node(&self, index: u32) -> Node {
        self.nodes[index as usize]
    }

    /// The name of the list that an element is taken from.
    pub(super) fn element_name(&self, node: u32) -> &str {
        match self.node(node).operation {
            Operation::Element(name) => &self.names[name as usize].0,
            _ => "",
        }
    }

    /// The bytes of a part.
    pub(super) fn range(&self, index: u32) -> Range<u32> {
        let node = self.node(index);
        node.start..node.end
    }

    /// The text of a part, fit for a message.
    pub(super) fn quoted(&self, index: u32) -> String {
        shown(self.text.part(self.range(index)))
    }

    /// The text of a part, if it is short enough for messages to repeat it whole.
    pub(super) fn short(&self, index: u32) -> Option<&str> {
        Some(self.text.part(self.range(index))).filter(|text| text.chars().nth(MOST_SHOWN).is_none())
    }
}

/// Longer texts are cut in messages.
const MOST_SHOWN: usize = 60;

/// A text of the expression in a message: in backticks, cut if it is long.
pub(super) fn shown(text: &str) -> String {
    match text.char_indices().nth(MOST_SHOWN) {
        Some((at, _)) => format!("`{}…`", &text[..at]),
        None => format!("`{text}`"),
    }
}
