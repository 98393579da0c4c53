//! Samplers by themselves: one samples all its images alike.

use crate::base::{Code, Diagnostic};
use crate::frame::Pass;
use crate::language;
use crate::shader::{PASS_SET, ShaderInterface, declared_name};
use crate::vulkan::{AddressMode, Filter, Sampler};

/// Reports images that one sampler samples, and that the pass gives in different ways.
pub(in crate::expand) fn check(
    pass: &language::Pass,
    lowered: &Pass,
    interface: &ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) {
    let shader = pass.shader().map_or("", |shader| &*shader.text);
    for binding in interface.bindings.iter().filter(|binding| binding.set == PASS_SET) {
        let Some((images, compares)) = binding.kind.sampler() else { continue };
        let is_its = |name: &str| images.iter().any(|image| *image == declared_name(name));
        let mut sampled = lowered.sampled.iter().filter(|sampled| is_its(&sampled.binding));
        let Some(first) = sampled.next() else { continue };
        let state = first.sampler.comparing(compares);
        let Some(other) = sampled.find(|other| other.sampler.comparing(compares) != state) else { continue };
        let message = format!(
            "shader `{shader}` samples `{}` and `{}` by one sampler, `{}`, and pass `{}` gives them in different ways",
            first.binding, other.binding, binding.name, pass.name.text
        );
        let wrong = Diagnostic::new(Code::SAMPLER_SHARED, other.span, message).remark(words(other.sampler));
        errors.push(wrong.label(first.span, words(first.sampler)).help(
            "say the same `filter`, `mip_filter`, `address` and `compare` of both; left out, `filter` is `Linear` for colour alone",
        ));
    }
}

/// A sampler as a file writes it.
fn words(sampler: Sampler) -> String {
    let Sampler { filter, mips, address, compare, .. } = sampler;
    let name = |filter: Filter| if filter == Filter::Linear { "Linear" } else { "Nearest" };
    let address = match address {
        AddressMode::ClampToEdge => "Clamp",
        AddressMode::Repeat => "Repeat",
        AddressMode::MirroredRepeat => "Mirror",
        AddressMode::ClampToBorder => "Border",
        AddressMode::MirrorClampToEdge => "MirrorOnce",
    };
    let compare = if compare.is_some() { ", compared" } else { "" };
    format!("filter: {}, mip_filter: {}, address: {address}{compare}", name(filter), name(mips))
}
