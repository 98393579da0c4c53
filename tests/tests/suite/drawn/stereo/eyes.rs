//! The eye as shaders are told of it, passes that both eyes share, and passes that run for each eye.

use super::{Case, Drawn, EVEN, EXTENT, at_once, drawn, floats, form, read, rendered, upright};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Eye, EyeForm, Stereo};
use framewright_graph::vulkan::FillValue;
use framewright_passes::draw::{Eyes, SceneDrawSource};
use framewright_passes::scene::load;
use framewright_tests::render::{Setup, device, in_repository, library, plan_for, silent};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::{CustomRecorder, Device, DrawSource, Executor, ExecutorOptions, Recorder};
use std::error::Error;

fn all(device: &Device) -> Vec<Stereo> {
    [vec![Stereo::MultiPass], at_once(device)].concat()
}

/// ST-5, ST-11: 0 and 1 in vertex, fragment and compute shaders; a quad shows what the triangle shows.
#[test]
fn each_stage_is_told_the_eye_and_a_quad_shows_what_a_triangle_shows() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    for (stereo, extent) in all(device).into_iter().flat_map(|stereo| [(stereo, EVEN), (stereo, EXTENT)]) {
        let case = Case { pipeline: "tests/pipelines/eyes_told.ron", set: &[], scene: &scene, extent, frames: 1 };
        let shown = drawn(device, &case, upright(stereo), &Eyes::default())?;
        let [triangle, quad, computed, ..] = &shown.frames[0][..] else { return Err("outputs are missing".into()) };
        for eye in [0, 1] {
            let told = eye as f32;
            let (triangle, quad) = (floats(&triangle[eye]), floats(&quad[eye]));
            for (at, (one, other)) in triangle.iter().zip(&quad).enumerate() {
                let [column, row] = [at % extent[0] as usize, at / extent[0] as usize];
                let place = [(column as f32 + 0.5) / extent[0] as f32, (row as f32 + 0.5) / extent[1] as f32];
                for found in [one, other] {
                    assert_eq!(found[..2], [told, told], "{}, {at}", stereo.name());
                    let off = (found[2] - place[0]).abs().max((found[3] - place[1]).abs());
                    assert!(off < 1e-4, "{}: {found:?} at {place:?}", stereo.name());
                }
            }
            for (found, seen) in floats(&computed[eye]).iter().zip(&quad) {
                assert_eq!(*found, [told, seen[0], seen[1], seen[2]], "{}", stereo.name());
            }
        }
    }
    Ok(())
}

/// ST-5, ST-6: scale, offset, the way there and back, two places at once, and before a division by w.
#[test]
fn helpers_place_an_eyes_picture_in_what_is_drawn_into() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    for stereo in [vec![Stereo::Off], all(device)].concat() {
        let case =
            Case { pipeline: "tests/pipelines/eyes_told.ron", set: &[], scene: &scene, extent: EXTENT, frames: 1 };
        let shown = drawn(device, &case, upright(stereo), &Eyes::default())?;
        let halves = form(&shown.plan) == Some(EyeForm::Halves);
        for eye in [0, 1] {
            let [st, there_and_back, two, undivided] = [3, 4, 5, 6].map(|at| floats(&shown.frames[0][at][eye]));
            let expected = if halves { [0.5, 1.0, 0.5 * eye as f32, 0.0] } else { [1.0, 1.0, 0.0, 0.0] };
            assert!(st.iter().all(|found| *found == expected), "{}: {:?}", stereo.name(), st[0]);
            let placed = |[x, y]: [f32; 2]| [x * expected[0] + expected[2], y * expected[1] + expected[3]];
            for at in 0..st.len() {
                let [x, y] = [(at % 97) as f32 + 0.5, (at / 97) as f32 + 0.5];
                let uv = [x / 97.0, y / 61.0];
                let (there, other) = (placed(uv), placed([1.0 - uv[0], 1.0 - uv[1]]));
                for (found, expected) in [
                    (there_and_back[at], [there[0], there[1], uv[0], uv[1]]),
                    (two[at], [there[0], there[1], other[0], other[1]]),
                    (undivided[at], [uv[0], uv[1], there[0], there[1]]),
                ] {
                    let off = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs());
                    assert!(off.fold(0.0, f32::max) < 1e-4, "{}: {found:?}, {expected:?}", stereo.name());
                }
            }
        }
    }
    Ok(())
}

/// ST-8, ST-13: grain is the same in both eyes, bit by bit; a detail repeats 8 × 6 times in the picture of each.
#[test]
fn grain_and_overlays_are_the_same_in_both_eyes() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    let case =
        |extent| Case { pipeline: "tests/pipelines/eyes_overlaid.ron", set: &[], scene: &scene, extent, frames: 2 };
    for extent in [EVEN, EXTENT] {
        let alone = drawn(device, &case(extent), upright(Stereo::MultiPass), &Eyes::default())?;
        for stereo in all(device) {
            let how = stereo.name();
            let shown = drawn(device, &case(extent), upright(stereo), &Eyes::default())?;
            let [[grain, of_right], tiled, objects] = &shown.frames[1][..] else { return Err("outputs".into()) };
            assert!(grain == of_right, "{how}: other grain");
            assert!(grain.chunks(4).any(|pixel| pixel != &grain[..4]), "{how}: no grain");
            assert!(*grain != shown.frames[0][0][0], "{how}: the same grain in each frame");
            assert!(*grain == alone.frames[1][0][0], "{how}: other grain than in {}", Stereo::MultiPass.name());
            if extent == EVEN {
                // 12 by 10 pixels each.
                let [left, right] = tiled;
                assert!(left == right, "{how}: not laid over both alike");
                let pixels = left.as_chunks::<4>().0;
                let tile = |at: usize| pixels[(at / 96 % 10) * 96 + at % 96 % 12];
                assert!((0..pixels.len()).all(|at| pixels[at] == tile(at)), "{how}: not in tiles of 12 by 10");
                assert!(pixels[0] != pixels[1] && pixels[..48] != pixels[5..53], "{how}: all the same");
            }
            // The middle column and row of an odd size lie between two texels of the detail: a driver rounds either way,
            // in layers too.
            let halves = form(&shown.plan) == Some(EyeForm::Halves);
            let ties = if extent == EVEN { 0 } else { (extent[0] + extent[1]) as usize };
            let differ = [(tiled, &alone.frames[1][1], ties), (objects, &alone.frames[1][2], 0)];
            for (at, (found, expected, ties)) in differ.into_iter().enumerate() {
                for (found, expected) in found.iter().zip(expected) {
                    let off = super::apart(found, expected);
                    println!("{extent:?} {how} {at}: {off}");
                    let most = if halves { found.len() / 4 / 200 } else { 0 };
                    assert!(off <= most + ties, "{how}, overlay {at}: {off} of {} pixels", found.len() / 4);
                }
            }
            let [left, right] = objects;
            assert!(left.chunks(4).filter(|pixel| **pixel != [0, 0, 0, 255]).count() > 500 && left != right, "{how}");
        }
    }
    Ok(())
}

/// A scene, and a custom pass that paints what the left eye sees otherwise than what the right one sees.
struct Painter(SceneDrawSource);

impl DrawSource for Painter {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, framewright_vulkan::Error> {
        self.0.record(draw, recorder)
    }

    fn custom(&mut self, _: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), framewright_vulkan::Error> {
        let eye = recorder.view().and_then(|view| view.eye).map(|eye| eye.eye);
        let (name, color) = match eye {
            Some(Eye::Left) => ("painted (left)", [0.0, 1.0, 0.0, 1.0]),
            Some(Eye::Right) => ("painted (right)", [0.0, 0.0, 1.0, 1.0]),
            None => ("painted", [1.0, 0.0, 0.0, 1.0]),
        };
        recorder.fill(name, FillValue::Color(color));
        Ok(())
    }
}

/// ST-4, ST-9: compute shaders, blits, custom passes, mip levels, what one eye's is drawn alone, and what is repeated.
#[test]
fn what_is_done_for_one_eye_after_the_other_shows_the_same_in_each_mode() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    for extent in [EVEN, EXTENT] {
        let setup = Setup { pipeline: "tests/pipelines/eyes_apart.ron", set: &[], scene: &scene, extent };
        let shown = |stereo| {
            let mut shaders = library();
            let plan = plan_for(device, &setup, upright(stereo), &mut shaders, &Options::default())?;
            let mut painter = Painter(SceneDrawSource::for_plan(device, &scene, extent, &plan)?);
            let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
            let frame = executor.frame(&mut painter)?;
            let report = executor.report(frame)?;
            let frames = vec![read(&plan, &mut executor)?];
            silent(device)?;
            Ok::<_, Box<dyn Error>>(Drawn { plan, report, frames })
        };
        let alone = shown(Stereo::MultiPass)?;
        for stereo in at_once(device) {
            let both = shown(stereo)?;
            let at_once = both.plan.images.iter().filter(|image| image.eyes.is_some()).count();
            let tree = both.plan.tree();
            assert!(0 < at_once && at_once < both.plan.images.len(), "all of it in one way: {tree}");
            // ST-12: one shader, of what lies in an image for both, and of what each eye has an image for. In layers a compute shader
            // writes each eye's, and mip levels are in both.
            let by = |name: &str| rendered(&both.plan).filter(|pass| pass.name.starts_with(name)).count();
            let each = if form(&both.plan) == Some(EyeForm::Layers) { 1 } else { 2 };
            assert_eq!(["around", "on_computed", "levels", "of_levels"].map(by), [1, each, 3 * each, each], "{tree}");
            for (at, (both, alone)) in both.frames[0].iter().zip(&alone.frames[0]).enumerate() {
                let [left, right] = alone;
                assert!(left != right, "output {at}: both eyes see the same");
                assert!(both == alone, "output {at}, {extent:?}, {}", stereo.name());
            }
        }
    }
    Ok(())
}

/// ST-9: at its place in the file, where it would see both eyes' halves; elsewhere it is right.
#[test]
fn a_shader_that_does_not_ask_for_its_half_is_reported_at_its_pass() {
    let Some(device) = device() else { return };
    let scene = empty_scene();
    let case =
        Case { pipeline: "tests/pipelines/eyes_unasked.ron", set: &[], scene: &scene, extent: EXTENT, frames: 1 };
    for stereo in all(device) {
        let shown = drawn(device, &case, upright(stereo), &Eyes::default());
        let halves = stereo == Stereo::DoubleWide || stereo == Stereo::Instanced && !device.profile().vertex_layer;
        if !halves {
            assert!(shown.is_ok(), "{}: {:?}", stereo.name(), shown.err());
            continue;
        }
        let said = shown.map(|_| ()).expect_err("two mistakes").to_string();
        for (mistake, place) in [
            ("shader `fetch` samples `source` and doesn't ask which half of `numbers` is its eye's", "ron:11:71"),
            ("shader `raw_ramp` reads `gl_FragCoord` without `frag_coord()`", "ron:12:41"),
        ] {
            assert!(said.contains(mistake) && said.contains(place), "{}: {said}", stereo.name());
        }
    }
}
