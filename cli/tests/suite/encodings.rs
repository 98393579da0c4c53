//! Outputs that are encoded for HDR10, or as linear light, are drawn on both software drivers, written to a file as `run`
//! does, and read back by a decoder of our own.
//!
//! The loader takes its drivers from the environment, which a process can't change from within: each test starts itself
//! anew for each driver.

use crate::testing::{self, Vulkan};
use framewright_graph::base::Span;
use framewright_graph::compile::{Options, compile};
use framewright_graph::frame::{
    Blend, ColorTarget, Draw, Frame, Image, ImageIndex, Output, ParamValue, Pass, Resource, SampledImage, Work,
};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{self, *};
use framewright_graph::vulkan::{Encoding, Stages, Subresources};
use framewright_lab::picture::{FileFormat, Picture};
use framewright_passes::draw::interfaces;
use framewright_passes::shipped::SHADERS;
use framewright_passes::twin::hdr10::{PQ_PEAK, decode_pq, encode_hdr10};
use framewright_vulkan::{
    Device, DeviceOptions, DrawSource, Error, Executor, ExecutorOptions, Message, Recorder, ShaderLibrary, Texels,
};
use std::io::Read;

const WIDTH: u32 = 64;

/// Radiance at which `reference_white` is shown, cd/m².
const REFERENCE_WHITE: f64 = 203.0;

/// Grey, pure colours and a mixture, darker and brighter than HDR10 shows. Every number is exact in 32 bits.
const GRADIENT: &str = "#version 460
layout(location = 0) out vec4 color;
void main() {
    const vec3 tints[5] = vec3[](vec3(1.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0), vec3(0.25, 0.5, 1.0));
    const float x = gl_FragCoord.x - 0.5;
    color = vec4(tints[int(gl_FragCoord.y)] * x * x / 32.0, 0.5);
}";

const TINTS: [[f64; 3]; 5] = [[1.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.25, 0.5, 1.0]];

/// The same gradient.
fn radiance(x: u32, y: u32) -> [f64; 3] {
    TINTS[y as usize].map(|tint| tint * f64::from(x) * f64::from(x) / 32.0)
}

struct Nothing;

impl DrawSource for Nothing {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Ok(0)
    }
}

/// Pass `shader` draws the whole of an image of this format, from an image if there is one.
fn drawn(frame: &mut Frame, shader: &str, format: Format, from: Option<ImageIndex>) -> ImageIndex {
    let to = ImageIndex(u32::try_from(frame.images.len()).expect("few"));
    let height = u32::try_from(TINTS.len()).expect("few");
    frame.images.push(Image::new(&format!("{shader}ed"), format, WIDTH, height));
    let work = Work::Draw { draw: Draw::FullScreen, shader: shader.into(), discards: false, per_sample: false };
    let sampled = from.map(|image| SampledImage::new("source", image, Stages::FRAGMENT_SHADER));
    let color = ColorTarget {
        image: to,
        range: Subresources::WHOLE,
        span: Span::NONE,
        clear: None,
        blend: Blend::Replace,
        write_mask: Default::default(),
    };
    frame.passes.push(Pass { sampled: sampled.into_iter().collect(), color: vec![color], ..Pass::new(shader, work) });
    to
}

fn leaves(frame: &mut Frame, image: ImageIndex, encoding: Option<Encoding>) {
    frame.outputs.push(Output { encoding, ..Resource::Image(image).into() });
}

/// The first output of a frame, with what the Plan says of where it is encoded.
fn texels(frame: &Frame) -> (Texels, Option<Encoding>, Option<String>) {
    let options = DeviceOptions { validation: true, ..DeviceOptions::default() };
    let device = Device::open(&options).expect("a device");
    device.canary().expect("the layer is awake");
    let plan = compile(frame, &device.profile(), &mut device.memory(), &Options::default()).expect("a Plan");
    assert_eq!(verify(&plan), []);
    let shaders = [SHADERS, &[("gradient.frag", GRADIENT)]].concat().leak();
    let mut shaders = ShaderLibrary::new(Vec::new(), shaders, interfaces());
    let mut executor = Executor::new(&device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
    executor.frame(&mut Nothing).expect("a frame");
    let texels = executor.read(0).expect("texels");
    drop(executor);
    let messages = device.messages();
    drop(device);
    let findings: Vec<Message> = messages.list().into_iter().filter(Message::is_finding).collect();
    assert!(findings.is_empty(), "{findings:#?}");
    (texels, plan.outputs[0].encoding, plan.outputs[0].encoded.clone())
}

/// Runs the test of this name anew for each driver; whether this process is such a run.
fn on_both_drivers(test: &str) -> bool {
    const CHILD: &str = "FRAMEWRIGHT_TEST_ENCODINGS_HERE";
    if std::env::var_os(CHILD).is_some() {
        return true;
    }
    for vulkan in [Vulkan::LAVAPIPE_CURRENT, Vulkan::SWIFTSHADER_CURRENT] {
        let Some(variables) = vulkan.variables() else { continue };
        let mut command = std::process::Command::new(std::env::current_exe().expect("this test"));
        command.args([&format!("encodings::{test}"), "--exact", "--nocapture"]).envs(variables).env(CHILD, "1");
        command.env("VK_LAYER_PATH", testing::repository("tests/layer"));
        let outcome = testing::outcome(&mut command).exits(0);
        assert!(outcome.out.contains("1 passed"), "{}", outcome.out);
    }
    false
}

/// Chunks of a PNG, names and bytes, in their order.
fn chunks(file: &[u8]) -> Vec<([u8; 4], &[u8])> {
    let mut rest = file.strip_prefix(b"\x89PNG\r\n\x1a\n").expect("a PNG");
    let mut chunks = Vec::new();
    while let Some((header, after)) = rest.split_first_chunk::<8>() {
        let [a, b, c, d, name @ ..] = *header;
        let (data, after) = after.split_at(u32::from_be_bytes([a, b, c, d]) as usize);
        chunks.push((name, data));
        rest = &after[4..];
    }
    chunks
}

/// Red, green and blue of a PNG of 16 bits without alpha or interlacing, by the text of its standard (PNG, third edition).
fn decoded(file: &[u8]) -> Vec<[u16; 3]> {
    const PIXEL: usize = 6;
    let chunks = chunks(file);
    let named = |name: [u8; 4]| chunks.iter().filter(move |chunk| chunk.0 == name).map(|chunk| chunk.1);
    let header = named(*b"IHDR").next().expect("a header");
    assert_eq!(header[8..], [16, 2, 0, 0, 0], "16 bits, red, green and blue, not interlaced");
    let width = u32::from_be_bytes([header[0], header[1], header[2], header[3]]) as usize;
    let (packed, mut rows) = (named(*b"IDAT").collect::<Vec<_>>().concat(), Vec::new());
    flate2::read::ZlibDecoder::new(&*packed).read_to_end(&mut rows).expect("a zlib stream");
    let mut above = vec![0_u8; width * PIXEL];
    let mut pixels = Vec::new();
    for row in rows.chunks_exact(width * PIXEL + 1) {
        let (filter, mut line) = (row[0], row[1..].to_vec());
        for at in 0..line.len() {
            let left = |of: &[u8]| at.checked_sub(PIXEL).map_or(0, |at| i32::from(of[at]));
            let (a, b, c) = (left(&line), i32::from(above[at]), left(&above));
            let paeth = || [a, b, c].into_iter().min_by_key(|value| (a + b - c - value).abs()).unwrap_or(0);
            let predicted = match filter {
                0 => 0,
                1 => a,
                2 => b,
                3 => (a + b) / 2,
                4 => paeth(),
                other => panic!("no filter {other}"),
            };
            line[at] = line[at].wrapping_add(u8::try_from(predicted).expect("a byte"));
        }
        pixels.extend(line.chunks_exact(PIXEL).map(|it| [0, 2, 4].map(|at| u16::from_be_bytes([it[at], it[at + 1]]))));
        above = line;
    }
    pixels
}

#[test]
fn an_hdr10_picture_holds_the_light_that_was_drawn() {
    if !on_both_drivers("an_hdr10_picture_holds_the_light_that_was_drawn") {
        return;
    }
    for format in [A2B10G10R10_UNORM_PACK32, R16G16B16A16_UNORM] {
        let mut frame = Frame::default();
        let light = drawn(&mut frame, "gradient", R32G32B32A32_SFLOAT, None);
        let screen = drawn(&mut frame, "encode_hdr10", format, Some(light));
        frame.passes[1].params = vec![("reference_white".into(), ParamValue::Number(REFERENCE_WHITE))];
        leaves(&mut frame, screen, Some(Encoding::Hdr10));
        let (texels, encoding, encoded) = texels(&frame);
        assert_eq!(encoded.as_deref(), Some("by shader `encode_hdr10` of pass `encode_hdr10`"));
        let [width, height, _] = texels.extent;
        let picture = Picture { format: texels.format, encoding, extent: [width, height], bytes: &texels.bytes };
        let file = FileFormat::Png.encode(&picture).expect("a file");
        let code_points = chunks(&file).into_iter().find(|chunk| chunk.0 == *b"cICP").map(|chunk| chunk.1.to_vec());
        assert_eq!(code_points, Some(vec![9, 16, 0, 1]));
        let names: Vec<[u8; 4]> = chunks(&file).into_iter().map(|chunk| chunk.0).collect();
        assert_eq!((names[0], names[1], names.contains(b"sRGB")), (*b"IHDR", *b"cICP", false));
        // Vulkan lets a driver store either of the two closest steps, of which lavapipe takes the lower one of 1024. PQ
        // magnifies what it allows a logarithm to a sixteenth of a step of 10 bits. The file adds half a step of 16 bits.
        let step = if format == R16G16B16A16_UNORM { 1.0 / 65535.0 } else { 1.0 / 1023.0 };
        let bound = step + 1.0 / 1023.0 / 16.0 + 0.5 / 65535.0;
        let pixels = decoded(&file);
        assert_eq!(pixels.len(), (width * height) as usize);
        for (at, pixel) in (0_u32..).zip(pixels) {
            let light = radiance(at % width, at / width);
            let expected = encode_hdr10(light, REFERENCE_WHITE);
            for (found, expected) in pixel.into_iter().zip(expected) {
                let apart = (f64::from(found) / 65535.0 - expected).abs();
                assert!(apart <= bound, "{format}: {light:?} became {pixel:?}, {apart} from {expected}");
            }
        }
        // The light that the file's signal shows by the standard: the first row is grey, 1 at `reference_white`.
        let white = decoded(&file)[6];
        let luminance = decode_pq(f64::from(white[0]) / 65535.0) * PQ_PEAK;
        assert!((luminance - REFERENCE_WHITE * 36.0 / 32.0).abs() < 3.0, "{luminance} cd/m²");
    }
}

/// The value of a channel's samples in an OpenEXR file, as bits.
fn channel(file: &[u8], name: &str) -> Vec<u32> {
    use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
    let read = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = read.from_buffered(std::io::Cursor::new(file)).expect("an OpenEXR file");
    let list = &image.layer_data.channel_data.list;
    let found = list.iter().find(|channel| channel.name.eq(name)).unwrap_or_else(|| panic!("{name} is missing"));
    match &found.sample_data {
        FlatSamples::F16(samples) => samples.iter().map(|sample| sample.to_bits().into()).collect(),
        FlatSamples::F32(samples) => samples.iter().map(|sample| sample.to_bits()).collect(),
        FlatSamples::U32(_) => panic!("{name} holds integers"),
    }
}

#[test]
fn linear_light_comes_back_from_its_file_bit_for_bit() {
    if !on_both_drivers("linear_light_comes_back_from_its_file_bit_for_bit") {
        return;
    }
    for format in [R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT] {
        let mut frame = Frame::default();
        let light = drawn(&mut frame, "gradient", format, None);
        leaves(&mut frame, light, Some(Encoding::Linear));
        let (texels, encoding, encoded) = texels(&frame);
        assert_eq!((encoding, encoded), (Some(Encoding::Linear), None));
        let [width, height, _] = texels.extent;
        let picture = Picture { format, encoding, extent: [width, height], bytes: &texels.bytes };
        let file = FileFormat::OpenExr.encode(&picture).expect("a file");
        for (number, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
            let drawn: Vec<u32> = if format == R16G16B16A16_SFLOAT {
                let halves = texels.bytes.as_chunks::<2>().0.iter().skip(number).step_by(4);
                halves.map(|half| u16::from_ne_bytes(*half).into()).collect()
            } else {
                let floats = texels.bytes.as_chunks::<4>().0.iter().skip(number).step_by(4);
                floats.map(|float| u32::from_ne_bytes(*float)).collect()
            };
            assert_eq!(channel(&file, name), drawn, "{name} of {format}");
        }
        // And they are the light that was drawn: all of it is exact in 32 bits.
        if format == R32G32B32A32_SFLOAT {
            let red: Vec<u32> = (0..width * height)
                .map(|at| radiance(at % width, at / width)[0])
                .map(|red| (red as f32).to_bits())
                .collect();
            assert_eq!(channel(&file, "R"), red);
        }
    }
}

/// Numbers that are no light, and those at the ends of what a float holds, come through a file as they are.
#[test]
fn every_half_comes_back_bit_for_bit() {
    let halves: Vec<u16> = (0..=u16::MAX).collect();
    let bytes: Vec<u8> = halves.iter().flat_map(|half| half.to_ne_bytes()).collect();
    let picture = Picture { format: R16_SFLOAT, encoding: None, extent: [256, 256], bytes: &bytes };
    let file = FileFormat::OpenExr.encode(&picture).expect("a file");
    assert_eq!(channel(&file, "Y"), halves.into_iter().map(u32::from).collect::<Vec<_>>());
    // 11 and 10 bits are halves without a sign, cut short (Vulkan, "Unsigned 11-Bit Floating-Point Numbers").
    let word = 0x3c0_u32 | (0x3bf << 11) | (0x1df << 22);
    let small = Picture { format: B10G11R11_UFLOAT_PACK32, extent: [1, 1], bytes: &word.to_ne_bytes(), ..picture };
    let file = FileFormat::OpenExr.encode(&small).expect("a file");
    assert_eq!(["R", "G", "B"].map(|name| channel(&file, name)[0]), [0x3c00, 0x3bf0, 0x3be0]);
}
