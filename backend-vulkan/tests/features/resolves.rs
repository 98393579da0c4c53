//! Integers of several samples become sample zero, in a rendering scope and by a draw.

use crate::frames::{Shaders, Small, Uses, draw, on_each_driver, to_words};
use crate::testing::Nothing;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::Profile;
use framewright_graph::frame::{Draw, Image, Work};
use framewright_graph::shader::DrawInterface;
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Format, Numeric, Subresources};
use framewright_passes::shipped;
use framewright_vulkan::{Executor, ExecutorOptions, ShaderLibrary};

const NUMBERS: [(&str, &str); 2] = [
    (
        "number_uint.frag",
        "#version 460
        layout(location = 0) out uvec4 color;
        void main() { color = uvec4(gl_FragCoord.x + 10.0 * floor(gl_FragCoord.y)) + 50u * gl_SampleID; }",
    ),
    (
        "number_sint.frag",
        "#version 460
        layout(location = 0) out ivec4 color;
        void main() { color = ivec4(-int(gl_FragCoord.x + 10.0 * floor(gl_FragCoord.y)) - 50 * gl_SampleID); }",
    ),
];

#[test]
fn integers_become_sample_zero_whether_the_scope_resolves_them_or_a_draw() {
    let shaders: Shaders = [shipped::SHADERS, &NUMBERS].concat().leak();
    for format in [Format::R32_UINT, Format::R32_SINT] {
        let shader = if format.numeric() == Numeric::Sint { "number_sint" } else { "number_uint" };
        let mut small = Small::default();
        let numbers = small.image_like(Image { samples: 4, ..Image::new("numbers", format, 3, 2) });
        let mut pass = draw(shader, Draw::FullScreen).draws(numbers, Subresources::WHOLE, None);
        let Work::Draw { per_sample, .. } = &mut pass.work else { unreachable!("it draws") };
        *per_sample = true;
        small.pass(pass);
        small.image_output(numbers);
        on_each_driver(|device| {
            let honest = device.profile();
            // NVIDIA's driver 580 takes the last sample.
            let usual = u32::from(honest.refuted_integer_resolve);
            assert!(usual == 0 || honest.source.contains("NVIDIA"), "{}", honest.source);
            for (by_draw, inserted) in [(honest.refuted_integer_resolve, usual), (true, 1)] {
                let profile = Profile { refuted_integer_resolve: by_draw, ..honest.clone() };
                let plan = compile(&small.frame, &profile, &mut device.memory(), &Options::default());
                let plan = plan.unwrap_or_else(|errors| panic!("{errors:?}"));
                assert_eq!((verify(&plan), plan.totals.inserted_passes), (Vec::new(), inserted), "{}", plan.tree());
                let mut library = ShaderLibrary::new(Vec::new(), shaders, |_| DrawInterface::default());
                let mut executor =
                    Executor::new(device, &plan, &mut library, &ExecutorOptions::default()).expect("an executor");
                executor.frame(&mut Nothing).expect("a frame");
                let sign = if shader == "number_sint" { -1 } else { 1 };
                let expected = [0, 1, 2, 10, 11, 12].map(|number: i32| (sign * number).cast_unsigned());
                assert_eq!(
                    to_words(&executor.read(0).expect("texels").bytes),
                    expected,
                    "{format}, by a draw: {by_draw}"
                );
            }
        });
    }
}
