//! Where GLSL is compiled: in this process, or in a helper process.

use super::compile::{Failure, IncludedFile, Job, compile};
use super::files::{Found, ShaderFiles};
use super::messages::located;
use crate::helper::{Helper, NoAnswer};
use framewright_graph::file_path::FilePath;
use framewright_graph::interface::{ShaderMessage, ShaderProblem};
use shaderc::Compiler;
use std::collections::HashMap;

/// Where GLSL is compiled.
pub(super) enum Compilers {
    /// In this process, by a compiler that is made for the first shader.
    Here(Option<Compiler>),
    /// In a helper process.
    Helper(Helper),
}

impl Compilers {
    /// Compiles a stage whose own file is `source`.
    pub(super) fn compile(
        &mut self,
        job: &Job,
        source: &Found,
        files: &ShaderFiles,
    ) -> Result<Vec<u32>, ShaderProblem> {
        // Which files the compiler's names stand for, and what they hold.
        let mut known = HashMap::from([(source.shown.clone(), (source.path.clone(), source.text.clone()))]);
        let mut includes = |from: &str, name: &str| -> Result<IncludedFile, String> {
            let from = known.get(from).map_or_else(|| source.path.clone(), |(path, _)| FilePath::clone(path));
            let found = files.included(&from, name)?;
            let Found { path, shown, text } =
                found.ok_or_else(|| format!("looked for it in {}", files.places(&from).join(", ")))?;
            known.insert(shown.clone(), (path, text.clone()));
            Ok(IncludedFile { shown, text })
        };
        let compiled = match self {
            Compilers::Here(compiler) => {
                let compiler = match compiler {
                    Some(compiler) => compiler,
                    none => none.insert(Compiler::new().map_err(|error| ShaderProblem::Unsupported {
                        what: format!("the shader compiler doesn't start: {error}"),
                    })?),
                };
                compile(compiler, job, &mut includes)
            }
            Compilers::Helper(helper) => {
                helper.compile(job, &mut includes).map_err(|end| no_answer(&job.shown, &end))?
            }
        };
        let text = |name: &str| known.get(name).map(|(_, text)| text.as_str());
        compiled.map_err(|failure| match failure {
            Failure::Messages(messages) => ShaderProblem::DoesNotCompile { messages: located(messages, text) },
            Failure::OutOfMemory => without_line(format!("{}: the GLSL compiler ran out of memory", job.shown)),
            Failure::Internal(words) => without_line(format!("{}: the GLSL compiler failed: {words}", job.shown)),
        })
    }
}

/// That the helper process gave no answer about the file `shown`.
fn no_answer(shown: &str, end: &NoAnswer) -> ShaderProblem {
    let raise = match end {
        NoAnswer::TooLong(_) => "; `--shader-seconds` raises it",
        NoAnswer::Stack(_) => "; `--shader-stack` raises it",
        NoAnswer::Memory(_) => "; `--shader-memory` raises it",
        NoAnswer::Died(_) | NoAnswer::Cancelled => "",
        NoAnswer::Unusable(_) => {
            return ShaderProblem::Unsupported { what: format!("the helper process that compiles shaders {end}") };
        }
    };
    without_line(format!("{shown}: the GLSL compiler {end}{raise}"))
}

/// What keeps a shader from being compiled, on no line of it.
fn without_line(text: String) -> ShaderProblem {
    ShaderProblem::DoesNotCompile { messages: vec![ShaderMessage { text, quote: None }] }
}
