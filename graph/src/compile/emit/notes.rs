//! Notes of the Plan.

use super::stage_results::StageResults;
use crate::plan::{Note, Stage};

/// Notes by stage.
pub(super) fn notes(results: &StageResults<'_>) -> Vec<Note> {
    let frame = results.frame;
    let off = frame.switched_off.iter().map(|off| Note {
        stage: Stage::Expand,
        subject: off.name.clone(),
        text: match &off.sampled {
            Some(name) => format!("is compiled without `{name}`: {}", off.because),
            None => format!("is off: {}", off.because),
        },
        at: frame.sources.place(off.span),
    });
    let culled = results.decisions.live.culled.iter().map(|pass| &frame.passes[*pass as usize]).map(|pass| Note {
        stage: Stage::Cull,
        subject: pass.name.clone(),
        text: "does not run: no output needs what it writes".to_owned(),
        at: frame.sources.place(pass.span),
    });
    let remarks = frame.remarks.iter().map(|remark| Note {
        stage: if remark.instead { Stage::Fit } else { Stage::Expand },
        subject: remark.subject.clone(),
        text: remark.text.clone(),
        at: frame.sources.place(remark.span),
    });
    off.chain(remarks).chain(culled).chain(results.decisions.notes.iter().cloned()).collect()
}
