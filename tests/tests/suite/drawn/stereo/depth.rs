//! Multisampled depth that is resolved with a layer for each eye.

use super::{Case, EXTENT, Pair, apart, at_once, drawn, form, shipped, upright};
use crate::drawn::depth_of_field::Seen;
use framewright_graph::frame::{EyeForm, Stereo};
use framewright_passes::draw::Eyes;
use framewright_passes::scene::load;
use framewright_passes::twin::depth_of_field::Lens;
use framewright_tests::render::{device, in_repository};
use std::error::Error;

/// Every way to resolve it that a pipeline can ask for, seen by an effect that draws stripes by depth.
#[test]
fn each_eye_sees_its_own_layer_of_depth_however_it_is_resolved() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let (pipeline, scene) = (shipped("image_quality"), load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?);
    let mut wrong = Vec::new();
    for resolve in ["DepthOnly", "SampleZero", "Min", "Max", "Average", "Samples"] {
        let set = &[("depth_stripes", "blended"), ("depth_resolve", resolve)];
        let case = Case { pipeline: &pipeline, set, scene: &scene, extent: EXTENT, frames: 1 };
        let alone = drawn(device, &case, upright(Stereo::MultiPass), &Eyes::default())?;
        for stereo in at_once(device) {
            let both = drawn(device, &case, upright(stereo), &Eyes::default())?;
            if form(&both.plan) != Some(EyeForm::Layers) {
                continue;
            }
            for (eye, (one, other)) in both.frames[0][0].iter().zip(&alone.frames[0][0]).enumerate() {
                let off = apart(one, other);
                if off > 0 {
                    wrong.push(format!("{resolve}, {}, eye {eye}: {off} pixels off", stereo.name()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    Ok(())
}

/// Each eye's picture through a lens is made of its own light and depth, and of nothing of the other's.
#[test]
fn depth_of_field_reads_each_eyes_own_depth_and_light() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/passing.ron"))?;
    let pipeline = "tests/pipelines/depth_of_field.ron";
    let case = Case { pipeline, set: &[("spread", "0.2")], scene: &scene, extent: EXTENT, frames: 1 };
    let lens = Lens { focus: 9.0, spread: 0.2 * f64::from(EXTENT[1]), largest: 5 };
    for stereo in [vec![Stereo::MultiPass], at_once(device)].concat() {
        let drawn = drawn(device, &case, upright(stereo), &Eyes::apart(0.5))?;
        let [light, depths, seen] = &drawn.frames[0][..] else { return Err("not three outputs".into()) };
        for eye in 0..2 {
            let texels = |of: &Pair| -> Vec<[f64; 3]> {
                let number = |bytes: &[u8; 4]| f64::from(f32::from_ne_bytes(*bytes));
                let texels = of[eye].as_chunks::<16>().0.iter();
                texels.map(|texel| [0, 1, 2].map(|at| number(&texel.as_chunks::<4>().0[at]))).collect()
            };
            let depth = texels(depths).into_iter().map(|[depth, ..]| depth).collect();
            let extent = EXTENT.map(u32::cast_signed);
            let seen = Seen { extent, light: texels(light), depth, seen: texels(seen) };
            let case = format!("{}, eye {eye}", stereo.name());
            let changed = seen.demand_the_twin(f64::from(scene.camera.near), lens, &case);
            assert!(changed > 300, "{case}: {changed} texels changed");
        }
    }
    Ok(())
}
