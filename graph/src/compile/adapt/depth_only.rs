//! Depth-only passes: the draws of a version of multisampled depth are drawn again with one sample, and without colour, onto a fill
//! with the same value if they were drawn onto one. They neither read nor write the multisampled depth.

use super::access;
use super::adapter::Adapter;
use crate::base::{Code, Diagnostic, Span};
use crate::compile::model::{InitialContents, InsertedDraw, OpKind, PhysicalIndex, Use};
use crate::frame::{ImageIndex, ViewIndex};
use crate::plan::{AttachmentKind, InsertionCause};
use crate::vulkan::{Aspects, Stages, Subresources};
use std::sync::Arc;

/// A pass that made depth what it is, and can do so again.
enum DepthWork {
    /// It is drawn, onto these contents.
    Drawn(u32, InitialContents),
    /// It fills.
    Filled(u32),
}

/// Why depth can't be drawn again.
struct DepthHindrance {
    /// In words: "`terrain` is recorded by the program".
    what: String,
    /// The pass that is why.
    at: Span,
}

impl Adapter<'_> {
    /// Notes the operations that wrote the current version of multisampled depth.
    pub(super) fn note_depth_writer(&mut self, used: &Use, draws: bool) {
        if self.samples(used.resource) == 1 || !self.adapted.range(used).aspects.contains(Aspects::DEPTH) {
            return;
        }
        let op = self.adapted.ops.len() as u32;
        let writers = self.depth_writers.entry(used.resource).or_default();
        // A clear or a draw that covers replaces earlier draws. Other operations replace them too, or can't be drawn again.
        if used.contents != InitialContents::Keep || !draws {
            writers.clear();
        }
        writers.push(op);
    }

    /// The view that the last writer of multisampled depth draws for.
    pub(super) fn view_of_writer(&self, resource: PhysicalIndex) -> ViewIndex {
        let last = self.depth_writers.get(&resource).and_then(|writers| writers.last());
        let pass = last.and_then(|op| self.adapted.ops[*op as usize].kind.pass());
        pass.map_or(ViewIndex::default(), |pass| self.input.frame.passes[pass as usize].view)
    }

    /// The single-sample depth that drawing the current version of `image` again leaves.
    pub(super) fn redrawn(&mut self, image: ImageIndex, because: String, span: Span) -> Option<PhysicalIndex> {
        let source = self.current(image);
        if let Some(redrawn) = self.versions[source as usize].redrawn {
            return Some(redrawn);
        }
        let declared = &self.input.frame.images[image.0 as usize];
        let passes = match self.redrawable(source, declared.layers) {
            Ok(passes) => passes,
            Err(DepthHindrance { what, at }) => {
                let name = &declared.name;
                let message = format!("{because}, and its depth can't be drawn again with 1: {what}");
                // Several layers can't be resolved either.
                let one = self.one_sample(image);
                let help = match declared.layers {
                    1 => format!(
                        "say `resolve: SampleZero`, `resolve: Min`, `resolve: Max` or `resolve: Average` of `{name}`, sample \
                         it as `sampler2DMS`, or {one}"
                    ),
                    _ => format!(
                        "sample a layer of `{name}` as `sampler2DMS`, give each layer an image of its own, or {one}"
                    ),
                };
                self.errors
                    .push(Diagnostic::new(Code::RESOLVE_IMPOSSIBLE, span, message).label(at, "drawn here").help(help));
                return None;
            }
        };
        let why = self.reason(format!("{because}; what drew it is drawn again with 1"), span);
        let target = self.second(image, "depth only", why.clone(), 1);
        let range = self.range(image, Subresources { aspects: Aspects::DEPTH, ..Subresources::WHOLE });
        for again in passes {
            match again {
                DepthWork::Drawn(pass, contents) => {
                    let uses = [access::depth(Aspects::DEPTH, target, range, contents, true, declared.format)];
                    let draw = InsertedDraw { name: self.depth_only_name(pass), why: InsertionCause::clone(&why) };
                    self.push(OpKind::DepthOnly { pass, draw: Box::new(draw) }, &uses);
                }
                DepthWork::Filled(pass) => {
                    let uses = [access::target(target, range, Stages::CLEAR)];
                    self.push(OpKind::FillAgain { pass, why: why.clone() }, &uses);
                }
            }
        }
        self.versions[source as usize].redrawn = Some(target);
        Some(target)
    }

    /// The name of a pass that is drawn again: the pass's own with a word, and a number if it is drawn more than once.
    fn depth_only_name(&mut self, pass: u32) -> Arc<str> {
        let times = self.redrawn_times.entry(pass).or_insert(0);
        *times += 1;
        let name = &self.input.frame.passes[pass as usize].name;
        match times {
            1 => format!("{name} (depth only)"),
            times => format!("{name} (depth only {times})"),
        }
        .into()
    }

    /// The passes that made all of the current version.
    fn redrawable(&self, resource: PhysicalIndex, layers: u32) -> Result<Vec<DepthWork>, DepthHindrance> {
        let Adapter { adapted, input, .. } = self;
        let writers = self.depth_writers.get(&resource).map_or(&[][..], Vec::as_slice);
        let mut passes = Vec::with_capacity(writers.len());
        for op in writers {
            let (kind, uses) = (&adapted.ops[*op as usize].kind, adapted.uses(*op));
            let pass = kind.pass().map(|pass| (pass, &input.frame.passes[pass as usize]));
            let unavailable = |what: &str| {
                let name = pass.map_or("a copy", |(_, pass)| &pass.name);
                let at = pass.map_or(Span::NONE, |(_, pass)| pass.span);
                DepthHindrance { what: format!("`{name}` {what}"), at }
            };
            if let (OpKind::Pass(number), Some(_)) = (kind, pass.and_then(|(_, pass)| pass.work.filled())) {
                passes.push(DepthWork::Filled(*number));
                continue;
            }
            let (OpKind::Draw(number), Some((_, pass))) = (kind, pass) else {
                return Err(unavailable("writes it and is no draw"));
            };
            let Some((draw, _)) = pass.work.draw() else { return Err(unavailable("is no draw")) };
            if draw.is_custom() {
                return Err(unavailable("is recorded by the program"));
            }
            if draw.is_indirect() || !pass.buffers.is_empty() {
                return Err(unavailable("draws from buffers, which may have changed since"));
            }
            if uses.iter().any(|used| used.role.attachment() == Some(AttachmentKind::Stencil)) {
                return Err(unavailable("tests stencil as well"));
            }
            if let Some(why) = &pass.no_depth_only {
                return Err(unavailable(why));
            }
            let drawn = uses.iter().find(|used| used.role.attachment() == Some(AttachmentKind::Depth));
            let contents = drawn.map_or(InitialContents::Keep, |used| used.contents);
            if passes.is_empty() && contents == InitialContents::Keep {
                return Err(unavailable("draws onto what was there before the frame"));
            }
            passes.push(DepthWork::Drawn(*number, contents));
        }
        match (passes.is_empty(), layers) {
            (true, _) => Err(DepthHindrance { what: "nothing in the frame draws it".to_owned(), at: Span::NONE }),
            (false, 1) => Ok(passes),
            (false, _) => Err(DepthHindrance { what: "it has several layers".to_owned(), at: Span::NONE }),
        }
    }
}
