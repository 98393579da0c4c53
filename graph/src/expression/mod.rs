//! Expressions: values that a pipeline file calculates from settings, facts of the scene, the view and the device.
//!
//! ```text
//! text ─► tokens ─► parse ─► check (names, types) ─► Expression ─► evaluate (values) ─► Outcome
//! ```
//! An expression stands in quotes where a file takes a number, a format, a condition, an image or a buffer. It is
//! checked as a whole when the file is read, for all settings at once, and evaluated for each frame that is put together.
//! Its text is kept in a flat program, operands before operators: checking and evaluating it are loops, and thousands
//! of variants of a pipeline share one program.
//!
//! # The language
//! ```text
//! a || b                      true if either is; `b` is evaluated only if `a` is false
//! a && b                      true if both are; `b` is evaluated only if `a` is true
//! == != < <= > >=             of two numbers; `==` and `!=` of any two values of one type; not chained
//! a + b, a - b
//! a * b, a / b, a % b
//! !a, -a
//! name[index]                 an element of a list, counted from 0
//! ```
//! from the loosest to the tightest, those of one line from left to right. The rest is parentheses, `true`, `false`,
//! numbers (`12`, `0.5`, `1e-3`), texts in single quotes (`'high'`, without escapes), names (`levels`, `view.width`;
//! also [formats](crate::vulkan::Format) by Vulkan's names, unless something declared has that name) and calls of [`functions`].
//!
//! # Types
//! [`Type`] lists them. A whole number becomes a number where one is needed, never the other way round. `/` always gives
//! a number: `floor(a / b)` divides whole numbers. The remainder `a % b` is never negative.
//!
//! Every expression has a value or a mistake with its place: division by zero, whole numbers beyond 64 bits, numbers
//! that aren't finite, roots and logarithms that don't exist, indices outside a list. None wraps, clamps or is NaN.
//!
//! # Why the parser is our own
//! Precedence climbing takes few lines, and three things matter here that combinators make harder: sentences that say
//! what was found where and what to write instead, a bound on the recursion of prefix operators too (the expression
//! parser of `winnow` has none), and the flat program as its direct output. Crates that evaluate expressions as a whole
//! find types only as they go, and tell no places.

mod arithmetic;
mod check;
mod environment;
mod evaluate;
mod functions;
mod parse;
mod program;
mod tokens;
mod types;

pub use environment::{Decision, Declarations, MissingValue, NameMeaning, Origin, Property, Symbol, Values};
pub use evaluate::{FailedCondition, Outcome};
pub use functions::functions;
pub use parse::{LONGEST_TEXT, MOST_NESTED};
pub use program::Expression;
pub use types::{Type, Value, WantedTypes};

use crate::base::{Diagnostic, Span};
use environment::Bound;
use program::Program;

/// An expression that was parsed; its names are not bound yet.
#[derive(Debug, Clone)]
pub struct ParsedExpression {
    program: Program,
}

impl ParsedExpression {
    /// Parses `text`. `span` is where it stands: all between the quotes. If that has another length than `text`, the
    /// file wrote it with escapes, and every mistake is placed at the whole span.
    ///
    /// # Errors
    /// The first mistake in the text.
    pub fn new(text: &str, span: Span) -> Result<ParsedExpression, Diagnostic> {
        parse::parse(text, span).map(|program| ParsedExpression { program })
    }

    /// Every name that it refers to, once, in the order of the text, with its first place. Formats are among them.
    pub fn names(&self) -> impl Iterator<Item = (&str, Span)> {
        self.program.names()
    }

    /// Binds its names, and checks that types fit together and that the whole has a wanted type.
    ///
    /// # Errors
    /// Every mistake; none if all that is wrong was reported already ([`NameMeaning::Reported`]).
    pub fn check(
        self,
        declarations: &dyn Declarations,
        wanted: WantedTypes<'_>,
    ) -> Result<Expression, Vec<Diagnostic>> {
        check::check(self.program, declarations, wanted)
    }
}

impl Expression {
    /// Parses and checks: see [`ParsedExpression::new`] and [`ParsedExpression::check`].
    ///
    /// # Errors
    /// The mistakes of both.
    pub fn new(
        text: &str,
        span: Span,
        declarations: &dyn Declarations,
        wanted: WantedTypes<'_>,
    ) -> Result<Expression, Vec<Diagnostic>> {
        ParsedExpression::new(text, span).map_err(|mistake| vec![mistake])?.check(declarations, wanted)
    }

    /// As it was written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.program.text.text
    }

    /// Where it stands.
    #[must_use]
    pub fn span(&self) -> Span {
        self.program.text.whole()
    }

    /// The type of its value.
    #[must_use]
    pub const fn ty(&self) -> Type {
        self.ty
    }

    /// Every name that it refers to, once, in the order of the text, with its first place. Formats are among them.
    pub fn names(&self) -> impl Iterator<Item = (&str, Span)> {
        self.program.names()
    }

    /// The declarations of its names, in the order of [`Expression::names`]; formats are left out.
    pub fn symbols(&self) -> impl Iterator<Item = Symbol> {
        self.bound.iter().filter_map(|bound| match bound {
            Bound::Symbol(symbol) => Some(*symbol),
            Bound::Format(_) => None,
        })
    }

    /// Its value.
    ///
    /// # Errors
    /// Why it has none; nothing if that was reported already ([`MissingValue::Reported`]).
    pub fn evaluate(&self, values: &dyn Values) -> Result<Outcome, Vec<Diagnostic>> {
        evaluate::evaluate(self, values)
    }
}
