//! An expander that keeps what didn't change makes the same frame as expanding anew.

use framewright_graph::base::{self, Diagnostic};
use framewright_graph::device::{Profile, SHIPPED_PROFILES};
use framewright_graph::expand::{Expander, Inputs, expand};
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::language::Facts;
use framewright_graph::vulkan::{Format, Rotation};
use framewright_tests::{shipped, sweep};
use std::fmt::Debug;

const INPUTS: Inputs<'static> = Inputs {
    set: &[],
    facts: Facts::UNKNOWN,
    facts_known: true,
    output_extent: [640, 360],
    dump: &[],
    device: None,
    rotation: Rotation::Identity,
    stereo: Stereo::Off,
    window: None,
};

/// All of a frame but the texts that its places point into.
fn whole(frame: &Frame) -> impl PartialEq + Debug {
    let Frame {
        sources: _,
        settings,
        changes,
        extent,
        stereo,
        views,
        images,
        buffers,
        passes,
        outputs,
        decided,
        switched_off,
        remarks,
    } = frame;
    ((settings, changes, extent, stereo, views, images), (buffers, passes, outputs, decided, switched_off, remarks))
}

/// Settings, one after the other, and after each of them another scene, size, window, device or number of eyes. What was changed is taken
/// back, so that each follows a frame that it has much in common with.
#[test]
fn frames_of_an_expander_are_those_of_expanding_anew() {
    let read = |(_, text): &(&str, &str)| Profile::from_ron(text).expect("a shipped profile is right");
    let devices: Vec<Profile> = SHIPPED_PROFILES.iter().map(read).collect();
    let opaque = Facts { has_alpha_clip: false, has_cross_fade: false, has_transparent: false, ..Facts::UNKNOWN };
    let mut shaders = shipped::shaders();
    for (name, pipeline, sources) in sweep::of("expanding again", shipped::documents(), 6) {
        let mut expander = Expander::default();
        for (at, set) in shipped::combinations(&pipeline).iter().enumerate() {
            let plain = Inputs { set, device: Some(&devices[at % devices.len()]), ..INPUTS };
            let other = match at % 5 {
                0 => Inputs { facts: opaque, ..plain },
                1 => Inputs { output_extent: [320, 200], ..plain },
                2 => Inputs { window: Some(Format::B8G8R8A8_SRGB), ..plain },
                3 => Inputs { stereo: Stereo::MultiPass, ..plain },
                _ => Inputs { set: &[], ..plain },
            };
            for inputs in [plain, other, plain] {
                let told = |wrong: Vec<Diagnostic>| base::render(&sources, &wrong);
                let anew = expand(&pipeline, sources.clone(), &inputs, &mut shaders).map_err(told);
                let again = expander.expand(&pipeline, sources.clone(), &inputs, &mut shaders).map_err(told);
                assert_eq!(anew.as_ref().map(whole), again.as_ref().map(whole), "{name} {inputs:?}");
            }
        }
    }
}
