//! Several samples become one value: once for each version of an image, for all its readers.
//!
//! Colour is averaged, integers are sample zero. Depth has a ladder: whatever drew it is drawn again with one sample (see
//! `depth_only`), or it is resolved, by the scope that drew it where the device has the mode, else by a draw.

use super::{Adapter, access};
use crate::compile::model::{OpKind, StoreIndex, Use};
use crate::describe::Diagnostic;
use crate::device::Profile;
use crate::frame::{Face, ImageIndex, Resolve};
use crate::plan::names::vulkan;
use crate::source::Span;
use crate::vocabulary::{Aspects, ResolveMode, Subresources};

impl Adapter<'_> {
    /// The single-sample copy of an image's current version, for a pass that samples it.
    pub(super) fn resolved(
        &mut self,
        image: ImageIndex,
        face: Face,
        because: String,
        span: Span,
    ) -> Option<StoreIndex> {
        let declared = &self.input.frame.images[image.0 as usize];
        if !declared.format.is_depth() {
            return Some(self.average(image, because, span));
        }
        match declared.resolve.as_ref().filter(|_| face != Face::DepthOnly) {
            Some(Resolve { mode: Some(mode), because: asked }) => {
                self.resolved_depth(image, *mode, format!("{because}, {asked}"), span)
            }
            _ => self.redrawn(image, because, span),
        }
    }

    /// The same for what copies it, texel for texel, or carries it out of the frame: of depth without a word sample zero, since
    /// what is there is asked for, and not what would be drawn.
    pub(super) fn resolved_as_it_is(&mut self, image: ImageIndex, because: String, span: Span) -> Option<StoreIndex> {
        let declared = &self.input.frame.images[image.0 as usize];
        if !declared.format.is_depth() {
            return Some(self.average(image, because, span));
        }
        if declared.format.aspects().contains(Aspects::STENCIL) {
            self.refuse_stencil(image, &because, span);
            return None;
        }
        match &declared.resolve {
            None => self.resolved_depth(image, ResolveMode::SampleZero, because, span),
            Some(Resolve { mode: Some(mode), because: asked }) => {
                self.resolved_depth(image, *mode, format!("{because}, {asked}"), span)
            }
            Some(Resolve { mode: None, .. }) => self.redrawn(image, because, span),
        }
    }

    pub(super) fn refuse_stencil(&mut self, image: ImageIndex, because: &str, span: Span) {
        let name = &self.input.frame.images[image.0 as usize].name;
        let help =
            format!("sample it as `usampler2DMS`, choose a depth format without stencil, or give `{name}` 1 sample");
        self.errors.push(Diagnostic::new(span, format!("{because}; stencil can't be resolved")).help(help));
    }

    /// Colour averaged, integers sample zero.
    fn average(&mut self, image: ImageIndex, because: String, span: Span) -> StoreIndex {
        let integers = self.input.frame.images[image.0 as usize].format.is_integer();
        let mode = if integers { ResolveMode::SampleZero } else { ResolveMode::Average };
        let source = self.current(image);
        match self.resolved_of[source as usize] {
            Some(resolved) => resolved,
            None => self.resolve(image, mode, because, span),
        }
    }

    /// Depth resolved by the scope that drew it, or by a draw.
    fn resolved_depth(
        &mut self,
        image: ImageIndex,
        mode: ResolveMode,
        because: String,
        span: Span,
    ) -> Option<StoreIndex> {
        let source = self.current(image);
        if let Some(resolved) = self.resolved_of[source as usize] {
            return Some(resolved);
        }
        let declared = &self.input.frame.images[image.0 as usize];
        if declared.layers > 1 {
            let help = format!("give it 1 layer, or give `{}` 1 sample", declared.name);
            let message = format!("{because}; several layers can't be resolved at once");
            self.errors.push(Diagnostic::new(span, message).help(help));
            return None;
        }
        let by_draw = if declared.format.aspects().contains(Aspects::STENCIL) {
            "it has stencil beside the depth".to_owned()
        } else if !self.drawn[source as usize] {
            format!("no draw wrote `{}` last", declared.name)
        } else if !self.input.device.depth_resolve.contains(&mode) {
            lacks(self.input.device, mode)
        } else {
            return Some(self.resolve(image, mode, because, span));
        };
        let why = self.reason(format!("{because}; by a draw: {by_draw}"), span);
        let target = self.second(image, "resolved", why.clone(), 1);
        let depth = self.range(image, Subresources { aspects: Aspects::DEPTH, ..Subresources::WHOLE });
        let uses = access::resolve_draw(source, target, depth, declared.format);
        let store = &self.adapted.stores[target as usize];
        let name = store.renamed.clone().unwrap_or_else(|| declared.name.clone());
        let view = self.view_of_writer(source);
        self.push(OpKind::ResolveDraw { mode, name, view, why }, &uses);
        self.resolved_of[source as usize] = Some(target);
        Some(target)
    }

    /// Inserts a resolve that a scope may carry.
    fn resolve(&mut self, image: ImageIndex, mode: ResolveMode, because: String, span: Span) -> StoreIndex {
        let source = self.current(image);
        let why = self.reason(because, span);
        let target = self.second(image, "resolved", why.clone(), 1);
        self.push_transfer(OpKind::Resolve { mode, why }, source, target, Use::ALL);
        self.resolved_of[source as usize] = Some(target);
        target
    }
}

/// Why a device doesn't resolve depth so.
fn lacks(device: &Profile, mode: ResolveMode) -> String {
    if device.refuted_depth_resolve.contains(&mode) {
        let mode = vulkan(&mode);
        return format!("`{}` claims to resolve depth by {mode}, and a test showed that it doesn't", device.name);
    }
    let has: Vec<String> = device.depth_resolve.iter().map(vulkan).collect();
    let has = if has.is_empty() { "not at all".to_owned() } else { format!("by {} only", has.join(", ")) };
    format!("`{}` resolves depth {has}", device.name)
}
