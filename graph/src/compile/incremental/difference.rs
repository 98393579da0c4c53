//! The difference between two frames, and which differences are mere values: those that no decision of the compiler depends on.
//! `compile/emit/revise.rs` puts such values into the Plan that there is. Whether an executor stays is the rule of
//! [`Plan::differs_beyond_values`](crate::plan::Plan::differs_beyond_values).

use crate::frame::{
    Buffer, ColorTarget, DepthTarget, Frame, Groups, Image, Lifetime, Pass, SampledImage, StencilState, Storage, View,
    Work,
};
use crate::vulkan::FillValue;
use std::sync::Arc;

/// How much two frames differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Difference {
    /// In nothing.
    None,
    /// In values that no decision depends on.
    Values,
    /// In more.
    Structure,
}

use Difference::{None as Nothing, Structure, Values};

/// The difference that there is if two things are not the same.
fn unless(same: bool, difference: Difference) -> Difference {
    if same { Nothing } else { difference }
}

/// Whether two names are the same: often they are one, since frames come from one another.
fn same_name(old: &Arc<str>, new: &Arc<str>) -> bool {
    Arc::ptr_eq(old, new) || old == new
}

/// Whether all members of two lists are the same.
fn same_lists<T>(old: &[T], new: &[T], same: impl Fn(&T, &T) -> bool) -> bool {
    old.len() == new.len() && old.iter().zip(new).all(|(old, new)| same(old, new))
}

/// The greatest of the differences between the members of two lists.
fn of_lists<T>(old: &[T], new: &[T], of: impl Fn(&T, &T) -> Difference) -> Difference {
    if old.len() != new.len() {
        return Structure;
    }
    let mut most = Nothing;
    for (old, new) in old.iter().zip(new) {
        most = most.max(of(old, new));
        if most == Structure {
            break;
        }
    }
    most
}

pub(super) fn between(old: &Frame, new: &Frame) -> Difference {
    let Frame { sources, settings, changes, extent, stereo, views, images, buffers, passes, outputs, .. } = new;
    let Frame { decided, switched_off, remarks, .. } = new;
    let same = old.sources == *sources
        && old.changes == *changes
        && old.extent == *extent
        && old.stereo == *stereo
        && old.outputs == *outputs
        && old.switched_off == *switched_off
        && old.remarks == *remarks
        && same_lists(&old.images, images, same_image)
        && same_lists(&old.buffers, buffers, same_buffer);
    if !same {
        return Structure;
    }
    unless(old.settings == *settings && old.decided == *decided, Values)
        .max(of_lists(&old.views, views, view))
        .max(of_lists(&old.passes, passes, pass))
}

fn view(old: &View, new: &View) -> Difference {
    let View { name, span, extent, camera, allows, jitter, eye } = new;
    let same = old.name == *name
        && old.span == *span
        && old.extent == *extent
        && old.camera == *camera
        && old.allows == *allows
        && old.eye == *eye;
    if same { unless(old.jitter == *jitter, Values) } else { Structure }
}

fn same_image(old: &Image, new: &Image) -> bool {
    let Image {
        name,
        span,
        format,
        shape,
        extent,
        allocated,
        rotation,
        eyes,
        mips,
        layers,
        samples,
        resolve,
        chosen,
        lifetime,
    } = new;
    same_name(&old.name, name)
        && old.span == *span
        && old.format == *format
        && old.shape == *shape
        && old.extent == *extent
        && old.allocated == *allocated
        && old.rotation == *rotation
        && old.eyes == *eyes
        && old.mips == *mips
        && old.layers == *layers
        && old.samples == *samples
        && old.resolve == *resolve
        && old.chosen == *chosen
        && same_lifetime(&old.lifetime, lifetime)
}

fn same_buffer(old: &Buffer, new: &Buffer) -> bool {
    let Buffer { name, span, bytes, lifetime } = new;
    same_name(&old.name, name) && old.span == *span && old.bytes == *bytes && same_lifetime(&old.lifetime, lifetime)
}

fn same_lifetime(old: &Lifetime, new: &Lifetime) -> bool {
    let same_start = match (old, new) {
        (Lifetime::Transient, Lifetime::Transient) => return true,
        (Lifetime::Persistent { initial: old }, Lifetime::Persistent { initial: new }) => same_fill(old, new),
        (Lifetime::History { initial: old, .. }, Lifetime::History { initial: new, .. }) => same_fill(old, new),
        _ => true,
    };
    same_start && old == new
}

fn pass(old: &Pass, new: &Pass) -> Difference {
    let Pass {
        name,
        span,
        view,
        run,
        work,
        sampled,
        storage,
        color,
        depth,
        raster,
        raster_span,
        alpha_to_coverage,
        covers,
        untouched,
        no_depth_only,
        no_rotation,
        needs,
        inserted,
        buffers,
        transfers,
        uses,
        any_queue,
        both_eyes,
        side_effect,
        params,
        constants,
    } = new;
    let same = same_name(&old.name, name)
        && old.span == *span
        && old.view == *view
        && old.run == *run
        && old.side_effect == *side_effect
        && old.raster == *raster
        && old.raster_span == *raster_span
        && old.alpha_to_coverage == *alpha_to_coverage
        && old.covers == *covers
        && old.untouched == *untouched
        && old.no_depth_only == *no_depth_only
        && old.no_rotation == *no_rotation
        && old.inserted == *inserted
        && same_lists(&old.sampled, sampled, same_sampled)
        && same_lists(&old.storage, storage, same_storage)
        && old.buffers == *buffers
        && old.transfers == *transfers
        && old.uses == *uses
        && old.any_queue == *any_queue
        && old.both_eyes == *both_eyes
        && old.needs == *needs
        && old.constants == *constants;
    if !same {
        return Structure;
    }
    let depth = match (&old.depth, depth) {
        (None, None) => Nothing,
        (Some(old), Some(new)) => depth_target(old, new),
        _ => Structure,
    };
    let same_params = same_lists(&old.params, params, |old, new| same_name(&old.0, &new.0) && old.1.is_same(&new.1));
    unless(same_params, Values).max(works(&old.work, work)).max(of_lists(&old.color, color, color_target)).max(depth)
}

fn same_sampled(old: &SampledImage, new: &SampledImage) -> bool {
    let SampledImage { binding, image, range, frames_ago, span, eye, face, texture, own_pixel, sampler, stages } = new;
    old.image == *image
        && old.range == *range
        && old.frames_ago == *frames_ago
        && old.span == *span
        && old.eye == *eye
        && old.face == *face
        && old.texture == *texture
        && old.own_pixel == *own_pixel
        && old.sampler == *sampler
        && old.stages == *stages
        && same_name(&old.binding, binding)
}

fn same_storage(old: &Storage, new: &Storage) -> bool {
    let Storage { binding, image, range, span, read, write, eye, stages } = new;
    old.image == *image
        && old.range == *range
        && old.span == *span
        && old.read == *read
        && old.write == *write
        && old.eye == *eye
        && old.stages == *stages
        && same_name(&old.binding, binding)
}

fn works(old: &Work, new: &Work) -> Difference {
    match new {
        Work::Dispatch { shader, groups } => {
            let same_kind = match (old.groups(), groups) {
                (Some(Groups::Count(_)), Groups::Count(_)) | (Some(Groups::Invocations(_)), Groups::Invocations(_)) => {
                    old.shader().is_some_and(|old| same_name(old, shader))
                }
                _ => false,
            };
            unless(old == new, if same_kind { Values } else { Structure })
        }
        Work::Fill { value } => old.filled().map_or(Structure, |old| unless(same_fill(&old, value), Values)),
        Work::Draw { .. } | Work::Copy | Work::Blit { .. } | Work::Custom { .. } | Work::Forward { .. } => {
            unless(old == new, Structure)
        }
    }
}

fn color_target(old: &ColorTarget, new: &ColorTarget) -> Difference {
    let ColorTarget { image, range, span, clear, blend, write_mask } = new;
    let same =
        (old.image, old.range, old.span, old.blend, old.write_mask) == (*image, *range, *span, *blend, *write_mask);
    if !same || old.clear.is_some() != clear.is_some() {
        return Structure;
    }
    let bits = |clear: &Option<[f64; 4]>| clear.map(|clear| clear.map(f64::to_bits));
    unless(bits(&old.clear) == bits(clear), Values)
}

fn depth_target(old: &DepthTarget, new: &DepthTarget) -> Difference {
    let DepthTarget { image, range, span, clear, test, write, stencil } = new;
    let same = (old.image, old.range, old.span, old.test, old.write) == (*image, *range, *span, *test, *write);
    let kind = |stencil: &Option<StencilState>| {
        stencil.map(|stencil| StencilState { clear: stencil.clear.map(|_| 0), ..stencil })
    };
    if !same || old.clear.is_some() != clear.is_some() || kind(&old.stencil) != kind(stencil) {
        return Structure;
    }
    let bits = |clear: &Option<f64>| clear.map(f64::to_bits);
    unless(bits(&old.clear) == bits(clear) && old.stencil == *stencil, Values)
}

/// Whether two values are the same, bit for bit: a Plan tells 0 from −0.
fn same_fill(old: &FillValue, new: &FillValue) -> bool {
    match (old, new) {
        (FillValue::Color(old), FillValue::Color(new)) => old.map(f32::to_bits) == new.map(f32::to_bits),
        (FillValue::Depth(old, a), FillValue::Depth(new, b)) => (old.to_bits(), a) == (new.to_bits(), b),
        _ => old == new,
    }
}
