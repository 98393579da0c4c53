//! Stages that were compiled ahead, as files of SPIR-V in a folder or in memory: programs need no compiler then.

use super::files::{NoShader, ShaderFiles, SourceFile};
use super::text::included;
use crate::base::with_usual_rights;
use crate::process::{CompileJob, LARGEST_SPIRV};
use framewright_graph::base::{ReadFiles, is_of_machine, unix_lines};
use framewright_graph::shader::{FileLanguage, ShaderProblem};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The first word of SPIR-V.
const MAGIC: u32 = 0x0723_0203;

/// Compiled stages, one file of SPIR-V each: of a folder, or in memory. A file's name holds a digest of all that it was compiled from: the
/// stage's text and macros, the files that it includes or may include, and the version of this crate. Behind it stands one of the command, if
/// a command compiled it; a program that names no command takes what any one made. A stage whose text has changed since, or that a
/// pass needs with other macros, has another name. Line endings don't count.
///
/// Drivers are given what such files hold: they must be trusted as the program itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PrecompiledShaders {
    place: Place,
    adds: bool,
}

/// Where files of compiled stages are.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Place {
    Folder(PathBuf),
    /// By their names.
    Memory(Arc<BTreeMap<Arc<str>, Arc<[u8]>>>),
}

impl PrecompiledShaders {
    /// The stages in this folder are taken from there. Others are compiled, where the program has a compiler.
    #[must_use]
    pub fn in_folder(folder: impl Into<PathBuf>) -> PrecompiledShaders {
        PrecompiledShaders { place: Place::Folder(folder.into()), adds: false }
    }

    /// The stages are those of such a folder's files, which the program carries within itself: each file's name without folder, and its bytes.
    /// Others are compiled, where the program has a compiler.
    #[must_use]
    pub fn in_memory(files: impl IntoIterator<Item = (Arc<str>, Arc<[u8]>)>) -> PrecompiledShaders {
        PrecompiledShaders { place: Place::Memory(Arc::new(files.into_iter().collect())), adds: false }
    }

    /// Stages that are compiled are added to the folder, which is made if there is none. Nothing is added to files in memory.
    #[must_use]
    pub fn adding(self) -> PrecompiledShaders {
        PrecompiledShaders { adds: self.folder().is_some(), ..self }
    }

    /// The folder; `None`: the files are in memory.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        match &self.place {
            Place::Folder(folder) => Some(folder),
            Place::Memory(_) => None,
        }
    }

    /// That no file has the SPIR-V of a stage, in words.
    pub(super) fn lacks(&self) -> String {
        match &self.place {
            Place::Folder(folder) => format!("{} holds no SPIR-V of it as this pass needs it", folder.display()),
            Place::Memory(files) => {
                format!("none of {} precompiled shaders in memory is SPIR-V of it as this pass needs it", files.len())
            }
        }
    }

    /// The name of the file of a stage, whether it is there or not. `command` compiles it; empty where shaderc or none does.
    pub(super) fn file(&self, job: &CompileJob, command: &str, source: &SourceFile, files: &ShaderFiles) -> String {
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
            return format!("{begun}.{by}.spv");
        }
        let file = format!("{begun}.spv");
        // Shaderc compiles what is to be added; else what any command made is taken: the files are there so that none is needed.
        let by_shaderc = matches!(job.language, None | Some(FileLanguage::Hlsl));
        if job.language.is_none() || self.adds && by_shaderc || self.has(&file) {
            return file;
        }
        self.by_any_command(&begun).unwrap_or(file)
    }

    fn has(&self, file: &str) -> bool {
        match &self.place {
            Place::Folder(folder) => folder.join(file).exists(),
            Place::Memory(files) => files.contains_key(file),
        }
    }

    /// The first file of a stage that a command made.
    fn by_any_command(&self, begun: &str) -> Option<String> {
        let of_stage = |name: &String| {
            let rest = name.strip_prefix(begun).and_then(|rest| rest.strip_prefix('.'));
            rest.and_then(|rest| rest.strip_suffix(".spv")).is_some_and(|by| !by.is_empty())
        };
        match &self.place {
            Place::Folder(folder) => {
                let made = fs::read_dir(folder).ok()?.flatten();
                made.filter_map(|entry| entry.file_name().into_string().ok()).filter(of_stage).min()
            }
            Place::Memory(files) => files.keys().map(|name| name.to_string()).find(of_stage),
        }
    }

    /// The SPIR-V in the file of a stage; `None` if there is no such file.
    ///
    /// # Errors
    /// The file is no SPIR-V, or can't be read.
    pub(super) fn read(&self, file: &str) -> Result<Option<Vec<u32>>, ShaderProblem> {
        match &self.place {
            Place::Folder(folder) => read_file(&folder.join(file)),
            Place::Memory(files) => {
                let read = |bytes| words_of(bytes).ok_or_else(|| no_spirv(&format!("{file} in memory")));
                files.get(file).map(|bytes| read(bytes)).transpose()
            }
        }
    }

    /// Adds a stage that was compiled, if that is wanted.
    ///
    /// # Errors
    /// In words: the file can't be written.
    pub(super) fn add(&self, file: &str, spirv: &[u32]) -> Result<(), String> {
        let Some(folder) = self.folder().filter(|_| self.adds) else { return Ok(()) };
        let bytes: Vec<u8> = spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
        let file = folder.join(file);
        let written = || -> io::Result<()> {
            fs::create_dir_all(folder)?;
            let mut unfinished = tempfile::Builder::new();
            with_usual_rights(&mut unfinished);
            let mut unfinished = unfinished.tempfile_in(folder)?;
            unfinished.write_all(&bytes)?;
            unfinished.persist(&file).map_err(|error| error.error)?;
            Ok(())
        };
        written().map_err(|error| format!("the precompiled shader {} can't be written: {error}", file.display()))
    }
}

/// The SPIR-V in a file; `None` if there is none.
fn read_file(file: &Path) -> Result<Option<Vec<u32>>, ShaderProblem> {
    let unreadable = |error: io::Error| {
        let what = format!("the precompiled shader {} can't be read: {error}", file.display());
        NoShader { what, of_machine: is_of_machine(&error) }
    };
    let opened = match ReadFiles::default().open("a precompiled shader", file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        opened => opened.map_err(unreadable)?,
    };
    let mut bytes = Vec::new();
    opened.take(LARGEST_SPIRV as u64 + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    words_of(&bytes).map(Some).ok_or_else(|| no_spirv(&file.display().to_string()))
}

fn no_spirv(file: &str) -> ShaderProblem {
    NoShader::from(format!("the precompiled shader {file} is no SPIR-V")).into()
}

/// The words of SPIR-V; `None`: the bytes are none.
fn words_of(bytes: &[u8]) -> Option<Vec<u32>> {
    let (words, rest) = bytes.as_chunks();
    let words: Vec<u32> = words.iter().map(|word| u32::from_le_bytes(*word)).collect();
    (words.first() == Some(&MAGIC) && rest.is_empty() && bytes.len() <= LARGEST_SPIRV).then_some(words)
}

/// The first bytes of a digest in letters.
fn letters(digest: Sha256, bytes: usize) -> String {
    digest.finalize().iter().take(bytes).map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_added_to_files_in_memory() {
        let files = || PrecompiledShaders::in_memory([]);
        assert_eq!(files().adding(), files());
        assert_ne!(PrecompiledShaders::in_folder("it").adding(), PrecompiledShaders::in_folder("it"));
    }
}
