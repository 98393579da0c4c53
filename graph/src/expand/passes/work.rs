//! The work of passes: draws, dispatches and their groups, copies, blits, fills; and whether it is possible.

use super::transfers::{self, FilePass};
use crate::base::{Code, Diagnostic};
use crate::expand::resources::{Resources, fills, parts};
use crate::expand::shader::coverage;
use crate::frame::{Draw, Groups, Pass, Work, check};
use crate::language::{self, Groups as Described, MOST_GROUPS};
use crate::ron::{Name, Spanned};
use crate::shader::ShaderInterface;
use crate::vulkan::{FillValue, Filter};

/// The work of the pass. After a mistake it is something like it.
pub(in crate::expand) fn lower(
    resources: &Resources<'_>,
    pass: &language::Pass,
    interface: Option<&ShaderInterface>,
) -> Work {
    let drawn = |draw, shader: &Name| Work::Draw {
        draw,
        shader: shader.text.clone(),
        // Samples that aren't covered keep their contents.
        discards: interface.is_some_and(coverage::leaves_out) || pass.alpha_to_coverage.is_some(),
        per_sample: coverage::per_sample(draw, interface),
    };
    match &pass.work {
        language::Work::Draw { draw, shader, .. } => drawn(*draw, shader),
        language::Work::Dispatch { shader, groups } => {
            Work::Dispatch { shader: shader.text.clone(), groups: self::groups(resources, &groups.value) }
        }
        language::Work::Copy { .. } => Work::Copy,
        language::Work::Blit { from, filter, .. } => {
            let format = match from {
                language::Part::Image(part) => resources.image(part.image.index).map(|image| image.image.format),
                language::Part::Buffer(_) => None,
            };
            let filtered = format.is_none_or(|format| !format.is_depth() && !format.is_integer());
            let default = if filtered { Filter::Linear } else { Filter::Nearest };
            Work::Blit { filter: filter.map_or(default, |filter| filter.value) }
        }
        language::Work::Fill { to, value } => {
            let value = fills::typed(value.value, resources.filled(to));
            Work::Fill { value: value.unwrap_or(FillValue::Bits([0; 4])) }
        }
        language::Work::Custom { callback, .. } if pass.is_drawn() => drawn(Draw::Custom, callback),
        language::Work::Custom { callback, .. } => Work::Custom { callback: callback.text.clone() },
    }
}

fn groups(resources: &Resources<'_>, groups: &Described) -> Groups {
    match groups {
        Described::Count(count) => Groups::Count(*count),
        Described::Invocations(count) => Groups::Invocations(*count),
        Described::Texels(part) => Groups::Invocations(texels(resources, part)),
        Described::Indirect { offset, .. } => Groups::Indirect { offset: *offset },
    }
}

/// Width, height, and depth or layers of a part of an image.
fn texels(resources: &Resources<'_>, part: &language::ImagePart) -> [u32; 3] {
    let Some(image) = resources.image(part.image.index).map(|image| &image.image) else { return [1; 3] };
    let part = image.part(parts::range(resources, part, &mut Vec::new()));
    let [width, height, depth] = image.extent_at(part.base_mip);
    [width, height, depth.saturating_mul(part.layers)]
}

/// Reports work that the pass can't do.
pub(in crate::expand) fn check(
    resources: &Resources<'_>,
    pass: &language::Pass,
    lowered: &Pass,
    interface: Option<&ShaderInterface>,
    errors: &mut Vec<Diagnostic>,
) {
    match &pass.work {
        language::Work::Draw { draw, .. } => counts_fit(resources, pass, *draw, errors),
        language::Work::Dispatch { groups, .. } => {
            dispatch_fits(resources, pass, groups, lowered, interface, errors);
        }
        language::Work::Copy { .. } | language::Work::Blit { .. } => {
            check::transfers::check(&FilePass { resources, pass }, lowered, errors);
        }
        language::Work::Fill { to, value } => transfers::fill(resources, to, *value, errors),
        language::Work::Custom { .. } => check::uses::check(&FilePass { resources, pass }, lowered, errors),
    }
}

/// Indices and counts lie within their buffers.
fn counts_fit(resources: &Resources<'_>, pass: &language::Pass, draw: Draw, errors: &mut Vec<Diagnostic>) {
    let indexed = pass.index.is_some();
    if let (Some(draws), Some(part)) = (draw.indirect(), pass.work.counts()) {
        if let Some(fault) = draws.fault(indexed) {
            errors.push(Diagnostic::new(Code::INDIRECT_UNFIT, part.buffer.span, fault));
        }
        let command = if indexed { "VkDrawIndexedIndirectCommand" } else { "VkDrawIndirectCommand" };
        let what = match draws.draws {
            1 => format!("the counts of a draw ({command})"),
            many => format!("the counts of {many} draws ({command})"),
        };
        resources.holds(&part.buffer, draws.end(indexed), &what, part.buffer.span, errors);
    }
    if let (Some(at), Some(part)) = (draw.indirect().and_then(|draws| draws.count), pass.work.count()) {
        let what = format!("the number of draws at byte {at}");
        resources.holds(&part.buffer, at.saturating_add(4), &what, part.buffer.span, errors);
    }
    if let (Some(part), Some([count, _])) = (&pass.index, draw.counts()) {
        let what = format!("{count} indices of 4 bytes");
        resources.holds(&part.buffer, u64::from(count) * 4, &what, part.buffer.span, errors);
    }
}

fn dispatch_fits(
    resources: &Resources<'_>,
    pass: &language::Pass,
    groups: &Spanned<Described>,
    lowered: &Pass,
    interface: Option<&ShaderInterface>,
    errors: &mut Vec<Diagnostic>,
) {
    match &groups.value {
        Described::Indirect { buffer, offset } => {
            if !offset.is_multiple_of(4) {
                let message = format!("counts of a dispatch stand at a multiple of 4 bytes, not at {offset}");
                errors.push(Diagnostic::new(Code::GROUPS, groups.span, message));
            }
            // VkDispatchIndirectCommand.
            let what = format!("the counts of a dispatch at byte {offset}, up to their end,");
            resources.holds(&buffer.buffer, offset.saturating_add(12), &what, buffer.buffer.span, errors);
        }
        Described::Texels(part) => {
            parts::range(resources, part, errors);
            if let Some(previous) = part.previous {
                errors.push(Diagnostic::new(
                    Code::EARLIER_FRAME,
                    previous.span,
                    "an image has one size in all frames: leave `previous` out",
                ));
            }
        }
        Described::Count(_) | Described::Invocations(_) => {}
    }
    let (Some(Groups::Invocations(wanted)), Some(interface)) = (lowered.work.groups(), interface) else {
        return;
    };
    let size = interface.workgroup_size.unwrap_or([1; 3]);
    for ((axis, wanted), size) in ["x", "y", "z"].into_iter().zip(wanted).zip(size) {
        let count = wanted.div_ceil(size.max(1));
        if i64::from(count) > MOST_GROUPS {
            let message = format!(
                "pass `{}` runs {wanted} invocations in {axis}: {count} workgroups of {size}; {MOST_GROUPS} are allowed",
                pass.name.text
            );
            let help = "give the shader larger workgroups, or each invocation more to do";
            errors.push(Diagnostic::new(Code::GROUPS, groups.span, message).help(help));
        }
    }
}
