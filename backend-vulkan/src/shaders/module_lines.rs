//! On which lines of its source a module does what: as it tells debuggers.
//!
//! A module may hold the texts that it was compiled of, and say on which line of which file each instruction stands. Both are a
//! stranger's words: they are shown, and no file is looked for by them. See `module_words` for the ways to tell them.

use super::module::IndexedModule;
use super::text::{without_comments, words};
use crate::base::named;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op};
use std::collections::{BTreeMap, HashMap};

/// Letters of the name of a file that are shown.
const LONGEST_NAME: usize = 200;

/// Letters of the name of something that are kept, and bytes of all that is kept of instructions: a name may be as long as it likes, and
/// stand as often.
const LONGEST_WORD: usize = 64;
const MOST_BYTES: usize = 4 << 20;

/// Files whose lines are kept.
const MOST_FILES: usize = 4096;

/// Lines by file: what stands there, as words.
#[derive(Debug, Default)]
pub(super) struct ModuleLines {
    files: Vec<(String, BTreeMap<u32, String>)>,
    numbers: HashMap<String, usize>,
}

impl ModuleLines {
    /// The lines of a module, and of the texts that it holds, by the names of their files.
    pub(super) fn of(module: &Module, texts: Vec<(String, String)>) -> ModuleLines {
        let mut lines = ModuleLines::default();
        for (file, text) in texts {
            let own = lines.file(&file);
            let (mut at, mut number) = (own, 0_u32);
            for line in without_comments(&text).lines() {
                number = number.saturating_add(1);
                // The next line has this number, and stands in this file.
                if let Some((next, said)) = line_directive(line) {
                    number = next.saturating_sub(1);
                    at = match said {
                        SaidFile::Same => at,
                        SaidFile::Named(name) => lines.file(name),
                        SaidFile::Number(0) => own,
                        SaidFile::Number(_) => None,
                    };
                    continue;
                }
                if let Some(at) = at.filter(|_| !line.trim().is_empty()) {
                    lines.files[at].1.insert(number, line.to_owned());
                }
            }
        }
        lines.instructions(module);
        lines
    }

    /// The first line with such a word, as `FILE:LINE`.
    pub(super) fn place(&self, wanted: impl Fn(&str) -> bool) -> Option<String> {
        let line =
            |lines: &BTreeMap<u32, String>| lines.iter().find(|(_, text)| words(text).any(&wanted)).map(|it| *it.0);
        self.files.iter().find_map(|(file, lines)| Some(format!("{file}:{}", line(lines)?)))
    }

    /// The number of a file; `None`: there are too many.
    fn file(&mut self, name: &str) -> Option<usize> {
        let name = shown(name);
        if let Some(known) = self.numbers.get(name) {
            return Some(*known);
        }
        let number = self.files.len();
        if number == MOST_FILES {
            return None;
        }
        self.files.push((name.to_owned(), BTreeMap::new()));
        self.numbers.insert(name.to_owned(), number);
        Some(number)
    }

    /// Adds what instructions name and do on their lines. A line whose text is there is known already.
    fn instructions(&mut self, module: &Module) {
        let strings = module.debug_string_source.iter().filter(|it| it.class.opcode == Op::String);
        let strings = strings.filter_map(|it| match (it.result_id, it.operands.first()) {
            (Some(id), Some(Operand::LiteralString(text))) => Some((id, text.as_str())),
            _ => None,
        });
        let strings: HashMap<u32, &str> = strings.collect();
        if strings.is_empty() {
            return;
        }
        let with_text = self.files.len();
        let indexed = IndexedModule::new(module);
        let mut bytes = 0;
        for function in &module.functions {
            let mut at: Option<(usize, u32)> = None;
            for it in function.blocks.iter().flat_map(|block| &block.instructions) {
                match (it.class.opcode, &it.operands[..]) {
                    (Op::Line, [Operand::IdRef(file), Operand::LiteralBit32(line), ..]) => {
                        let file = strings.get(file).and_then(|file| self.file(file));
                        at = file.filter(|file| *file >= with_text).map(|file| (file, *line));
                    }
                    (Op::NoLine, _) => at = None,
                    _ => {
                        let Some((file, line)) = at.filter(|_| bytes < MOST_BYTES) else { continue };
                        let text = self.files[file].1.entry(line).or_default();
                        let before = text.len();
                        add_words(&indexed, it, text);
                        bytes += text.len() - before + size_of::<String>();
                    }
                }
            }
        }
    }
}

/// The beginning of a file's name, as it is shown.
fn shown(name: &str) -> &str {
    name.char_indices().nth(LONGEST_NAME).map_or(name, |(end, _)| &name[..end])
}

/// Which file a `#line` says that the lines behind it stand in.
enum SaidFile<'t> {
    Same,
    Named(&'t str),
    /// GLSL counts texts: the first, 0, is the file's own. The names of others aren't told.
    Number(u32),
}

/// What `#line NUMBER "FILE"` says, or `# NUMBER "FILE"` of a preprocessor in C.
fn line_directive(line: &str) -> Option<(u32, SaidFile<'_>)> {
    let said = line.trim_start().strip_prefix('#')?.trim_start();
    let said = said.strip_prefix("line").unwrap_or(said).trim_start();
    let (number, file) = said.split_at(said.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(said.len()));
    let (number, file) = (number.parse().ok()?, file.trim());
    let named = file.strip_prefix('"').map(|rest| rest.split_once('"').map_or(rest, |(name, _)| name));
    let counted = || file.parse().map_or(SaidFile::Same, SaidFile::Number);
    Some((number, named.map_or_else(counted, SaidFile::Named)))
}

/// What an instruction names and does, in words of shaders.
fn add_words(module: &IndexedModule<'_>, it: &Instruction, text: &mut String) {
    for id in it.operands.iter().filter_map(Operand::id_ref_any) {
        let built_in = module.decoration(id, Decoration::BuiltIn).flatten();
        if let Some(Operand::BuiltIn(built_in)) = built_in {
            *text += &format!(" gl_{}", built_in_name(*built_in));
        }
        let name = module.name(id);
        if !name.is_empty() {
            *text += " ";
            text.extend(name.chars().take(LONGEST_WORD));
        }
    }
    let opcode = it.class.opcode;
    let does = match opcode {
        Op::Kill | Op::TerminateInvocation | Op::DemoteToHelperInvocation => " discard",
        Op::ImageGather | Op::ImageDrefGather => " textureGather",
        _ if named(opcode).starts_with("GroupNonUniform") => " subgroup",
        _ if named(opcode).starts_with("Atomic") => " atomic",
        _ => "",
    };
    *text += does;
}

/// The name of a built-in variable in GLSL, behind `gl_`.
fn built_in_name(built_in: BuiltIn) -> String {
    match built_in {
        BuiltIn::SampleId => "SampleID".to_owned(),
        BuiltIn::PrimitiveId => "PrimitiveID".to_owned(),
        other => named(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_counted_as_they_count_themselves() {
        let text = "// before\n#line 1\n// discard\nvoid main() {\n    discard; }\n#line 70\nfar\n";
        let lines = ModuleLines::of(&Module::new(), vec![("a/b.frag".to_owned(), text.to_owned())]);
        let place = |wanted: &str| lines.place(|word| word == wanted);
        assert_eq!(place("discard").as_deref(), Some("a/b.frag:3"));
        assert_eq!(place("far").as_deref(), Some("a/b.frag:70"));
        assert_eq!(place("near"), None);
    }
    /// DO-1: lines of another file are that file's.
    #[test]
    fn lines_behind_the_name_of_another_file_stand_in_that_one() {
        let text = "own\n#line 12 \"inc/cut.hlsl\"\ndiscard\n\nlast\n#line 3\nhere\n# 2 \"a.hlsl\" 2\nback\n\
            #line 5 1\nunknown\n#line 9 0\nagain\n";
        let lines = ModuleLines::of(&Module::new(), vec![("a.hlsl".to_owned(), text.to_owned())]);
        for (word, expected) in [
            ("own", Some("a.hlsl:1")),
            ("discard", Some("inc/cut.hlsl:12")),
            ("last", Some("inc/cut.hlsl:14")),
            ("here", Some("inc/cut.hlsl:3")),
            ("back", Some("a.hlsl:2")),
            ("unknown", None),
            ("again", Some("a.hlsl:9")),
        ] {
            assert_eq!(lines.place(|it| it == word).as_deref(), expected, "{word}");
        }
    }

    /// DO-4: a module may name as many files as it likes.
    #[test]
    fn no_more_files_than_a_limit_are_kept() {
        let texts = (0..MOST_FILES + 9).map(|at| (format!("{at}.frag"), "discard\n".repeat(3)));
        let lines = ModuleLines::of(&Module::new(), texts.collect());
        assert_eq!(lines.files.len(), MOST_FILES);
        assert_eq!(lines.place(|word| word == "discard").as_deref(), Some("0.frag:1"));
    }
}
