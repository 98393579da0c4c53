//! The forms of values in a pipeline's files, as data: the readers' own tables of fields and words.
//!
//! ```text
//! fields!, Words, Form ─┬─► schema: a JSON Schema, of files as `convert` makes JSON of them
//! (beside each reader)  └─► docs/language.md, which a test renews
//! ```
//! Readers take the names of fields and words from these tables. So schema and page name all words that are read, and
//! no others.

/// The form of a value in a file.
#[derive(Debug, Clone, Copy)]
pub enum Form {
    /// Any value: the table doesn't say its form.
    Anything,
    /// A value by itself, never an expression.
    Plain(PlainForm),
    /// `true` or `false`, or an expression.
    Truth,
    /// A whole number from the one to the other, or an expression.
    Whole(i64, i64),
    /// One of these whole numbers.
    Listed(&'static [u32]),
    /// A number, or an expression.
    Number,
    /// An expression in quotes for the value that the words name: "a condition".
    Expression(&'static str),
    /// A name, or an expression, for an image or buffer: "an image".
    Reference(&'static str),
    /// `(name: value, …)`
    Fields(fn() -> Table),
    /// One of several words, most with something in parentheses.
    Words(&'static Words),
    /// One of several words that stand alone: the name of their kind, and the words.
    Choice(&'static str, fn() -> Vec<&'static str>),
    /// Fields that another table lists, with their name: "fields of the thing".
    Open(&'static str),
    /// `(value, …)`
    Tuple(&'static [Form]),
    /// `(value, …)`, of one form, at least and at most so many.
    Several(&'static Form, usize, usize),
    /// `[value, …]`
    List(&'static Form),
    /// `{"name": value, …}`, with the kind of its names: "setting".
    Map(&'static str, &'static Form),
    /// One or the other.
    Either(&'static [Form]),
}

/// A value by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlainForm {
    /// `true` or `false`.
    Truth,
    /// A whole number.
    Whole,
    /// A number.
    Number,
    /// A text in quotes.
    Text,
    /// A name that the file gives to something, in quotes.
    Name,
    /// The name of a callback of a program, in quotes.
    Outside,
    /// The name of a shader or of one of its stages, in quotes.
    Shader,
}

/// The fields of a form, as [`fields!`](crate::fields) makes them.
#[derive(Debug, Clone, Copy)]
pub struct Table {
    /// The name in the schema: "ImageFields".
    pub name: &'static str,
    /// The word that may stand before its parentheses, if any.
    pub word: Option<&'static str>,
    /// Lines of documentation. They begin with a noun, up to a colon, comma or full stop.
    pub about: &'static [&'static str],
    /// Its fields.
    pub rows: &'static [Row],
}

/// A field.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Its name.
    pub name: &'static str,
    /// Whether it has to be there.
    pub needed: bool,
    /// Lines of documentation.
    pub about: &'static [&'static str],
    /// The form of its value.
    pub form: Form,
}

/// Words of which one stands in a place.
#[derive(Debug)]
pub struct Words {
    /// The name in the schema: "Size".
    pub name: &'static str,
    /// The name in messages: "a size".
    pub what: &'static str,
    /// Other forms that are allowed in place of a word.
    pub or: &'static [Form],
    /// The words.
    pub all: &'static [Word],
}

/// A word and its parentheses.
#[derive(Debug)]
pub struct Word {
    /// The word.
    pub word: &'static str,
    /// The contents that its parentheses may have.
    pub takes: &'static [WordContents],
    /// Examples of every way to write it; empty if it stands alone.
    pub examples: &'static [&'static str],
    /// The meaning.
    pub about: &'static str,
}

impl Word {
    /// A word with something in parentheses.
    pub(crate) const fn new(
        word: &'static str,
        takes: &'static [WordContents],
        examples: &'static [&'static str],
        about: &'static str,
    ) -> Word {
        Word { word, takes, examples, about }
    }

    /// A word that stands alone.
    pub(crate) const fn alone(word: &'static str, about: &'static str) -> Word {
        Word { word, takes: &[WordContents::Nothing], examples: &[], about }
    }

    /// Every way to write it.
    pub fn written(&self) -> impl Iterator<Item = &'static str> {
        let alone = self.examples.is_empty().then_some(self.word);
        self.examples.iter().copied().chain(alone)
    }
}

/// The contents of the parentheses behind a word.
#[derive(Debug, Clone, Copy)]
pub enum WordContents {
    /// No parentheses, or empty ones.
    Nothing,
    /// Values.
    Values(&'static [Form]),
    /// Fields.
    Fields(fn() -> Table),
}

/// A type that has a table of its fields.
pub trait FieldTable {
    /// The table.
    const TABLE: Table;

    /// The table, for tables that refer to each other.
    #[must_use]
    fn table() -> Table {
        Self::TABLE
    }
}

impl Table {
    /// The noun for one value: "an image".
    #[must_use]
    pub fn noun(&self) -> String {
        let first = self.about.first().map_or("", |line| line.trim());
        let end = first.find([':', '.', ',']).unwrap_or(first.len());
        let mut letters = first[..end].chars();
        letters.next().map_or_else(String::new, |letter| letter.to_lowercase().chain(letters).collect())
    }
}

impl Words {
    /// The word that is written so.
    #[must_use]
    pub fn find(&self, word: &str) -> Option<&Word> {
        self.all.iter().find(|known| known.word == word)
    }

    /// All allowed words, words in [`or`](Words::or) too.
    pub(crate) fn known(&self) -> Vec<&'static str> {
        let mut known: Vec<&'static str> = self.all.iter().map(|word| word.word).collect();
        for or in self.or {
            if let Form::Choice(_, words) = or {
                known.extend(words());
            }
        }
        known
    }

    /// How each is written, in a sentence: "a size is `Output`, … or …".
    #[must_use]
    pub fn forms(&self) -> String {
        let (first, then): (Vec<&Form>, Vec<&Form>) =
            self.or.iter().partition(|form| matches!(form, Form::Whole(..) | Form::Listed(_)));
        let mut all: Vec<String> = first.into_iter().filter_map(Form::briefly).collect();
        all.extend(self.all.iter().flat_map(Word::written).map(|written| format!("`{written}`")));
        all.extend(then.into_iter().filter_map(Form::briefly));
        let last = all.pop().unwrap_or_default();
        match all.is_empty() {
            true => format!("{} is {last}", self.what),
            false => format!("{} is {} or {last}", self.what, all.join(", ")),
        }
    }
}

impl Form {
    /// The name in a list of words; `None` if the list leaves it out.
    fn briefly(&self) -> Option<String> {
        Some(match self {
            Form::Whole(..) => "a number, an expression in quotes".to_owned(),
            Form::Listed(numbers) => numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(", "),
            Form::Reference(what) => format!("the name of {what}"),
            Form::Expression(_) => "an expression in quotes".to_owned(),
            Form::Choice(what, words) => format!("{what}, such as `{}`", words().first().copied().unwrap_or_default()),
            Form::Fields(table) => table().noun(),
            _ => return None,
        })
    }
}

/// The names of choices that have values.
pub(crate) fn names<T>(choices: &[(&'static str, T)]) -> Vec<&'static str> {
    choices.iter().map(|(name, _)| *name).collect()
}
