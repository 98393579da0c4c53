//! The order of passes: nothing is read before it is written, and the first writer covers or clears.

use super::accesses::{self, Read, Write};
use super::parts::Cells;
use super::resources::Resources;
use super::state::State;
use super::waits::{self, Need};
use super::writers::{Writer, Writers};
use super::written::{Cell, Written};
use crate::base::{Diagnostic, Span, keep};
use crate::frame::{Lifetime, Output, Pass, Resource};
use crate::language::StandIn;
use crate::vulkan::Aspects;
use std::fmt::{self, Display, Formatter};
use std::iter::{once, successors};

/// After this many mistakes the writer that was meant is no longer looked for: that would take long in a large file.
const MANY_MISTAKES: usize = 100;

struct Check<'a> {
    resources: &'a Resources<'a>,
    states: &'a [State],
    writers: Writers,
    /// The parts written so far, by resource. A part that was reported as unwritten counts as written: one report is enough.
    written: Vec<Written>,
    errors: &'a mut Vec<Diagnostic>,
}

/// Who reads an image or buffer.
#[derive(Clone, Copy)]
enum Reader<'a> {
    /// The pass of that name.
    Pass(&'a str),
    /// What stands in for the pass of that name.
    StandIn(&'a str),
    /// The frame, which gives it out.
    Frame,
    /// The program, which dumps it.
    Dump,
}

impl Display for Reader<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Reader::Pass(name) => write!(f, "pass `{name}`"),
            Reader::StandIn(name) => write!(f, "the stand-in of pass `{name}`"),
            Reader::Frame => f.write_str("the frame"),
            Reader::Dump => f.write_str("the dump"),
        }
    }
}

/// Walks through the passes in their order.
pub(super) fn check(resources: &Resources<'_>, states: &[State], outputs: &[Output], errors: &mut Vec<Diagnostic>) {
    let writers = Writers::find(resources, states);
    let written = writers.on.iter().map(|_| Written::default()).collect();
    let mut check = Check { resources, states, writers, written, errors };
    for (position, state) in states.iter().enumerate() {
        let name = &resources.pipeline.passes[position].name.text;
        let before = check.errors.len();
        match state {
            State::On(pass) => check.runs(position, pass, Reader::Pass(name), None),
            State::Off { stand_ins, .. } => {
                for (pass, described) in stand_ins.iter().zip(&resources.pipeline.passes[position].otherwise) {
                    let named = match described {
                        StandIn::Forward(forward) => Some(forward.from.span),
                        StandIn::Clear { .. } => None,
                    };
                    check.runs(position, pass, Reader::StandIn(name), named);
                }
            }
        }
        super::instances::used_here(
            resources.pipeline,
            resources.pipeline.passes[position].instance,
            &mut check.errors[before..],
        );
    }
    for (position, state) in states.iter().enumerate() {
        let looks_back = |pass: &&Pass| pass.accesses().any(|access| access.frames_ago() > 0);
        for pass in state.runs().iter().filter(looks_back) {
            let name = &resources.pipeline.passes[position].name.text;
            for read in accesses::reads(resources, pass).iter().filter(|read| read.frames_ago > 0) {
                check.needs(states.len(), read, Reader::Pass(name));
            }
        }
    }
    for output in outputs {
        let reader = if output.span == Span::NONE { Reader::Dump } else { Reader::Frame };
        if let Some(cells) = accesses::whole(resources, output.resource) {
            let read = Read { resource: output.resource, cells, frames_ago: 0, span: output.span };
            check.needs(states.len(), &read, reader);
        }
    }
}

impl Check<'_> {
    /// Reads, then writes. `named` is where a stand-in's source is named.
    fn runs(&mut self, position: usize, pass: &Pass, reader: Reader<'_>, named: Option<Span>) {
        let resources = self.resources;
        accesses::for_each_read(resources, pass, |read| {
            if read.frames_ago == 0 {
                let span = named.unwrap_or(read.span);
                self.needs(position, &Read { span, ..read }, reader);
            }
        });
        accesses::for_each_write(resources, pass, |write| {
            if let Some(clear) = write.continues {
                self.continues(position, pass, &write, clear);
            }
            self.add(write.resource, &write.cells);
        });
    }

    fn add(&mut self, of: Resource, cells: &Cells) {
        if let Some(whole) = accesses::whole(self.resources, of) {
            let at = self.writers.index(of);
            self.written[at].add(cells, &whole);
        }
    }

    /// The first of `cells` that holds nothing when the frame has come this far.
    fn missing(&self, of: Resource, cells: &Cells, frames_ago: u32) -> Option<Cell> {
        let holds = self.resources.lifetime(of)?.has_contents(of);
        if holds && frames_ago == 0 { None } else { self.written[self.writers.index(of)].missing(cells) }
    }

    /// Demands that the part that `reader` reads was written.
    fn needs(&mut self, position: usize, read: &Read, reader: Reader<'_>) {
        let of = read.resource;
        let Some(cell) = self.missing(of, &read.cells, read.frames_ago) else { return };
        let what = self.words(of, &read.cells, cell);
        self.add(of, &read.cells);
        let declared = self.resources.name(of);
        let (name, span) = (&declared.text, read.span);
        let diagnostic = if let Some((writer, because)) = self.off_before(of, position) {
            let off = &self.resources.pipeline.passes[writer.position].name.text;
            let message = format!("{reader} needs {what}, but pass `{off}`, which fills it, is off ({because})");
            let wrong = Diagnostic::new(span, message)
                .remark("needed here")
                .label(writer.span, "filled here, if the pass runs");
            match of {
                Resource::Image(_) => {
                    let narrower = match reader {
                        Reader::Pass(pass) => format!("; or give pass `{pass}` a `when` that is false as well"),
                        Reader::StandIn(_) | Reader::Frame | Reader::Dump => String::new(),
                    };
                    wrong.help(format!(
                        "say what `{name}` takes instead: `otherwise: Forward(from: \"…\", to: \"{name}\")`, or \
                         `otherwise: Clear(image: \"{name}\", value: 0)`{narrower}"
                    ))
                }
                Resource::Buffer(_) => {
                    wrong.help("let another pass fill it then, such as `fill: (to: \"…\", value: 0)`")
                }
            }
        } else if read.frames_ago > 0 {
            let message = format!("{reader} reads what an earlier frame left of {what}, but no pass writes it");
            let wrong = Diagnostic::new(span, message).remark("read here").label(declared.span, "declared here");
            wrong.help("each frame writes what has history anew")
        } else if let Some(writer) = self.writer_of(of, cell) {
            self.too_early(position, read, &what, writer)
        } else if let Some(Lifetime::Imported { .. }) = self.resources.lifetime(of) {
            let message = format!("{reader} reads {what}, which is handed in without contents, and no pass writes it");
            let wrong = Diagnostic::new(span, message).remark("read here").label(declared.span, "imported here");
            wrong.help("`before: Undefined` says that there is nothing to read: say in which state it really is")
        } else {
            let message = format!("{reader} needs {what}, but no pass writes it");
            let wrong = Diagnostic::new(span, message).remark("needed here").label(declared.span, "declared here");
            self.removed(wrong, name)
        };
        keep(self.errors, diagnostic);
    }

    /// Where a pass is named, and each use that it came by: the same places for all that one entry repeats.
    fn named_at(&self, position: usize) -> Vec<Span> {
        let pipeline = self.resources.pipeline;
        let pass = &pipeline.passes[position];
        let whole = |within: Option<u32>| within.and_then(|at| pipeline.instances.get(at as usize));
        let uses = successors(whole(pass.instance), |instance| whole(instance.within));
        once(pass.name.span).chain(uses.map(|instance| instance.span)).collect()
    }

    /// A read that stands before the first write.
    fn too_early(&self, position: usize, read: &Read, what: &str, writer: Writer) -> Diagnostic {
        let of = read.resource;
        let wrong = Diagnostic::new(read.span, format!("{what} is read before it is written")).remark("read here");
        if writer.position == position {
            let mut help = "a pass reads what stood there before the pass".to_owned();
            if let Some(previous) = self.previous(of) {
                help = format!("{help}; {previous}");
            }
            return wrong.label(writer.span, "first written here, by the same pass").help(help);
        }
        let first = Need { pass: position, resource: of, span: read.span, writer: writer.position };
        let few = self.errors.len() < MANY_MISTAKES;
        if few && let Some(circle) = waits::circle(self.resources, self.states, &self.writers, first) {
            return waits::report(self.resources, &circle);
        }
        let below = &self.resources.pipeline.passes[writer.position].name.text;
        // One repetition can't be moved by itself.
        if self.named_at(writer.position) == self.named_at(position) {
            let help = "a repetition can read only what repetitions with lower numbers wrote";
            return wrong.label(writer.span, format!("first written here, by `{below}`")).help(help);
        }
        let wrong = wrong.label(writer.span, "first written here, further below");
        // Further up, the writer itself would read a part that nothing has written.
        let reads = self.states[writer.position].runs().iter().flat_map(|pass| accesses::reads(self.resources, pass));
        if reads.into_iter().any(|own| own.resource == of && own.frames_ago == 0 && own.cells == read.cells) {
            return wrong.help(format!("another pass has to write it first, since `{below}` reads it as well"));
        }
        let wrong = self.removed(wrong, &self.resources.name(of).text);
        if let Some(previous) = self.previous(of) {
            return wrong.help(format!("{previous}; else move pass `{below}` up"));
        }
        wrong.help(format!("move pass `{below}` up: the order of passes gives them their meaning"))
    }

    /// How a pass reads what the frame before left in something that has a history.
    fn previous(&self, of: Resource) -> Option<String> {
        let Some(Lifetime::History { .. }) = self.resources.lifetime(of) else { return None };
        let name = &self.resources.name(of).text;
        let kind = if matches!(of, Resource::Image(_)) { "image" } else { "buffer" };
        Some(format!("what the frame before left is `({kind}: \"{name}\", previous: 1)`"))
    }

    /// Shows where passes were removed that may have written the missing part.
    fn removed(&self, wrong: Diagnostic, name: &str) -> Diagnostic {
        let removed = &self.resources.pipeline.removed;
        let named = removed.iter().filter(|pass| pass.texts.iter().any(|text| **text == *name));
        named.fold(wrong, |wrong, pass| {
            wrong.label(pass.span, format!("pass `{}`, which uses `{name}`, is removed here", pass.name))
        })
    }

    /// Demands that a target has contents that a draw can be added to.
    fn continues(&mut self, position: usize, pass: &Pass, write: &Write, clear: &str) {
        let Some(cell) = self.missing(write.resource, &write.cells, 0) else { return };
        let what = self.words(write.resource, &write.cells, cell);
        let name = &self.resources.name(write.resource).text;
        let layers = write.cells.layers.clone();
        // Shaders choose no layer, so draws land in the first.
        let several = layers.len() > 1;
        // Which layer is meant was asked already.
        let here = |error: &Diagnostic| error.labels.first().is_some_and(|label| label.span == write.span);
        if several && self.errors.iter().any(here) {
            return;
        }
        let why = match &pass.untouched {
            _ if several => ": a draw reaches only the first of several layers".to_owned(),
            Some(why) => format!(": {why}"),
            None => String::new(),
        };
        let message =
            format!("pass `{}` is the first to draw into {what} and may leave texels untouched{why}", pass.name);
        let clear = clear.replace('…', name);
        let clear = match accesses::whole(self.resources, write.resource) {
            Some(whole) => {
                let mip = if whole.mips.len() > 1 { format!(", mip: {}", cell.mip) } else { String::new() };
                let layer = match layers.len() {
                    1 if whole.layers.len() > 1 => format!(", layer: {}", cell.layer),
                    0 | 1 => String::new(),
                    _ if layers == whole.layers => ", layers: Rest".to_owned(),
                    several => format!(", layer: {}, layers: {several}", layers.start),
                };
                clear.replacen("\",", &format!("\"{mip}{layer},"), 1)
            }
            None => clear,
        };
        let promise = match &pass.untouched {
            Some(_) if !several => "; or say `covers: true` of the pass, which promises that it sets every texel",
            _ => "",
        };
        let diagnostic = Diagnostic::new(write.span, message).help(format!("clear it: `{clear}`{promise}"));
        let mut diagnostic = self.removed(diagnostic, name);
        if let Some((writer, because)) = self.off_before(write.resource, position) {
            let off = &self.resources.pipeline.passes[writer.position].name.text;
            diagnostic =
                diagnostic.label(writer.span, format!("pass `{off}` would come first, but is off ({because})"));
        }
        keep(self.errors, diagnostic);
    }

    /// "`color`", or "mip level 2 of `color`" where a part of `cells` alone is missing.
    fn words(&self, of: Resource, cells: &Cells, cell: Cell) -> String {
        let name = &self.resources.name(of).text;
        let Some(whole) = accesses::whole(self.resources, of) else { return format!("`{name}`") };
        if *cells == whole && self.written[self.writers.index(of)].is_blank() {
            return format!("`{name}`");
        }
        let mut words = Vec::new();
        if whole.planes.bits().count_ones() > 1 {
            words.push(if cell.plane == Aspects::DEPTH { "the depth".to_owned() } else { "the stencil".to_owned() });
        }
        if whole.mips.len() > 1 {
            words.push(format!("mip level {}", cell.mip));
        }
        if whole.layers.len() > 1 {
            words.push(format!("layer {}", cell.layer));
        }
        if words.is_empty() { format!("`{name}`") } else { format!("{} of `{name}`", words.join(", ")) }
    }

    /// The first pass that runs and writes `cell`, or after many mistakes any part.
    fn writer_of(&self, of: Resource, cell: Cell) -> Option<Writer> {
        let writers = &self.writers.on[self.writers.index(of)];
        let few = self.errors.len() < MANY_MISTAKES;
        let writes = |writer: &&Writer| {
            let pass = self.states[writer.position].runs();
            let writes = pass.iter().flat_map(|pass| accesses::writes(self.resources, pass));
            writes.into_iter().any(|write| write.resource == of && write.cells.contains(cell))
        };
        let first = if few { writers.iter().find(writes) } else { writers.first() };
        first.copied()
    }

    /// The pass before `position` that would have filled it and is off, and why.
    fn off_before(&self, of: Resource, position: usize) -> Option<(Writer, &str)> {
        let writer = *self.writers.off[self.writers.index(of)].first().filter(|writer| writer.position < position)?;
        match &self.states[writer.position] {
            State::Off { because, .. } => Some((writer, because)),
            State::On(_) => None,
        }
    }
}
