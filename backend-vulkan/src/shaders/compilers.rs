//! Where stages come from: from precompiled ones, or of a compiler: that of GLSL and HLSL in this process or in a helper
//! process, or a command.

use super::by_command;
use super::compile::{Includes, compile};
use super::files::{ShaderFiles, SourceFile};
use super::foreign_files::refuse_foreign;
use super::hlsl_words;
use super::messages::located;
use super::precompiled_shaders::PrecompiledShaders;
use super::shader_compilers::{CompilerCommand, ShaderCompilers};
use super::spirv_cache::{Inclusions, SpirvCache};
use super::text::included;
use super::validator::judge;
use super::view_semantics::placed;
use crate::base::{Cancel, digest};
use crate::process::{
    CompileFailure, CompileJob, CompilerAnswer, Helper, IncludedFile, LARGEST_SPIRV, Limits, NoAnswer, Verdict,
};
use framewright_graph::base::{FilePath, OutsideChoice, Quote, unix_lines};
use framewright_graph::shader::{FileLanguage, ShaderMessage, ShaderProblem};
use std::collections::HashMap;
use std::sync::Arc;

/// Where stages come from.
pub(super) struct Compilers {
    compiler: Compiler,
    /// Commands that compile other languages than GLSL.
    pub(super) commands: ShaderCompilers,
    /// Stages that need no compiler.
    pub(super) precompiled: Option<PrecompiledShaders>,
}

/// Where GLSL is compiled, and HLSL for which no command is named.
enum Compiler {
    /// In this process.
    Here,
    /// In a helper process, unless the cache holds it.
    Helper(Helper, Option<SpirvCache>),
}

impl Compilers {
    /// In this process, or in processes of a helper and with its cache.
    pub(super) fn new(helper: Option<&Helper>, precompiled: Option<PrecompiledShaders>) -> Compilers {
        let compiler = helper.map_or(Compiler::Here, |helper| {
            let cache = helper.cache().map(|cache| SpirvCache::new(cache, helper.path(), helper.limits()));
            Compiler::Helper(helper.clone(), cache)
        });
        Compilers { compiler, commands: ShaderCompilers::default(), precompiled }
    }

    /// Takes a stage, whose own file is `source`, from those that were compiled ahead, or compiles it.
    pub(super) fn compile(
        &mut self,
        job: &CompileJob,
        source: &SourceFile,
        files: &ShaderFiles,
    ) -> Result<CompilerAnswer, ShaderProblem> {
        let Some(precompiled) = self.precompiled.clone() else { return self.compile_now(job, source, files) };
        let command = job.language.and_then(|language| self.commands.of(language));
        let file = precompiled.file(job, command.map_or("", CompilerCommand::text), source, files);
        if let Some(spirv) = precompiled.read(&file)? {
            let verdict = judge(&spirv);
            return Ok(CompilerAnswer { spirv, verdict });
        }
        let compiled = self.compile_now(job, source, files)?;
        precompiled.add(&file, &compiled.spirv).map_err(|what| ShaderProblem::Machine { what })?;
        Ok(compiled)
    }

    fn compile_now(
        &mut self,
        job: &CompileJob,
        source: &SourceFile,
        files: &ShaderFiles,
    ) -> Result<CompilerAnswer, ShaderProblem> {
        match job.language.map(|language| (language, self.commands.of(language))) {
            Some((_, Some(command))) => return self.by_command(command, job, source, files),
            None | Some((FileLanguage::Hlsl, None)) => {}
            Some((language, None)) => return Err(by_command::no_command(language)),
        }
        // Which files the compiler's names stand for, and what they hold.
        let mut known = HashMap::from([(source.shown.clone(), (source.path.clone(), source.text.clone()))]);
        let mut refused = None;
        let mut includes = |from: &str, name: &str| -> Result<IncludedFile, String> {
            let from = known.get(from).map_or_else(|| source.path.clone(), |(path, _)| FilePath::clone(path));
            let found = files.included(&from, name).map_err(|no| {
                if no.of_machine {
                    refused.get_or_insert(no.what.clone());
                }
                no.what
            });
            let SourceFile { path, shown, text, once, .. } =
                found?.ok_or_else(|| format!("looked for it in {}", files.places(&from).join(", ")))?;
            known.insert(shown.clone(), (path, text.clone()));
            let text = if self.commands.knows_views(job.language) { text } else { placed(&text).into_owned() };
            // The stage's own file is there already.
            let text = if once.is_some() && once == source.once { String::new() } else { text };
            Ok(IncludedFile { shown, text, once })
        };
        let compiled = match &mut self.compiler {
            Compiler::Here => compile(job, &mut includes),
            Compiler::Helper(helper, cache) => {
                let mut ask = || compile_cached(helper, cache.as_mut(), job, &mut includes);
                // It may have died since the file before, of something that has nothing to do with this one.
                let answer = ask().or_else(|end| if end.may_be_chance() { ask() } else { Err(end) });
                answer.map_err(|end| no_answer(source, &end))?
            }
        };
        if let Some(what) = refused {
            return Err(ShaderProblem::Machine { what });
        }
        let text = |name: &str| known.get(name).map(|(_, text)| text.as_str());
        compiled.map_err(|failure| match failure {
            CompileFailure::NoCompiler => ShaderProblem::Unsupported { what: self.no_compiler(source) },
            // The compiler of HLSL has no words for this.
            CompileFailure::Messages(messages) if messages.is_empty() => {
                let entry = job.entry.as_deref().unwrap_or("main");
                let text = format!("{}: it has no entry point `{entry}`", source.shown);
                ShaderProblem::DoesNotCompile { messages: vec![ShaderMessage { text, quote: None, limit: None }] }
            }
            CompileFailure::Messages(messages) if job.language == Some(FileLanguage::Hlsl) => {
                let mut messages = located(hlsl_words::plain(messages), text);
                messages.push(hlsl_words::better_told());
                ShaderProblem::DoesNotCompile { messages }
            }
            CompileFailure::Messages(messages) => ShaderProblem::DoesNotCompile { messages: located(messages, text) },
            CompileFailure::OutOfMemory => of_file(source, "ran out of memory", None),
            CompileFailure::Internal(words) => of_file(source, &format!("failed: {words}"), None),
            CompileFailure::TooLarge(bytes) => ShaderProblem::Unsupported {
                what: format!(
                    "{}: it becomes {bytes} bytes of SPIR-V, and at most {LARGEST_SPIRV} are taken",
                    source.shown
                ),
            },
        })
    }

    /// Has a command compile a stage, unless the cache holds it.
    fn by_command(
        &self,
        command: &CompilerCommand,
        job: &CompileJob,
        source: &SourceFile,
        files: &ShaderFiles,
    ) -> Result<CompilerAnswer, ShaderProblem> {
        let included = included(files, source);
        refuse_foreign(files, source, &included)?;
        let (limits, cancel, cache) = match &self.compiler {
            Compiler::Helper(helper, _) => (helper.limits().clone(), helper.cancel().clone(), helper.cache()),
            Compiler::Here => (Limits::default(), Arc::<Cancel>::default(), None),
        };
        let mut cache = cache.zip(command.file()).map(|(cache, program)| {
            let texts: Vec<_> = included.iter().map(|file| (file.path.to_string(), unix_lines(&file.text))).collect();
            let identity = format!("{}; {}; {:016x}", command.identity(&program), command.text(), digest(&texts));
            SpirvCache::of_command(cache, identity)
        });
        let found = cache.as_ref().and_then(|cache| cache.find(job, &mut |_, _| Err(String::new())));
        if let Some(found) = found {
            return Ok(found);
        }
        let mut included = included;
        if !self.commands.knows_views(job.language) {
            included.iter_mut().for_each(|file| file.text = placed(&file.text).into_owned());
        }
        let spirv = by_command::compile(command, job, source, &included, limits.time, &cancel)?;
        // It is judged when an entry point was cut out of it.
        let answer = CompilerAnswer { spirv, verdict: Verdict::None };
        if let Some(cache) = &mut cache {
            cache.keep(job, Inclusions::of(job), &answer);
        }
        Ok(answer)
    }

    /// Whether what compiles a language knows the index of a view.
    pub(super) fn knows_views(&self, language: FileLanguage) -> bool {
        self.commands.knows_views(Some(language))
    }

    /// The name of the compiler of a language, for messages.
    pub(super) fn name_of(&self, language: FileLanguage) -> &str {
        self.commands.of(language).map_or("shaderc", CompilerCommand::program)
    }

    /// Whether the compiler of a language is told which entry point is wanted.
    pub(super) fn is_told_entry(&self, language: FileLanguage) -> bool {
        self.commands.of(language).is_none_or(CompilerCommand::is_told_entry)
    }

    /// That there is no compiler for a file.
    fn no_compiler(&self, source: &SourceFile) -> String {
        let program = match &self.compiler {
            Compiler::Here => "this program".to_owned(),
            Compiler::Helper(helper, _) => format!("the program {}", helper.path().display()),
        };
        let elsewhere = match &self.precompiled {
            Some(precompiled) => precompiled.lacks(),
            None => "no folder of precompiled shaders was named".to_owned(),
        };
        format!(
            "{}: it must be compiled, and {program} was built without the feature `shader-compiler`; {elsewhere}",
            source.shown
        )
    }
}

/// Takes a stage from the cache, or compiles it and keeps it there.
fn compile_cached(
    helper: &Helper,
    cache: Option<&mut SpirvCache>,
    job: &CompileJob,
    includes: &mut Includes<'_>,
) -> Result<Result<CompilerAnswer, CompileFailure>, NoAnswer> {
    let Some(cache) = cache else { return helper.compile(job, includes) };
    if let Some(compiled) = cache.find(job, includes) {
        return Ok(Ok(compiled));
    }
    let mut included = Inclusions::of(job);
    let compiled = helper.compile(job, &mut |from, name| {
        let file = includes(from, name)?;
        included.add(from, name, &file);
        Ok(file)
    })?;
    if let Ok(compiled) = &compiled {
        cache.keep(job, included, compiled);
    }
    Ok(compiled)
}

/// That the helper process gave no answer about a file.
fn no_answer(source: &SourceFile, end: &NoAnswer) -> ShaderProblem {
    let limit = match end {
        NoAnswer::TooLong(_) => Some(OutsideChoice::ShaderTime),
        NoAnswer::Stack(_) => Some(OutsideChoice::ShaderStack),
        NoAnswer::Memory(_) => Some(OutsideChoice::ShaderMemory),
        NoAnswer::Crashed(_) | NoAnswer::Cancelled => None,
        NoAnswer::Died(_) => {
            let what =
                format!("the helper process that compiles shaders {end}, and so did the one that took its place");
            return ShaderProblem::Machine { what };
        }
        NoAnswer::Unusable(_) => {
            return ShaderProblem::Machine { what: format!("the helper process that compiles shaders {end}") };
        }
    };
    of_file(source, &end.to_string(), limit)
}

/// The problem of a file as a whole. The compiler had no time to name a line: the file's first one stands for the file.
fn of_file(source: &SourceFile, what: &str, limit: Option<OutsideChoice>) -> ShaderProblem {
    let language = FileLanguage::of_file(source.path.path()).map_or("GLSL", |it| it.facts().name);
    let words = format!("the {language} compiler {what}");
    let quote = Quote {
        file: source.shown.clone(),
        line: 1,
        text: source.text.lines().next().unwrap_or_default().to_owned(),
        underlined: 0..0,
        remark: format!("{words}; on which line isn't known"),
    };
    let text = format!("{}: {words}", source.shown);
    ShaderProblem::DoesNotCompile { messages: vec![ShaderMessage { text, quote: Some(quote), limit }] }
}
