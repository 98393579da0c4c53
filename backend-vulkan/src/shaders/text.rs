//! The text of a stage: its words, its lines, and the files that it includes. SPIR-V says what a stage uses, and the
//! text on which line that stands.

use super::compile::MAX_INCLUDES;
use super::files::{ShaderFiles, SourceFile};
use framewright_graph::base::FilePath;
use framewright_graph::shader::FileLanguage;
use std::collections::BTreeSet;

/// Why a stage can't be used, and the words of its text that show where.
#[derive(Debug)]
pub(super) struct RefusedStage {
    what: String,
    shown_by: Words,
}

/// Words of a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Words {
    None,
    /// One word.
    Whole(String),
    /// Every word with one of these beginnings.
    Beginning(&'static [&'static str]),
    /// The first of these words that the text has.
    First(Vec<String>),
    /// Every word with this ending, whatever the case of its letters.
    Ending(String),
}

impl Words {
    /// Where a stage's file or one that it includes has such a word first, as `FILE:LINE`; its file where none has.
    pub(super) fn place(&self, files: &ShaderFiles, stage: &SourceFile) -> String {
        let found = match self {
            Words::None => None,
            Words::Whole(name) => place(files, stage, |word| word == name),
            Words::Beginning(all) => {
                place(files, stage, |word| all.iter().any(|beginning| word.starts_with(beginning)))
            }
            Words::First(all) => all.iter().find_map(|name| place(files, stage, |word| word == name)),
            Words::Ending(ending) => place(files, stage, |word| word.to_ascii_lowercase().ends_with(ending)),
        };
        found.unwrap_or_else(|| stage.shown.clone())
    }
}

impl From<String> for RefusedStage {
    fn from(what: String) -> RefusedStage {
        RefusedStage { what, shown_by: Words::None }
    }
}

impl RefusedStage {
    /// With the name that the text gives to what is refused.
    pub(super) fn named(name: &str, what: String) -> RefusedStage {
        RefusedStage { what, shown_by: Words::Whole(name.to_owned()) }
    }

    /// With beginnings of the words that are refused.
    pub(super) fn beginning(words: &'static [&'static str], what: String) -> RefusedStage {
        RefusedStage { what, shown_by: Words::Beginning(words) }
    }

    /// With the words that are refused.
    pub(super) fn shown_by(shown_by: Words, what: String) -> RefusedStage {
        RefusedStage { what, shown_by }
    }

    /// As a message with its place: `FILE:LINE: …`, or `FILE: …` where no line shows it.
    pub(super) fn placed(&self, files: &ShaderFiles, stage: &SourceFile) -> String {
        format!("{}: {}", self.shown_by.place(files, stage), self.what)
    }
}

/// The first place, as `FILE:LINE`, where a stage's file or one that it includes has such a word outside comments.
pub(super) fn place(files: &ShaderFiles, stage: &SourceFile, wanted: impl Fn(&str) -> bool) -> Option<String> {
    let line = |found: &SourceFile| {
        let text = without_comments(&found.text);
        let at = text.lines().position(|line| words(line).any(&wanted))?;
        Some(format!("{}:{}", found.shown, at + 1))
    };
    line(stage).or_else(|| included(files, stage).iter().find_map(line))
}

/// The files that a stage's file includes, and those that they include, each once. No more than [`MAX_INCLUDES`] are looked
/// for: the compiler refuses a stage with more.
pub(super) fn included(files: &ShaderFiles, stage: &SourceFile) -> Vec<SourceFile> {
    included_by(stage, |from, name| files.included(from, name).ok().flatten())
}

/// The same with files that `read` finds. A name in a folder is read once, however often it is included.
fn included_by(stage: &SourceFile, mut read: impl FnMut(&FilePath, &str) -> Option<SourceFile>) -> Vec<SourceFile> {
    let (mut looked_for, mut seen) = (BTreeSet::new(), BTreeSet::new());
    let mut all: Vec<SourceFile> = Vec::new();
    let mut looked_at = 0;
    loop {
        let from = match looked_at {
            0 => Some(stage),
            at => all.get(at - 1),
        };
        let Some(from) = from else { return all };
        let path = from.path.clone();
        for name in named_in(from) {
            if looked_for.len() == MAX_INCLUDES {
                return all;
            }
            let shipped = matches!(path, FilePath::Shipped(_));
            if !looked_for.insert((shipped, path.folder().to_owned(), name.clone())) {
                continue;
            }
            all.extend(read(&path, &name).filter(|file| seen.insert(file.path.to_string())));
        }
        looked_at += 1;
    }
}

/// The names in a file's `#include` directives, and the files of the modules that Slang imports.
fn named_in(file: &SourceFile) -> Vec<String> {
    let text = without_comments(&file.text);
    if FileLanguage::of_file(file.path.path()) == Some(FileLanguage::Slang) {
        return included_in(&text).into_iter().chain(imported_in(&text)).collect();
    }
    included_in(&text)
}

/// The files of the modules that a text in Slang imports or takes in. `a.b_c` is `a/b_c.slang` or `a/b-c.slang`.
fn imported_in(text: &str) -> Vec<String> {
    let statements = text.split([';', '\n', '{', '}']).filter_map(|statement| {
        let mut words = statement.split_whitespace().skip_while(|word| ["public", "__exported"].contains(word));
        let imports = ["import", "__import", "__include", "implementing"];
        words.next().filter(|word| imports.contains(word))?;
        words.next().map(str::to_owned)
    });
    let files = statements.flat_map(|named| match named.strip_prefix('"') {
        Some(file) => {
            let file = file.trim_end_matches('"');
            vec![if file.contains('.') { file.to_owned() } else { format!("{file}.slang") }]
        }
        None => {
            let path = named.replace('.', "/");
            let mut files = vec![format!("{path}.slang"), format!("{}.slang", path.replace('_', "-"))];
            files.dedup();
            files
        }
    });
    files.collect()
}

/// The names in the `#include` directives of a text without comments.
fn included_in(text: &str) -> Vec<String> {
    let named = text.lines().filter_map(|line| {
        let directive = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("include")?;
        directive.split(['"', '<', '>']).nth(1).map(str::to_owned)
    });
    named.collect()
}

/// Whether a text says that it is included once at most, outside of all conditions.
pub(super) fn is_once(text: &str) -> bool {
    if !text.contains("once") {
        return false;
    }
    let mut conditions = 0_usize;
    without_comments(text).lines().any(|line| {
        let mut words = line.trim_start().strip_prefix('#').unwrap_or_default().split_whitespace();
        match words.next() {
            Some("if" | "ifdef" | "ifndef") => conditions += 1,
            Some("endif") => conditions = conditions.saturating_sub(1),
            Some("pragma") => return conditions == 0 && words.next() == Some("once") && words.next().is_none(),
            _ => {}
        }
        false
    })
}

/// The words of a text without comments: names, and numbers that begin with a digit.
pub(super) fn words(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|letter: char| letter != '_' && !letter.is_ascii_alphanumeric());
    words.filter(|word| !word.is_empty())
}

/// A text with a blank in place of each comment. Lines keep their numbers.
pub(super) fn without_comments(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut rest = text;
    // One search for both kinds: a search for each would look through all that follows for the kind that comes late.
    let start_of_comment = |text: &str| {
        let mut slashes = text.match_indices('/').map(|(at, _)| at);
        slashes.find(|at| matches!(text.as_bytes().get(at + 1), Some(b'/' | b'*')))
    };
    while let Some(start) = start_of_comment(rest) {
        let (before, comment) = rest.split_at(start);
        kept.extend([before, " "]);
        let (_, inside) = comment.split_at(2);
        let end = match comment.starts_with("//") {
            true => inside.find('\n'),
            false => inside.find("*/").map(|end| end + 2),
        };
        let (inside, behind) = inside.split_at(end.unwrap_or(inside.len()));
        kept.extend(inside.matches('\n'));
        rest = behind;
    }
    kept + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often files are read for a stage with this text, whose files hold `text` each.
    fn reads(stage: String, text: impl Fn(&str) -> String) -> usize {
        let found =
            |name: &str, text: String| SourceFile { path: name.into(), shown: name.to_owned(), text, once: None };
        let mut reads = 0;
        included_by(&found("stage.frag", stage), |_, name| {
            reads += 1;
            Some(found(name, text(name)))
        });
        reads
    }

    #[test]
    fn a_file_is_read_once_however_often_it_is_included() {
        let thousand = |name: &str| format!("#include \"{name}\"\n").repeat(1000);
        assert_eq!(reads(thousand("a.glsl"), |_| thousand("a.glsl")), 1);
        assert_eq!(reads(thousand("a.glsl"), |_| thousand("b.glsl")), 2);
    }

    #[test]
    fn no_more_files_are_read_than_the_compiler_includes() {
        let others =
            |beginning: &str| (0..1000).map(|at| format!("#include \"{beginning}{at}\"\n")).collect::<String>();
        assert_eq!(reads(others("a"), |_| String::new()), MAX_INCLUDES);
        assert_eq!(reads("#include \"a\"".to_owned(), |name| others(name)), MAX_INCLUDES);
    }

    #[test]
    fn a_text_is_included_once_where_it_says_so_outside_of_comments_and_conditions() {
        for once in ["#pragma once", " # pragma  once // really\n", "#version 460\n#if A\n#endif\n#pragma once\n"] {
            assert!(is_once(once), "{once}");
        }
        for not in
            ["// #pragma once", "/*\n#pragma once\n*/", "#pragma once_more", "#if A\n#pragma once\n#endif", "once"]
        {
            assert!(!is_once(not), "{not}");
        }
    }

    #[test]
    fn a_comment_of_several_lines_leaves_the_numbers_of_lines() {
        assert_eq!(without_comments("a /* b\nc */ d // e\nf"), "a  \n d  \nf");
        assert_eq!(without_comments("a /* b\n"), "a  \n");
    }
}
