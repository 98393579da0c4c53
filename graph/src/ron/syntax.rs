//! From text to a tree in one pass, by RON's grammar.
//!
//! After a mistake inside a list, a map or fields, reading goes on behind the next comma of the same brackets. Where
//! brackets or quotes are amiss it stops: the rest would be a guess.

use super::lexer::{Lexer, Stop};
use super::node::{Kind, Node};
use crate::base::{Code, Diagnostic, MOST_KEPT};

/// Brackets are nested at most this deep.
const DEEPEST: usize = 128;

/// Attributes that a file may begin with: `#![enable(…)]`. They change nothing here.
const EXTENSIONS: [&str; 4] = ["unwrap_newtypes", "implicit_some", "unwrap_variant_newtypes", "explicit_struct_names"];

/// The nodes of a file's tree; `None` if a mistake leaves no tree.
pub(crate) fn nodes(file: u32, text: &str, errors: &mut Vec<Diagnostic>) -> Option<Vec<Node>> {
    let lexer = Lexer { file, text, at: 0, long: None };
    // A node takes six bytes of usual text.
    let (nodes, misplaced) = (Vec::with_capacity(text.len() / 6), Vec::new());
    let mut parser = Parser { lexer, nodes, depth: 0, misplaced, errors };
    let whole = parser.file();
    let mut nodes = parser.nodes;
    match whole {
        Ok(()) => {
            nodes.shrink_to_fit();
            Some(nodes)
        }
        Err(Stop::Value(error) | Stop::Misplaced(error) | Stop::File(error)) => {
            errors.push(error);
            None
        }
    }
}

struct Parser<'t, 'e> {
    lexer: Lexer<'t>,
    nodes: Vec<Node>,
    /// Brackets that are open.
    depth: usize,
    /// Items in brackets where they can't stand. If brackets turn out to be left open, they should have ended there.
    misplaced: Vec<MisplacedItem>,
    errors: &'e mut Vec<Diagnostic>,
}

/// Something that stands in brackets where it can't.
struct MisplacedItem {
    /// The number of its mistake.
    error: usize,
    /// Where it stands.
    at: usize,
    /// Where the brackets were opened.
    open: usize,
    closing: u8,
}

/// An item between two commas.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Item {
    Value,
    /// `name: value`
    Field,
    /// `key: value`
    Entry,
}

impl Parser<'_, '_> {
    fn file(&mut self) -> Result<(), Stop> {
        self.lexer.blanks()?;
        while self.lexer.byte() == Some(b'#') {
            self.attribute()?;
            self.lexer.blanks()?;
        }
        if self.lexer.byte().is_none() {
            let whole = self.lexer.character(0);
            return Err(Stop::File(self.lexer.diagnostic(
                Code::FILE_EMPTY,
                whole,
                "the file holds no value, only blanks and comments",
            )));
        }
        self.value()?;
        self.lexer.blanks()?;
        if self.lexer.at < self.lexer.text.len() {
            let more = self.lexer.character(self.lexer.at);
            self.report(self.lexer.diagnostic(Code::RON_SYNTAX, more, "something stands after the last bracket"))?;
        }
        Ok(())
    }

    /// Keeps a mistake, unless a text right before it runs over several lines: then the quote of that text is the mistake.
    fn report(&mut self, error: Diagnostic) -> Result<(), Stop> {
        let at = error.labels.first().map_or(0, |label| label.span.start as usize);
        if let Some(long) = self.lexer.long.clone()
            && self.lexer.text.get(long.end..at).is_some_and(|between| between.trim().is_empty())
        {
            let open = self.lexer.diagnostic(
                Code::NOT_CLOSED,
                long.start..long.start + 1,
                "this text runs over several lines, and makes no sense there",
            );
            let open = error.labels.iter().fold(open, |open, label| open.label(label.span, error.message.clone()));
            return Err(Stop::File(open.help("is its closing quote missing?")));
        }
        // The rest of a file with very many mistakes isn't read.
        if self.errors.len() >= MOST_KEPT {
            return Err(Stop::File(error));
        }
        self.errors.push(error);
        Ok(())
    }

    /// `#![enable(extension, …)]`, `#![type = "…"]` or `#![schema = "…"]`.
    fn attribute(&mut self) -> Result<(), Stop> {
        let start = self.lexer.at;
        for sign in ["#", "!", "["] {
            self.sign(sign, start)?;
        }
        let word = self.lexer.word();
        let name = &self.lexer.rest()[..word];
        self.lexer.at += word;
        self.lexer.blanks()?;
        match name {
            "enable" => {
                self.sign("(", start)?;
                loop {
                    let from = self.lexer.at;
                    let word = self.lexer.word();
                    let name = &self.lexer.rest()[..word];
                    if !EXTENSIONS.contains(&name) {
                        let unknown = self.lexer.diagnostic(
                            Code::RON_SYNTAX,
                            from..from + word,
                            format!("RON has no extension `{name}`"),
                        );
                        let known = EXTENSIONS.map(|name| format!("`{name}`")).join(", ");
                        return Err(Stop::File(unknown.help(format!("there are {known}"))));
                    }
                    self.lexer.at += word;
                    self.lexer.blanks()?;
                    let comma = self.lexer.byte() == Some(b',');
                    if comma {
                        self.sign(",", start)?;
                    }
                    if !comma || self.lexer.byte() == Some(b')') {
                        break;
                    }
                }
                self.sign(")", start)?;
            }
            "type" | "schema" => {
                self.sign("=", start)?;
                match self.lexer.scalar() {
                    Some(Ok(Kind::Text | Kind::Escaped | Kind::Raw)) => self.lexer.blanks()?,
                    _ => return Err(self.no_attribute(start)),
                }
            }
            _ => return Err(self.no_attribute(start)),
        }
        self.sign("]", start)
    }

    fn sign(&mut self, sign: &str, start: usize) -> Result<(), Stop> {
        if !self.lexer.rest().starts_with(sign) {
            return Err(self.no_attribute(start));
        }
        self.lexer.at += sign.len();
        self.lexer.blanks()
    }

    fn no_attribute(&self, start: usize) -> Stop {
        let wrong = self.lexer.diagnostic(Code::RON_SYNTAX, start..start + 1, "this is no attribute of RON");
        Stop::File(
            wrong.help("attributes are `#![enable(implicit_some)]`, `#![type = \"…\"]` and `#![schema = \"…\"]`"),
        )
    }

    fn open(&mut self, kind: Kind, start: usize) -> usize {
        let start = place(start);
        self.nodes.push(Node { start, end: start, after: 0, text: 0, kind });
        self.nodes.len() - 1
    }

    /// The node ends here, with all that was added since.
    fn close(&mut self, node: usize) {
        let (end, after) = (place(self.lexer.at), place(self.nodes.len()));
        let node = &mut self.nodes[node];
        (node.end, node.after) = (end, after);
    }

    fn value(&mut self) -> Result<(), Stop> {
        let start = self.lexer.at;
        match self.lexer.byte() {
            None => return Err(self.lexer.ends(None)),
            Some(b'(') => return self.parentheses(),
            Some(b'[') => return self.brackets(Kind::List, b']', Item::Value),
            Some(b'{') => return self.brackets(Kind::Map, b'}', Item::Entry),
            _ => {}
        }
        if let Some(kind) = self.lexer.scalar() {
            let kind = kind?;
            let node = self.open(kind, start);
            self.close(node);
            return Ok(());
        }
        let length = self.lexer.word();
        if length == 0 {
            let found = self.lexer.character(start);
            let shown = self.lexer.text[found.clone()].escape_debug().to_string();
            return Err(Stop::Value(self.lexer.diagnostic(
                Code::RON_SYNTAX,
                found,
                format!("expected a value, found `{shown}`"),
            )));
        }
        self.lexer.at += length;
        let end = self.lexer.at;
        self.lexer.blanks()?;
        let alone = matches!(&self.lexer.text[start..end], "true" | "false" | "None" | "inf" | "NaN");
        if self.lexer.byte() != Some(b'(') || alone {
            self.word(start, end);
            return Ok(());
        }
        let named = self.open(Kind::Named, start);
        self.word(start, end);
        self.parentheses()?;
        self.close(named);
        Ok(())
    }

    fn word(&mut self, start: usize, end: usize) {
        let after = place(self.nodes.len() + 1);
        self.nodes.push(Node { start: place(start), end: place(end), after, text: 0, kind: Kind::Word });
    }

    /// `(…)`: fields if it begins with a word that is no value by itself.
    fn parentheses(&mut self) -> Result<(), Stop> {
        let open = self.lexer.at;
        self.lexer.at += 1;
        self.lexer.blanks()?;
        let first = self.lexer.word();
        let mut named = false;
        if first > 0 {
            let start = self.lexer.at;
            self.lexer.at += first;
            self.lexer.blanks()?;
            // The name of a field may lack its colon; behind a value stands a comma or a bracket.
            named = !matches!(self.lexer.byte(), None | Some(b',' | b'(' | b')' | b']' | b'}'));
            self.lexer.at = start;
        }
        self.lexer.at = open;
        match named {
            true => self.brackets(Kind::Fields, b')', Item::Field),
            false => self.brackets(Kind::Tuple, b')', Item::Value),
        }
    }

    /// Items between brackets, with commas.
    fn brackets(&mut self, kind: Kind, closing: u8, item: Item) -> Result<(), Stop> {
        let open = self.lexer.at;
        if self.depth == DEEPEST {
            let deep = self.lexer.diagnostic(Code::NESTED_TOO_DEEPLY, open..open + 1, "brackets are nested too deeply");
            return Err(Stop::File(deep.help("no file needs more than a dozen levels")));
        }
        self.depth += 1;
        let node = self.open(kind, open);
        self.lexer.at += 1;
        // Several items without commas between them are one mistake.
        let mut comma_missed = false;
        loop {
            self.lexer.blanks()?;
            match self.lexer.byte() {
                None => {
                    let ends = self.lexer.ends(Some(open));
                    return Err(self.left_open(open).unwrap_or(ends));
                }
                Some(byte) if byte == closing => break,
                Some(b')' | b']' | b'}') => {
                    let other = self.other_bracket(open, closing);
                    return Err(self.left_open(open).unwrap_or(other));
                }
                Some(_) => {}
            }
            let (start, nodes, depth) = (self.lexer.at, self.nodes.len(), self.depth);
            match self.item(item) {
                Ok(()) => {}
                Err(stop @ (Stop::Value(_) | Stop::Misplaced(_))) => {
                    match stop {
                        Stop::Misplaced(error) => self.report_misplaced(error, open, closing)?,
                        Stop::Value(error) | Stop::File(error) => self.report(error)?,
                    }
                    self.skip()?;
                    self.nodes.truncate(nodes);
                    self.depth = depth;
                    for _ in 0..if item == Item::Value { 1 } else { 2 } {
                        let broken = self.open(Kind::Broken, start);
                        self.close(broken);
                    }
                }
                Err(stop) => return Err(stop),
            }
            self.lexer.blanks()?;
            match self.lexer.byte() {
                Some(b',') => {
                    self.lexer.at += 1;
                    comma_missed = false;
                }
                Some(b')' | b']' | b'}') | None => {}
                Some(byte) => {
                    if !comma_missed {
                        let here = self.lexer.character(self.lexer.at);
                        let wrong = self.lexer.diagnostic(Code::RON_SYNTAX, here, "expected a comma");
                        self.report_misplaced(wrong, open, closing)?;
                    }
                    comma_missed = true;
                    // A character that begins no value would be a second mistake at this place.
                    if !byte.is_ascii_alphanumeric() && !b"\"'([{+-._".contains(&byte) {
                        self.skip()?;
                        self.lexer.at += usize::from(self.lexer.byte() == Some(b','));
                    }
                }
            }
        }
        self.lexer.at += 1;
        self.close(node);
        self.depth -= 1;
        Ok(())
    }

    /// Reports an item that can't stand in the brackets that were opened at `open`.
    fn report_misplaced(&mut self, error: Diagnostic, open: usize, closing: u8) -> Result<(), Stop> {
        let at = error.labels.first().map_or(0, |label| label.span.start as usize);
        self.report(error)?;
        self.misplaced.push(MisplacedItem { error: self.errors.len() - 1, at, open, closing });
        Ok(())
    }

    /// The brackets that were opened at `open` aren't closed here. Where an item within them was misplaced before, brackets
    /// should have ended there, and mistakes that were reported since follow from that.
    fn left_open(&mut self, open: usize) -> Option<Stop> {
        let first = self.misplaced.iter().find(|misplaced| misplaced.at > open)?;
        let (opened, closing, error) = (first.open, char::from(first.closing), first.error);
        let mut wrong = self.errors.drain(error..).next()?;
        wrong.message = format!("{} or `{closing}`", wrong.message);
        let here = self.lexer.character(self.lexer.at);
        let (opened, here) = (self.lexer.span(opened..opened + 1), self.lexer.span(here));
        Some(Stop::File(wrong.label(opened, "opened here").label(here, "still open here")))
    }

    fn other_bracket(&self, open: usize, closing: u8) -> Stop {
        let here = self.lexer.character(self.lexer.at);
        let wrong = self.lexer.diagnostic(Code::NOT_CLOSED, here, format!("expected `{}`", char::from(closing)));
        Stop::File(wrong.label(self.lexer.span(open..open + 1), "opened here"))
    }

    fn item(&mut self, item: Item) -> Result<(), Stop> {
        match item {
            Item::Value => return self.value(),
            Item::Field => {
                let start = self.lexer.at;
                self.lexer.at += self.lexer.word();
                if self.lexer.at == start {
                    let found = self.lexer.character(start);
                    return Err(Stop::Misplaced(self.lexer.diagnostic(
                        Code::RON_SYNTAX,
                        found,
                        "expected the name of a field",
                    )));
                }
                self.word(start, self.lexer.at);
            }
            Item::Entry => self.value()?,
        }
        self.lexer.blanks()?;
        if self.lexer.byte() != Some(b':') {
            let found = self.lexer.character(self.lexer.at);
            return Err(Stop::Misplaced(self.lexer.diagnostic(Code::RON_SYNTAX, found, "expected a colon")));
        }
        self.lexer.at += 1;
        self.lexer.blanks()?;
        self.value()
    }

    /// Passes over the rest of an item: to the next comma or closing bracket of the brackets around it.
    fn skip(&mut self) -> Result<(), Stop> {
        let mut depth = 0_usize;
        while let Some(byte) = self.lexer.byte() {
            match byte {
                b'"' => {
                    // A text with a mistake in it still ends at its quote.
                    if let Some(Err(stop @ Stop::File(_))) = self.lexer.scalar() {
                        return Err(stop);
                    }
                }
                b'/' => {
                    if let Err(stop @ Stop::File(_)) = self.lexer.blanks() {
                        return Err(stop);
                    }
                }
                b',' if depth == 0 => break,
                b')' | b']' | b'}' if depth == 0 => break,
                b'(' | b'[' | b'{' => (depth, self.lexer.at) = (depth + 1, self.lexer.at + 1),
                b')' | b']' | b'}' => (depth, self.lexer.at) = (depth - 1, self.lexer.at + 1),
                _ => self.lexer.at += 1,
            }
        }
        Ok(())
    }
}

/// Texts have less than 4 GiB, and no more nodes than bytes.
fn place(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}
