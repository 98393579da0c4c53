//! Resources that outlive the frame: history, persistent ones, several frames in flight, and another size.

use crate::frames::{
    Small, Uses, copy, dispatch, draw, everywhere, frame, library, on_each_driver, planned, texels, to_bytes, to_words,
    words,
};
use crate::testing::Nothing;
use framewright_graph::compile::Options;
use framewright_graph::frame::{BufferIndex, Draw, Frame, Groups, Image, ImageIndex, Lifetime, Resource};
use framewright_graph::vulkan::{FillValue, Format, Subresources};
use framewright_vulkan::{Device, Executor, ExecutorOptions};

const WHOLE: Subresources = Subresources::WHOLE;
const ONE: Groups = Groups::Count([1, 1, 1]);

const SHADERS: &[(&str, &str)] = &[
    (
        "follow.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D last;
        layout(set = 0, binding = 1) uniform usampler2D before_last;
        layout(location = 0) out uint color;
        void main() {
            ivec2 at = ivec2(gl_FragCoord.xy);
            color = texelFetch(last, at, 0).r + 10 * texelFetch(before_last, at, 0).r;
        }",
    ),
    (
        "follow.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) readonly buffer Last { uint last[]; };
        layout(set = 0, binding = 1) readonly buffer BeforeLast { uint before_last[]; };
        layout(set = 0, binding = 2) writeonly buffer Now { uint now[]; };
        void main() { for (int i = 0; i < 2; ++i) now[i] = last[i] + 10 * before_last[i]; }",
    ),
    (
        "count.comp",
        "#version 460
        layout(local_size_x = 2) in;
        layout(set = 0, binding = 0, r32ui) uniform uimage2D image;
        layout(set = 0, binding = 1) buffer Words { uint word[]; } words;
        void main() {
            uint x = gl_GlobalInvocationID.x;
            imageStore(image, ivec2(x, 0), imageLoad(image, ivec2(x, 0)) + x + 1);
            words.word[x] += 2;
        }",
    ),
    (
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(location = 0) out uint color;
        void main() { color = texelFetch(source, ivec2(0), 0).r; }",
    ),
];

const fn bits(word: u32) -> FillValue {
    FillValue::Bits([word, 0, 0, 0])
}

/// The values that [`SHADERS`]' `follow` leaves, frame after frame, if all frames before the first held `initial`.
fn sequence(initial: u32) -> impl Iterator<Item = u32> {
    let mut held = [initial; 2];
    std::iter::repeat_with(move || {
        held = [held[0] + 10 * held[1], held[0]];
        held[0]
    })
}

fn history(frames: u32, initial: u32) -> Lifetime {
    Lifetime::History { frames, initial: bits(initial) }
}

fn image_history() -> Frame {
    let mut small = Small::default();
    let kept = small.image_like(Image { lifetime: history(2, 1), ..Image::new("kept", Format::R32_UINT, 2, 1) });
    let shown = small.image("shown", Format::R32_UINT, [2, 1]);
    let pass = draw("follow", Draw::FullScreen).samples_earlier("last", kept, 1);
    small.pass(pass.samples_earlier("before_last", kept, 2).draws(kept, WHOLE, None));
    small.pass(copy("show", (Resource::Image(kept), WHOLE), (Resource::Image(shown), WHOLE)));
    small.image_output(shown);
    small.frame
}

#[test]
fn history_of_an_image_is_right_from_the_first_frame_on() {
    everywhere(&image_history(), SHADERS, |executor| {
        for value in sequence(1).take(5) {
            frame(executor);
            assert_eq!(texels(executor, "shown", 0), [value; 2]);
            assert_eq!(texels(executor, "kept", 0), [value; 2]);
        }
    });
}

#[test]
fn history_that_is_an_output_is_its_newest_version() {
    let mut small = Small::default();
    let kept = small.image_like(Image { lifetime: history(2, 3), ..Image::new("kept", Format::R32_UINT, 2, 1) });
    let pass = draw("follow", Draw::FullScreen).samples_earlier("last", kept, 1);
    small.pass(pass.samples_earlier("before_last", kept, 2).draws(kept, WHOLE, None));
    small.image_output(kept);
    everywhere(&small.frame, SHADERS, |executor| {
        for value in sequence(3).take(4) {
            frame(executor);
            assert_eq!(to_words(&executor.read(0).expect("texels").bytes), [value; 2]);
        }
    });
}

fn buffer_history() -> (Small, BufferIndex) {
    let mut small = Small::default();
    let kept = small.buffer_with("kept", 2, history(2, 1));
    let pass = dispatch("follow", ONE).block_earlier("Last", kept, 1).block_earlier("BeforeLast", kept, 2);
    small.pass(pass.block("Now", kept, (false, true)));
    small.buffer_output(kept);
    (small, kept)
}

#[test]
fn history_of_a_buffer_is_right_from_the_first_frame_on() {
    everywhere(&buffer_history().0.frame, SHADERS, |executor| {
        for value in sequence(1).take(5) {
            frame(executor);
            assert_eq!(words(executor, "kept"), [value; 2]);
        }
    });
}

/// An image and a buffer persist and count frames; `shown`, of this size, shows the image's first texel.
fn counters(extent: [u32; 2]) -> (Small, ImageIndex) {
    let mut small = Small::default();
    let lifetime = Lifetime::Persistent { initial: bits(40) };
    let image = small.image_like(Image { lifetime, ..Image::new("count", Format::R32_UINT, 2, 1) });
    let buffer = small.buffer_with("words", 2, Lifetime::Persistent { initial: bits(7) });
    let shown = small.image("shown", Format::R32_UINT, extent);
    small.pass(dispatch("count", ONE).modifies("image", image).block("words", buffer, (true, true)));
    small.pass(draw("show", Draw::FullScreen).samples("source", image, WHOLE).draws(shown, WHOLE, None));
    small.image_output(shown);
    small.buffer_output(buffer);
    (small, image)
}

#[test]
fn what_persists_goes_on_from_frame_to_frame() {
    everywhere(&counters([2, 2]).0.frame, SHADERS, |executor| {
        for frames in 1..5 {
            frame(executor);
            assert_eq!(texels(executor, "count", 0), [40 + frames, 40 + 2 * frames]);
            assert_eq!(texels(executor, "shown", 0), [40 + frames; 4]);
            assert_eq!(words(executor, "words"), [7 + 2 * frames; 2]);
        }
    });
}

#[test]
fn what_the_host_writes_the_next_frame_finds() {
    everywhere(&counters([1, 1]).0.frame, SHADERS, |executor| {
        executor.write_buffer("words", &to_bytes(&[100, 200])).expect("before the first frame");
        frame(executor);
        assert_eq!(words(executor, "words"), [102, 202]);
        executor.write_buffer("words", &to_bytes(&[1000, 0])).expect("between frames");
        let color = framewright_graph::vulkan::Aspects::COLOR;
        executor.write_image("count", color, 0, &to_bytes(&[5, 6])).expect("between frames");
        frame(executor);
        assert_eq!(words(executor, "words"), [1002, 2]);
        assert_eq!(texels(executor, "count", 0), [6, 8]);
        executor.write_buffer("words", &[0; 4]).expect_err("too short");
    });
}

fn executor(device: &Device, frame: &Frame, options: &ExecutorOptions) -> Executor {
    let plan = planned(device, frame, &Options { poison: options.poison, ..Options::default() });
    Executor::new(device, &plan, &mut library(SHADERS), options).expect("an executor")
}

#[test]
fn several_frames_on_their_way_leave_what_one_after_the_other_leaves() {
    on_each_driver(|device| {
        for poison in [false, true] {
            let options = ExecutorOptions { poison, frames_in_flight: 3, readback: true, ..ExecutorOptions::default() };
            let mut images = executor(device, &image_history(), &options);
            let mut buffers = executor(device, &buffer_history().0.frame, &options);
            let mut counts = executor(device, &counters([1, 1]).0.frame, &options);
            for _ in 0..7 {
                for executor in [&mut images, &mut buffers, &mut counts] {
                    executor.submit(&mut Nothing).expect("a frame");
                }
            }
            // The last three are still kept.
            for (number, value) in (0_u64..7).zip(sequence(1)).skip(4) {
                let kept = images.read_back_image(number, 0).expect("texels").bytes;
                assert_eq!(to_words(&kept), [value; 2], "frame {number}");
                assert_eq!(
                    to_words(&buffers.read_back_buffer(number, 0).expect("bytes")),
                    [value; 2],
                    "frame {number}"
                );
                let frames = u32::try_from(number).expect("few") + 1;
                assert_eq!(to_words(&counts.read_back_image(number, 0).expect("texels").bytes), [40 + frames]);
                assert_eq!(to_words(&counts.read_back_buffer(number, 1).expect("bytes")), [7 + 2 * frames; 2]);
            }
            images.read_back_image(3, 0).expect_err("its place was taken");
        }
    });
}

#[test]
fn what_persists_goes_on_when_the_size_changes() {
    on_each_driver(|device| {
        let options = ExecutorOptions::default();
        let mut small = executor(device, &counters([1, 1]).0.frame, &options);
        let mut large = executor(device, &counters([3, 2]).0.frame, &options);
        let fresh = executor(device, &counters([3, 2]).0.frame, &options);
        for _ in 0..3 {
            frame(&mut small);
        }
        assert_eq!(large.migrate_from(small).expect("they are of one device"), ["count", "words"]);
        frame(&mut large);
        assert_eq!(texels(&mut large, "shown", 0), [44; 6]);
        assert_eq!(words(&mut large, "words"), [15; 2]);
        large.migrate_from(fresh).expect_err("it has begun");
    });
}

#[test]
fn history_goes_on_as_a_whole_or_not_at_all() {
    on_each_driver(|device| {
        let options = ExecutorOptions::default();
        let mut first = executor(device, &image_history(), &options);
        for _ in 0..4 {
            frame(&mut first);
        }
        let mut next = executor(device, &image_history(), &options);
        let carried = next.migrate_from(first).expect("they are of one device");
        assert_eq!(carried, ["kept", "kept (1 frame ago)", "kept (2 frames ago)"]);
        for value in sequence(1).take(7).skip(4) {
            frame(&mut next);
            assert_eq!(texels(&mut next, "shown", 0), [value; 2]);
        }
        let mut larger = image_history();
        larger.images.iter_mut().for_each(|image| image.extent = [4, 1, 1]);
        let mut larger = executor(device, &larger, &options);
        assert_eq!(larger.migrate_from(next).expect("they are of one device"), [""; 0]);
        for value in sequence(1).take(3) {
            frame(&mut larger);
            assert_eq!(texels(&mut larger, "shown", 0), [value; 4], "it begins anew");
        }
    });
}
