//! The options that messages name. Libraries report a choice from outside; here it gets the option that makes it.

use framewright_graph::base::{Diagnostic, OutsideChoice};

/// How an option makes a choice.
pub(crate) fn option(choice: OutsideChoice) -> &'static str {
    match choice {
        OutsideChoice::Root => "`--root` names it, or `--allow-outside` allows all",
        OutsideChoice::Extensions => "the command applies it by `--extend`",
        OutsideChoice::OutputSize => "`--size` chooses it",
        OutsideChoice::ShaderTime => "`--shader-seconds` raises it",
        OutsideChoice::ShaderMemory => "`--shader-memory` raises it",
        OutsideChoice::ShaderStack => "`--shader-stack` raises it",
        OutsideChoice::ShaderCompiler => "`--shader-compiler LANGUAGE=COMMAND` names it",
        OutsideChoice::DrawInterfaces => "`check --interface` reads what the draws of another program bring along",
    }
}

/// Mistakes, with the options that mend them.
pub(crate) fn named(diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    diagnostics.into_iter().map(named_one).collect()
}

/// A mistake, with the option that mends it.
pub(crate) fn named_one(mut diagnostic: Diagnostic) -> Diagnostic {
    let option = diagnostic.choice.take().map(|choice| option(choice).to_owned());
    diagnostic.help = match (diagnostic.help, option) {
        (Some(help), Some(option)) => Some(format!("{help}; {option}")),
        (help, option) => help.or(option),
    };
    diagnostic
}
