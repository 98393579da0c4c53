//! Stages in files that are named with their endings: an entry point is cut out of SPIR-V, which is the file's own or compiled first.

use super::by_command;
use super::compilers::Compilers;
use super::constants::Constants;
use super::eyes::{ASKING, EYE};
use super::eyes_of_modules;
use super::files::{ShaderFiles, SourceFile};
use super::macros::{Macros, in_hlsl, is_of_glsl};
use super::module_file::{CutModule, ModuleFile};
use super::push_constants::PushedBy;
use super::stage_sources::{StageCode, StageSource};
use super::text;
use super::view_semantics::placed;
use crate::base::ShaderStage;
use crate::process::CompileJob;
use framewright_graph::base::nearest;
use framewright_graph::shader::{FileLanguage, ShaderProblem};

/// A stage that is wanted of a file.
pub(super) struct FileStage<'s> {
    pub(super) file: &'s str,
    /// `None`: the only one of the stage, or in HLSL `main`.
    pub(super) entry: Option<&'s str>,
    pub(super) stage: ShaderStage,
    pub(super) macros: &'s Macros,
    /// Values of its specialization constants.
    pub(super) constants: &'s Constants,
    /// Whether it draws for both eyes at once.
    pub(super) both: bool,
    /// Whose its push constants are.
    pub(super) pushed: &'s PushedBy,
}

impl FileStage<'_> {
    /// Its SPIR-V, as the compiler of GLSL would have written it.
    ///
    /// # Errors
    /// What is wrong with the file, or with its compiler.
    pub(super) fn compiled(
        &self,
        source: &StageSource,
        compilers: &mut Compilers,
        files: &ShaderFiles,
    ) -> Result<CutModule, ShaderProblem> {
        let FileStage { file, entry, stage, macros, constants, pushed, .. } = *self;
        let language = match &source.code {
            StageCode::Module(module) => return module.cut(file, stage, entry, constants, pushed),
            StageCode::Text(language) => *language,
            StageCode::Glsl => return Err(ShaderProblem::Unsupported { what: format!("{file}: it is GLSL") }),
        };
        let found = &source.found;
        let entry = entry.or((language == FileLanguage::Hlsl).then_some("main"));
        let job = CompileJob {
            stage,
            language: Some(language),
            entry: entry.map(str::to_owned),
            shown: found.shown.clone(),
            text: self.text(language, found, files, compilers.knows_views(language)),
            macros: macros
                .iter()
                .filter(|(name, _)| !is_of_glsl(name))
                .map(|(name, value)| (name.clone(), in_hlsl(value)))
                .collect(),
        };
        let answer = compilers.compile(&job, found, files);
        let answer = answer.map_err(|problem| self.misspelt(entry, found, files).unwrap_or(problem))?;
        let bad = |what: String| by_command::wrote_no_module(compilers.name_of(language), &what);
        let mut module = ModuleFile::compiled(&answer.spirv).map_err(bad)?;
        if language == FileLanguage::Hlsl {
            module.spread_registers();
        }
        // Compilers that are told of one entry point may call it `main`.
        let renamed = compilers.is_told_entry(language) && module.only_entry(stage) == Some("main");
        module.cut(file, stage, entry.filter(|_| !renamed), constants, pushed)
    }

    /// The text that is compiled. Where it asks for the eye of a draw for both, it begins with what stands for that.
    /// `knows_views`: its compiler knows the index of a view.
    fn text(&self, language: FileLanguage, found: &SourceFile, files: &ShaderFiles, knows_views: bool) -> String {
        let told = self.both && (language == FileLanguage::Hlsl || language == FileLanguage::Slang);
        let asks = || {
            self.macros.iter().any(|(_, value)| value.contains(EYE))
                || text::place(files, found, |word| ASKING.contains(&word)).is_some()
        };
        let text = if knows_views { found.text.clone() } else { placed(&found.text).into_owned() };
        if told && asks() { eyes_of_modules::declared() + &text } else { text }
    }

    /// That the file has no such entry point, if a function there has nearly its name. The compiler's own words are of no help then.
    fn misspelt(&self, entry: Option<&str>, found: &SourceFile, files: &ShaderFiles) -> Option<ShaderProblem> {
        let named = entry?;
        let included = text::included(files, found);
        let texts: Vec<&str> = std::iter::once(found).chain(&included).map(|file| &*file.text).collect();
        let functions: Vec<String> = texts.iter().flat_map(|text| text::functions(text)).collect();
        if texts.iter().any(|text| text::words(text).any(|word| word == named)) {
            return None;
        }
        let meant = nearest(named, functions.iter().map(String::as_str))?.to_owned();
        Some(ShaderProblem::EntryPoint {
            file: self.file.into(),
            stage: self.stage.facts().name,
            named: Some(named.to_owned()),
            of_stage: [meant].into(),
            others: [].into(),
        })
    }
}
