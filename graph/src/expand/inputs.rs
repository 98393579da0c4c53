//! Inputs beside the file: settings, scene facts, size, device, eyes.

use crate::base::{Code, Diagnostic};
use crate::device::Profile;
use crate::frame::{Allowances, Stereo};
use crate::language::{Facts, LARGEST_SIZE, Reads, Surroundings};
use crate::vulkan::{Format, Rotation};

/// The inputs that a pipeline is expanded with, beside its file.
#[derive(Debug, Clone, Copy)]
pub struct Inputs<'a> {
    /// Chosen settings, name and value as the user wrote them; of several values for one setting the last counts.
    pub set: &'a [(String, String)],
    /// Known facts about the scene.
    pub facts: Facts,
    /// Whether there is a scene at all; if not, [`Facts::UNKNOWN`] counts.
    pub facts_known: bool,
    /// Width and height of the frame, in texels, 1 to 16384 each.
    pub output_extent: [u32; 2],
    /// The device that the frame is for; `None`: a device with no more than Vulkan 1.3 demands. Only pipelines that ask for
    /// properties of the device depend on it, and frames of instances for both eyes: in layers or in halves.
    pub device: Option<&'a Profile>,
    /// The rotation of outputs for a screen: those whose image has `format: Output`, or that leave the frame as
    /// `Hdr10`. Sizes are those of the upright picture.
    pub rotation: Rotation,
    /// The format of the window's images that the outputs for a screen are drawn into, as [`Inputs::rotation`] says which those are:
    /// images with `format: Output` have it, and such an output is left as `Present` unless the pipeline says otherwise. `None`: the
    /// frame isn't shown in a window, and `Output` is `R8G8B8A8_SRGB`.
    pub window: Option<Format>,
    /// Names of further images that leave the frame.
    pub dump: &'a [String],
    /// How the frame is drawn for two eyes.
    pub stereo: Stereo,
}

impl Inputs<'_> {
    /// The facts that count.
    pub(super) fn facts(&self) -> Facts {
        if self.facts_known { self.facts } else { Facts::UNKNOWN }
    }
}

pub(super) fn surroundings<'a>(inputs: &Inputs<'a>, reads: Option<&'a Reads>) -> Surroundings<'a> {
    let facts = inputs.facts();
    let eyes = if inputs.stereo == Stereo::Off { 1 } else { 2 };
    let allows = Allowances::default();
    Surroundings { facts, extent: inputs.output_extent, eyes, allows, device: inputs.device, reads }
}

pub(super) fn check_extent(extent: [u32; 2], errors: &mut Vec<Diagnostic>) {
    let [width, height] = extent;
    if extent.iter().any(|extent| !(1..=LARGEST_SIZE).contains(extent)) {
        errors.push(Diagnostic::nowhere(
            Code::SIZE_OUTSIDE,
            format!("the frame can't be {width}×{height}: 1 to {LARGEST_SIZE} texels are allowed"),
        ));
    }
}
