//! What the driver says of a pipeline that it created.

use crate::base::Error;
use ash::vk;

/// The one pipeline that was created with `feedback`, and whether the driver found it in its cache.
pub(super) fn created(
    made: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    feedback: vk::PipelineCreationFeedback,
) -> Result<(vk::Pipeline, bool), Error> {
    let doing = "creating a pipeline";
    let made = made.map_err(|(_, result)| Error::vulkan(doing)(result))?;
    let pipeline = made.first().copied().ok_or(Error::Vulkan { doing, result: vk::Result::ERROR_UNKNOWN })?;
    let found =
        vk::PipelineCreationFeedbackFlags::VALID | vk::PipelineCreationFeedbackFlags::APPLICATION_PIPELINE_CACHE_HIT;
    Ok((pipeline, feedback.flags.contains(found)))
}
