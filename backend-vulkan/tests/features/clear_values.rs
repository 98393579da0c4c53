//! The greatest and the least numbers of every format, as clear values of draws and as fills: the bytes are those of Vulkan's
//! own words on formats. (Numbers that a format doesn't hold are refused before: graph/tests/suite/language/exact_values.rs.)

use crate::frames::{Shaders, Small, Uses, draw, in_each_way, on_each_driver, plane, transfer};
use framewright_graph::base::Span;
use framewright_graph::frame::{DepthTarget, Draw, ImageIndex, Resource, StencilState, Work};
use framewright_graph::vulkan::{Aspects, CompareOp, FillValue, Format, Numeric, StencilOp, Subresources, Usage};
use framewright_vulkan::Device;

const WHOLE: Subresources = Subresources::WHOLE;
const EXTENT: [u32; 2] = [3, 2];
const TEXELS: usize = 6;

/// Draws that leave every texel as it was cleared.
const SHADERS: Shaders = &[
    ("nothing.frag", "#version 460\nlayout(location = 0) out vec4 color; void main() { color = vec4(0.0); discard; }"),
    (
        "nothing_u.frag",
        "#version 460\nlayout(location = 0) out uvec4 color; void main() { color = uvec4(0); discard; }",
    ),
    (
        "nothing_i.frag",
        "#version 460\nlayout(location = 0) out ivec4 color; void main() { color = ivec4(0); discard; }",
    ),
    ("nothing_d.frag", "#version 460\nvoid main() { discard; }"),
];

/// Numbers, and the bytes of a texel that holds them.
type Case = ([f64; 4], Vec<u8>);

/// The components of a texel of equally large ones, each of `size` bytes.
fn parts(format: Format, size: usize, parts: [i64; 4]) -> Vec<u8> {
    let order = if format.name().starts_with("B8") { [2, 1, 0, 3] } else { [0, 1, 2, 3] };
    let held = order.into_iter().take(format.components() as usize);
    held.flat_map(|part| parts[part].to_le_bytes()[..size].to_vec()).collect()
}

fn words(word: u32) -> Vec<u8> {
    word.to_le_bytes().to_vec()
}

#[allow(clippy::cast_precision_loss, reason = "whole numbers of 32 bits")]
fn cases(format: Format) -> Vec<Case> {
    let size = (format.texel_bytes() / u64::from(format.components())) as usize;
    let bits = 8 * size;
    let equal = |numbers: [f64; 4], held: [i64; 4]| (numbers, parts(format, size, held));
    match format {
        Format::A2B10G10R10_UNORM_PACK32 => {
            vec![([1.0, 0.0, 1.0, 1.0], words(0xFFF0_03FF)), ([0.0, 1.0, 0.0, 0.0], words(0x000F_FC00))]
        }
        Format::A2R10G10B10_UNORM_PACK32 => {
            vec![([1.0, 0.0, 1.0, 1.0], words(0xFFF0_03FF)), ([0.0, 1.0, 0.0, 0.0], words(0x000F_FC00))]
        }
        // The largest mantissa with the largest exponent, and 1: a half with an exponent for 1.
        Format::E5B9G9R9_UFLOAT_PACK32 => vec![
            ([65408.0, 0.0, 65408.0, 1.0], words(31 << 27 | 511 << 18 | 511)),
            ([1.0, 0.0, 0.5, 1.0], words(16 << 27 | 128 << 18 | 256)),
        ],
        Format::B10G11R11_UFLOAT_PACK32 => vec![
            ([65024.0, 0.0, 64512.0, 1.0], words(0x3DF << 22 | 0x7BF)),
            ([0.0, 65024.0, 1.0, 1.0], words(0x1E0 << 22 | 0x7BF << 11)),
        ],
        _ => match format.numeric() {
            Numeric::Uint => {
                let most = (1_i64 << bits) - 1;
                let mut cases = vec![[most, 0, most, 1], [0, most, 1, most], [1, 2, 3, 4]];
                cases.extend((bits == 32).then_some([16_777_217, 4_294_967_167, 0, 16_777_219]));
                cases.into_iter().map(|held| equal(held.map(|it| it as f64), held)).collect()
            }
            Numeric::Sint => {
                let (least, most) = (-(1_i64 << (bits - 1)), (1_i64 << (bits - 1)) - 1);
                let mut cases = vec![[most, least, most, -1], [least, most, -1, 0], [-1, -2, 3, 4]];
                cases.extend((bits == 32).then_some([16_777_217, -16_777_217, 0, -16_777_219]));
                cases.into_iter().map(|held| equal(held.map(|it| it as f64), held)).collect()
            }
            Numeric::Unorm | Numeric::Srgb => {
                let most = (1_i64 << bits) - 1;
                vec![equal([1.0, 0.0, 1.0, 0.0], [most, 0, most, 0]), equal([0.0, 1.0, 0.0, 1.0], [0, most, 0, most])]
            }
            Numeric::Snorm => {
                let most = (1_i64 << (bits - 1)) - 1;
                vec![
                    equal([1.0, -1.0, 0.0, 1.0], [most, -most, 0, most]),
                    equal([-1.0, 1.0, 1.0, -1.0], [-most, most, most, -most]),
                ]
            }
            Numeric::Sfloat if bits == 16 => vec![
                equal([65504.0, -65504.0, 0.5, -2.0], [0x7BFF, 0xFBFF, 0x3800, 0xC000]),
                equal([-65504.0, 65504.0, 0.0, 1.0], [0xFBFF, 0x7BFF, 0, 0x3C00]),
            ],
            Numeric::Sfloat => {
                let numbers = [f32::MAX, f32::MIN, 16_777_216.0, -0.1];
                let turned = [f32::MIN_POSITIVE, f32::MAX, 1.0, 0.25];
                [numbers, turned].map(|it| equal(it.map(f64::from), it.map(|it| it.to_bits().into()))).to_vec()
            }
            Numeric::Ufloat => unreachable!("one format"),
        },
    }
}

fn can(device: &Device, format: Format, usage: Usage) -> bool {
    device.profile().format(format).is_some_and(|support| support.usage.contains(usage | Usage::TRANSFER_SRC))
}

/// Draws a frame of one image in each way, and compares a plane of it.
fn judge(device: &Device, mut small: Small, image: ImageIndex, aspect: Aspects, wanted: &[u8], what: &str) {
    small.image_output(image);
    in_each_way(device, &small.frame, SHADERS, |executor| {
        crate::frames::frame(executor);
        let found = executor.read_image("i", aspect, 0).expect("its texels").bytes;
        assert_eq!(found, wanted.repeat(TEXELS), "{what}");
    });
}

fn nothing(letter: &str) -> Work {
    let shader = format!("nothing{letter}").into();
    Work::Draw { draw: Draw::FullScreen, shader, discards: true, per_sample: false }
}

#[test]
fn every_format_is_cleared_to_the_very_numbers() {
    on_each_driver(|device| {
        let mut tried = 0;
        for format in Format::ALL.iter().copied().filter(|format| !format.is_depth() && !format.is_compressed()) {
            if !can(device, format, Usage::COLOR_ATTACHMENT) {
                continue;
            }
            let letter = match format.numeric() {
                Numeric::Uint => "_u",
                Numeric::Sint => "_i",
                _ => "",
            };
            for (numbers, wanted) in cases(format) {
                let mut small = Small::default();
                let image = small.image("i", format, EXTENT);
                let mut pass = draw("clear", Draw::FullScreen);
                pass.work = nothing(letter);
                small.pass(pass.draws(image, WHOLE, Some(numbers)));
                judge(device, small, image, Aspects::COLOR, &wanted, &format!("{format} cleared to {numbers:?}"));
            }
            tried += 1;
        }
        assert!(tried > 30, "{tried} formats can be drawn");
    });
}

#[test]
fn every_format_is_filled_with_the_very_numbers() {
    on_each_driver(|device| {
        let mut tried = 0;
        for format in Format::ALL.iter().copied().filter(|format| !format.is_depth() && !format.is_compressed()) {
            if !can(device, format, Usage::TRANSFER_DST) {
                continue;
            }
            for (numbers, wanted) in cases(format) {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the format holds them")]
                let value = match format.numeric() {
                    Numeric::Uint => FillValue::Bits(numbers.map(|number| number as u32)),
                    Numeric::Sint => FillValue::Bits(numbers.map(|number| (number as i32).cast_unsigned())),
                    _ => FillValue::Color(numbers.map(|number| number as f32)),
                };
                let mut small = Small::default();
                let image = small.image("i", format, EXTENT);
                small.pass(transfer("fill", Work::Fill { value }, &[(Resource::Image(image), WHOLE, true)]));
                judge(device, small, image, Aspects::COLOR, &wanted, &format!("{format} filled with {numbers:?}"));
            }
            tried += 1;
        }
        assert!(tried > 30, "{tried} formats can be filled");
    });
}

/// Depth as a copy finds it in a buffer. Of 24 bits the upper eight are undefined.
fn depth_bytes(format: Format, depth: f64) -> Vec<u8> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 1")]
    match format {
        Format::D16_UNORM => ((depth * 65535.0).round() as u16).to_le_bytes().to_vec(),
        Format::X8_D24_UNORM_PACK32 | Format::D24_UNORM_S8_UINT => {
            ((depth * 16_777_215.0).round() as u32).to_le_bytes()[..3].to_vec()
        }
        _ => (depth as f32).to_le_bytes().to_vec(),
    }
}

#[test]
fn depth_and_stencil_are_set_each_by_itself() {
    on_each_driver(|device| {
        let mut tried = 0;
        for format in Format::ALL.iter().copied().filter(|format| format.is_depth()) {
            if !can(device, format, Usage::DEPTH_STENCIL_ATTACHMENT | Usage::TRANSFER_DST) {
                continue;
            }
            let stencil = format.aspects().contains(Aspects::STENCIL);
            for (depth, marked) in [(0.0, 255), (1.0, 0), (0.5, 1), (1.0, 128)] {
                let mut cleared = Small::default();
                let image = cleared.image("i", format, EXTENT);
                let mut pass = draw("clear", Draw::FullScreen);
                pass.work = nothing("_d");
                let state =
                    StencilState { clear: Some(marked), test: CompareOp::Always, reference: 0, pass: StencilOp::Keep };
                cleared.pass(pass.tests(DepthTarget {
                    image,
                    range: WHOLE,
                    span: Span::NONE,
                    clear: Some(depth),
                    test: CompareOp::Always,
                    write: true,
                    stencil: stencil.then_some(state),
                }));
                let mut filled = Small::default();
                let image = filled.image("i", format, EXTENT);
                #[allow(clippy::cast_possible_truncation, reason = "depth has single precision")]
                let values = match stencil {
                    // Each value by itself, and beside it the other plane's, which must not be touched.
                    true => vec![
                        (FillValue::Depth(0.25, 77), WHOLE),
                        (FillValue::Depth(0.0, marked), plane(Aspects::STENCIL)),
                        (FillValue::Depth(depth as f32, 0), plane(Aspects::DEPTH)),
                    ],
                    false => vec![(FillValue::Depth(depth as f32, 0), WHOLE)],
                };
                for (at, (value, range)) in values.into_iter().enumerate() {
                    let sides = [(Resource::Image(image), range, true)];
                    filled.pass(transfer(&format!("fill {at}"), Work::Fill { value }, &sides));
                }
                for (mut small, how) in [(cleared, "cleared"), (filled, "filled")] {
                    small.image_output(image);
                    in_each_way(device, &small.frame, SHADERS, |executor| {
                        crate::frames::frame(executor);
                        let what = format!("{format} {how} with {depth} and {marked}");
                        let wanted = depth_bytes(format, depth);
                        let found = executor.read_image("i", Aspects::DEPTH, 0).expect("its depth").bytes;
                        for texel in found.chunks_exact(found.len() / TEXELS) {
                            assert_eq!(texel[..wanted.len()], wanted, "{what}");
                        }
                        if stencil {
                            let found = executor.read_image("i", Aspects::STENCIL, 0).expect("its stencil").bytes;
                            assert_eq!(found, [marked; TEXELS], "{what}");
                        }
                    });
                }
            }
            tried += 1;
        }
        assert!(tried > 2, "{tried} formats of depth");
    });
}
