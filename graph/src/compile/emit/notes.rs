//! Notes of the Plan.

use super::stage_results::StageResults;
use crate::plan::{Note, NoteKind};

/// Notes by stage.
pub(super) fn notes(results: &StageResults<'_>) -> Vec<Note> {
    let frame = results.frame;
    let off = frame.switched_off.iter().map(|off| {
        let (kind, text) = match &off.sampled {
            Some(name) => (NoteKind::LeftOut, format!("is compiled without `{name}`: {}", off.because)),
            None => (NoteKind::Off, format!("is off: {}", off.because)),
        };
        Note::new(kind, off.name.clone(), text, frame.sources.place(off.span))
    });
    let culled = results.decisions.live.culled.iter().map(|pass| {
        let pass = &frame.passes[*pass as usize];
        let text = "does not run: no output needs what it writes";
        Note::new(NoteKind::Unneeded, pass.name.clone(), text, frame.sources.place(pass.span))
    });
    let remarks = frame.remarks.iter().map(|remark| {
        let at = frame.sources.place(remark.span);
        Note::new(remark.kind, remark.subject.clone(), &*remark.text, at)
    });
    off.chain(remarks).chain(culled).chain(results.decisions.notes.iter().cloned()).collect()
}
