//! The files of stages: GLSL, or files of other languages, found by the names of shaders.

use super::files::{ShaderFiles, SourceFile};
use super::mentioned_names::MentionedNames;
use super::module_file::ModuleFile;
use super::text;
use crate::base::ShaderStage;
use framewright_graph::base::{FilePath, NoFile, unix_lines};
use framewright_graph::frame::Draw;
use framewright_graph::shader::{FileLanguage, ShaderProblem, StageName};
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// A stage's own file.
pub(super) struct StageSource {
    pub(super) found: SourceFile,
    /// The names in the file that decide how it is compiled for a pass.
    pub(super) mentioned: MentionedNames,
    pub(super) code: StageCode,
}

/// What a stage's file holds.
pub(super) enum StageCode {
    Glsl,
    /// SPIR-V.
    Module(Box<ModuleFile>),
    /// A text in another language.
    Text(FileLanguage),
}

impl StageCode {
    /// Whether an entry point is cut out of a module, which a stranger's compiler may have made.
    pub(super) const fn is_foreign(&self) -> bool {
        !matches!(self, StageCode::Glsl)
    }
}

/// The files of stages, each read once.
pub(super) struct StageSources {
    pub(super) files: ShaderFiles,
    known: HashMap<String, Result<Option<Arc<StageSource>>, ShaderProblem>>,
}

impl StageSources {
    pub(super) fn new(files: ShaderFiles) -> StageSources {
        StageSources { files, known: HashMap::new() }
    }

    /// The file of a stage, by its name; `None` if there is none.
    pub(super) fn source(&mut self, file: &str) -> Result<Option<Arc<StageSource>>, ShaderProblem> {
        if let Some(known) = self.known.get(file) {
            return known.clone();
        }
        let source = self.find_source(file);
        self.known.insert(file.to_owned(), source.clone());
        source
    }

    fn find_source(&self, file: &str) -> Result<Option<Arc<StageSource>>, ShaderProblem> {
        let path = FilePath::of_text(file);
        let (found, code) = if let Some(FileLanguage::Spirv) = FileLanguage::of_file(file) {
            let Some((mut found, bytes)) = self.files.find_module(&path)? else { return Ok(None) };
            let bad = |what: String| ShaderProblem::BadModule { what: format!("{}: {what}", found.shown) };
            let module = ModuleFile::read(&bytes).map_err(bad)?;
            found.inside = module.lines(&bytes);
            (found, StageCode::Module(Box::new(module)))
        } else {
            let Some(found) = self.files.find(&path)? else { return Ok(None) };
            (found, FileLanguage::of_file(file).map_or(StageCode::Glsl, StageCode::Text))
        };
        let mut mentioned = MentionedNames::by_stage(&self.files, &found);
        if let StageCode::Module(module) = &code {
            mentioned.view = module.knows_views();
        }
        Ok(Some(Arc::new(StageSource { found, mentioned, code })))
    }

    /// As [`super::ShaderLibrary::own_files`].
    pub(super) fn own_files(&self, from: &FilePath, name: &str) -> Vec<Vec<u8>> {
        if let StageName::File { file, .. } = StageName::of_text(name) {
            let beside =
                from.beside(&file).ok().filter(|it| it.folder().is_empty() || self.files.may_read(it.folder()));
            let mut places = beside.into_iter().chain([FilePath::Own(file.clone())]);
            if FileLanguage::of_file(&file) != Some(FileLanguage::Spirv) {
                let found = places.find_map(|place| self.files.find(&place).ok().flatten());
                return self.texts(found.into_iter());
            }
            let found = |place: FilePath| self.files.find_module(&place).ok().flatten().map(|(_, bytes)| bytes);
            return places.find_map(found).into_iter().collect();
        }
        let stages = ShaderStage::ALL.map(|stage| stage.file_of(name));
        let usual = Draw::usual_vertex_shaders().map(str::to_owned);
        let beside = stages.iter().filter_map(|file| from.beside(file).ok());
        let beside = beside.filter(|file| file.folder().is_empty() || self.files.may_read(file.folder()));
        let places = beside.chain(stages.iter().chain(&usual).map(|file| FilePath::Own((&**file).into())));
        self.texts(places.filter_map(|file| self.files.find(&file).ok().flatten()))
    }

    /// The texts of the user's own files among these, and of those that they include.
    fn texts(&self, found: impl Iterator<Item = SourceFile>) -> Vec<Vec<u8>> {
        let own = |file: &SourceFile| matches!(file.path, FilePath::Own(_));
        let found = found.filter(own);
        let with_included = found.flat_map(|file| {
            let included = text::included(&self.files, &file);
            std::iter::once(file).chain(included)
        });
        let texts = with_included.filter(own).map(|file| unix_lines(&file.text).into_owned().into_bytes());
        texts.collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// That there is no such stage.
    pub(super) fn lacking(&self, name: &StageName, stage: ShaderStage) -> ShaderProblem {
        self.missing(&FilePath::of_text(&name.to_string()), name, stage)
    }

    /// The stage `name` as the file `from` calls it, by the name under which it is found.
    pub(super) fn located(
        &mut self,
        from: &FilePath,
        name: &StageName,
        stage: ShaderStage,
    ) -> Result<Option<StageName>, ShaderProblem> {
        let (file, entry) = match name {
            StageName::Glsl(name) => (name, None),
            StageName::File { file, entry } => (file, entry.clone()),
        };
        let named = |file: &str| match name {
            StageName::Glsl(_) => StageName::Glsl(file.into()),
            StageName::File { .. } => StageName::File { file: file.into(), entry: entry.clone() },
        };
        let none = |_: NoFile| ShaderProblem::Unsupported { what: format!("`{file}` is no name of a shader") };
        let beside = match from {
            FilePath::Shipped(_) => FilePath::Shipped(file.clone()),
            FilePath::Own(_) => from.beside(file).map_err(none)?,
        };
        // A file that the user named by hand may lie in a folder outside: nothing is looked for there.
        if from.folder().is_empty() || self.files.may_read(from.folder()) {
            let found = named(&beside.to_string());
            if self.source(&file_of(&found, stage))?.is_some() {
                return Ok(Some(found));
            }
        }
        match from {
            FilePath::Own(_) if self.source(&file_of(name, stage))?.is_some() => Ok(Some(name.clone())),
            _ => Ok(None),
        }
    }

    /// That the file `from` names no shader that there is.
    pub(super) fn missing(&self, from: &FilePath, name: &StageName, stage: ShaderStage) -> ShaderProblem {
        let looked_in = self.files.places(from);
        let known = match name {
            StageName::Glsl(_) => self.files.known_shaders(from, stage.facts().ending),
            StageName::File { file, .. } => {
                let ending = FileLanguage::of_file(file).map_or("", |language| language.facts().ending);
                let known = self.files.known_shaders(from, ending).into_iter();
                // Those that are included are no shaders.
                known.filter(|name| !name.starts_with("include/")).map(|name| name + ending).collect()
            }
        };
        ShaderProblem::Missing { looked_in, known }
    }
}

/// The file of a stage.
pub(super) fn file_of(name: &StageName, stage: ShaderStage) -> String {
    match name {
        StageName::Glsl(name) => stage.file_of(name),
        StageName::File { file, .. } => file.to_string(),
    }
}
