//! KTX2 and DDS files on each driver (DO-7): every level, layer and face as it is stored, compressed formats as their decoders decode
//! them, and decoded where a device lacks the format.

use crate::frames::{Shaders, Small, Uses, draw, frame, library, on_each_driver, planned};
use framewright_graph::base::Root;
use framewright_graph::compile::Options;
use framewright_graph::frame::{ColorSpace, Draw, Frame, Image, Lifetime, TextureFile, Textures, WantedTexels};
use framewright_graph::vulkan::{Accesses, Aspects, Format, Layout, Numeric, Shape, Stages, State, Subresources};
use framewright_passes::texture_files::TextureFiles;
use framewright_tests::texture_files::{Dds, DdsTexels, Ktx2};
use framewright_vulkan::{Device, Executor, ExecutorOptions};
use std::cell::RefCell;
use tempfile::TempDir;

/// A folder with one file, `texture`.
fn written(bytes: &[u8]) -> (TempDir, TextureFiles) {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("texture"), bytes).expect("it is written");
    let textures = TextureFiles::new(Root::new(folder.path().to_owned()));
    (folder, textures)
}

fn file(format: Format) -> TextureFile {
    let space = if format.numeric() == Numeric::Srgb { ColorSpace::Srgb } else { ColorSpace::Linear };
    TextureFile::picture("texture", space)
}

/// A pass that draws each texel of a target of this size by `show`, which samples the texture.
fn shown(texture: Image, [width, height]: [u32; 2]) -> Frame {
    let mut small = Small::default();
    let texture = small.image_like(texture);
    let target = small.image("shown", Format::R32G32B32A32_SFLOAT, [width, height]);
    let pass = draw("show", Draw::FullScreen).samples("picture", texture, Subresources::WHOLE);
    small.pass(pass.draws(target, Subresources::WHOLE, None));
    small.image_output(target);
    small.frame
}

/// What a device draws of the file, and the format and notes of the image.
fn drawn(device: &Device, textures: &mut TextureFiles, frame: &Frame, shaders: Shaders) -> (Vec<[f32; 4]>, Format) {
    let plan = planned(device, frame, &Options::default());
    let image = plan.images.iter().find(|image| &*image.name == "picture").expect("it is planned");
    let noted = plan.notes.iter().any(|note| &*note.subject == "picture" && note.text.contains("texels are decoded"));
    assert_eq!(noted, image.format != frame.images[0].format, "{:?}", plan.notes);
    let options = ExecutorOptions::default();
    let mut executor = Executor::with_textures(device, &plan, &mut library(shaders), textures, &options);
    let executor = executor.as_mut().unwrap_or_else(|error| panic!("{error}"));
    self::frame(executor);
    (floats(&executor.read_image("shown", Aspects::COLOR, 0).expect("its texels").bytes), image.format)
}

fn floats(bytes: &[u8]) -> Vec<[f32; 4]> {
    let float = |bytes: &[u8; 4]| f32::from_ne_bytes(*bytes);
    bytes.as_chunks::<16>().0.iter().map(|texel| [0, 1, 2, 3].map(|at| float(&texel.as_chunks().0[at]))).collect()
}

/// Bytes without a pattern.
struct Random(u64);

impl Random {
    fn byte(&mut self) -> u8 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 56) as u8
    }

    fn bytes(&mut self, count: u64) -> Vec<u8> {
        (0..count).map(|_| self.byte()).collect()
    }
}

const TEXEL: Shaders = &[(
    "show.frag",
    "#version 460
    layout(set = 0, binding = 0) uniform sampler2D picture;
    layout(location = 0) out vec4 color;
    void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }",
)];

/// The share of a number that drivers may differ in, and the least difference.
fn tolerance(format: Format) -> (f32, f32) {
    match format.numeric() {
        Numeric::Sfloat | Numeric::Ufloat => (1.0 / 256.0, 1.0 / 1024.0),
        // Drivers and decoders round the means of two colours in their own ways. Of the curve's steep end.
        Numeric::Srgb => (0.03, 2.6 / 255.0),
        Numeric::Snorm => (0.0, 2.6 / 127.0),
        _ => (0.0, 2.6 / 255.0),
    }
}

/// A file of random blocks, the frame that shows it, and what is to be seen.
struct Case {
    format: Format,
    textures: TextureFiles,
    frame: Frame,
    expected: Vec<[f32; 4]>,
    _folder: TempDir,
}

fn case(format: Format) -> Case {
    let [wide, high] = format.block();
    // Not a whole number of blocks.
    let [width, height] = [wide * 6 - 1, high * 4 - 2];
    let blocks = blocks(format, format.bytes([width, height, 1]));
    let (folder, mut textures) = written(&Ktx2::flat(format.vulkan(), [width, height]).plain(&[blocks]));
    let info = textures.info(&file(format)).expect("a texture");
    assert_eq!((info.format, info.mips, info.stored), (format, 1, true));
    let image = Image::of_file("picture", file(format), &info, Shape::D2).expect("an image");
    let wanted = WantedTexels::picture(Format::R32G32B32A32_SFLOAT, image.extent);
    let expected = floats(&textures.texels(&file(format), &wanted).expect("decoded"));
    Case { format, textures, frame: shown(image, [width, height]), expected, _folder: folder }
}

#[test]
fn random_blocks_look_as_their_decoder_decodes_them_whether_the_device_has_the_format_or_not() {
    let cases = Format::ALL.iter().copied().filter(|format| format.is_compressed()).map(case);
    let cases = RefCell::new(cases.collect::<Vec<Case>>());
    on_each_driver(|device| {
        let name = &device.summary().name;
        let mut wrong = Vec::new();
        for Case { format, textures, frame, expected, .. } in cases.borrow_mut().iter_mut() {
            let format = *format;
            let (found, made) = drawn(device, textures, frame, TEXEL);
            let has = device.profile().format(format).is_some();
            assert_eq!(Some(made), if has { Some(format) } else { format.decoded() }, "{name}");
            // Both software drivers have BC.
            assert!(has || format.feature() != Some("textureCompressionBC"), "{format} on {name}");
            let (share, least) = tolerance(format);
            let excess = |found: &f32, expected: &f32| (found - expected).abs() - share * expected.abs() - least;
            let components = format.components() as usize;
            let texels = found.iter().zip(expected.iter());
            let pairs = texels.flat_map(|(found, expected)| found.iter().zip(expected).take(components));
            let worst = pairs.max_by(|a, b| excess(a.0, a.1).total_cmp(&excess(b.0, b.1)));
            let (found, expected) = worst.expect("texels");
            if excess(found, expected) > 0.0 {
                wrong.push(format!("{format} on {name}: {found}, not {expected}"));
            }
        }
        assert_eq!(wrong, Vec::<String>::new());
    });
}

/// Random blocks that are valid in the format.
fn blocks(format: Format, bytes: u64) -> Vec<u8> {
    let mut random = Random(format.vulkan().unsigned_abs().into());
    let mut blocks = random.bytes(bytes);
    for block in blocks.chunks_exact_mut(format.texel_bytes() as usize) {
        match format {
            // One of eight modes: the lowest bit that is set.
            Format::BC7_UNORM_BLOCK | Format::BC7_SRGB_BLOCK if block[0] == 0 => block[0] = 1,
            // The mode of two endpoints of 10 bits; other values of five bits may be reserved.
            Format::BC6H_UFLOAT_BLOCK | Format::BC6H_SFLOAT_BLOCK => block[0] = block[0] & !31 | 3,
            _ if format.feature() == Some("textureCompressionASTC_LDR") => astc(block),
            _ => {}
        }
    }
    blocks
}

/// Makes a random block a valid one of ASTC: 4 × 4 weights of two bits, and one to four partitions of random colours.
fn astc(block: &mut [u8]) {
    let bits = u128::from_le_bytes(block.try_into().expect("16 bytes"));
    let (partitions, seed) = (bits >> 126, (bits >> 100) & 1023);
    // Luminance, with alpha, a scaled colour, two colours, with alpha: each directly and by an offset.
    let ends = match partitions {
        0 | 1 => [0, 1, 4, 5, 6, 8, 9, 10, 12, 13][(bits >> 110) as usize % 10],
        2 => 8,
        _ => 4,
    };
    let (head, used) = match partitions {
        0 => (0x42 | ends << 13, 17),
        _ => (0x42 | partitions << 11 | seed << 13 | ends << 25, 29),
    };
    block.copy_from_slice(&(bits >> used << used | head).to_le_bytes());
}

#[test]
fn every_level_and_face_of_a_ktx2_cube_is_drawn_as_it_is_stored() {
    // Face by face below each other, level by level beside each other.
    const PARTS: Shaders = &[(
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2DArray picture;
        layout(location = 0) out vec4 color;
        void main() {
            ivec2 at = ivec2(gl_FragCoord.xy);
            int level = at.x / 4;
            ivec2 texel = min(ivec2(at.x % 4, at.y % 4), ivec2((4 >> level) - 1));
            color = texelFetch(picture, ivec3(texel, at.y / 4), level);
        }",
    )];
    let mut random = Random(7);
    let levels: Vec<Vec<u8>> = [4_u64, 2, 1].map(|side| random.bytes(6 * side * side * 4)).into();
    let ktx2 = Ktx2 { faces: 6, ..Ktx2::flat(Format::R8G8B8A8_UNORM.vulkan(), [4, 4]) };
    exact(&ktx2.plain(&levels), Shape::Cube, &levels, PARTS);
    // A DDS file has the same texels, face after face.
    let face = |face: usize| {
        let part = move |level: &Vec<u8>| level.chunks_exact(level.len() / 6).nth(face).expect("six").to_vec();
        levels.iter().flat_map(part).collect::<Vec<u8>>()
    };
    let texels: Vec<u8> = (0..6).flat_map(face).collect();
    let dds = Dds { extent: [4, 4, 1], mips: 3, elements: 1, cube: true, texels: DdsTexels::Dxgi(28) };
    exact(&dds.with(&texels), Shape::Cube, &levels, PARTS);
    let array = Dds { elements: 6, cube: false, ..dds };
    exact(&array.with(&texels), Shape::D2, &levels, PARTS);
}

/// Draws a file of six layers and three levels of 4 × 4 texels, and holds each texel against those of `levels`.
fn exact(bytes: &[u8], shape: Shape, levels: &[Vec<u8>], shaders: Shaders) {
    let (_folder, mut textures) = written(bytes);
    let info = textures.info(&file(Format::R8G8B8A8_UNORM)).expect("a texture");
    assert_eq!((info.extent, info.mips, info.layers, info.shape()), ([4, 4, 1], 3, 6, shape));
    let image = Image::of_file("picture", file(info.format), &info, shape).expect("an image");
    let frame = shown(image, [12, 24]);
    let textures = RefCell::new(textures);
    on_each_driver(|device| {
        let (found, _) = drawn(device, &mut textures.borrow_mut(), &frame, shaders);
        for (at, found) in found.iter().enumerate() {
            let [x, y] = [at % 12, at / 12];
            let (level, face) = (x / 4, y / 4);
            let side = 4 >> level;
            let [x, y] = [x % 4, y % 4].map(|place| place.min(side - 1));
            let first = 4 * ((face * side + y) * side + x);
            let stored = [0, 1, 2, 3].map(|more| levels[level][first + more]);
            let drawn = found.map(|value| (value * 255.0).round() as u8);
            assert_eq!(drawn, stored, "level {level} of face {face} at {x}, {y} on {}", device.summary().name);
        }
    });
}

#[test]
fn an_imported_image_of_a_compressed_format_begins_with_zeros() {
    let state = State {
        stages: Stages::FRAGMENT_SHADER,
        accesses: Accesses::SHADER_SAMPLED_READ,
        layout: Layout::ShaderReadOnlyOptimal,
    };
    on_each_driver(|device| {
        let format = Format::BC4_UNORM_BLOCK;
        if device.profile().format(format).is_none() {
            return;
        }
        let lifetime = Lifetime::Imported { before: state, after: None, owner: None };
        let frame = shown(Image { lifetime, mips: 3, ..Image::new("picture", format, 7, 5) }, [7, 5]);
        let (found, _) = drawn(device, &mut written(&[]).1, &frame, TEXEL);
        assert!(found.iter().all(|texel| texel[0] == 0.0), "{found:?}");
    });
}
