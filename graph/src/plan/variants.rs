//! How a Plan has shaders compiled.

use super::{BindingKind, Pass, Plan, RenderScope};
use crate::frame::Stereo;
use crate::shader::{EyeSource, Variant};

impl Plan {
    /// How the shader of a pass is compiled, which is part of a rendering scope or, with `None`, a dispatch.
    #[must_use]
    pub fn variant(&self, pass: &Pass, scope: Option<&RenderScope>) -> Variant {
        let form = scope.and_then(|scope| self.eyes(scope));
        let of_view = pass.view.and_then(|view| self.views.get(view.0 as usize)?.eye);
        let eye = match (self.stereo, form) {
            (Stereo::Multiview, Some(_)) => Some(EyeSource::ViewIndex),
            (Stereo::DoubleWide, Some(_)) => Some(EyeSource::InstanceBit),
            (_, Some(_)) => Some(EyeSource::InstanceParity),
            (_, None) => of_view.map(|of| EyeSource::One(of.eye)),
        };
        let eyes = pass.accesses.iter().filter_map(|access| {
            let binding = access.binding.as_ref().filter(|it| matches!(it.kind, BindingKind::Sampled(_)))?;
            Some((binding.name.clone(), self.image(access.image).eyes?, access.eye))
        });
        let components = pass.accesses.iter().filter_map(|access| {
            Some((access.binding.as_ref()?.name.clone(), self.image(access.image).format.components()))
        });
        let bindings = || pass.accesses.iter().filter_map(|access| access.binding.as_ref());
        let sampled = bindings().filter(|binding| binding.kind != BindingKind::Storage);
        let mut sampled: Vec<_> = sampled.map(|binding| binding.name.clone()).collect();
        Variant::name_arrays(&mut sampled);
        let local = bindings().filter(|binding| binding.kind == BindingKind::InputAttachment);
        Variant {
            textures: bindings().filter_map(|it| Some((it.name.clone(), it.texture?))).collect(),
            sampled,
            components: components.collect(),
            parts: self.parts(pass).map(|(name, _)| name.clone()).collect(),
            eye,
            form,
            eyes: eyes.collect(),
            local: local.map(|binding| binding.name.clone()).collect(),
            depth_only: pass.redraws.is_some(),
            alpha_to_coverage: pass.alpha_to_coverage,
            given: Variant::given_to(
                &pass.shader,
                bindings().map(|binding| &binding.name).chain(pass.buffers.iter().filter_map(|it| it.binding.as_ref())),
                pass.params.iter().map(|param| &param.name),
            ),
            constants: Variant::constants(pass.constants.iter().map(|it| (&it.name, &it.value))),
        }
    }

    /// All passes that have a shader, inserted ones too, each with how it is compiled.
    pub fn variants(&self) -> impl Iterator<Item = (&Pass, Variant)> {
        self.steps.iter().flat_map(move |step| {
            let shaded = step.work.passes().iter().filter(|_| !step.work.is_custom());
            shaded.map(move |pass| (pass, self.variant(pass, step.work.scope())))
        })
    }
}
