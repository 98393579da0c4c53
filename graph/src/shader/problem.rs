//! What is wrong with a shader, as a mistake of the file that names it.

use super::ShaderProblem;
use crate::base::{Code, Diagnostic, Span, suggestion};

impl ShaderProblem {
    /// The rule that is broken.
    #[must_use]
    pub const fn code(&self) -> Code {
        match self {
            ShaderProblem::Missing { .. } => Code::UNKNOWN_SHADER,
            ShaderProblem::DoesNotCompile { .. } => Code::SHADER_BROKEN,
            ShaderProblem::Unsupported { .. } => Code::SHADER_UNFIT,
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
            ShaderProblem::Machine { what } => {
                Diagnostic::new(self.code(), span, format!("shader `{name}` can't be used: {what}")).of_machine()
            }
        }
    }
}
