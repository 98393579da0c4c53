//! Arrays of images of the frame, given to a pass element by element (EM-5).

use crate::frames::{
    Shaders, Small, Uses, dispatch, draw, everywhere, frame, indexing, lacks, library, on_each_driver, placeless,
    planned, texels, transfer,
};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame, Groups, Image, ImageIndex, Lifetime, Pass, Resource, Work};
use framewright_graph::vulkan::{FillValue, Format, Subresources};
use framewright_vulkan::{Device, Executor, ExecutorOptions};

const WHOLE: Subresources = Subresources::WHOLE;

const SHADERS: Shaders = &[
    // Each pixel by its own number, and the shader is told that the array is there. Every device has numbers that are constants.
    (
        "by_constants.frag",
        "#version 460
        #ifdef HAS_taps
        layout(set = 0, binding = 0) uniform usampler2D taps[3];
        #endif
        layout(location = 0) out uint color;
        void main() {
            uint[3] found = uint[](
                texelFetch(taps[0], ivec2(0), 0).r, texelFetch(taps[1], ivec2(0), 0).r, texelFetch(taps[2], ivec2(0), 0).r
            );
            color = found[2 - int(gl_FragCoord.x) % 3];
        }",
    ),
    // The number is the same for all pixels.
    (
        "by_turns.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D taps[3];
        layout(location = 0) out uint color;
        void main() {
            for (int number = 0; number < 3; number++) {
                uint found = texelFetch(taps[number], ivec2(0), 0).r;
                if (number == 2 - int(gl_FragCoord.x) % 3) { color = found; }
            }
        }",
    ),
    (
        "by_pixel.frag",
        "#version 460
        #extension GL_EXT_nonuniform_qualifier : require
        layout(set = 0, binding = 0) uniform usampler2D taps[3];
        layout(location = 0) out uint color;
        void main() { color = texelFetch(taps[nonuniformEXT(2 - int(gl_FragCoord.x) % 3)], ivec2(0), 0).r; }",
    ),
    // From one array of storage images into another, in turned order.
    (
        "turn.comp",
        "#version 460
        layout(local_size_x = 6) in;
        layout(set = 0, binding = 0, r32ui) uniform readonly uimage2D sources[3];
        layout(set = 0, binding = 4, r32ui) uniform writeonly uimage2D targets[3];
        void main() {
            ivec2 at = ivec2(gl_LocalInvocationID.x, 0);
            imageStore(targets[0], at, imageLoad(sources[1], ivec2(0)) + 1);
            imageStore(targets[1], at, imageLoad(sources[2], ivec2(0)) + 1);
            imageStore(targets[2], at, imageLoad(sources[0], ivec2(0)) + 1);
        }",
    ),
    (
        "count.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D times[2];
        layout(location = 0) out uint color;
        void main() {
            // What this pass drew one frame and two frames before.
            color = 2 * texelFetch(times[0], ivec2(0), 0).r + texelFetch(times[1], ivec2(0), 0).r + 1;
        }",
    ),
];

/// Three images that are filled with 7, 20 and 300.
fn filled(small: &mut Small) -> [ImageIndex; 3] {
    [("seven", 7), ("twenty", 20), ("many", 300)].map(|(name, word)| {
        let image = small.image(name, Format::R32_UINT, [6, 1]);
        let value = FillValue::Bits([word, 0, 0, 0]);
        small.pass(transfer(name, Work::Fill { value }, &[(Resource::Image(image), WHOLE, true)]));
        image
    })
}

/// A pass that samples the images of its array in this order.
fn sampling(shader: &str, names: &[&str], order: &[usize]) -> Frame {
    let mut small = Small::default();
    let images = filled(&mut small);
    let shown = small.image("shown", Format::R32_UINT, [6, 1]);
    let sampled = |pass: Pass, (name, image): (&&str, &usize)| pass.samples(name, images[*image], WHOLE);
    let pass = names.iter().zip(order).fold(draw(shader, Draw::FullScreen), sampled);
    small.pass(pass.draws(shown, WHOLE, None));
    small.image_output(shown);
    small.frame
}

const NAMES: [&str; 3] = ["taps[0]", "taps[1]", "taps[2]"];

#[test]
fn each_element_is_the_image_that_was_given_to_it() {
    everywhere(&sampling("by_constants", &NAMES, &[0, 1, 2]), SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "shown", 0), [300, 20, 7, 300, 20, 7]);
    });
    // Not in the order of the elements, and one image twice.
    everywhere(&sampling("by_constants", &["taps[2]", "taps[0]", "taps[1]"], &[0, 1, 0]), SHADERS, |executor| {
        frame(executor);
        assert_eq!(texels(executor, "shown", 0), [7, 7, 20, 7, 7, 20]);
    });
}

/// Why a frame can't be executed; empty if it can.
fn refused(device: &Device, frame: &Frame) -> String {
    let plan = planned(device, frame, &Options::default());
    let executor = Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default());
    executor.err().map(|error| placeless(&error.to_string())).unwrap_or_default()
}

#[test]
fn numbers_that_change_choose_where_the_device_can_and_are_refused_elsewhere() {
    on_each_driver(|device| {
        for (shader, needed) in [("by_turns", 1), ("by_pixel", 2)] {
            let frame = sampling(shader, &NAMES, &[0, 1, 2]);
            if let Some((feature, _)) = indexing(device).iter().take(needed).find(|(_, there)| !there) {
                assert_eq!(refused(device, &frame), lacks(shader, feature));
                continue;
            }
            let plan = planned(device, &frame, &Options::default());
            let executor = Executor::new(device, &plan, &mut library(SHADERS), &ExecutorOptions::default());
            let mut executor = executor.expect("an executor");
            self::frame(&mut executor);
            assert_eq!(texels(&mut executor, "shown", 0), [300, 20, 7, 300, 20, 7], "{shader}");
        }
    });
}

#[test]
fn arrays_of_storage_images_are_read_and_written() {
    let mut small = Small::default();
    let sources = filled(&mut small);
    let targets = ["a", "b", "c"].map(|name| small.image(name, Format::R32_UINT, [6, 1]));
    let mut pass = dispatch("turn", Groups::Count([1, 1, 1]));
    for (number, (source, target)) in sources.into_iter().zip(targets).enumerate() {
        pass = pass.loads(&format!("sources[{number}]"), source, WHOLE);
        pass = pass.stores(&format!("targets[{number}]"), target, WHOLE);
    }
    small.pass(pass);
    targets.iter().for_each(|image| small.image_output(*image));
    everywhere(&small.frame, SHADERS, |executor| {
        frame(executor);
        for (name, word) in [("a", 21), ("b", 301), ("c", 8)] {
            assert_eq!(texels(executor, name, 0), [word; 6], "{name}");
        }
    });
}

#[test]
fn an_element_can_be_what_an_image_was_in_earlier_frames() {
    let mut small = Small::default();
    let lifetime = Lifetime::History { frames: 2, initial: FillValue::Bits([0; 4]) };
    let count = small.image_like(Image { lifetime, ..Image::new("count", Format::R32_UINT, 1, 1) });
    let shown = draw("count", Draw::FullScreen).samples_earlier("times[0]", count, 1);
    small.pass(shown.samples_earlier("times[1]", count, 2).draws(count, WHOLE, None));
    small.image_output(count);
    everywhere(&small.frame, SHADERS, |executor| {
        let (mut before, mut now) = (0, 0);
        for _ in 0..7 {
            frame(executor);
            (before, now) = (now, 2 * now + before + 1);
            assert_eq!(texels(executor, "count", 0), [now]);
        }
    });
}

#[test]
fn an_array_with_a_gap_and_an_element_beyond_its_end_are_refused() {
    on_each_driver(|device| {
        let gap = refused(device, &sampling("by_constants", &["taps[0]", "taps[2]"], &[0, 1]));
        assert_eq!(gap, "pass `by_constants`: nothing is bound to `taps[1]`");
        let beyond = refused(device, &sampling("by_constants", &["taps[0]", "taps[1]", "taps[3]"], &[0, 1, 2]));
        assert_eq!(beyond, "pass `by_constants`: the shader has no `taps[3]`");
        let whole = refused(device, &sampling("by_constants", &["taps"], &[0]));
        assert_eq!(whole, "pass `by_constants`: the shader has no `taps`");
    });
}
