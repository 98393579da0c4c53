//! Notes of a Plan for people: many of one kind are shown as a few and a count.

use crate::system::text;
use framewright_graph::plan::{Note, NoteKind, Stage};
use std::collections::HashMap;

/// Up to this many notes of one kind are all shown; of more only the first [`FEW`].
const MANY: usize = 20;
const FEW: usize = 3;

/// The notes that `check` shows. It leaves out why scopes are separate (`inspect` shows that), and what shipped fragments
/// leave out by themselves.
pub(crate) fn worth_showing(notes: &[Note]) -> impl Iterator<Item = &Note> {
    notes.iter().filter(|note| note.stage() != Stage::Scope && !note.is_of_shipped_fragment())
}

/// One line for each note, in their order; of many of one kind only for the first few, and how many more there are.
pub(crate) fn lines<'n>(notes: impl Iterator<Item = &'n Note>) -> Vec<String> {
    let notes: Vec<&Note> = notes.collect();
    let mut counts: HashMap<NoteKind, (usize, usize)> = HashMap::new();
    for note in &notes {
        counts.entry(note.kind).or_default().0 += 1;
    }
    let mut lines = Vec::new();
    for note in &notes {
        let Some((count, seen)) = counts.get_mut(&note.kind) else { continue };
        *seen += 1;
        if *count <= MANY || *seen <= FEW {
            lines.push(shown(note));
        } else if *seen == FEW + 1 {
            let more = *count - FEW;
            lines.push(format!("note: {more} more like `{}` (`--format json` has all)", text::escape(&note.subject)));
        }
    }
    lines
}

/// A note in one line.
fn shown(note: &Note) -> String {
    let at = note.at.as_ref().map_or_else(String::new, |place| format!(" ({})", text::escape(&place.to_string())));
    format!("note: `{}`: {}{at}", text::escape(&note.subject), text::escape(&note.text))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn note(kind: NoteKind, subject: &str, text: &str) -> Note {
        Note { kind, subject: subject.into(), text: text.to_owned(), at: None }
    }

    #[test]
    fn of_many_notes_of_one_kind_the_first_few_are_shown_and_a_count_and_of_few_all() {
        let mut notes: Vec<Note> =
            (0..MANY).map(|at| note(NoteKind::Unneeded, &format!("p{at}"), "does not run")).collect();
        notes.insert(1, note(NoteKind::Off, "other", "is off: `x` = false"));
        assert_eq!(lines(notes.iter()).len(), MANY + 1);
        notes.push(note(NoteKind::Unneeded, "last", "does not run"));
        let expected = [
            "note: `p0`: does not run",
            "note: `other`: is off: `x` = false",
            "note: `p1`: does not run",
            "note: `p2`: does not run",
            "note: 18 more like `p3` (`--format json` has all)",
        ];
        assert_eq!(lines(notes.iter()), expected);
        let saved = serde_json::to_string(&notes).expect("JSON");
        let saved: Vec<Note> = serde_json::from_str(&saved).expect("notes");
        assert_eq!(lines(saved.iter()), expected, "a saved Plan knows what belongs together");
    }
}
