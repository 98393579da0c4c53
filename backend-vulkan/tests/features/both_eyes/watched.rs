//! What custom passes do, held against what they declare (DO-8), where they are recorded for both eyes at once, and beside pictures that are
//! turned.

use super::engine::{EXTENT, Engine};
use super::{expected, pictures, ways};
use crate::frames::on_each_driver_with;
use ash::vk;
use framewright_graph::compile::{Options, Order};
use framewright_graph::frame::{EyeForm, Stereo};
use framewright_graph::vulkan::Rotation;
use framewright_tests::render::{Setup, Ways, library, plan_for};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::{CustomImage, CustomRecorder, Device, Error, Executor, ExecutorOptions};

/// What a program does that its pipeline doesn't say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lie {
    /// The pass `keep` writes the right eye's part of what it only reads.
    WritesWhatItReads,
    /// The pass `keep`, or `aside`, writes the right eye's part of an image that it doesn't name.
    WritesAnother,
    /// The pass `keep` sets the left eye's part alone of what it declares to set.
    LeavesOneEye,
}

/// The lie of a program, and an image that it keeps hold of for it.
#[derive(Default)]
pub(super) struct Lies {
    pub(super) lie: Option<Lie>,
    kept: Option<CustomImage>,
}

/// Which eye's part of an image, the left one's as 0.
type Part<'i> = (&'i CustomImage, u32);

impl Lies {
    /// Keeps hold of an image, if there is one.
    pub(super) fn keep(&mut self, image: Option<CustomImage>) {
        self.kept = image.or(self.kept);
    }

    /// Does what a pass mustn't, behind its own work.
    pub(super) fn tell(&mut self, device: &Device, recorder: &mut CustomRecorder<'_>, [source, target]: [&str; 2]) {
        let [source, target] = [source, target].map(|name| recorder.image(name).expect("the pass names it"));
        let pass = recorder.pass().to_owned();
        if pass == "hold" {
            self.kept = Some(target);
        }
        let victim = match self.lie {
            Some(Lie::WritesWhatItReads) if pass == "keep" => source,
            Some(Lie::WritesAnother) if pass == "keep" || pass == "aside" => {
                self.kept.expect("a pass before was handed it")
            }
            _ => return,
        };
        copy_part(device, recorder.raw(), (&target, 0), (&victim, 1));
    }

    /// Copies the left eye's part alone, if that is the lie; else the pass is to copy both.
    pub(super) fn leaves_one_eye(&self, device: &Device, recorder: &mut CustomRecorder<'_>, names: [&str; 2]) -> bool {
        let leaves = self.lie == Some(Lie::LeavesOneEye) && recorder.pass() == "keep";
        if leaves {
            let [source, target] = names.map(|name| recorder.image(name).expect("the pass names it"));
            copy_part(device, recorder.raw(), (&source, 0), (&target, 0));
        }
        leaves
    }
}

/// Copies as much as fits of one eye's part over another's, behind everything before. Software drivers forgive the layouts.
fn copy_part(device: &Device, commands: vk::CommandBuffer, from: Part<'_>, to: Part<'_>) {
    let place = |(image, eye): Part<'_>| {
        let aside = if image.eyes == Some(EyeForm::Halves) { eye } else { 0 };
        let [x, y, _] = image.extent.map(|side| (aside * side).cast_signed());
        let offset = if image.rotation.quarters() % 2 == 1 {
            vk::Offset3D { x: 0, y, z: 0 }
        } else {
            vk::Offset3D { x, y: 0, z: 0 }
        };
        let layer = if image.eyes == Some(EyeForm::Layers) { eye } else { 0 };
        let layers = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            base_array_layer: image.range.base_layer + layer,
            layer_count: 1,
            ..Default::default()
        };
        (offset, layers)
    };
    let [(src_offset, src_subresource), (dst_offset, dst_subresource)] = [place(from), place(to)];
    let [width, height] = [0, 1].map(|axis| from.0.extent[axis].min(to.0.extent[axis]));
    let extent = vk::Extent3D { width, height, depth: 1 };
    let region = vk::ImageCopy { src_offset, src_subresource, dst_offset, dst_subresource, extent };
    let all = [vk::MemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
        .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)];
    let stage = vk::PipelineStageFlags::ALL_COMMANDS;
    let raw = device.raw();
    // SAFETY: the images live, and hold both places.
    unsafe {
        raw.cmd_pipeline_barrier(commands, stage, stage, vk::DependencyFlags::empty(), &all, &[], &[]);
        raw.cmd_copy_image(commands, from.0.raw, from.0.layout, to.0.raw, to.0.layout, &[region]);
    }
}

const FOR_BOTH: &str = "tests/pipelines/watched_for_both_eyes.ron";
const TURNED: &str = "tests/pipelines/watched_and_turned.ron";

/// What four frames of a program are told, each eye's part of the first output unless there is one for both, and all outputs.
struct Left {
    told: Vec<String>,
    pictures: Option<[Vec<[u8; 4]>; 2]>,
    outputs: Vec<Vec<u8>>,
}

fn left(device: &Device, pipeline: &str, ways: Ways, (lie, check_uses): (Option<Lie>, bool)) -> Left {
    let scene = empty_scene();
    let setup = Setup { pipeline, set: &[], scene: &scene, extent: EXTENT };
    let mut shaders = library();
    let options = Options { readable: true, order: Order::File, ..Options::default() };
    let plan = plan_for(device, &setup, ways, &mut shaders, &options);
    let plan = plan.unwrap_or_else(|error| panic!("{ways:?}: {error}"));
    let options = ExecutorOptions { check_uses, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plan, &mut shaders, &options).expect("an executor");
    let mut engine = Engine::new(device);
    engine.lies.lie = lie;
    let draws = ["draw", "draw (left)", "draw (right)"]
        .into_iter()
        .filter(|name| plan.steps.iter().flat_map(|step| step.work.passes()).any(|pass| *pass.name == **name));
    draws.for_each(|pass| engine.prepare(&executor, pass));
    let frames = (0..4).map(|_| match executor.frame(&mut engine) {
        Ok(_) => Vec::new(),
        Err(Error::BrokenPromises { promises }) => promises.iter().map(ToString::to_string).collect(),
        Err(error) => panic!("{ways:?}: {error}"),
    });
    let told = frames.collect::<Vec<Vec<String>>>().concat();
    let pictures = (ways.stereo != Stereo::Off).then(|| pictures(&plan, &mut executor, 0));
    let outputs = (0..plan.outputs.len()).map(|at| executor.read(at).expect("a picture").bytes).collect();
    Left { told, pictures, outputs }
}

#[test]
fn do_8_an_honest_program_is_left_in_peace_for_both_eyes_and_turned() {
    on_each_driver_with(|device| {
        for stereo in ways(&device).into_iter().chain([Stereo::Off]) {
            for rotation in Rotation::ALL {
                let ways = Ways { stereo, rotation };
                let upright = rotation == Rotation::Identity && stereo != Stereo::Off;
                let pipelines: &[&str] = if upright { &[FOR_BOTH, TURNED] } else { &[TURNED] };
                for pipeline in pipelines {
                    let [plain, watched] = [false, true].map(|check| left(&device, pipeline, ways, (None, check)));
                    assert_eq!(watched.told, [""; 0], "{pipeline}: {ways:?}");
                    assert_eq!(watched.outputs, plain.outputs, "{pipeline}: {ways:?}");
                    let seen = watched.pictures.filter(|_| *pipeline == FOR_BOTH);
                    assert!(seen.is_none_or(|seen| seen == expected(false)), "{pipeline}: {ways:?}");
                }
            }
        }
    });
}

/// Has what is said of a lie hold these words.
fn is_told(device: &Device, pipeline: &str, ways: Ways, lie: Lie, words: [&str; 3]) {
    let said = left(device, pipeline, ways, (Some(lie), true)).told;
    assert!(said.iter().any(|it| words.iter().all(|word| it.contains(word))), "{ways:?}, {lie:?}: {said:?}");
}

#[test]
fn do_8_what_is_done_to_one_eyes_part_alone_is_told() {
    on_each_driver_with(|device| {
        for stereo in ways(&device).into_iter().filter(|stereo| *stereo != Stereo::MultiPass) {
            let ways = Ways { stereo, rotation: Rotation::Identity };
            let others = " of 256 bytes of mip 0, layer 0 are others after it";
            let reads =
                ["pass `keep` (", "declares `stored` as COPY, TRANSFER_READ, TRANSFER_SRC_OPTIMAL, and ", others];
            is_told(&device, FOR_BOTH, ways, Lie::WritesWhatItReads, reads);
            let another = ["pass `keep` (", "doesn't name `held`, and ", others];
            is_told(&device, FOR_BOTH, ways, Lie::WritesAnother, another);
            let unset = [
                "pass `keep` (",
                "declares `kept` as COPY, TRANSFER_WRITE, TRANSFER_DST_OPTIMAL, and ",
                "32 of 64 texels of mip 0, layer 0 are not set by it",
            ];
            is_told(&device, FOR_BOTH, ways, Lie::LeavesOneEye, unset);
        }
    });
}

#[test]
fn do_8_what_is_done_to_a_turned_picture_is_told() {
    on_each_driver_with(|device| {
        for stereo in ways(&device).into_iter().filter(|stereo| *stereo != Stereo::MultiPass) {
            for rotation in Rotation::ALL {
                let words = [
                    "pass `aside` (",
                    "doesn't name `screen`, and ",
                    " of 256 bytes of mip 0, layer 0 are others after it",
                ];
                is_told(&device, TURNED, Ways { stereo, rotation }, Lie::WritesAnother, words);
            }
        }
        let (stereo, rotation) = (Stereo::Off, Rotation::Rotate90);
        let words =
            ["pass `aside` (", "doesn't name `screen`, and ", " of 128 bytes of mip 0, layer 0 are others after it"];
        is_told(&device, TURNED, Ways { stereo, rotation }, Lie::WritesAnother, words);
    });
}
