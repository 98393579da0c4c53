//! Text for people: nothing that came from a file, an argument or a driver reaches a terminal raw.

pub(crate) use framewright_graph::base::amount::bytes;
pub(crate) use framewright_graph::base::escape;

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Several lines of text: as [`escape`], but line breaks stay.
#[must_use]
pub(crate) fn escape_lines(text: &str) -> String {
    text.lines().map(escape).collect::<Vec<_>>().join("\n")
}

/// A path as [`escape`] shows it.
#[must_use]
pub(crate) fn path(path: &Path) -> String {
    escape(&path.to_string_lossy())
}

/// Text as [`escape`] shows it, in a cell of a table in Markdown.
#[must_use]
pub(crate) fn cell(text: &str) -> String {
    let shown = escape(text);
    if shown.contains('|') { shown.replace('\\', "\\\\").replace('|', "\\|") } else { shown }
}

/// A value as indented JSON with a final line break, fit for a terminal.
///
/// # Errors
/// If it has no JSON form.
pub(crate) fn json(value: &impl serde::Serialize) -> serde_json::Result<String> {
    serde_json::to_string_pretty(value).map(|text| json_text(&text) + "\n")
}

/// JSON with everything that a terminal would act on written as JSON's own escapes: the same values, safe to print.
#[must_use]
pub(crate) fn json_text(json: &str) -> String {
    let mut shown = String::with_capacity(json.len());
    for character in json.chars() {
        let mut bytes = [0; 4];
        let alone: &str = character.encode_utf8(&mut bytes);
        if character == '\n' || escape(alone) == alone {
            shown.push(character);
        } else {
            let mut units = [0; 2];
            shown.extend(character.encode_utf16(&mut units).iter().map(|unit| format!("\\u{unit:04x}")));
        }
    }
    shown
}

/// Writes to standard output. A reader that has gone away (`| head`) is no error.
///
/// # Errors
/// Anything else that goes wrong, such as a full disk.
pub(crate) fn print(text: &str) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Writes a note to standard error, unless it was written this way before: what is true of each frame is said of the first.
pub(crate) fn note_once(note: &str) {
    static SAID: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    if SAID.lock().unwrap_or_else(PoisonError::into_inner).insert(note.to_owned()) {
        say(&format!("note: {note}"));
    }
}

/// Writes a line to standard error. A failure can't be reported anywhere, and is ignored.
pub(crate) fn say(text: &str) {
    let mut out = std::io::stderr().lock();
    drop(writeln!(out, "{text}"));
}

/// A count with its noun: `1 pass`, `2 passes`.
#[must_use]
pub(crate) fn count(number: usize, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_acts_on_is_escaped_and_the_rest_is_not() {
        assert_eq!(escape("a\u{1b}[2J\n\t\u{0}\u{7f}\u{9b}b"), "a\\u{1b}[2J\\n\\t\\0\\u{7f}\\u{9b}b");
        assert_eq!(escape("\u{202e}gnp.exe"), "\\u{202e}gnp.exe");
        assert_eq!(escape("Größe 'x' \"y\" \\ 漢"), "Größe 'x' \"y\" \\ 漢");
        assert_eq!(
            json_text("\"a\u{7f}\u{9b}\u{202e}ö漢\u{e0001}\"\n"),
            "\"a\\u007f\\u009b\\u202eö漢\\udb40\\udc01\"\n"
        );
        assert_eq!(escape_lines("one\u{7}\ntwo"), "one\\u{7}\ntwo");
    }
}
