//! Passes, copies, blits, fills and resolves of the Plan.

use super::stage_results::{StageResults, cause, frame_work};
use crate::compile::adapt::has_samples;
use crate::compile::model::{Kind, Op, OpKind, ResolveShader, Role, Use};
use crate::frame::{
    Access as FrameAccess, Blend, ColorTarget, DepthTarget, Draw, Groups, ParamValue, Pass as FramePass, RasterState,
    SampledImage, Storage, ViewIndex, Work as FrameWork,
};
use crate::plan::{
    Access, Binding, BindingKind, BufferAccess, BufferId, Cause, DepthState, Fill, ImageId, Param, Pass, Side,
    Transfer, ViewId, Work,
};
use crate::vulkan::{ColorComponents, CompareOp, Component, Dimension, Filter, ImageShape, ResolveMode, Sampler};
use std::sync::Arc;

/// The shader that draws one image into another. Inserted passes are drawn by shipped shaders, even if there are files of
/// those names a user has.
const COPY_SHADER: &str = "shipped:copy";
/// The name by which it knows its source.
const COPY_SOURCE: &str = "source";

/// The work of an operation that is not drawn.
pub(super) fn single(results: &StageResults<'_>, number: u32) -> Work {
    let op = &results.adapted.ops[number as usize];
    if matches!(op.kind, OpKind::Resolve { .. }) {
        return Work::Resolve(transfer(results, op, number, None));
    }
    match frame_work(results.frame, op) {
        None | Some(FrameWork::Copy) => Work::Copy(transfer(results, op, number, None)),
        Some(FrameWork::Blit { filter }) => Work::Blit(transfer(results, op, number, Some(*filter))),
        Some(FrameWork::Fill { value }) => {
            let (name, cause, target) = (name(results, op), cause(results, op), filled(results, number));
            Work::Fill(Fill { name, cause, target, value: *value })
        }
        Some(FrameWork::Custom { .. }) => Work::Custom(pass(results, number)),
        Some(FrameWork::Dispatch { .. } | FrameWork::Draw { .. } | FrameWork::Forward { .. }) => {
            Work::Dispatch(pass(results, number))
        }
    }
}

/// The side of a transfer without sides: validation refuses these.
const NOTHING: Side = Side::Buffer { buffer: BufferId(0), bytes: 0 };

/// The name of the pass that an operation is. What was inserted beside it has none.
fn name(results: &StageResults<'_>, op: &Op) -> Option<Arc<str>> {
    let OpKind::Pass(pass) = op.kind else { return None };
    Some(results.frame.passes[pass as usize].name.clone())
}

fn transfer(results: &StageResults<'_>, op: &Op, number: u32, filter: Option<Filter>) -> Transfer {
    let [source, target] = sides(results, number);
    Transfer { name: name(results, op), cause: cause(results, op), source, target, filter }
}

/// The target of a fill.
pub(super) fn filled(results: &StageResults<'_>, number: u32) -> Side {
    results.adapted.uses(number).first().map_or(NOTHING, |used| side(results, used))
}

/// Source and target of a transfer.
pub(super) fn sides(results: &StageResults<'_>, number: u32) -> [Side; 2] {
    let uses = results.adapted.uses(number);
    let [mut source, mut target] = [0, 1].map(|at| uses.get(at).map_or(NOTHING, |used| side(results, used)));
    // Beside an image only the bytes of its texels count; between buffers those of the source.
    if let Side::Image { range, extent, .. } = source
        && let Side::Buffer { bytes, .. } = &mut target
    {
        *bytes = texel_bytes(results, &uses[0], range.layers, extent);
    } else if let Side::Image { range, extent, .. } = target
        && let Side::Buffer { bytes, .. } = &mut source
    {
        *bytes = texel_bytes(results, &uses[1], range.layers, extent);
    } else if let (Side::Buffer { bytes: some, .. }, Side::Buffer { bytes: others, .. }) = (source, &mut target) {
        *others = some;
    }
    [source, target]
}

/// Bytes of the texels that a transfer moves from or to the image that is used here.
fn texel_bytes(results: &StageResults<'_>, used: &Use, layers: u32, extent: [u32; 3]) -> u64 {
    let image = results.adapted.resources[used.resource as usize].image();
    let bytes = image.and_then(|image| image.format.plane_bytes(results.adapted.range(used).aspects)).unwrap_or(0);
    extent.iter().fold(bytes.saturating_mul(layers.into()), |all, side| all.saturating_mul((*side).into()))
}

fn side(results: &StageResults<'_>, used: &Use) -> Side {
    let resource = &results.adapted.resources[used.resource as usize];
    match &resource.kind {
        Kind::Image(image) => {
            let range = results.adapted.range(used);
            let (image, extent) =
                (ImageId(resource.id), results.adapted.extent_at(used.resource, image, range.base_mip));
            Side::Image { image, range, extent, layout: used.layout }
        }
        Kind::Buffer(buffer) => Side::Buffer { buffer: BufferId(resource.id), bytes: buffer.bytes },
    }
}

/// A pass of the Plan.
pub(super) fn pass(results: &StageResults<'_>, number: u32) -> Pass {
    let op = &results.adapted.ops[number as usize];
    let uses = results.adapted.uses(number);
    let nothing = || Arc::clone(&results.nothing);
    if let OpKind::ResolveDraw { by, view, draw } = &op.kind {
        return resolve_draw(results, number, *by, &draw.name, *view);
    }
    let Some(declared) = op.kind.pass().map(|pass| &results.frame.passes[pass as usize]) else {
        return bare(nothing(), cause(results, op), None, None, nothing());
    };
    if let OpKind::DepthOnly { draw, .. } = &op.kind {
        return depth_only(results, number, declared, &draw.name);
    }
    let (name, cause) = (declared.name.clone(), cause(results, op));
    if let OpKind::ForwardDraw { filter, .. } = op.kind {
        return Pass {
            blend: vec![Blend::Replace],
            accesses: from_source(results, uses, filter),
            merged: results.scoped.merged(results.frame, results.adapted, number),
            view: view(results, declared.view),
            ..bare(name, cause, Some(Draw::FullScreen), None, COPY_SHADER.into())
        };
    }
    let work = &declared.work;
    let draw = work.draw().map(|(draw, _)| draw);
    let shader = work.shader().map_or_else(nothing, Arc::clone);
    let (mut accesses, mut buffers) = (Vec::with_capacity(uses.len()), Vec::new());
    for used in uses {
        if results.adapted.resources[used.resource as usize].image().is_some() {
            accesses.push(declared_access(results, used, declared));
        } else {
            buffers.push(buffer_access(results, used, declared));
        }
    }
    let view = view(results, declared.view);
    let mut planned = Pass { view, accesses, buffers, ..bare(name, cause, draw, work.groups(), shader) };
    (planned.any_queue, planned.both_eyes) = (declared.any_queue, declared.both_eyes);
    if work.is_draw() {
        drawn(results, &mut planned, declared, uses);
        planned.alpha_to_coverage = declared.alpha_to_coverage && has_samples(results.adapted, uses);
        planned.merged = results.scoped.merged(results.frame, results.adapted, number);
    }
    if !declared.params.is_empty() {
        planned.params = named(&declared.params);
    }
    planned.constants = named(&declared.constants);
    planned
}

/// Values by the shader's names.
fn named(values: &[(Arc<str>, ParamValue)]) -> Vec<Param> {
    values.iter().map(|(name, value)| Param { name: name.clone(), value: value.clone() }).collect()
}

/// The view that a pass is for, if the frame has any.
fn view(results: &StageResults<'_>, view: ViewIndex) -> Option<ViewId> {
    (!results.frame.views.is_empty()).then_some(ViewId(view.0))
}

/// The accesses of an inserted full-screen draw that samples one image.
fn from_source(results: &StageResults<'_>, uses: &[Use], filter: Filter) -> Vec<Access> {
    let kind = BindingKind::Sampled(Sampler::new(filter));
    let binding = || Binding { name: COPY_SOURCE.into(), kind, texture: None };
    uses.iter().map(|used| access(results, used, (used.role.is_sampled()).then(binding))).collect()
}

/// A draw of the frame again, of nothing but its depth.
fn depth_only(results: &StageResults<'_>, number: u32, declared: &FramePass, name: &Arc<str>) -> Pass {
    let (op, uses) = (&results.adapted.ops[number as usize], results.adapted.uses(number));
    let drawn_again = declared.work.draw().map(|(draw, shader)| (Some(draw), shader));
    let (draw, shader) = drawn_again.unwrap_or((None, &results.nothing));
    let mut planned = bare(name.clone(), cause(results, op), draw, None, Arc::clone(shader));
    drawn(results, &mut planned, declared, uses);
    Pass {
        redraws: Some(declared.name.clone()),
        view: view(results, declared.view),
        blend: Vec::new(),
        write_masks: Vec::new(),
        params: named(&declared.params),
        constants: named(&declared.constants),
        accesses: uses.iter().map(|used| access(results, used, None)).collect(),
        merged: results.scoped.merged(results.frame, results.adapted, number),
        ..planned
    }
}

/// A full-screen draw that resolves depth or colour.
fn resolve_draw(results: &StageResults<'_>, number: u32, by: ResolveShader, name: &Arc<str>, of: ViewIndex) -> Pass {
    let (op, uses) = (&results.adapted.ops[number as usize], results.adapted.uses(number));
    let shader = match by {
        ResolveShader::Depth(ResolveMode::SampleZero) => "shipped:depth_resolve_zero",
        ResolveShader::Depth(ResolveMode::Min) => "shipped:depth_resolve_min",
        ResolveShader::Depth(ResolveMode::Max) => "shipped:depth_resolve_max",
        ResolveShader::Depth(ResolveMode::Average) => "shipped:depth_resolve_average",
        ResolveShader::Weighted => "shipped:resolve_weighted",
        ResolveShader::Uint => "shipped:resolve_zero_uint",
        ResolveShader::Sint => "shipped:resolve_zero_sint",
    };
    let pass = Pass {
        accesses: from_source(results, uses, Filter::Nearest),
        merged: results.scoped.merged(results.frame, results.adapted, number),
        view: view(results, of),
        ..bare(name.clone(), cause(results, op), Some(Draw::FullScreen), None, shader.into())
    };
    match by {
        ResolveShader::Depth(_) => Pass { depth: Some(DepthState { test: CompareOp::Always, write: true }), ..pass },
        ResolveShader::Weighted => weighted(pass),
        ResolveShader::Uint | ResolveShader::Sint => Pass { blend: vec![Blend::Replace], ..pass },
    }
}

/// Adds the texture and the parameter that the shader of weighted resolves takes: its source is multisampled, and it computes
/// the mean of light.
fn weighted(mut pass: Pass) -> Pass {
    let samples =
        ImageShape { dimension: Dimension::D2, arrayed: false, multisampled: true, component: Component::Float };
    for binding in pass.accesses.iter_mut().filter_map(|access| access.binding.as_mut()) {
        binding.texture = Some(samples);
    }
    let params = vec![Param { name: "invert".into(), value: ParamValue::Bool(true) }];
    Pass { blend: vec![Blend::Replace], params, ..pass }
}

/// Adds the state that only draws have.
fn drawn(results: &StageResults<'_>, planned: &mut Pass, declared: &FramePass, uses: &[Use]) {
    planned.discards = declared.work.discards();
    planned.untouched.clone_from(&declared.untouched);
    planned.covers = declared.covers;
    planned.blend = declared.color.iter().map(|target| target.blend).collect();
    planned.write_masks = write_masks(results, declared);
    planned.raster = declared.raster;
    let uses_plane = |role| uses.iter().any(|used| used.role == role);
    let depth = declared.depth.as_ref();
    let state = depth.map(|DepthTarget { test, write, .. }| DepthState { test: *test, write: *write });
    planned.depth = state.filter(|_| uses_plane(Role::Depth));
    planned.stencil = depth.and_then(|depth| depth.stencil).filter(|_| uses_plane(Role::Stencil));
}

/// The channels that a pass writes of each target; none if it writes all that each has.
fn write_masks(results: &StageResults<'_>, declared: &FramePass) -> Vec<ColorComponents> {
    let written = |target: &ColorTarget| {
        let components = results.frame.images[target.image.0 as usize].format.components();
        let whole = target.write_mask.contains(ColorComponents::first(components));
        if whole { ColorComponents::RGBA } else { target.write_mask }
    };
    let mut partial = declared.color.iter().map(written).filter(|mask| *mask != ColorComponents::RGBA);
    // Most passes write all, and need no list.
    if partial.next().is_none() { Vec::new() } else { declared.color.iter().map(written).collect() }
}

/// A pass without accesses.
fn bare(name: Arc<str>, cause: Cause, draw: Option<Draw>, groups: Option<Groups>, shader: Arc<str>) -> Pass {
    Pass {
        name,
        cause,
        view: None,
        draw,
        groups,
        shader,
        redraws: None,
        discards: false,
        untouched: None,
        covers: false,
        alpha_to_coverage: false,
        blend: Vec::new(),
        write_masks: Vec::new(),
        raster: RasterState::default(),
        depth: None,
        stencil: None,
        params: Vec::new(),
        constants: Vec::new(),
        accesses: Vec::new(),
        buffers: Vec::new(),
        local_barrier: false,
        any_queue: false,
        both_eyes: false,
        merged: None,
    }
}

/// The access to an image by the pass that declares it.
fn declared_access(results: &StageResults<'_>, used: &Use, declared: &FramePass) -> Access {
    let entry = used.entry as usize;
    let bound = |name: &Arc<str>, kind, texture| Some(Binding { name: name.clone(), kind, texture });
    let of_sampled = |sampled: &SampledImage| {
        let texture = sampled.texture.map(|texture| adapted(results, used, texture));
        (bound(&sampled.binding, BindingKind::Sampled(sampled.sampler), texture), sampled.eye)
    };
    let of_storage = |storage: &Storage| (bound(&storage.binding, BindingKind::Storage, None), storage.eye);
    let (binding, eye) = match used.role {
        Role::Declared => match declared.accesses().nth(entry) {
            Some(FrameAccess::Sampled(sampled)) => of_sampled(sampled),
            Some(FrameAccess::Storage(storage)) => of_storage(storage),
            _ => (None, None),
        },
        Role::Sampled => of_sampled(&declared.sampled[entry]),
        Role::Input => (bound(&declared.sampled[entry].binding, BindingKind::InputAttachment, None), None),
        Role::Storage => of_storage(&declared.storage[entry]),
        Role::Color | Role::Depth | Role::Stencil | Role::Buffer | Role::Source | Role::Target => (None, None),
    };
    Access { eye, declared: used.role.is_declared(), ..access(results, used, binding) }
}

/// The texture that an adapting shader declares: multisampled only if the image has several samples.
fn adapted(results: &StageResults<'_>, used: &Use, texture: ImageShape) -> ImageShape {
    let samples = results.adapted.resources[used.resource as usize].image().map_or(1, |image| image.samples);
    ImageShape { multisampled: texture.multisampled && samples > 1, ..texture }
}

/// One access of a pass to an image; load, store and resolve operations are the scope's.
#[inline]
fn access(results: &StageResults<'_>, used: &Use, binding: Option<Binding>) -> Access {
    let resource = &results.adapted.resources[used.resource as usize];
    let range = results.adapted.ranges.get(used.range as usize).copied().unwrap_or_else(|| resource.all());
    let image = ImageId(resource.id);
    let Use { stages, accesses, layout, .. } = *used;
    Access { image, range, eye: None, stages, accesses, layout, binding, declared: false }
}

fn buffer_access(results: &StageResults<'_>, used: &Use, declared: &FramePass) -> BufferAccess {
    let entry = used.entry as usize;
    let named = if used.role.is_declared() {
        declared.accesses().nth(entry).and_then(|named| match named {
            FrameAccess::Buffer(named) => Some(named),
            _ => None,
        })
    } else {
        declared.buffers.get(entry).filter(|_| used.role.is_buffer())
    };
    BufferAccess {
        buffer: BufferId(results.adapted.resources[used.resource as usize].id),
        role: named.map(|named| named.role),
        stages: used.stages,
        accesses: used.accesses,
        binding: named.and_then(|named| named.binding.clone()),
        declared: used.role.is_declared(),
    }
}
