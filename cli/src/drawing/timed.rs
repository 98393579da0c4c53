//! The times of a Plan that is drawn for them.

use crate::error::Error;
use crate::system::interrupt;
use framewright::{Assets, SceneRenderer};
use framewright_graph::frame::Frame;
use framewright_graph::plan::Plan;
use framewright_passes::scene::Scene;
use framewright_viewer::Times;
use framewright_vulkan::{Device, ExecutorOptions};
use std::time::{Duration, Instant};

/// No more frames are drawn than this.
const MOST: usize = 20;
/// No frame is begun after this time.
const LONGEST: Duration = Duration::from_secs(2);

/// The times of some frames of a Plan as it is; `None`: the device measures none.
///
/// # Errors
/// Those of drawing; Ctrl-C.
pub(crate) fn times(
    device: &Device,
    (plan, frame): (&Plan, &Frame),
    assets: &mut Assets,
    scene: &Scene,
) -> Result<Option<Times>, Error> {
    let options = ExecutorOptions { timestamps: true, ..ExecutorOptions::default() };
    let mut prepared = SceneRenderer::new(device, (plan, Some(frame)), assets, scene, &options)?;
    let begun = Instant::now();
    let mut reports = Vec::new();
    while reports.is_empty() || reports.len() < MOST && begun.elapsed() < LONGEST {
        if interrupt::asked() {
            return Err(Error::Interrupted { frames: 0, wanted: 1 });
        }
        reports.push(prepared.draw()?);
    }
    Ok(Times::of(device, &reports))
}
