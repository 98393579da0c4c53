//! Passes of the frame: the work of each, the parts that it uses, and the inputs of its shader.

use super::transfers::FilePass;
use super::{raster, targets, transfers, work};
use crate::base::{Diagnostic, Span};
use crate::expand::resources::{Resources, fills, parts};
use crate::expand::shader::{
    self, CheckedShaders, constants, coverage, local, params, rotation, sampled_images, samplers, stereo, storage,
    supplied_resources, variant,
};
use crate::frame::check;
use crate::frame::{BufferRole, Cadence, ColorTarget, DeclaredUse, DepthTarget, Pass, Resource, TransferUse, Work};
use crate::language::{self, StandIn};
use crate::shader::ShaderInterface;
use crate::vulkan::{FillValue, Stages, Subresources};

/// The pass as it runs, checked against its shader. A shader that can't be had is unknown: mistakes were reported then,
/// and the targets that the pass would write count as written.
pub(in crate::expand) fn lower(
    resources: &Resources<'_>,
    pass: &language::Pass,
    shaders: &mut CheckedShaders<'_>,
    errors: &mut Vec<Diagnostic>,
) -> Pass {
    let variant = variant::of(resources, pass);
    let path = shaders.find(pass, errors);
    let interface = path.as_ref().and_then(|path| shaders.found_interface(pass, path, &variant, errors));
    let mut lowered = draft(resources, pass, interface.as_ref(), errors);
    if let Some(found) = &path {
        lowered.work.set_shader(found);
    }
    work::check(resources, pass, &lowered, interface.as_ref(), errors);
    if let Some(brought) = shaders.brought_along(pass) {
        raster::join(pass, &brought, &mut lowered, errors);
    }
    raster::check(pass, &lowered, interface.as_ref(), errors);
    transfers::draw_part(&FilePass { resources, pass }, &mut lowered, errors);
    supplied_resources::custom(shaders, pass, errors);
    if let (Some(path), Some(interface)) = (&path, &interface) {
        lowered.no_rotation = rotation::hindrance(&lowered.work, interface);
        lowered.needs = supplied_resources::needs(shaders, pass, interface);
        let strays = supplied_resources::check(resources, shaders, pass, (path, interface), errors);
        let before = errors.len();
        let mut misspelt = sampled_images::check(resources, pass, &lowered, interface, errors);
        if errors.len() == before {
            check::samplers::check(&FilePass { resources, pass }, &lowered, errors);
            samplers::check(pass, &lowered, interface, errors);
            variant::check_single_sampled(pass, &lowered, &variant, shaders, errors);
            local::check(resources, pass, &lowered, (interface, &variant), shaders, errors);
        }
        misspelt.extend(storage::check(resources, pass, &lowered, interface, errors));
        shader::missing(pass, interface, &misspelt, errors);
        let whole = (!pass.left_out.is_empty()).then(|| variant::with_all(resources, pass)).flatten();
        let whole = whole.and_then(|whole| shaders.interface(pass, &whole, errors));
        sampled_images::check_left_out(pass, whole.as_ref(), errors);
        lowered.params = params::give(pass, interface, whole.as_ref(), &strays, errors);
        constants::check(pass, interface, errors);
        targets::fed(resources, pass, interface, errors);
        shaders.remarks.extend(targets::set(pass, interface, errors));
        targets::untaken(pass, interface, &mut shaders.remarks);
        stereo::check_halves(resources, pass, interface, errors);
        stereo::note_shared_matrix(resources, pass, interface, &mut shaders.remarks);
    } else if pass.work.callback().is_some() {
        lowered.params = params::as_written(pass);
    }
    lowered
}

/// The pass without its shader's parameters. Stages, and whether it reads and writes storage, are the shader's.
pub(in crate::expand) fn draft(
    resources: &Resources<'_>,
    pass: &language::Pass,
    interface: Option<&ShaderInterface>,
    errors: &mut Vec<Diagnostic>,
) -> Pass {
    let raster = pass.is_drawn();
    let mut lowered = Pass {
        name: pass.name.text.clone(),
        span: pass.name.span,
        view: pass.view,
        run: pass.run.clone().unwrap_or_default(),
        work: work::lower(resources, pass, interface),
        // Vectors with room for just these: a frame has many passes with one or two.
        sampled: Vec::with_capacity(pass.sample.len()),
        storage: Vec::new(),
        color: Vec::with_capacity(pass.color.len()),
        depth: None,
        raster: pass.raster.map(|raster| raster.value).unwrap_or_default(),
        raster_span: pass.raster.map_or(Span::NONE, |raster| raster.span),
        alpha_to_coverage: pass.alpha_to_coverage.is_some(),
        covers: pass.covers,
        untouched: coverage::untouched(pass, interface),
        no_depth_only: None,
        no_rotation: None,
        needs: Vec::new(),
        inserted: None,
        buffers: Vec::new(),
        transfers: Vec::new(),
        uses: Vec::new(),
        any_queue: pass.any_queue,
        both_eyes: pass.both_eyes && touches_both(resources, pass),
        side_effect: pass.side_effect,
        params: Vec::new(),
        constants: constants::as_written(pass),
    };
    for sample in &pass.sample {
        let range = parts::range(resources, &sample.part, errors);
        lowered.sampled.extend(sampled_images::lower(resources, sample, range, interface, raster));
    }
    for part in &pass.storage {
        storage::lower(resources, part, interface, raster, &mut lowered, errors);
    }
    for target in &pass.color {
        lowered.color.push(ColorTarget {
            image: target.part.image.index,
            range: parts::range(resources, &target.part, errors),
            span: target.part.image.span,
            clear: target.clear.map(|clear| clear.map(|number| number.value)),
            blend: target.blend.value,
            write_mask: target.write_mask,
        });
    }
    lowered.depth = pass.depth.as_ref().map(|target| DepthTarget {
        image: target.part.image.index,
        range: parts::range(resources, &target.part, errors),
        span: target.part.image.span,
        clear: target.clear,
        test: target.test,
        write: target.write,
        stencil: target.stencil.map(|stencil| stencil.value),
    });
    buffers(pass, interface, raster, &mut lowered);
    transferred(resources, pass, &mut lowered, errors);
    lowered.uses = pass.uses.iter().map(|declared| declared_use(resources, declared, errors)).collect();
    lowered
}

/// Whether an image that it touches holds both eyes' parts, and neither eye's alone is meant.
fn touches_both(resources: &Resources<'_>, pass: &language::Pass) -> bool {
    let both = |part: &language::ImagePart| {
        part.eye.is_none() && resources.image(part.image.index).is_some_and(|image| image.image.eyes.is_some())
    };
    pass.image_parts().any(|(part, _)| both(part))
}

fn declared_use(
    resources: &Resources<'_>,
    declared: &language::DeclaredUse,
    errors: &mut Vec<Diagnostic>,
) -> DeclaredUse {
    let language::DeclaredUse { part, span, state } = declared;
    let range = match part {
        language::Part::Image(part) => parts::range(resources, part, errors),
        language::Part::Buffer(_) => Subresources::WHOLE,
    };
    let frames_ago = part.previous().map_or(0, |previous| previous.value);
    DeclaredUse { resource: part.resource().resource, range, frames_ago, span: *span, state: *state }
}

/// Buffers that are read as uniform blocks, vertices, indices and counts.
fn buffers(pass: &language::Pass, interface: Option<&ShaderInterface>, raster: bool, lowered: &mut Pass) {
    for uniform in &pass.uniform {
        let stages = storage::stages(interface, &uniform.binding.text, raster);
        let binding = Some(uniform.binding.text.clone());
        lowered.buffers.push(storage::used(&uniform.part, binding, BufferRole::Uniform, stages));
    }
    let indirect = pass.work.counts();
    let roles = [
        (pass.vertex.as_ref(), BufferRole::Vertex),
        (pass.index.as_ref(), BufferRole::Index),
        (indirect, BufferRole::Indirect),
        (pass.work.count(), BufferRole::Count),
    ];
    for (part, role) in roles {
        lowered.buffers.extend(part.map(|part| storage::used(part, None, role, Stages::empty())));
    }
}

fn transferred(resources: &Resources<'_>, pass: &language::Pass, lowered: &mut Pass, errors: &mut Vec<Diagnostic>) {
    let reads = pass.work.transfer_reads().iter().map(|part| (part, false));
    let parts = reads.chain(pass.work.transfer_writes().iter().map(|part| (part, true)));
    for (part, write) in parts {
        let language::ResourceRef { resource, span } = part.resource();
        let range = match part {
            language::Part::Image(part) => parts::range(resources, part, errors),
            language::Part::Buffer(_) => Subresources::WHOLE,
        };
        let frames_ago = part.previous().map_or(0, |previous| previous.value);
        lowered.transfers.push(TransferUse { resource, range, frames_ago, span, write, keeps: false });
    }
}

/// The passes that run in place of a pass that is off, if its targets must be filled all the same. The first has the name
/// of the pass, others a number beside it.
pub(in crate::expand) fn stand_ins(
    resources: &Resources<'_>,
    pass: &language::Pass,
    because: &str,
    errors: &mut Vec<Diagnostic>,
) -> Vec<Pass> {
    let stand_in = |(number, stand_in): (usize, &StandIn)| {
        let (run, work, transfer) = match *stand_in {
            // What it forwards may have changed in any frame.
            StandIn::Forward(language::Forward { from, to }) => {
                let work = Work::Forward { from: from.index, to: to.index, because: because.to_owned() };
                (Cadence::Always, work, None)
            }
            StandIn::Clear { to, value } => {
                let part = language::Part::Image(language::ImagePart::whole(to));
                transfers::fill(resources, &part, value, errors);
                let filled = fills::typed(value.value, resources.filled(&part));
                let filled = filled.unwrap_or(FillValue::Bits([0; 4]));
                let (resource, range) = (Resource::Image(to.index), Subresources::WHOLE);
                let transfer = TransferUse { resource, range, frames_ago: 0, span: to.span, write: true, keeps: false };
                (pass.run.clone().unwrap_or_default(), Work::Fill { value: filled }, Some(transfer))
            }
        };
        let name = &pass.name.text;
        let name = if number == 0 { name.to_string() } else { format!("{name} (otherwise {})", number + 1) };
        let (span, view) = (pass.name.span, pass.view);
        Pass { span, view, run, transfers: transfer.into_iter().collect(), ..Pass::new(&name, work) }
    };
    pass.otherwise.iter().enumerate().map(stand_in).collect()
}
