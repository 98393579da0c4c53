//! Plans that draw for both eyes at once: which devices execute them, and what who records draws may do.

use crate::testing;
use framewright_graph::base::Span;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::Profile;
use framewright_graph::frame::{
    Blend, ColorTarget, Draw, DrawList, EyeForm, Frame, Image, ImageIndex, Pass, Resource, Stereo, Work,
};
use framewright_graph::plan::Plan;
use framewright_graph::shader::DrawInterface;
use framewright_graph::vulkan::{Format, Subresources};
use framewright_vulkan::{Device, DrawSource, Error, Executor, ExecutorOptions, Recorder, ShaderLibrary};
use std::time::Instant;

const SHADERS: &[(&str, &str)] = &[
    (
        "objects.vert",
        "#version 460
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0); }",
    ),
    (
        "eyes.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        void main() { color = framewright_eye == 0 ? vec4(1.0, 0.0, 0.0, 1.0) : vec4(0.0, 1.0, 0.0, 1.0); }",
    ),
];

/// One eye's picture.
const EXTENT: [u32; 2] = [9, 4];

const MODES: [(Stereo, EyeForm); 4] = [
    (Stereo::DoubleWide, EyeForm::Halves),
    (Stereo::Instanced, EyeForm::Halves),
    (Stereo::Instanced, EyeForm::Layers),
    (Stereo::Multiview, EyeForm::Layers),
];

/// A clear to black, and draws of objects.
fn plan(device: &Device, (stereo, form): (Stereo, EyeForm)) -> Plan {
    let eyes = Image { eyes: Some(form), ..Image::new("eyes", Format::R8G8B8A8_UNORM, EXTENT[0], EXTENT[1]) };
    let (image, range) = (ImageIndex(0), Subresources::WHOLE);
    let clear = Some([0.0, 0.0, 0.0, 1.0]);
    let target =
        ColorTarget { image, range, span: Span::NONE, clear, blend: Blend::Replace, write_mask: Default::default() };
    let draw = Draw::Objects(DrawList::Opaque);
    let draw = Work::Draw { draw, shader: "eyes".into(), discards: false, per_sample: false };
    let frame = Frame {
        stereo,
        images: vec![eyes],
        passes: vec![Pass { color: vec![target], ..Pass::new("draw", draw) }],
        outputs: vec![Resource::Image(image).into()],
        ..Frame::default()
    };
    compile(&frame, &device.profile(), &mut device.memory(), &Options::default()).expect("the frame is valid")
}

fn executor(device: &Device, plan: &Plan) -> Result<Executor, Error> {
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let options = ExecutorOptions { timestamps: true, ..ExecutorOptions::default() };
    Executor::new(device, plan, &mut shaders, &options)
}

struct With<F>(F);

impl<F: FnMut(&mut Recorder<'_>)> DrawSource for With<F> {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        (self.0)(recorder);
        recorder.draw(0..3, 0..1);
        Ok(1)
    }
}

/// Both eyes' pictures, row by row: `L`, `R` where an eye's colour is, else a dot.
fn pictures(
    device: &Device,
    mode: (Stereo, EyeForm),
    record: impl FnMut(&mut Recorder<'_>),
) -> Result<[Vec<String>; 2], Error> {
    let mut executor = executor(device, &plan(device, mode))?;
    executor.frame(&mut With(record))?;
    let bytes = executor.read(0)?.bytes;
    let letter = |texel: &[u8]| match *texel {
        [255, 0, 0, 255] => 'L',
        [0, 255, 0, 255] => 'R',
        [0, 0, 0, 255] => '.',
        _ => '?',
    };
    let letters: Vec<char> = bytes.chunks(4).map(letter).collect();
    let [width, height] = EXTENT.map(|side| side as usize);
    let row = |eye: usize, y: usize| {
        let begin = match mode.1 {
            EyeForm::Halves => (2 * y + eye) * width,
            EyeForm::Layers => (eye * height + y) * width,
        };
        letters[begin..begin + width].iter().collect()
    };
    Ok([0, 1].map(|eye| (0..height).map(|y| row(eye, y)).collect()))
}

fn draws(profile: &Profile, (stereo, form): (Stereo, EyeForm)) -> bool {
    match (stereo, form) {
        (Stereo::Multiview, _) => profile.max_multiview_views >= 2,
        (_, EyeForm::Layers) => profile.vertex_layer,
        (Stereo::DoubleWide, _) => true,
        _ => profile.max_clip_distances.is_some_and(|most| most >= 1),
    }
}

#[test]
fn each_eyes_picture_is_drawn_where_the_device_can_and_refused_in_words_where_it_can_not() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let profile = device.profile();
    for mode in MODES {
        match pictures(&device, mode, |_| ()) {
            Ok([left, right]) if !profile.refuted_multiview || mode.0 != Stereo::Multiview => {
                assert!(draws(&profile, mode), "{mode:?}");
                assert_eq!(
                    (left, right),
                    (vec!["LLLLLLLLL".to_owned(); 4], vec!["RRRRRRRRR".to_owned(); 4]),
                    "{mode:?}"
                );
            }
            Ok(_) => {}
            Err(error) => {
                assert!(!draws(&profile, mode), "{mode:?}: {error}");
                let said = error.to_string();
                let expected = format!("draws for both eyes at once ({})", mode.0.name());
                let refused = said.contains(" can't") || said.contains(" lacks what the Plan uses: ");
                assert!(said.contains(&expected) && refused, "{said}");
            }
        }
    }
    drop(device);
    assert_eq!(testing::findings(&messages), []);
}

#[test]
fn a_plan_whose_images_do_not_fit_its_mode_is_refused() {
    let Some(device) = testing::device() else { return };
    for (stereo, form) in MODES {
        let mut plan = plan(device, (stereo, form));
        plan.stereo = if form == EyeForm::Layers { Stereo::DoubleWide } else { Stereo::Multiview };
        let said = executor(device, &plan).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(!said.is_empty(), "{stereo:?} {form:?}: it was taken");
    }
}

#[test]
fn viewports_and_scissors_are_those_of_each_eyes_own_picture() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let profile = device.profile();
    let shown = |eye: char, rows: [&str; 4]| rows.map(|row| row.replace('x', &eye.to_string())).to_vec();
    let modes =
        MODES.into_iter().filter(|mode| draws(&profile, *mode) && *mode != (Stereo::Instanced, EyeForm::Halves));
    let mut seen = 0;
    for mode in modes {
        let both = |rows| [shown('L', rows), shown('R', rows)];
        let drawn = |record: fn(&mut Recorder<'_>)| pictures(&device, mode, record).expect("it is drawn");
        let viewport = drawn(|recorder| recorder.set_viewport([2.0, 1.0], [4.0, 2.0]));
        assert_eq!(viewport, both([".........", "..xxxx...", "..xxxx...", "........."]), "{mode:?}");
        let scissor = drawn(|recorder| recorder.set_scissor([6, 0], [3, 3]));
        assert_eq!(scissor, both(["......xxx", "......xxx", "......xxx", "........."]), "{mode:?}");
        // The part of a rectangle outside the picture is left out, and never the other eye's.
        let beyond = drawn(|recorder| recorder.set_scissor([7, 1], [100, 100]));
        assert_eq!(beyond, both([".........", ".......xx", ".......xx", ".......xx"]), "{mode:?}");
        let across = drawn(|recorder| recorder.set_viewport([6.0, 0.0], [9.0, 4.0]));
        assert_eq!(across, both(["......xxx"; 4]), "{mode:?}: a viewport over the edge");
        let together = drawn(|recorder| {
            recorder.set_viewport([1.0, 0.0], [5.0, 4.0]);
            recorder.set_scissor([0, 2], [4, 1]);
        });
        assert_eq!(together, both([".........", ".........", ".xxx.....", "........."]), "{mode:?}");
        let again = drawn(|recorder| {
            recorder.set_viewport([2.0, 1.0], [4.0, 2.0]);
            recorder.set_scissor([6, 0], [3, 3]);
            recorder.set_viewport([0.0, 0.0], EXTENT.map(f64::from));
            recorder.set_scissor([0, 0], EXTENT);
        });
        assert_eq!(again, both(["xxxxxxxxx"; 4]), "{mode:?}: all of it again");
        seen += 1;
    }
    assert!(seen >= 2, "{profile:?}");
    drop(device);
    assert_eq!(testing::findings(&messages), []);
}

#[test]
fn where_instances_draw_into_halves_a_part_of_a_picture_is_misuse() {
    let Some(device) = testing::device() else { return };
    let mode = (Stereo::Instanced, EyeForm::Halves);
    let drawn = |record: fn(&mut Recorder<'_>)| pictures(device, mode, record).map_err(|error| error.to_string());
    let expected = "part of a picture while instances draw into both eyes' halves";
    for record in [
        (|recorder: &mut Recorder<'_>| recorder.set_viewport([2.0, 1.0], [4.0, 2.0])) as fn(&mut Recorder<'_>),
        |recorder| recorder.set_scissor([2, 1], [4, 2]),
    ] {
        let said = drawn(record).expect_err("it is misuse");
        assert!(said.contains(expected), "{said}");
    }
    // All of it is fine.
    let all = drawn(|recorder| {
        recorder.set_viewport([0.0, 0.0], EXTENT.map(f64::from));
        recorder.set_scissor([0, 0], [1000, 1000]);
    });
    assert_eq!(all, Ok([vec!["LLLLLLLLL".to_owned(); 4], vec!["RRRRRRRRR".to_owned(); 4]]));
}

#[test]
fn more_instances_than_can_be_counted_for_both_eyes_are_misuse() {
    let Some(device) = testing::device() else { return };
    let profile = device.profile();
    for mode in MODES.into_iter().filter(|mode| mode.0 != Stereo::Multiview && draws(&profile, *mode)) {
        let said = pictures(device, mode, |recorder| recorder.draw(0..3, 0x8000_0000..0x8000_0001));
        let said = said.expect_err("the highest bit tells the eye").to_string();
        assert!(said.contains("for both eyes"), "{mode:?}: {said}");
    }
}

#[test]
fn times_stay_right_where_a_scope_draws_several_views() {
    let Some(device) = testing::device() else { return };
    let mode = (Stereo::Multiview, EyeForm::Layers);
    if !draws(&device.profile(), mode) {
        return;
    }
    let mut executor = executor(device, &plan(device, mode)).expect("the device executes the Plan");
    for _ in 0..3 {
        let begun = Instant::now();
        let frame = executor.frame(&mut With(|_: &mut Recorder<'_>| ())).expect("it is drawn");
        let elapsed = begun.elapsed().as_secs_f64() * 1e3;
        let report = executor.report(frame).expect("its report");
        assert!(report.milliseconds > 0.0 && report.milliseconds < elapsed, "{report:?} in {elapsed} ms");
        let steps: f64 = report.steps.iter().map(|step| step.milliseconds).sum();
        assert!((steps - report.milliseconds).abs() < 1e-3, "{report:?}");
        for step in &report.steps {
            let passes: f64 = step.passes.iter().map(|pass| pass.milliseconds).sum();
            assert!(step.passes.is_empty() || passes > 0.0 && passes <= step.milliseconds + 1e-3, "{step:?}");
        }
    }
}
