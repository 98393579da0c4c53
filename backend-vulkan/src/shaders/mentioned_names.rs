//! The names in a GLSL text that decide how it is compiled for a pass.

use super::eyes::BASE_INSTANCE;
use super::files::{ShaderFiles, SourceFile};
use super::text;
use framewright_graph::base::FilePath;
use framewright_graph::shader::FileLanguage;
use std::collections::BTreeSet;

/// Beginning of macros that stand for the type of a sampled image.
pub(super) const TEXTURE: &str = "TEXTURE_";

/// Beginning of macros that are there if a pass samples the image that they name.
pub(super) const HAS: &str = "HAS_";

/// Beginning of macros that stand for the number of components of a sampled image's format.
pub(super) const COMPONENTS: &str = "COMPONENTS_";

/// Beginning of macros that are there if a pass reads the image that they name locally.
pub(super) const LOCAL: &str = "LOCAL_READ_";

/// Ending of macros that stand for the part in use of an image.
pub(super) const PART: &str = "_st";

/// Names that a stage's text and its included files mention outside comments: behind [`TEXTURE`], [`HAS`] and [`COMPONENTS`], and,
/// for its samplers and storage images, before [`PART`]. Each name stands once, in order. A name that the stage declares is its own.
pub(super) struct MentionedNames {
    pub(super) adapting: Vec<String>,
    pub(super) optional: Vec<String>,
    pub(super) counted: Vec<String>,
    pub(super) parts: Vec<String>,
    /// Whether the text asks which eye it draws for.
    pub(super) eye: bool,
    /// Whether the stage asks for the index of a view.
    pub(super) view: bool,
    /// Whether the stage asks for the first instance of a draw, as GLSL calls it.
    pub(super) base_instance: bool,
    /// Macros that would be defined, but for the stage's own declarations of the same names.
    pub(super) own: Vec<String>,
}

/// Macros whose names say all, and stand for no image.
const FIXED: [&str; 3] = ["DEPTH_ONLY", "ALPHA_TO_COVERAGE", "eye_index"];

impl MentionedNames {
    /// The names that a stage mentions. Shipped files that it includes are given the same for both eyes where one is drawn for:
    /// they don't ask.
    pub(super) fn by_stage(files: &ShaderFiles, stage: &SourceFile) -> MentionedNames {
        let included = text::included(files, stage);
        let own = included.iter().filter(|file| matches!(file.path, FilePath::Own(_)));
        let eye = std::iter::once(stage)
            .chain(own)
            .any(|file| text::words(&text::without_comments(&file.text)).any(|word| word == "eye_index"));
        let all: Vec<&str> = std::iter::once(stage).chain(&included).map(|file| &*file.text).collect();
        let mut mentioned = MentionedNames::by(&all.join("\n"));
        mentioned.eye &= eye;
        let language = FileLanguage::of_file(stage.path.path());
        mentioned.view = std::iter::once(stage).chain(&included).any(|file| asks_for_view(language, &file.text));
        mentioned
    }

    /// The names that `text` mentions.
    fn by(text: &str) -> MentionedNames {
        let text = text::without_comments(text);
        let in_order: Vec<&str> = text::words(&text).collect();
        let is_image = |word: &str| word.contains("sampler") || word.contains("image") || word.starts_with(TEXTURE);
        let seen = in_order.windows(2).filter(|pair| is_image(pair[0])).map(|pair| pair[1]);
        // Of HLSL a texel's type may stand between: `Texture2D<float4> source`.
        let of_hlsl = in_order.windows(3).filter(|words| words[0].contains("Texture"));
        let seen: BTreeSet<&str> = seen.chain(of_hlsl.flat_map(|words| [words[1], words[2]])).collect();
        let words: BTreeSet<&str> = in_order.into_iter().collect();
        let is_macro = |word: &&str| {
            [TEXTURE, HAS, COMPONENTS, LOCAL].iter().any(|beginning| word.starts_with(beginning))
                || word.ends_with(PART)
                || FIXED.contains(word)
        };
        let own: BTreeSet<&str> = words.iter().copied().filter(is_macro).filter(|word| declares(&text, word)).collect();
        let words = || words.iter().filter(|word| !own.contains(**word));
        let behind =
            |beginning: &str| words().filter_map(|word| word.strip_prefix(beginning)).map(str::to_owned).collect();
        let parts = words().filter_map(|word| word.strip_suffix(PART));
        let parts = parts.filter(|name| seen.contains(name)).map(str::to_owned).collect();
        let eye = words().any(|word| *word == "eye_index");
        let base_instance = words().any(|word| BASE_INSTANCE.contains(word));
        let (adapting, optional, counted) = (behind(TEXTURE), behind(HAS), behind(COMPONENTS));
        let own = own.into_iter().map(str::to_owned).collect();
        MentionedNames { adapting, optional, counted, parts, eye, view: false, base_instance, own }
    }
}

/// Whether a text mentions the index of a view, as its language calls it; `None` is GLSL. Letters of HLSL's semantics may be of any case.
fn asks_for_view(language: Option<FileLanguage>, text: &str) -> bool {
    let text = text::without_comments(text);
    let mut words = text::words(&text);
    match language {
        None => words.any(|word| word == "gl_ViewIndex"),
        Some(FileLanguage::Hlsl | FileLanguage::Slang) => words.any(|word| word.eq_ignore_ascii_case("SV_ViewID")),
        Some(FileLanguage::Wgsl) => words.collect::<Vec<_>>().windows(2).any(|pair| pair == ["builtin", "view_index"]),
        // Its capabilities tell.
        Some(FileLanguage::Spirv) => false,
    }
}

/// Words before a name that are no type: behind a qualifier the name is a type itself.
const NO_TYPES: [&str; 24] = [
    "return",
    "else",
    "case",
    "uniform",
    "const",
    "in",
    "out",
    "inout",
    "highp",
    "mediump",
    "lowp",
    "flat",
    "smooth",
    "noperspective",
    "centroid",
    "sample",
    "precise",
    "invariant",
    "coherent",
    "volatile",
    "restrict",
    "readonly",
    "writeonly",
    "shared",
];

/// Whether a text without comments declares `name`, as a variable, a parameter, a member or a function, or defines it as a
/// macro without asking first whether there is one.
fn declares(text: &str, name: &str) -> bool {
    // A line that goes on is one line.
    let text = &*text.replace("\\\r\n", "   ").replace("\\\n", "  ");
    let letter = |letter: char| letter == '_' || letter.is_ascii_alphanumeric();
    let before = text.match_indices(name).filter_map(|(at, _)| {
        let behind = text[at + name.len()..].chars().next();
        let (before, whole) = (&text[..at], !text[..at].ends_with(letter) && !behind.is_some_and(letter));
        let line = before.rsplit('\n').next().unwrap_or(before);
        // A directive before it is no type.
        let code = before[..before.len() - line.len()].lines().rev().find(|line| !line.trim().is_empty());
        let own = line.trim().is_empty() && code.is_some_and(|line| line.trim_start().starts_with('#'));
        whole.then(|| (line.trim_start(), if own { "" } else { before.trim_end() }))
    });
    let (mut asked, mut defined) = (false, false);
    for (line, before) in before {
        let word = before.rsplit(|it| !letter(it)).next().unwrap_or("");
        match line.strip_prefix('#') {
            Some(directive) if directive.trim_start().starts_with("define") && word == "define" => defined = true,
            Some(directive) => asked |= !directive.trim_start().starts_with("define"),
            // Any other word before it, or the brackets of an array, are a type.
            None if NO_TYPES.contains(&word) => {}
            None if !word.is_empty() || before.ends_with(']') => return true,
            None => {}
        }
    }
    defined && !asked
}

#[cfg(test)]
mod tests {
    use super::{MentionedNames, asks_for_view};
    use framewright_graph::shader::FileLanguage;

    /// DO-2: a word that means the view in another language means nothing here.
    #[test]
    fn each_language_has_its_own_word_for_the_index_of_a_view() {
        let languages = [None, Some(FileLanguage::Hlsl), Some(FileLanguage::Slang), Some(FileLanguage::Wgsl)];
        for (text, expected) in [
            ("int eye = int(gl_ViewIndex);", [true, false, false, false]),
            ("f(uint v : sv_viewid)", [false, true, true, false]),
            ("fn f(@builtin( view_index ) v: i32)", [false, false, false, true]),
            ("let view_index = 0;", [false; 4]),
            ("// gl_ViewIndex SV_ViewID @builtin(view_index)", [false; 4]),
        ] {
            assert_eq!(languages.map(|language| asks_for_view(language, text)), expected, "{text}");
        }
    }

    #[test]
    fn a_macro_that_only_a_comment_mentions_adapts_nothing() {
        let text = "// TEXTURE_a\nuniform TEXTURE_b b; /* TEXTURE_c\nTEXTURE_d */ uniform TEXTURE_e/**/e; // TEXTURE_f";
        assert_eq!(MentionedNames::by(text).adapting, ["b", "e"]);
        assert_eq!(MentionedNames::by("uniform TEXTURE_b b; /* TEXTURE_c").adapting, ["b"]);
    }

    #[test]
    fn only_what_is_an_image_has_a_part() {
        let text = "uniform sampler2D a; uniform TEXTURE_b b; in vec2 c; vec2 c_st = c * a_st.xy + b_st.zw; // d_st sampler2D d";
        assert_eq!(MentionedNames::by(text).parts, ["a", "b"]);
        assert_eq!(MentionedNames::by("usampler2DArray a ; vec4 x = e_st;").parts, [""; 0]);
        let hlsl = "Texture2D<float4> a; Texture2D b; RWTexture2D<uint> c; float4 d = a_st + b_st + c_st + d_st;";
        assert_eq!(MentionedNames::by(hlsl).parts, ["a", "b", "c"]);
        assert_eq!(MentionedNames::by("uniform readonly uimage2D a; ivec2 b = imageSize(a) * a_st.xy;").parts, ["a"]);
    }

    #[test]
    fn a_name_that_the_text_declares_is_its_own() {
        let own = |text: &str| MentionedNames::by(text).own;
        assert_eq!(own("vec4 blur(sampler2D a, vec4 a_st) { return a_st; }"), ["a_st"]);
        assert_eq!(own("uniform Params { highp vec4 a_st; int[2] COMPONENTS_a; };"), ["COMPONENTS_a", "a_st"]);
        assert_eq!(own("#define HAS_a 1\n#ifdef DEPTH_ONLYS\nconst bool DEPTH_ONLY = true;"), ["DEPTH_ONLY", "HAS_a"]);
        for asks in [
            "#ifndef a_st\n#define a_st vec4(1, 1, 0, 0)\n#endif",
            "#if COMPONENTS_a == 1 && defined(HAS_a)",
            "#if defined HAS_a || \\\n    defined HAS_b\nfloat c;\n#endif",
            "vec2 c = b +\n#ifdef OTHER\na_st.xy;\n#else\n\na_st.zw;\n#endif",
            "vec4 f() { return a_st; }",
            "f(a, a_st, b * a_st, (a_st), eye_index)",
            "#define SCALE a_st.xy",
            "layout(binding = 0) uniform TEXTURE_a a;",
        ] {
            assert_eq!(own(asks), [""; 0], "{asks}");
        }
        assert_eq!(MentionedNames::by("uniform sampler2D a; vec4 f(vec4 a_st) { return a_st; }").parts, [""; 0]);
    }
}
