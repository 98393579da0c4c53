//! The images of a Plan whose contents are a file's: their texels are read once, and uploaded before the first frame.

use crate::base::Error;
use crate::commands::staged;
use crate::gpu::Gpu;
use crate::memory::RawBuffer;
use framewright_graph::frame::{TextureFile, Textures, WantedTexels};
use framewright_graph::plan::{FirstContents, Image, ImageId, Plan, Role};
use std::sync::Arc;

/// The texels of one image, where the device can copy from.
pub(crate) struct StagedTexture {
    pub(crate) image: ImageId,
    pub(crate) buffer: RawBuffer,
    /// How many mip levels it holds; smaller ones are made from them.
    pub(crate) mips: u32,
}

/// The file that an image comes from.
pub(crate) fn file_of(image: &Image) -> Option<&TextureFile> {
    match &image.role {
        Role::Persistent { initial: FirstContents::File(file), .. } => Some(file),
        Role::Persistent { .. } | Role::Transient(_) | Role::External { .. } => None,
    }
}

/// Reads the texels of every image that comes from a file.
///
/// # Errors
/// [`Error::Texture`] if there is no such texture, [`Error::OutOfMemory`].
pub(crate) fn stage_textures(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    textures: &mut dyn Textures,
) -> Result<Vec<StagedTexture>, Error> {
    let files = plan.images.iter().filter_map(|image| Some((image, file_of(image)?)));
    files
        .map(|(image, file)| {
            let bad = |problem| Error::Texture { image: image.name.to_string(), path: file.path.to_string(), problem };
            // Smaller levels of a picture are made on the device.
            let mips = if file.stored { image.mips } else { 1 };
            let wanted = WantedTexels { format: image.format, extent: image.extent, mips, layers: image.layers };
            let (texels, expected) = (textures.texels(file, &wanted).map_err(bad)?, wanted.bytes());
            if texels.len() as u64 != expected {
                let what =
                    format!("the texels of `{}` take {expected} bytes, and {} were provided", image.name, texels.len());
                return Err(Error::BadResource { what });
            }
            Ok(StagedTexture { image: image.id, buffer: staged(gpu, &image.name, &texels)?, mips })
        })
        .collect()
}
