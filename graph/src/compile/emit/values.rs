//! Settings, views and totals of the Plan.

use super::stage_results::StageResults;
use crate::frame::{self, Frame};
use crate::plan::{Change, SettingUsed, Totals, View, ViewEye, ViewId};

pub(super) fn settings(parts: &StageResults<'_>) -> Vec<SettingUsed> {
    let settings = parts.frame.settings.iter();
    settings.map(|(name, value)| SettingUsed { name: name.clone(), value: value.clone() }).collect()
}

pub(super) fn changes(parts: &StageResults<'_>) -> Vec<Change> {
    let Frame { sources, changes, .. } = parts.frame;
    changes.iter().map(|change| Change { action: change.action.clone(), at: sources.place(change.span) }).collect()
}

/// Totals with the sizes of memory.
pub(super) fn with_bytes(parts: &StageResults<'_>, totals: Totals) -> Totals {
    Totals {
        transient_bytes: parts.placed.transient_bytes,
        placed_bytes: parts.placed.heaps.iter().map(|heap| heap.bytes).sum(),
        live_peak_bytes: parts.placed.live_peak_bytes,
        kept_bytes: parts.placed.kept_bytes,
        ..totals
    }
}

pub(super) fn views(parts: &StageResults<'_>) -> Vec<View> {
    let view = |view: &frame::View| View {
        name: view.name.clone(),
        extent: view.extent,
        camera: view.camera.clone(),
        allows: view.allows,
        jitter: view.jitter.clone(),
        eye: view.eye.map(|frame::ViewEye { eye, of }| ViewEye { eye, of: ViewId(of.0) }),
    };
    parts.frame.views.iter().map(view).collect()
}
