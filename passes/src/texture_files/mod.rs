//! Textures from files: pictures (PNG, JPEG, Radiance HDR, OpenEXR) and texture files (KTX2, DDS).
//!
//! Each of both kinds is a feature of this crate: `pictures` and `texture-files`.

#[cfg(feature = "texture-files")]
mod containers;
mod limits;
#[cfg(any(feature = "pictures", feature = "texture-files"))]
mod pack;
#[cfg(feature = "pictures")]
mod pictures;
#[cfg(any(feature = "pictures", feature = "texture-files"))]
mod words;

pub use limits::{MOST_BYTES, MOST_SIDE, MOST_TEXELS};

use framewright_graph::base::{NoFile, Root, is_of_machine};
use framewright_graph::frame::{TextureFile, TextureInfo, TextureProblem, Textures, WantedTexels};
use std::fs::{self, File};
use std::io::{self, Read, Seek};
use std::path::PathBuf;

/// Textures from files.
///
/// The bytes of a file decide its format, not its name. PNG of 8 bits and JPEG become `R8G8B8A8_SRGB` or `R8G8B8A8_UNORM`, PNG
/// of 16 bits `R16G16B16A16_UNORM`, HDR and EXR `R16G16B16A16_SFLOAT`; a frame may say `R32G32B32A32_SFLOAT` or any other
/// format of colour, of which the picture fills as many components as there are. KTX2 and DDS keep the format, levels and layers that
/// they have; where a device lacks the format, their texels are decoded.
#[derive(Debug, Clone)]
pub struct TextureFiles {
    root: Root,
}

/// Reads files of one kind. Each file is given opened, at its beginning.
trait Reader {
    /// The properties of the image that the file becomes.
    fn info(&self, opened: File, file: &TextureFile) -> Result<TextureInfo, TextureProblem>;

    /// The texels that an image wants of it.
    fn texels(&self, opened: File, file: &TextureFile, wanted: &WantedTexels) -> Result<Vec<u8>, TextureProblem>;
}

/// The first bytes of a KTX2 file (KTX 2.0, section 3.1).
const KTX2: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";
/// The first bytes of a DDS file.
const DDS: &[u8] = b"DDS ";

impl TextureFiles {
    /// Files that `root` lets be read.
    #[must_use]
    pub fn new(root: Root) -> TextureFiles {
        TextureFiles { root }
    }

    /// The bytes of a picture's file.
    ///
    /// # Errors
    /// If the file lies outside of the folder, can't be read or is too large.
    pub fn bytes(&self, path: &str) -> Result<Vec<u8>, TextureProblem> {
        let mut bytes = Vec::new();
        self.open(path)?.take(MOST_BYTES).read_to_end(&mut bytes).map_err(unreadable)?;
        Ok(bytes)
    }

    /// Opens a file that isn't too large.
    fn open(&self, path: &str) -> Result<File, TextureProblem> {
        self.root.open(&self.locate(path)?).map_err(unreadable)
    }

    /// Opens a file, and finds who reads it.
    fn open_to_read(&self, path: &str) -> Result<(&'static dyn Reader, File), TextureProblem> {
        let mut opened = self.open(path)?;
        let mut head = Vec::new();
        opened.by_ref().take(KTX2.len() as u64).read_to_end(&mut head).map_err(unreadable)?;
        opened.rewind().map_err(unreadable)?;
        Ok((reader(&head)?, opened))
    }

    /// The file behind a path.
    fn locate(&self, path: &str) -> Result<PathBuf, TextureProblem> {
        let found = self.root.locate(path).map_err(|problem| match problem {
            NoFile::Outside { .. } => TextureProblem::Outside,
            NoFile::Unreadable { reason } => TextureProblem::Unreadable { reason },
            NoFile::Denied { reason } | NoFile::Machine { reason } => TextureProblem::Machine { reason },
            other => TextureProblem::Unreadable { reason: format!("it {other}") },
        })?;
        let bytes = fs::metadata(&found).map_err(unreadable)?.len();
        if bytes > MOST_BYTES {
            let reason = format!("it has {bytes} bytes, more than the {MOST_BYTES} of a texture");
            return Err(TextureProblem::Unreadable { reason });
        }
        Ok(found)
    }
}

/// The reader of a file that begins with `head`.
fn reader(head: &[u8]) -> Result<&'static dyn Reader, TextureProblem> {
    if head.starts_with(KTX2) || head.starts_with(DDS) {
        #[cfg(feature = "texture-files")]
        return Ok(&containers::Containers);
        #[cfg(not(feature = "texture-files"))]
        return Err(TextureProblem::LeftOut { kind: "a KTX2 or DDS file", feature: "texture-files" });
    }
    #[cfg(feature = "pictures")]
    return Ok(&pictures::Pictures);
    #[cfg(not(feature = "pictures"))]
    return Err(TextureProblem::LeftOut { kind: "no KTX2 or DDS file", feature: "pictures" });
}

impl Textures for TextureFiles {
    fn info(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        let (reader, opened) = self.open_to_read(&file.path)?;
        reader.info(opened, file)
    }

    fn texels(&mut self, file: &TextureFile, wanted: &WantedTexels) -> Result<Vec<u8>, TextureProblem> {
        let (reader, opened) = self.open_to_read(&file.path)?;
        reader.texels(opened, file, wanted)
    }
}

fn unreadable(error: io::Error) -> TextureProblem {
    let reason = error.to_string();
    if is_of_machine(&error) { TextureProblem::Machine { reason } } else { TextureProblem::Unreadable { reason } }
}
