//! KTX2 and DDS files (DO-7): what they hold, how they are unpacked, and what is refused. What drivers draw of them is tested in
//! backend-vulkan/tests/features/texture_files.rs.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use framewright_graph::base::Root;
use framewright_graph::frame::ColorSpace::{self, Linear, Srgb};
use framewright_graph::frame::{TextureFile, TextureInfo, TextureProblem, Textures, WantedTexels};
use framewright_graph::vulkan::Format::{self, *};
use framewright_passes::texture_files::{MOST_SIDE, TextureFiles};
use framewright_tests::texture_files::{Dds, DdsTexels, Ktx2};
use proptest::prelude::*;
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use std::io::Write;
use tempfile::TempDir;

/// Bytes as the file `texture`.
fn written(bytes: &[u8]) -> (TempDir, TextureFiles) {
    let folder = TempDir::new().expect("a folder");
    std::fs::write(folder.path().join("texture"), bytes).expect("it is written");
    let textures = TextureFiles::new(Root::new(folder.path().to_owned()));
    (folder, textures)
}

fn info(bytes: &[u8], color_space: ColorSpace) -> Result<TextureInfo, TextureProblem> {
    let (_folder, mut textures) = written(bytes);
    textures.info(&TextureFile::picture("texture", color_space))
}

/// All texels as the file has them.
fn texels(bytes: &[u8], color_space: ColorSpace) -> Result<Vec<u8>, TextureProblem> {
    let TextureInfo { format, .. } = info(bytes, color_space)?;
    texels_in(bytes, color_space, format)
}

fn texels_in(bytes: &[u8], color_space: ColorSpace, format: Format) -> Result<Vec<u8>, TextureProblem> {
    let (_folder, mut textures) = written(bytes);
    let file = TextureFile::picture("texture", color_space);
    let TextureInfo { extent, mips, layers, .. } = textures.info(&file)?;
    textures.texels(&file, &WantedTexels { format, extent, mips, layers })
}

fn said(bytes: &[u8]) -> String {
    texels(bytes, Linear).expect_err("it is wrong").to_string()
}

const FLAT: Dds = Dds { extent: [4, 2, 1], mips: 1, elements: 1, cube: false, texels: DdsTexels::Dxgi(28) };

/// Bytes that rise.
fn rising(count: usize) -> Vec<u8> {
    (0..count).map(|at| at as u8).collect()
}

#[test]
fn a_ktx2_file_has_the_levels_layers_faces_and_format_that_it_says() {
    let level = |side: u32| rising(12 * BC7_SRGB_BLOCK.bytes([side, side, 1]) as usize);
    let levels: Vec<Vec<u8>> = [8, 4, 2].map(level).into();
    let cubes = Ktx2 { layers: 2, faces: 6, ..Ktx2::flat(BC7_SRGB_BLOCK.vulkan(), [8, 8]) };
    let file = cubes.plain(&levels);
    let found = info(&file, Srgb).expect("a texture");
    let expected = TextureInfo {
        extent: [8, 8, 1],
        format: BC7_SRGB_BLOCK,
        mips: 3,
        layers: 12,
        cube: true,
        stored: true,
        color_space: Some(Srgb),
    };
    assert_eq!(found, expected);
    assert_eq!(texels(&file, Srgb), Ok(levels.concat()));
    // The file names its colour space: another one is wrong.
    assert_eq!(texels(&file, Linear), Err(TextureProblem::ColorSpace { named: Srgb }));
    let deep = Ktx2 { extent: [4, 4, 2], ..Ktx2::flat(R8_UNORM.vulkan(), [4, 4]) };
    let deep = deep.plain(&[rising(32), rising(4)]);
    let found = info(&deep, Linear).expect("a texture");
    assert_eq!((found.extent, found.mips, found.layers), ([4, 4, 2], 2, 1));
    assert_eq!(texels(&deep, Linear), Ok([rising(32), rising(4)].concat()));
}

#[test]
fn packed_levels_are_unpacked_and_may_not_lie_about_their_size() {
    let zlib = |bytes: &[u8]| {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(bytes).expect("it is written");
        encoder.finish().expect("it is packed")
    };
    let zstandard = |bytes: &[u8]| compress_to_vec(bytes, CompressionLevel::Fastest);
    let ktx2 = Ktx2::flat(R8G8B8A8_UNORM.vulkan(), [16, 16]);
    let whole = rising(1024);
    for (packing, packed) in [(2, zstandard(&whole)), (3, zlib(&whole))] {
        let ktx2 = Ktx2 { packing, ..ktx2 };
        assert_eq!(texels(&ktx2.with_levels(&[(packed.clone(), 1024)]), Linear), Ok(whole.clone()));
        // More texels than are packed, and fewer.
        let more = Ktx2 { extent: [32, 16, 0], ..ktx2 }.with_levels(&[(packed.clone(), 2048)]);
        assert!(said(&more).contains("takes 2048 bytes, and it has 1024"), "{}", said(&more));
        let fewer = Ktx2 { extent: [8, 16, 0], ..ktx2 }.with_levels(&[(packed.clone(), 512)]);
        assert!(said(&fewer).contains("takes 512 bytes, and it has 513"), "{}", said(&fewer));
        assert!(texels(&ktx2.with_levels(&[(packed[..packed.len() / 2].to_vec(), 1024)]), Linear).is_err());
    }
}

#[test]
fn three_components_become_four_and_the_last_is_one() {
    for (number, bytes, format, expected) in [
        (23, vec![1, 2, 3], R8G8B8A8_UNORM, vec![1, 2, 3, 255]),
        (24, vec![1, 2, 3], R8G8B8A8_SNORM, vec![1, 2, 3, 127]),
        (27, vec![1, 2, 3], R8G8B8A8_UINT, vec![1, 2, 3, 1]),
        (36, vec![1, 2, 3], B8G8R8A8_SRGB, vec![1, 2, 3, 255]),
        (84, vec![1, 0, 2, 0, 3, 0], R16G16B16A16_UNORM, vec![1, 0, 2, 0, 3, 0, 255, 255]),
        (85, vec![1, 0, 2, 0, 3, 0], R16G16B16A16_SNORM, vec![1, 0, 2, 0, 3, 0, 255, 127]),
        (90, vec![1, 0, 2, 0, 3, 0], R16G16B16A16_SFLOAT, vec![1, 0, 2, 0, 3, 0, 0, 0x3C]),
        (106, rising(12), R32G32B32A32_SFLOAT, [rising(12), 1.0_f32.to_le_bytes().to_vec()].concat()),
    ] {
        let file = Ktx2::flat(number, [1, 1]).plain(&[bytes]);
        let space = if format == B8G8R8A8_SRGB { Srgb } else { Linear };
        assert_eq!(info(&file, space).map(|info| info.format), Ok(format));
        assert_eq!(texels(&file, space), Ok(expected), "{format}");
    }
    let masks = [24, 0x00FF_0000, 0xFF00, 0xFF, 0];
    let file = Dds { extent: [1, 1, 1], texels: DdsTexels::Masks(masks), ..FLAT }.with(&[3, 2, 1]);
    assert_eq!(
        (info(&file, Srgb).map(|it| it.format), texels(&file, Srgb)),
        (Ok(B8G8R8A8_SRGB), Ok(vec![3, 2, 1, 255]))
    );
    let masks = [32, 0xFF, 0xFF00, 0x00FF_0000, 0];
    let file = Dds { extent: [1, 1, 1], texels: DdsTexels::Masks(masks), ..FLAT }.with(&[1, 2, 3, 0]);
    assert_eq!(texels(&file, Linear), Ok(vec![1, 2, 3, 255]), "bytes that aren't used");
}

#[test]
fn a_dds_file_without_a_newer_header_has_the_colour_space_that_is_asked_for() {
    for (letters, linear, srgb) in [
        (b"DXT1", BC1_RGBA_UNORM_BLOCK, Some(BC1_RGBA_SRGB_BLOCK)),
        (b"DXT3", BC2_UNORM_BLOCK, Some(BC2_SRGB_BLOCK)),
        (b"DXT5", BC3_UNORM_BLOCK, Some(BC3_SRGB_BLOCK)),
        (b"ATI2", BC5_UNORM_BLOCK, None),
    ] {
        let file = Dds { texels: DdsTexels::Letters(*letters), ..FLAT };
        let file = file.with(&rising(linear.texel_bytes() as usize));
        let formats = [Linear, Srgb].map(|space| info(&file, space).expect("a texture"));
        assert_eq!(formats.map(|info| info.format), [linear, srgb.unwrap_or(linear)]);
        assert_eq!(formats[0].color_space, if srgb.is_some() { None } else { Some(Linear) });
    }
    // Layer after layer, each with its levels, becomes level after level.
    let file =
        Dds { extent: [2, 1, 1], mips: 2, elements: 2, texels: DdsTexels::Dxgi(61), ..FLAT }.with(&[1, 2, 3, 4, 5, 6]);
    assert_eq!(texels(&file, Linear), Ok(vec![1, 2, 4, 5, 3, 6]));
    let file = Dds { extent: [2, 1, 2], mips: 2, texels: DdsTexels::Dxgi(61), ..FLAT }.with(&[1, 2, 3, 4, 5]);
    assert_eq!(
        (info(&file, Linear).map(|info| info.extent), texels(&file, Linear)),
        (Ok([2, 1, 2]), Ok(vec![1, 2, 3, 4, 5]))
    );
}

#[test]
fn basis_universal_and_formats_that_no_image_has_are_refused_by_name() {
    let basis = |packing: u32, model: u8| {
        let ktx2 = Ktx2 { packing, model, ..Ktx2::flat(0, [4, 4]) };
        info(&ktx2.plain(&[vec![0; 16]]), Linear)
    };
    assert_eq!(basis(1, 163), Err(TextureProblem::Basis { what: "ETC1S" }));
    for packing in [0, 2] {
        assert_eq!(basis(packing, 166), Err(TextureProblem::Basis { what: "UASTC" }));
    }
    let refused = |file: &[u8]| info(file, Linear).expect_err("it is refused").to_string();
    assert_eq!(
        refused(&Ktx2::flat(2, [4, 4]).plain(&[vec![0; 16]])),
        "holds the VkFormat with the number 2, which no image has here"
    );
    let dds = Dds { texels: DdsTexels::Dxgi(85), ..FLAT }.with(&[0; 16]);
    assert_eq!(refused(&dds), "holds DXGI's format B5G6R5_UNorm, which no image has here");
    let dds = Dds { texels: DdsTexels::Letters(*b"PVRT"), ..FLAT }.with(&[0; 16]);
    assert_eq!(refused(&dds), "holds texels named PVRT, which no image has here");
}

#[test]
fn a_file_that_can_not_be_an_image_is_refused() {
    let ktx2 = Ktx2::flat(R8_UNORM.vulkan(), [4, 4]);
    for (file, wanted) in [
        (ktx2.plain(&[vec![0; 15]]), "mip level 0 takes 16 bytes, and it has 15"),
        (Ktx2 { faces: 5, ..ktx2 }.plain(&[vec![0; 80]]), "5 faces"),
        (Ktx2 { faces: 6, extent: [4, 2, 0], ..ktx2 }.plain(&[vec![0; 48]]), "its sides aren't square"),
        (Ktx2 { layers: 2, extent: [4, 4, 4], ..ktx2 }.plain(&[vec![0; 128]]), "depth and layers"),
        (ktx2.plain(&[vec![0; 16], vec![0; 4], vec![0; 1], vec![0; 1]]), "4 mip levels, more than its size allows"),
        (Ktx2 { packing: 9, ..ktx2 }.plain(&[vec![0; 16]]), "has the number 9"),
        (Ktx2 { extent: [MOST_SIDE + 1, 1, 0], ..ktx2 }.plain(&[vec![0; 1]]), "at most 16384 texels along a side"),
        (Ktx2 { layers: u32::MAX, ..ktx2 }.plain(&[vec![0; 1]]), "67108864 in all"),
        (Dds { elements: 0, ..FLAT }.with(&[0; 32]), "it is empty"),
        (FLAT.with(&[0; 31]), "it is cut off"),
    ] {
        assert!(said(&file).contains(wanted), "{}, not {wanted}", said(&file));
    }
    let file = FLAT.with(&rising(32));
    let wanted = |format: Format, mips: u32| {
        let (_folder, mut textures) = written(&file);
        let wanted = WantedTexels { format, extent: [4, 2, 1], mips, layers: 1 };
        textures.texels(&TextureFile::picture("texture", Linear), &wanted).expect_err("it is refused").to_string()
    };
    assert_eq!(
        wanted(R8G8B8A8_UNORM, 2),
        "holds 4×2×1 texels with mips: 1, layers: 1, and 4×2×1 texels with mips: 2, layers: 1 are needed"
    );
    assert_eq!(wanted(R8G8B8A8_UINT, 1), "can't become R8G8B8A8_UINT: the file holds another format");
    assert_eq!(wanted(BC1_RGBA_UNORM_BLOCK, 1), "can't become BC1_RGBA_UNORM_BLOCK: the file holds another format");
}

#[test]
fn texels_become_other_formats_where_a_device_lacks_their_own() {
    let one = |number: u32, bytes: &[u8], format: Format| {
        let file = Dds { extent: [1, 1, 1], texels: DdsTexels::Dxgi(number), ..FLAT }.with(bytes);
        texels_in(&file, if matches!(number, 29 | 91) { Srgb } else { Linear }, format).expect("texels")
    };
    let floats = |number: u32, bytes: &[u8]| -> Vec<f32> {
        let all = one(number, bytes, R32G32B32A32_SFLOAT);
        all.as_chunks::<4>().0.iter().map(|bytes| f32::from_ne_bytes(*bytes)).collect()
    };
    assert_eq!(one(28, &[1, 2, 3, 4], B8G8R8A8_UNORM), [3, 2, 1, 4]);
    assert_eq!(one(29, &[1, 2, 3, 4], B8G8R8A8_SRGB), [3, 2, 1, 4], "encoded values stay so");
    assert_eq!(floats(29, &[255, 0, 255, 255]), [1.0, 0.0, 1.0, 1.0]);
    assert_eq!(floats(31, &[127, 0x81, 0x80, 0]), [1.0, -1.0, -1.0, 0.0]);
    assert_eq!(floats(24, &0xC000_03FF_u32.to_le_bytes()), [1.0, 0.0, 0.0, 1.0]);
    // 1, 0.5 and 2 with mantissas of 6, 6 and 5 bits: exponents 15, 14 and 16.
    assert_eq!(floats(26, &(15 << 6 | 14 << 17 | 16_u32 << 27).to_le_bytes()), [1.0, 0.5, 2.0, 1.0]);
    assert_eq!(floats(67, &(16_u32 << 27 | 128 << 9 | 256).to_le_bytes()), [1.0, 0.5, 0.0, 1.0]);
    assert_eq!(floats(34, &[0, 0x3C, 0, 0xC0]), [1.0, -2.0, 0.0, 1.0]);
    // A block of one red: both ends are 0xF800.
    let red = [0x00, 0xF8, 0x00, 0xF8, 0, 0, 0, 0];
    assert_eq!(one(71, &red, R8G8B8A8_UNORM), [255, 0, 0, 255]);
}

/// Files of both kinds, packed and not.
fn some_files() -> Vec<Vec<u8>> {
    let zstandard = compress_to_vec(&rising(64)[..], CompressionLevel::Fastest);
    let ktx2 = Ktx2::flat(R8G8B8A8_UNORM.vulkan(), [4, 4]);
    vec![
        ktx2.plain(&[rising(64), rising(16), rising(4)]),
        Ktx2 { packing: 2, ..ktx2 }.with_levels(&[(zstandard, 64)]),
        Ktx2::flat(ASTC_5x4_UNORM_BLOCK.vulkan(), [9, 9]).plain(&[rising(16 * 6)]),
        FLAT.with(&rising(32)),
        Dds { texels: DdsTexels::Letters(*b"DXT5"), extent: [4, 4, 1], ..FLAT }.with(&rising(16)),
    ]
}

#[test]
fn a_file_that_is_cut_anywhere_is_refused() {
    for file in some_files() {
        assert!(texels(&file, Linear).is_ok());
        for length in 0..file.len() {
            assert!(texels(&file[..length], Linear).is_err(), "{length} of {} bytes", file.len());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn no_change_to_a_file_makes_anything_panic(
        file in 0_usize..5,
        changes in prop::collection::vec((0_usize..200, prop_oneof![Just(0_u8), Just(1), Just(0xFF), any::<u8>()]), 1..6),
    ) {
        let mut bytes = some_files().swap_remove(file);
        for (at, value) in changes {
            let at = at % bytes.len();
            bytes[at] = value;
        }
        for space in [Linear, Srgb] {
            let _ = texels(&bytes, space);
            let _ = texels_in(&bytes, space, R32G32B32A32_SFLOAT);
        }
    }

    #[test]
    fn every_block_is_decoded(bytes in prop::collection::vec(any::<u8>(), 16 * 4), number in 131_i32..=184) {
        let format = Format::ALL.iter().find(|format| format.vulkan() == number).expect("a format");
        let [wide, high] = format.block();
        let file = Ktx2::flat(number, [2 * wide, 2 * high]).plain(&[bytes[..format.texel_bytes() as usize * 4].to_vec()]);
        let space = if format.with_srgb(false) == *format { Linear } else { Srgb };
        let decoded = texels_in(&file, space, format.decoded().expect("it is compressed"));
        prop_assert!(decoded.is_ok(), "{decoded:?}");
    }
}
