//! Pictures of files as textures: which format they get, which texels, and what is refused.

use framewright_graph::base::Root;
use framewright_graph::frame::{ColorSpace, TextureFile, TextureInfo, TextureProblem, Textures, WantedTexels};
use framewright_graph::vulkan::Format;
use framewright_passes::texture_files::{MOST_SIDE, TextureFiles};
use image::{DynamicImage, ImageBuffer, ImageFormat, Rgb, Rgba};
use std::io::Cursor;
use tempfile::TempDir;

/// A folder with these files.
fn folder(files: &[(&str, Vec<u8>)]) -> (TempDir, TextureFiles) {
    let folder = TempDir::new().expect("a folder");
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).expect("it is written");
    }
    let textures = TextureFiles::new(Root::new(folder.path().to_owned()));
    (folder, textures)
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Vec::new();
    image.write_to(&mut Cursor::new(&mut bytes), format).expect("it is encoded");
    bytes
}

fn file(path: &str, color_space: ColorSpace) -> TextureFile {
    TextureFile::picture(path, color_space)
}

fn bytes(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> DynamicImage {
    ImageBuffer::from_fn(width, height, |x, y| Rgba(texel(x, y))).into()
}

fn floats(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 3]) -> DynamicImage {
    ImageBuffer::from_fn(width, height, |x, y| Rgb(texel(x, y))).into()
}

use ColorSpace::{Linear, Srgb};

#[test]
fn eight_bits_get_the_format_of_their_color_space_and_stay_as_they_are() {
    let picture = bytes(2, 1, |x, _| [10 + x as u8, 20, 30, 40]);
    let (_folder, mut textures) = folder(&[("a.png", encoded(&picture, ImageFormat::Png))]);
    for (space, format) in [(Srgb, Format::R8G8B8A8_SRGB), (Linear, Format::R8G8B8A8_UNORM)] {
        let file = file("a.png", space);
        assert_eq!(textures.info(&file), Ok(TextureInfo::picture([2, 1], format)));
        assert_eq!(
            textures.texels(&file, &WantedTexels::picture(format, [2, 1, 1])),
            Ok(vec![10, 20, 30, 40, 11, 20, 30, 40])
        );
    }
    let swapped = textures.texels(&file("a.png", Srgb), &WantedTexels::picture(Format::B8G8R8A8_SRGB, [2, 1, 1]));
    assert_eq!(swapped.expect("texels")[..4], [30, 20, 10, 40]);
    let one = textures.texels(&file("a.png", Linear), &WantedTexels::picture(Format::R8_UNORM, [2, 1, 1]));
    assert_eq!(one, Ok(vec![10, 11]));
}

#[test]
fn sixteen_bits_stay_sixteen_bits() {
    let words: ImageBuffer<Rgba<u16>, _> = ImageBuffer::from_fn(1, 1, |_, _| Rgba([1_u16, 513, 40_000, 65_535]));
    let (_folder, mut textures) = folder(&[("a.png", encoded(&words.into(), ImageFormat::Png))]);
    let file = file("a.png", Linear);
    let format = Format::R16G16B16A16_UNORM;
    assert_eq!(textures.info(&file), Ok(TextureInfo::picture([1, 1], format)));
    let expected: Vec<u8> = [1_u16, 513, 40_000, 65_535].iter().flat_map(|word| word.to_ne_bytes()).collect();
    assert_eq!(textures.texels(&file, &WantedTexels::picture(format, [1, 1, 1])), Ok(expected));
}

#[test]
fn encoded_values_become_linear_where_the_format_does_not_decode_them() {
    let picture = bytes(1, 1, |_, _| [188, 0, 255, 188]);
    let (_folder, mut textures) = folder(&[("a.png", encoded(&picture, ImageFormat::Png))]);
    let texels = textures
        .texels(&file("a.png", Srgb), &WantedTexels::picture(Format::R32G32B32A32_SFLOAT, [1, 1, 1]))
        .expect("texels");
    let values: Vec<f32> = texels.as_chunks().0.iter().map(|bytes| f32::from_ne_bytes(*bytes)).collect();
    // IEC 61966-2-1; alpha is never encoded.
    for (value, expected) in values.iter().zip([0.502_886, 0.0, 1.0, 188.0 / 255.0]) {
        assert!((value - expected).abs() < 1e-6, "{values:?}");
    }
}

#[test]
fn exr_and_hdr_hold_light_beyond_one_and_are_never_srgb() {
    let light = floats(1, 1, |_, _| [0.25, 4.0, 1e9]);
    let (_folder, mut textures) =
        folder(&[("a.exr", encoded(&light, ImageFormat::OpenExr)), ("a.hdr", encoded(&light, ImageFormat::Hdr))]);
    let format = Format::R16G16B16A16_SFLOAT;
    let exr = file("a.exr", Linear);
    assert_eq!(textures.info(&exr), Ok(TextureInfo::picture([1, 1], format)));
    let texels = textures.texels(&exr, &WantedTexels::picture(format, [1, 1, 1])).expect("texels");
    let halves: Vec<u16> = texels.as_chunks().0.iter().map(|bytes| u16::from_ne_bytes(*bytes)).collect();
    // Numbers too large for a half become the largest half, 65504.
    assert_eq!(halves, [0x3400, 0x4400, 0x7bff, 0x3c00]);
    let wide = textures.texels(&exr, &WantedTexels::picture(Format::R32G32B32A32_SFLOAT, [1, 1, 1])).expect("texels");
    assert_eq!(wide[8..12], 1e9_f32.to_ne_bytes());
    assert_eq!(textures.info(&file("a.hdr", Linear)).map(|info| info.format), Ok(format));
    for name in ["a.exr", "a.hdr"] {
        let problem = textures.info(&file(name, Srgb)).expect_err("light is linear").to_string();
        assert!(problem.ends_with("HDR and EXR hold linear light: say `color_space: Linear`"), "{problem}");
    }
}

/// An OpenEXR file of 2×1 texels whose channels hold these values.
fn exr(channels: &[(&str, [f32; 2])]) -> Vec<u8> {
    use exr::prelude::*;
    let channel = |(name, values): &(&str, [f32; 2])| AnyChannel::new(*name, FlatSamples::F32(values.to_vec()));
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels.iter().map(channel).collect();
    let mut file = Cursor::new(Vec::new());
    let image = exr::image::Image::from_channels((2, 1), AnyChannels::sort(channels));
    image.write().non_parallel().to_buffered(&mut file).expect("it is written");
    file.into_inner()
}

/// Names and values of the channels of two texels.
type Channels<'c> = &'c [(&'c str, [f32; 2])];

#[test]
fn every_set_of_channels_that_is_a_picture_is_read() {
    let [a, b, c, half] = [[0.25, 4.0], [2.0, 3.0], [5.0, 6.0], [0.5, 0.75]];
    let cases: [(Channels<'_>, [[f32; 4]; 2]); 9] = [
        (&[("Y", a)], [[0.25, 0.25, 0.25, 1.0], [4.0, 4.0, 4.0, 1.0]]),
        (&[("Y", a), ("A", half)], [[0.25, 0.25, 0.25, 0.5], [4.0, 4.0, 4.0, 0.75]]),
        (&[("Z", a)], [[0.25, 0.25, 0.25, 1.0], [4.0, 4.0, 4.0, 1.0]]),
        (&[("R", a)], [[0.25, 0.25, 0.25, 1.0], [4.0, 4.0, 4.0, 1.0]]),
        (&[("A", half)], [[0.5, 0.5, 0.5, 1.0], [0.75, 0.75, 0.75, 1.0]]),
        (&[("R", a), ("G", b)], [[0.25, 2.0, 0.0, 1.0], [4.0, 3.0, 0.0, 1.0]]),
        (&[("R", a), ("G", b), ("B", c)], [[0.25, 2.0, 5.0, 1.0], [4.0, 3.0, 6.0, 1.0]]),
        (&[("R", a), ("G", b), ("B", c), ("A", half)], [[0.25, 2.0, 5.0, 0.5], [4.0, 3.0, 6.0, 0.75]]),
        (&[("R", a), ("G", b), ("B", c), ("Z", half)], [[0.25, 2.0, 5.0, 1.0], [4.0, 3.0, 6.0, 1.0]]),
    ];
    for (channels, expected) in cases {
        let (_folder, mut textures) = folder(&[("a.exr", exr(channels))]);
        let file = file("a.exr", Linear);
        let format = Format::R16G16B16A16_SFLOAT;
        assert_eq!(textures.info(&file), Ok(TextureInfo::picture([2, 1], format)), "{channels:?}");
        let texels =
            textures.texels(&file, &WantedTexels::picture(Format::R32G32B32A32_SFLOAT, [2, 1, 1])).expect("texels");
        let values: Vec<f32> = texels.as_chunks().0.iter().map(|bytes| f32::from_ne_bytes(*bytes)).collect();
        assert_eq!(values, expected.as_flattened(), "{channels:?}");
    }
    let refused = |channels: &[(&str, [f32; 2])]| {
        let (_folder, mut textures) = folder(&[("a.exr", exr(channels))]);
        textures.info(&file("a.exr", Linear)).expect_err("no colours").to_string()
    };
    let said = refused(&[("Y", a), ("RY", b), ("BY", c)]);
    assert!(
        said.ends_with("it holds luminance and chroma, or fewer values than texels: save it as R, G and B"),
        "{said}"
    );
    let said = refused(&[("u", a), ("v", b)]);
    assert!(
        said.contains("its channels are u, v: R, G and B are read, R and G, Y, and one channel of any name"),
        "{said}"
    );
}

/// Other programs write depth as a layer of its own, which may come first.
#[test]
fn of_several_layers_the_first_with_colours_is_read() {
    use exr::prelude::*;
    let layer = |names: &[&str], value: f32| {
        let channel = |name: &&str| AnyChannel::new(*name, FlatSamples::F32(vec![value; 2]));
        let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = names.iter().map(channel).collect();
        let attributes = LayerAttributes::named(names.join(" ").as_str());
        Layer::new((2, 1), attributes, Encoding::UNCOMPRESSED, AnyChannels::sort(channels))
    };
    let red_of = |layers: Vec<Layer<AnyChannels<FlatSamples>>>| {
        let attributes = ImageAttributes::new(IntegerBounds::from_dimensions((2, 1)));
        let mut bytes = Cursor::new(Vec::new());
        Image::from_layers(attributes, layers).write().non_parallel().to_buffered(&mut bytes).expect("it is written");
        let (_folder, mut textures) = folder(&[("a.exr", bytes.into_inner())]);
        let file = file("a.exr", Linear);
        let texels =
            textures.texels(&file, &WantedTexels::picture(Format::R32G32B32A32_SFLOAT, [2, 1, 1])).expect("texels");
        f32::from_ne_bytes(texels[..4].try_into().expect("a number"))
    };
    let depth = || layer(&["Z"], 3.0);
    assert_eq!(red_of(vec![depth(), layer(&["R", "G", "B"], 0.5), layer(&["Y"], 2.0)]), 0.5);
    assert_eq!(red_of(vec![depth(), layer(&["u", "v"], 4.0), layer(&["Y"], 2.0)]), 2.0);
    assert_eq!(red_of(vec![layer(&["u", "v"], 4.0), depth(), layer(&["mask"], 5.0)]), 3.0);
}

#[test]
fn luminance_with_fewer_values_of_chroma_is_refused_by_what_it_is() {
    // The list of channels in the header: name, kind, three bytes, and the distance of values across and down.
    let mut chroma = exr(&[("BY", [0.0; 2]), ("RY", [0.0; 2]), ("Y", [1.0; 2])]);
    let at = chroma.windows(3).position(|name| name == b"BY\0").expect("the channel");
    chroma[at + 3 + 8] = 2;
    let (_folder, mut textures) = folder(&[("a.exr", chroma)]);
    let said = textures.info(&file("a.exr", Linear)).expect_err("luminance and chroma").to_string();
    assert!(said.contains("luminance and chroma") && said.contains("save it as R, G and B"), "{said}");
}

#[test]
fn a_radiance_file_may_begin_with_the_name_of_any_program() {
    let light = floats(9, 2, |x, y| [0.25 + x as f32, 4.0, y as f32]);
    let usual = encoded(&light, ImageFormat::Hdr);
    let rest = usual.strip_prefix(b"#?RADIANCE").expect("the usual name");
    let texels = |bytes: Vec<u8>| {
        let (_folder, mut textures) = folder(&[("a.hdr", bytes)]);
        let file = file("a.hdr", Linear);
        assert_eq!(textures.info(&file)?.extent, [9, 2, 1]);
        textures.texels(&file, &WantedTexels::picture(Format::R32G32B32A32_SFLOAT, [9, 2, 1]))
    };
    let expected = texels(usual.clone()).expect("texels");
    for name in ["#?RGBE", "#?AUTOPANO", "\u{feff}#?RADIANCE", "#?"] {
        assert_eq!(texels([name.as_bytes(), rest].concat()).as_ref(), Ok(&expected), "{name}");
    }
    let no = texels([b"#!RGBE", rest].concat()).expect_err("no picture").to_string();
    assert_eq!(no, "is no picture that can be read: neither PNG nor JPEG, HDR, EXR, KTX2 or DDS");
    let long = [&b"#?"[..], &[b'a'; 1000], rest].concat();
    assert!(texels(long).is_err());
}

#[cfg(unix)]
#[test]
fn no_pipe_is_waited_for_and_no_device_read() {
    let (folder, mut textures) = folder(&[]);
    let made = std::process::Command::new("mkfifo").arg(folder.path().join("pipe.png")).status().expect("mkfifo");
    assert!(made.success());
    let said = textures.info(&file("pipe.png", Linear)).expect_err("a pipe").to_string();
    assert_eq!(said, "can't be read: it is not a regular file");
}

#[test]
fn a_strip_becomes_slices() {
    // Red to the right, green downwards, blue from square to square.
    let strip = bytes(4, 2, |x, y| [(x % 2) as u8, y as u8, (x / 2) as u8, 255]);
    let (_folder, mut textures) = folder(&[("lut.png", encoded(&strip, ImageFormat::Png))]);
    let file = file("lut.png", Linear);
    let texels = textures.texels(&file, &WantedTexels::picture(Format::R8G8B8A8_UNORM, [2, 2, 2])).expect("texels");
    let expected: Vec<u8> = (0..8_u8).flat_map(|texel| [texel & 1, texel >> 1 & 1, texel >> 2 & 1, 255]).collect();
    assert_eq!(texels, expected);
    let wrong = textures.texels(&file, &WantedTexels::picture(Format::R8G8B8A8_UNORM, [3, 3, 3]));
    assert_eq!(wrong, Err(TextureProblem::Size { found: [4, 2], expected: [9, 3], strip: true }));
}

#[test]
fn no_path_leads_out_of_the_folder() {
    let picture = encoded(&bytes(1, 1, |_, _| [0; 4]), ImageFormat::Png);
    let (outside, _) = folder(&[("a.png", picture.clone())]);
    let (inside, mut textures) = folder(&[("a.png", picture)]);
    let absolute = outside.path().join("a.png").to_string_lossy().into_owned();
    for path in ["../a.png", "b/../../a.png", &absolute] {
        assert_eq!(textures.info(&file(path, Srgb)), Err(TextureProblem::Outside), "{path}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(outside.path().join("a.png"), inside.path().join("link.png")).expect("a link");
        assert_eq!(textures.info(&file("link.png", Srgb)), Err(TextureProblem::Outside));
    }
    assert!(textures.info(&file("a.png", Srgb)).is_ok());
    let missing = textures.info(&file("missing.png", Srgb));
    assert!(matches!(missing, Err(TextureProblem::Unreadable { .. })), "{missing:?}");
    drop(inside);
}

#[test]
fn a_picture_that_is_too_large_is_refused_before_it_is_decoded() {
    let side = MOST_SIDE + 1;
    let long: DynamicImage = image::GrayImage::new(side, 1).into();
    let (_folder, mut textures) = folder(&[("long.png", encoded(&long, ImageFormat::Png))]);
    let problem = textures.info(&file("long.png", Linear)).expect_err("too long");
    assert!(matches!(problem, TextureProblem::TooLarge { extent, .. } if extent == [side, 1]), "{problem}");
}

#[test]
fn damaged_pictures_are_refused_with_words() {
    let small = bytes(8, 8, |x, y| [x as u8, y as u8, 0, 255]);
    let light = floats(8, 8, |x, y| [x as f32, y as f32, 0.5]);
    let jpeg = DynamicImage::from(small.to_rgb8());
    let whole = [
        ("a.png", encoded(&small, ImageFormat::Png)),
        ("a.jpg", encoded(&jpeg, ImageFormat::Jpeg)),
        ("a.exr", encoded(&light, ImageFormat::OpenExr)),
        ("a.hdr", encoded(&light, ImageFormat::Hdr)),
    ];
    let mut refused = 0;
    let mut try_it = |name: &str, bytes: Vec<u8>| {
        let (_folder, mut textures) = folder(&[(name, bytes)]);
        let texels =
            textures.texels(&file(name, Linear), &WantedTexels::picture(Format::R16G16B16A16_SFLOAT, [8, 8, 1]));
        match texels {
            Ok(texels) => assert_eq!(texels.len(), 8 * 8 * 8),
            Err(problem) => {
                assert!(!problem.to_string().is_empty());
                refused += 1;
            }
        }
    };
    for (name, bytes) in &whole {
        for length in 0..bytes.len().min(300) {
            try_it(name, bytes[..length].to_vec());
        }
        for at in 0..bytes.len().min(300) {
            for bit in [1, 0x80] {
                let mut flipped = bytes.clone();
                flipped[at] ^= bit;
                try_it(name, flipped);
            }
        }
    }
    assert!(refused > 1000, "{refused}");
    let (_folder, mut textures) = folder(&[("a.png", b"not a picture at all".to_vec())]);
    let problem = textures.info(&file("a.png", Linear)).expect_err("no picture").to_string();
    assert_eq!(problem, "is no picture that can be read: neither PNG nor JPEG, HDR, EXR, KTX2 or DDS");
}
