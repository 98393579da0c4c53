//! Checks, after `usage`, that each format supports the final usage of its image. Usages that passes take were checked before
//! (`samples`); here it is about resolves, copies and draws that the compiler inserted, and about initial and final states.

use super::needs::Supports;
use crate::base::{Code, Diagnostic, Span};
use crate::compile::model::{AdaptedFrame, MemorySource, OpKind, PhysicalIndex, PhysicalResource};
use crate::compile::scope::{ScopedSteps, Step, resource_name};
use crate::device::{ImageDescriptor, Profile};
use crate::frame::{Frame, Resource};
use crate::plan::InsertionCause;
use crate::vulkan::{Format, Usage};

/// Refuses images whose formats can't be used as the Plan does on this device.
pub(crate) fn check_support(
    frame: &Frame,
    adapted: &AdaptedFrame,
    scoped: &ScopedSteps,
    supports: &Supports<'_>,
) -> Result<(), Vec<Diagnostic>> {
    let device = supports.device;
    let supported = |format: Format| supports.of(format).map_or(Usage::empty(), |support| support.usage);
    let mut errors = Vec::new();
    for (resource, at) in adapted.resources.iter().zip(0..) {
        let Some(image) = resource.image() else { continue };
        let missing = image.usage.difference(FOLLOWS).difference(supported(image.format));
        if !missing.is_empty() {
            errors.push(refusal(frame, adapted, device, at, (image, missing)));
        }
    }
    for op in scoped.steps.iter().filter_map(|step| if let Step::Single(op) = step { Some(*op) } else { None }) {
        if !matches!(adapted.ops[op as usize].kind, OpKind::Resolve { .. }) {
            continue;
        }
        // A resolve that is not folded needs a format that can be an attachment.
        let Some(target) = adapted.uses(op).iter().find(|used| used.role.is_target()) else { continue };
        let Some(image) = adapted.resources[target.resource as usize].image() else { continue };
        let missing = Usage::COLOR_ATTACHMENT.difference(supported(image.format));
        if !missing.is_empty() {
            errors.push(refusal(frame, adapted, device, target.resource, (image, missing)));
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// Usages that every format supports that can be an attachment.
const FOLLOWS: Usage = Usage::TRANSIENT_ATTACHMENT.union(Usage::INPUT_ATTACHMENT);

fn refusal(
    frame: &Frame,
    adapted: &AdaptedFrame,
    device: &Profile,
    at: PhysicalIndex,
    (image, missing): (&ImageDescriptor, Usage),
) -> Diagnostic {
    let resource = &adapted.resources[at as usize];
    let span = match resource.of {
        Resource::Image(image) => frame.images[image.0 as usize].span,
        Resource::Buffer(_) => Span::NONE,
    };
    let name = resource_name(frame, adapted, at);
    let mut declared = frame.passes.iter().flat_map(|pass| pass.uses.iter().map(move |it| (pass, it)));
    let declared =
        declared.find(|(_, it)| it.resource == resource.of && it.state.accesses.image_usage().intersects(missing));
    let missing = missing.iter_names().map(|(name, _)| name).collect::<Vec<_>>().join(", ");
    let message = format!("`{name}` can't be {} on `{}`: no {missing}", image.format, device.name);
    if let Some((pass, used)) = declared {
        let wrong = Diagnostic::new(Code::FORMAT_UNSUPPORTED, span, message);
        let wrong = wrong.label(used.span, format!("pass `{}` declares this use", pass.name));
        return wrong.help("choose another format, or leave the use out");
    }
    let help = format!("it takes that since {}; choose another format", why(adapted, resource, at));
    Diagnostic::new(Code::FORMAT_UNSUPPORTED, span, message).help(help)
}

/// Why a resource has its usages: an inserted operation that uses it, or where it comes from and goes.
fn why<'a>(adapted: &'a AdaptedFrame, resource: &'a PhysicalResource, at: PhysicalIndex) -> &'a str {
    let inserted = |number: u32| -> Option<&InsertionCause> {
        let why = adapted.ops[number as usize].kind.inserted()?;
        adapted.uses(number).iter().any(|used| used.resource == at).then_some(why)
    };
    let because = (0..adapted.ops.len() as u32).find_map(inserted).or(resource.inserted.as_deref());
    match (because, resource.memory) {
        (Some(reason), _) => &reason.because,
        (None, MemorySource::Transient) => "memory that is shared may be filled before it is used",
        (None, MemorySource::Output) => "outputs can be copied",
        (None, MemorySource::Persistent { .. } | MemorySource::Imported { .. }) => {
            "what outlives the frame can be copied and filled"
        }
    }
}
