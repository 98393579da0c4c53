//! Names of shaders: GLSL by a name for all its stages, and SPIR-V by its file and entry point.

use std::fmt;
use std::sync::Arc;

/// The ending of files of SPIR-V.
const SPIRV: &str = ".spv";

/// The shader of a pass.
///
/// It is a text in pipelines' frames and in Plans: `lit`, `post.spv`, `post.spv:PSMain`, or, where stages have names of their own,
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
    /// SPIR-V.
    Spirv {
        /// The file, which ends in `.spv`.
        file: Arc<str>,
        /// The entry point; `None`: the only one of the stage.
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

    /// Whether the shader of this text has a stage that is SPIR-V.
    #[must_use]
    pub fn is_spirv(text: &str) -> bool {
        text.contains(SPIRV)
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
        let entry = text.find(".spv:").map(|at| text.split_at(at + SPIRV.len()));
        match entry {
            Some((file, entry)) => StageName::Spirv { file: file.into(), entry: Some(entry[1..].into()) },
            None if text.ends_with(SPIRV) => StageName::Spirv { file: text.into(), entry: None },
            None => StageName::Glsl(text.into()),
        }
    }

    /// Whether it is SPIR-V.
    #[must_use]
    pub const fn is_spirv(&self) -> bool {
        matches!(self, StageName::Spirv { .. })
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
            StageName::Spirv { file, entry: None } => f.write_str(file),
            StageName::Spirv { file, entry: Some(entry) } => write!(f, "{file}:{entry}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shader_is_the_same_after_it_was_written() {
        let spirv =
            |file: &str, entry: Option<&str>| StageName::Spirv { file: file.into(), entry: entry.map(Into::into) };
        let glsl = |name: &str| StageName::Glsl(name.into());
        for (text, name) in [
            ("lit", ShaderName::Whole(glsl("lit"))),
            ("shipped:lit", ShaderName::Whole(glsl("shipped:lit"))),
            ("post.spv", ShaderName::Whole(spirv("post.spv", None))),
            ("a/post.spv:PS Main::x", ShaderName::Whole(spirv("a/post.spv", Some("PS Main::x")))),
            (
                "vertex a.spv:VS, fragment b.spv",
                ShaderName::Stages { vertex: Some(spirv("a.spv", Some("VS"))), fragment: spirv("b.spv", None) },
            ),
            ("fragment glow", ShaderName::Stages { vertex: None, fragment: glsl("glow") }),
        ] {
            assert_eq!(ShaderName::of_text(text), name);
            assert_eq!(name.to_string(), text);
        }
    }
}
