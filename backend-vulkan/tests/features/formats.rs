//! Images of the less usual formats: shaders store, draw, clear and read them, and the bytes are those that the format says.

use crate::frames::{Shaders, Small, Uses, dispatch, draw, in_each_way, on_each_driver, transfer};
use framewright_graph::frame::{Draw, Groups, Resource, Work};
use framewright_graph::vulkan::{Aspects, FillValue, Format, Numeric, Subresources, Usage};
use framewright_vulkan::Device;

const WHOLE: Subresources = Subresources::WHOLE;
const EXTENT: [u32; 2] = [4, 3];

const FORMATS: [Format; 24] = [
    Format::R8_SNORM,
    Format::R8_SINT,
    Format::R8G8_SNORM,
    Format::R8G8_UINT,
    Format::R8G8_SINT,
    Format::R8G8B8A8_SNORM,
    Format::R8G8B8A8_SINT,
    Format::R16_UNORM,
    Format::R16_SNORM,
    Format::R16_UINT,
    Format::R16_SINT,
    Format::R16G16_UNORM,
    Format::R16G16_SNORM,
    Format::R16G16_UINT,
    Format::R16G16_SINT,
    Format::R16G16B16A16_UNORM,
    Format::R16G16B16A16_SNORM,
    Format::R16G16B16A16_UINT,
    Format::R16G16B16A16_SINT,
    Format::R32_SINT,
    Format::R32G32_UINT,
    Format::R32G32_SINT,
    Format::R32G32B32A32_UINT,
    Format::R32G32B32A32_SINT,
];

fn letter(format: Format) -> &'static str {
    match format.numeric() {
        Numeric::Uint => "u",
        Numeric::Sint => "i",
        _ => "",
    }
}

fn is_signed(format: Format) -> bool {
    matches!(format.numeric(), Numeric::Snorm | Numeric::Sint)
}

/// The value of a component of a texel: −1, 0 or 1 where the format holds shares, a small whole number where it holds those.
fn value([x, y]: [i64; 2], component: i64, format: Format) -> i64 {
    let number = x + 4 * y + component;
    let shares = !format.is_integer();
    match (shares, is_signed(format)) {
        (true, true) => number % 3 - 1,
        (true, false) => number % 2,
        (false, true) => 5 * number - 40,
        (false, false) => 5 * number,
    }
}

/// The same in GLSL.
fn glsl(format: Format) -> String {
    let letter = letter(format);
    let expression = match (format.is_integer(), is_signed(format)) {
        (false, true) => "number % 3 - 1",
        (false, false) => "number % 2",
        (true, true) => "5 * number - 40",
        (true, false) => "5 * number",
    };
    format!(
        "{letter}vec4 value(ivec2 at) {{ ivec4 number = at.x + 4 * at.y + ivec4(0, 1, 2, 3); return {letter}vec4({expression}); }}"
    )
}

fn shaders(format: Format) -> Shaders {
    let letters = ["r", "rg", "", "rgba"][format.components() as usize - 1];
    let bits = 8 * format.texel_bytes() / u64::from(format.components());
    let kind = match format.numeric() {
        Numeric::Uint => "ui",
        Numeric::Sint => "i",
        Numeric::Snorm => "_snorm",
        _ => "",
    };
    let (letter, value) = (letter(format), glsl(format));
    let store = format!(
        "#version 460
        layout(local_size_x = 4, local_size_y = 4) in;
        layout(set = 0, binding = 0, {letters}{bits}{kind}) uniform writeonly {letter}image2D target;
        {value}
        void main() {{
            ivec2 at = ivec2(gl_GlobalInvocationID.xy);
            if (all(lessThan(at, imageSize(target)))) imageStore(target, at, value(at));
        }}"
    );
    // The first column stays as it was cleared.
    let paint = format!(
        "#version 460
        layout(location = 0) out {letter}vec4 color;
        {value}
        void main() {{
            if (gl_FragCoord.x < 1.0) discard;
            color = value(ivec2(gl_FragCoord.xy));
        }}"
    );
    let read = format!(
        "#version 460
        layout(local_size_x = 4, local_size_y = 4) in;
        layout(set = 0, binding = 0) uniform {letter}sampler2D source;
        layout(set = 0, binding = 1) writeonly buffer Words {{ int word[]; }} words;
        void main() {{
            ivec2 at = ivec2(gl_GlobalInvocationID.xy);
            if (at.x < 4 && at.y < 3) words.word[at.x + 4 * at.y] = int(texelFetch(source, at, 0).r);
        }}"
    );
    let texts = [("store.comp", store), ("paint.frag", paint), ("read.comp", read)];
    texts.map(|(name, text)| (name, &*text.leak())).to_vec().leak()
}

/// The bytes of all texels, of which those of the first column hold `first` if it is given.
fn bytes(format: Format, first: Option<i64>) -> Vec<u8> {
    let size = (format.texel_bytes() / u64::from(format.components())) as usize;
    let most = (1_i64 << (8 * size - usize::from(is_signed(format)))) - 1;
    let component = |value: i64| {
        let stored = if format.is_integer() { value } else { value * most };
        stored.to_le_bytes()[..size].to_vec()
    };
    let texels = (0..3).flat_map(|y| (0..4).map(move |x| [x, y]));
    let components = texels.flat_map(|at| (0..i64::from(format.components())).map(move |number| (at, number)));
    components
        .flat_map(|(at, number)| component(first.filter(|_| at[0] == 0).unwrap_or(value(at, number, format))))
        .collect()
}

/// The first component of all texels.
fn read(format: Format, first: Option<i64>) -> Vec<i64> {
    let texels = (0..3).flat_map(|y| (0..4).map(move |x| [x, y]));
    texels.map(|at| first.filter(|_| at[0] == 0).unwrap_or(value(at, 0, format))).collect()
}

fn can(device: &Device, format: Format, usage: Usage) -> bool {
    device
        .profile()
        .format(format)
        .is_some_and(|support| support.usage.contains(usage | Usage::SAMPLED | Usage::TRANSFER_SRC))
}

/// Adds the reading pass, draws a frame, and compares the texels.
fn judge(device: &Device, mut small: Small, format: Format, first: Option<i64>) {
    let (image, words) = (framewright_graph::frame::ImageIndex(0), small.buffer("words", 12));
    small.pass(dispatch("read", Groups::Count([1, 1, 1])).samples("source", image, WHOLE).block(
        "words",
        words,
        (false, true),
    ));
    small.image_output(image);
    small.buffer_output(words);
    in_each_way(device, &small.frame, shaders(format), |executor| {
        crate::frames::frame(executor);
        let found = executor.read_image("i", Aspects::COLOR, 0).expect("its texels").bytes;
        assert_eq!(found, bytes(format, first), "{format}");
        let found = crate::frames::words(executor, "words");
        assert_eq!(
            found.iter().map(|word| i64::from(word.cast_signed())).collect::<Vec<_>>(),
            read(format, first),
            "{format}"
        );
    });
}

#[test]
fn what_a_compute_shader_stores_is_read_by_shaders_and_by_the_host() {
    on_each_driver(|device| {
        let formats = FORMATS.into_iter().filter(|format| can(device, *format, Usage::STORAGE));
        let mut tried = 0;
        for format in formats {
            let mut small = Small::default();
            let image = small.image("i", format, EXTENT);
            small.pass(dispatch("store", Groups::Count([1, 1, 1])).stores("target", image, WHOLE));
            judge(device, small, format, None);
            tried += 1;
        }
        assert!(tried > 10, "{tried} formats can be stored");
    });
}

#[test]
fn what_is_cleared_and_drawn_is_read_by_shaders_and_by_the_host() {
    on_each_driver(|device| {
        let mut tried = 0;
        for format in FORMATS.into_iter().filter(|format| can(device, *format, Usage::COLOR_ATTACHMENT)) {
            let mut small = Small::default();
            let image = small.image("i", format, EXTENT);
            let first = match format.numeric() {
                Numeric::Sint => -7,
                Numeric::Uint => 7,
                Numeric::Snorm => -1,
                _ => 1,
            };
            let mut paint = draw("paint", Draw::FullScreen);
            paint.work =
                Work::Draw { draw: Draw::FullScreen, shader: "paint".into(), discards: true, per_sample: false };
            #[allow(clippy::cast_precision_loss, reason = "small")]
            let clear = [first as f64; 4];
            small.pass(paint.draws(image, WHOLE, Some(clear)));
            judge(device, small, format, Some(first));
            tried += 1;
        }
        assert!(tried > 10, "{tried} formats can be drawn");
    });
}

#[test]
fn negative_numbers_fill_signed_images() {
    on_each_driver(|device| {
        let mut small = Small::default();
        let image = small.image("i", Format::R16G16_SINT, EXTENT);
        let value = FillValue::Bits([-3, 4, 0, 0].map(i32::cast_unsigned));
        small.pass(transfer("fill", Work::Fill { value }, &[(Resource::Image(image), WHOLE, true)]));
        small.image_output(image);
        in_each_way(device, &small.frame, &[], |executor| {
            crate::frames::frame(executor);
            let found = executor.read_image("i", Aspects::COLOR, 0).expect("its texels").bytes;
            assert_eq!(found, [0xFD, 0xFF, 4, 0].repeat(12));
        });
    });
}
