//! Scenes from files.

#[cfg(feature = "gltf")]
use super::gltf;
use super::model::Scene;
use super::{limits, text};
#[cfg(feature = "gltf")]
use framewright_graph::base::Root;
use framewright_graph::base::{Diagnostic, NoText, ReadFiles, Sources, is_of_machine, render, text_of};
use std::path::{Path, PathBuf};

/// Why a file is no scene. The sentences name the file as it was given, escaped.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The name ends in neither `.glb` nor `.gltf` nor `.ron`.
    #[error("{}: a scene is a .glb, .gltf or .ron file", shown(path))]
    Kind {
        /// The file.
        path: PathBuf,
    },
    /// The file can't be read.
    #[error("{}: {source}", shown(path))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The file is too large.
    #[error("{}: a scene of this kind has at most {limit} bytes; this has more", shown(path))]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Bytes allowed.
        limit: u64,
    },
    /// A `.ron` file that isn't text.
    #[error("{}: this is not text: {}", shown(path), why.brief())]
    NotText {
        /// The file.
        path: PathBuf,
        /// The encoding that it has, or the first byte that isn't text.
        why: NoText,
    },
    /// A `.ron` file with mistakes; rendered with their places.
    #[error("{}", render(sources, mistakes))]
    Text {
        /// The text that the mistakes point into.
        sources: Sources,
        /// At least one.
        mistakes: Vec<Diagnostic>,
    },
    /// A `.glb` or `.gltf` file, and this program was built without the feature `gltf`.
    #[error("{}: this program reads no glTF: build it with the feature `gltf` of Framewright", shown(path))]
    LeftOut {
        /// The file.
        path: PathBuf,
    },
    /// A `.glb` or `.gltf` file with a mistake.
    #[cfg(feature = "gltf")]
    #[error("{}: {error}", shown(path))]
    Gltf {
        /// The file.
        path: PathBuf,
        /// The mistake.
        error: gltf::GltfError,
    },
}

impl SceneError {
    /// Whether nothing is wrong with the files: the machine doesn't let one be read, or this program has no reader for it.
    #[must_use]
    pub fn is_of_machine(&self) -> bool {
        match self {
            SceneError::Unreadable { source, .. } => is_of_machine(source),
            SceneError::LeftOut { .. } => true,
            #[cfg(feature = "gltf")]
            SceneError::Gltf { error, .. } => error.is_of_machine(),
            _ => false,
        }
    }
}

/// Reads the scene in a file: glTF ([`super::gltf`]) where its name ends in `.glb` or `.gltf`, our own format
/// ([`super::text`]) where it ends in `.ron`.
///
/// # Errors
/// [`SceneError`], with the mistake and its place.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    load_recorded(path, &ReadFiles::default())
}

/// Like [`load`], and records in `read` the file and all files that it names.
///
/// # Errors
/// Those of [`load`].
pub fn load_recorded(path: &Path, read: &ReadFiles) -> Result<Scene, SceneError> {
    let bytes = |limit| bytes(path, limit, read);
    let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    match extension.as_deref() {
        #[cfg(not(feature = "gltf"))]
        Some("glb" | "gltf") => Err(SceneError::LeftOut { path: path.into() }),
        #[cfg(feature = "gltf")]
        Some(ending @ ("glb" | "gltf")) => {
            let beside = Root::new(path.parent().unwrap_or(Path::new("")).to_owned());
            let beside = beside.recorded(read, "a file of the scene");
            let scene = match ending {
                "glb" => gltf::read_glb(&bytes(limits::FILE_BYTES)?, Some(&beside)),
                _ => gltf::read_json(&bytes(limits::JSON_BYTES as u64)?, Some(&beside)),
            };
            scene.map_err(|error| SceneError::Gltf { path: path.into(), error })
        }
        Some("ron") => {
            let bytes = bytes(limits::TEXT_BYTES)?;
            let text = text_of(&bytes).map_err(|why| SceneError::NotText { path: path.into(), why })?.to_owned();
            let mut sources = Sources::default();
            let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            text::read(&mut sources, &path.to_string_lossy(), &name, text)
                .map_err(|mistakes| SceneError::Text { sources, mistakes })
        }
        _ => Err(SceneError::Kind { path: path.into() }),
    }
}

/// The whole file, if it isn't larger than `limit`. Some systems' own files tell no size, so the bytes read count.
fn bytes(path: &Path, limit: u64, read: &ReadFiles) -> Result<Vec<u8>, SceneError> {
    use std::io::Read;
    let mut bytes = Vec::new();
    read.open("the scene itself", path)
        .and_then(|file| file.take(limit + 1).read_to_end(&mut bytes))
        .map_err(|source| SceneError::Unreadable { path: path.into(), source })?;
    if bytes.len() as u64 > limit {
        return Err(SceneError::TooLarge { path: path.into(), limit });
    }
    Ok(bytes)
}

fn shown(path: &Path) -> String {
    path.to_string_lossy().escape_debug().to_string()
}
