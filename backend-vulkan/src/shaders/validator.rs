//! The validator of SPIR-V, SPIRV-Tools', where the feature `spirv-validator` and the system have it. See build/validator.rs.

use crate::process::Verdict;

/// Judges a module by the rules of Vulkan 1.3. Which layout blocks may have is the device's matter, see `block_layout.rs`.
pub(crate) fn judge(spirv: &[u32]) -> Verdict {
    #[cfg(spirv_validator)]
    return spirv_tools::judge(spirv);
    #[cfg(not(spirv_validator))]
    {
        let _ = spirv;
        Verdict::None
    }
}

/// Whether a module is valid with the layouts that blocks may have: those of std430 in uniform blocks, and scalar ones.
#[cfg(all(test, spirv_validator))]
pub(super) fn is_valid(spirv: &[u32], standard: bool, scalar: bool) -> bool {
    spirv_tools::validate(spirv, standard, scalar).0 == 0
}

#[cfg(spirv_validator)]
mod findings {
    use crate::process::Finding;
    use std::collections::HashMap;

    /// Whether a message of the reader says that it doesn't know a word.
    pub(super) fn is_unknown_word(message: &str) -> bool {
        let unknown =
            ["Invalid opcode: ", "Invalid extended instruction import ", "Invalid extended instruction number: "];
        unknown.iter().any(|beginning| message.starts_with(beginning))
            || message.starts_with("Invalid ") && message.contains(" operand: ")
            || message.contains("invalid mask component")
    }

    /// The finding in a message about the instruction of a number, from 1; 0: about none.
    pub(super) fn finding(spirv: &[u32], instruction: usize, message: &str) -> Finding {
        let debug = Debug::of(spirv, instruction);
        // Behind the words stands the instruction.
        let words = message.split("\n  ").next().unwrap_or_default().trim().replace('\n', " ");
        // `[VUID-…] In the …`: the number of the rule behind it.
        let rule =
            words.strip_prefix('[').and_then(|rest| rest.split_once("] ")).filter(|(rule, _)| rule.starts_with("VUID"));
        let (rule, words) = rule.map_or((None, &*words), |(rule, words)| (Some(rule), words));
        let (words, mut named) = debug.with_names(words);
        named.extend(
            words.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|it| is_name(it)).flat_map(as_in_glsl),
        );
        let words = words.trim_end_matches('.').to_owned();
        let words = rule.map_or_else(|| words.clone(), |rule| format!("{words} ({rule})"));
        Finding { words, place: debug.line, named }
    }

    /// Whether a word is one of SPIR-V's own names: `PixelCenterInteger`.
    fn is_name(word: &str) -> bool {
        word.starts_with(|letter: char| letter.is_ascii_uppercase())
            && word.contains(|letter: char| letter.is_ascii_lowercase())
    }

    /// What GLSL calls one of SPIR-V's names: a built-in variable, or a word of a layout.
    fn as_in_glsl(name: &str) -> [String; 2] {
        let mut layout = String::new();
        for letter in name.chars() {
            if letter.is_ascii_uppercase() && !layout.is_empty() {
                layout.push('_');
            }
            layout.push(letter.to_ascii_lowercase());
        }
        [format!("gl_{name}"), layout]
    }

    /// What a module tells people about its parts.
    struct Debug {
        names: HashMap<u32, String>,
        line: Option<(String, u32)>,
    }

    impl Debug {
        /// The names, and the line of the instruction of a number.
        fn of(spirv: &[u32], instruction: usize) -> Debug {
            let (mut names, mut strings, mut line) = (HashMap::new(), HashMap::new(), None);
            let mut rest = spirv.get(5..).unwrap_or_default();
            let mut number = 0;
            while let [first, ..] = rest {
                let Some((words, behind)) = rest.split_at_checked((*first >> 16).max(1) as usize) else { break };
                rest = behind;
                number += 1;
                // OpName, OpString, OpLine, OpNoLine, and the end of a block or function, which ends a line's reach.
                match (first & 0xffff, &words[1..]) {
                    (5, [id, name @ ..]) => _ = names.insert(*id, text(name)),
                    (7, [id, name @ ..]) => _ = strings.insert(*id, text(name)),
                    (8, [file, number_of_line, ..]) if number <= instruction => line = Some((*file, *number_of_line)),
                    (317 | 56, _) if number < instruction => line = None,
                    _ => {}
                }
            }
            let line = line.filter(|_| instruction > 0);
            let line = line.and_then(|(file, line)| Some((strings.get(&file)?.clone(), line)));
            names.retain(|_, name| !name.is_empty());
            Debug { names, line }
        }

        /// A message with names in place of `'12[%12]'` and `id 12`, and the names.
        fn with_names(&self, words: &str) -> (String, Vec<String>) {
            let (mut said, mut named) = (String::new(), Vec::new());
            let mut rest = words;
            while let Some((before, id, behind)) = next_id(rest) {
                said.push_str(before);
                match self.names.get(&id) {
                    Some(name) => {
                        said.push_str(&format!("`{name}`"));
                        named.push(name.split('(').next().unwrap_or_default().to_owned());
                    }
                    None => said.push_str(&format!("%{id}")),
                }
                rest = behind;
            }
            (said + rest, named)
        }
    }

    /// What stands before the next `'12[%12]'` or `id 12`, its number, and what stands behind it.
    fn next_id(words: &str) -> Option<(&str, u32, &str)> {
        let ids = words.match_indices(['\'', 'i']).filter_map(|(start, _)| {
            let inside = words[start..].strip_prefix('\'').or(words[start..].strip_prefix("id "))?;
            let digits = inside.len() - inside.trim_start_matches(|letter: char| letter.is_ascii_digit()).len();
            let (id, behind) = inside.split_at(digits);
            let behind = match words[start..].starts_with('\'') {
                true => behind.strip_prefix("[%")?.split_once("]'")?.1,
                false => behind,
            };
            Some((&words[..start], id.parse().ok()?, behind))
        });
        ids.into_iter().next()
    }

    /// A literal string: bytes up to a zero.
    fn text(words: &[u32]) -> String {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

#[cfg(spirv_validator)]
mod spirv_tools {
    use super::Verdict;
    use super::findings::{finding, is_unknown_word};
    use std::ffi::{CStr, c_char};

    // SPIRV-Tools' SPV_ERROR_INVALID_BINARY.
    const INVALID_BINARY: i32 = -4;

    /// Bytes of the longest message that is taken.
    const LONGEST: usize = 4096;

    unsafe extern "C" {
        /// See build/validator.cpp.
        fn framewright_validate_spirv(
            words: *const u32,
            count: usize,
            standard: bool,
            scalar: bool,
            instruction: *mut usize,
            message: *mut c_char,
            capacity: usize,
        ) -> i32;
    }

    pub(super) fn judge(spirv: &[u32]) -> Verdict {
        let (result, instruction, message) = validate(spirv, true, true);
        match result {
            0 => Verdict::Valid,
            INVALID_BINARY if is_unknown_word(&message) => Verdict::Unknown(message.trim().to_owned()),
            // The reader counts words, and not instructions.
            INVALID_BINARY => Verdict::Invalid(finding(spirv, 0, &message)),
            // GLSL compilers before 2025 give local variables the types of blocks. Drivers take no notice of such layouts.
            _ if message.contains("VUID-StandaloneSpirv-None-10684") => Verdict::Valid,
            _ => Verdict::Invalid(finding(spirv, instruction, &message)),
        }
    }

    /// SPIRV-Tools' result, the number of the instruction that is wrong, and the message. `standard` and `scalar`: the layouts that
    /// blocks may have.
    pub(super) fn validate(spirv: &[u32], standard: bool, scalar: bool) -> (i32, usize, String) {
        let (mut instruction, mut message) = (0, vec![0_u8; LONGEST]);
        // SAFETY: the words are as many as is said, and nobody changes them; the message has room for as many bytes as is said. Both, and
        // the number, outlive the call, which keeps no pointer.
        let result = unsafe {
            framewright_validate_spirv(
                spirv.as_ptr(),
                spirv.len(),
                standard,
                scalar,
                &raw mut instruction,
                message.as_mut_ptr().cast(),
                LONGEST,
            )
        };
        let message =
            CStr::from_bytes_until_nul(&message).map_or_else(|_| String::new(), |it| it.to_string_lossy().into_owned());
        (result, instruction, message)
    }
}
