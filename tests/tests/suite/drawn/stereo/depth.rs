//! Multisampled depth that is resolved with a layer for each eye.

use super::{Case, EXTENT, apart, at_once, drawn, form, shipped, upright};
use framewright_graph::frame::{EyeForm, Stereo};
use framewright_passes::draw::Eyes;
use framewright_passes::scene::load;
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
