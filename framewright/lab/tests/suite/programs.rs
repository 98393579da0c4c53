//! A program measures choices, joins two parts of a sweep, and chooses, without the command.

use framewright::vulkan::StepReport;
use framewright::{Choices, FrameReport, Pipeline, ReadFiles, Renderer, RendererOptions, Stereo, load_scene};
use framewright_lab::bench::{
    BatchProgress, Bench, BenchOptions, Choice, ErrorBaseline, MeasuredScene, Program, WARM_UP,
};
use framewright_lab::choosing::{Candidates, Limit, Quantity, SettingsAnswer};
use framewright_lab::metric::{Errors, Metric, PIXELS_PER_DEGREE};
use framewright_lab::outputs::{self, PictureRequest};
use framewright_lab::picture::{FileFormat, Light};
use framewright_lab::results::{FORMAT_VERSION, Outcome, Part, Results, joined};
use framewright_lab::sweep::{self, Combination, Sweep};
use framewright_lab::timings;
use framewright_tests::render;
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::rc::Rc;

/// Frames whose times are taken.
const FRAMES: u32 = 2;

/// Keeps files in memory, and may stop.
#[derive(Default)]
struct Memory {
    files: RefCell<BTreeMap<String, Vec<u8>>>,
    stopped: Cell<bool>,
}

impl Program for Memory {
    fn stops(&self) -> bool {
        self.stopped.get()
    }

    fn kept(&self, name: &str) -> Option<Vec<u8>> {
        self.files.borrow().get(name).cloned()
    }

    fn keep(&self, name: &str, contents: &[u8]) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        self.files.borrow_mut().insert(name.to_owned(), contents.to_owned());
        Ok(())
    }
}

fn forward() -> Pipeline {
    Pipeline::open("forward", &RendererOptions::default(), &ReadFiles::default()).expect("it is shipped")
}

fn bench<'p>(device: &framewright::Device, program: &'p Memory) -> Bench<'p> {
    let mut options = BenchOptions::default();
    options.frames = FRAMES;
    Bench::new(device, forward(), Choices::default(), options, program).expect("few frames")
}

fn choices() -> (Choice, Vec<Choice>) {
    let name = "spheres_and_cubes";
    let scene = Rc::new(MeasuredScene::new(name.to_owned(), load_scene(name).expect("it is shipped")));
    let baseline = Choice { values: BTreeMap::new(), scene, size: [32, 18], stereo: vec![Stereo::Off] };
    let swept = [Sweep { name: "msaa".to_owned(), values: vec!["1".to_owned(), "4".to_owned()] }];
    let choices = sweep::choices(&swept, Combination::All).expect("few");
    let choices = choices.into_iter().map(|values| Choice { values, ..baseline.clone() }).collect();
    (baseline, choices)
}

#[test]
fn choices_are_measured_joined_and_chosen_from() {
    let Some(device) = render::device() else { return };
    let (program, (baseline, choices)) = (Memory::default(), choices());
    let mut bench = bench(device, &program);
    let subject = bench.subject("forward".to_owned(), &baseline).expect("planned");
    let mut parts = Vec::new();
    for choice in &choices {
        let (frames, done) = (Cell::new(0), Cell::new(0));
        let progress = |drawn| match drawn {
            BatchProgress::Frame => frames.set(frames.get() + 1),
            BatchProgress::Choice => done.set(done.get() + 1),
        };
        let mut rows = Vec::new();
        let choice = std::slice::from_ref(choice);
        bench.batch((&baseline, &subject), choice, &progress, &mut rows).expect("measured");
        assert_eq!((frames.get(), done.get()), (WARM_UP + FRAMES, 1));
        let results = Results { format_version: FORMAT_VERSION, subject: subject.clone(), rows };
        let read = Results::from_json(&serde_json::to_string(&results).expect("JSON")).expect("it is right");
        assert_eq!(read.rows.len(), 1);
        parts.push(Part { folder: choice[0].values["msaa"].clone().into(), results });
    }
    let results = joined(parts).expect("of one subject").expect("two parts");
    let [one, four] = ["1", "4"].map(|msaa| {
        let row = results.rows.iter().find(|row| row.settings["msaa"] == msaa).expect("measured");
        let Outcome::Measured(measured) = &row.outcome else { panic!("{row:?}") };
        assert!(program.kept(measured.picture.as_deref().expect("a picture")).is_some());
        measured.errors.clone().expect("errors")
    });
    assert!(four.of(Metric::Flip) < one.of(Metric::Flip), "more samples are nearer to the reference");
    let flip = |value| [Limit { quantity: Quantity::Error(Metric::Flip), value }];
    let candidates = Candidates::of(&results);
    let between = (four.of(Metric::Flip) + one.of(Metric::Flip)) / 2.0;
    let SettingsAnswer::Best { best, .. } = candidates.choose(&flip(between)) else { panic!("four samples hold it") };
    assert_eq!(best.settings["msaa"], "4");
    assert!(matches!(candidates.choose(&flip(0.0)), SettingsAnswer::Nearest(Some(_))));
}

#[test]
fn numbers_of_frames_that_no_results_have_are_refused() {
    let Some(device) = render::device() else { return };
    let made = |frames, flicker| {
        let mut options = BenchOptions::default();
        (options.frames, options.flicker) = (frames, flicker);
        Bench::new(device, forward(), Choices::default(), options, &Memory::default()).map(drop)
    };
    for (frames, flicker, words) in [
        (0, None, "times are taken over 1 to 100000 frames, and not 0"),
        (u32::MAX, None, "and not 4294967295"),
        (1, Some(1), "flicker is measured over 2 to 1000 frames, and not 1"),
        (1, Some(1001), "and not 1001"),
    ] {
        let refused = made(frames, flicker).expect_err("out of range").to_string();
        assert!(refused.ends_with(words), "{refused}");
    }
    made(1, Some(2)).expect("the least");
}

#[test]
fn a_choice_without_a_way_for_two_eyes_is_one_for_one_eye_also_if_it_cannot_be_drawn() {
    let Some(device) = render::device() else { return };
    let (program, (baseline, choices)) = (Memory::default(), choices());
    let mut options = BenchOptions::default();
    (options.frames, options.held_against) = (1, ErrorBaseline::Nothing);
    let mut bench = Bench::new(device, forward(), Choices::default(), options, &program).expect("few frames");
    let subject = bench.subject("forward".to_owned(), &baseline).expect("planned");
    let mut rows = Vec::new();
    // lavapipe has no 8 samples.
    let many = Choice { values: BTreeMap::from([("msaa".to_owned(), "8".to_owned())]), ..baseline.clone() };
    let choices = [&choices[0], &many].map(|choice| Choice { stereo: Vec::new(), ..choice.clone() });
    bench.batch((&baseline, &subject), &choices, &|_| (), &mut rows).expect("measured");
    assert!(rows.iter().all(|row| row.stereo == "off"), "{rows:?}");
}

#[test]
fn a_picture_of_no_output_is_an_error_and_reports_of_another_plan_are_no_panic() {
    let Some(device) = render::device() else { return };
    let mut renderer = Renderer::open(device, "forward", RendererOptions::default()).expect("it is shipped");
    let plan = renderer.prepare().expect("planned").plan.clone();
    let executor = renderer.executor_mut().expect("planned");
    for outputs in [outputs::named(&plan, "none"), vec![99]] {
        let path = Path::new("none.png");
        let request = PictureRequest { outputs, name: "none", path, file_format: FileFormat::Png };
        let refused = request.encode(executor, &plan, &|_| ()).expect_err("there is none").to_string();
        assert!(refused.starts_with("there is no output `none`: there are `screen`"), "{refused}");
    }
    assert!(outputs::side_by_side(Vec::new()).is_none());
    assert!(outputs::encoded(FileFormat::Png, (&plan, &plan.outputs[0]), Vec::new(), &|_| ()).is_err());
    let step = StepReport { milliseconds: 1.0, began: None, ran: true, passes: Vec::new() };
    for steps in [Vec::new(), vec![step.clone()], vec![step; 99]] {
        let (recording_began, fragment_invocations) = (None, None);
        let other = FrameReport {
            milliseconds: 1.0,
            recording_milliseconds: 1.0,
            recording_began,
            fragment_invocations,
            steps,
        };
        let of_steps = timings::rows(&plan, &[other]);
        assert!(of_steps.iter().all(|row| row.step < plan.steps.len()), "{of_steps:?}");
    }
}

#[test]
fn references_are_kept_and_a_program_that_stops_is_told_so() {
    let Some(device) = render::device() else { return };
    let (program, (baseline, choices)) = (Memory::default(), choices());
    let mut first = bench(device, &program);
    let missing = |bench: &mut Bench<'_>| -> BTreeSet<String> {
        let keys = choices.iter().filter_map(|choice| bench.missing_reference(choice, 0).expect("planned"));
        keys.collect()
    };
    assert_eq!(missing(&mut first).len(), 1, "both choices have one reference");
    let last = Cell::new((0, 0));
    first.draw_reference(&choices[0], 0, &|done, of| last.set((done, of))).expect("drawn");
    assert!(last.get().0 > 0 && last.get().0 == last.get().1, "{last:?}");
    assert!(missing(&mut bench(device, &program)).is_empty(), "another bench finds it");
    program.stopped.set(true);
    let subject = first.subject("forward".to_owned(), &baseline).expect("planned");
    let stopped = first.batch((&baseline, &subject), &choices, &|_| (), &mut Vec::new());
    assert!(matches!(stopped, Err(framewright_lab::Error::Stopped { drawn: 0, .. })), "{stopped:?}");
}

#[test]
fn pictures_of_other_sizes_or_with_other_texels_than_they_say_have_no_errors() {
    let grey = |extent, texels| Light { extent, texels: vec![[0.5; 3]; texels], is_light: false, left_out: Vec::new() };
    let errors = |a: &Light, b: &Light| Errors::between(a, b, PIXELS_PER_DEGREE);
    let picture = grey([16, 12], 192);
    assert!(errors(&picture, &picture).is_some_and(|errors| errors.rmse.abs() < f64::EPSILON));
    for other in [grey([12, 16], 192), grey([16, 13], 208), grey([16, 12], 191), grey([usize::MAX, 2], 192)] {
        assert!(errors(&picture, &other).is_none() && errors(&other, &picture).is_none(), "{:?}", other.extent);
    }
    for empty in [grey([0, 0], 0), grey([0, 3], 0), grey([3, 0], 0)] {
        assert!(errors(&empty, &empty).is_none(), "{:?}", empty.extent);
    }
    for out_of_range in [0.0, -1.0, 1001.0, f64::NAN, f64::INFINITY] {
        assert!(Errors::between(&picture, &picture, out_of_range).is_none(), "{out_of_range}");
    }
}
