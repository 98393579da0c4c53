//! Plans that do something else than their pipelines say, in ways that the checker can't see: the judge must.

use framewright_graph::frame::Blend;
use framewright_graph::plan::{FirstContents, Pass, Plan, RenderScope, Role, Work};
use framewright_graph::vulkan::{CompareOp, FillValue, LoadOp, StencilOp};

/// The part of a Plan that is spoiled, in the first place where it can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spoil {
    /// The value of a fill.
    Fill,
    /// The value that a scope clears a colour attachment to.
    Clear,
    /// A load of a colour attachment, which becomes a clear.
    Load,
    /// The value that images are filled with before the first frame.
    Initial,
    /// A blend, which becomes a replacement.
    Blend,
    /// A depth test, which lets all pass.
    Depth,
    /// The stencil operation of a pass, which is left out.
    Stencil,
    /// The first pass of a scope of several, which is left out.
    Pass,
}

impl Spoil {
    /// Spoils a Plan; false if there is no such thing in it.
    pub fn spoil(self, plan: &mut Plan) -> bool {
        if self == Spoil::Initial {
            // All of them: those that become each other start alike.
            for image in &mut plan.images {
                if let Role::Persistent { initial: FirstContents::Value(initial), .. } = &mut image.role {
                    *initial = another(*initial);
                }
            }
            return true;
        }
        let Plan { steps, totals, .. } = plan;
        steps.iter_mut().any(|step| match &mut step.work {
            Work::Fill(fill) if self == Spoil::Fill => {
                fill.value = another(fill.value);
                true
            }
            Work::Render(scope) if self == Spoil::Pass && scope.passes.len() > 1 => {
                scope.passes.remove(0);
                totals.passes -= 1;
                true
            }
            Work::Render(scope) => self.scope(scope),
            Work::Dispatch(pass) => self.pass(pass),
            _ => false,
        })
    }

    fn scope(self, scope: &mut RenderScope) -> bool {
        let attachment = scope.attachments.iter_mut().any(|attachment| match (self, attachment.load) {
            (Spoil::Clear, LoadOp::Clear) => {
                attachment.clear = attachment.clear.map(|clear| clear.map(|value| f64::from(value == 0.0)));
                true
            }
            (Spoil::Load, LoadOp::Load) => {
                (attachment.load, attachment.clear) = (LoadOp::Clear, Some([0.0; 4]));
                true
            }
            _ => false,
        });
        attachment || scope.passes.iter_mut().any(|pass| self.pass(pass))
    }

    fn pass(self, pass: &mut Pass) -> bool {
        match self {
            Spoil::Blend => {
                let blend = pass.blend.iter_mut().find(|blend| **blend == Blend::Additive);
                blend.map(|blend| *blend = Blend::Replace).is_some()
            }
            Spoil::Depth => {
                let depth = pass.depth.as_mut().filter(|depth| depth.test != CompareOp::Always);
                depth.map(|depth| depth.test = CompareOp::Always).is_some()
            }
            Spoil::Stencil => {
                let stencil = pass.stencil.as_mut().filter(|stencil| stencil.pass != StencilOp::Keep);
                stencil.map(|stencil| stencil.pass = StencilOp::Keep).is_some()
            }
            Spoil::Fill | Spoil::Clear | Spoil::Load | Spoil::Initial | Spoil::Pass => false,
        }
    }
}

/// Another value of the same kind.
fn another(value: FillValue) -> FillValue {
    match value {
        FillValue::Bits(bits) => FillValue::Bits(bits.map(|word| word ^ 1)),
        FillValue::Color(color) => FillValue::Color(color.map(|component| 1.0 - component)),
        FillValue::Depth(depth, stencil) => FillValue::Depth(1.0 - depth, stencil ^ 1),
    }
}
