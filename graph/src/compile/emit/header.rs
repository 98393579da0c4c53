//! Settings, views and totals of the Plan.

use crate::compile::memory::PlacedResources;
use crate::frame::{self, Frame};
use crate::plan::{Change, SettingUsed, Totals, View, ViewEye, ViewId};

pub(super) fn settings(frame: &Frame) -> Vec<SettingUsed> {
    let settings = frame.settings.iter();
    settings.map(|(name, value)| SettingUsed { name: name.clone(), value: value.clone() }).collect()
}

pub(super) fn changes(frame: &Frame) -> Vec<Change> {
    let Frame { sources, changes, .. } = frame;
    changes.iter().map(|change| Change { action: change.action.clone(), at: sources.place(change.span) }).collect()
}

/// Totals with the sizes of memory.
pub(super) fn with_bytes(placed: &PlacedResources, totals: Totals) -> Totals {
    Totals {
        transient_bytes: placed.transient_bytes,
        placed_bytes: placed.heaps.iter().map(|heap| heap.bytes).sum(),
        live_peak_bytes: placed.live_peak_bytes,
        kept_bytes: placed.kept_bytes,
        ..totals
    }
}

pub(super) fn views(frame: &Frame) -> Vec<View> {
    let view = |view: &frame::View| View {
        name: view.name.clone(),
        extent: view.extent,
        camera: view.camera.clone(),
        allows: view.allows,
        jitter: view.jitter.clone(),
        eye: view.eye.map(|frame::ViewEye { eye, of }| ViewEye { eye, of: ViewId(of.0) }),
    };
    frame.views.iter().map(view).collect()
}
