//! Random expressions against values that are calculated on their trees, and random texts.

use crate::expression::world::{ANY, World};
use framewright_graph::base::{Sources, Span, render};
use framewright_graph::expression::{Expression, ParsedExpression, Type, Value};
use proptest::prelude::*;

/// An expression as a tree.
#[derive(Debug, Clone)]
enum Tree {
    Truth(bool),
    Whole(i64),
    Real(f64),
    Word(&'static str),
    Name(&'static str),
    Prefix(char, Box<Tree>),
    Infix(&'static str, Box<[Tree; 2]>),
    Call(&'static str, Vec<Tree>),
}

/// The value of a tree; whole numbers in 128 bits.
#[derive(Debug, Clone, PartialEq)]
enum Worth {
    Truth(bool),
    Whole(i128),
    Real(f64),
    Word(String),
}

use Worth::{Real, Truth, Whole};

/// Choices that make a tree, the smallest first; at their end all are 0.
struct Tape<'t>(std::slice::Iter<'t, u8>);

impl Tape<'_> {
    fn below(&mut self, limit: usize) -> usize {
        usize::from(self.0.next().copied().unwrap_or(0)) % limit
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    fn tree(&mut self, ty: Type, depth: usize) -> Tree {
        let leaf = depth == 0;
        match ty {
            Type::Bool => match if leaf { self.below(2) } else { self.below(8) } {
                0 => Tree::Truth(self.below(2) == 1),
                1 => Tree::Name(self.pick(&["hdr", "bloom", "scene.has_opaque"])),
                2 => Tree::Prefix('!', self.boxed(Type::Bool, depth)),
                3 => self.infix(&["&&", "||"], Type::Bool, depth),
                4 => self.infix(&["==", "!="], Type::Bool, depth),
                5 => self.infix(&["==", "!="], Type::Text, depth),
                6 => self.choice(Type::Bool, depth),
                _ => {
                    let operator = self.pick(&["==", "!=", "<", "<=", ">", ">="]);
                    let (left, right) = (self.either(depth), self.either(depth));
                    Tree::Infix(operator, Box::new([left, right]))
                }
            },
            Type::Integer => match if leaf { self.below(3) } else { self.below(10) } {
                0 => Tree::Whole([0, 1, 2, 3, 7, 100, i64::MAX, i64::MIN][self.below(8)]),
                1 => Tree::Name(self.pick(&["levels", "none", "view.width", "i"])),
                2 => Tree::Whole(i64::try_from(self.below(256)).expect("small") - 128),
                3 => Tree::Prefix('-', self.boxed(Type::Integer, depth)),
                4..=6 => self.infix(&["+", "-", "*", "%"], Type::Integer, depth),
                7 => Tree::Call(self.pick(&["floor", "ceil", "round"]), vec![self.either(depth)]),
                8 => self.choice(Type::Integer, depth),
                _ => self.several(Type::Integer, depth),
            },
            Type::Number => match if leaf { self.below(2) } else { self.below(9) } {
                0 => Tree::Real([0.0, 0.5, 1.0, 2.0, 1e-3, 1e300, 2.5, 1e17][self.below(8)]),
                1 => Tree::Name(self.pick(&["radius", "strength"])),
                2 => Tree::Prefix('-', self.boxed(Type::Number, depth)),
                3 => {
                    let (left, right) = (self.either(depth), self.either(depth));
                    Tree::Infix("/", Box::new([left, right]))
                }
                4 | 5 => {
                    let operator = self.pick(&["+", "-", "*", "%"]);
                    let operands = [self.either(depth), self.tree(Type::Number, depth - 1)];
                    Tree::Infix(operator, Box::new(operands))
                }
                6 => Tree::Call(self.pick(&["sqrt", "exp2", "log2"]), vec![self.either(depth)]),
                7 => self.choice(Type::Number, depth),
                _ => self.several(Type::Number, depth),
            },
            _ => match self.below(2) {
                0 => Tree::Word(self.pick(&["low", "high"])),
                _ => Tree::Name("quality"),
            },
        }
    }

    fn boxed(&mut self, ty: Type, depth: usize) -> Box<Tree> {
        Box::new(self.tree(ty, depth - 1))
    }

    /// A whole number or a number.
    fn either(&mut self, depth: usize) -> Tree {
        let ty = self.pick(&[Type::Integer, Type::Number]);
        self.tree(ty, depth - 1)
    }

    fn infix(&mut self, operators: &[&'static str], ty: Type, depth: usize) -> Tree {
        let operator = self.pick(operators);
        let operands = [self.tree(ty, depth - 1), self.tree(ty, depth - 1)];
        Tree::Infix(operator, Box::new(operands))
    }

    /// The second value of a choice of numbers may be whole.
    fn choice(&mut self, ty: Type, depth: usize) -> Tree {
        let condition = self.tree(Type::Bool, depth - 1);
        let mut values =
            [self.tree(ty, depth - 1), if ty == Type::Number { self.either(depth) } else { self.tree(ty, depth - 1) }];
        if self.below(2) == 1 {
            values.reverse();
        }
        let [first, second] = values;
        Tree::Call("if", vec![condition, first, second])
    }

    /// A function of several values, one of which at least has the type.
    fn several(&mut self, ty: Type, depth: usize) -> Tree {
        let name = self.pick(&["min", "max", "clamp", "abs"]);
        let mut values = vec![self.tree(ty, depth - 1)];
        for _ in 1..match name {
            "abs" => 1,
            "clamp" => 3,
            _ => 2 + self.below(3),
        } {
            values.push(if ty == Type::Number { self.either(depth) } else { self.tree(ty, depth - 1) });
        }
        let turn = self.below(values.len());
        values.rotate_left(turn);
        Tree::Call(name, values)
    }
}

fn real(worth: &Worth) -> f64 {
    match worth {
        Whole(value) => *value as f64,
        Real(value) => *value,
        other => panic!("{other:?} is no number"),
    }
}

fn finite(value: f64) -> Option<Worth> {
    value.is_finite().then_some(Real(value))
}

fn whole(value: i128) -> Option<Worth> {
    i64::try_from(value).ok().map(|_| Whole(value))
}

impl Tree {
    /// Whether it is a number that needn't be whole.
    fn is_real(&self) -> bool {
        match self {
            Tree::Real(_) | Tree::Name("radius" | "strength") | Tree::Infix("/", _) => true,
            Tree::Prefix(_, inner) => inner.is_real(),
            Tree::Infix("+" | "-" | "*" | "%", operands) => operands.iter().any(Tree::is_real),
            Tree::Call("sqrt" | "exp2" | "log2", _) => true,
            Tree::Call("min" | "max" | "clamp" | "abs" | "if", values) => values.iter().any(Tree::is_real),
            _ => false,
        }
    }

    /// Its value, by rules of its own; `None` if it has none.
    fn worth(&self) -> Option<Worth> {
        match self {
            Tree::Truth(value) => Some(Truth(*value)),
            Tree::Whole(value) => Some(Whole((*value).into())),
            Tree::Real(value) => Some(Real(*value)),
            Tree::Word(value) => Some(Worth::Word((*value).to_owned())),
            Tree::Name(name) => Some(match *name {
                "hdr" | "scene.has_opaque" => Truth(true),
                "bloom" => Truth(false),
                "levels" => Whole(5),
                "none" => Whole(0),
                "view.width" => Whole(1920),
                "i" => Whole(1),
                "radius" => Real(1.5),
                "strength" => Real(0.25),
                _ => Worth::Word("high".to_owned()),
            }),
            Tree::Prefix(_, inner) => match inner.worth()? {
                Truth(value) => Some(Truth(!value)),
                Whole(value) => whole(-value),
                other => finite(-real(&other)),
            },
            Tree::Infix(operator, operands) => infix(operator, &operands[0], &operands[1]),
            Tree::Call("if", values) => {
                let chosen = if values[0].worth()? == Truth(true) { &values[1] } else { &values[2] };
                self.with_its_type(chosen.worth()?)
            }
            Tree::Call(name, values) => {
                let values = values.iter().map(Tree::worth).collect::<Option<Vec<Worth>>>()?;
                self.with_its_type(call(name, &values)?)
            }
        }
    }

    fn with_its_type(&self, worth: Worth) -> Option<Worth> {
        Some(if self.is_real() { Real(real(&worth)) } else { worth })
    }

    /// How tightly it holds together when printed.
    fn strength(&self) -> u8 {
        match self {
            Tree::Infix("||", _) => 1,
            Tree::Infix("&&", _) => 2,
            Tree::Infix("==" | "!=" | "<" | "<=" | ">" | ">=", _) => 3,
            Tree::Infix("+" | "-", _) => 4,
            Tree::Infix(..) => 5,
            Tree::Prefix(..) => 6,
            _ => 7,
        }
    }

    /// Its text, with the parentheses that it needs or with all that it may have.
    fn text(&self, all: bool) -> String {
        let inner = |tree: &Tree, least: u8| {
            let text = tree.text(all);
            if all || tree.strength() < least { format!("({text})") } else { text }
        };
        match self {
            Tree::Truth(value) => value.to_string(),
            Tree::Whole(value) => value.to_string(),
            Tree::Real(value) => format!("{value:?}"),
            Tree::Word(value) => format!("'{value}'"),
            Tree::Name(name) => (*name).to_owned(),
            Tree::Prefix(sign, of) => format!("{sign}{}", inner(of, 6)),
            Tree::Infix(operator, operands) => {
                let strength = self.strength();
                // Comparisons hold together neither to the left nor to the right.
                let left = inner(&operands[0], if strength == 3 { 4 } else { strength });
                format!("{left} {operator} {}", inner(&operands[1], strength + 1))
            }
            Tree::Call(name, values) => {
                let values: Vec<String> = values.iter().map(|value| inner(value, 0)).collect();
                format!("{name}({})", values.join(", "))
            }
        }
    }
}

fn infix(operator: &str, left: &Tree, right: &Tree) -> Option<Worth> {
    let first = left.worth()?;
    match (operator, &first) {
        ("&&", Truth(false)) | ("||", Truth(true)) => return Some(first),
        ("&&" | "||", _) => return right.worth(),
        _ => {}
    }
    let second = right.worth()?;
    let pair = match (&first, &second) {
        (Whole(first), Whole(second)) => Some((*first, *second)),
        _ => None,
    };
    let equal = || match (&first, &second, pair) {
        (Truth(_), ..) | (Worth::Word(_), ..) => first == second,
        (_, _, Some((first, second))) => first == second,
        _ => real(&first) == real(&second),
    };
    let less = |first: &Worth, second: &Worth| match (first, second) {
        (Whole(first), Whole(second)) => first < second,
        _ => real(first) < real(second),
    };
    match (operator, pair) {
        ("==", _) => Some(Truth(equal())),
        ("!=", _) => Some(Truth(!equal())),
        ("<", _) => Some(Truth(less(&first, &second))),
        (">", _) => Some(Truth(less(&second, &first))),
        ("<=", _) => Some(Truth(less(&first, &second) || equal())),
        (">=", _) => Some(Truth(less(&second, &first) || equal())),
        ("+", Some((first, second))) => whole(first + second),
        ("-", Some((first, second))) => whole(first - second),
        ("*", Some((first, second))) => whole(first * second),
        ("%", Some((first, second))) => {
            whole(first.checked_rem(second)? + if first % second < 0 { second.abs() } else { 0 })
        }
        ("+", None) => finite(real(&first) + real(&second)),
        ("-", None) => finite(real(&first) - real(&second)),
        ("*", None) => finite(real(&first) * real(&second)),
        ("/", _) => finite(real(&first) / real(&second)),
        ("%", None) => {
            let (first, second) = (real(&first), real(&second));
            let rest = first % second;
            finite(if rest < 0.0 { rest + second.abs() } else { rest })
        }
        other => panic!("{other:?}"),
    }
}

fn call(name: &str, values: &[Worth]) -> Option<Worth> {
    let wholes: Option<Vec<i128>> =
        values.iter().map(|value| if let Whole(value) = value { Some(*value) } else { None }).collect();
    let reals = || values.iter().map(real);
    match (name, wholes.as_deref()) {
        ("min", Some(wholes)) => wholes.iter().min().copied().and_then(whole),
        ("max", Some(wholes)) => wholes.iter().max().copied().and_then(whole),
        ("abs" | "floor" | "ceil" | "round", Some([value])) => whole(if name == "abs" { value.abs() } else { *value }),
        ("clamp", Some([value, low, high])) => (low <= high).then(|| Whole((*value).clamp(*low, *high))),
        ("min", None) => reals().reduce(f64::min).and_then(finite),
        ("max", None) => reals().reduce(f64::max).and_then(finite),
        ("clamp", None) => {
            let (value, low, high) = (real(&values[0]), real(&values[1]), real(&values[2]));
            (low <= high).then(|| Real(value.clamp(low, high)))
        }
        ("abs", None) => finite(real(&values[0]).abs()),
        ("floor" | "ceil" | "round", None) => {
            let value = real(&values[0]);
            let value = match name {
                "floor" => value.floor(),
                "ceil" => value.ceil(),
                _ => value.round(),
            };
            whole(value as i128)
        }
        ("sqrt", _) => finite(real(&values[0]).sqrt()),
        ("exp2", _) => finite(real(&values[0]).exp2()),
        ("log2", _) => finite(real(&values[0]).log2()),
        other => panic!("{other:?}"),
    }
}

/// Compares a text's value with what its tree comes to.
fn comes_to(text: &str, worth: Option<&Worth>) {
    let world = World::new();
    let expression =
        Expression::new(text, Span::NONE, &world, ANY).unwrap_or_else(|errors| panic!("{text}: {errors:?}"));
    let value = expression.evaluate(&world);
    let same = match (&value, worth) {
        (Ok(outcome), Some(worth)) => match (&outcome.value, worth) {
            (Value::Bool(value), Truth(worth)) => value == worth,
            (Value::Integer(value), Whole(worth)) => i128::from(*value) == *worth,
            (Value::Number(value), Real(worth)) => value == worth,
            (Value::Text(value), Worth::Word(worth)) => **value == **worth,
            _ => false,
        },
        (Err(errors), None) => errors.len() == 1,
        _ => false,
    };
    assert!(same, "{text}\nis {value:?}\nand comes to {worth:?}");
}

/// Pieces that expressions are made of, and some that they aren't.
const PIECES: &[&str] = &[
    "levels",
    "hdr",
    "down",
    "source",
    "i",
    "quality",
    "'high'",
    "'",
    "scene.",
    "scene.has_opaque",
    "0",
    "1",
    "2.5",
    "1e999",
    "99999999999999999999",
    "(",
    ")",
    "[",
    "]",
    ",",
    "+",
    "-",
    "*",
    "/",
    "%",
    "!",
    "&&",
    "||",
    "==",
    "<",
    "if(",
    "min(",
    "width(",
    " ",
    "é",
    "\u{9b}",
    "\n",
    "\0",
    "=",
    ".",
    "\"",
    "true",
    "R8_UNORM",
];

/// Reads and evaluates a text; panics if that does, or if a mistake can't be shown.
fn goes_through(text: &str) {
    let world = World::new();
    let mut sources = Sources::default();
    let file = sources.add("p.ron", "p.ron", format!("\"{text}\""));
    let span = Span::new(file, 1, u32::try_from(text.len()).expect("short") + 1);
    for span in [span, Span::new(file, 0, span.end + 1), Span::NONE] {
        let answer = Expression::new(text, span, &world, ANY).and_then(|expression| expression.evaluate(&world));
        for mistake in answer.err().into_iter().flatten() {
            let place = mistake.labels[0].span;
            assert!(
                span.start <= place.start && place.start <= place.end && place.end <= span.end,
                "{text:?}: {mistake:?}"
            );
            let shown = render(&sources, std::slice::from_ref(&mistake));
            assert!(shown.starts_with("error: ") && shown.chars().all(|c| c == '\n' || !c.is_control()), "{shown:?}");
        }
    }
    if let Ok(parsed) = ParsedExpression::new(text, span) {
        for (name, place) in parsed.names() {
            assert_eq!(&text[place.start as usize - 1..place.end as usize - 1], name);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    #[test]
    fn random_expressions_come_to_what_their_trees_do(
        tape in proptest::collection::vec(any::<u8>(), 0..120), ty in 0..4_usize, depth in 0..6_usize,
    ) {
        let ty = [Type::Bool, Type::Integer, Type::Number, Type::Text][ty];
        let tree = Tape(tape.iter()).tree(ty, depth);
        let worth = tree.worth();
        for text in [tree.text(false), tree.text(true)] {
            if text.len() <= framewright_graph::expression::LONGEST_TEXT {
                comes_to(&text, worth.as_ref());
            }
        }
    }

    #[test]
    fn any_text_is_answered(text in "\\PC{0,60}") {
        goes_through(&text);
    }

    #[test]
    fn any_pieces_are_answered(pieces in proptest::collection::vec(0..PIECES.len(), 0..14)) {
        goes_through(&pieces.into_iter().map(|piece| PIECES[piece]).collect::<String>());
    }
}
