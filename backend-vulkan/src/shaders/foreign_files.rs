//! Files that a compiler would open by itself: those that a shader includes and that aren't among its own. The shader may be a
//! stranger's, and the file the user's, so no command is run for such a shader.
//!
//! Compilers don't agree on where comments, strings and lines end. A text is read in each of these ways, and what one of them includes
//! counts.

use super::files::{ShaderFiles, SourceFile};
use super::messages::located;
use super::text::{CommentLines, IMPORTS, Literals, joined, quoted_imports, without_comments_as, words};
use framewright_graph::base::FilePath;
use framewright_graph::shader::{FileLanguage, ShaderProblem};
use std::collections::{BTreeSet, HashMap, HashSet};

/// Names that ask for files, or give them other names, elsewhere than in a directive.
const ASKING: [&str; 4] = ["include_alias", "__has_include", "__has_include_next", "__has_embed"];

/// What stands before the `"` of a string whose end has other rules.
const RAW: [&str; 5] = ["R", "LR", "uR", "UR", "u8R"];

/// Something in a text that asks for a file.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Asked {
    /// For the file of this name.
    Named(String),
    /// In a way that isn't followed: in words.
    Otherwise(String),
}

/// Refuses a shader that asks for other files than those that were found for it.
///
/// # Errors
/// The lines that do so.
pub(super) fn refuse_foreign(
    files: &ShaderFiles,
    source: &SourceFile,
    included: &[SourceFile],
) -> Result<(), ShaderProblem> {
    let all: Vec<&SourceFile> = std::iter::once(source).chain(included).collect();
    let known: HashSet<&FilePath> = all.iter().map(|file| &file.path).collect();
    let mut refused = Vec::new();
    for file in &all {
        let mut looked_for = HashMap::new();
        for (line, asked) in asked(file) {
            let words = match asked {
                Asked::Otherwise(words) => Some(words),
                Asked::Named(name) => {
                    let found = looked_for.entry(name.clone()).or_insert_with(|| files.included(&file.path, &name));
                    match found {
                        Ok(Some(found)) if known.contains(&found.path) => None,
                        Ok(Some(_)) => Some(format!("'{name}' : the shader includes too many files")),
                        Ok(None) => {
                            let places = files.places(&file.path).join(", ");
                            Some(format!("'{name}' : there is no such file; looked for it in {places}"))
                        }
                        Err(no) if no.of_machine => return Err(ShaderProblem::Machine { what: no.what.clone() }),
                        Err(no) => Some(format!("'{name}' : {}", no.what)),
                    }
                }
            };
            refused.extend(words.map(|words| format!("{}:{line}: error: {words}", file.shown)));
        }
    }
    if refused.is_empty() {
        return Ok(());
    }
    let text = |name: &str| all.iter().find(|file| file.shown == name).map(|file| file.text.as_str());
    Err(ShaderProblem::DoesNotCompile { messages: located(refused, text) })
}

/// All that a file asks for in any reading, with its lines.
fn asked(file: &SourceFile) -> BTreeSet<(usize, Asked)> {
    let language = FileLanguage::of_file(file.path.path());
    let text = file.text.replace("\r\n", "\n");
    let mut all = BTreeSet::new();
    for (at, line) in text.split('\n').enumerate() {
        if line.contains('\r') {
            all.insert((at + 1, Asked::Otherwise("a line ends with a carriage return alone".to_owned())));
        }
        if line.contains("??=") || line.trim_end().ends_with("??/") {
            all.insert((at + 1, Asked::Otherwise("trigraphs aren't taken".to_owned())));
        }
    }
    let mut texts = vec![text.clone()];
    if text.contains('\\') {
        texts.extend([false, true].map(|blanks| joined(&text, blanks)));
    }
    for text in &texts {
        for literals in [Literals::None, Literals::Strings, Literals::Escaped, Literals::WithLetters] {
            for lines in [CommentLines::InPlace, CommentLines::AtEnd] {
                let code = without_comments_as(text, literals, lines);
                in_code(&code, language, &mut all);
            }
        }
    }
    all
}

/// What a text without comments asks for.
fn in_code(code: &str, language: Option<FileLanguage>, all: &mut BTreeSet<(usize, Asked)>) {
    let slang = language == Some(FileLanguage::Slang);
    for (at, line) in code.lines().enumerate() {
        let mut add = |asked: Asked| all.insert((at + 1, asked));
        if let Some(asked) = in_directive(line, language) {
            add(asked);
        }
        if let Some(word) = words(line).find(|word| ASKING.contains(word)) {
            add(Asked::Otherwise(format!("'{word}' : this isn't taken of shaders that a command compiles")));
        }
        for (quote, _) in line.match_indices('"') {
            let before = words_end(&line[..quote]);
            if RAW.contains(&before) {
                add(Asked::Otherwise("raw strings aren't taken".to_owned()));
            }
            let inside = line[quote + 1..].split('"').next().unwrap_or_default();
            let named = is_include(line) || IMPORTS.contains(&words_end(line[..quote].trim_end()));
            if slang && leads_out(inside) && !named {
                // A macro may make an `import` of it.
                add(Asked::Named(inside.to_owned()));
            }
        }
        if slang && makes_strings(line) {
            add(Asked::Otherwise(
                "a macro that makes strings (`#name`) isn't taken in Slang: it may name files".to_owned(),
            ));
        }
    }
    if slang {
        all.extend(quoted_imports(code).into_iter().map(|(line, name)| (line, Asked::Named(name))));
    }
}

/// What stands behind the `#` of a directive.
fn directive(line: &str) -> Option<&str> {
    let line = line.trim_start();
    line.strip_prefix('#').or_else(|| line.strip_prefix("%:")).map(str::trim_start)
}

fn is_include(line: &str) -> bool {
    directive(line).is_some_and(|it| it.starts_with("include"))
}

fn in_directive(line: &str, language: Option<FileLanguage>) -> Option<Asked> {
    let directive = directive(line)?;
    let name = words(directive).next().filter(|name| directive.starts_with(*name))?;
    let includes = ["include", "include_next", "__include_macros"].contains(&name);
    if !(includes || name == "import" && language == Some(FileLanguage::Hlsl)) {
        return None;
    }
    let rest = directive[name.len()..].trim_start();
    let literal = match rest.strip_prefix('<') {
        Some(rest) => rest.split_once('>'),
        None => rest.strip_prefix('"').and_then(|rest| rest.split_once('"')),
    };
    Some(match literal {
        Some((name, _)) => Asked::Named(name.to_owned()),
        None => Asked::Otherwise(
            "an include must name its file in quotes: names that macros make up aren't found".to_owned(),
        ),
    })
}

/// The word at the end of a text.
fn words_end(text: &str) -> &str {
    text.rsplit(|letter: char| letter != '_' && !letter.is_ascii_alphanumeric()).next().unwrap_or_default()
}

/// Whether a name may lead out of the folder where a compiler runs.
fn leads_out(name: &str) -> bool {
    let numbered = |rest: &str| rest.starts_with(['x', 'u', 'U']) || rest.starts_with(|it: char| it.is_ascii_digit());
    name.starts_with(['/', '\\'])
        || name.get(1..).is_some_and(|rest| rest.starts_with(":/") || rest.starts_with(":\\"))
        || name.split(['/', '\\']).any(|part| part == "..")
        || name.match_indices('\\').any(|(at, _)| numbered(&name[at + 1..]))
}

/// Whether a line defines a macro that puts `"` around what it is given.
fn makes_strings(line: &str) -> bool {
    let Some(defined) = directive(line).and_then(|it| it.strip_prefix("define")) else { return false };
    let single = defined.replace("##", " ").replace("%:%:", " ");
    single.contains('#') || single.contains("%:")
}

#[cfg(test)]
mod tests {
    use super::super::module_lines::ModuleLines;
    use super::*;

    fn lines(name: &str, text: &str) -> Vec<usize> {
        let inside = ModuleLines::default();
        let file = SourceFile { path: name.into(), shown: name.to_owned(), text: text.to_owned(), once: None, inside };
        let lines: BTreeSet<usize> = asked(&file).into_iter().map(|(line, _)| line).collect();
        lines.into_iter().collect()
    }

    #[test]
    fn all_ways_to_ask_for_a_file_are_seen() {
        for text in [
            "\n#include \"/etc/passwd\"",
            "\n # include <x>",
            "\n#include F",
            "\n#/* a */include/*b*/\"x\"",
            "\n# /*\n*/ include \"x\"",
            "\n#inc\\\nlude \"x\"",
            "\n#inc\\ \nlude \"x\"",
            "\"/*\"\n#include \"x\"\n\"*/\"",
            "'\"' // \"\n#include \"x\"",
            "\"\\\"/*\"\n#include \"x\"",
            "// \\ \n#include \"x\"",
            "\n%:include \"x\"",
            "\n#import \"x\"",
            "\n#include_next \"x\"",
            "\n#if __has_include(\"x\")",
            "\nR\"(\" /* )\"",
            "#if 0\n#include \"x\"",
            "\nint a; // \r#include \"x\"",
        ] {
            assert_eq!(lines("a.hlsl", text), [2], "{text}");
        }
        for text in [
            "\nimport \"x\";",
            "\nimport\"x\";",
            "\n__include \"x\";",
            "\n#define F \"/etc/passwd\"",
            "\n#define F \"a/../../x\"",
            "\n#define F \"\\x2fetc\"",
            "\n#define F(x) #x",
        ] {
            assert_eq!(lines("a.slang", text), [2], "{text}");
        }
    }

    #[test]
    fn what_asks_for_no_file_is_left_alone() {
        for text in [
            "// #include \"x\"\n",
            "/*\n#include \"x\"\n*/",
            "// don't\n/* \"\n#include \"x\"\n*/",
            "import light; import a.b;",
            "[shader(\"fragment\")] void main() {}",
            "#define JOINED(a, b) a##b",
            "#includes",
            "float a = b / c; // what??",
        ] {
            assert_eq!(lines("a.slang", text), [0; 0], "{text}");
            assert_eq!(lines("a.hlsl", text), [0; 0], "{text}");
        }
    }
}
