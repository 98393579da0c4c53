//! Textures out of images.

use super::accessor::Data;
use super::document::{self, follow};
use super::notes::Notes;
use super::problem::{GltfError, Problem, at_most, at_most_in_all};
use crate::decoder_words;
use crate::scene::limits;
use crate::scene::model::{Sampler, Texture, Wrap};
use framewright_graph::vulkan::Filter;
use image::{DynamicImage, ImageFormat, ImageReader, Limits};
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Cursor;
use std::sync::Arc;

/// Bytes that a decoder may take: what the largest picture takes with four 16-bit components, and as much again.
const MOST_DECODED: u64 = (limits::TEXTURE_SIDE as u64).pow(2) * 16;

/// Decodes textures when a material first asks for them.
#[derive(Debug, Default)]
pub(super) struct Textures {
    pub(super) decoded: Vec<Texture>,
    /// The place of each texture in that list, by glTF's number of its image and by its sampler.
    places: HashMap<(u64, Sampler), usize>,
    /// Images by glTF's number: decoded, or why they can't be.
    pictures: HashMap<u64, Result<Picture, GltfError>>,
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
    pub(super) fn place(
        &mut self,
        data: &Data<'_>,
        number: u64,
        user: &str,
        notes: &mut Notes,
    ) -> Result<Option<usize>, GltfError> {
        let texture = follow(&data.document.textures, number, "texture", user)?;
        let at = format!("texture {number}");
        let Some(source) = texture.source else { return Ok(None) };
        let image = follow(&data.document.images, source, "image", &at)?;
        let sampler = texture.sampler.map(|sampler| {
            let found = follow(&data.document.samplers, sampler, "sampler", &at)?;
            read_sampler(found, &format!("sampler {sampler}"))
        });
        let sampler = sampler.transpose().unwrap_or_else(|error| {
            notes.mistake(format!("{error}, so a usual sampler stands in its place"));
            None
        });
        let sampler = sampler.unwrap_or_default();
        if let Some(place) = self.places.get(&(source, sampler)) {
            return Ok(Some(*place));
        }
        let picture = match self.pictures.get(&source) {
            Some(known) => known.clone(),
            None => {
                let decoded = self.decode(data, image, &format!("image {source}"));
                let new = decoded.map(|decoded| {
                    let (width, height) = (decoded.width(), decoded.height());
                    Picture { width, height, rgba8: decoded.into_rgba8().into_raw().into() }
                });
                self.pictures.insert(source, new.clone());
                new
            }
        };
        let Picture { width, height, rgba8 } = picture?;
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
            |error: image::ImageError| Problem::Image(decoder_words(error).escape_debug().to_string()).at(at);
        let (width, height) =
            ImageReader::with_format(Cursor::new(&bytes), format).into_dimensions().map_err(undecodable)?;
        at_most("texels along a side", width.max(height).into(), limits::TEXTURE_SIDE.into(), at)?;
        self.bytes += u64::from(width) * u64::from(height) * 4;
        at_most_in_all("bytes of all pictures up to here", self.bytes, limits::TEXTURE_BYTES, at)?;
        let mut reader = ImageReader::with_format(Cursor::new(&bytes), format);
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(MOST_DECODED);
        reader.limits(limits);
        reader.decode().map_err(undecodable)
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
