//! The differences that other devices make.

use super::device;
use crate::error::Error;
use framewright::{Choices, Pipeline};
use framewright_graph::compile::Options;
use framewright_graph::device::MemoryEstimate;
use framewright_graph::difference::Differences;
use framewright_graph::plan::Plan;
use framewright_viewer::{DeviceDifferences, MOST_NODES};

/// The differences that every other shipped profile makes to a Plan of the pipeline, which has a name for people.
///
/// # Errors
/// If a shipped profile can't be read, which a test rules out.
pub(crate) fn on_other_devices(
    pipeline: &mut Pipeline,
    choices: &Choices,
    options: &Options,
    (name, plan): (&str, &Plan),
) -> Result<Vec<DeviceDifferences>, Error> {
    // The differences of a Plan that is summarised would be longer than its page.
    let shown = plan.steps.len() <= MOST_NODES;
    let others = device::all()?.into_iter().filter(|(_, profile)| shown && profile.name != plan.device.name);
    Ok(others
        .map(|(profile, device)| {
            let differences = match pipeline.planned(choices, &device, &mut MemoryEstimate(&device), options) {
                Ok(other) => Ok(Differences::between((name, plan), (name, &other.plan))),
                Err(error) => Err(Error::from(error).shown()),
            };
            DeviceDifferences { profile: profile.to_owned(), differences }
        })
        .collect())
}
