//! `textures`: images whose texels come from pictures and texture files.

use super::parameters;
use super::values::optional;
use crate::base::{Code, Diagnostic, Span};
use crate::frame::{ColorSpace, TextureFile, TextureInfo, ViewIndex};
use crate::language::model::{Decided, Decisions, Format, Image, ImageShape, Layers, Lifetime, Mips, Samples, Size};
use crate::language::scope::{Context, FieldValue};
use crate::ron::{FieldTable, Form, Leaf, Name, PlainForm, Reader, Spanned, names};
use crate::{fields, vulkan};
use std::collections::HashMap;
use std::sync::Arc;

fields! {
    /// A texture: an image whose texels come from a file. Passes sample it, and do nothing else with it.
    ///
    /// ```ron
    /// (name: "grain", file: "grain.png", color_space: Linear)
    /// ```
    pub(crate) struct TextureFields<'src> as "Texture" {
        /// Its name, unique among images and buffers.
        name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// Its path, counted from the file in which it stands; parts are divided by `/`.
        pub(crate) file: Leaf<'src> => Form::Plain(PlainForm::Text),
        /// `Srgb`: red, green and blue are encoded with the sRGB curve, as pictures for people are; `Linear`: all values are as
        /// they are, as in tables, noise and light. If left out, what the file says: KTX2 files and DDS files with a DX10 header say
        /// it. Else `Srgb`; HDR and EXR files are linear.
        pub(crate) color_space: Option<Leaf<'src>> => Form::Choice("a colour space", || names(&COLOR_SPACES)),
        /// The format. If left out, a format that holds the file's values: `R8G8B8A8_SRGB` or `_UNORM` of 8 bits,
        /// `R16G16B16A16_UNORM` of 16, `R16G16B16A16_SFLOAT` of floating point; of KTX2 and DDS the file's own.
        format: Option<Leaf<'src>> => Form::Either(&[parameters::FORMAT, Form::Expression("a format")]),
        /// `D3`: the picture is a strip of N squares of N × N texels, one for each slice from left to right; a colour table has
        /// red to the right, green downwards, and blue from square to square. `Cube` is for files that hold cubes. If left out, the
        /// shape that a KTX2 or DDS file has; `D2` of other files.
        shape: Option<Leaf<'src>> => Form::Choice("the shape of a texture", || names(&SHAPES)),
    }
}

/// The textures of one level.
pub(crate) const TEXTURES: Form = Form::List(&Form::Fields(TextureFields::<'static>::table));

const COLOR_SPACES: [(&str, ColorSpace); 2] = [("Srgb", ColorSpace::Srgb), ("Linear", ColorSpace::Linear)];

const SHAPES: [(&str, vulkan::Shape); 3] =
    [("D2", vulkan::Shape::D2), ("D3", vulkan::Shape::D3), ("Cube", vulkan::Shape::Cube)];

/// Pictures, by the places of their paths; `None` where a mistake was reported.
pub(crate) type Pictures = HashMap<Span, Option<Picture>>;

/// A picture's file.
#[derive(Debug, Clone)]
pub(crate) struct Picture {
    pub(crate) file: Arc<TextureFile>,
    pub(crate) info: TextureInfo,
}

impl Context<'_> {
    /// A texture, once its fields are told apart.
    pub(crate) fn texture(
        &mut self,
        pictures: &Pictures,
        fields: &TextureFields<'_>,
    ) -> Option<FieldValue<Arc<Image>>> {
        let name = self.reader.name(fields.name, "a texture");
        let path = self.reader.words(fields.file, "the path of a file");
        let color_space = color_space(self.reader, fields.color_space);
        let shape = optional(fields.shape, |leaf| self.reader.choice(leaf, "the shape of a texture", &SHAPES));
        let format = optional(fields.format, |leaf| match leaf.shape() {
            crate::ron::Shape::Text => self.format(leaf),
            _ => parameters::format(self.reader, leaf).map(|format| FieldValue::said(leaf, format)),
        });
        let (name, path, _, shape, format) = (name?, path?, color_space?, shape?, format?);
        let Picture { file, info } = pictures.get(&fields.file.span())?.as_ref()?;
        let shape = shape.unwrap_or(info.shape());
        let format = match format {
            Some(format) => {
                let (file, info, name) = (Arc::clone(file), *info, name.clone());
                format.checked_as(self.reader, true, move |format, _| {
                    match info.format_problem(&file, format.value) {
                        None => Ok(format),
                        Some(why) => {
                            let message = format!("texture `{}` can't be {}: {why}", name.text, format.value);
                            Err(Diagnostic::new(Code::TEXTURE_FORMAT, format.span, message))
                        }
                    }
                })?
            }
            None => FieldValue::said(fields.file, info.format),
        };
        let extent = match info.image_extent(shape) {
            Ok(extent) => extent,
            Err(problem) => {
                let at = fields.shape.map_or(fields.file.span(), Leaf::span);
                self.reader.report(
                    Diagnostic::new(Code::TEXTURE_FILE, at, format!("`{path}` {problem}"))
                        .label(fields.file.span(), "this file"),
                );
                return None;
            }
        };
        let image = image(name, file, info, (extent, shape), fields);
        Some(format.of(Format::Named).map(move |format| Arc::new(Image { format, ..image.clone() })))
    }
}

fn image(
    name: Name,
    file: &Arc<TextureFile>,
    info: &TextureInfo,
    ([width, height, depth], shape): ([u32; 3], vulkan::Shape),
    fields: &TextureFields<'_>,
) -> Image {
    let (from, span) = (fields.file, name.span);
    let shape = match shape {
        vulkan::Shape::D2 => ImageShape::D2,
        vulkan::Shape::D3 => ImageShape::D3(depth),
        vulkan::Shape::Cube => ImageShape::Cube,
    };
    Image {
        name,
        format: Decided::said(from.span(), Format::Named(info.format)),
        size: Decided::said(from.span(), Size::Fixed([width, height])),
        samples: Decided::said(span, Samples::Count(1)),
        resolve: None,
        mips: Decided::said(from.span(), Mips::Count(info.mips)),
        layers: Decided::said(from.span(), Layers::Count(info.layers)),
        shape: Decided::said(fields.shape.unwrap_or(from).span(), shape),
        lifetime: from.spanned(Lifetime::File(Arc::clone(file))),
        repeat: Decisions::default(),
        per_eye: Some(Spanned { value: false, span }),
        eyes: None,
        view: ViewIndex::default(),
        instance: None,
    }
}

pub(crate) fn color_space(reader: &mut Reader, leaf: Option<Leaf<'_>>) -> Option<ColorSpace> {
    leaf.map_or(Some(ColorSpace::default()), |leaf| reader.choice(leaf, "a colour space", &COLOR_SPACES))
}
