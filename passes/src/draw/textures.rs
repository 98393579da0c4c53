//! The textures of a scene as bind groups.

use super::interface::{BASE_COLOR_TEXTURE_BINDING, MATERIAL_SET};
use crate::scene::{Sampler, Texture, Wrap};
use framewright_graph::shader::DrawInterface;
use framewright_graph::vulkan::{AddressMode, Filter, Format};
use framewright_vulkan::{BindGroup, Device, Error, Resource, SamplerDescriptor, Texture as Uploaded};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Bind groups by texture. Factors live with the objects, so materials of one texture share its group.
pub(super) struct Textures {
    by_index: Vec<BindGroup>,
    white: BindGroup,
}

impl Textures {
    /// Uploads textures, and a white one for materials without.
    ///
    /// # Errors
    /// Too little memory, or a texture larger than the device takes.
    pub(super) fn new(device: &Device, objects: &DrawInterface, textures: &[Texture]) -> Result<Textures, Error> {
        // Textures of one picture share its texels here too.
        let mut pictures: HashMap<(*const u8, bool), Uploaded> = HashMap::new();
        let mut group = |texture: &Texture| {
            let (sampler, mips) = (sampler(texture.sampler), texture.sampler.mip.is_some());
            let Texture { width, height, rgba8, .. } = texture;
            let uploaded = match pictures.entry((rgba8.as_ptr(), mips)) {
                Entry::Occupied(known) => device.sampled(known.get(), &sampler)?,
                Entry::Vacant(new) => {
                    let format = Format::R8G8B8A8_SRGB;
                    new.insert(device.texture(*width, *height, format, rgba8, &sampler, mips)?).clone()
                }
            };
            device.bind_group(objects, MATERIAL_SET, &[(BASE_COLOR_TEXTURE_BINDING, Resource::Texture(&uploaded))])
        };
        let (name, rgba8) = ("white".to_owned(), [255; 4].into());
        let white = group(&Texture { name, width: 1, height: 1, rgba8, sampler: Sampler::default() })?;
        Ok(Textures { by_index: textures.iter().map(group).collect::<Result<_, _>>()?, white })
    }

    /// The bind group for a material's texture.
    pub(super) fn group(&self, texture: Option<usize>) -> &BindGroup {
        texture.and_then(|index| self.by_index.get(index)).unwrap_or(&self.white)
    }
}

fn sampler(sampler: Sampler) -> SamplerDescriptor {
    let address = |wrap| match wrap {
        Wrap::Repeat => AddressMode::Repeat,
        Wrap::MirroredRepeat => AddressMode::MirroredRepeat,
        Wrap::ClampToEdge => AddressMode::ClampToEdge,
    };
    SamplerDescriptor {
        magnify: sampler.magnify,
        minify: sampler.minify,
        mip: sampler.mip.unwrap_or(Filter::Nearest),
        address: [address(sampler.wrap_u), address(sampler.wrap_v), AddressMode::ClampToEdge],
    }
}
