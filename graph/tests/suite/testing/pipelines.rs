//! The way of a pipeline from its text to a frame, as tests of the language go it.

use super::table::Table;
use framewright_graph::base::{self, Diagnostic, FilePath, Sources};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::frame::{ColorSpace, Frame, Stereo, TextureFile, TextureInfo, TextureProblem};
use framewright_graph::language::{self, Facts, Files, FoundFile, NoFiles, ReadFailure};
use framewright_graph::vulkan::{Format, Rotation};
use std::sync::Arc;

/// The inputs with which a test puts a pipeline together.
pub(crate) const INPUTS: Inputs<'static> = Inputs {
    set: &[],
    facts: Facts::UNKNOWN,
    facts_known: false,
    output_extent: [640, 360],
    dump: &[],
    device: None,
    stereo: Stereo::Off,
    window: None,
    rotation: Rotation::Identity,
};

/// The text of a shipped pipeline.
pub(crate) fn shipped(name: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/pipelines").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Expands a pipeline's text; if it fails, with the mistakes as they are shown.
pub(crate) fn frame(text: &str, inputs: &Inputs<'_>) -> Result<Frame, String> {
    let mut sources = Sources::default();
    let pipeline = language::read_with(&mut sources, &mut Pictures, "test.ron", "test.ron", text.to_owned());
    let sources = Arc::new(sources);
    let expanded = pipeline.and_then(|pipeline| expand(&pipeline, sources.clone(), inputs, &mut Table));
    expanded.map_err(|errors: Vec<Diagnostic>| base::render(&sources, &errors))
}

/// Pictures out of a table.
pub(crate) struct Pictures;

impl Pictures {
    /// The extent and format of the file's texture, if it is one of the table.
    pub(crate) fn info(file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        let (extent, format) = match &*file.path {
            "grain.png" | "looks/grain.png" => ([64, 32], Format::R8G8B8A8_UNORM),
            "photo.png" => ([800, 600], Format::R8G8B8A8_SRGB),
            "strip.png" => ([256, 16], Format::R16G16B16A16_UNORM),
            "box.ktx2" => {
                let box_of = TextureInfo::picture([8, 8], Format::BC7_SRGB_BLOCK);
                let color_space = Some(ColorSpace::Srgb);
                return Ok(TextureInfo { mips: 4, layers: 6, cube: true, stored: true, color_space, ..box_of });
            }
            "normals.dds" => {
                let normals = TextureInfo::picture([6, 4], Format::BC5_UNORM_BLOCK);
                return Ok(TextureInfo {
                    mips: 2,
                    layers: 3,
                    stored: true,
                    color_space: Some(ColorSpace::Linear),
                    ..normals
                });
            }
            "deep.ktx2" => {
                let deep = TextureInfo::picture([8, 8], Format::ASTC_4x4_SRGB_BLOCK);
                return Ok(TextureInfo {
                    extent: [8, 8, 4],
                    stored: true,
                    color_space: Some(ColorSpace::Srgb),
                    ..deep
                });
            }
            "basis.ktx2" => return Err(TextureProblem::Basis { what: "UASTC" }),
            "damaged.png" => return Err(TextureProblem::Damaged { reason: "unexpected end of file".to_owned() }),
            _ => {
                return Err(TextureProblem::Unreadable { reason: "No such file or directory (os error 2)".to_owned() });
            }
        };
        Ok(TextureInfo::picture(extent, format))
    }
}

impl Files for Pictures {
    fn read(&mut self, from: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        NoFiles.read(from, path)
    }

    fn picture(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        Pictures::info(file)
    }
}

/// `--set` values.
pub(crate) fn set(values: &[(&str, &str)]) -> Vec<(String, String)> {
    values.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
}

/// The frame of a pipeline that is right.
pub(crate) fn right(text: &str, inputs: &Inputs<'_>) -> Frame {
    frame(text, inputs).unwrap_or_else(|answer| panic!("{answer}"))
}

/// The messages about a pipeline that is wrong.
pub(crate) fn wrong(text: &str, inputs: &Inputs<'_>) -> String {
    frame(text, inputs).expect_err("the pipeline is wrong")
}

/// All that a frame says, but for names and places.
pub(crate) fn unnamed(frame: &Frame) -> String {
    let all = format!("{:#?}", (&frame.images, &frame.buffers, &frame.passes, &frame.outputs));
    let said = |line: &&str| !["name: ", "file: ", "start: ", "end: "].iter().any(|it| line.trim().starts_with(it));
    all.lines().filter(said).collect::<Vec<_>>().join("\n")
}
