//! Passes of the frame: what each does with which parts, and what its shader is given.

use super::shader::{self, Checked};
use super::things::Things;
use super::{
    Chosen, fills, halves, local, params, parts, rotation, sampled, storage, supplied, targets, transfers, variant,
    work,
};
use crate::base::Diagnostic;
use crate::frame::{Access, BufferRole, BufferUse, ColorTarget, DepthTarget, Pass, Resource, TransferUse, Work};
use crate::language::{self, StandIn, Work as Described};
use crate::shader::ShaderInterface;
use crate::vulkan::{FillValue, Stages, Subresources};

/// The pass as it runs, checked against its shader. Of a shader that can't be had nothing is known: mistakes were
/// reported then, and what it would write counts as written.
pub(super) fn lower(
    chosen: &Chosen<'_>,
    things: &Things,
    pass: &language::Pass,
    shaders: &mut Checked<'_>,
    errors: &mut Vec<Diagnostic>,
) -> Pass {
    let variant = variant::of(chosen, things, pass);
    let interface = shaders.interface(pass, &variant, errors);
    let mut lowered = draft(chosen, things, pass, interface.as_ref(), errors);
    if let Work::Draw { shader, .. } | Work::Dispatch { shader, .. } = &mut lowered.work
        && let Some(found) = shaders.find(pass, &mut Vec::new())
    {
        *shader = found;
    }
    work::check(chosen, things, pass, &lowered, interface.as_ref(), errors);
    if let Some(interface) = &interface {
        lowered.no_rotation = rotation::hindrance(&lowered.work, interface);
        supplied::check(shaders, pass, interface, errors);
        let before = errors.len();
        let mut misspelt = sampled::check(chosen, things, pass, &lowered, interface, errors);
        if errors.len() == before {
            variant::check_single_sampled(pass, &lowered, &variant, shaders, errors);
            local::check(things, pass, &lowered, (interface, &variant), shaders, errors);
        }
        misspelt.extend(storage::check(chosen, things, pass, &lowered, interface, errors));
        shader::missing(pass, interface, &misspelt, errors);
        let whole = (!pass.left_out.is_empty()).then(|| variant::with_all(chosen, things, pass)).flatten();
        let whole = whole.and_then(|whole| shaders.interface(pass, &whole, errors));
        sampled::check_left_out(pass, whole.as_ref(), errors);
        lowered.params = params::give(pass, interface, whole.as_ref(), errors);
        targets::fed(things, pass, interface, errors);
        halves::check(chosen, things, pass, interface, errors);
    } else if let Described::Custom { .. } = pass.work {
        lowered.params = params::as_written(pass);
    }
    lowered
}

/// The pass without what its shader's parameters are. Stages, and what is done with storage, are the shader's.
pub(super) fn draft(
    chosen: &Chosen<'_>,
    things: &Things,
    pass: &language::Pass,
    interface: Option<&ShaderInterface>,
    errors: &mut Vec<Diagnostic>,
) -> Pass {
    let raster = !pass.color.is_empty() || pass.depth.is_some();
    let mut lowered = Pass::new(&pass.name.text, work::lower(chosen, things, pass, interface));
    lowered.span = pass.name.span;
    lowered.view = pass.view;
    lowered.side_effect = pass.side_effect;
    lowered.alpha_to_coverage = pass.alpha_to_coverage.is_some();
    for sample in &pass.sample {
        let range = parts::range(chosen, things, &sample.part, errors);
        lowered.sampled.extend(sampled::lower(things, sample, range, interface, raster));
    }
    for part in &pass.storage {
        storage::lower(chosen, things, part, interface, raster, &mut lowered, errors);
    }
    for target in &pass.color {
        lowered.color.push(ColorTarget {
            image: target.part.image.index,
            range: parts::range(chosen, things, &target.part, errors),
            span: target.part.image.span,
            clear: target.clear,
            blend: target.blend.value,
        });
    }
    lowered.depth = pass.depth.as_ref().map(|target| DepthTarget {
        image: target.part.image.index,
        range: parts::range(chosen, things, &target.part, errors),
        span: target.part.image.span,
        clear: target.clear,
        test: target.test,
        write: target.write,
        stencil: target.stencil.map(|stencil| stencil.value),
    });
    buffers(pass, interface, raster, &mut lowered);
    transferred(chosen, things, pass, &mut lowered, errors);
    lowered
}

/// Buffers that are read as uniform blocks, vertices, indices and counts.
fn buffers(pass: &language::Pass, interface: Option<&ShaderInterface>, raster: bool, lowered: &mut Pass) {
    for uniform in &pass.uniform {
        let stages = storage::stages(interface, &uniform.binding.text, raster);
        let binding = Some(uniform.binding.text.clone());
        lowered.buffers.push(used(&uniform.part, binding, BufferRole::Uniform, stages));
    }
    let indirect = match &pass.work {
        Described::Draw { draw: language::Draw::Indirect(buffer), .. } => Some(buffer),
        Described::Dispatch { groups, .. } => match &groups.value {
            language::Groups::Indirect { buffer, .. } => Some(buffer),
            _ => None,
        },
        _ => None,
    };
    let roles = [
        (pass.vertex.as_ref(), BufferRole::Vertex),
        (pass.index.as_ref(), BufferRole::Index),
        (indirect, BufferRole::Indirect),
    ];
    for (part, role) in roles {
        lowered.buffers.extend(part.map(|part| used(part, None, role, Stages::empty())));
    }
}

/// One use of a buffer.
pub(super) fn used(
    part: &language::BufferPart,
    binding: Option<std::sync::Arc<str>>,
    role: BufferRole,
    stages: Stages,
) -> BufferUse {
    BufferUse {
        binding,
        buffer: part.buffer.index,
        frames_ago: part.previous.map_or(0, |previous| previous.value),
        span: part.buffer.span,
        role,
        stages,
    }
}

fn transferred(
    chosen: &Chosen<'_>,
    things: &Things,
    pass: &language::Pass,
    lowered: &mut Pass,
    errors: &mut Vec<Diagnostic>,
) {
    let (reads, writes) = match &pass.work {
        Described::Copy { from, to } | Described::Blit { from, to, .. } => {
            (std::slice::from_ref(from), std::slice::from_ref(to))
        }
        Described::Fill { to, .. } => (&[][..], std::slice::from_ref(to)),
        Described::Custom { reads, writes, .. } => (&reads[..], &writes[..]),
        Described::Draw { .. } | Described::Dispatch { .. } => return,
    };
    let parts = reads.iter().map(|part| (part, false)).chain(writes.iter().map(|part| (part, true)));
    for (part, write) in parts {
        let language::ResourceRef { resource, span } = part.resource();
        let range = match part {
            language::Part::Image(part) => parts::range(chosen, things, part, errors),
            language::Part::Buffer(_) => Subresources::WHOLE,
        };
        let frames_ago = part.previous().map_or(0, |previous| previous.value);
        lowered.transfers.push(TransferUse { resource, range, frames_ago, span, write });
    }
}

/// What runs in place of a pass that is off, if its targets must be filled all the same. The first has the name of the
/// pass, others a number beside it.
pub(super) fn stand_ins(
    things: &Things,
    pass: &language::Pass,
    because: &str,
    errors: &mut Vec<Diagnostic>,
) -> Vec<Pass> {
    let stand_in = |(number, stand_in): (usize, &StandIn)| {
        let (work, transfer) = match *stand_in {
            StandIn::Forward(language::Forward { from, to }) => {
                (Work::Forward { from: from.index, to: to.index, because: because.to_owned() }, None)
            }
            StandIn::Clear { to, value } => {
                let part = language::Part::Image(language::ImagePart::whole(to));
                transfers::fill(things, &part, value, errors);
                let format = things.image(to.index).map(|image| image.image.format);
                let filled = fills::typed(value.value, format).unwrap_or(FillValue::Bits([0; 4]));
                let (resource, range) = (Resource::Image(to.index), Subresources::WHOLE);
                let transfer = TransferUse { resource, range, frames_ago: 0, span: to.span, write: true };
                (Work::Fill { value: filled }, Some(transfer))
            }
        };
        let name = &pass.name.text;
        let name = if number == 0 { name.to_string() } else { format!("{name} (otherwise {})", number + 1) };
        let (span, view) = (pass.name.span, pass.view);
        Pass { span, view, transfers: transfer.into_iter().collect(), ..Pass::new(&name, work) }
    };
    pass.otherwise.iter().enumerate().map(stand_in).collect()
}

/// Images and buffers whose contents `pass` would make, were it on.
pub(super) fn would_write(pass: &Pass) -> impl Iterator<Item = (Resource, crate::base::Span)> {
    let writes = |access: &Access<'_>| access.attaches() || access.writes(pass, None);
    pass.accesses().filter(writes).map(|access| (access.resource, access.span))
}
