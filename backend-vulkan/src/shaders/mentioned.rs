//! The names in a GLSL text that decide how it is compiled for a pass.

use super::files::{ShaderFiles, SourceFile};
use super::text;
use framewright_graph::base::FilePath;
use std::collections::BTreeSet;

/// Beginning of macros that stand for the type of a sampled image.
pub(super) const TEXTURE: &str = "TEXTURE_";

/// Beginning of macros that are there if a pass samples the image that they name.
pub(super) const HAS: &str = "HAS_";

/// Beginning of macros that stand for the number of components of a sampled image's format.
pub(super) const COMPONENTS: &str = "COMPONENTS_";

/// Ending of macros that stand for the part in use of a sampled image.
pub(super) const PART: &str = "_st";

/// Names that a GLSL text mentions outside comments, each once, in order: those behind [`TEXTURE`], [`HAS`] and [`COMPONENTS`],
/// and those of its samplers before [`PART`].
pub(super) struct Mentioned {
    pub(super) adapting: Vec<String>,
    pub(super) optional: Vec<String>,
    pub(super) counted: Vec<String>,
    pub(super) parts: Vec<String>,
    /// Whether the text asks which eye it draws for.
    pub(super) eye: bool,
}

impl Mentioned {
    /// The names that `text` mentions.
    pub(super) fn by(text: &str) -> Mentioned {
        let text = text::without_comments(text);
        let in_order: Vec<&str> = text::words(&text).collect();
        let sampled = in_order.windows(2).filter(|pair| pair[0].contains("sampler") || pair[0].starts_with(TEXTURE));
        let sampled: BTreeSet<&str> = sampled.map(|pair| pair[1]).collect();
        let words: BTreeSet<&str> = in_order.into_iter().collect();
        let behind =
            |beginning: &str| words.iter().filter_map(|word| word.strip_prefix(beginning)).map(str::to_owned).collect();
        let parts = words.iter().filter_map(|word| word.strip_suffix(PART));
        let parts = parts.filter(|name| sampled.contains(name)).map(str::to_owned).collect();
        let eye = words.contains("eye_index");
        Mentioned { adapting: behind(TEXTURE), optional: behind(HAS), counted: behind(COMPONENTS), parts, eye }
    }
}

/// Whether one of the user's own files that a file includes asks which eye is drawn for. Those that are shipped are given the same
/// for both where one eye is drawn for.
pub(super) fn asks_eye_in_included(files: &ShaderFiles, from: &SourceFile) -> bool {
    let included = text::included(files, from);
    included.iter().any(|file| matches!(file.path, FilePath::Own(_)) && Mentioned::by(&file.text).eye)
}

#[cfg(test)]
mod tests {
    use super::Mentioned;

    #[test]
    fn a_macro_that_only_a_comment_mentions_adapts_nothing() {
        let text = "// TEXTURE_a\nuniform TEXTURE_b b; /* TEXTURE_c\nTEXTURE_d */ uniform TEXTURE_e/**/e; // TEXTURE_f";
        assert_eq!(Mentioned::by(text).adapting, ["b", "e"]);
        assert_eq!(Mentioned::by("uniform TEXTURE_b b; /* TEXTURE_c").adapting, ["b"]);
    }

    #[test]
    fn only_what_is_sampled_has_a_part() {
        let text = "uniform sampler2D a; uniform TEXTURE_b b; in vec2 c; vec2 c_st = c * a_st.xy + b_st.zw; // d_st sampler2D d";
        assert_eq!(Mentioned::by(text).parts, ["a", "b"]);
        assert_eq!(Mentioned::by("usampler2DArray a ; vec4 x = e_st;").parts, [""; 0]);
    }
}
