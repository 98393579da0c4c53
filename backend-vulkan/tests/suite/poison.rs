//! Memory that changes hands: nobody may see what its last owner left, or what the poison put there.

use crate::testing::{self, Nothing, OVER_ALL};
use framewright_graph::base::Span;
use framewright_graph::compile::{Options, compile};
use framewright_graph::frame::{self, Blend, ColorTarget, Draw, Frame, ImageIndex, Pass, SampledImage, Work};
use framewright_graph::plan::{Plan, Role};
use framewright_graph::shader::DrawInterface;
use framewright_graph::vulkan::{Format, Stages, Subresources};
use framewright_vulkan::{Device, Error, Executor, ExecutorOptions, ShaderLibrary};

/// Each image holds the one before, and a little more; `sum` adds two.
const SHADERS: &[(&str, &str)] = &[
    ("full_screen.vert", OVER_ALL),
    (
        "begin.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() { color = vec4(floor(gl_FragCoord.xy) * 8.0, 16.0, 255.0) / 255.0; }",
    ),
    (
        "next.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D source;
        layout(location = 0) out vec4 color;
        void main() { color = texelFetch(source, ivec2(gl_FragCoord.xy), 0) + vec4(1.0, 2.0, 3.0, 0.0) / 255.0; }",
    ),
    (
        "sum.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D source;
        layout(set = 0, binding = 1) uniform sampler2D older;
        layout(location = 0) out vec4 color;
        void main() {
            ivec2 at = ivec2(gl_FragCoord.xy);
            color = vec4(texelFetch(source, at, 0).rgb + texelFetch(older, at, 0).rgb, 1.0);
        }",
    ),
];

const EXTENT: [u32; 2] = [8, 8];

fn pass(name: &str, shader: &str, sampled: &[(&str, u32)], target: u32) -> Pass {
    let sampled =
        sampled.iter().map(|(binding, image)| SampledImage::new(*binding, ImageIndex(*image), Stages::FRAGMENT_SHADER));
    let work = Work::Draw { draw: Draw::FullScreen, shader: shader.into(), discards: false, per_sample: false };
    let (image, range) = (ImageIndex(target), Subresources::WHOLE);
    Pass {
        sampled: sampled.collect(),
        color: vec![ColorTarget {
            image,
            range,
            span: Span::NONE,
            clear: None,
            blend: Blend::Replace,
            write_mask: Default::default(),
        }],
        ..Pass::new(name, work)
    }
}

/// Images `a`, `b`, `c` and the output, drawn one after the other; with `long`, the pass that draws `c` reads `a` too.
fn chain(long: bool) -> Frame {
    let image = |name: &str| frame::Image::new(name, Format::R8G8B8A8_UNORM, EXTENT[0], EXTENT[1]);
    let third = if long {
        pass("third", "sum", &[("source", 1), ("older", 0)], 2)
    } else {
        pass("third", "next", &[("source", 1)], 2)
    };
    Frame {
        images: ["a", "b", "c", "screen"].map(image).into(),
        passes: vec![
            pass("first", "begin", &[], 0),
            pass("second", "next", &[("source", 0)], 1),
            third,
            pass("last", "next", &[("source", 2)], 3),
        ],
        outputs: vec![frame::Resource::Image(ImageIndex(3)).into()],
        ..Frame::default()
    }
}

fn planned(device: &Device, frame: &Frame, alias: bool, poison: bool) -> Plan {
    let options = Options { alias, poison, ..Options::default() };
    compile(frame, &device.profile(), &mut device.memory(), &options).expect("the frame compiles")
}

fn library() -> ShaderLibrary {
    ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default())
}

fn picture(executor: Result<Executor, Error>) -> Vec<u8> {
    let mut executor = executor.expect("an executor");
    for _ in 0..2 {
        executor.frame(&mut Nothing).expect("a frame");
    }
    executor.read(0).expect("texels").bytes
}

fn run(device: &Device, plan: &Plan, poison: bool) -> Vec<u8> {
    let options = ExecutorOptions { poison, ..ExecutorOptions::default() };
    picture(Executor::new(device, plan, &mut library(), &options))
}

#[test]
fn shared_memory_and_poison_leave_the_picture_as_it_is() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let frame = chain(false);
    let aliased = planned(&device, &frame, true, false);
    let apart = planned(&device, &frame, false, false);
    assert!(aliased.totals.placed_bytes < apart.totals.placed_bytes, "memory is shared");
    let expected: Vec<u8> =
        (0..8).flat_map(|y| (0..8).flat_map(move |x| [x * 8 + 3, y * 8 + 6, 16 + 9, 255])).collect();
    assert_eq!(run(&device, &apart, false), expected);
    assert_eq!(run(&device, &aliased, false), expected);
    assert_eq!(run(&device, &planned(&device, &frame, true, true), true), expected);
    drop(device);
    assert_eq!(testing::findings(&messages), []);
}

#[test]
fn a_lifetime_that_is_a_step_too_short_shows_under_poison() {
    let Some(device) = testing::device() else { return };
    let mut plan = planned(device, &chain(true), true, true);
    let expected = run(device, &plan, true);
    // The third step reads `a` and draws `c`: had `a` ended a step earlier, `c` would lie where `a` is.
    let place_of = |plan: &Plan, image: usize| match &plan.images[image].role {
        Role::Transient(place) => place.clone(),
        Role::External { .. } | Role::Persistent { .. } => panic!("image {image} is transient"),
    };
    let [a, c] = ["a", "c"].map(|name| plan.images.iter().position(|image| *image.name == *name).expect("it is there"));
    assert_eq!(place_of(&plan, a).lifetime[1], place_of(&plan, c).lifetime[0], "they meet in one step");
    let (heap, offset) = (place_of(&plan, a).heap, place_of(&plan, a).offset);
    if let Role::Transient(place) = &mut plan.images[c].role {
        (place.heap, place.offset) = (heap, offset);
    }
    let refused = Executor::new(device, &plan, &mut library(), &ExecutorOptions::default()).err();
    assert!(matches!(refused, Some(Error::Violations { .. })), "{refused:?}");
    let options = ExecutorOptions { poison: true, ..ExecutorOptions::default() };
    // SAFETY: the tests run on software drivers, which execute commands in order.
    let seen = picture(unsafe { Executor::with_hazards(device, &plan, &mut library(), &options) });
    assert_ne!(seen, expected);
}
