//! Whether passes that draw multisampled depth can draw depth alone, where one value a texel of that depth may be wanted: then
//! they draw it again with one sample, by the part of their shader that the macro `DEPTH_ONLY` leaves.

use super::state::State;
use crate::expand::resources::Resources;
use crate::expand::shader::{CheckedShaders, coverage, variant};
use crate::frame::{Face, ImageIndex, Pass, ResolveWay};
use crate::language;
use crate::shader::{Binding, PARAMS, PASS_SET, ShaderInterface, ShaderProblem, Variant};
use crate::vulkan::Stages;
use std::collections::HashSet;

/// Notes why passes can't draw depth alone, for those that may have to. `states` are those of the pipeline's passes.
pub(in crate::expand) fn note(resources: &Resources<'_>, states: &mut [State], shaders: &mut CheckedShaders<'_>) {
    let multisampled = |image: ImageIndex| {
        let image = resources.image(image).map(|image| &image.image);
        image.filter(|image| image.samples > 1 && image.format.is_depth())
    };
    let mut wanted = HashSet::new();
    for (image, index) in resources.images.iter().zip(0..).map(|(image, index)| (image, ImageIndex(index))) {
        let asks = image.as_ref().and_then(|image| image.image.resolve.as_ref());
        if asks.is_some_and(|resolve| resolve.way == ResolveWay::DepthOnly) && multisampled(index).is_some() {
            wanted.insert(index);
        }
    }
    for state in &*states {
        let State::On(pass) = state else { continue };
        let sampled = pass.sampled.iter().filter(|sampled| sampled.face != Face::Samples && sampled.frames_ago == 0);
        wanted.extend(sampled.map(|sampled| sampled.image).filter(|image| multisampled(*image).is_some()));
    }
    for (state, described) in states.iter_mut().zip(&resources.pipeline.passes) {
        let State::On(pass) = state else { continue };
        let writes = pass
            .depth
            .as_ref()
            .is_some_and(|depth| (depth.write || depth.clear.is_some()) && wanted.contains(&depth.image));
        if writes {
            pass.no_depth_only = hindrance(resources, described, pass, shaders).map(Into::into);
        }
    }
}

/// Why the shader of a pass can't draw its depth alone, behind the name of the pass.
fn hindrance(
    resources: &Resources<'_>,
    described: &language::Pass,
    pass: &Pass,
    shaders: &mut CheckedShaders<'_>,
) -> Option<String> {
    let (draw, shader) = pass.work.draw()?;
    if draw.is_custom() {
        return None;
    }
    let variant = variant::of(resources, described);
    let whole = shaders.drawn(shader, draw, &variant).ok()?;
    let alone = shaders.drawn(
        shader,
        draw,
        &Variant { depth_only: true, constants: variant.constants.clone(), ..Variant::default() },
    );
    let wrong = match alone {
        Ok(alone) if variant.alpha_to_coverage && !coverage::leaves_out(&alone) => {
            "it leaves out no samples, which its alpha does".to_owned()
        }
        Ok(alone) => difference(&whole, &alone)?,
        Err(ShaderProblem::DoesNotCompile { messages }) => {
            format!("it doesn't compile: {}", messages.first().map_or("", |message| &message.text))
        }
        Err(
            ShaderProblem::Unsupported { what }
            | ShaderProblem::BadModule { what }
            | ShaderProblem::Compiler { what, .. }
            | ShaderProblem::Machine { what },
        ) => {
            format!("it can't be used: {what}")
        }
        Err(ShaderProblem::Missing { .. } | ShaderProblem::EntryPoint { .. }) => return None,
    };
    Some(format!("has the shader `{shader}`, and with the macro `DEPTH_ONLY` {wrong}"))
}

/// Why the rest of a shader can't draw depth alone.
fn difference(whole: &ShaderInterface, alone: &ShaderInterface) -> Option<String> {
    if whole.discards && !alone.discards {
        return Some("it discards no fragments any more".to_owned());
    }
    if whole.masks_samples && !alone.masks_samples {
        return Some("it writes no `gl_SampleMask` any more".to_owned());
    }
    if whole.writes_depth && !alone.writes_depth {
        return Some("it writes no depth of its own any more".to_owned());
    }
    let own = |binding: &&Binding| binding.set == PASS_SET && binding.name != PARAMS;
    if let Some(read) = alone.bindings.iter().find(own) {
        return Some(format!("it still uses `{}`, which may have changed since", read.name));
    }
    if let Some(written) = alone.program.iter().find(|it| it.writable) {
        return Some(format!("it still writes `{}` of the program's", written.name));
    }
    // A vertex shader that lacks one of its inputs would put the geometry elsewhere.
    let moving = |binding: &&Binding| own(binding) && binding.stages.contains(Stages::VERTEX_SHADER);
    let lacking = whole.bindings.iter().find(moving)?;
    Some(format!("its vertex shader would lack `{}`", lacking.name))
}
