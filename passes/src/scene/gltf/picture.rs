//! Textures out of images.

use super::accessor::Data;
use super::document::{self, follow};
use super::problem::{GltfError, Problem, at_most};
use crate::scene::limits;
use crate::scene::model::{Sampler, Texture, Wrap};
use framewright_graph::vulkan::Filter;
use image::{DynamicImage, ImageFormat, ImageReader};
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Cursor;
use std::sync::Arc;

/// Decodes textures when a material first asks for them.
#[derive(Debug, Default)]
pub(super) struct Textures {
    pub(super) decoded: Vec<Texture>,
    /// The place of each texture in that list, by glTF's number of its image and by its sampler.
    places: HashMap<(u64, Sampler), usize>,
    /// Decoded images, by glTF's number.
    pictures: HashMap<u64, Picture>,
    bytes: u64,
}

/// An image, decoded.
#[derive(Debug, Clone)]
struct Picture {
    width: u32,
    height: u32,
    rgba8: Arc<[u8]>,
}

impl Textures {
    /// The place of glTF's texture `number` in the scene's list; `None` if it has no image.
    pub(super) fn place(&mut self, data: &Data<'_>, number: u64, user: &str) -> Result<Option<usize>, GltfError> {
        let texture = follow(&data.document.textures, number, "texture", user)?;
        let at = format!("texture {number}");
        let Some(source) = texture.source else { return Ok(None) };
        let image = follow(&data.document.images, source, "image", &at)?;
        let sampler = match texture.sampler {
            Some(sampler) => {
                let sampler_at = format!("sampler {sampler}");
                read_sampler(follow(&data.document.samplers, sampler, "sampler", &at)?, &sampler_at)?
            }
            None => Sampler::default(),
        };
        if let Some(place) = self.places.get(&(source, sampler)) {
            return Ok(Some(*place));
        }
        let Picture { width, height, rgba8 } = match self.pictures.get(&source) {
            Some(known) => known.clone(),
            None => {
                let decoded = self.decode(data, image, &format!("image {source}"))?;
                let (width, height) = (decoded.width(), decoded.height());
                let new = Picture { width, height, rgba8: decoded.into_rgba8().into_raw().into() };
                self.pictures.insert(source, new.clone());
                new
            }
        };
        let name = image.name.clone().unwrap_or_else(|| format!("image {source}"));
        self.decoded.push(Texture { name, width, height, rgba8, sampler });
        self.places.insert((source, sampler), self.decoded.len() - 1);
        Ok(Some(self.decoded.len() - 1))
    }

    fn decode(&mut self, data: &Data<'_>, image: &document::Image, at: &str) -> Result<DynamicImage, GltfError> {
        let bytes: Cow<'_, [u8]> = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => data.external.bytes(uri, at)?.into(),
            (None, Some(view)) => data.view(view, at)?.0.into(),
            (None, None) => return Err(Problem::NoData.at(at)),
        };
        // The bytes decide the format; `mimeType` is ignored.
        let format = match image::guess_format(&bytes) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
            _ => return Err(Problem::ImageKind.at(at)),
        };
        let undecodable =
            |error: image::ImageError| Problem::Image(error.to_string().escape_debug().to_string()).at(at);
        let (width, height) =
            ImageReader::with_format(Cursor::new(&bytes), format).into_dimensions().map_err(undecodable)?;
        at_most("texels along a side", width.max(height).into(), limits::TEXTURE_SIDE.into(), at)?;
        self.bytes += u64::from(width) * u64::from(height) * 4;
        at_most("bytes of all pictures up to here", self.bytes, limits::TEXTURE_BYTES, at)?;
        ImageReader::with_format(Cursor::new(&bytes), format).decode().map_err(undecodable)
    }
}

/// glTF 2.0, section 5.26: OpenGL's numbers.
fn read_sampler(sampler: &document::Sampler, at: &str) -> Result<Sampler, GltfError> {
    let unknown = |what, is: u64, expected| Problem::Word { what, is: is.to_string(), expected }.at(at);
    let wrap = |code: Option<u64>| match code.unwrap_or(10497) {
        10497 => Ok(Wrap::Repeat),
        33071 => Ok(Wrap::ClampToEdge),
        33648 => Ok(Wrap::MirroredRepeat),
        other => Err(unknown("wrap mode", other, "10497, 33071 or 33648")),
    };
    let (minify, mip) = match sampler.min_filter.unwrap_or(9987) {
        9728 => (Filter::Nearest, None),
        9729 => (Filter::Linear, None),
        9984 => (Filter::Nearest, Some(Filter::Nearest)),
        9985 => (Filter::Linear, Some(Filter::Nearest)),
        9986 => (Filter::Nearest, Some(Filter::Linear)),
        9987 => (Filter::Linear, Some(Filter::Linear)),
        other => return Err(unknown("minification filter", other, "9728, 9729 or 9984 to 9987")),
    };
    let magnify = match sampler.mag_filter.unwrap_or(9729) {
        9728 => Filter::Nearest,
        9729 => Filter::Linear,
        other => return Err(unknown("magnification filter", other, "9728 or 9729")),
    };
    Ok(Sampler { wrap_u: wrap(sampler.wrap_s)?, wrap_v: wrap(sampler.wrap_t)?, magnify, minify, mip })
}
