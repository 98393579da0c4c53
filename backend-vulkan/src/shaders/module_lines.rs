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

/// Lines by file: what stands there, as words.
#[derive(Debug, Default)]
pub(super) struct ModuleLines(Vec<(String, BTreeMap<u32, String>)>);

impl ModuleLines {
    /// The lines of a module, and of the texts that it holds, by the names of their files.
    pub(super) fn of(module: &Module, texts: Vec<(String, String)>) -> ModuleLines {
        let mut lines = ModuleLines::default();
        for (file, text) in texts {
            let all = lines.file(&file);
            let mut number = 0_u32;
            for line in without_comments(&text).lines() {
                number = number.saturating_add(1);
                // The next line has this number.
                let said = line.trim_start().strip_prefix("#line ").and_then(|rest| words(rest).next()?.parse().ok());
                if let Some(next) = said {
                    number = u32::saturating_sub(next, 1);
                    continue;
                }
                all.insert(number, line.to_owned());
            }
        }
        lines.instructions(module);
        lines
    }

    /// The first line with such a word, as `FILE:LINE`.
    pub(super) fn place(&self, wanted: impl Fn(&str) -> bool) -> Option<String> {
        let line =
            |lines: &BTreeMap<u32, String>| lines.iter().find(|(_, text)| words(text).any(&wanted)).map(|it| *it.0);
        self.0.iter().find_map(|(file, lines)| Some(format!("{file}:{}", line(lines)?)))
    }

    fn file(&mut self, name: &str) -> &mut BTreeMap<u32, String> {
        let name: String = name.chars().take(LONGEST_NAME).collect();
        let at = self.0.iter().position(|(known, _)| *known == name).unwrap_or_else(|| {
            self.0.push((name, BTreeMap::new()));
            self.0.len() - 1
        });
        &mut self.0[at].1
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
        let has_text: Vec<String> = self.0.iter().map(|(file, _)| file.clone()).collect();
        let indexed = IndexedModule::new(module);
        let mut bytes = 0;
        for function in &module.functions {
            let mut at: Option<(&str, u32)> = None;
            for it in function.blocks.iter().flat_map(|block| &block.instructions) {
                match (it.class.opcode, &it.operands[..]) {
                    (Op::Line, [Operand::IdRef(file), Operand::LiteralBit32(line), ..]) => {
                        at = strings
                            .get(file)
                            .map(|file| (*file, *line))
                            .filter(|(file, _)| !has_text.contains(&(*file).to_owned()));
                    }
                    (Op::NoLine, _) => at = None,
                    _ => {
                        let Some((file, line)) = at.filter(|_| bytes < MOST_BYTES) else { continue };
                        let text = self.file(file).entry(line).or_default();
                        let before = text.len();
                        add_words(&indexed, it, text);
                        bytes += text.len() - before + size_of::<String>();
                    }
                }
            }
        }
    }
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
}
