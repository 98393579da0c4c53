//! The words of SPIR-V that others compiled, before it is read as a module.
//!
//! What only tells people about a module is left out, and so is what the reader of modules takes for a mistake. Lines stay: those that
//! stand in extended instructions (`NonSemantic.Shader.DebugInfo.100`) become instructions of SPIR-V's own.

use std::collections::{HashMap, HashSet};

/// The first word of SPIR-V.
const MAGIC: u32 = 0x0723_0203;

/// Words of the header.
const HEADER: usize = 5;

/// The most ids that a module may have: a limit of SPIR-V's own ("Universal Limits").
const MOST_IDS: u32 = 0x003f_ffff;

/// Bytes of all texts that are taken of a module, and of the names of their files.
const MOST_TEXT: usize = 4 << 20;

/// The last version, 1.x, that Vulkan 1.3 takes.
const LAST_VERSION: u32 = 6;

/// Opcodes, by their names in SPIR-V's specification.
mod op {
    pub(super) const NOP: u32 = 0;
    pub(super) const SOURCE_CONTINUED: u32 = 2;
    pub(super) const SOURCE: u32 = 3;
    pub(super) const SOURCE_EXTENSION: u32 = 4;
    pub(super) const STRING: u32 = 7;
    pub(super) const LINE: u32 = 8;
    pub(super) const EXTENSION: u32 = 10;
    pub(super) const EXT_INST_IMPORT: u32 = 11;
    pub(super) const EXT_INST: u32 = 12;
    pub(super) const EXECUTION_MODE: u32 = 16;
    pub(super) const CONSTANT: u32 = 43;
    pub(super) const SPEC_CONSTANT: u32 = 50;
    pub(super) const FUNCTION: u32 = 54;
    pub(super) const FUNCTION_END: u32 = 56;
    pub(super) const NO_LINE: u32 = 317;
    pub(super) const MODULE_PROCESSED: u32 = 330;
    pub(super) const EXECUTION_MODE_ID: u32 = 331;
    pub(super) const DECORATE_ID: u32 = 332;
    pub(super) const EXT_INST_WITH_FORWARD_REFS: u32 = 4433;
    pub(super) const DECORATE_STRING: u32 = 5632;
    pub(super) const MEMBER_DECORATE_STRING: u32 = 5633;
}

/// Extended instructions for debuggers, and the name of their set.
mod debug {
    pub(super) const SET: &str = "NonSemantic.Shader.DebugInfo.100";
    pub(super) const SOURCE: u32 = 35;
    pub(super) const SOURCE_CONTINUED: u32 = 102;
    pub(super) const LINE: u32 = 103;
    pub(super) const NO_LINE: u32 = 104;
}

/// The execution modes for the size of workgroups: by numbers, and by constants.
const LOCAL_SIZE: [u32; 2] = [17, 38];

/// `HlslCounterBufferGOOGLE`
const COUNTER_BUFFER: u32 = 5634;

/// Extensions that bring only what is left out here.
const FOR_PEOPLE: [&str; 6] = [
    "SPV_KHR_non_semantic_info",
    "SPV_KHR_relaxed_extended_instruction",
    "SPV_GOOGLE_decorate_string",
    "SPV_GOOGLE_hlsl_functionality1",
    "SPV_GOOGLE_user_type",
    "SPV_NV_shader_debug_info",
];

/// The words of a file, in this machine's order.
///
/// # Errors
/// In words: it is no SPIR-V, is of a later version, or is cut off.
pub(super) fn words(bytes: &[u8]) -> Result<Vec<u32>, String> {
    let (_, rest) = bytes.as_chunks::<4>();
    let words = in_order(bytes);
    let (header, instructions) = match words.split_at_checked(HEADER) {
        Some(parts) if words[0] == MAGIC => parts,
        _ if words.first() == Some(&MAGIC) => return Err(format!("it is cut off: it has {} bytes", bytes.len())),
        _ => return Err("it doesn't begin as SPIR-V does".to_owned()),
    };
    let [_, version, _, bound, _] = header[..] else { return Err("it has no header".to_owned()) };
    let (major, minor) = (version >> 16 & 0xff, version >> 8 & 0xff);
    if major != 1 || minor > LAST_VERSION {
        return Err(format!(
            "it is SPIR-V {major}.{minor}: versions 1.0 to 1.{LAST_VERSION} are taken, those of Vulkan 1.3"
        ));
    }
    if bound == 0 || bound > MOST_IDS {
        return Err(format!("it says that it has {bound} ids: 1 to {MOST_IDS} are allowed"));
    }
    if !rest.is_empty() {
        return Err(format!("it is cut off: it has {} bytes, and words have four", bytes.len()));
    }
    let all = split(instructions)?;
    // It may be cut between two instructions.
    let mut functions = all.iter().rev().map(|it| it[0] & 0xffff);
    if functions.find(|opcode| [op::FUNCTION, op::FUNCTION_END].contains(opcode)) == Some(op::FUNCTION) {
        return Err("it is cut off: its last function has no end".to_owned());
    }
    Ok([header, &without_notes(&all)].concat())
}

/// The functions of entry points whose workgroups are sized by constants, each with these constants, of a file whose words are good.
pub(super) fn sized_by_constants(bytes: &[u8]) -> Vec<(u32, Vec<u32>)> {
    let words = in_order(bytes);
    let all = split(words.get(HEADER..).unwrap_or_default()).unwrap_or_default();
    let sized = all.iter().filter_map(|it| match (it[0] & 0xffff, &it[1..]) {
        (op::EXECUTION_MODE_ID, [entry, mode, sizes @ ..]) if *mode == LOCAL_SIZE[1] => Some((*entry, sizes.to_vec())),
        _ => None,
    });
    sized.collect()
}

/// The words in this machine's order.
fn in_order(bytes: &[u8]) -> Vec<u32> {
    let mut words: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    if words.first() == Some(&MAGIC.swap_bytes()) {
        words.iter_mut().for_each(|word| *word = word.swap_bytes());
    }
    words
}

/// The texts that a file whose words are good was compiled of, as far as it holds them: each with the name of its file. A pair of file and
/// text is taken once, and no more than [`MOST_TEXT`] of all: a module may name one long text as often as it likes.
pub(super) fn texts(bytes: &[u8]) -> Vec<(String, String)> {
    let words = in_order(bytes);
    let all = split(words.get(HEADER..).unwrap_or_default()).unwrap_or_default();
    let (mut strings, mut sets, mut pairs): (HashMap<u32, &[u32]>, _, _) =
        (HashMap::new(), HashSet::new(), HashSet::new());
    let mut taken = Texts::default();
    for it in all {
        let said = |id: &u32| strings.get(id).copied().unwrap_or_default();
        match (it[0] & 0xffff, &it[1..]) {
            (op::STRING, [id, name @ ..]) => _ = strings.insert(*id, name),
            (op::EXT_INST_IMPORT, [id, name @ ..]) if text(name) == debug::SET => _ = sets.insert(*id),
            (op::SOURCE, [_, _, file, words @ ..]) => taken.begin(said(file), words),
            (op::EXT_INST, [_, _, set, debug::SOURCE, file, words]) if sets.contains(set) => {
                match pairs.insert((*file, *words)) {
                    true => taken.begin(said(file), said(words)),
                    false => taken.goes_on = false,
                }
            }
            (op::SOURCE_CONTINUED, words) => taken.go_on(words),
            (op::EXT_INST, [_, _, set, debug::SOURCE_CONTINUED, words]) if sets.contains(set) => {
                taken.go_on(said(words));
            }
            _ => {}
        }
    }
    taken.all
}

/// Texts that are taken, with the names of their files, and how many bytes.
#[derive(Default)]
struct Texts {
    all: Vec<(String, String)>,
    bytes: usize,
    /// Whether what goes on belongs to the last one.
    goes_on: bool,
}

impl Texts {
    fn begin(&mut self, file: &[u32], words: &[u32]) {
        let pair = self.text(file).and_then(|file| Some((file, self.text(words)?)));
        self.goes_on = pair.is_some();
        self.all.extend(pair);
    }

    fn go_on(&mut self, words: &[u32]) {
        let more = if self.goes_on { self.text(words) } else { None };
        match self.all.last_mut().zip(more) {
            Some((last, more)) => last.1 += &more,
            None => self.goes_on = false,
        }
    }

    /// `None`: it is empty, or more than may be taken.
    fn text(&mut self, words: &[u32]) -> Option<String> {
        let bytes = self.bytes.saturating_add(size_of_val(words));
        if bytes > MOST_TEXT {
            return None;
        }
        self.bytes = bytes;
        Some(text(words)).filter(|text| !text.is_empty())
    }
}

/// The instructions.
fn split(mut rest: &[u32]) -> Result<Vec<&[u32]>, String> {
    let mut all = Vec::new();
    while let [first, ..] = rest {
        let length = (first >> 16) as usize;
        let number = all.len() + 1;
        let Some((instruction, behind)) = rest.split_at_checked(length).filter(|_| length > 0) else {
            let left = rest.len();
            return Err(format!("it is cut off: instruction {number} has {length} words, and {left} are left"));
        };
        all.push(instruction);
        rest = behind;
    }
    Ok(all)
}

/// The instructions that mean something, with the size of workgroups by numbers.
fn without_notes(all: &[&[u32]]) -> Vec<u32> {
    let mut constants = HashMap::new();
    let (mut notes, mut lines, mut sources) = (HashSet::new(), HashSet::new(), HashMap::new());
    for it in all {
        match (it[0] & 0xffff, &it[1..]) {
            (op::CONSTANT | op::SPEC_CONSTANT, [_, id, value]) => _ = constants.insert(*id, *value),
            (op::EXT_INST_IMPORT, [id, name @ ..]) if text(name).starts_with("NonSemantic.") => {
                notes.insert(*id);
                lines.extend((text(name) == debug::SET).then_some(*id));
            }
            (op::EXT_INST, [_, id, set, debug::SOURCE, file, ..]) if lines.contains(set) => {
                _ = sources.insert(*id, *file)
            }
            _ => {}
        }
    }
    let mut kept = Vec::new();
    for it in all {
        match (it[0] & 0xffff, &it[1..]) {
            (op::NOP | op::SOURCE_CONTINUED | op::SOURCE | op::SOURCE_EXTENSION | op::MODULE_PROCESSED, _)
            | (op::DECORATE_STRING | op::MEMBER_DECORATE_STRING, _)
            | (op::DECORATE_ID, [_, COUNTER_BUFFER, ..]) => {}
            (op::EXTENSION, name) if FOR_PEOPLE.contains(&&*text(name)) => {}
            (op::EXT_INST_IMPORT, [id, ..]) if notes.contains(id) => {}
            (op::EXT_INST, [_, _, set, debug::LINE, source, line, ..]) if lines.contains(set) => {
                if let (Some(file), Some(line)) = (sources.get(source), constants.get(line)) {
                    kept.extend([4 << 16 | op::LINE, *file, *line, 0]);
                }
            }
            (op::EXT_INST, [_, _, set, debug::NO_LINE]) if lines.contains(set) => kept.push(1 << 16 | op::NO_LINE),
            (op::EXT_INST | op::EXT_INST_WITH_FORWARD_REFS, [_, _, set, ..]) if notes.contains(set) => {}
            (op::EXECUTION_MODE_ID, [entry, mode, sizes @ ..]) if *mode == LOCAL_SIZE[1] => {
                let sizes: Option<Vec<u32>> = sizes.iter().map(|size| constants.get(size).copied()).collect();
                match sizes {
                    Some(sizes) => {
                        kept.extend([it[0] & 0xffff_0000 | op::EXECUTION_MODE, *entry, LOCAL_SIZE[0]]);
                        kept.extend(sizes);
                    }
                    None => kept.extend_from_slice(it),
                }
            }
            _ => kept.extend_from_slice(it),
        }
    }
    kept
}

/// A literal string: bytes up to a zero.
fn text(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn module(version: u32, instructions: &[u32]) -> Vec<u8> {
        let words = [&[MAGIC, version, 0, 100, 0], instructions].concat();
        words.into_iter().flat_map(u32::to_le_bytes).collect()
    }

    fn refused(bytes: &[u8]) -> String {
        words(bytes).expect_err("refused")
    }

    #[test]
    fn what_is_no_whole_module_is_refused_with_the_reason() {
        assert_eq!(refused(b""), "it doesn't begin as SPIR-V does");
        assert_eq!(refused(b"#version 460"), "it doesn't begin as SPIR-V does");
        assert_eq!(refused(&module(0x0001_0000, &[])[..12]), "it is cut off: it has 12 bytes");
        let later = "it is SPIR-V 1.7: versions 1.0 to 1.6 are taken, those of Vulkan 1.3";
        assert_eq!(refused(&module(0x0001_0700, &[])), later);
        assert!(refused(&module(0x0002_0000, &[])).starts_with("it is SPIR-V 2.0"));
        let cut = "it is cut off: instruction 2 has 3 words, and 2 are left";
        assert_eq!(refused(&module(0x0001_0600, &[0x0002_0011, 1, 0x0003_000e, 0])), cut);
        assert!(refused(&module(0x0001_0600, &[0])).contains("instruction 1 has 0 words"));
        let unended = "it is cut off: its last function has no end";
        assert_eq!(refused(&module(0x0001_0600, &[0x0005_0036, 1, 2, 0, 3, 0x0002_00f8, 4])), unended);
        let uneven = [module(0x0001_0600, &[]), vec![0]].concat();
        assert_eq!(refused(&uneven), "it is cut off: it has 21 bytes, and words have four");
    }

    #[test]
    fn modules_of_the_other_byte_order_are_read() {
        let bytes: Vec<u8> =
            module(0x0001_0300, &[0x0002_0011, 1]).chunks(4).flat_map(|it| [it[3], it[2], it[1], it[0]]).collect();
        assert_eq!(words(&bytes), Ok(vec![MAGIC, 0x0001_0300, 0, 100, 0, 0x0002_0011, 1]));
    }

    #[test]
    fn the_size_of_workgroups_is_put_in_numbers() {
        let by_constants = [0x0006_014b, 1, 38, 7, 7, 8, 0x0004_002b, 2, 7, 64, 0x0004_0032, 2, 8, 3];
        let found = words(&module(0x0001_0600, &by_constants)).expect("read");
        assert_eq!(found[HEADER..HEADER + 6], [0x0006_0010, 1, 17, 64, 64, 3]);
    }
    /// A string of a module, in words.
    fn string(text: &str) -> Vec<u32> {
        let bytes = [text.as_bytes(), &[0; 4]].concat();
        bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
    }

    fn instruction(opcode: u32, operands: &[u32]) -> Vec<u32> {
        [&[(operands.len() as u32 + 1) << 16 | opcode], operands].concat()
    }

    /// DO-4: one long text that a module names often is taken once, and different ones up to a limit.
    #[test]
    fn no_more_than_a_limit_is_taken_of_all_texts() {
        let named = |id: u32, text: &str| instruction(op::STRING, &[&[id], &string(text)[..]].concat());
        let long = "long ".repeat(40_000);
        let head = [instruction(op::EXT_INST_IMPORT, &[&[1], &string(debug::SET)[..]].concat()), named(2, &long)];
        let source = |file: u32| instruction(op::EXT_INST, &[9, 9, 1, debug::SOURCE, file, 2]);
        let more = instruction(op::EXT_INST, &[9, 9, 1, debug::SOURCE_CONTINUED, 2]);
        let found = |parts: &[Vec<u32>]| texts(&module(0x0001_0600, &[&head.concat()[..], &parts.concat()].concat()));
        let again = found(&[&[named(3, "a.frag")][..], &vec![source(3); 30]].concat());
        assert_eq!(again, [("a.frag".to_owned(), long.clone())]);
        let files: Vec<Vec<u32>> = (3..103).flat_map(|id| [named(id, &format!("{id}.frag")), source(id)]).collect();
        let goes_on = [&[named(3, "a.frag"), source(3)][..], &vec![more; 100]].concat();
        let inside = |words: &str| instruction(op::SOURCE, &[&[2, 450, 3], &string(words)[..]].concat());
        let named_long = [&[named(3, &long)][..], &vec![inside("main"); 100]].concat();
        for parts in [files, goes_on, named_long] {
            let found = found(&parts);
            let bytes: usize = found.iter().map(|(file, text)| file.len() + text.len()).sum();
            assert!((MOST_TEXT - 2 * long.len()..=MOST_TEXT).contains(&bytes), "{bytes}");
        }
    }
}
