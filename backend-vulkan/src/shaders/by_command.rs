//! HLSL, Slang and WGSL to SPIR-V by a command: it is given a folder with the shader and what it includes, and no others.

use super::compiler_words::{complaints, cut, lacks_library};
use super::files::SourceFile;
use super::shader_compilers::{CompilerCommand, StageToCompile};
use crate::base::{Cancel, in_words, is_crash};
use crate::process::{Bounds, CompileJob, GivenUp, LARGEST_SPIRV, run};
use framewright_graph::base::{FilePath, OutsideChoice};
use framewright_graph::shader::{FileLanguage, ShaderMessage, ShaderProblem};
use std::path::{Component, Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use std::{fs, io};

/// A language of which no compiler is named.
pub(super) fn no_command(language: FileLanguage) -> ShaderProblem {
    let name = language.facts().name;
    ShaderProblem::Compiler {
        what: format!("no compiler of {name} is named"),
        help: format!("a command compiles {name}"),
        of_machine: true,
        choice: Some(OutsideChoice::ShaderCompiler),
    }
}

/// Compiles a stage. `included` are the files that it includes, and that they include.
///
/// # Errors
/// The compiler's complaints, or what is wrong with the compiler.
pub(super) fn compile(
    command: &CompilerCommand,
    job: &CompileJob,
    source: &SourceFile,
    included: &[SourceFile],
    time: Duration,
    cancel: &Cancel,
) -> Result<Vec<u32>, ShaderProblem> {
    let Some(program) = command.file() else { return Err(not_there(command)) };
    // It becomes an argument: a file must not make an option of it.
    let is_name = |entry: &str| entry.chars().all(|it| it == '_' || it.is_alphanumeric());
    if let Some(entry) = job.entry.as_deref().filter(|entry| !is_name(entry)) {
        let text = format!("{}: `{}` is no name of an entry point", source.shown, entry.escape_debug());
        return Err(ShaderProblem::DoesNotCompile { messages: vec![ShaderMessage { text, quote: None, limit: None }] });
    }
    let machine =
        |error: io::Error| ShaderProblem::Machine { what: format!("no folder can be made for its compiler: {error}") };
    let folder = tempfile::Builder::new().prefix("framewright-shader-").tempdir().map_err(machine)?;
    let places = Places::new(folder.path(), source, included);
    places.write(source, &job.text, included).map_err(machine)?;
    let output = folder.path().join("out.spv");
    let input = as_argument(&places.within(&source.path));
    let told = StageToCompile {
        stage: job.stage,
        entry: job.entry.as_deref(),
        macros: &job.macros,
        folders: &[".".to_owned(), places.shipped.display().to_string()],
        input: &input,
        output: &output.display().to_string(),
    };
    let mut started = Command::new(program);
    started.args(command.arguments(&told)).current_dir(&places.own);
    let length = || fs::metadata(&output).map_or(0, |file| file.len());
    let wrote_too_much = || length() > LARGEST_SPIRV as u64;
    let ended = run(started, &Bounds { time, cancel, wrote_too_much: &wrote_too_much });
    let (status, said) = ended.map_err(|given_up| gave_up(command, source, given_up))?;
    let said = places.with_shown_names(&said, source, included);
    if !status.success() {
        if is_crash(status) {
            return Err(faulty(command, format!("crashed ({})", in_words(status)), &said));
        }
        if let Some(line) = lacks_library(&said) {
            return Err(without_library(command, line));
        }
        let files: Vec<&SourceFile> = std::iter::once(source).chain(included).collect();
        let messages = complaints(&said, &files);
        return match messages.is_empty() {
            true => Err(faulty(command, format!("failed without a word ({})", in_words(status)), "")),
            false => Err(ShaderProblem::DoesNotCompile { messages }),
        };
    }
    if wrote_too_much() {
        return Err(gave_up(command, source, GivenUp::WroteTooMuch));
    }
    let bytes = match fs::read(&output) {
        Ok(bytes) if !bytes.is_empty() => bytes,
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            let what = format!("what its compiler `{}` wrote can't be read: {error}", command.program());
            return Err(ShaderProblem::Machine { what });
        }
        _ => return Err(faulty(command, "wrote nothing, and says that all is well".to_owned(), &said)),
    };
    super::module_words::words(&bytes)
        .map_err(|what| faulty(command, format!("wrote no SPIR-V that can be read: {what}"), &said))?;
    Ok(bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect())
}

/// A path that no program takes for an option.
fn as_argument(path: &Path) -> String {
    let whole = path.is_absolute() || path.starts_with("..") || path.starts_with(".");
    if whole { path.display().to_string() } else { format!("./{}", path.display()) }
}

/// That what a compiler wrote breaks a rule of SPIR-V.
pub(super) fn wrote_no_module(by: &str, what: &str) -> ShaderProblem {
    let what = format!("its compiler `{by}` wrote no SPIR-V that can be read: {what}");
    ShaderProblem::Compiler { what, help: String::new(), of_machine: false, choice: None }
}

fn not_there(command: &CompilerCommand) -> ShaderProblem {
    let program = command.program();
    let from = command.from().map_or_else(String::new, |from| format!("{from}; "));
    ShaderProblem::Compiler {
        what: format!("its compiler `{program}` isn't there"),
        help: format!("{from}a path names one outside of PATH"),
        of_machine: true,
        choice: Some(OutsideChoice::ShaderCompiler),
    }
}

/// slangc where it lacks a library that it calls unless it is told not to optimise.
fn without_library(command: &CompilerCommand, said: &str) -> ShaderProblem {
    let program = command.program();
    ShaderProblem::Compiler {
        what: format!("its compiler `{program}` lacks a library of its own"),
        help: format!("try `slangc -O0`, which calls none; it said: {}", cut(said)),
        of_machine: true,
        choice: Some(OutsideChoice::ShaderCompiler),
    }
}

/// A compiler that doesn't do what compilers do. What it printed may say why.
fn faulty(command: &CompilerCommand, what: String, said: &str) -> ShaderProblem {
    let said: Vec<String> = said.lines().map(str::trim_end).filter(|line| !line.is_empty()).take(8).map(cut).collect();
    let help = if said.is_empty() { String::new() } else { format!("it said: {}", said.join("\n")) };
    let what = format!("its compiler `{}` {what}", command.program());
    ShaderProblem::Compiler { what, help, of_machine: false, choice: None }
}

fn gave_up(command: &CompilerCommand, source: &SourceFile, given_up: GivenUp) -> ShaderProblem {
    let program = command.program();
    match given_up {
        GivenUp::CantStart(error) => ShaderProblem::Compiler {
            what: format!("its compiler `{program}` can't be started: {error}"),
            help: String::new(),
            of_machine: true,
            choice: Some(OutsideChoice::ShaderCompiler),
        },
        GivenUp::TooLong(time) => ShaderProblem::Compiler {
            what: format!(
                "its compiler `{program}` took longer than {} s for {}, which is its limit",
                time.as_secs_f64(),
                source.shown
            ),
            help: "it was ended".to_owned(),
            of_machine: false,
            choice: Some(OutsideChoice::ShaderTime),
        },
        GivenUp::WroteTooMuch => {
            faulty(command, format!("wrote more than the {LARGEST_SPIRV} bytes of SPIR-V that are taken"), "")
        }
        GivenUp::Cancelled => ShaderProblem::Machine { what: format!("its compiler `{program}` was cancelled") },
    }
}

/// Where files lie in the compiler's folder.
struct Places {
    /// The user's own; the compiler runs here.
    own: PathBuf,
    shipped: PathBuf,
}

impl Places {
    /// Files may lie above the pipeline's folder, if that was allowed: so it lies deep enough.
    fn new(folder: &Path, source: &SourceFile, included: &[SourceFile]) -> Places {
        let above = |file: &SourceFile| {
            Path::new(file.path.path()).components().filter(|it| matches!(it, Component::ParentDir)).count()
        };
        let deepest = std::iter::once(source).chain(included).map(above).max().unwrap_or(0);
        let own = (0..deepest).fold(folder.join("own"), |folder, _| folder.join("in"));
        Places { own, shipped: folder.join("shipped") }
    }

    /// The place of a file, as the compiler is told of it: by its path, or where that is absolute, by its name alone.
    fn within(&self, path: &FilePath) -> PathBuf {
        let name = Path::new(path.path());
        let name = if name.is_absolute() { Path::new(name.file_name().unwrap_or_default()) } else { name };
        match path {
            FilePath::Own(_) => name.to_owned(),
            FilePath::Shipped(_) => self.shipped.join(name),
        }
    }

    fn write(&self, source: &SourceFile, text: &str, included: &[SourceFile]) -> io::Result<()> {
        fs::create_dir_all(&self.own)?;
        fs::create_dir_all(&self.shipped)?;
        for (path, text) in included.iter().map(|file| (&file.path, &*file.text)).chain([(&source.path, text)]) {
            let place = self.own.join(self.within(path));
            if let Some(folder) = place.parent() {
                fs::create_dir_all(folder)?;
            }
            fs::write(place, text)?;
        }
        Ok(())
    }

    /// What the compiler said, with the names of files that messages show.
    fn with_shown_names(&self, said: &str, source: &SourceFile, included: &[SourceFile]) -> String {
        let own = self.own.display().to_string();
        let mut said = said.to_owned();
        for file in std::iter::once(source).chain(included) {
            let place = self.within(&file.path);
            let whole = self.own.join(&place).display().to_string();
            said = said.replace(&whole, &file.shown);
        }
        said.replace(&format!("{own}/"), "")
    }
}
