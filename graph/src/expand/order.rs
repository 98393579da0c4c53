//! The order of passes: nothing is read before it is written, and whoever writes first covers or clears.

use crate::describe::{Diagnostic, Pass, Pipeline};
use crate::frame::{Blend, Draw, ImageIndex, Output, Resource};
use crate::source::Span;
use crate::vocabulary::CompareOp;

/// A pass as it runs in this frame.
pub(super) struct State<'a> {
    pub(super) pass: &'a Pass,
    /// Why it is off; `None` if it runs.
    pub(super) off: Option<String>,
    /// Whether its fragment shader discards fragments.
    pub(super) discards: bool,
}

impl State<'_> {
    /// Whether what it draws replaces every texel of a target that isn't blended.
    fn covers(&self) -> bool {
        let tested = self.pass.depth.as_ref().is_some_and(|depth| depth.test != CompareOp::Always);
        self.pass.draw == Draw::FullScreen && !self.discards && !tested
    }

    /// Images that it draws into, and where it names them.
    fn targets(&self) -> impl Iterator<Item = (ImageIndex, Span)> {
        let color = self.pass.color.iter().map(|color| color.image);
        color.chain(self.pass.depth.as_ref().map(|depth| depth.image)).map(|image| (image.index, image.span))
    }
}

/// A pass that has an image as its target.
#[derive(Clone, Copy)]
struct Writer<'a> {
    pass: &'a Pass,
    position: usize,
    span: Span,
    off: Option<&'a str>,
}

struct Check<'a> {
    pipeline: &'a Pipeline,
    /// The first pass that runs and draws into each image.
    first_on: Vec<Option<Writer<'a>>>,
    /// The first pass that is off, has no stand-in and would draw into each image.
    first_off: Vec<Option<Writer<'a>>>,
    /// Whether each image holds something by now. True after a mistake was reported: once is enough.
    written: Vec<bool>,
    errors: &'a mut Vec<Diagnostic>,
}

/// Walks through the passes in their order.
pub(super) fn check(pipeline: &Pipeline, states: &[State<'_>], outputs: &[Output], errors: &mut Vec<Diagnostic>) {
    let count = pipeline.images.len();
    let (mut first_on, mut first_off) = (vec![None; count], vec![None; count]);
    for (position, state) in states.iter().enumerate() {
        for (image, span) in state.targets() {
            if state.pass.otherwise.is_some_and(|forward| state.off.is_some() && forward.to.index == image) {
                continue;
            }
            let writer = Writer { pass: state.pass, position, span, off: state.off.as_deref() };
            let list = if state.off.is_some() { &mut first_off } else { &mut first_on };
            list[image.0 as usize].get_or_insert(writer);
        }
    }
    let mut check = Check { pipeline, first_on, first_off, written: vec![false; count], errors };
    for (position, state) in states.iter().enumerate() {
        if state.off.is_none() {
            check.runs(position, state);
        } else if let Some(forward) = state.pass.otherwise {
            let name = &state.pass.name.text;
            check.needs(position, forward.from.index, forward.from.span, &format!("the stand-in of pass `{name}`"));
            check.written[forward.to.index.0 as usize] = true;
        }
    }
    for output in outputs {
        let reader = if output.span == Span::NONE { "the dump" } else { "the frame" };
        if let Resource::Image(image) = output.resource {
            check.needs(states.len(), image, output.span, reader);
        }
    }
}

impl Check<'_> {
    fn runs(&mut self, position: usize, state: &State<'_>) {
        let pass = state.pass;
        let reader = format!("pass `{}`", pass.name.text);
        for sample in &pass.sample {
            self.needs(position, sample.image.index, sample.image.span, &reader);
        }
        for target in &pass.color {
            let whole = target.clear.is_some() || (state.covers() && target.blend.value == Blend::Replace);
            if !whole {
                let clear = "(image: \"…\", clear: (0.0, 0.0, 0.0, 1.0))";
                self.continues(position, state, target.image.index, target.image.span, clear);
            }
            self.written[target.image.index.0 as usize] = true;
        }
        if let Some(depth) = &pass.depth {
            let whole = depth.clear.is_some() || (state.covers() && depth.write);
            if !whole {
                self.continues(position, state, depth.image.index, depth.image.span, "(image: \"…\", clear: 0.0)");
            }
            self.written[depth.image.index.0 as usize] = true;
        }
    }

    /// Demands that an image holds something that `reader` can read at `span`.
    fn needs(&mut self, position: usize, image: ImageIndex, span: Span, reader: &str) {
        let at = image.0 as usize;
        if std::mem::replace(&mut self.written[at], true) {
            return;
        }
        let name = &self.pipeline.images[at].name.text;
        let diagnostic = if let Some((writer, because)) = self.off_before(image, position) {
            let off = &writer.pass.name.text;
            let message = format!("{reader} needs `{name}`, but pass `{off}`, which fills it, is off ({because})");
            Diagnostic::new(span, message)
                .remark("needed here")
                .label(writer.span, "filled here, if the pass runs")
                .help(format!("say what `{name}` takes instead: `otherwise: Forward(from: \"…\", to: \"{name}\")`"))
        } else if let Some(writer) = self.first_on[at] {
            let below = &writer.pass.name.text;
            let diagnostic =
                Diagnostic::new(span, format!("`{name}` is read before it is written")).remark("read here");
            if writer.position == position {
                let help = "a pass reads what stood in an image before the pass";
                diagnostic.label(writer.span, "first written here, by the same pass").help(help)
            } else {
                let help = format!("move pass `{below}` up: the order of passes gives them their meaning");
                diagnostic.label(writer.span, "first written here, further below").help(help)
            }
        } else {
            let declared = self.pipeline.images[at].name.span;
            let diagnostic = Diagnostic::new(span, format!("{reader} needs `{name}`, but no pass writes it"));
            diagnostic.remark("needed here").label(declared, "declared here")
        };
        self.errors.push(diagnostic);
    }

    /// Demands that an image holds something that a draw can be added to.
    fn continues(&mut self, position: usize, state: &State<'_>, image: ImageIndex, span: Span, clear: &str) {
        let at = image.0 as usize;
        if self.written[at] {
            return;
        }
        let (pass, name) = (&state.pass.name.text, &self.pipeline.images[at].name.text);
        let message = format!("pass `{pass}` is the first to draw into `{name}` and may leave texels untouched");
        let clear = clear.replace('…', name);
        let mut diagnostic = Diagnostic::new(span, message).help(format!("clear it: `{clear}`"));
        if let Some((writer, because)) = self.off_before(image, position) {
            let remark = format!("pass `{}` would come first, but is off ({because})", writer.pass.name.text);
            diagnostic = diagnostic.label(writer.span, remark);
        }
        self.errors.push(diagnostic);
    }

    /// The pass before `position` that would have filled `image` and is off, and why.
    fn off_before(&self, image: ImageIndex, position: usize) -> Option<(Writer<'_>, &str)> {
        let writer = self.first_off[image.0 as usize].filter(|writer| writer.position < position)?;
        Some((writer, writer.off?))
    }
}
