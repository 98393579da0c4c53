//! Whether each reader finds the same where passes before it are left out.

use crate::base::{Code, Diagnostic, Span};
use crate::frame::tracked_parts::Parts;
use crate::frame::{Cadence, Frame, Lifetime, Pass, Resource};

/// What is known of a part while passes are followed in their order.
#[derive(Debug, Clone, Default)]
struct PartUse {
    /// The passes that wrote it, in their order, and where they name it.
    writers: Vec<(u32, Span)>,
    /// The writer whose contents must stay, and who reads them in other frames.
    kept: Option<(u32, Reader)>,
}

/// Who reads contents in frames in which their writer may not run.
#[derive(Debug, Clone, Copy)]
enum Reader {
    Pass(u32),
    Output,
}

/// Checks the cadences of passes, and that what they leave for other frames is theirs alone.
pub(in crate::compile) fn check(frame: &Frame, parts: &Parts<'_>) -> Result<(), Vec<Diagnostic>> {
    if frame.passes.iter().all(|pass| pass.run.is_always()) {
        return Ok(());
    }
    let mut check = Check { frame, parts, uses: vec![PartUse::default(); parts.len()], errors: Vec::new() };
    for (pass, number) in frame.passes.iter().zip(0..) {
        check.pass(pass, number);
    }
    for output in &frame.outputs {
        if *check.lifetime(output.resource) == Lifetime::Transient {
            check.parts.of(output.resource).for_each(|part| check.read(part, None, Reader::Output));
            check.output(output.resource);
        }
    }
    for part in 0..check.uses.len() {
        check.writers_agree(part);
    }
    if check.errors.is_empty() { Ok(()) } else { Err(check.errors) }
}

struct Check<'c> {
    frame: &'c Frame,
    parts: &'c Parts<'c>,
    uses: Vec<PartUse>,
    errors: Vec<Diagnostic>,
}

impl Check<'_> {
    fn pass(&mut self, pass: &Pass, number: u32) {
        if let Some(what) = pass.run.problem() {
            self.say(Diagnostic::new(Code::CADENCE_UNFIT, pass.span, format!("`{}` runs {what}", pass.name)));
        }
        let (parts, mut written, mut read) = (self.parts, Vec::new(), Vec::new());
        parts.for_each_access(pass, |access, part, reads, writes| {
            read.extend(reads.then_some(part));
            written.extend(writes.then_some((part, access.span())));
        });
        read.into_iter().for_each(|part| self.read(part as usize, Some(&pass.run), Reader::Pass(number)));
        for (part, span) in written {
            self.write(pass, number, part, span);
        }
    }

    fn lifetime(&self, of: Resource) -> &Lifetime {
        match of {
            Resource::Image(image) => &self.frame.images[image.0 as usize].lifetime,
            Resource::Buffer(buffer) => &self.frame.buffers[buffer.0 as usize].lifetime,
        }
    }

    fn name(&self, pass: u32) -> &str {
        &self.frame.passes[pass as usize].name
    }

    fn run(&self, pass: u32) -> &Cadence {
        &self.frame.passes[pass as usize].run
    }

    /// A part is read, by a pass that runs so, or by what comes after the frame. What outlives the frame is as the last pass left it,
    /// whenever that ran.
    fn read(&mut self, part: usize, run: Option<&Cadence>, reader: Reader) {
        let Some((writer, _)) = self.uses[part].writers.last().copied() else { return };
        let cadence = self.run(writer);
        let foreign = !cadence.is_always() && run != Some(cadence);
        if foreign && *self.lifetime(self.parts.owner(part as u32)) == Lifetime::Transient {
            self.uses[part].kept.get_or_insert((writer, reader));
        }
    }

    fn write(&mut self, pass: &Pass, number: u32, part: u32, span: Span) {
        let of = self.parts.owner(part);
        if !pass.run.is_always() {
            let what = match self.lifetime(of) {
                Lifetime::History { .. } => Some("has a history, which each frame writes anew"),
                Lifetime::Imported { .. } => Some("is handed in, perhaps as another one in each frame"),
                Lifetime::Transient | Lifetime::Persistent { .. } | Lifetime::File(_) => None,
            };
            if let Some(what) = what {
                self.unfit(pass, of, what, span);
            }
        }
        if let Some((_, reader)) = self.uses[part as usize].kept {
            self.written_after(pass, of, reader, span);
        }
        self.uses[part as usize].writers.push((number, span));
    }

    /// Something leaves the frame that a pass doesn't write in each.
    fn output(&mut self, of: Resource) {
        let parts = self.parts.of(of);
        let kept = self.uses[parts].iter().find_map(|it| Some((it.kept?.0, it.writers.last()?.1)));
        if let Some((writer, span)) = kept {
            let pass = &self.frame.passes[writer as usize];
            self.unfit(pass, of, "is an output, which each frame writes anew", span);
        }
    }

    fn unfit(&mut self, pass: &Pass, of: Resource, what: &str, span: Span) {
        let (frame, name) = (self.frame, &pass.name);
        let message = format!("`{name}` runs {}, and writes `{}`, which {what}", pass.run, frame.name(of));
        let help = "let it write an image or buffer of its own, and another pass copy that in each frame";
        self.say(Diagnostic::new(Code::KEPT_UNFIT, span, message).help(help));
    }

    fn written_after(&mut self, pass: &Pass, of: Resource, reader: Reader, span: Span) {
        let Reader::Pass(reader) = reader else { return };
        let (frame, name) = (self.frame, &pass.name);
        let (image, reader) = (frame.name(of), self.name(reader));
        let message = format!(
            "`{name}` writes `{image}` after `{reader}` read it: where `{reader}` runs alone, it would read what `{name}` wrote"
        );
        let help = "let the later pass write a copy, or give the reader the same `run`";
        self.say(Diagnostic::new(Code::KEPT_WRITTEN, span, message).help(help));
    }

    /// What stays for other frames is written by passes that run together.
    fn writers_agree(&mut self, part: usize) {
        let Some((writer, reader)) = self.uses[part].kept else { return };
        let of = self.parts.owner(part as u32);
        if let Resource::Image(image) = of
            && self.frame.images[image.0 as usize].allocated.is_some()
        {
            let span = self.uses[part].writers.first().map_or(Span::NONE, |(_, span)| *span);
            let pass = &self.frame.passes[writer as usize];
            self.unfit(pass, of, "changes its size from frame to frame", span);
        }
        for (other, span) in self.uses[part].writers.clone() {
            if self.run(other) == self.run(writer) {
                continue;
            }
            let (one, another, name) = (self.name(other), self.name(writer), self.frame.name(of));
            let (runs, others) = (self.run(other), self.run(writer));
            let reader = match reader {
                Reader::Pass(reader) => format!("`{}` reads it", self.name(reader)),
                Reader::Output => "it is read".to_owned(),
            };
            let message = format!(
                "`{one}` runs {runs} and writes `{name}`, which `{another}` writes too, {others}; {reader} in other frames"
            );
            let help = "let one of them write an image of its own, or give both the same `run`";
            self.say(Diagnostic::new(Code::KEPT_WRITTEN, span, message).help(help));
        }
    }

    /// Reports a mistake, once for all parts.
    fn say(&mut self, wrong: Diagnostic) {
        if !self.errors.contains(&wrong) {
            self.errors.push(wrong);
        }
    }
}
