//! Stages that were compiled ahead, as files of SPIR-V: programs need no compiler then.

use super::files::{NoShader, ShaderFiles, SourceFile};
use super::text::included;
use crate::base::with_usual_rights;
use crate::process::{CompileJob, LARGEST_SPIRV};
use framewright_graph::base::{ReadFiles, is_of_machine, unix_lines};
use framewright_graph::shader::{FileLanguage, ShaderProblem};
use sha2::{Digest, Sha256};
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// The first word of SPIR-V.
const MAGIC: u32 = 0x0723_0203;

/// A folder of compiled stages, one file of SPIR-V each. A file's name holds a digest of all that it was compiled from: the stage's
/// text and macros, the files that it includes or may include, and the version of this crate. Behind it stands one of the command, if
/// a command compiled it; a program that names no command takes what any one made. A stage whose text has changed since, or that a
/// pass needs with other macros, has another name. Line endings don't count.
///
/// Drivers are given what such files hold: they must be trusted as the program itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PrecompiledShaders {
    folder: PathBuf,
    adds: bool,
}

impl PrecompiledShaders {
    /// The stages in this folder are taken from there. Others are compiled, where the program has a compiler.
    #[must_use]
    pub fn in_folder(folder: impl Into<PathBuf>) -> PrecompiledShaders {
        PrecompiledShaders { folder: folder.into(), adds: false }
    }

    /// Stages that are compiled are added to the folder, which is made if there is none.
    #[must_use]
    pub fn adding(self) -> PrecompiledShaders {
        PrecompiledShaders { adds: true, ..self }
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The file of a stage, whether it is there or not. `command` compiles it; empty where shaderc or none does.
    pub(super) fn file(&self, job: &CompileJob, command: &str, source: &SourceFile, files: &ShaderFiles) -> PathBuf {
        let mut digest = Sha256::new();
        let mut add = |text: &str| {
            let text = unix_lines(text);
            digest.update((text.len() as u64).to_le_bytes());
            digest.update(&*text);
        };
        [env!("CARGO_PKG_VERSION"), job.stage.facts().name, &job.text].into_iter().for_each(&mut add);
        if let Some(language) = job.language {
            [language.facts().name, job.entry.as_deref().unwrap_or_default()].into_iter().for_each(&mut add);
        }
        job.macros.iter().flat_map(|(name, value)| [name, value]).for_each(|text| add(text));
        included(files, source).iter().for_each(|file| add(&file.text));
        // For people alone.
        let name = Path::new(source.path.path()).file_name().unwrap_or_default().to_string_lossy();
        let begun = format!("{name}.{}", letters(digest, 16));
        if !command.is_empty() {
            let by = letters(Sha256::new_with_prefix(command), 8);
            return self.folder.join(format!("{begun}.{by}.spv"));
        }
        let file = self.folder.join(format!("{begun}.spv"));
        // Shaderc compiles what is to be added; else what any command made is taken: the folder is there so that none is needed.
        let by_shaderc = matches!(job.language, None | Some(FileLanguage::Hlsl));
        if job.language.is_none() || self.adds && by_shaderc || file.exists() {
            return file;
        }
        self.by_any_command(&begun).unwrap_or(file)
    }

    /// The first file of a stage that a command made.
    fn by_any_command(&self, begun: &str) -> Option<PathBuf> {
        let made = fs::read_dir(&self.folder).ok()?.flatten().filter_map(|entry| entry.file_name().into_string().ok());
        let of_stage = made.filter(|name| {
            let rest = name.strip_prefix(begun).and_then(|rest| rest.strip_prefix('.'));
            rest.and_then(|rest| rest.strip_suffix(".spv")).is_some_and(|by| !by.is_empty())
        });
        of_stage.min().map(|name| self.folder.join(name))
    }

    /// The SPIR-V in the file of a stage; `None` if there is no such file.
    ///
    /// # Errors
    /// The file is no SPIR-V, or can't be read.
    pub(super) fn read(file: &Path) -> Result<Option<Vec<u32>>, ShaderProblem> {
        let problem = |what: &str| format!("the precompiled shader {} {what}", file.display());
        let unreadable = |error: io::Error| {
            let what = problem(&format!("can't be read: {error}"));
            NoShader { what, of_machine: is_of_machine(&error) }
        };
        let opened = match ReadFiles::default().open("a precompiled shader", file) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            opened => opened.map_err(unreadable)?,
        };
        let mut bytes = Vec::new();
        opened.take(LARGEST_SPIRV as u64 + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        let (words, rest) = bytes.as_chunks();
        let words: Vec<u32> = words.iter().map(|word| u32::from_le_bytes(*word)).collect();
        match words.first() {
            Some(&MAGIC) if rest.is_empty() && bytes.len() <= LARGEST_SPIRV => Ok(Some(words)),
            _ => Err(NoShader::from(problem("is no SPIR-V")).into()),
        }
    }

    /// Adds a stage that was compiled, if that is wanted.
    ///
    /// # Errors
    /// In words: the file can't be written.
    pub(super) fn add(&self, file: &Path, spirv: &[u32]) -> Result<(), String> {
        if !self.adds {
            return Ok(());
        }
        let bytes: Vec<u8> = spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
        let written = || -> io::Result<()> {
            fs::create_dir_all(&self.folder)?;
            let mut unfinished = tempfile::Builder::new();
            with_usual_rights(&mut unfinished);
            let mut unfinished = unfinished.tempfile_in(&self.folder)?;
            unfinished.write_all(&bytes)?;
            unfinished.persist(file).map_err(|error| error.error)?;
            Ok(())
        };
        written().map_err(|error| format!("the precompiled shader {} can't be written: {error}", file.display()))
    }
}

/// The first bytes of a digest in letters.
fn letters(digest: Sha256, bytes: usize) -> String {
    digest.finalize().iter().take(bytes).map(|byte| format!("{byte:02x}")).collect()
}
