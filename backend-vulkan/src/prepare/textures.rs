//! The images of a Plan whose contents are a file's: their texels are read once, and uploaded before the first frame.

use crate::base::Error;
use crate::commands::staged;
use crate::gpu::Gpu;
use crate::memory::RawBuffer;
use framewright_graph::frame::{TextureFile, Textures};
use framewright_graph::plan::{FirstContents, Image, ImageId, Plan, Role};
use std::sync::Arc;

/// The texels of one image, where the device can copy from.
pub(crate) struct StagedTexture {
    pub(crate) image: ImageId,
    pub(crate) buffer: RawBuffer,
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
            let texels = textures.texels(file, image.format, image.extent).map_err(bad)?;
            let expected =
                image.extent.iter().fold(image.format.texel_bytes(), |all, side| all.saturating_mul(u64::from(*side)));
            if texels.len() as u64 != expected {
                let what =
                    format!("the texels of `{}` take {expected} bytes, and {} were provided", image.name, texels.len());
                return Err(Error::BadResource { what });
            }
            Ok(StagedTexture { image: image.id, buffer: staged(gpu, &image.name, &texels)? })
        })
        .collect()
}
