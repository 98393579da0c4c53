//! Textures: images whose texels come from files.

use crate::testing::pipelines::{INPUTS, Pictures, right};
use crate::testing::table::Table;
use framewright_graph::base::{FilePath, Sources};
use framewright_graph::expand::expand;
use framewright_graph::frame::{ColorSpace, Frame, Image, Lifetime, TextureFile, TextureInfo, TextureProblem};
use framewright_graph::language::{self, Files, FoundFile, ReadFailure};
use framewright_graph::vulkan::{Format, Shape};
use std::sync::Arc;

/// The frame of a pipeline with these textures and images, and these passes before the one that shows.
fn pipeline(textures: &str, images: &str, passes: &str) -> Frame {
    let text = format!(
        r#"Pipeline(
            version: 1,
            settings: [(name: "deep", value: Bool(default: true))],
            textures: [{textures}],
            images: [(name: "screen", format: Output, size: Output), {images}],
            passes: [{passes} (name: "show", draw: FullScreen("plain"), color: ["screen"])],
            outputs: ["screen"],
        )"#
    );
    right(&text, &INPUTS)
}

fn texture(fields: &str) -> Image {
    pipeline(&format!(r#"(name: "texture", {fields})"#), "", "").images[0].clone()
}

/// The file that an image comes from.
fn file(image: &Image) -> (&str, ColorSpace) {
    let Lifetime::File(file) = &image.lifetime else { panic!("{image:?}") };
    (&file.path, file.color_space)
}

#[test]
fn a_texture_is_an_image_of_the_size_and_format_that_its_file_has() {
    let photo = texture(r#"file: "photo.png""#);
    assert_eq!((photo.format, photo.shape, photo.extent), (Format::R8G8B8A8_SRGB, Shape::D2, [800, 600, 1]));
    assert_eq!((photo.mips, photo.layers, photo.samples), (1, 1, 1));
    assert_eq!(file(&photo), ("photo.png", ColorSpace::Srgb));
    assert_eq!(file(&texture(r#"file: "grain.png", color_space: Linear"#)), ("grain.png", ColorSpace::Linear));
}

#[test]
fn a_strip_makes_a_deep_texture_and_another_format_may_be_asked_for() {
    let table = texture(r#"file: "strip.png", color_space: Linear, shape: D3"#);
    assert_eq!((table.format, table.shape, table.extent), (Format::R16G16B16A16_UNORM, Shape::D3, [16, 16, 16]));
    let flat = texture(r#"file: "strip.png", shape: D2, format: R16G16B16A16_SFLOAT"#);
    assert_eq!((flat.format, flat.shape, flat.extent), (Format::R16G16B16A16_SFLOAT, Shape::D2, [256, 16, 1]));
    let chosen = texture(r#"file: "grain.png", color_space: Linear, format: "if(deep, R16G16B16A16_UNORM, R8_UNORM)""#);
    assert_eq!(chosen.format, Format::R16G16B16A16_UNORM);
}

#[test]
fn other_images_may_follow_a_texture_and_expressions_ask_for_its_size() {
    let images = r#"(name: "like", format: Like("photo"), size: Like("photo")),
                    (name: "row", format: R8_UNORM, size: Fixed("height(photo)", 1))"#;
    let frame = pipeline(r#"(name: "photo", file: "photo.png")"#, images, "");
    let extents: Vec<_> = frame.images.iter().map(|image| (&*image.name, image.extent)).collect();
    assert_eq!(
        extents,
        [("photo", [800, 600, 1]), ("screen", [640, 360, 1]), ("like", [800, 600, 1]), ("row", [600, 1, 1])]
    );
    assert!(matches!(frame.images[2].lifetime, Lifetime::Transient), "it follows the size, not the contents");
}

#[test]
fn passes_sample_a_texture_before_anything_is_drawn() {
    let passes = r#"(name: "film", draw: FullScreen("downsample"),
        sample: {"source": (image: "if(deep, grain, photo)", address: Repeat)}, color: ["screen"]),"#;
    let textures = r#"(name: "grain", file: "grain.png", color_space: Linear), (name: "photo", file: "photo.png")"#;
    assert_eq!(pipeline(textures, "", passes).passes[0].sampled[0].image.0, 0);
}

/// A file of fragments in a folder, and the pictures of the table.
struct Shelf;

impl Files for Shelf {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        let text = r#"Fragments(version: 1, fragments: [(name: "film", parameters: [(name: "target", value: Image)],
            textures: [(name: "grain", file: "grain.png", color_space: Linear)],
            passes: [(name: "draw", draw: FullScreen("downsample"), sample: {"source": "grain"}, color: ["target"])])])"#;
        Ok(FoundFile { shown: path.to_owned(), relative: path.into(), bytes: text.as_bytes().to_vec() })
    }

    fn picture(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        Pictures::info(file)
    }
}

#[test]
fn a_fragment_brings_its_textures_which_lie_beside_the_file_that_it_stands_in() {
    let text = r#"Pipeline(version: 1, include: ["looks/film.ron"],
        images: [(name: "screen", format: Output, size: Output)],
        passes: [(use: "film", name: "film", with: {"target": "screen"})], outputs: ["screen"])"#;
    let mut sources = Sources::default();
    let document = language::read_with(&mut sources, &mut Shelf, "test.ron", "test.ron", text.to_owned());
    let frame = expand(&document.expect("it is read"), Arc::new(sources), &INPUTS, &mut Table).expect("a frame");
    assert_eq!((&*frame.images[1].name, file(&frame.images[1]).0), ("film.grain", "looks/grain.png"));
}

/// Pictures, and how often one was looked at.
struct Counted(u32);

impl Files for Counted {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        Err(format!("no `{path}`").into())
    }

    fn picture(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        self.0 += 1;
        Pictures::info(file)
    }
}

#[test]
fn a_picture_that_many_textures_name_is_looked_at_once() {
    let textures: String = (0..1000).map(|at| format!(r#"(name: "t{at}", file: "photo.png"),"#)).collect();
    let text = format!(
        r#"Pipeline(version: 1, textures: [{textures}], images: [(name: "screen", format: Output, size: Output)],
            passes: [(name: "show", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#
    );
    let mut files = Counted(0);
    let document = language::read_with(&mut Sources::default(), &mut files, "test.ron", "test.ron", text);
    assert!(document.is_ok());
    assert_eq!(files.0, 1);
}
