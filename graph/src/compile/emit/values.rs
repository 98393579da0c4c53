//! Settings, views and totals of the Plan.

use super::stage_results::StageResults;
use crate::frame::{self, Frame};
use crate::plan::{Change, SettingUsed, Totals, View, ViewEye, ViewId};

pub(super) fn settings(results: &StageResults<'_>) -> Vec<SettingUsed> {
    let settings = results.frame.settings.iter();
    settings.map(|(name, value)| SettingUsed { name: name.clone(), value: value.clone() }).collect()
}

pub(super) fn changes(results: &StageResults<'_>) -> Vec<Change> {
    let Frame { sources, changes, .. } = results.frame;
    changes.iter().map(|change| Change { action: change.action.clone(), at: sources.place(change.span) }).collect()
}

/// Totals with the sizes of memory.
pub(super) fn with_bytes(results: &StageResults<'_>, totals: Totals) -> Totals {
    Totals {
        transient_bytes: results.placed.transient_bytes,
        placed_bytes: results.placed.heaps.iter().map(|heap| heap.bytes).sum(),
        live_peak_bytes: results.placed.live_peak_bytes,
        kept_bytes: results.placed.kept_bytes,
        ..totals
    }
}

pub(super) fn views(results: &StageResults<'_>) -> Vec<View> {
    let view = |view: &frame::View| View {
        name: view.name.clone(),
        extent: view.extent,
        camera: view.camera.clone(),
        allows: view.allows,
        jitter: view.jitter.clone(),
        eye: view.eye.map(|frame::ViewEye { eye, of }| ViewEye { eye, of: ViewId(of.0) }),
    };
    results.frame.views.iter().map(view).collect()
}
