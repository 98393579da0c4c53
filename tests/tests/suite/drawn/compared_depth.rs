//! Samplers that compare depth give what a comparison by hand gives (EM-5): for each eye too, whose parts lie in layers or halves.

use framewright_graph::compile::Options;
use framewright_graph::frame::{Eye, EyeForm, Stereo};
use framewright_graph::plan::Resource;
use framewright_graph::vulkan::{Format, Rotation};
use framewright_passes::draw::SceneDrawSource;
use framewright_passes::scene::load;
use framewright_tests::render::{Setup, Ways, device, floats, in_repository, library, plan_for, silent};
use framewright_vulkan::{Device, Executor, ExecutorOptions, Texels};
use std::error::Error;

const EXTENT: [u32; 2] = [96, 60];

/// What the full-screen pass, the compute pass and the comparison by hand give, for each eye.
type Compared = [Vec<Vec<f64>>; 3];

fn compared(device: &Device, set: &[(&str, &str)], stereo: Stereo) -> Result<Compared, Box<dyn Error>> {
    let scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    let setup = Setup { pipeline: "tests/pipelines/compared_depth.ron", set, scene: &scene, extent: EXTENT };
    let mut shaders = library();
    let ways = Ways { stereo, rotation: Rotation::Identity };
    let plan = plan_for(device, &setup, ways, &mut shaders, &Options::default())?;
    let mut draws = SceneDrawSource::for_plan(device, &scene, EXTENT, &plan)?;
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    executor.frame(&mut draws)?;
    let mut all = Vec::new();
    for (at, output) in plan.outputs.iter().enumerate().filter(|(_, output)| output.eye != Some(Eye::Right)) {
        let Resource::Image(image) = output.resource else { return Err("an output that is no image".into()) };
        let texels = executor.read(at)?;
        all.push(match (output.eye, plan.image(image).eyes) {
            (Some(_), _) => vec![floats(&texels), floats(&executor.read(at + 1)?)],
            (None, Some(form)) => parted(&texels, form),
            (None, None) => vec![floats(&texels)],
        });
    }
    silent(device)?;
    all.try_into().map_err(|_| "no three outputs".into())
}

/// Both eyes' parts of what holds them.
fn parted(texels: &Texels, form: EyeForm) -> Vec<Vec<f64>> {
    let numbers = floats(texels);
    let run = match form {
        EyeForm::Layers => numbers.len() / 2,
        EyeForm::Halves => texels.extent[0] as usize / 2,
    };
    [0, 1].map(|eye| numbers.chunks(run).skip(eye).step_by(2).flatten().copied().collect()).to_vec()
}

/// How many of the pixels, but for those in the last row and column, are further apart than `most`.
fn apart(found: &[f64], wanted: &[f64], most: f64) -> usize {
    assert_eq!([found.len(), wanted.len()], [(EXTENT[0] * EXTENT[1]) as usize; 2]);
    let width = EXTENT[0] as usize;
    let inner = |at: &usize| at % width < width - 1 && at / width < EXTENT[1] as usize - 1;
    (0..found.len()).filter(inner).filter(|at| (found[*at] - wanted[*at]).abs() > most).count()
}

#[test]
fn a_comparing_sampler_gives_what_a_comparison_by_hand_gives_for_each_eye() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let modes = [Stereo::Off, Stereo::MultiPass, Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];
    for stereo in modes.into_iter().filter(|stereo| stereo.lacks(&device.profile()).is_none()) {
        for way in ["GreaterOrEqual", "Less"] {
            let [drawn, computed, by_hand] = compared(device, &[("way", way)], stereo)?;
            assert_eq!(by_hand.len(), if stereo == Stereo::Off { 1 } else { 2 });
            for (eye, by_hand) in by_hand.iter().enumerate() {
                let passed = by_hand.iter().filter(|passed| **passed == 1.0).count();
                assert!((500..5000).contains(&passed), "{stereo:?} {way}: {passed} pass");
                assert_eq!(apart(&drawn[eye], by_hand, 0.0), 0, "drawn, {stereo:?} {way}, eye {eye}");
                assert_eq!(apart(&computed[eye], by_hand, 0.0), 0, "computed, {stereo:?} {way}, eye {eye}");
            }
        }
    }
    Ok(())
}

#[test]
fn with_a_linear_filter_it_is_the_share_of_four_texels_where_the_device_filters_depth() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let set = [("filter", "Linear"), ("off", "0.25")];
    if !device.profile().format(Format::D32_SFLOAT).is_some_and(|support| support.linear_filter) {
        let refused = compared(device, &set, Stereo::Off).expect_err("it can't be filtered").to_string();
        assert!(refused.contains("`draw` can't filter `depth`"), "{refused}");
        return Ok(());
    }
    let [drawn, computed, by_hand] = compared(device, &set, Stereo::Off)?;
    let between = by_hand[0].iter().filter(|share| **share > 0.0 && **share < 1.0).count();
    assert!(between > 30, "{between} lie between");
    // Drivers round the shares to 1/256 at least.
    assert_eq!(apart(&drawn[0], &by_hand[0], 1.0 / 128.0), 0);
    assert_eq!(apart(&computed[0], &by_hand[0], 1.0 / 128.0), 0);
    Ok(())
}
