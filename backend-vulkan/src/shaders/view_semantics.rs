//! `SV_ViewID` for compilers of HLSL that don't know it: glslang before 2024, by itself or within shaderc, takes it for a value that the
//! stage before hands over.
//!
//! So it becomes one, at a location that nothing else has. In the module the eye takes its place.

use std::borrow::Cow;

/// The location. What has a location in a shader lies far below.
pub(super) const LOCATION: u32 = 97;

/// The name that stands for `SV_ViewID`, which later versions of the compiler know.
const NAME: &str = "FRAMEWRIGHT_VIEW";

/// A text of HLSL whose `SV_ViewID` is a value at [`LOCATION`]. Lines keep their numbers.
pub(super) fn placed(text: &str) -> Cow<'_, str> {
    let (mut made, mut kept) = (String::new(), 0);
    for (start, end) in semantics(text) {
        let Some(declared) = declaration(&text[kept..start]) else { continue };
        made += &text[kept..kept + declared];
        made += &format!("[[vk::location({LOCATION})]] ");
        made += &text[kept + declared..start];
        made += NAME;
        kept = end;
    }
    if kept == 0 {
        return Cow::Borrowed(text);
    }
    Cow::Owned(made + &text[kept..])
}

/// Where a text says `SV_ViewID`, from and to. Letters may be of any case.
fn semantics(text: &str) -> impl Iterator<Item = (usize, usize)> {
    const WORD: &str = "SV_VIEWID";
    let is_letter = |letter: Option<&u8>| letter.is_some_and(|it| *it == b'_' || it.is_ascii_alphanumeric());
    let bytes = text.as_bytes();
    let starts = (0..bytes.len()).filter(move |at| {
        let found = bytes.get(*at..*at + WORD.len()).is_some_and(|it| it.eq_ignore_ascii_case(WORD.as_bytes()));
        found && !is_letter(at.checked_sub(1).and_then(|at| bytes.get(at))) && !is_letter(bytes.get(*at + WORD.len()))
    });
    starts.map(|start| (start, start + WORD.len()))
}

/// Where the declaration begins that a text ends with, up to its semantic: behind `uint view : `. `None`: it ends with none.
fn declaration(text: &str) -> Option<usize> {
    let declared = text.trim_end().strip_suffix(':')?;
    let start = declared.rfind(['(', ',', '{', ';', ']', '\n']).map_or(0, |at| at + 1);
    let inside = &declared[start..];
    let is_word = |it: char| it == '_' || it.is_ascii_alphanumeric() || it.is_whitespace();
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
            ("// SV_ViewID\nmy_SV_ViewID(uint v : SV_ViewIDs)", "// SV_ViewID\nmy_SV_ViewID(uint v : SV_ViewIDs)"),
        ] {
            assert_eq!(placed(text), expected);
        }
    }
}
