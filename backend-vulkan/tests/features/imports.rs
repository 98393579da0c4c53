//! The embedding program's own resources: imported before the frame, found after it, in the states that the frame says.

use crate::foreign::{destroy_buffer, destroy_image, own_buffer, own_image};
use crate::frames::{
    Small, Uses, dispatch, draw, everywhere, frame, library, on_each_driver, planned, texels, to_bytes, words,
};
use crate::testing::Nothing;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Frame, Groups, Image, Lifetime, Output, Resource};
use framewright_graph::vulkan::{Accesses, Aspects, Format, Layout, Stages, State, Subresources};
use framewright_vulkan::ash::vk;
use framewright_vulkan::{Device, Executor, ExecutorOptions};

const WHOLE: Subresources = Subresources::WHOLE;
const ONE: Groups = Groups::Count([1, 1, 1]);

pub(crate) const SHADERS: &[(&str, &str)] = &[
    (
        "double.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D source;
        layout(location = 0) out uint color;
        void main() { color = 2 * texelFetch(source, ivec2(gl_FragCoord.xy), 0).r; }",
    ),
    (
        "double.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) readonly buffer From { uint from[]; };
        layout(set = 0, binding = 1) writeonly buffer To { uint to[]; };
        void main() { for (int i = 0; i < 3; ++i) to[i] = 2 * from[i]; }",
    ),
    (
        "increase.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) buffer Words { uint word[]; };
        void main() { for (int i = 0; i < 3; ++i) word[i] += 1; }",
    ),
];

const UNKNOWN: State = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::Undefined };
const COPIED_TO: State =
    State { stages: Stages::COPY, accesses: Accesses::TRANSFER_WRITE, layout: Layout::TransferDstOptimal };
const SAMPLED: State = State {
    stages: Stages::FRAGMENT_SHADER,
    accesses: Accesses::SHADER_SAMPLED_READ,
    layout: Layout::ShaderReadOnlyOptimal,
};
const PRESENTED: State = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::PresentSrcKhr };
const WRITTEN: State = State { stages: Stages::COPY, accesses: Accesses::TRANSFER_WRITE, layout: Layout::Undefined };
const READ: State =
    State { stages: Stages::COMPUTE_SHADER, accesses: Accesses::SHADER_STORAGE_READ, layout: Layout::Undefined };

fn imported(name: &str, before: State, after: Option<State>) -> Image {
    Image { lifetime: Lifetime::Imported { before, after, owner: None }, ..Image::new(name, Format::R32_UINT, 2, 2) }
}

/// Draws numbers into the imported image `shared`, and leaves it to be sampled.
pub(crate) fn drawn_into() -> Frame {
    let mut small = Small::default();
    let shared = small.image_like(imported("shared", UNKNOWN, Some(SAMPLED)));
    small.pass(draw("number", Draw::FullScreen).draws(shared, WHOLE, None));
    small.image_output(shared);
    small.frame
}

/// Samples the imported image `shared`, which is ready for that, and leaves it so.
pub(crate) fn sampled_from() -> Frame {
    let mut small = Small::default();
    let shared = small.image_like(imported("shared", SAMPLED, Some(SAMPLED)));
    let doubled = small.image("doubled", Format::R32_UINT, [2, 2]);
    small.pass(draw("double", Draw::FullScreen).samples("source", shared, WHOLE).draws(doubled, WHOLE, None));
    small.image_output(doubled);
    small.frame
}

#[test]
fn each_frame_samples_what_the_program_handed_in_for_it() {
    let mut small = Small::default();
    let source = small.image_like(imported("source", COPIED_TO, None));
    let doubled = small.image("doubled", Format::R32_UINT, [2, 2]);
    small.pass(draw("double", Draw::FullScreen).samples("source", source, WHOLE).draws(doubled, WHOLE, None));
    small.image_output(doubled);
    everywhere(&small.frame, SHADERS, |executor| {
        for first in [0, 50, 90] {
            let given = [first, first + 1, first + 2, first + 3];
            executor.write_image("source", Aspects::COLOR, 0, &to_bytes(&given)).expect("it relies on its contents");
            frame(executor);
            assert_eq!(texels(executor, "doubled", 0), given.map(|value| 2 * value));
            assert_eq!(texels(executor, "source", 0), given, "it is left as it was");
        }
    });
}

#[test]
fn each_frame_reads_the_buffer_that_the_program_wrote_for_it() {
    let mut small = Small::default();
    let given = small.buffer_with("given", 3, Lifetime::Imported { before: WRITTEN, after: Some(READ), owner: None });
    let doubled = small.buffer("doubled", 3);
    small.pass(dispatch("double", ONE).block("From", given, (true, false)).block("To", doubled, (false, true)));
    small.buffer_output(doubled);
    everywhere(&small.frame, SHADERS, |executor| {
        for first in [1, 100, 1000] {
            executor.write_buffer("given", &to_bytes(&[first, 2 * first, 3 * first])).expect("it fits");
            frame(executor);
            assert_eq!(words(executor, "doubled"), [2 * first, 4 * first, 6 * first]);
        }
    });
}

#[test]
fn an_output_is_left_in_the_state_that_was_asked_for() {
    let mut small = Small::default();
    let shown = small.image("shown", Format::R32_UINT, [2, 2]);
    small.pass(draw("number", Draw::FullScreen).draws(shown, WHOLE, None));
    small.frame.outputs.push(Output { after: Some(SAMPLED), ..Resource::Image(shown).into() });
    everywhere(&small.frame, SHADERS, |executor| {
        for _ in 0..2 {
            frame(executor);
            // Read from that state, and brought back into it: the layer would say if the image were in another.
            assert_eq!(texels(executor, "shown", 0), [0, 1, 10, 11]);
        }
    });
}

#[test]
fn what_is_to_be_presented_is_left_for_that() {
    let mut small = Small::default();
    let window = small.image_like(imported("window", UNKNOWN, Some(PRESENTED)));
    small.pass(draw("number", Draw::FullScreen).draws(window, WHOLE, None));
    small.image_output(window);
    everywhere(&small.frame, SHADERS, |executor| {
        for _ in 0..2 {
            frame(executor);
            assert_eq!(texels(executor, "window", 0), [0, 1, 10, 11]);
        }
    });
}

fn executor(device: &Device, frame: &Frame) -> Executor {
    executor_with(device, frame, &ExecutorOptions::default())
}

/// An executor that begins a frame before the one before it is done.
fn executor_of_two(device: &Device, frame: &Frame) -> Executor {
    executor_with(device, frame, &ExecutorOptions { frames_in_flight: 2, ..ExecutorOptions::default() })
}

fn executor_with(device: &Device, frame: &Frame, options: &ExecutorOptions) -> Executor {
    let plan = planned(device, frame, &Options::default());
    Executor::new(device, &plan, &mut library(SHADERS), options).expect("an executor")
}

/// Draws two frames and waits for neither.
fn two_frames(executor: &mut Executor) {
    for _ in 0..2 {
        executor.submit(&mut Nothing).expect("a frame");
    }
}

/// Waits until the frames that were submitted are done.
fn wait_for_last(executor: &mut Executor) {
    executor.wait(executor.frames() - 1).expect("it ends");
}

/// Increases each word of the imported buffer `own`.
pub(crate) fn increased() -> Frame {
    let mut small = Small::default();
    let changed = State {
        stages: Stages::COMPUTE_SHADER,
        accesses: Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE,
        layout: Layout::Undefined,
    };
    let own = small.buffer_with("own", 3, Lifetime::Imported { before: changed, after: Some(changed), owner: None });
    small.pass(dispatch("increase", ONE).block("Words", own, (true, true)));
    small.frame
}

#[test]
fn the_program_s_own_image_goes_from_one_plan_to_another() {
    on_each_driver(|device| {
        let (image, memory) = own_image(device);
        let [mut first, mut second] = [drawn_into(), sampled_from()].map(|frame| executor(device, &frame));
        // SAFETY: it is made as the Plans say, outlives the executors, and the first leaves it as the second finds it.
        unsafe {
            first.import_image("shared", image).expect("it is external");
            second.import_image("shared", image).expect("it is external");
        }
        for _ in 0..2 {
            frame(&mut first);
            assert_eq!(first.raw_image("shared"), Some(image));
            frame(&mut second);
            assert_eq!(texels(&mut second, "doubled", 0), [0, 2, 20, 22]);
        }
        drop((first, second));
        // SAFETY: the executors were dropped.
        unsafe { destroy_image(device, (image, memory)) };
    });
}

#[test]
fn an_image_is_imported_in_place_of_another_that_frames_in_flight_use() {
    on_each_driver(|device| {
        let [mut first, mut second] = [drawn_into(), sampled_from()].map(|frame| executor_of_two(device, &frame));
        let [old, new] = [own_image(device), own_image(device)];
        // SAFETY: each is made as the Plans say, and lives until another is imported or the executors are dropped. The first
        // leaves it as the second finds it.
        unsafe {
            for ((image, _), numbers) in [(new, [50, 60, 70, 80]), (old, [1, 2, 3, 4])] {
                first.import_image("shared", image).expect("it is external");
                frame(&mut first);
                second.import_image("shared", image).expect("it is external");
                second.write_image("shared", Aspects::COLOR, 0, &to_bytes(&numbers)).expect("it fits");
            }
            first.import_image("shared", new.0).expect("it is external");
            two_frames(&mut second);
            second.import_image("shared", new.0).expect("it is external");
            wait_for_last(&mut first);
            wait_for_last(&mut second);
            destroy_image(device, old);
        }
        two_frames(&mut second);
        assert_eq!(texels(&mut second, "doubled", 0), [100, 120, 140, 160]);
        two_frames(&mut first);
        assert_eq!(texels(&mut first, "shared", 0), [0, 1, 10, 11]);
        drop((first, second));
        // SAFETY: the executors were dropped.
        unsafe { destroy_image(device, new) };
    });
}

#[test]
fn a_buffer_is_imported_in_place_of_another_that_frames_in_flight_use() {
    on_each_driver(|device| {
        let mut executor = executor_of_two(device, &increased());
        let [old, new] = [own_buffer(device), own_buffer(device)];
        // SAFETY: each is made as the Plan says, and lives until another is imported or the executor is dropped.
        unsafe {
            for ((buffer, _), numbers) in [(new, [5, 50, 500]), (old, [1, 10, 100])] {
                executor.import_buffer("own", buffer).expect("it is external");
                executor.write_buffer("own", &to_bytes(&numbers)).expect("it fits");
            }
            two_frames(&mut executor);
            executor.import_buffer("own", new.0).expect("it is external");
            wait_for_last(&mut executor);
            destroy_buffer(device, old);
        }
        two_frames(&mut executor);
        assert_eq!(words(&mut executor, "own"), [7, 52, 502]);
        drop(executor);
        // SAFETY: the executor was dropped.
        unsafe { destroy_buffer(device, new) };
    });
}

#[test]
fn the_program_s_own_buffer_is_changed_in_place() {
    on_each_driver(|device| {
        let (buffer, memory) = own_buffer(device);
        let mut executor = executor(device, &increased());
        // SAFETY: it is made as the Plan says and outlives the executor; nothing else touches it.
        unsafe { executor.import_buffer("own", buffer) }.expect("it is external");
        executor.write_buffer("own", &to_bytes(&[1, 10, 100])).expect("it fits");
        for frames in 1..4 {
            frame(&mut executor);
            assert_eq!(words(&mut executor, "own"), [1 + frames, 10 + frames, 100 + frames]);
        }
        drop(executor);
        // SAFETY: the executor was dropped.
        unsafe { destroy_buffer(device, (buffer, memory)) };
    });
}

#[test]
fn what_is_not_the_program_s_own_can_not_be_handed_in() {
    on_each_driver(|device| {
        let mut executor = executor(device, &sampled_from());
        // SAFETY: it is refused before the image is looked at.
        let refused = unsafe { executor.import_image("shade", vk::Image::null()) }.expect_err("no such image");
        assert_eq!(refused.to_string(), "the Plan has no image `shade`");
    });
}

/// A frame with another executor, such as one at another size, would be drawn into an image of that executor's own, and the program's
/// would keep the last picture.
#[test]
fn no_frame_is_drawn_before_the_program_s_own_is_handed_in_again() {
    on_each_driver(|device| {
        let (image, memory) = own_image(device);
        let (buffer, buffer_memory) = own_buffer(device);
        let [mut drawn, mut increases] = [drawn_into(), increased()].map(|frame| executor(device, &frame));
        // SAFETY: each is made as the Plans say and outlives the executors; nothing else touches it.
        unsafe {
            drawn.import_image("shared", image).expect("it is external");
            increases.import_buffer("own", buffer).expect("it is external");
        }
        increases.write_buffer("own", &to_bytes(&[1, 10, 100])).expect("it fits");
        frame(&mut drawn);
        frame(&mut increases);
        // A Plan without the image comes between: the program's image is missing nevertheless.
        let mut between = executor(device, &increased());
        between.migrate_from(drawn).expect("they are of one device");
        frame(&mut between);
        let mut again = executor(device, &drawn_into());
        again.migrate_from(between).expect("they are of one device");
        let refused =
            |executor: &mut Executor| executor.frame(&mut Nothing).expect_err("it isn't imported").to_string();
        assert_eq!(refused(&mut again), "the Plan is another one: `shared` is to be imported again");
        let mut more = executor(device, &increased());
        more.migrate_from(increases).expect("they are of one device");
        assert_eq!(refused(&mut more), "the Plan is another one: `own` is to be imported again");
        // SAFETY: as above.
        unsafe {
            again.import_image("shared", image).expect("it is external");
            more.import_buffer("own", buffer).expect("it is external");
        }
        frame(&mut again);
        assert_eq!(texels(&mut again, "shared", 0), [0, 1, 10, 11]);
        frame(&mut more);
        assert_eq!(words(&mut more, "own"), [3, 12, 102]);
        drop((again, more));
        // SAFETY: the executors were dropped.
        unsafe {
            destroy_image(device, (image, memory));
            destroy_buffer(device, (buffer, buffer_memory));
        }
    });
}

#[test]
fn do_11_frames_use_buffers_of_the_program_in_turn() {
    on_each_driver(|device| {
        let mut executor = executor_of_two(device, &increased());
        let own = [own_buffer(device), own_buffer(device)];
        // SAFETY: each is made as the Plan says, and lives until the executor is dropped; nothing else touches it.
        unsafe {
            for ((buffer, _), numbers) in own.into_iter().zip([[1, 10, 100], [5, 50, 500]]) {
                executor.import_buffer("own", buffer).expect("it is external");
                executor.write_buffer("own", &to_bytes(&numbers)).expect("it fits");
            }
            executor.import_buffers("own", &own.map(|(buffer, _)| buffer)).expect("it is external");
            two_frames(&mut executor);
            two_frames(&mut executor);
            frame(&mut executor);
            assert_eq!(words(&mut executor, "own"), [4, 13, 103]);
            executor.import_buffer("own", own[1].0).expect("it is external");
            assert_eq!(words(&mut executor, "own"), [7, 52, 502]);
            let none = executor.import_buffers("own", &[]).expect_err("no buffer can't be used");
            assert_eq!(none.to_string(), "no buffers were given for `own`");
        }
        drop(executor);
        // SAFETY: the executor was dropped.
        own.into_iter().for_each(|buffer| unsafe { destroy_buffer(device, buffer) });
    });
}

/// The program sets the buffer of the next frame, and reads that of the last one.
#[test]
fn do_11_what_the_program_sets_between_frames_is_in_the_buffer_whose_turn_it_is() {
    on_each_driver(|device| {
        let mut executor = executor(device, &increased());
        let own = [own_buffer(device), own_buffer(device), own_buffer(device)];
        // SAFETY: each is made as the Plan says, and lives until the executor is dropped; nothing else touches it.
        unsafe { executor.import_buffers("own", &own.map(|(buffer, _)| buffer)) }.expect("it is external");
        let mut last = None;
        for number in 0..7 {
            let given = [10 * number, 10 * number + 1, 10 * number + 2];
            executor.write_buffer("own", &to_bytes(&given)).expect("it fits");
            if let Some(last) = last {
                assert_eq!(words(&mut executor, "own"), last, "frame {number}");
            }
            frame(&mut executor);
            let increased = given.map(|word| word + 1);
            assert_eq!(words(&mut executor, "own"), increased, "frame {number}");
            last = Some(increased);
        }
        drop(executor);
        // SAFETY: the executor was dropped.
        own.into_iter().for_each(|buffer| unsafe { destroy_buffer(device, buffer) });
    });
}

#[test]
fn do_11_images_that_died_are_told_and_those_of_the_program_are_not() {
    on_each_driver(|device| {
        let mut executor = executor(device, &drawn_into());
        frame(&mut executor);
        let dead = device.follow_images();
        let made = executor.raw_image("shared").expect("there is such an image");
        assert_eq!(dead.take(), []);
        let (image, memory) = own_image(device);
        // SAFETY: it is made as the Plan says, and outlives the executor.
        unsafe { executor.import_image("shared", image).expect("it is external") };
        assert_eq!(dead.take(), [made]);
        frame(&mut executor);
        drop(executor);
        assert!(!dead.take().contains(&image));
        // SAFETY: the executor was dropped.
        unsafe { destroy_image(device, (image, memory)) };
    });
}
