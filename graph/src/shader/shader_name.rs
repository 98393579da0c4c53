//! Names of shaders: GLSL by a name for all its stages, and files of other languages by file and entry point.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// The language of a shader's file that is named with its ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum FileLanguage {
    /// SPIR-V, which is taken as it is.
    Spirv,
    /// HLSL.
    Hlsl,
    /// Slang.
    Slang,
    /// WGSL.
    Wgsl,
}

/// What there is to know of a language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LanguageFacts {
    /// Its name.
    pub name: &'static str,
    /// The ending of its files.
    pub ending: &'static str,
    /// The ending of the shipped files that it includes, `include/part.hlsl`; `None`: it isn't told what passes tell of images and eyes.
    pub includes: Option<&'static str>,
    /// What it calls the place of a fragment.
    pub place: &'static str,
}

impl FileLanguage {
    /// All of them.
    pub const ALL: [FileLanguage; 4] =
        [FileLanguage::Spirv, FileLanguage::Hlsl, FileLanguage::Slang, FileLanguage::Wgsl];

    /// What there is to know of it.
    #[must_use]
    pub const fn facts(self) -> LanguageFacts {
        let (name, ending, includes, place) = match self {
            FileLanguage::Spirv => ("SPIR-V", ".spv", None, "FragCoord"),
            FileLanguage::Hlsl => ("HLSL", ".hlsl", Some(".hlsl"), "SV_Position"),
            FileLanguage::Slang => ("Slang", ".slang", Some(".hlsl"), "SV_Position"),
            FileLanguage::Wgsl => ("WGSL", ".wgsl", None, "@builtin(position)"),
        };
        LanguageFacts { name, ending, includes, place }
    }

    /// What a language, of which `None` is GLSL, calls the place of a fragment.
    #[must_use]
    pub fn place(language: Option<FileLanguage>) -> &'static str {
        language.map_or("gl_FragCoord", |it| it.facts().place)
    }

    /// The language of a file, by its ending.
    #[must_use]
    pub fn of_file(file: &str) -> Option<FileLanguage> {
        FileLanguage::ALL.into_iter().find(|language| file.ends_with(language.facts().ending))
    }

    /// The language of the stage that draws colours, or computes, in the shader of this text; `None`: GLSL.
    #[must_use]
    pub fn of_shader(text: &str) -> Option<FileLanguage> {
        ShaderName::of_text(text).main().language()
    }

    /// The language of the stage that places vertices in the shader of this text; `None`: GLSL.
    #[must_use]
    pub fn of_vertices(text: &str) -> Option<FileLanguage> {
        match ShaderName::of_text(text) {
            ShaderName::Whole(stage) => stage.language(),
            ShaderName::Stages { vertex, .. } => vertex?.language(),
        }
    }
}

/// The shader of a pass.
///
/// It is a text in pipelines' frames and in Plans: `lit`, `post.hlsl:PSMain`, `post.spv`, or, where stages have names of their own,
/// `vertex mesh.spv:VSMain, fragment glow`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ShaderName {
    /// One name for all stages. The vertex stage is the usual one of what is drawn where there is none of that name.
    Whole(StageName),
    /// A name for each stage.
    Stages {
        /// The vertex stage; `None`: the usual one of what is drawn.
        vertex: Option<StageName>,
        /// The fragment stage.
        fragment: StageName,
    },
}

/// The name of a stage.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum StageName {
    /// GLSL of this name: the file `NAME.vert`, `NAME.frag` or `NAME.comp`.
    Glsl(Arc<str>),
    /// A file that is named with its ending: one of [`FileLanguage`].
    File {
        /// The file.
        file: Arc<str>,
        /// The entry point; `None`: the only one of the stage, or `main`.
        entry: Option<Arc<str>>,
    },
}

impl ShaderName {
    /// The shader whose text this is.
    #[must_use]
    pub fn of_text(text: &str) -> ShaderName {
        let stages = text.strip_prefix("vertex ").and_then(|rest| rest.split_once(", fragment "));
        match (stages, text.strip_prefix("fragment ")) {
            (Some((vertex, fragment)), _) => {
                ShaderName::Stages { vertex: Some(StageName::of_text(vertex)), fragment: StageName::of_text(fragment) }
            }
            (None, Some(fragment)) => ShaderName::Stages { vertex: None, fragment: StageName::of_text(fragment) },
            (None, None) => ShaderName::Whole(StageName::of_text(text)),
        }
    }

    /// Whether the shader of this text has a stage in a file that is named with its ending.
    #[must_use]
    pub fn has_file(text: &str) -> bool {
        match ShaderName::of_text(text) {
            ShaderName::Whole(stage) => stage.is_file(),
            ShaderName::Stages { vertex, fragment } => fragment.is_file() || vertex.is_some_and(|it| it.is_file()),
        }
    }

    /// The stage that draws colours, or computes.
    #[must_use]
    pub const fn main(&self) -> &StageName {
        match self {
            ShaderName::Whole(stage) | ShaderName::Stages { fragment: stage, .. } => stage,
        }
    }
}

impl StageName {
    /// The stage whose text this is.
    #[must_use]
    pub fn of_text(text: &str) -> StageName {
        let mut colons = text.match_indices(':').map(|(at, _)| at);
        match colons.find(|at| FileLanguage::of_file(&text[..*at]).is_some()) {
            Some(at) => StageName::File { file: text[..at].into(), entry: Some(text[at + 1..].into()) },
            None if FileLanguage::of_file(text).is_some() => StageName::File { file: text.into(), entry: None },
            None => StageName::Glsl(text.into()),
        }
    }

    /// The language that it is written in; `None`: GLSL.
    fn language(&self) -> Option<FileLanguage> {
        match self {
            StageName::Glsl(_) => None,
            StageName::File { file, .. } => FileLanguage::of_file(file),
        }
    }

    /// Whether it is a file that is named with its ending.
    #[must_use]
    pub const fn is_file(&self) -> bool {
        matches!(self, StageName::File { .. })
    }
}

impl fmt::Display for ShaderName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ShaderName::Whole(stage) => stage.fmt(f),
            ShaderName::Stages { vertex: Some(vertex), fragment } => write!(f, "vertex {vertex}, fragment {fragment}"),
            ShaderName::Stages { vertex: None, fragment } => write!(f, "fragment {fragment}"),
        }
    }
}

impl fmt::Display for StageName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StageName::Glsl(name) => f.write_str(name),
            StageName::File { file, entry: None } => f.write_str(file),
            StageName::File { file, entry: Some(entry) } => write!(f, "{file}:{entry}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shader_is_the_same_after_it_was_written() {
        let file_of =
            |file: &str, entry: Option<&str>| StageName::File { file: file.into(), entry: entry.map(Into::into) };
        let glsl = |name: &str| StageName::Glsl(name.into());
        for (text, name) in [
            ("lit", ShaderName::Whole(glsl("lit"))),
            ("shipped:lit", ShaderName::Whole(glsl("shipped:lit"))),
            ("post.spv", ShaderName::Whole(file_of("post.spv", None))),
            ("a/post.spv:PS Main::x", ShaderName::Whole(file_of("a/post.spv", Some("PS Main::x")))),
            (
                "vertex a.spv:VS, fragment b.spv",
                ShaderName::Stages { vertex: Some(file_of("a.spv", Some("VS"))), fragment: file_of("b.spv", None) },
            ),
            ("post.hlsl:PSMain", ShaderName::Whole(file_of("post.hlsl", Some("PSMain")))),
            ("post.slang", ShaderName::Whole(file_of("post.slang", None))),
            ("post.wgsl:main", ShaderName::Whole(file_of("post.wgsl", Some("main")))),
            ("fragment glow", ShaderName::Stages { vertex: None, fragment: glsl("glow") }),
        ] {
            assert_eq!(ShaderName::of_text(text), name);
            assert_eq!(name.to_string(), text);
        }
    }
}
