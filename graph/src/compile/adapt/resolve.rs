//! Resolves: once for each version of an image, for all its readers.
//!
//! Colour is averaged, or weighted by a draw; of integers sample zero is taken, by a draw where the device takes another. Depth is drawn again with one sample
//! (`depth_only`), or it is resolved: by the scope that drew it where the device has the mode, else by a draw.

use super::access;
use super::adapter::Adapter;
use crate::base::{Code, Diagnostic, Span};
use crate::compile::fit::drawn_together;
use crate::compile::model::{InsertedDraw, OpKind, PhysicalIndex, ResolveShader, Use};
use crate::device::Profile;
use crate::frame::tracked_parts::join;
use crate::frame::{Access, EyeForm, Face, Frame, ImageIndex, Resolve, ResolveWay, Resource};
use crate::plan::InsertionCause;
use crate::vulkan::{Aspects, Numeric, ResolveMode, Subresources, name_of};

impl Adapter<'_> {
    /// The single-sample copy of an image's current version, for a pass that samples it.
    pub(super) fn resolved(
        &mut self,
        image: ImageIndex,
        face: Face,
        because: String,
        span: Span,
    ) -> Option<PhysicalIndex> {
        let declared = &self.input.frame.images[image.0 as usize];
        if !declared.format.is_depth() {
            return self.color(image, because, span);
        }
        match declared.resolve.as_ref().filter(|_| face != Face::DepthOnly) {
            Some(Resolve { way: ResolveWay::By(mode), because: asked }) => {
                self.resolved_depth(image, *mode, format!("{because}, {asked}"), span)
            }
            _ => self.redrawn(image, because, span),
        }
    }

    /// The same for a copy, texel for texel, and for an output. Depth without a `resolve` is resolved to sample zero: the
    /// copy takes the contents, not what drawing them again would give. `planes` are those that are read.
    pub(super) fn resolved_as_it_is(
        &mut self,
        (image, planes): (ImageIndex, Aspects),
        because: String,
        span: Span,
    ) -> Option<PhysicalIndex> {
        let declared = &self.input.frame.images[image.0 as usize];
        if !declared.format.is_depth() {
            return self.color(image, because, span);
        }
        if planes.contains(Aspects::STENCIL) {
            self.refuse_stencil(image, &because, span);
            return None;
        }
        match &declared.resolve {
            None => self.resolved_depth(image, ResolveMode::SampleZero, because, span),
            Some(Resolve { way: ResolveWay::By(mode), because: asked }) => {
                self.resolved_depth(image, *mode, format!("{because}, {asked}"), span)
            }
            Some(Resolve { way: ResolveWay::DepthOnly | ResolveWay::Weighted, .. }) => {
                self.redrawn(image, because, span)
            }
        }
    }

    pub(super) fn refuse_stencil(&mut self, image: ImageIndex, because: &str, span: Span) {
        let help = format!(
            "sample it as `usampler2DMS`, choose a depth format without stencil, or {}",
            self.one_sample(image)
        );
        self.errors.push(
            Diagnostic::new(Code::RESOLVE_IMPOSSIBLE, span, format!("{because}; stencil can't be resolved")).help(help),
        );
    }

    /// Help for an image that must have one sample: it has as many as what is drawn together with it.
    pub(super) fn one_sample(&self, image: ImageIndex) -> String {
        let Frame { images, passes, .. } = self.input.frame;
        let together = drawn_together(passes, image);
        let names: Vec<String> = together.iter().map(|it| format!("`{}`", images[it.0 as usize].name)).collect();
        format!("say `samples: 1` of {}", names.join(" and "))
    }

    /// Colour averaged or weighted, integers sample zero.
    fn color(&mut self, image: ImageIndex, because: String, span: Span) -> Option<PhysicalIndex> {
        let source = self.current(image);
        let declared = &self.input.frame.images[image.0 as usize];
        let usual = if declared.format.is_integer() { ResolveMode::SampleZero } else { ResolveMode::Average };
        let way = declared.resolve.as_ref().map_or(ResolveWay::By(usual), |resolve| resolve.way);
        if let Some(resolved) = self.resolved_so(source, way) {
            return Some(resolved);
        }
        match &declared.resolve {
            Some(Resolve { way: ResolveWay::Weighted, because: asked }) => {
                self.color_by_draw(image, ResolveShader::Weighted, format!("{because}, {asked}"), span)
            }
            _ if declared.format.is_integer() && self.input.device.refuted_integer_resolve => {
                let by =
                    if declared.format.numeric() == Numeric::Sint { ResolveShader::Sint } else { ResolveShader::Uint };
                let device = &self.input.device.name;
                let because =
                    format!("{because}; by a draw: a test showed that `{device}` resolves integers to another sample");
                self.color_by_draw(image, by, because, span)
            }
            _ => Some(self.resolve(image, usual, because, span)),
        }
    }

    /// Colour resolved by a draw.
    fn color_by_draw(
        &mut self,
        image: ImageIndex,
        by: ResolveShader,
        because: String,
        span: Span,
    ) -> Option<PhysicalIndex> {
        let source = self.current(image);
        if self.refuses_layers(image, &because, span) {
            return None;
        }
        let why = self.reason(because, span);
        let target = self.second(image, "resolved", why.clone(), 1);
        Some(self.resolve_by_draw(by, *why, access::forward_draw(source, target)))
    }

    /// Whether an image has several layers, which no draw resolves. Reports that.
    fn refuses_layers(&mut self, image: ImageIndex, because: &str, span: Span) -> bool {
        let declared = &self.input.frame.images[image.0 as usize];
        if declared.layers > 1 {
            let help =
                format!("give each layer of `{}` an image of its own, or {}", declared.name, self.one_sample(image));
            let message = format!("{because}; an image of several layers can't be resolved, whichever of them is read");
            self.errors.push(Diagnostic::new(Code::RESOLVE_IMPOSSIBLE, span, message).help(help));
        }
        declared.layers > 1
    }

    /// Inserts a full-screen draw from one image into another.
    fn resolve_by_draw(&mut self, by: ResolveShader, why: InsertionCause, uses: [Use; 2]) -> PhysicalIndex {
        let [source, target] = [uses[0].resource, uses[1].resource];
        let resource = &self.adapted.resources[target as usize];
        // Inserted images have names of their own.
        let name = resource.renamed.clone().unwrap_or_default();
        let view = self.view_of_writer(source);
        let way = match by {
            ResolveShader::Depth(mode) => ResolveWay::By(mode),
            ResolveShader::Weighted => ResolveWay::Weighted,
            ResolveShader::Uint | ResolveShader::Sint => ResolveWay::By(ResolveMode::SampleZero),
        };
        let draw = Box::new(InsertedDraw { name, why });
        self.push(OpKind::ResolveDraw { by, view, draw }, &uses);
        self.versions[source as usize].resolved = Some((way, target));
        target
    }

    /// Depth resolved by the scope that drew it, or by a draw.
    fn resolved_depth(
        &mut self,
        image: ImageIndex,
        mode: ResolveMode,
        because: String,
        span: Span,
    ) -> Option<PhysicalIndex> {
        let source = self.current(image);
        if let Some(resolved) = self.resolved_so(source, ResolveWay::By(mode)) {
            return Some(resolved);
        }
        if self.refuses_layers(image, &because, span) {
            return None;
        }
        let declared = &self.input.frame.images[image.0 as usize];
        let by_draw = if declared.format.aspects().contains(Aspects::STENCIL) {
            "it has stencil beside the depth".to_owned()
        } else if !self.versions[source as usize].drawn {
            format!("no draw wrote `{}` last", declared.name)
        } else if let Some(lacks) = lacks(self.input.device, mode, declared.eyes == Some(EyeForm::Layers)) {
            lacks
        } else {
            return Some(self.resolve(image, mode, because, span));
        };
        let why = self.reason(format!("{because}; by a draw: {by_draw}"), span);
        let target = self.second(image, "resolved", why.clone(), 1);
        let depth = self.range(image, Subresources { aspects: Aspects::DEPTH, ..Subresources::WHOLE });
        let uses = access::resolve_draw(source, target, depth, declared.format);
        Some(self.resolve_by_draw(ResolveShader::Depth(mode), *why, uses))
    }

    /// Inserts a resolve that may be folded into a scope.
    fn resolve(&mut self, image: ImageIndex, mode: ResolveMode, because: String, span: Span) -> PhysicalIndex {
        let source = self.current(image);
        let why = self.reason(because, span);
        let target = self.second(image, "resolved", why.clone(), 1);
        for part in self.written_and_read(image, source) {
            let range = self.range(image, part);
            self.push_transfer(OpKind::Resolve { mode, why: why.clone() }, source, target, range);
        }
        self.versions[source as usize].resolved = Some((ResolveWay::By(mode), target));
        target
    }

    /// The parts of an image that are worth resolving: written so far, and read by some pass of the frame. All of an image
    /// that isn't cut.
    fn written_and_read(&self, image: ImageIndex, source: PhysicalIndex) -> Vec<Subresources> {
        let Adapter { adapted, input, .. } = self;
        let resource = &adapted.resources[source as usize];
        let Some(grid) = &resource.grid else { return vec![Subresources::WHOLE] };
        let declared = &input.frame.images[image.0 as usize];
        let mut written = vec![declared.lifetime.outlives_frame(); grid.len() as usize];
        let so_far = &adapted.uses[..self.first_use];
        for used in so_far.iter().filter(|used| used.writes && used.resource == source) {
            grid.cover(adapted.range(used)).for_each(|part| written[part as usize] = true);
        }
        let mut read = vec![false; grid.len() as usize];
        let mut reads = |range| {
            grid.cover(declared.part(range)).for_each(|part| read[part as usize] = true);
        };
        if input.frame.outputs.iter().any(|output| output.resource == Resource::Image(image)) {
            reads(Subresources::WHOLE);
        }
        for pass in &input.frame.passes {
            for access in pass.accesses().filter(|access| access.image_index() == Some(image)) {
                match access {
                    Access::Sampled(used) if used.frames_ago == 0 => reads(declared.sampled_part(used.range)),
                    Access::Transfer(used) if !used.write && used.frames_ago == 0 => reads(used.range),
                    // Another image may take its contents or give it its own, whose readers aren't those of this one.
                    Access::ForwardSource(..) | Access::ForwardTarget(..) => reads(access.range()),
                    _ => {}
                }
            }
        }
        let mut ranges: Vec<Subresources> = Vec::new();
        for part in (0..grid.len()).filter(|part| written[*part as usize] && read[*part as usize]) {
            let range = grid.range(part);
            match ranges.last_mut().and_then(|last| Some((join(*last, range)?, last))) {
                Some((joined, last)) => *last = joined,
                None => ranges.push(range),
            }
        }
        ranges
    }

    /// The resolved copy of an image in a certain way, if there is one: images that are forwarded to each other may ask for
    /// different ways.
    fn resolved_so(&self, source: PhysicalIndex, way: ResolveWay) -> Option<PhysicalIndex> {
        self.versions[source as usize].resolved.filter(|(known, _)| *known == way).map(|(_, resolved)| resolved)
    }
}

/// Why a device doesn't resolve depth so, if it doesn't: of one layer, or of several at once.
fn lacks(device: &Profile, mode: ResolveMode, layered: bool) -> Option<String> {
    let claims = |of: &str, tested: &str| {
        let mode = name_of(&mode);
        Some(format!("`{}` claims to resolve depth{of} by {mode}, and {tested}", device.name))
    };
    let refuted = "a test showed that it doesn't";
    if device.refuted_depth_resolve.contains(&mode) {
        return claims("", refuted);
    }
    if layered && device.refuted_layered_depth_resolve.contains(&mode) {
        return claims(" of several layers", refuted);
    }
    if device.untested_depth_resolve.contains(&mode) {
        return claims("", "that couldn't be tested");
    }
    if device.depth_resolve.contains(&mode) {
        return None;
    }
    let has: Vec<String> = device.depth_resolve.iter().map(name_of).collect();
    let has = if has.is_empty() { "not at all".to_owned() } else { format!("by {} only", has.join(", ")) };
    Some(format!("`{}` resolves depth {has}", device.name))
}
