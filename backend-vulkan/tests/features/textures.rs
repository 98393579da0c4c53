//! Images whose contents come from files, which here are entries of a table.

use crate::frames::{Shaders, Small, Uses, draw, frame, library, on_each_driver, planned, texels};
use framewright_graph::compile::Options;
use framewright_graph::frame::{
    ColorSpace, Draw, Frame, Image, Lifetime, TextureFile, TextureInfo, TextureProblem, Textures, WantedTexels,
};
use framewright_graph::vulkan::{AddressMode, Filter, Format, Sampler, Shape, Subresources};
use framewright_vulkan::{Device, Error, Executor, ExecutorOptions};
use std::sync::Arc;

/// One file, `picture`, with these bytes.
struct Table(Vec<u8>);

impl Textures for Table {
    fn info(&mut self, _: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        Err(TextureProblem::NotProvided)
    }

    fn texels(&mut self, file: &TextureFile, _: &WantedTexels) -> Result<Vec<u8>, TextureProblem> {
        if &*file.path == "picture" { Ok(self.0.clone()) } else { Err(TextureProblem::Outside) }
    }
}

fn picture(format: Format, extent: [u32; 3], mips: u32, path: &str) -> Image {
    let file = TextureFile::picture(path, ColorSpace::Srgb);
    let shape = if extent[2] > 1 { Shape::D3 } else { Shape::D2 };
    let lifetime = Lifetime::File(Arc::new(file));
    Image { extent, shape, mips, lifetime, ..Image::new("picture", format, extent[0], extent[1]) }
}

/// A pass that draws 4×4 words of `show` from the picture.
fn shown(picture: Image) -> Frame {
    let mut small = Small::default();
    let picture = small.image_like(picture);
    let words = small.image("words", Format::R32_UINT, [4, 4]);
    small.pass(draw("show", Draw::FullScreen).samples("picture", picture, Subresources::WHOLE).draws(
        words,
        Subresources::WHOLE,
        None,
    ));
    small.image_output(words);
    small.frame
}

fn executor(device: &Device, frame: &Frame, shaders: Shaders, texels: &[u8]) -> Result<Executor, Error> {
    let plan = planned(device, frame, &Options::default());
    let mut table = Table(texels.to_vec());
    Executor::with_textures(device, &plan, &mut library(shaders), &mut table, &ExecutorOptions::default())
}

/// Holds the texels that `show` makes of the picture in each of three frames, on each driver, against `expected`.
fn everywhere(picture: Image, shaders: Shaders, bytes: &[u8], expected: &[u32]) {
    let frame = shown(picture);
    on_each_driver(|device| {
        let mut executor = executor(device, &frame, shaders, bytes).expect("an executor");
        for _ in 0..3 {
            self::frame(&mut executor);
            assert_eq!(texels(&mut executor, "words", 0), expected, "{}", device.summary().name);
        }
    });
}

const RED: Shaders = &[(
    "show.frag",
    "#version 460
    layout(set = 0, binding = 0) uniform sampler2D picture;
    layout(location = 0) out uint word;
    void main() { word = uint(round(texelFetch(picture, ivec2(gl_FragCoord.xy), 0).r * 255.0)); }",
)];

#[test]
fn every_frame_samples_the_texels_of_the_file() {
    let bytes: Vec<u8> = (0..16).flat_map(|texel| [texel * 16, 0, 0, 255]).collect();
    let expected: Vec<u32> = (0..16).map(|texel| texel * 16).collect();
    everywhere(picture(Format::R8G8B8A8_UNORM, [4, 4, 1], 1, "picture"), RED, &bytes, &expected);
}

#[test]
fn an_srgb_format_decodes_what_is_sampled() {
    // IEC 61966-2-1: 188 of 255 is about half of the light.
    let bytes = [188, 0, 0, 255].repeat(16);
    everywhere(picture(Format::R8G8B8A8_SRGB, [4, 4, 1], 1, "picture"), RED, &bytes, &[128; 16]);
}

#[test]
fn smaller_mip_levels_are_means_of_the_level_before() {
    const LEVELS: Shaders = &[(
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D picture;
        layout(location = 0) out uint word;
        void main() {
            int level = min(int(gl_FragCoord.y), 2);
            ivec2 texel = ivec2(min(int(gl_FragCoord.x), (4 >> level) - 1), 0);
            word = uint(round(texelFetch(picture, texel, level).r * 255.0));
        }",
    )];
    // Columns of 0, 40, 80, 120: two by two 20 and 100, all together 60.
    let bytes: Vec<u8> = (0..16).flat_map(|texel| [texel % 4 * 40, 0, 0, 255]).collect();
    let expected = [0, 40, 80, 120, 20, 100, 100, 100, 60, 60, 60, 60, 60, 60, 60, 60];
    everywhere(picture(Format::R8G8B8A8_UNORM, [4, 4, 1], 3, "picture"), LEVELS, &bytes, &expected);
}

#[test]
fn a_three_dimensional_picture_has_its_slices_one_after_the_other() {
    const SLICES: Shaders = &[(
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler3D picture;
        layout(location = 0) out uint word;
        void main() {
            ivec2 at = ivec2(gl_FragCoord.xy);
            word = uint(round(texelFetch(picture, ivec3(at.x & 1, at.y & 1, at.x >> 1), 0).r * 255.0));
        }",
    )];
    let bytes: Vec<u8> = (0..8).flat_map(|texel| [texel, 0, 0, 255]).collect();
    let expected = [0, 1, 4, 5, 2, 3, 6, 7, 0, 1, 4, 5, 2, 3, 6, 7];
    everywhere(picture(Format::R8G8B8A8_UNORM, [2, 2, 2], 1, "picture"), SLICES, &bytes, &expected);
}

#[test]
fn a_texture_that_is_not_provided_or_has_other_texels_is_refused_before_the_first_frame() {
    on_each_driver(|device| {
        let said = |frame: &Frame, bytes: &[u8]| match executor(device, frame, RED, bytes) {
            Ok(_) => panic!("it is wrong"),
            Err(error) => error.to_string(),
        };
        let format = Format::R8G8B8A8_UNORM;
        let missing = said(&shown(picture(format, [4, 4, 1], 1, "../picture")), &[]);
        assert!(missing.starts_with("image `picture`: the texture `../picture` leads out of the folder"), "{missing}");
        let short = said(&shown(picture(format, [4, 4, 1], 1, "picture")), &[0; 63]);
        assert_eq!(short, "the texels of `picture` take 64 bytes, and 63 were provided");
        let plan = planned(device, &shown(picture(format, [4, 4, 1], 1, "picture")), &Options::default());
        let none = Executor::new(device, &plan, &mut library(RED), &ExecutorOptions::default());
        let none = none.err().expect("nobody provides it").to_string();
        assert!(none.contains("no textures are provided here"), "{none}");
    });
}

#[test]
fn a_plan_that_goes_on_reads_its_textures_anew() {
    let frame = shown(picture(Format::R8G8B8A8_UNORM, [4, 4, 1], 1, "picture"));
    on_each_driver(|device| {
        let of = |red: u8| executor(device, &frame, RED, &[red, 0, 0, 255].repeat(16)).expect("an executor");
        let mut before = of(7);
        self::frame(&mut before);
        let mut after = of(9);
        assert_eq!(after.migrate_from(before).expect("the same device"), Vec::<String>::new());
        self::frame(&mut after);
        assert_eq!(texels(&mut after, "words", 0), [9; 16]);
    });
}

/// A row of words that `show` makes of the picture with these bytes, sampled so, on each driver.
fn row(picture: Image, sampler: Sampler, shaders: Shaders, bytes: &[u8], expected: [u32; 4]) {
    let mut frame = shown(picture);
    frame.passes[0].sampled[0].sampler = sampler;
    on_each_driver(|device| {
        let mut executor = executor(device, &frame, shaders, bytes).expect("an executor");
        self::frame(&mut executor);
        let name = &device.summary().name;
        assert_eq!(texels(&mut executor, "words", 0)[..4], expected, "{name}, {sampler:?}");
    });
}

#[test]
fn beyond_its_edges_a_picture_is_what_the_sampler_says() {
    // At −0.75, 0.25, 1.25 and 2.25 of the width of two texels.
    const ALONG: Shaders = &[(
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D picture;
        layout(location = 0) out uint word;
        void main() {
            float place = floor(gl_FragCoord.x) - 0.75;
            word = uint(round(textureLod(picture, vec2(place, 0.5), 0.0).r * 255.0));
        }",
    )];
    for (address, expected) in [
        (AddressMode::ClampToEdge, [10, 10, 20, 20]),
        (AddressMode::Repeat, [10, 10, 10, 10]),
        (AddressMode::MirroredRepeat, [20, 10, 20, 10]),
    ] {
        let sampler = Sampler { address, ..Sampler::new(Filter::Nearest) };
        let bytes = [10, 0, 0, 255, 20, 0, 0, 255];
        row(picture(Format::R8G8B8A8_UNORM, [2, 1, 1], 1, "picture"), sampler, ALONG, &bytes, expected);
    }
}

#[test]
fn between_mip_levels_lies_a_mean_or_the_nearest_as_the_sampler_says() {
    // From the texel 100 to the mean 60 of all four.
    const BETWEEN: Shaders = &[(
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D picture;
        layout(location = 0) out uint word;
        void main() {
            float level = float[](0.0, 0.25, 0.75, 1.0)[int(gl_FragCoord.x)];
            word = uint(round(textureLod(picture, vec2(0.25), level).r * 255.0));
        }",
    )];
    let bytes: Vec<u8> = [100, 60, 60, 20].iter().flat_map(|red| [*red, 0, 0, 255]).collect();
    for (mips, expected) in [(Filter::Nearest, [100, 100, 60, 60]), (Filter::Linear, [100, 90, 70, 60])] {
        let sampler = Sampler { mips, ..Sampler::new(Filter::Nearest) };
        row(picture(Format::R8G8B8A8_UNORM, [2, 2, 1], 2, "picture"), sampler, BETWEEN, &bytes, expected);
    }
}
