//! The order of passes: what reads or keeps contents that nothing has written, in words of the file.

use super::accesses;
use super::waits::{self, Need};
use super::writers::{Writer, Writers};
use crate::base::{Code, Diagnostic, Span, keep};
use crate::expand::mistakes::{self, ReportedMistakes};
use crate::expand::passes::State;
use crate::expand::resources::Resources;
use crate::frame::check::contents::{Demand, MissingContents};
use crate::frame::tracked_parts::Parts;
use crate::frame::{Lifetime, Output, Pass, Resource};
use crate::language::StandIn;
use crate::vulkan::{Aspects, Subresources};
use std::fmt::{self, Display, Formatter};
use std::iter::{once, successors};

/// After this many mistakes the writer that was meant is no longer looked for: that would take long in a large file.
const MANY_MISTAKES: usize = 100;

struct Check<'a> {
    resources: &'a Resources<'a>,
    states: &'a [State],
    parts: &'a Parts<'a>,
    writers: Writers,
    errors: &'a mut Vec<Diagnostic>,
    /// Mistakes that were found so far, also those that are told once for several passes.
    found: usize,
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

/// Follows contents through the passes in their order.
pub(in crate::expand) fn check(
    resources: &Resources<'_>,
    states: &[State],
    outputs: &[Output],
    parts: &Parts<'_>,
    (reported, errors): (&mut ReportedMistakes, &mut Vec<Diagnostic>),
) {
    let mut contents = accesses::contents(resources, parts);
    let (writers, found) = (Writers::find(resources, states), errors.len());
    let mut check = Check { resources, states, parts, writers, errors, found };
    for ((position, state), number) in states.iter().enumerate().zip(1..) {
        let described = &resources.pipeline.passes[position];
        let name = &described.name.text;
        let before = check.errors.len();
        match state {
            State::On(pass) => {
                for found in contents.pass(pass, number) {
                    check.unwritten(position, pass, &found, Reader::Pass(name));
                }
            }
            State::Off { stand_ins, .. } => {
                for (pass, stand_in) in stand_ins.iter().zip(&described.otherwise) {
                    for found in contents.pass(pass, number) {
                        let span = match stand_in {
                            StandIn::Forward(forward) => forward.from.span,
                            StandIn::Clear { .. } => found.span,
                        };
                        check.needs(position, &MissingContents { span, ..found }, Reader::StandIn(name));
                    }
                }
            }
        }
        reported.once(check.errors, before);
        mistakes::used_here(resources.pipeline, described.instance, &mut check.errors[before..]);
    }
    for (state, described) in states.iter().zip(&resources.pipeline.passes) {
        let before = check.errors.len();
        for found in state.runs().iter().flat_map(|pass| contents.earlier(pass)).collect::<Vec<_>>() {
            check.needs(states.len(), &found, Reader::Pass(&described.name.text));
        }
        reported.once(check.errors, before);
    }
    for output in outputs {
        let before = check.errors.len();
        let reader = if output.span == Span::NONE { Reader::Dump } else { Reader::Frame };
        if let Some(found) = contents.output(output.resource, output.span) {
            check.needs(states.len(), &found, reader);
        }
        reported.once(check.errors, before);
    }
}

impl Check<'_> {
    fn report(&mut self, mistake: Diagnostic) {
        self.found += 1;
        keep(self.errors, mistake);
    }

    fn unwritten(&mut self, position: usize, pass: &Pass, found: &MissingContents, reader: Reader<'_>) {
        match found.demand {
            Demand::Color | Demand::Depth => self.continues(position, pass, found),
            Demand::Read | Demand::Earlier | Demand::Output => self.needs(position, found, reader),
        }
    }

    /// `reader` reads a part that nothing has written.
    fn needs(&mut self, position: usize, found: &MissingContents, reader: Reader<'_>) {
        let MissingContents { of, span, .. } = *found;
        let what = self.words(found);
        let declared = self.resources.name(of);
        let name = &declared.text;
        let diagnostic = if let Some((writer, because)) = self.off_before(of, position) {
            let off = &self.resources.pipeline.passes[writer.position].name.text;
            let message = format!("{reader} needs {what}, but pass `{off}`, which fills it, is off ({because})");
            let wrong = Diagnostic::new(Code::WRITER_IS_OFF, span, message)
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
        } else if found.demand == Demand::Earlier {
            let message = format!("{reader} reads what an earlier frame left of {what}, but no pass writes it");
            let wrong = Diagnostic::new(Code::HISTORY_NEVER_WRITTEN, span, message)
                .remark("read here")
                .label(declared.span, "declared here");
            wrong.help("each frame writes what has history anew")
        } else if let Some(writer) = self.writer_of(of, found.missing) {
            self.too_early(position, found, &what, writer)
        } else if let Some(Lifetime::Imported { .. }) = self.resources.lifetime(of) {
            let message = format!("{reader} reads {what}, which is handed in without contents, and no pass writes it");
            let wrong = Diagnostic::new(Code::IMPORTED_WITHOUT_CONTENTS, span, message)
                .remark("read here")
                .label(declared.span, "imported here");
            wrong.help("`before: Undefined` says that there is nothing to read: say in which state it really is")
        } else {
            let message = format!("{reader} needs {what}, but no pass writes it");
            let wrong = Diagnostic::new(Code::NEVER_WRITTEN, span, message)
                .remark("needed here")
                .label(declared.span, "declared here");
            self.removed(wrong, name)
        };
        self.report(diagnostic);
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
    fn too_early(&self, position: usize, found: &MissingContents, what: &str, writer: Writer) -> Diagnostic {
        let MissingContents { of, span, needed, .. } = *found;
        let wrong = Diagnostic::new(Code::READ_BEFORE_WRITTEN, span, format!("{what} is read before it is written"))
            .remark("read here");
        if writer.position == position {
            let mut help = "a pass reads what stood there before the pass".to_owned();
            let draws = &self.resources.pipeline.passes[position].color;
            if draws.iter().any(|target| Resource::Image(target.part.image.index) == of) {
                help.push_str(": let it draw into another image");
            }
            if let Some(previous) = self.previous(of) {
                help = format!("{help}; {previous}");
            }
            return wrong.label(writer.span, "first written here, by the same pass").help(help);
        }
        let first = Need { pass: position, resource: of, span, writer: writer.position };
        let few = self.found < MANY_MISTAKES;
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
        let uses = self.states[writer.position].runs().iter().flat_map(|pass| accesses::uses(self.resources, pass));
        if uses.into_iter().any(|own| own.reads && !own.attaches && own.resource == of && own.part == needed) {
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

    /// A draw is added to a target of which nothing has written a part.
    fn continues(&mut self, position: usize, pass: &Pass, found: &MissingContents) {
        let MissingContents { of, span, needed, missing, .. } = *found;
        let what = self.words(found);
        let name = &self.resources.name(of).text;
        // Shaders choose no layer, so draws land in the first.
        let several = needed.layers > 1;
        // Which layer is meant was asked already.
        let here = |error: &Diagnostic| error.labels.first().is_some_and(|label| label.span == span);
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
        let whole = self.parts.part(of, Subresources::WHOLE);
        let mip = if whole.mips > 1 { format!(", mip: {}", missing.base_mip) } else { String::new() };
        let layer = match needed.layers {
            1 if whole.layers > 1 => format!(", layer: {}", missing.base_layer),
            0 | 1 => String::new(),
            several if several == whole.layers => ", layers: Rest".to_owned(),
            several => format!(", layer: {}, layers: {several}", needed.base_layer),
        };
        let clear = match found.demand {
            Demand::Color => "clear: (0.0, 0.0, 0.0, 1.0)",
            _ if needed.aspects == Aspects::STENCIL => "stencil: (clear: 0)",
            _ => "clear: 0.0",
        };
        let clear = format!("(image: \"{name}\"{mip}{layer}, {clear})");
        let promise = match &pass.untouched {
            Some(_) if !several => "; or say `covers: true` of the pass, which promises that it sets every texel",
            _ => "",
        };
        let diagnostic =
            Diagnostic::new(Code::NOT_CLEARED, span, message).help(format!("clear it: `{clear}`{promise}"));
        let mut diagnostic = self.removed(diagnostic, name);
        if let Some((writer, because)) = self.off_before(of, position) {
            let off = &self.resources.pipeline.passes[writer.position].name.text;
            diagnostic =
                diagnostic.label(writer.span, format!("pass `{off}` would come first, but is off ({because})"));
        }
        self.report(diagnostic);
    }

    /// "`color`", or "mip level 2 of `color`" where only a part is missing.
    fn words(&self, found: &MissingContents) -> String {
        let MissingContents { of, needed, missing, is_blank, .. } = *found;
        let (name, whole) = (&self.resources.name(of).text, self.parts.part(of, Subresources::WHOLE));
        if is_blank && needed == whole {
            return format!("`{name}`");
        }
        let mut words = Vec::new();
        if whole.aspects.bits().count_ones() > 1 {
            words.push(if missing.aspects == Aspects::DEPTH {
                "the depth".to_owned()
            } else {
                "the stencil".to_owned()
            });
        }
        if whole.mips > 1 {
            words.push(format!("mip level {}", missing.base_mip));
        }
        if whole.layers > 1 {
            words.push(format!("layer {}", missing.base_layer));
        }
        if words.is_empty() { format!("`{name}`") } else { format!("{} of `{name}`", words.join(", ")) }
    }

    /// The first pass that runs and writes the part, or after many mistakes any part.
    fn writer_of(&self, of: Resource, missing: Subresources) -> Option<Writer> {
        let writers = &self.writers.on[self.writers.index(of)];
        let few = self.found < MANY_MISTAKES;
        let writes = |writer: &&Writer| {
            let pass = self.states[writer.position].runs();
            let uses = pass.iter().flat_map(|pass| accesses::uses(self.resources, pass));
            uses.into_iter().any(|used| used.writes && used.resource == of && used.part.overlaps(missing))
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
