//! `SV_ViewID` for compilers of HLSL that don't know it: glslang before 2024, by itself or within shaderc, takes it for a value that the
//! stage before hands over.
//!
//! So it becomes one, at a location that nothing else has. In the module the eye takes its place.

use std::borrow::Cow;

/// The location. What has a location in a shader lies far below.
pub(super) const LOCATION: u32 = 97;

/// The name that stands for `SV_ViewID`, which later versions of the compiler know.
const NAME: &str = "FRAMEWRIGHT_VIEW";

/// `SV_ViewID`. Letters may be of any case.
const WORD: &str = "SV_VIEWID";

/// A text of HLSL whose `SV_ViewID` is a value at [`LOCATION`], also where a macro of the text stands for it. Lines keep their numbers.
pub(super) fn placed(text: &str) -> Cow<'_, str> {
    let code = blanked(text);
    let macros = macros(&code);
    let (mut made, mut kept) = (String::new(), 0);
    for (start, end) in semantics(&code, &macros) {
        let defines = macro_before(&code[..start]).is_some();
        let declared = declaration(&code[kept..start]).filter(|_| !defines);
        if !defines && declared.is_none() {
            continue;
        }
        if let Some(declared) = declared {
            made += &text[kept..kept + declared];
            made += &format!("[[vk::location({LOCATION})]] ");
            kept += declared;
        }
        made += &text[kept..start];
        made += if is_word(&code[start..end]) { NAME } else { &text[start..end] };
        kept = end;
    }
    if kept == 0 {
        return Cow::Borrowed(text);
    }
    Cow::Owned(made + &text[kept..])
}

fn is_word(word: &str) -> bool {
    word.eq_ignore_ascii_case(WORD)
}

fn is_letter(letter: char) -> bool {
    letter == '_' || letter.is_ascii_alphanumeric()
}

/// A text with blanks in place of its comments: all else stands where it stood.
fn blanked(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(['/', '"']) {
        let (before, behind) = rest.split_at(start);
        code += before;
        let until = |end: &str, from: usize| behind[from..].find(end).map(|at| from + at);
        let (length, is_comment) = if behind.starts_with("//") {
            (until("\n", 2).unwrap_or(behind.len()), true)
        } else if behind.starts_with("/*") {
            (until("*/", 2).map_or(behind.len(), |at| at + 2), true)
        } else if let Some(literal) = behind.strip_prefix('"') {
            // A literal ends on its line.
            (literal.find(['"', '\n']).map_or(behind.len(), |at| at + 2), false)
        } else {
            (1, false)
        };
        let (part, behind) = behind.split_at(length);
        match is_comment {
            true => code.extend(part.bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' })),
            false => code += part,
        }
        rest = behind;
    }
    code + rest
}

/// The macros that stand for `SV_ViewID`.
fn macros(code: &str) -> Vec<&str> {
    let starts = words(code).filter(|(start, end)| is_word(&code[*start..*end]));
    starts.filter_map(|(start, _)| macro_before(&code[..start])).collect()
}

/// The macro whose value begins where a text ends.
fn macro_before(text: &str) -> Option<&str> {
    let line = text.rsplit('\n').next()?.trim_start().strip_prefix('#')?.trim_start();
    let mut words = line.strip_prefix("define")?.split_whitespace();
    let name = words.next().filter(|name| name.chars().all(is_letter))?;
    words.next().is_none().then_some(name)
}

/// Where a text says `SV_ViewID`, or one of these macros, from and to.
fn semantics(code: &str, macros: &[&str]) -> impl Iterator<Item = (usize, usize)> {
    words(code).filter(|(start, end)| is_word(&code[*start..*end]) || macros.contains(&&code[*start..*end]))
}

/// The words of a text, from and to.
fn words(code: &str) -> impl Iterator<Item = (usize, usize)> {
    let words = code.split(|letter| !is_letter(letter)).filter(|word| !word.is_empty());
    words.map(|word| {
        let start = word.as_ptr().addr() - code.as_ptr().addr();
        (start, start + word.len())
    })
}

/// Where the declaration begins that a text ends with, up to its semantic: behind `uint view : `. `None`: it ends with none.
fn declaration(text: &str) -> Option<usize> {
    let declared = text.trim_end().strip_suffix(':')?;
    let start = declared.rfind(['(', ',', '{', ';', ']', '\n']).map_or(0, |at| at + 1);
    let inside = &declared[start..];
    let is_word = |it: char| is_letter(it) || it.is_whitespace();
    let begins = start + inside.len() - inside.trim_start().len();
    (inside.chars().all(is_word) && inside.split_whitespace().count() > 1).then_some(begins)
}

#[cfg(test)]
mod tests {
    use super::placed;

    #[test]
    fn the_index_of_a_view_gets_a_location() {
        for (text, expected) in [
            ("f(uint v : SV_ViewID)", "f([[vk::location(97)]] uint v : FRAMEWRIGHT_VIEW)"),
            (
                "{ float a : B;\n  in uint v:sv_viewid; }",
                "{ float a : B;\n  [[vk::location(97)]] in uint v:FRAMEWRIGHT_VIEW; }",
            ),
            (
                "(A a, uint v : SV_ViewID, B b) (uint w : SV_VIEWID)",
                "(A a, [[vk::location(97)]] uint v : FRAMEWRIGHT_VIEW, B b) \
                ([[vk::location(97)]] uint w : FRAMEWRIGHT_VIEW)",
            ),
            (
                "f(/* the eye */ uint v /* Ü */ : SV_ViewID)",
                "f(/* the eye */ [[vk::location(97)]] uint v /* Ü */ : FRAMEWRIGHT_VIEW)",
            ),
            (
                "f(A a, // uint v : SV_ViewID\n uint v : SV_ViewID)",
                "f(A a, // uint v : SV_ViewID\n [[vk::location(97)]] uint v : FRAMEWRIGHT_VIEW)",
            ),
            (
                "# define SEM sv_viewid // it\nf(uint v : SEM, uint w : Sem)",
                "# define SEM FRAMEWRIGHT_VIEW // it\nf([[vk::location(97)]] uint v : SEM, uint w : Sem)",
            ),
            ("#define F(x) SV_ViewID\n", "#define F(x) SV_ViewID\n"),
            ("// SV_ViewID\nmy_SV_ViewID(uint v : SV_ViewIDs)", "// SV_ViewID\nmy_SV_ViewID(uint v : SV_ViewIDs)"),
        ] {
            assert_eq!(placed(text), expected);
        }
    }
}
