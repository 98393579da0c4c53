//! Text becomes a [`Program`]: precedence climbing, with a bound on its own recursion.

use super::functions::{CALLEES, Callee};
use super::program::{Binary, Node, Operation, Program, Text, shown};
use super::tokens::{self, Mistake, PlacedToken, Token};
use super::types::Value;
use crate::base::{Code, Diagnostic, Span, nearest, suggestion};
use std::ops::Range;

/// An expression has at most this many bytes.
pub const LONGEST_TEXT: usize = 4096;

/// Parentheses, calls, brackets, `!` and `-` stand at most this deep in each other.
pub const MOST_NESTED: usize = 64;

/// Parses `text`, which stands at `span`.
pub(super) fn parse(text: &str, span: Span) -> Result<Program, Diagnostic> {
    if text.len() > LONGEST_TEXT {
        let message = format!("this expression has {} bytes; {LONGEST_TEXT} are allowed", text.len());
        return Err(Diagnostic::new(Code::EXPRESSION_TOO_LONG, span, message));
    }
    let source = Text::new(text, span);
    let located = |mistake: Mistake| {
        let diagnostic = source.mistake(mistake.code, bytes(&mistake.range), mistake.message);
        match mistake.help {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        }
    };
    let mut parser = match Parser::new(text) {
        Ok(parser) => parser,
        Err(mistake) => return Err(located(mistake)),
    };
    match parser.whole() {
        Ok(()) => {
            let Parser { nodes, literals, names, .. } = parser;
            let names = names.into_iter().map(|(name, range)| (name.into(), bytes(&range))).collect();
            Ok(Program { text: source, nodes, literals, names })
        }
        Err(mistake) => Err(located(mistake)),
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "texts have at most LONGEST_TEXT bytes, and a node has some of them"
)]
const fn short(at: usize) -> u32 {
    at as u32
}

fn bytes(range: &Range<usize>) -> Range<u32> {
    short(range.start)..short(range.end)
}

/// An operator between two operands.
#[derive(Clone, Copy, PartialEq)]
enum Infix {
    Or,
    And,
    Plain(Binary),
}

impl Infix {
    fn of(sign: &str) -> Option<Infix> {
        let plain = match sign {
            "||" => return Some(Infix::Or),
            "&&" => return Some(Infix::And),
            "==" => Binary::Equal,
            "!=" => Binary::NotEqual,
            "<" => Binary::Less,
            "<=" => Binary::LessOrEqual,
            ">" => Binary::Greater,
            ">=" => Binary::GreaterOrEqual,
            "+" => Binary::Add,
            "-" => Binary::Subtract,
            "*" => Binary::Multiply,
            "/" => Binary::Divide,
            "%" => Binary::Remainder,
            _ => return None,
        };
        Some(Infix::Plain(plain))
    }

    /// How tightly it binds.
    const fn power(self) -> u8 {
        match self {
            Infix::Or => 1,
            Infix::And => 2,
            Infix::Plain(Binary::Add | Binary::Subtract) => 4,
            Infix::Plain(Binary::Multiply | Binary::Divide | Binary::Remainder) => 5,
            Infix::Plain(_) => COMPARISON,
        }
    }
}

const COMPARISON: u8 = 3;

/// A jump whose target isn't known yet.
#[derive(Clone, Copy)]
struct Jump {
    at: usize,
    to: fn(u32) -> Operation,
}

struct Parser<'a> {
    text: &'a str,
    next: PlacedToken<'a>,
    /// Parentheses, brackets and prefix operators that are open.
    depth: usize,
    nodes: Vec<Node>,
    literals: Vec<Value>,
    names: Vec<(&'a str, Range<usize>)>,
}

impl<'a> Parser<'a> {
    fn new(text: &'a str) -> Result<Parser<'a>, Mistake> {
        let next = tokens::next(text, 0)?;
        Ok(Parser { text, next, depth: 0, nodes: Vec::new(), literals: Vec::new(), names: Vec::new() })
    }

    /// Takes the next token.
    fn take(&mut self) -> Result<PlacedToken<'a>, Mistake> {
        let after = tokens::next(self.text, self.next.range.end)?;
        Ok(std::mem::replace(&mut self.next, after))
    }

    fn at(&self, sign: &str) -> bool {
        matches!(self.next.token, Token::Sign(next) if next == sign)
    }

    fn push(&mut self, operation: Operation, first: usize, range: &Range<usize>) {
        let Range { start, end } = bytes(range);
        self.nodes.push(Node { operation, first: short(first), start, end });
    }

    /// Pushes a jump whose target isn't known yet.
    fn jump(&mut self, to: fn(u32) -> Operation, range: &Range<usize>) -> Jump {
        let at = self.nodes.len();
        self.push(to(0), at, range);
        Jump { at, to }
    }

    /// Lets a jump go to the next node.
    fn land(&mut self, Jump { at, to }: Jump) {
        let target = short(self.nodes.len());
        self.nodes[at].operation = to(target);
    }

    fn whole(&mut self) -> Result<(), Mistake> {
        if self.next.token == Token::End {
            return Err(Mistake::new(0..self.text.len(), "the expression is empty"));
        }
        self.binary(0)?;
        if self.next.token == Token::End { Ok(()) } else { Err(self.expected("an operator or the end")) }
    }

    /// An operand and all operators after it that bind at least as tightly as `least`. Returns the bytes.
    fn binary(&mut self, least: u8) -> Result<Range<usize>, Mistake> {
        let first = self.nodes.len();
        let mut whole = self.operand()?;
        let mut compared = false;
        while let Token::Sign(sign) = self.next.token {
            let Some(infix) = Infix::of(sign).filter(|infix| infix.power() >= least) else { break };
            if infix.power() == COMPARISON && std::mem::replace(&mut compared, true) {
                let help = "compare twice, `a < b && b < c`, or put one into parentheses";
                return Err(Mistake::new(self.next.range.clone(), "comparisons can't be chained").help(help));
            }
            let sign = self.take()?.range;
            let (skip, operation) = match infix {
                Infix::And => (Some(self.jump(Operation::IfHolds, &sign)), Operation::And),
                Infix::Or => (Some(self.jump(Operation::IfFails, &sign)), Operation::Or),
                Infix::Plain(binary) => (None, Operation::Binary(binary)),
            };
            let right = self.binary(infix.power() + 1)?;
            whole.end = right.end;
            self.push(operation, first, &whole);
            if let Some(skip) = skip {
                self.land(skip);
            }
        }
        Ok(whole)
    }

    /// One level deeper, which the token at `range` opens.
    fn deeper<T>(
        &mut self,
        range: Range<usize>,
        inner: impl FnOnce(&mut Self) -> Result<T, Mistake>,
    ) -> Result<T, Mistake> {
        if self.depth == MOST_NESTED {
            let message = format!("this is nested more than {MOST_NESTED} deep");
            return Err(Mistake::new(range, message).code(Code::EXPRESSION_TOO_LONG));
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        result
    }

    /// A value with the operators before it.
    fn operand(&mut self) -> Result<Range<usize>, Mistake> {
        let first = self.nodes.len();
        let PlacedToken { token, range } = self.next.clone();
        match token {
            Token::Integer(digits) => self.integer(digits, &range),
            Token::Number(digits) => {
                // A token that is called a number is a number; only its size may be too large.
                let number = digits.parse().unwrap_or(f64::INFINITY);
                if !f64::is_finite(number) {
                    return Err(too_large(range, "64-bit floating point reaches about 1.79e308"));
                }
                self.literal(Value::Number(number), &range)
            }
            Token::Text(text) => self.literal(Value::Text(text.into()), &range),
            Token::Name("true") => self.literal(Value::Bool(true), &range),
            Token::Name("false") => self.literal(Value::Bool(false), &range),
            Token::Name(name) => {
                self.take()?;
                if self.at("(") { self.call(name, range) } else { self.name(name, range) }
            }
            Token::Sign("(") => {
                self.take()?;
                self.deeper(range.clone(), |parser| parser.binary(0))?;
                let end = self.close(")", &range)?;
                Ok(range.start..end)
            }
            Token::Sign(sign @ ("!" | "-")) => {
                self.take()?;
                if let (Token::Integer(digits), "-") = (self.next.token, sign) {
                    // The least whole number has no positive twin, so sign and digits are read as one.
                    let whole = range.start..self.next.range.end;
                    let digits = format!("-{digits}");
                    return self.integer(&digits, &whole);
                }
                let inner = self.deeper(range.clone(), Self::operand)?;
                let whole = range.start..inner.end;
                self.push(if sign == "!" { Operation::Not } else { Operation::Negate }, first, &whole);
                Ok(whole)
            }
            Token::Sign(_) | Token::End => Err(self.expected("a value")),
        }
    }

    fn integer(&mut self, digits: &str, range: &Range<usize>) -> Result<Range<usize>, Mistake> {
        match digits.parse() {
            Ok(value) => self.literal(Value::Integer(value), range),
            Err(_) => Err(too_large(range.clone(), "whole numbers have 64 bits; with `.0` it is a number")),
        }
    }

    /// Takes a literal with the value `value`.
    fn literal(&mut self, value: Value, range: &Range<usize>) -> Result<Range<usize>, Mistake> {
        self.take()?;
        let index = short(self.literals.len());
        self.literals.push(value);
        self.push(Operation::Literal(index), self.nodes.len(), range);
        if self.at("[") { Err(self.no_list()) } else { Ok(range.clone()) }
    }

    /// A name that was taken, and the index after it.
    fn name(&mut self, name: &'a str, range: Range<usize>) -> Result<Range<usize>, Mistake> {
        let first = self.nodes.len();
        let index = self.names.iter().position(|(known, _)| *known == name).unwrap_or(self.names.len());
        if index == self.names.len() {
            self.names.push((name, range.clone()));
        }
        if !self.at("[") {
            self.push(Operation::Name(short(index)), first, &range);
            return Ok(range);
        }
        let bracket = self.take()?.range;
        self.deeper(bracket.clone(), |parser| parser.binary(0))?;
        let whole = range.start..self.close("]", &bracket)?;
        self.push(Operation::Element(short(index)), first, &whole);
        if self.at("[") { Err(self.no_list()) } else { Ok(whole) }
    }

    fn no_list(&self) -> Mistake {
        Mistake::new(self.next.range.clone(), "this takes no index")
            .code(Code::INDEX)
            .help("only the name of a list does: `down[i - 1]`")
    }

    /// Takes the sign that closes the bracket at `open`. Returns its end.
    fn close(&mut self, sign: &'static str, open: &Range<usize>) -> Result<usize, Mistake> {
        if self.at(sign) {
            let end = self.take()?.range.end;
            return if sign == ")" && self.at("[") { Err(self.no_list()) } else { Ok(end) };
        }
        if self.next.token == Token::End {
            let message = format!("{} is never closed", shown(&self.text[open.clone()]));
            return Err(Mistake::new(open.clone(), message));
        }
        Err(self.expected(if sign == ")" { "an operator or `)`" } else { "an operator or `]`" }))
    }

    /// `name(…)`, of which the name was taken.
    fn call(&mut self, name: &str, range: Range<usize>) -> Result<Range<usize>, Mistake> {
        let Some(callee) = Callee::find(name) else {
            let known = CALLEES.iter().map(|callee| callee.name);
            let help = match nearest(name, known.clone()).and_then(Callee::find) {
                Some(near) => Some(format!("did you mean `{}`?", near.form)),
                None => suggestion(name, known),
            };
            let unknown = Mistake::new(range, format!("there is no function named {}", shown(name)));
            return Err(Mistake { help, ..unknown.code(Code::UNKNOWN_FUNCTION) });
        };
        let first = self.nodes.len();
        let open = self.take()?.range;
        let (count, skip) = self.deeper(open.clone(), |parser| parser.arguments(callee))?;
        let whole = range.start..self.close(")", &open)?;
        if !callee.takes.contains(&count) {
            let least = callee.takes.start();
            let some = if *callee.takes.end() > *least { "at least " } else { "" };
            let values = if *least == 1 { "value" } else { "values" };
            let message = format!("`{name}` takes {some}{least} {values}, found {count}");
            let wrong = Mistake::new(whole, message).code(Code::ARGUMENTS);
            return Err(wrong.help(format!("write `{}`", callee.form)));
        }
        if let Some(skip) = skip {
            self.land(skip);
        }
        let operation = match callee.function {
            Some(function) => Operation::Call(function, short(count)),
            None => Operation::If { widen: false },
        };
        self.push(operation, first, &whole);
        Ok(whole)
    }

    /// The arguments of a call: how many, and the jump that leads to its end if it evaluates only some.
    fn arguments(&mut self, callee: &Callee) -> Result<(usize, Option<Jump>), Mistake> {
        let (mut count, mut branch, mut skip) = (0, None, None);
        if self.at(")") {
            return Ok((count, skip));
        }
        loop {
            let argument = self.binary(0)?;
            count += 1;
            match (callee.function, count) {
                (None, 1) => branch = Some(self.jump(Operation::Branch, &argument)),
                (None, 2) => {
                    skip = Some(self.jump(Operation::Jump, &argument));
                    if let Some(branch) = branch {
                        self.land(branch);
                    }
                }
                _ => {}
            }
            if !self.at(",") {
                return Ok((count, skip));
            }
            self.take()?;
        }
    }

    /// The mistake that the next token is not `what`, which was expected.
    fn expected(&self, what: &str) -> Mistake {
        let PlacedToken { token, range } = self.next.clone();
        let found = match token {
            Token::End => "the end".to_owned(),
            _ => shown(&self.text[range.clone()]),
        };
        let help = match token {
            Token::Name("and") => Some("\"and\" is written `&&`"),
            Token::Name("or") => Some("\"or\" is written `||`"),
            _ if self.text[..range.start].trim_end().ends_with("not") => Some("\"not\" is written `!`"),
            _ => None,
        };
        let mistake = Mistake::new(range, format!("expected {what}, found {found}"));
        Mistake { help: help.map(str::to_owned), ..mistake }
    }
}

fn too_large(range: Range<usize>, help: &str) -> Mistake {
    Mistake::new(range, "this number is too large").code(Code::NUMBER_TOO_LARGE).help(help)
}
