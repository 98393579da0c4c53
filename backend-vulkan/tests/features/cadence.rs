//! Passes that don't run in every frame: they are left out, what they left stays, and the next frame in which they run sees the change
//! (DO-9).

use crate::frames::{
    Small, Uses, copy, dispatch, draw, everywhere, frame, layer, library, on_each_driver, planned, texels, to_words,
    words,
};
use crate::testing::Nothing;
use framewright_graph::compile::Options;
use framewright_graph::frame::{
    Cadence, Draw, Frame, FrameValue, Groups, Image, ImageIndex, Lifetime, ParamValue, Pass, Resource,
};
use framewright_graph::vulkan::{FillValue, Format, Subresources};
use framewright_vulkan::{Device, Error, Executor, ExecutorOptions};

const WHOLE: Subresources = Subresources::WHOLE;

const SHADERS: &[(&str, &str)] = &[
    (
        "tick.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) buffer Ticks { uint tick; };
        void main() { tick += 1; }",
    ),
    (
        "note.frag",
        "#version 460
        layout(set = 0, binding = 0) readonly buffer Ticks { uint tick; };
        layout(location = 0) out uint color;
        void main() { color = tick; }",
    ),
    (
        "scaled.frag",
        "#version 460
        layout(set = 0, binding = 0) readonly buffer Ticks { uint tick; };
        layout(set = 0, binding = 1) uniform Params { uint scale; } params;
        layout(location = 0) out uint color;
        void main() { color = tick * params.scale; }",
    ),
    (
        "mark.comp",
        "#version 460
        layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) readonly buffer Ticks { uint tick; };
        layout(set = 0, binding = 1) writeonly buffer Marks { uint mark; };
        void main() { mark = tick; }",
    ),
    (
        "both.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform usampler2D kept;
        layout(set = 0, binding = 1) readonly buffer Marks { uint mark; };
        layout(location = 0) out uint color;
        void main() { color = texelFetch(kept, ivec2(0), 0).r + 1000 * mark; }",
    ),
];

const fn every(count: u32, at: u32) -> Cadence {
    Cadence::Every { count, at }
}

fn dirty() -> Cadence {
    Cadence::WhenDirty("sky".into())
}

fn running(pass: Pass, run: &Cadence) -> Pass {
    Pass { run: run.clone(), ..pass }
}

/// Ticks are counted in each frame; passes that run now and then note the count in an image (by a draw) and in a buffer (by a
/// dispatch), and `shown`, of this size, shows both in each frame: a frame's number, from 1, and another one 1000 times.
fn noted(extent: [u32; 2], run: &Cadence) -> Frame {
    let mut small = Small::default();
    let ticks = small.buffer_with("ticks", 1, Lifetime::Persistent { initial: FillValue::Bits([0; 4]) });
    let kept = small.image("kept", Format::R32_UINT, [2, 1]);
    let marks = small.buffer("marks", 1);
    let shown = small.image("shown", Format::R32_UINT, extent);
    let one = Groups::Count([1, 1, 1]);
    small.pass(dispatch("tick", one).block("Ticks", ticks, (true, true)));
    let note = draw("note", Draw::FullScreen).block("Ticks", ticks, (true, false)).draws(kept, WHOLE, None);
    small.pass(running(note, run));
    let mark = dispatch("mark", one).block("Ticks", ticks, (true, false)).block("Marks", marks, (false, true));
    small.pass(running(mark, run));
    let both = draw("both", Draw::FullScreen).samples("kept", kept, WHOLE).block("Marks", marks, (true, false));
    small.pass(both.draws(shown, WHOLE, None));
    small.image_output(shown);
    small.frame
}

/// Six layers, each of which notes the count in one frame of six.
fn faces() -> Frame {
    let mut small = Small::default();
    let ticks = small.buffer_with("ticks", 1, Lifetime::Persistent { initial: FillValue::Bits([0; 4]) });
    let faces = small.image_like(Image { layers: 6, ..Image::new("faces", Format::R32_UINT, 1, 1) });
    let shown = small.image_like(Image { layers: 6, ..Image::new("shown", Format::R32_UINT, 1, 1) });
    small.pass(dispatch("tick", Groups::Count([1, 1, 1])).block("Ticks", ticks, (true, true)));
    for face in 0..6 {
        let pass = draw("note", Draw::FullScreen).block("Ticks", ticks, (true, false));
        let pass = pass.draws(faces, layer(face), None);
        small.pass(Pass { name: format!("face {face}").into(), run: every(6, face), ..pass });
    }
    small.pass(copy("show", (Resource::Image(faces), WHOLE), (Resource::Image(shown), WHOLE)));
    small.image_output(shown);
    small.frame
}

fn executor(device: &Device, frame: &Frame, options: &ExecutorOptions) -> Executor {
    let plan = planned(device, frame, &Options { poison: options.poison, ..Options::default() });
    Executor::new(device, &plan, &mut library(SHADERS), options).expect("an executor")
}

/// What a frame shows: the number of the frame that noted it.
fn shows(executor: &mut Executor) -> u32 {
    frame(executor);
    let shown = texels(executor, "shown", 0)[0];
    assert_eq!(shown % 1000, shown / 1000, "draw and dispatch run together");
    shown % 1000
}

#[test]
fn do_9_passes_run_in_their_frames_and_what_they_left_stays() {
    for (run, expected) in [
        (Cadence::Always, [1, 2, 3, 4, 5, 6, 7]),
        (Cadence::Once, [1, 1, 1, 1, 1, 1, 1]),
        (every(3, 0), [1, 1, 1, 4, 4, 4, 7]),
        (every(3, 1), [1, 2, 2, 2, 5, 5, 5]),
        (every(2, 1), [1, 2, 2, 4, 4, 6, 6]),
    ] {
        everywhere(&noted([1, 1], &run), SHADERS, |executor| {
            for (number, expected) in expected.into_iter().enumerate() {
                assert_eq!(shows(executor), expected, "{run}, frame {number}");
            }
        });
    }
}

#[test]
fn do_9_faces_are_drawn_one_a_frame() {
    everywhere(&faces(), SHADERS, |executor| {
        let mut faces = [1; 6];
        for number in 0..13_u32 {
            if number > 0 {
                faces[number as usize % 6] = number + 1;
            }
            frame(executor);
            assert_eq!(to_words(&executor.read(0).expect("texels").bytes), faces, "frame {number}");
        }
    });
}

#[test]
fn do_9_a_name_is_dirty_until_a_frame_was_drawn() {
    everywhere(&noted([1, 1], &dirty()), SHADERS, |executor| {
        assert_eq!([shows(executor), shows(executor)], [1, 1]);
        executor.set_dirty("sky").expect("a pass waits for it");
        executor.set_dirty("sky").expect("it may be said twice");
        assert_eq!([shows(executor), shows(executor)], [3, 3]);
        let Error::BadResource { what } = executor.set_dirty("ground").expect_err("no pass waits for it") else {
            panic!()
        };
        assert_eq!(what, "no pass runs when `ground` is dirty; passes wait for `sky`, `sky`".replace(", `sky`", ""));
        executor.run_all();
        assert_eq!([shows(executor), shows(executor)], [5, 5]);
    });
    everywhere(&noted([1, 1], &Cadence::Once), SHADERS, |executor| {
        let Error::BadResource { what } = executor.set_dirty("sky").expect_err("no pass waits") else { panic!() };
        assert!(what.ends_with("passes wait for none"), "{what}");
        assert_eq!([shows(executor), shows(executor)], [1, 1]);
        executor.run_all();
        assert_eq!([shows(executor), shows(executor)], [3, 3]);
    });
}

#[test]
fn do_9_the_program_may_number_frames_itself() {
    everywhere(&noted([1, 1], &every(4, 3)), SHADERS, |executor| {
        assert_eq!((executor.frame_number(), shows(executor)), (0, 1));
        executor.set_frame_number(u64::MAX);
        // The largest number is 3 more than a multiple of 4; frames begin anew behind it.
        assert_eq!(shows(executor), 2);
        assert_eq!(executor.frame_number(), 0);
        assert_eq!([0; 4].map(|_| shows(executor)), [2, 2, 2, 6]);
    });
}

#[test]
fn do_9_all_passes_run_in_the_first_frame_after_a_resize() {
    on_each_driver(|device| {
        for run in [Cadence::Once, every(100, 0), dirty()] {
            let options = ExecutorOptions { frames_in_flight: 3, ..ExecutorOptions::default() };
            let mut small = executor(device, &noted([1, 1], &run), &options);
            assert_eq!([0; 3].map(|_| shows(&mut small)), [1, 1, 1]);
            let mut large = executor(device, &noted([2, 2], &run), &options);
            let carried = large.migrate_from(small).expect("they are of one device");
            assert!(carried.contains(&"ticks".to_owned()), "{carried:?}");
            assert_eq!([0; 3].map(|_| shows(&mut large)), [4, 4, 4]);
        }
        // Numbers go on.
        let mut small = executor(device, &noted([1, 1], &every(4, 0)), &ExecutorOptions::default());
        shows(&mut small);
        small.set_frame_number(100);
        assert_eq!([0; 2].map(|_| shows(&mut small)), [2, 2]);
        let mut large = executor(device, &noted([2, 2], &every(4, 0)), &ExecutorOptions::default());
        large.migrate_from(small).expect("they are of one device");
        assert_eq!((large.frame_number(), [0; 4].map(|_| shows(&mut large))), (102, [4, 4, 6, 6]));
    });
}

#[test]
fn do_9_several_frames_on_their_way() {
    on_each_driver(|device| {
        for poison in [false, true] {
            let options = ExecutorOptions { poison, frames_in_flight: 3, readback: true, ..ExecutorOptions::default() };
            let mut executor = executor(device, &noted([1, 1], &every(3, 2)), &options);
            for _ in 0..9 {
                executor.submit(&mut Nothing).expect("a frame");
            }
            for (number, expected) in [(6, 6), (7, 6), (8, 9)] {
                let kept = executor.read_back_image(number, 0).expect("texels").bytes;
                assert_eq!(to_words(&kept), [1001 * expected], "frame {number}");
            }
        }
    });
}

#[test]
fn do_9_a_step_that_is_left_out_reports_no_time() {
    on_each_driver(|device| {
        let options = ExecutorOptions { timestamps: true, fragment_counts: true, ..ExecutorOptions::default() };
        let mut executor = executor(device, &noted([1, 1], &Cadence::Once), &options);
        for number in 0..3 {
            frame(&mut executor);
            let report = executor.report(number).expect("it was waited for");
            for (step, planned) in report.steps.iter().zip(&executor.plan().steps) {
                let runs = number == 0 || planned.run.is_always();
                assert_eq!(step.ran, runs);
                assert_eq!(step.passes.len(), planned.work.passes().len());
                if !runs {
                    assert_eq!(step.milliseconds, 0.0);
                    assert!(step.passes.iter().all(|pass| pass.draws == 0 && pass.milliseconds == 0.0));
                }
            }
            let last = report.steps.iter().rev().flat_map(|step| &step.passes).next().expect("a pass");
            assert_eq!((&*last.name, last.draws), ("both", 1));
        }
    });
}

/// What stays is drawn with a parameter.
fn scaled(scale: i64) -> Frame {
    let mut frame = noted([1, 1], &Cadence::Once);
    let scaled = draw("scaled", Draw::FullScreen);
    let params = vec![("scale".into(), ParamValue::Integer(scale))];
    let note = &mut frame.passes[1];
    (note.work, note.params) = (scaled.work, params);
    frame
}

#[test]
fn do_9_what_has_other_values_runs_again() {
    on_each_driver(|device| {
        let mut executor = executor(device, &scaled(1), &ExecutorOptions::default());
        assert_eq!([shows(&mut executor), shows(&mut executor)], [1, 1]);
        let plan = planned(device, &scaled(7), &Options::default());
        executor.change(&plan).expect("only a value differs");
        frame(&mut executor);
        assert_eq!(texels(&mut executor, "shown", 0), [7 * 3 + 3000], "both run again");
        executor.change(&plan).expect("nothing differs");
        frame(&mut executor);
        assert_eq!(texels(&mut executor, "shown", 0), [7 * 3 + 3000]);
    });
}

/// Both eyes' passes alike: an image with several samples that is resolved into one that stays.
#[test]
fn do_9_what_is_resolved_stays_resolved() {
    let mut frame_of = noted([1, 1], &every(2, 0));
    frame_of.images[0] = Image { samples: 4, ..Image::new("kept", Format::R16G16B16A16_SFLOAT, 2, 1) };
    let ImageIndex(kept) = frame_of.passes[1].color[0].image;
    assert_eq!(kept, 0);
    const FLOATS: &[(&str, &str)] = &[
        SHADERS[0],
        (
            "note.frag",
            "#version 460
            layout(set = 0, binding = 0) readonly buffer Ticks { uint tick; };
            layout(location = 0) out vec4 color;
            void main() { color = vec4(tick); }",
        ),
        SHADERS[3],
        (
            "both.frag",
            "#version 460
            layout(set = 0, binding = 0) uniform sampler2D kept;
            layout(set = 0, binding = 1) readonly buffer Marks { uint mark; };
            layout(location = 0) out uint color;
            void main() { color = uint(texelFetch(kept, ivec2(0), 0).r) + 1000 * mark; }",
        ),
    ];
    everywhere(&frame_of, FLOATS, |executor| {
        assert_eq!([0; 5].map(|_| shows(executor)), [1, 1, 3, 3, 5]);
        assert_eq!(words(executor, "ticks"), [5]);
    });
}

/// `shown` shows the frame's number and its time, 60 frames a second unless the program tells it.
#[test]
fn do_9_the_frame_s_number_and_time_reach_shaders_and_passes_of_the_program() {
    const CLOCKS: &[(&str, &str)] = &[
        (
            "clock.frag",
            "#version 460
            layout(set = 0, binding = 0) uniform Params { uvec2 numbers; float seconds; } params;
            layout(location = 0) out uint color;
            void main() { color = params.numbers.x + 1000 * params.numbers.y + 10000 * uint(round(60.0 * params.seconds)); }",
        ),
        (
            "clock.comp",
            "#version 460
            layout(local_size_x = 1) in;
            layout(set = 0, binding = 0) uniform Params { float seconds; } params;
            layout(set = 0, binding = 1) writeonly buffer Time { float time; };
            void main() { time = params.seconds; }",
        ),
    ];
    let mut small = Small::default();
    let shown = small.image("shown", Format::R32_UINT, [1, 1]);
    let time = small.buffer("time", 1);
    let [number, seconds] = [FrameValue::Frame, FrameValue::Time].map(ParamValue::OfFrame);
    let mut by_draw = draw("clock", Draw::FullScreen).draws(shown, WHOLE, None);
    let numbers = ParamValue::list([number, ParamValue::Integer(7)]);
    by_draw.params = vec![("numbers".into(), numbers), ("seconds".into(), seconds.clone())];
    small.pass(by_draw);
    let mut by_dispatch = dispatch("clock", Groups::Count([1, 1, 1])).block("Time", time, (false, true));
    (by_dispatch.name, by_dispatch.params) = ("clock of a dispatch".into(), vec![("seconds".into(), seconds)]);
    small.pass(by_dispatch);
    small.image_output(shown);
    small.buffer_output(time);
    let seconds = |executor: &mut Executor| f32::from_bits(words(executor, "time")[0]);
    everywhere(&small.frame, CLOCKS, |executor| {
        for number in 0..3 {
            frame(executor);
            assert_eq!(texels(executor, "shown", 0), [number + 7000 + 10000 * number]);
            assert_eq!(seconds(executor), number as f32 / 60.0);
        }
        executor.set_time(2.5).expect("a time");
        executor.set_frame_number(u64::from(u32::MAX) + 6);
        for number in 5..7 {
            frame(executor);
            assert_eq!(texels(executor, "shown", 0), [number + 7000 + 150 * 10000], "numbers begin anew");
            assert_eq!(seconds(executor), 2.5);
        }
        executor.set_time(f64::NAN).expect_err("no time");
    });
    // Frames on their way keep theirs.
    on_each_driver(|device| {
        let options = ExecutorOptions { frames_in_flight: 3, readback: true, ..ExecutorOptions::default() };
        let plan = planned(device, &small.frame, &Options::default());
        let mut executor = Executor::new(device, &plan, &mut library(CLOCKS), &options).expect("an executor");
        for _ in 0..6 {
            executor.submit(&mut Nothing).expect("a frame");
        }
        for number in 3..6_u32 {
            let shown = executor.read_back_image(number.into(), 0).expect("texels").bytes;
            assert_eq!(to_words(&shown), [number + 7000 + 10000 * number]);
        }
    });
}
