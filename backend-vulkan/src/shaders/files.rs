//! Where shader sources are found: folders on disk, and the texts that are shipped with the program.

use super::module_lines::ModuleLines;
use super::text::{is_once, without_comments};
use crate::base::digest;
use crate::process::LARGEST_SPIRV;
use framewright_graph::base::{FileIdentity, FilePath, NoFile, NoText, Root, text_of, without_mark};
use framewright_graph::shader::ShaderProblem;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

/// Larger files are no shaders.
const MAX_SOURCE_BYTES: usize = 1 << 20;

/// The name in messages of the place of shipped shaders.
const SHIPPED: &str = "the shipped shaders";

/// Where shaders and what they include are looked for.
pub(super) struct ShaderFiles {
    /// Folders on disk, in this order.
    pub(super) roots: Vec<Root>,
    /// File name and text.
    pub(super) shipped: &'static [(&'static str, &'static str)],
    /// SPIR-V of the program, by the names of files.
    pub(super) modules: Vec<(Arc<str>, Arc<[u8]>)>,
}

/// A source text.
#[derive(Debug)]
pub(super) struct SourceFile {
    /// The file's path.
    pub(super) path: FilePath,
    /// The name that messages show.
    pub(super) shown: String,
    /// GLSL.
    pub(super) text: String,
    /// What tells it from other files, if it says `#pragma once`.
    pub(super) once: Option<u64>,
    /// Of SPIR-V, the lines of what it was compiled of.
    pub(super) inside: ModuleLines,
}

/// Why a file that is there is no shader.
#[derive(Debug, Clone)]
pub(super) struct NoShader {
    /// The reason, in words.
    pub(super) what: String,
    /// Whether nothing is wrong with the file: the machine doesn't let it be read.
    pub(super) of_machine: bool,
}

impl From<String> for NoShader {
    fn from(what: String) -> NoShader {
        NoShader { what, of_machine: false }
    }
}

impl From<NoShader> for ShaderProblem {
    fn from(NoShader { what, of_machine }: NoShader) -> ShaderProblem {
        if of_machine { ShaderProblem::Machine { what } } else { ShaderProblem::Unsupported { what } }
    }
}

impl ShaderFiles {
    /// The file `name` of a pipeline (`lit.frag`), or else the shipped file of that name; `None` if there is neither.
    ///
    /// # Errors
    /// If the name leads out of the folders, or a file of that name can't be a shader.
    pub(super) fn find(&self, name: &FilePath) -> Result<Option<SourceFile>, NoShader> {
        let own = match name {
            FilePath::Own(own) => self.on_disk(own)?,
            FilePath::Shipped(_) => None,
        };
        Ok(own.or_else(|| self.shipped(name.path())))
    }

    /// The file of SPIR-V `name` of a pipeline, or else the program's of that name, with its bytes; `None` if there is neither.
    ///
    /// # Errors
    /// Those of [`ShaderFiles::find`].
    pub(super) fn find_module(&self, name: &FilePath) -> Result<Option<(SourceFile, Vec<u8>)>, NoShader> {
        let FilePath::Own(path) = name else { return Ok(None) };
        let source = |shown: String| SourceFile {
            path: path.as_ref().into(),
            shown,
            text: String::new(),
            once: None,
            inside: ModuleLines::default(),
        };
        if let Some((bytes, _, shown)) = self.bytes_on_disk(path, LARGEST_SPIRV)? {
            return Ok(Some((source(shown.replace('\0', "")), bytes)));
        }
        let brought = self.modules.iter().find(|(brought, _)| **brought == **path);
        Ok(brought.map(|(name, bytes)| (source(name.to_string()), bytes.to_vec())))
    }

    /// The file that the shader file `from` includes as `name`: beside it, then in the pipeline's folder, then shipped;
    /// `None` if there is none. What a shipped file includes is shipped.
    ///
    /// # Errors
    /// Those of [`ShaderFiles::find`].
    pub(super) fn included(&self, from: &FilePath, name: &str) -> Result<Option<SourceFile>, NoShader> {
        let whole = match from {
            FilePath::Own(_) => FilePath::Own("".into()),
            FilePath::Shipped(_) => FilePath::Shipped("".into()),
        };
        let refused = |problem: NoFile| format!("`{name}` {problem}");
        let places = [from.beside(name).map_err(refused)?, whole.beside(name).map_err(refused)?];
        for place in &places {
            if let FilePath::Own(own) = place
                && let Some(found) = self.on_disk(own)?
            {
                return Ok(Some(found));
            }
        }
        Ok(places.iter().find_map(|place| self.shipped(place.path())))
    }

    /// The file of that path in the first folder that has one.
    fn on_disk(&self, path: &str) -> Result<Option<SourceFile>, NoShader> {
        let Some((bytes, found, shown)) = self.bytes_on_disk(path, MAX_SOURCE_BYTES)? else { return Ok(None) };
        let text = text(&bytes, &shown)?;
        let once = FileIdentity::of(&found).filter(|_| is_once(&text)).map(|file| digest(&file));
        let shown = shown.replace('\0', "");
        Ok(Some(SourceFile { path: path.into(), shown, text, once, inside: ModuleLines::default() }))
    }

    /// The bytes of the file of that path in the first folder that has one, at most so many, with its place, and its name in messages.
    fn bytes_on_disk(&self, path: &str, most: usize) -> Result<Option<(Vec<u8>, PathBuf, String)>, NoShader> {
        for root in &self.roots {
            let shown = root.folder().join(path).display().to_string();
            let read = root.locate(path).and_then(|found| Ok((root.read(&found, most)?, found)));
            return match read {
                Ok((bytes, found)) => Ok(Some((bytes, found, shown))),
                Err(NoFile::Missing) => continue,
                Err(NoFile::TooLarge { bytes, limit }) => {
                    Err(format!("{shown} has {bytes} bytes, more than the {limit} of a shader").into())
                }
                Err(other) => Err(NoShader { what: format!("{shown} {other}"), of_machine: other.is_of_machine() }),
            };
        }
        Ok(None)
    }

    fn shipped(&self, name: &str) -> Option<SourceFile> {
        let (name, text) = self.shipped.iter().find(|(shipped, _)| *shipped == name)?;
        let path = FilePath::Shipped((*name).into());
        let once = is_once(text).then(|| digest(name));
        let inside = ModuleLines::default();
        Some(SourceFile { shown: path.to_string(), path, text: (*text).to_owned(), once, inside })
    }

    /// Whether files in that folder may be read.
    pub(super) fn may_read(&self, folder: &str) -> bool {
        let inside = |root: &Root| !matches!(root.locate(folder), Err(NoFile::Outside { .. }));
        self.roots.iter().any(inside)
    }

    /// The places where something that the file `from` names is looked for, for messages.
    pub(super) fn places(&self, from: &FilePath) -> Vec<String> {
        let shipped = (!self.shipped.is_empty()).then(|| SHIPPED.to_owned());
        let FilePath::Own(_) = from else { return shipped.into_iter().collect() };
        let shown = |folder: &str| {
            let folder = folder.to_owned();
            self.roots.iter().map(move |root| root.folder().join(&folder).components().collect::<PathBuf>())
        };
        let beside = Some(from.folder()).filter(|folder| !folder.is_empty() && self.may_read(folder));
        let beside = beside.into_iter().flat_map(shown);
        let folders = beside.chain(shown("")).map(|folder| folder.display().to_string());
        folders.chain(shipped).collect()
    }

    /// Names of all shaders whose files end in `ending` where something that the file `from` names is looked for, sorted, without
    /// the ending.
    pub(super) fn known_shaders(&self, from: &FilePath, ending: &str) -> Vec<String> {
        let own = matches!(from, FilePath::Own(_));
        let beside = Some(from.folder()).filter(|folder| !folder.is_empty() && self.may_read(folder));
        let folders = self.roots.iter().flat_map(|root| {
            let beside = beside.map(|folder| root.folder().join(folder));
            beside.into_iter().chain([root.folder().to_owned()])
        });
        let on_disk = folders.filter(|_| own).filter_map(|folder| fs::read_dir(folder).ok());
        let on_disk = on_disk.flatten().flatten().filter_map(|entry| entry.file_name().into_string().ok());
        let brought = self.modules.iter().filter(|_| own).map(|(name, _)| name.to_string());
        let shipped = self.shipped.iter().map(|(name, _)| (*name).to_owned()).chain(brought);
        let mut names: Vec<String> =
            on_disk.chain(shipped).filter_map(|file| file.strip_suffix(ending).map(str::to_owned)).collect();
        names.sort();
        names.dedup();
        names
    }
}

/// The text of a shader's file. In comments any byte may stand, as those of old encodings do.
fn text(bytes: &[u8], shown: &str) -> Result<String, NoShader> {
    let text = match text_of(bytes) {
        Ok(text) => text.to_owned(),
        Err(NoText::Byte { .. }) => {
            let text = without_mark(&String::from_utf8_lossy(bytes)).to_owned();
            let odd = without_comments(&text).lines().position(|line| line.contains(char::REPLACEMENT_CHARACTER));
            if let Some(line) = odd {
                return Err(format!("{shown}:{}: this is not UTF-8, which only comments may hold", line + 1).into());
            }
            text
        }
        Err(encoding @ NoText::Encoding(_)) => return Err(format!("{shown} is not text: {encoding}").into()),
    };
    if text.contains('\0') {
        return Err(format!("{shown} contains a zero byte").into());
    }
    Ok(text)
}
