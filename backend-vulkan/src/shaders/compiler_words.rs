//! What compilers of HLSL, Slang and WGSL say, with the lines that they speak of.

use super::files::SourceFile;
use super::messages::{bounded, underlined};
use framewright_graph::base::Quote;
use framewright_graph::shader::ShaderMessage;

/// Letters of a line that are shown.
const LONGEST_LINE: usize = 500;

/// A mistake as a compiler tells it.
#[derive(Debug, PartialEq, Eq)]
struct Complaint<'s> {
    file: &'s str,
    line: u32,
    /// Counted from 1.
    column: Option<usize>,
    words: String,
}

/// The complaints in a compiler's words: those with a line. If none has one, the mistakes with the notes behind them, and all that it
/// said if it tells none.
pub(super) fn complaints(said: &str, files: &[&SourceFile]) -> Vec<ShaderMessage> {
    let located: Vec<ShaderMessage> = found(said).iter().filter_map(|it| message(it, files)).collect();
    if !located.is_empty() {
        return bounded(located);
    }
    let mut lines: Vec<&str> = said.lines().map(str::trim_end).filter(|line| !line.is_empty()).collect();
    let mistakes = mistakes(&lines);
    if !mistakes.is_empty() {
        lines = mistakes;
    }
    bounded(lines.into_iter().map(|line| ShaderMessage { text: cut(line), quote: None, limit: None }).collect())
}

/// The lines that tell mistakes without a place, each with the notes right behind it.
fn mistakes<'s>(lines: &[&'s str]) -> Vec<&'s str> {
    let begins = |line: &str, words: &[&str]| words.iter().any(|word| line.starts_with(word));
    let mut is_told = false;
    let told = lines.iter().filter(|line| {
        is_told = begins(line, &["error", "fatal error"]) || is_told && begins(line, &["note"]);
        is_told
    });
    told.copied().collect()
}

/// What slangc says where a library of its own isn't there, to which it hands the SPIR-V for optimisation.
pub(super) fn lacks_library(said: &str) -> Option<&str> {
    said.lines().find(|line| line.starts_with("error") && line.contains("failed to load downstream compiler"))
}

/// A line that a compiler said, without what follows its first letters if it has very many.
pub(super) fn cut(line: &str) -> String {
    match line.char_indices().nth(LONGEST_LINE) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line.to_owned(),
    }
}

fn message(complaint: &Complaint<'_>, files: &[&SourceFile]) -> Option<ShaderMessage> {
    let Complaint { file, line: number, column, words } = complaint;
    let words = cut(words);
    let is = |known: &&&SourceFile| {
        let file = file.strip_prefix("./").unwrap_or(file);
        known.shown == file || known.path.path() == file || known.shown.strip_prefix("./") == Some(file)
    };
    let file = files.iter().find(is)?;
    let line = file.text.lines().nth(number.checked_sub(1)? as usize)?;
    let place = match column {
        Some(column) => format!("{}:{number}:{column}", file.shown),
        None => format!("{}:{number}", file.shown),
    };
    let at_column = column.and_then(|column| word_at(line, column.checked_sub(1)?));
    let quote = Quote {
        file: file.shown.clone(),
        line: *number,
        underlined: at_column.unwrap_or_else(|| underlined(line, &words)),
        text: line.to_owned(),
        remark: words.clone(),
    };
    Some(ShaderMessage { text: format!("{place}: error: {words}"), quote: Some(quote), limit: None })
}

/// The word that begins at, or goes over, a place in a line; one letter where no word does.
fn word_at(line: &str, at: usize) -> Option<std::ops::Range<usize>> {
    let first = line.get(at..)?.chars().next()?;
    let word = |letter: char| letter == '_' || letter.is_alphanumeric();
    if !word(first) {
        return Some(at..at + first.len_utf8());
    }
    let rest = line[at..].find(|letter| !word(letter)).map_or(line.len(), |end| at + end);
    Some(at..rest)
}

/// All mistakes that stand in what a compiler said.
fn found(said: &str) -> Vec<Complaint<'_>> {
    let mut all = Vec::new();
    // `error: WORDS` with the place in one of the next lines: rustc's way, which naga and newer slangc have.
    let mut open: Option<String> = None;
    for line in said.lines() {
        let trimmed = line.trim();
        let arrow = trimmed.strip_prefix("-->").or_else(|| trimmed.strip_prefix("┌─"));
        if let (Some(place), Some(words)) = (arrow, &open) {
            if let Some((file, line, column)) = place_of(place.trim()) {
                all.push(Complaint { file, line, column, words: words.clone() });
                open = None;
            }
            continue;
        }
        match on_one_line(trimmed) {
            Some(complaint) => all.push(complaint),
            None if trimmed.starts_with("error") => {
                open = trimmed.split_once(": ").map(|(_, words)| words.to_owned());
            }
            // The place of another message is none of the mistake's.
            None if trimmed.starts_with("warning") || trimmed.starts_with("note") => open = None,
            None => {}
        }
    }
    all
}

/// `FILE:LINE:COLUMN: error: WORDS`, `FILE(LINE): error NUMBER: WORDS`, or `ERROR: FILE:LINE: WORDS`.
fn on_one_line(line: &str) -> Option<Complaint<'_>> {
    if let Some(rest) = line.strip_prefix("ERROR: ") {
        let ends = rest.match_indices(": ").map(|(at, _)| at);
        let (place, at) = ends.into_iter().find_map(|at| Some((place_of(&rest[..at])?, at)))?;
        let (file, line, column) = place;
        return Some(Complaint { file, line, column, words: rest[at + 2..].to_owned() });
    }
    for mark in [": error", ": fatal error"] {
        let Some((place, words)) = line.split_once(mark) else { continue };
        let Some((file, line, column)) = place_of(place) else { continue };
        let words = words.split_once(": ").map_or(words, |(_, words)| words);
        return Some(Complaint { file, line, column, words: words.to_owned() });
    }
    None
}

/// A place: `FILE:LINE`, `FILE:LINE:COLUMN`, `FILE(LINE)` or `FILE(LINE,COLUMN)`.
fn place_of(text: &str) -> Option<(&str, u32, Option<usize>)> {
    if let Some((file, numbers)) = text.strip_suffix(')').and_then(|text| text.rsplit_once('(')) {
        let (line, column) = numbers.split_once(',').map_or((numbers, None), |(line, column)| (line, Some(column)));
        return Some((file, line.trim().parse().ok()?, column.and_then(|it| it.trim().parse().ok())));
    }
    let (rest, last) = text.rsplit_once(':')?;
    let last: u32 = last.parse().ok()?;
    match rest.rsplit_once(':').and_then(|(file, line)| Some((file, line.parse().ok()?))) {
        Some((file, line)) => Some((file, line, Some(last as usize))),
        None => Some((rest, last, None)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_compilers_way_to_tell_a_place_is_known() {
        let told = |said: &str| {
            let found = found(said);
            let [Complaint { file, line, column, words }] = &found[..] else { panic!("{said}: {found:?}") };
            format!("{file}|{line}|{column:?}|{words}")
        };
        for (said, expected) in [
            // DXC
            (
                "a/post.hlsl:4:9: error: use of undeclared identifier 'x'\n    x;\n    ^",
                "a/post.hlsl|4|Some(9)|use of undeclared identifier 'x'",
            ),
            (
                "post.hlsl:1:10: fatal error: 'no.hlsli' file not found",
                "post.hlsl|1|Some(10)|'no.hlsli' file not found",
            ),
            // glslang
            (
                "post.hlsl\nERROR: post.hlsl:4: 'x' : unknown variable \nERROR: 1 compilation errors.",
                "post.hlsl|4|None|'x' : unknown variable",
            ),
            // slangc before and after 2025
            (
                "post.slang(4): error 30015: undefined identifier 'x'.\n    x\n    ^",
                "post.slang|4|None|undefined identifier 'x'.",
            ),
            (
                "error[E30015]: undefined identifier\n --> post.slang:4:12\n  |",
                "post.slang|4|Some(12)|undefined identifier",
            ),
            // naga
            (
                "error: no definition in scope for identifier: `x`\n  ┌─ post.wgsl:4:12\n  │",
                "post.wgsl|4|Some(12)|no definition in scope for identifier: `x`",
            ),
            ("C:\\a b\\post.hlsl(4,9): error X3000: what", "C:\\a b\\post.hlsl|4|Some(9)|what"),
        ] {
            assert_eq!(told(said), expected, "{said}");
        }
        let placed_warning = "error[E1]: what\nwarning[E2]: else\n --> post.slang:4:12\n";
        assert_eq!(found(placed_warning), []);
        assert_eq!(found("warning: x\nERROR: 1 compilation errors. No code generated.\nnote: a:1:2: what"), []);
    }

    #[test]
    fn mistakes_without_a_place_are_told_without_the_warnings_before_them() {
        let warning =
            "warning[E39029]: D3D register without Vulkan binding or shift\n --> lens.hlsl:2:28\n  |\n--'\n".repeat(30);
        let error = "error[E00100]: failed to load downstream compiler 'spirv-opt'";
        let said = format!("{warning}{error}\nnote[E99996]: failed to load dynamic library 'pthread'\n{warning}");
        let told: Vec<String> = complaints(&said, &[]).into_iter().map(|it| it.text).collect();
        assert_eq!(told, [error, "note[E99996]: failed to load dynamic library 'pthread'"]);
        assert_eq!(lacks_library(&said), Some(error));
        assert_eq!(lacks_library(&warning), None);
        assert_eq!(complaints("what\n\nelse\n", &[]).len(), 2);
    }

    #[test]
    fn a_long_line_is_cut() {
        assert_eq!(cut("é x"), "é x");
        assert_eq!(cut(&"é".repeat(501)), format!("{}…", "é".repeat(500)));
    }

    #[test]
    fn a_column_underlines_its_word() {
        assert_eq!(word_at("  color = ab + b;", 10), Some(10..12));
        assert_eq!(word_at("a+b", 1), Some(1..2));
        assert_eq!((word_at("é", 1), word_at("a", 7)), (None, None));
    }
}
