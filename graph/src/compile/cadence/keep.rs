//! What is read in other frames than it is written gets memory of its own.

use crate::base::{Code, Diagnostic, Span};
use crate::compile::model::{AdaptedFrame, Kind, MemorySource, OpKind, PhysicalIndex};
use crate::compile::scope::{op_name, resource_name};
use crate::frame::{Cadence, Frame, NoteKind};
use crate::plan::Note;
use crate::vulkan::{FillValue, Format};

/// No operation.
const NONE: u32 = u32::MAX;

/// Contents that must stay: who writes them, and who reads them in other frames.
#[derive(Debug, Clone, Copy)]
struct KeptContents {
    writer: u32,
    reader: u32,
}

/// Says in which frames each operation runs, and lets what they leave for other frames stay. An operation that was inserted after
/// passes that run together runs with them.
pub(in crate::compile) fn keep(frame: &Frame, adapted: &mut AdaptedFrame) -> Result<Vec<Note>, Vec<Diagnostic>> {
    if frame.passes.iter().all(|pass| pass.run.is_always()) {
        return Ok(Vec::new());
    }
    let mut walk = Walk {
        frame,
        adapted,
        cadences: Vec::with_capacity(adapted.ops.len()),
        last: vec![NONE; adapted.subresources as usize],
        kept: vec![None; adapted.subresources as usize],
    };
    for op in 0..adapted.ops.len() as u32 {
        walk.op(op);
    }
    walk.outputs();
    let errors = walk.mistakes();
    if !errors.is_empty() {
        return Err(errors);
    }
    let notes = walk.notes();
    let Walk { cadences, kept, .. } = walk;
    adapted.cadences = cadences;
    for number in 0..adapted.resources.len() {
        let of = adapted.resources[number].subresources();
        let resource = &mut adapted.resources[number];
        if resource.is_transient() && kept[of.start as usize..of.end as usize].iter().any(Option::is_some) {
            let initial = Some(zero(&resource.kind));
            resource.memory = MemorySource::Persistent { becomes: number as PhysicalIndex, initial };
        }
    }
    leave_contents(adapted);
    Ok(notes)
}

/// Where an operation may be left out, what it writes must be there already if it outlives the frame.
fn leave_contents(adapted: &mut AdaptedFrame) {
    let AdaptedFrame { ops, uses, resources, cadences, .. } = adapted;
    for (op, _) in ops.iter().zip(cadences).filter(|(_, cadence)| !cadence.is_always()) {
        for used in &mut uses[op.uses.start as usize..op.uses.end as usize] {
            used.reads |= used.writes && !resources[used.resource as usize].is_transient();
        }
    }
}

struct Walk<'w> {
    frame: &'w Frame,
    adapted: &'w AdaptedFrame,
    cadences: Vec<Cadence>,
    /// For each subresource the operation that wrote it last.
    last: Vec<u32>,
    /// For each subresource the contents that must stay.
    kept: Vec<Option<KeptContents>>,
}

impl Walk<'_> {
    fn op(&mut self, op: u32) {
        let adapted = self.adapted;
        let cadence = self.cadence(op);
        for used in adapted.uses(op).iter().filter(|used| used.reads) {
            adapted.for_each_subresource(used, |subresource| {
                let writer = self.last[subresource as usize];
                if let Some(of_writer) = self.cadences.get(writer as usize)
                    && !of_writer.is_always()
                    && *of_writer != cadence
                {
                    self.kept[subresource as usize].get_or_insert(KeptContents { writer, reader: op });
                }
            });
        }
        for used in adapted.uses(op).iter().filter(|used| used.writes) {
            adapted.for_each_subresource(used, |subresource| self.last[subresource as usize] = op);
        }
        self.cadences.push(cadence);
    }

    /// In which frames an operation runs.
    fn cadence(&self, op: u32) -> Cadence {
        let of_pass = |pass: u32| self.frame.passes[pass as usize].run.clone();
        match &self.adapted.ops[op as usize].kind {
            OpKind::Draw(pass)
            | OpKind::Pass(pass)
            | OpKind::DepthOnly { pass, .. }
            | OpKind::FillAgain { pass, .. } => of_pass(*pass),
            // Its target may be another image in the next frame, as that of a history is.
            OpKind::ForwardDraw { .. } | OpKind::ForwardCopy(_) => Cadence::Always,
            OpKind::ResolveDraw { .. } | OpKind::Resolve { .. } | OpKind::Copy(_) => self.of_source(op),
        }
    }

    /// The cadence of all that wrote the source of an operation, if that is one. What outlives the frame may have changed since.
    fn of_source(&self, op: u32) -> Cadence {
        let Some(source) = self.adapted.uses(op).first() else { return Cadence::Always };
        if !self.adapted.resources[source.resource as usize].is_transient() {
            return Cadence::Always;
        }
        let mut writers: Vec<Option<&Cadence>> = Vec::new();
        self.adapted.for_each_subresource(source, |subresource| {
            writers.push(self.cadences.get(self.last[subresource as usize] as usize));
        });
        match writers.split_first() {
            Some((Some(first), others)) if others.iter().all(|other| *other == Some(*first)) => (*first).clone(),
            _ => Cadence::Always,
        }
    }

    /// An output is read after each frame.
    fn outputs(&mut self) {
        for output in &self.adapted.outputs {
            for subresource in self.adapted.resources[*output as usize].subresources() {
                let writer = self.last[subresource as usize];
                if self.cadences.get(writer as usize).is_some_and(|cadence| !cadence.is_always()) {
                    self.kept[subresource as usize].get_or_insert(KeptContents { writer, reader: NONE });
                }
            }
        }
    }

    /// Mistakes that images have alone which are forwarded to each other: others were found in the frame.
    fn mistakes(&self) -> Vec<Diagnostic> {
        let Walk { frame, adapted, cadences, kept, .. } = self;
        let mut errors: Vec<Diagnostic> = Vec::new();
        let span =
            |op: u32| adapted.ops[op as usize].kind.pass().map_or(Span::NONE, |it| frame.passes[it as usize].span);
        let mut say = |code: Code, at: u32, resource: PhysicalIndex, what: &str| {
            let (name, image) = (self.name(at), resource_name(frame, adapted, resource));
            let message = format!("`{name}` runs {}, and writes `{image}`, {what}", cadences[at as usize]);
            let help = "let a pass copy it in each frame, in place of the pass that is off and forwards it";
            let wrong = Diagnostic::new(code, span(at), message).help(help);
            if !errors.contains(&wrong) {
                errors.push(wrong);
            }
        };
        for op in 0..adapted.ops.len() as u32 {
            for used in adapted.uses(op).iter().filter(|used| used.writes) {
                let memory = &adapted.resources[used.resource as usize].memory;
                adapted.for_each_subresource(used, |subresource| match (memory, kept[subresource as usize]) {
                    (MemorySource::Persistent { .. }, _) | (_, None) => {}
                    (MemorySource::Output | MemorySource::Imported { .. }, Some(KeptContents { writer, .. })) => {
                        say(
                            Code::KEPT_UNFIT,
                            writer,
                            used.resource,
                            "which leaves the frame, and each frame writes anew",
                        );
                    }
                    (MemorySource::Transient, Some(KeptContents { writer, reader })) => {
                        if op > reader || cadences[op as usize] != cadences[writer as usize] {
                            let other = self.name(op);
                            let what =
                                format!("which `{other}` writes in other frames, or after it was read in others");
                            say(Code::KEPT_WRITTEN, writer, used.resource, &what);
                        }
                    }
                });
            }
        }
        errors
    }

    /// Says of each image and buffer that stays why it does.
    fn notes(&self) -> Vec<Note> {
        let Walk { frame, adapted, kept, .. } = self;
        let mut notes = Vec::new();
        for (resource, number) in adapted.resources.iter().zip(0..).filter(|(it, _)| it.is_transient()) {
            let of = resource.subresources();
            let Some(first) = kept[of.start as usize..of.end as usize].iter().flatten().next() else { continue };
            let (writer, reader) = (self.name(first.writer), self.name(first.reader));
            let runs = &self.cadences[first.writer as usize];
            let text = format!("stays from frame to frame: `{writer}`, which runs {runs}, writes it for `{reader}`");
            let at = adapted.ops[first.writer as usize].kind.pass();
            let at = at.and_then(|pass| frame.sources.place(frame.passes[pass as usize].span));
            notes.push(Note::new(NoteKind::Stays, resource_name(frame, adapted, number).clone(), text, at));
        }
        notes
    }

    /// The name of an operation: of a transfer that was inserted that of its target.
    fn name(&self, op: u32) -> &str {
        let Walk { frame, adapted, .. } = self;
        let target = || adapted.uses(op).last().map_or("", |used| resource_name(frame, adapted, used.resource));
        op_name(frame, adapted, op).map_or_else(target, |name| &**name)
    }
}

/// All bits zero.
fn zero(kind: &Kind) -> FillValue {
    let of_format = |format: Format| match () {
        () if format.is_depth() => FillValue::Depth(0.0, 0),
        () if format.is_integer() => FillValue::Bits([0; 4]),
        () => FillValue::Color([0.0; 4]),
    };
    match kind {
        Kind::Image(image) => of_format(image.format),
        Kind::Buffer(_) => FillValue::Bits([0; 4]),
    }
}
