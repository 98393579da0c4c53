//! Texture files, which hold an image as it is: all of its levels and layers, in a format of Vulkan's.

mod container;
mod dds;
mod decode;
mod ktx2;

use self::container::{Container, HEAD};
use super::{DDS, Reader, unreadable};
use framewright_graph::frame::{TextureFile, TextureInfo, TextureProblem, WantedTexels};
use std::fs::File;
use std::io::{Read, Seek};

/// Reads KTX2 and DDS files.
pub(super) struct Containers;

impl Reader for Containers {
    fn info(&self, mut opened: File, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        Ok(read_header(&mut opened, file)?.info())
    }

    fn texels(&self, mut opened: File, file: &TextureFile, wanted: &WantedTexels) -> Result<Vec<u8>, TextureProblem> {
        let container = read_header(&mut opened, file)?;
        let mut bytes = Vec::new();
        opened.rewind().map_err(unreadable)?;
        opened.take(super::MOST_BYTES).read_to_end(&mut bytes).map_err(unreadable)?;
        container.wanted(&bytes, file, wanted)
    }
}

/// Reads and checks what a file says of itself.
fn read_header(opened: &mut File, file: &TextureFile) -> Result<Container, TextureProblem> {
    let bytes = opened.metadata().map_err(unreadable)?.len();
    let mut head = Vec::new();
    opened.take(HEAD).read_to_end(&mut head).map_err(unreadable)?;
    let container = if head.starts_with(DDS) { dds::open(&head, file.color_space)? } else { ktx2::open(&head)? };
    container.check(bytes)?;
    Ok(container)
}
