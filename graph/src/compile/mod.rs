//! A frame becomes a Plan: one file or folder per stage, each a function from data to data.
//!
//! ```text
//! rotate ─► validate ─► parts ─► link ─► cull ─► fit ─► adapt ─► schedule ─► scope ─► queues ─► retain ─► timeline ─► usage
//!                                                                                       (these don't depend on sizes)
//!       ─► place ─► aliasing ─► barriers ─► emit
//! ```
//!
//! `structure` runs the stages. `incremental` keeps their decisions from frame to frame.

use crate::base::Diagnostic;
use crate::device::{MemoryProvider, Profile};
use crate::frame::{Frame, tracked as parts};
use crate::plan::Plan;
use emit::{StageResults, Subject};
use structure::Structure;

mod adapt;
mod cull;
mod emit;
mod fit;
pub mod heap_size;
mod history_ring;
mod incremental;
mod link;
mod memory;
mod model;
mod options;
mod queues;
mod retain;
mod rotate;
mod schedule;
mod scope;
pub mod shaders;
mod steps;
mod structure;
mod sync;
mod usage;
mod validate;

pub use incremental::{Compiler, Reuse};
pub use options::{Options, Order};

/// Finds out how `frame` is made on `device`.
///
/// Deterministic: equal input gives an equal Plan.
///
/// # Errors
/// Everything that is wrong with the frame itself, or that the device can't do, with places.
pub fn compile(
    frame: &Frame,
    device: &Profile,
    memory: &mut dyn MemoryProvider,
    options: &Options,
) -> Result<Plan, Vec<Diagnostic>> {
    let turned = rotate::rotate(frame)?;
    let frame = turned.as_ref().unwrap_or(frame);
    let (mut structure, substitute) = Structure::find_with_fallback(frame, device, options, false)?;
    let mut settled = structure.settle_for_good(device, memory, options)?;
    let frame = substitute.as_ref().unwrap_or(frame);
    let subjects = Subject::of(&structure.adapted);
    let mut steps = emit::steps(&StageResults::new(frame, device, &structure, &settled).with_subjects(&subjects));
    // Only `steps` needs these.
    (settled.barriers.barriers, settled.barriers.batched) = (Vec::new(), Vec::new());
    let results = StageResults::new(frame, device, &structure, &settled).with_subjects(&subjects);
    let totals = emit::put_in_work(&results, &mut steps);
    // Only `put_in_work` needs these.
    (structure.adapted.ops, structure.adapted.uses) = (Vec::new(), Vec::new());
    (structure.live.passes, structure.scoped.steps) = (Vec::new(), Vec::new());
    drop(subjects);
    let resources = emit::resources(frame, &structure, &settled);
    Ok(emit::emit(&StageResults::new(frame, device, &structure, &settled), (steps, totals), resources))
}
