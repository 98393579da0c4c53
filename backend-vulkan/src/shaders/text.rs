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
    pub(super) what: String,
    shown_by: Words,
    /// What mends it, by the language of the stage.
    mended: Option<Mends>,
}

/// What mends a mistake in a language, of which `None` is GLSL; `None`: nothing that could be told.
pub(super) type Mends = fn(Option<FileLanguage>) -> Option<&'static str>;

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
        RefusedStage { what, shown_by: Words::None, mended: None }
    }
}

impl RefusedStage {
    /// With the name that the text gives to what is refused.
    pub(super) fn named(name: &str, what: String) -> RefusedStage {
        RefusedStage { what, shown_by: Words::Whole(name.to_owned()), mended: None }
    }

    /// With beginnings of the words that are refused.
    pub(super) fn beginning(words: &'static [&'static str], what: String) -> RefusedStage {
        RefusedStage { what, shown_by: Words::Beginning(words), mended: None }
    }

    /// With the words that are refused.
    pub(super) fn shown_by(shown_by: Words, what: String) -> RefusedStage {
        RefusedStage { what, shown_by, mended: None }
    }

    /// With what mends it.
    pub(super) fn mended(self, mends: Mends) -> RefusedStage {
        RefusedStage { mended: Some(mends), ..self }
    }

    /// As a message with its place: `FILE:LINE: …`, or `FILE: …` where no line shows it.
    pub(super) fn placed(&self, files: &ShaderFiles, stage: &SourceFile) -> String {
        let place = self.shown_by.place(files, stage);
        let language = FileLanguage::of_file(stage.path.path());
        match self.mended.and_then(|mends| mends(language)) {
            Some(how) => format!("{place}: {}; {how}", self.what),
            None => format!("{place}: {}", self.what),
        }
    }
}

/// The first place, as `FILE:LINE`, where a stage's file or one that it includes has such a word outside comments. Of SPIR-V it is one of
/// the source, as far as that is told.
pub(super) fn place(files: &ShaderFiles, stage: &SourceFile, wanted: impl Fn(&str) -> bool) -> Option<String> {
    let line = |found: &SourceFile| {
        let text = without_comments(&found.text);
        let at = text.lines().position(|line| words(line).any(&wanted))?;
        Some(format!("{}:{}", found.shown, at + 1))
    };
    line(stage).or_else(|| included(files, stage).iter().find_map(line)).or_else(|| stage.inside.place(&wanted))
}

/// A line that a module tells, as messages show it. A file of the stage's is called as everywhere, whatever the folder where a command
/// compiled it; any other is a file that SPIR-V was compiled of.
pub(super) fn line_of(files: &ShaderFiles, stage: &SourceFile, file: &str, line: u32) -> String {
    let is_it = |known: &SourceFile| known.shown == file || file.ends_with(&format!("/{}", known.path.path()));
    let all = std::iter::once(stage).map(|it| it.shown.clone()).filter(|_| is_it(stage));
    let included = || included(files, stage).iter().find(|it| is_it(it)).map(|it| it.shown.clone());
    match all.into_iter().next().or_else(included) {
        Some(shown) => format!("{shown}:{line}"),
        None => format!("{file}:{line}"),
    }
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
    let text = without_comments(&joined(&file.text, false));
    if FileLanguage::of_file(file.path.path()) == Some(FileLanguage::Slang) {
        let quoted = quoted_imports(&text).into_iter().map(|(_, name)| name);
        return included_in(&text).into_iter().chain(imported_in(&text)).chain(quoted).collect();
    }
    included_in(&text)
}

/// The words of Slang that name a module.
pub(super) const IMPORTS: [&str; 4] = ["import", "__import", "__include", "implementing"];

/// The files of the modules that a text in Slang imports or takes in without quotes. `a.b_c` is `a/b_c.slang` or `a/b-c.slang`.
fn imported_in(text: &str) -> Vec<String> {
    let statements = text.split([';', '\n', '{', '}']).filter_map(|statement| {
        let mut words = statement.split_whitespace().skip_while(|word| ["public", "__exported"].contains(word));
        words.next().filter(|word| IMPORTS.contains(word))?;
        words.next().filter(|named| !named.starts_with('"'))
    });
    let files = statements.flat_map(|named| {
        let path = named.replace('.', "/");
        let mut files = vec![format!("{path}.slang"), format!("{}.slang", path.replace('_', "-"))];
        files.dedup();
        files
    });
    files.collect()
}

/// The files in quotes that a text in Slang imports or takes in, with their lines.
pub(super) fn quoted_imports(text: &str) -> Vec<(usize, String)> {
    let (mut all, mut line, mut counted) = (Vec::new(), 1, 0);
    for (at, _) in text.match_indices('"') {
        line += text[counted..at].matches('\n').count();
        let before = text[counted..at].trim_end();
        counted = at;
        let word = before.rsplit(|letter: char| letter != '_' && !letter.is_ascii_alphanumeric()).next();
        if !word.is_some_and(|word| IMPORTS.contains(&word)) {
            continue;
        }
        let file = text[at + 1..].split(['"', '\n']).next().unwrap_or_default();
        all.push((line, if file.contains('.') { file.to_owned() } else { format!("{file}.slang") }));
    }
    all
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

/// The names of the functions of a text in HLSL, Slang or WGSL: a word behind another one and before `(`, outside of all braces.
pub(super) fn functions(text: &str) -> Vec<String> {
    let code = without_comments(text);
    let is_letter = |letter: char| letter == '_' || letter.is_ascii_alphanumeric();
    let (mut depth, mut functions) = (0_u32, Vec::new());
    // The words since the last other sign.
    let mut before: Vec<&str> = Vec::new();
    let mut rest = &*code;
    while let Some(first) = rest.chars().next() {
        let length =
            if is_letter(first) { rest.find(|it| !is_letter(it)).unwrap_or(rest.len()) } else { first.len_utf8() };
        let (token, behind) = rest.split_at(length);
        rest = behind;
        match first {
            _ if is_letter(first) => before.push(token),
            _ if first.is_whitespace() => {}
            '(' if depth == 0 && before.len() > 1 => functions.extend(before.pop().map(str::to_owned)),
            '{' => depth += 1,
            '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if !is_letter(first) && !first.is_whitespace() {
            before.clear();
            // The type may have its own: `vector<float, 4> main(`.
            before.extend((first == '>').then_some(">"));
        }
    }
    functions
}

/// What a reader of a text takes as literals, in which no comment begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Literals {
    None,
    /// What stands in `"` on one line.
    Strings,
    /// The same with `\"` in it, and to the line's end where none closes it.
    Escaped,
    /// The same, and what stands in `'`.
    WithLetters,
}

/// Where the ends of lines within a comment are put.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CommentLines {
    InPlace,
    /// Behind the line in which the comment ends: a directive goes on behind a comment.
    AtEnd,
}

/// A text with a blank in place of each comment. Lines keep their numbers.
pub(super) fn without_comments(text: &str) -> String {
    without_comments_as(text, Literals::Strings, CommentLines::InPlace)
}

/// The same as one of several readers sees it.
pub(super) fn without_comments_as(text: &str, literals: Literals, lines: CommentLines) -> String {
    let quotes: &[char] = match literals {
        Literals::None => &[],
        Literals::Strings | Literals::Escaped => &['"'],
        Literals::WithLetters => &['"', '\''],
    };
    let mut kept = String::with_capacity(text.len());
    let (mut rest, mut owed) = (text, 0);
    // The ends of lines that are owed come behind the next one.
    let keep = |kept: &mut String, part: &str, owed: &mut usize| match part.find('\n').filter(|_| *owed > 0) {
        Some(end) => {
            kept.push_str(&part[..end]);
            kept.extend(std::iter::repeat_n('\n', std::mem::take(owed)));
            kept.push_str(&part[end..]);
        }
        None => kept.push_str(part),
    };
    while let Some(start) = rest.find(|letter| letter == '/' || quotes.contains(&letter)) {
        let (before, behind) = rest.split_at(start);
        keep(&mut kept, before, &mut owed);
        if !behind.starts_with("//") && !behind.starts_with("/*") {
            let length = if behind.starts_with('/') { 1 } else { literal(behind, literals) };
            let (literal, behind) = behind.split_at(length);
            kept.push_str(literal);
            rest = behind;
            continue;
        }
        kept.push(' ');
        let (_, inside) = behind.split_at(2);
        let end = match behind.starts_with("//") {
            true => inside.find('\n'),
            false => inside.find("*/").map(|end| end + 2),
        };
        let (inside, behind) = inside.split_at(end.unwrap_or(inside.len()));
        let ends = inside.matches('\n');
        match lines {
            CommentLines::InPlace => kept.extend(ends),
            CommentLines::AtEnd => owed += ends.count(),
        }
        rest = behind;
    }
    keep(&mut kept, rest, &mut owed);
    kept.extend(std::iter::repeat_n('\n', owed));
    kept
}

/// The length of the literal with which a text begins; that of its quote alone where it is none.
fn literal(text: &str, literals: Literals) -> usize {
    let line = text.find('\n').map_or(text, |end| &text[..end]);
    let quote = text.as_bytes().first();
    if literals == Literals::Strings {
        return line[1..].find('"').map_or(1, |end| end + 2);
    }
    let mut escaped = false;
    let end = line.bytes().enumerate().skip(1).find(|(_, byte)| {
        let closes = !escaped && Some(byte) == quote;
        escaped = !escaped && *byte == b'\\';
        closes
    });
    end.map_or(line.len(), |(end, _)| end + 1)
}

/// A text whose lines go on where they end with a backslash, or with one and `blanks`. Lines that begin behind keep their numbers.
pub(super) fn joined(text: &str, blanks: bool) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut owed = 0;
    for line in text.split_inclusive('\n') {
        let whole = line.strip_suffix('\n').unwrap_or(line);
        let whole = whole.strip_suffix('\r').unwrap_or(whole);
        let whole = if blanks { whole.trim_end() } else { whole };
        match whole.strip_suffix('\\') {
            Some(begun) => {
                kept.push_str(begun);
                owed += 1;
            }
            None => {
                kept.push_str(line);
                kept.extend(std::iter::repeat_n('\n', std::mem::take(&mut owed)));
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::super::module_lines::ModuleLines;
    use super::*;

    /// How often files are read for a stage with this text, whose files hold `text` each.
    fn reads(stage: String, text: impl Fn(&str) -> String) -> usize {
        let found = |name: &str, text: String| SourceFile {
            path: name.into(),
            shown: name.to_owned(),
            text,
            once: None,
            inside: ModuleLines::default(),
        };
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
        assert_eq!(without_comments("\"/*\" a // \"\n\"//\""), "\"/*\" a  \n\"//\"");
        let at_end = without_comments_as("# /* b\n*/ c\nd", Literals::Strings, CommentLines::AtEnd);
        assert_eq!(at_end, "#   c\n\nd");
        assert_eq!(joined("a\\\nb\nc", false), "ab\n\nc");
    }
}
