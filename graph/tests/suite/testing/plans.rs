//! From a frame to its Plan, and what tests look up there.

use super::parts::device;
use framewright_graph::base::Diagnostic;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile, SHIPPED_PROFILES};
use framewright_graph::frame::Frame;
use framewright_graph::plan::{Image, Plan, RenderScope, Work};
use framewright_graph::verify::verify;

/// The Plan of a frame, in which the checker finds nothing; or what is wrong with the frame.
pub(crate) fn planned(frame: &Frame, device: &Profile, options: &Options) -> Result<Plan, Vec<Diagnostic>> {
    let plan = compile(frame, device, &mut MemoryEstimate(device), options)?;
    assert_eq!(verify(&plan), [], "{}", plan.tree());
    Ok(plan)
}

/// The Plan of a frame with default options, or what is wrong with the frame.
pub(crate) fn on(frame: &Frame, device: &Profile) -> Result<Plan, Vec<Diagnostic>> {
    planned(frame, device, &Options::default())
}

/// The Plan of a valid frame on the device that has everything.
pub(crate) fn compiled(frame: &Frame) -> Plan {
    on(frame, &device()).unwrap_or_else(|errors| panic!("the frame is valid: {errors:?}"))
}

/// The messages about a frame that can't be compiled on the device that has everything.
pub(crate) fn refused(frame: &Frame) -> Vec<String> {
    refused_on(frame, &device())
}

/// The messages about a frame that can't be compiled on a device.
pub(crate) fn refused_on(frame: &Frame, device: &Profile) -> Vec<String> {
    match on(frame, device) {
        Ok(plan) => panic!("it was compiled:\n{}", plan.tree()),
        Err(errors) => errors.into_iter().map(|error| error.message).collect(),
    }
}

/// The rendering scopes of a Plan, in their order.
pub(crate) fn scopes(plan: &Plan) -> Vec<&RenderScope> {
    let steps = plan.steps.iter();
    steps.filter_map(|step| if let Work::Render(scope) = &step.work { Some(&**scope) } else { None }).collect()
}

/// The image of this name.
pub(crate) fn image<'p>(plan: &'p Plan, name: &str) -> &'p Image {
    plan.images.iter().find(|it| *it.name == *name).unwrap_or_else(|| panic!("no `{name}`:\n{}", plan.tree()))
}

/// A shipped device.
pub(crate) fn shipped(name: &str) -> Profile {
    let (_, text) = SHIPPED_PROFILES.iter().find(|(known, _)| *known == name).expect("it is shipped");
    Profile::from_ron(text).expect("shipped profiles are read")
}
