//! `textures`: images whose texels come from picture files.

use super::pipeline_files::WITHIN_ROOT;
use super::resources::{Format, Image, Layers, Lifetime, Mips, Samples, Shape, Size};
use super::scope::Scope;
use super::{parameters, values};
use crate::base::{Diagnostic, FilePath, OutsideChoice, Sources, Span};
use crate::frame::{ColorSpace, TextureFile, TextureInfo, TextureProblem, ViewIndex, format_problem};
use crate::ron::{Described, Form, Leaf, Name, Plain, Reader, Spanned, names};
use crate::{fields, vulkan};
use std::collections::HashMap;
use std::sync::Arc;

fields! {
    /// A texture: an image whose texels come from a file. Passes sample it, and do nothing else with it.
    ///
    /// ```ron
    /// (name: "grain", file: "grain.png", color_space: Linear)
    /// ```
    pub(super) struct TextureFields<'src> as "Texture" {
        /// Its name, unique among images and buffers.
        name: Leaf<'src> => Form::Plain(Plain::Name),
        /// Its path, counted from the file in which it stands; parts are divided by `/`.
        file: Leaf<'src> => Form::Plain(Plain::Text),
        /// `Srgb`: red, green and blue are encoded with the sRGB curve, as pictures for people are; `Linear`: all values are as
        /// they are, as in tables, noise and light. `Srgb` if left out; HDR and EXR files are linear.
        color_space: Option<Leaf<'src>> => Form::Choice("a colour space", || names(&COLOR_SPACES)),
        /// The format, if not the one that holds what the file does: `R8G8B8A8_SRGB` or `_UNORM` of 8 bits,
        /// `R16G16B16A16_UNORM` of 16, `R16G16B16A16_SFLOAT` of floating point.
        format: Option<Leaf<'src>> => Form::Either(&[parameters::FORMAT, Form::Expression("a format")]),
        /// `D3`: the picture is a strip of N squares of N × N texels, one for each slice from left to right; a colour table has
        /// red to the right, green downwards, and blue from square to square. `D2` if left out.
        shape: Option<Leaf<'src>> => Form::Choice("the shape of a texture", || names(&SHAPES)),
    }
}

/// The textures of one level.
pub(super) const TEXTURES: Form = Form::List(&Form::Fields(TextureFields::<'static>::table));

const COLOR_SPACES: [(&str, ColorSpace); 2] = [("Srgb", ColorSpace::Srgb), ("Linear", ColorSpace::Linear)];

const SHAPES: [(&str, vulkan::Shape); 2] = [("D2", vulkan::Shape::D2), ("D3", vulkan::Shape::D3)];

/// What was found behind the paths of pictures, by where they stand; `None` where a mistake was reported.
pub(super) type Pictures = HashMap<Span, Option<Picture>>;

/// A picture's file.
#[derive(Debug, Clone)]
pub(super) struct Picture {
    file: Arc<TextureFile>,
    info: TextureInfo,
}

/// Looks at the files that a list of textures names, by what `info` tells of them. What is wrong with the list itself is reported when it is lowered.
pub(super) fn look(
    reader: &mut Reader,
    sources: &Sources,
    mut info: impl FnMut(&TextureFile) -> Result<TextureInfo, TextureProblem>,
    list: Option<Leaf<'_>>,
    pictures: &mut Pictures,
) {
    let mut silent = Reader::default();
    let entries = list.and_then(|list| silent.list(list, "`textures`")).unwrap_or_default();
    for entry in entries {
        let Some(fields) = silent.read::<TextureFields<'_>>(entry, "a texture") else { continue };
        let Some(path) = silent.words(fields.file, "the path of a file") else { continue };
        let Some(color_space) = color_space(&mut silent, fields.color_space) else { continue };
        let span = fields.file.span();
        let from = span.file().and_then(|file| sources.file(file)).map(|file| &file.path);
        let picture = match from.unwrap_or(&"".into()).beside(&path) {
            Ok(FilePath::Own(path)) => {
                let file = TextureFile { path, color_space };
                info(&file).map(|info| Picture { file: Arc::new(file), info }).map_err(|problem| {
                    let outside = problem == TextureProblem::Outside;
                    let help = outside.then(|| WITHIN_ROOT.to_owned());
                    (problem.to_string(), help, outside.then_some(OutsideChoice::Root))
                })
            }
            Ok(FilePath::Shipped(_)) => Err(("can't be read: no textures are shipped".to_owned(), None, None)),
            Err(problem) => Err((problem.to_string(), None, None)),
        };
        let picture = picture.map_err(|(why, help, choice)| {
            reader.report(Diagnostic { help, choice, ..Diagnostic::new(span, format!("`{path}` {why}")) });
        });
        let picture = picture.ok();
        pictures.insert(span, picture);
    }
}

/// A texture, once its fields are told apart.
pub(super) fn lower<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    pictures: &Pictures,
    fields: &TextureFields<'src>,
) -> Option<Image> {
    let name = reader.name(fields.name, "a texture");
    let path = reader.words(fields.file, "the path of a file");
    let color_space = color_space(reader, fields.color_space);
    let shape = match fields.shape {
        Some(leaf) => values::choice(reader, leaf, "the shape of a texture", &SHAPES),
        None => Some(vulkan::Shape::D2),
    };
    let format = match fields.format.map(|leaf| (leaf, leaf.shape())) {
        Some((leaf, crate::ron::Shape::Text)) => {
            values::format(reader, scope, leaf).map(|format| Some(leaf.spanned(format)))
        }
        Some((leaf, _)) => parameters::format(reader, leaf).map(|format| Some(leaf.spanned(format))),
        None => Some(None),
    };
    let (name, path, _, shape, format) = (name?, path?, color_space?, shape?, format?);
    let Picture { file, info } = pictures.get(&fields.file.span())?.as_ref()?;
    if let Some(Spanned { value, span }) = format
        && let Some(why) = format_problem(file, value)
    {
        reader.report(Diagnostic::new(span, format!("texture `{}` can't be {value}: {why}", name.text)));
        return None;
    }
    let extent = match info.image_extent(shape) {
        Ok(extent) => extent,
        Err(problem) => {
            let at = fields.shape.map_or(fields.file.span(), Leaf::span);
            reader.report(Diagnostic::new(at, format!("`{path}` {problem}")).label(fields.file.span(), "this file"));
            return None;
        }
    };
    Some(image(name, file, format.map_or(info.format, |format| format.value), extent, shape, fields))
}

fn image(
    name: Name,
    file: &Arc<TextureFile>,
    format: crate::vulkan::Format,
    [width, height, depth]: [u32; 3],
    shape: vulkan::Shape,
    fields: &TextureFields<'_>,
) -> Image {
    let (from, span) = (fields.file, name.span);
    let shape = if shape == vulkan::Shape::D3 { Shape::D3(depth) } else { Shape::D2 };
    Image {
        name,
        format: fields.format.unwrap_or(from).spanned(Format::Named(format)),
        size: from.spanned(Size::Fixed([width, height])),
        size_because: None,
        samples: Spanned { value: Samples::Count(1), span },
        samples_because: None,
        resolve: None,
        mips: Spanned { value: Mips::Count(1), span },
        layers: Spanned { value: Layers::Default, span },
        shape: fields.shape.unwrap_or(from).spanned(shape),
        lifetime: from.spanned(Lifetime::File(Arc::clone(file))),
        per_eye: Some(Spanned { value: false, span }),
        eyes: None,
        view: ViewIndex::default(),
        instance: None,
    }
}

fn color_space(reader: &mut Reader, leaf: Option<Leaf<'_>>) -> Option<ColorSpace> {
    match leaf {
        Some(leaf) => values::choice(reader, leaf, "a colour space", &COLOR_SPACES),
        None => Some(ColorSpace::default()),
    }
}
