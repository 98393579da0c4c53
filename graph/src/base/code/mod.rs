//! The stable codes of mistakes: one for each rule, with words that explain the rule.
//!
//! A code never changes its meaning, and a code that isn't given any more is never given to another rule: people search for
//! codes, and programs tell mistakes apart by them. A new rule takes the next free number of its room.

use std::fmt;

/// One room of codes: a title, and its codes in rising order. The first line of a constant's documentation is the title of its
/// rule, and the others explain the rule.
macro_rules! room {
    ($title:literal; $($(#[doc = $line:literal])+ $name:ident = $number:literal,)+) => {
        use super::{Code, Room, Row};

        impl Code {
            $($(#[doc = $line])+ pub const $name: Code = Code($number);)+
        }

        pub(super) const ROOM: Room = Room {
            title: $title,
            rows: &[$(Row { code: Code::$name, text: concat!($($line, "\n"),+) },)+],
        };
    };
}

mod budgets;
mod command;
mod contents;
mod devices;
mod expressions;
mod files;
mod frames;
mod images;
mod machine;
mod names;
mod passes;
mod reading;
mod scenes;
mod settings;
mod shaders;
mod views;

/// All rooms, in the order of their numbers.
const ROOMS: [Room; 16] = [
    reading::ROOM,
    names::ROOM,
    expressions::ROOM,
    settings::ROOM,
    files::ROOM,
    images::ROOM,
    passes::ROOM,
    shaders::ROOM,
    contents::ROOM,
    views::ROOM,
    devices::ROOM,
    frames::ROOM,
    machine::ROOM,
    scenes::ROOM,
    budgets::ROOM,
    command::ROOM,
];

/// The stable code of a mistake, which is shown as `E0207`. There is one for each rule, whatever the sentence is that says how the
/// rule is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(u16);

/// Codes of one subject.
#[derive(Debug, Clone, Copy)]
pub struct Room {
    /// The subject.
    pub title: &'static str,
    rows: &'static [Row],
}

#[derive(Debug, Clone, Copy)]
struct Row {
    code: Code,
    /// The title, an empty line, and the explanation, each line with a space before it.
    text: &'static str,
}

impl Room {
    /// All rooms, in the order of their numbers.
    #[must_use]
    pub const fn all() -> &'static [Room] {
        &ROOMS
    }

    /// Its codes, in the order of their numbers.
    pub fn codes(&self) -> impl Iterator<Item = Code> + use<> {
        self.rows.iter().map(|row| row.code)
    }
}

impl Code {
    /// The code that is shown like this: `E0207`.
    #[must_use]
    pub fn find(shown: &str) -> Option<Code> {
        Code::all().find(|code| code.to_string() == shown)
    }

    /// All codes, in the order of their numbers.
    pub fn all() -> impl Iterator<Item = Code> {
        ROOMS.iter().flat_map(Room::codes)
    }

    /// Its rule in a few words.
    #[must_use]
    pub fn title(self) -> &'static str {
        self.lines().next().unwrap_or_default()
    }

    /// What the rule is, why it is one, and how a mistake is mended: Markdown, in lines.
    #[must_use]
    pub fn explanation(self) -> String {
        self.lines().skip(2).collect::<Vec<_>>().join("\n")
    }

    fn lines(self) -> impl Iterator<Item = &'static str> {
        let row = ROOMS.iter().flat_map(|room| room.rows).find(|row| row.code == self);
        row.map_or("", |row| row.text).lines().map(|line| line.strip_prefix(' ').unwrap_or(line))
    }
}

impl fmt::Display for Code {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "E{:04}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_is_given_once_and_rises_within_the_hundred_of_its_room() {
        for (room, hundred) in ROOMS.iter().zip(1..) {
            let numbers: Vec<u16> = room.codes().map(|code| code.0).collect();
            assert!(numbers.is_sorted_by(|one, next| one < next), "{}: {numbers:?}", room.title);
            assert!(numbers.iter().all(|number| number / 100 == hundred), "{}: {numbers:?}", room.title);
        }
    }

    #[test]
    fn each_code_has_a_title_and_an_explanation_of_one_to_eight_lines() {
        for code in Code::all() {
            let (title, explanation) = (code.title(), code.explanation());
            assert!(title.ends_with('.') && title.len() < 100, "{code}: {title}");
            assert!((1..=8).contains(&explanation.lines().count()), "{code}: {explanation}");
            assert_eq!(code.lines().nth(1), Some(""), "{code}: a line is empty below the title");
        }
    }

    #[test]
    fn a_code_is_found_as_it_is_shown() {
        assert!(Code::all().all(|code| Code::find(&code.to_string()) == Some(code)));
        assert_eq!(Code::UNKNOWN_IMAGE.to_string(), "E0207");
        assert_eq!(Code::find("E0000"), None);
    }
}
