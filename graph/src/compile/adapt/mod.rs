//! `adapt`: samples, sizes and formats are made to meet. Resolves, copies and second images are inserted, each with its
//! cause; passes that are off forward what they would have replaced.
//!
//! A resolve belongs to a *version* of an image and is shared by all its readers.

mod access;
mod adapter;
mod demote;
mod depth_only;
mod forward;
mod last_accesses;
mod pass;
mod resolve;
mod resources;
mod versions;

pub(super) use access::has_samples;
pub(super) use adapter::Input;

use super::cadence;
use super::model::AdaptedFrame;
use crate::base::Diagnostic;
use crate::frame::Resource;
use crate::plan::Note;
use adapter::Adapter;
use last_accesses::LastAccesses;

/// The physical resources and operations of a frame, with notes of what was decided.
pub(super) fn adapt(input: Input<'_>) -> Result<(AdaptedFrame, Vec<Note>), Vec<Diagnostic>> {
    let Input { frame, live, .. } = input;
    let mut adapter = Adapter::new(input);
    if live.passes.iter().any(|pass| frame.passes[*pass as usize].work.forwarded().is_some()) {
        adapter.last_accesses = LastAccesses::of(frame, live);
        adapter.is_output = vec![false; frame.images.len()];
        for output in &frame.outputs {
            if let Resource::Image(image) = output.resource {
                adapter.is_output[image.0 as usize] = true;
            }
        }
    }
    adapter.demotions = demote::find(&input, &mut adapter.notes);
    adapter.adapted.resources.reserve(frame.images.len());
    adapter.adapted.ops.reserve(live.passes.len());
    adapter.adapted.uses.reserve(live.passes.len() * 4 + frame.images.len());
    for pass in &live.passes {
        adapter.pass(*pass);
    }
    for output in &frame.outputs {
        adapter.output(output);
    }
    if adapter.renamed {
        resources::distinct_names(frame, &mut adapter.adapted.resources);
    }
    // Depth is tested by passes with attachments, and by draws that are inserted for second images.
    if input.negotiated.attached || adapter.renamed {
        access::settle_depth(&mut adapter.adapted);
    }
    let Adapter { mut adapted, mut notes, errors, .. } = adapter;
    if !errors.is_empty() {
        return Err(errors);
    }
    notes.extend(cadence::keep(frame, &mut adapted)?);
    Ok((adapted, notes))
}
