//! The features of a device that a Plan uses, each with what uses it.

use super::{Image, Pass, Plan, RenderScope, Resource};
use crate::device::{DYNAMIC_RENDERING, EVERY_PLAN_USES, INDEPENDENT_BLEND, Need, NeedKind, SEPARATE_LAYOUTS};
use crate::frame::{EyeForm, IndirectDraws, Stereo};
use crate::shader::{ShaderInterfaces, ShaderProblem, needs_in_pass};
use crate::vulkan::{Accesses, Aspects, BufferUsage, Layout, Stages, State, name_of};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Vulkan's name of the feature for colours that a scope reads of itself.
const LOCAL_READ: &str = "dynamicRenderingLocalRead";

/// Vulkan's name of the feature for buffers that have addresses.
const ADDRESSES: &str = "bufferDeviceAddress";

/// A feature of a device that a Plan uses.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct UsedFeature {
    /// Vulkan's name of the feature, of the property where none switches it on (`subgroupSupportedOperations.VOTE`), or of the
    /// extension where it has no feature (`VK_KHR_swapchain`).
    pub name: &'static str,
    /// The first that uses it, in words.
    pub by: String,
}

impl UsedFeature {
    /// The extension for images that are shown. It has no feature.
    pub const SWAPCHAIN: &'static str = "VK_KHR_swapchain";
}

/// The features found so far: each by its name, with the first that uses it.
#[derive(Default)]
struct UsedFeatures(BTreeMap<&'static str, String>);

impl UsedFeatures {
    fn add(&mut self, name: &'static str, by: impl FnOnce() -> String) {
        self.0.entry(name).or_insert_with(by);
    }

    fn list(self) -> Vec<UsedFeature> {
        self.0.into_iter().map(|(name, by)| UsedFeature { name, by }).collect()
    }
}

impl Plan {
    /// The features of a device that the Plan uses, those of its shaders included, by name. A device that has them, and allows what the
    /// Plan and its shaders are large, can execute it: with no feature beyond them, and with those of the minimum alone that are among
    /// them. What executors are asked for beside may need more, as counts of fragment shaders do.
    ///
    /// # Errors
    /// A shader that can't be used, with its name.
    pub fn features(&self, shaders: &mut dyn ShaderInterfaces) -> Result<Vec<UsedFeature>, (Arc<str>, ShaderProblem)> {
        let mut found = self.used();
        let sets = shaders.program_sets();
        for (pass, variant) in self.variants() {
            let interface = match pass.draw {
                Some(draw) => shaders.draw_shader(&pass.shader, draw, &variant),
                None => shaders.compute_shader(&pass.shader, &variant),
            };
            let interface = match (interface, pass.draw) {
                (Ok(interface), _) => interface,
                // The program brings a pipeline of its own.
                (Err(ShaderProblem::Missing { .. }), Some(draw)) if draw.is_custom() => continue,
                (Err(problem), _) => return Err((pass.shader.clone(), problem)),
            };
            let brought = shaders.brought_along(pass.draw, &pass.shader);
            // How many targets there are is held to a limit, and no feature.
            for Need { kind, place } in needs_in_pass(&interface, Some(&brought), &sets, 0) {
                let NeedKind::Feature { name, what } = kind else { continue };
                let place = if place.is_empty() { String::new() } else { format!(" ({place})") };
                found.add(name, || format!("pass `{}`: {what}{place}", pass.name));
            }
        }
        Ok(found.list())
    }

    /// Those of them that the Plan shows by itself, without its shaders.
    #[must_use]
    pub fn own_features(&self) -> Vec<UsedFeature> {
        self.used().list()
    }

    fn used(&self) -> UsedFeatures {
        let mut found = UsedFeatures::default();
        EVERY_PLAN_USES.into_iter().for_each(|name| found.add(name, || "every Plan".to_owned()));
        for image in &self.images {
            let states = image.role.states().into_iter().flatten();
            states.for_each(|it| state(&mut found, *it, || format!("the state of `{}`", image.name)));
            if let Some(feature) = image.format.feature() {
                found.add(feature, || format!("`{}`: {}", image.name, image.format));
            }
        }
        for buffer in &self.buffers {
            let states = buffer.role.states().into_iter().flatten();
            states.for_each(|it| state(&mut found, *it, || format!("the state of `{}`", buffer.name)));
            if buffer.usage.contains(BufferUsage::SHADER_DEVICE_ADDRESS) {
                found.add(ADDRESSES, || format!("`{}` has an address", buffer.name));
            }
        }
        for (number, step) in self.steps.iter().enumerate() {
            let by = || format!("a barrier of step {number}");
            for barrier in step.image_barriers.iter().chain(&step.releases) {
                let image = self.image(barrier.image);
                planes(&mut found, image, barrier.range.aspects, [barrier.old_layout, barrier.new_layout]);
                let ends = [
                    (barrier.src_stages, barrier.src_accesses, barrier.old_layout),
                    (barrier.dst_stages, barrier.dst_accesses, barrier.new_layout),
                ];
                ends.into_iter().for_each(|end| state(&mut found, state_of(end), by));
            }
            for barrier in &step.memory_barriers {
                let ends = [(barrier.src_stages, barrier.src_accesses), (barrier.dst_stages, barrier.dst_accesses)];
                let ends = ends.map(|(stages, accesses)| state_of((stages, accesses, Layout::Undefined)));
                ends.into_iter().for_each(|end| state(&mut found, end, by));
            }
            if let Some(scope) = step.work.scope() {
                found.add(DYNAMIC_RENDERING, || format!("the rendering scope of step {number}"));
                self.scope(&mut found, scope, number);
            }
            step.work.passes().iter().for_each(|pass| self.pass(&mut found, pass));
        }
        found
    }

    /// What a rendering scope takes.
    fn scope(&self, found: &mut UsedFeatures, scope: &RenderScope, number: usize) {
        let eyes = match (self.stereo, self.eyes(scope)) {
            (Stereo::Multiview, Some(_)) => Some("multiview"),
            (Stereo::Instanced, Some(EyeForm::Layers)) => Some("shaderOutputLayer"),
            (Stereo::Instanced, Some(EyeForm::Halves)) => Some("shaderClipDistance"),
            (Stereo::Off | Stereo::MultiPass | Stereo::DoubleWide, _) | (_, None) => None,
        };
        if let Some(name) = eyes {
            found.add(name, || format!("step {number} draws for both eyes at once ({})", self.stereo.name()));
        }
        for attachment in &scope.attachments {
            planes(found, self.image(attachment.image), attachment.range.aspects, [attachment.layout; 2]);
            if let Some(resolve) = &attachment.resolve {
                planes(found, self.image(resolve.image), resolve.range.aspects, [resolve.layout; 2]);
            }
        }
        for pass in &scope.passes {
            // An attachment that a pass doesn't draw into has an empty mask.
            let of = |number: usize| {
                let is_drawn = pass.accesses.iter().any(|access| {
                    let attachment = &scope.color()[number];
                    let (range, of) = (&access.range, &attachment.range);
                    access.image == attachment.image
                        && access.binding.is_none()
                        && !access.accesses.writes().is_empty()
                        && (range.base_mip, range.base_layer) == (of.base_mip, of.base_layer)
                });
                is_drawn.then(|| (pass.blend.get(number).and_then(|blend| blend.equation()), pass.write_mask(number)))
            };
            if (1..scope.color().len()).any(|number| of(number) != of(0)) {
                found.add(INDEPENDENT_BLEND, || {
                    format!("pass `{}`: it blends or masks its colours differently", pass.name)
                });
            }
        }
    }

    /// What a pass takes, but for its shader.
    fn pass(&self, found: &mut UsedFeatures, pass: &Pass) {
        let of_draws = pass.draw.and_then(|draw| draw.indirect()).into_iter().flat_map(IndirectDraws::features);
        let of_blends = pass.blend.iter().filter_map(|blend| blend.feature());
        for (name, what) in pass.raster.features().chain(of_blends).chain(of_draws) {
            found.add(name, || format!("pass `{}`: {what}", pass.name));
        }
        for access in &pass.accesses {
            let image = self.image(access.image);
            planes(found, image, access.range.aspects, [access.layout; 2]);
            let by = |what: &str| format!("pass `{}`, `{}`: {what}", pass.name, image.name);
            if let Some(sampler) = access.binding.as_ref().and_then(|it| it.kind.sampler()) {
                sampler.features().for_each(|(name, what)| found.add(name, || by(what)));
            }
            if access.declared {
                state(found, state_of((access.stages, access.accesses, access.layout)), || by("a declared use"));
            }
        }
        for access in pass.buffers.iter().filter(|access| access.declared) {
            let used = state_of((access.stages, access.accesses, Layout::Undefined));
            let name = self.resource_name(Resource::Buffer(access.buffer));
            state(found, used, || format!("pass `{}`, `{name}`: a declared use", pass.name));
        }
    }
}

/// What a state takes that an image or buffer is in.
fn state(found: &mut UsedFeatures, state: State, by: impl Fn() -> String) {
    state.features().for_each(|name| found.add(name, &by));
    match state.layout {
        Layout::RenderingLocalReadKhr => found.add(LOCAL_READ, by),
        Layout::PresentSrcKhr => found.add(UsedFeature::SWAPCHAIN, by),
        _ => {}
    }
}

/// The state of one end of a barrier, or of a use.
fn state_of((stages, accesses, layout): (Stages, Accesses, Layout)) -> State {
    State { stages, accesses, layout }
}

/// Whether planes of an image have layouts of their own.
fn planes(found: &mut UsedFeatures, image: &Image, planes: Aspects, layouts: [Layout; 2]) {
    let both = Aspects::DEPTH | Aspects::STENCIL;
    let apart = image.format.aspects().contains(both) && !planes.contains(both);
    let alone = layouts.into_iter().find(|layout| {
        matches!(
            layout,
            Layout::DepthAttachmentOptimal
                | Layout::DepthReadOnlyOptimal
                | Layout::StencilAttachmentOptimal
                | Layout::StencilReadOnlyOptimal
        )
    });
    match alone {
        Some(layout) => found.add(SEPARATE_LAYOUTS, || format!("`{}` in {}", image.name, name_of(&layout))),
        None if apart => found.add(SEPARATE_LAYOUTS, || format!("`{}`, one plane by itself", image.name)),
        None => {}
    }
}
