//! What is wrong with a shader, as a mistake of the file that names it.

use super::ShaderProblem;
use crate::base::{Code, Diagnostic, Span, nearest, suggestion};

impl ShaderProblem {
    /// The rule that is broken.
    #[must_use]
    pub const fn code(&self) -> Code {
        match self {
            ShaderProblem::Missing { .. } => Code::UNKNOWN_SHADER,
            ShaderProblem::DoesNotCompile { .. } => Code::SHADER_BROKEN,
            ShaderProblem::Unsupported { .. } => Code::SHADER_UNFIT,
            ShaderProblem::BadModule { .. } => Code::SPIRV_FILE,
            ShaderProblem::EntryPoint { .. } => Code::ENTRY_POINT,
            ShaderProblem::Compiler { .. } => Code::SHADER_COMPILER,
            ShaderProblem::Machine { .. } => Code::SHADER_MACHINE,
        }
    }

    /// The mistake in words, for the shader `name` that is named at `span`.
    pub(crate) fn at(&self, name: &str, span: Span) -> Diagnostic {
        match self {
            ShaderProblem::Missing { looked_in, known } => {
                let mut help = suggestion(name, known.iter().map(String::as_str)).unwrap_or_default();
                if !looked_in.is_empty() {
                    let break_line = if help.is_empty() { "" } else { "\n" };
                    help = format!("{help}{break_line}looked for in {}", looked_in.join(", "));
                }
                let missing = Diagnostic::new(self.code(), span, format!("there is no shader named `{name}`"));
                Diagnostic { help: (!help.is_empty()).then_some(help), ..missing }
            }
            ShaderProblem::DoesNotCompile { messages } => {
                let quotes = messages.iter().filter_map(|message| message.quote.clone()).collect();
                // Messages that quote their line need no further words.
                let rest = messages.iter().filter(|message| message.quote.is_none()).map(ToString::to_string);
                let rest = rest.collect::<Vec<_>>().join("\n");
                let broken = Diagnostic::new(self.code(), span, format!("shader `{name}` doesn't compile"));
                let choice = messages.iter().find_map(|message| message.limit);
                Diagnostic { quotes, help: (!rest.is_empty()).then_some(rest), choice, ..broken }
            }
            ShaderProblem::Unsupported { what } => {
                Diagnostic::new(self.code(), span, format!("shader `{name}` can't be used: {what}"))
            }
            ShaderProblem::BadModule { what } => {
                Diagnostic::new(self.code(), span, format!("shader `{name}` is no SPIR-V that can be read: {what}"))
            }
            ShaderProblem::EntryPoint { file, stage, named, of_stage, others } => {
                let (message, help) = entry_point(file, stage, named.as_deref(), of_stage, others);
                Diagnostic::new(self.code(), span, message).help(help)
            }
            ShaderProblem::Compiler { what, help, of_machine, choice } => {
                let wrong = Diagnostic::new(self.code(), span, format!("shader `{name}` isn't compiled: {what}"));
                Diagnostic {
                    help: (!help.is_empty()).then(|| help.clone()),
                    choice: *choice,
                    of_machine: *of_machine,
                    ..wrong
                }
            }
            ShaderProblem::Machine { what } => {
                Diagnostic::new(self.code(), span, format!("shader `{name}` can't be used: {what}")).of_machine()
            }
        }
    }
}

/// That a module has no such entry point, or several, and what to write.
fn entry_point(
    file: &str,
    stage: &str,
    named: Option<&str>,
    of_stage: &[String],
    others: &[(String, &'static str)],
) -> (String, String) {
    let mut all: Vec<String> = of_stage.iter().map(|entry| format!("`{file}:{entry}`")).collect();
    if let (None, [_, _, ..]) = (named, of_stage) {
        let message = format!("`{file}` has {} entry points of a {stage} stage", all.len());
        return (message, format!("say which: {}", all.join(", ")));
    }
    let message = match named {
        Some(named) => format!("`{file}` has no entry point `{named}` of a {stage} stage"),
        None => format!("`{file}` has no entry point of a {stage} stage"),
    };
    let meant = named.and_then(|named| nearest(named, of_stage.iter().map(String::as_str)));
    if let Some(meant) = meant {
        return (message, format!("did you mean `{file}:{meant}`?"));
    }
    all.extend(others.iter().map(|(entry, stage)| format!("`{entry}` of a {stage} stage")));
    (message, if all.is_empty() { "it has none at all".to_owned() } else { format!("it has {}", all.join(", ")) })
}
