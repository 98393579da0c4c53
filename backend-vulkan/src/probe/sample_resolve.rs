//! How a device really resolves samples.

use super::{depth_resolve, integer_resolve};
use crate::base::Error;
use crate::gpu::Device;
use crate::process::SampleResolve;

/// The result of trying `device`'s resolves of depth and of integers. `draws_views`: whether it draws several views at once, if it
/// claims to.
///
/// # Errors
/// If the resolves can't be tried.
pub(crate) fn probe(device: &Device, draws_views: bool) -> Result<SampleResolve, Error> {
    let depth = depth_resolve::probe(device, draws_views)?;
    Ok(SampleResolve { refuted_integers: integer_resolve::is_refuted(device)?, ..depth })
}
