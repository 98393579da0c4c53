//! Samplers by themselves: one samples all its images alike.

use crate::base::{Code, Diagnostic};
use crate::frame::Pass;
use crate::language;
use crate::shader::{PASS_SET, ShaderInterface, declared_name};
use crate::vulkan::{AddressMode, Filter, Sampler, name_of};

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
        errors.push(
            wrong.label(first.span, words(first.sampler)).help(
                "say the same of both in all that a sampler has; left out, `filter` is `Linear` for colour alone",
            ),
        );
    }
}

/// A sampler as a file writes it.
fn words(sampler: Sampler) -> String {
    let Sampler { filter, mips, address, compare, border, reduction, anisotropy, lod_bias, min_lod, max_lod } = sampler;
    let name = |filter: Filter| if filter == Filter::Linear { "Linear" } else { "Nearest" };
    let address = match address {
        AddressMode::ClampToEdge => "Clamp",
        AddressMode::Repeat => "Repeat",
        AddressMode::MirroredRepeat => "Mirror",
        AddressMode::ClampToBorder => "Border",
        AddressMode::MirrorClampToEdge => "MirrorOnce",
    };
    let mut words = format!("filter: {}, mip_filter: {}, address: {address}", name(filter), name(mips));
    words += if compare.is_some() { ", compared" } else { "" };
    words.extend(border.iter().map(|border| format!(", border: {}", name_of(border))));
    if sampler.reduces() {
        words += &format!(", reduction: {}", name_of(&reduction));
    }
    if anisotropy > 1 {
        words += &format!(", anisotropy: {anisotropy}");
    }
    if !lod_bias.is_zero() {
        words += &format!(", lod_bias: {}", f32::from(lod_bias));
    }
    if !min_lod.is_zero() {
        words += &format!(", min_lod: {}", f32::from(min_lod));
    }
    words.extend(max_lod.map(|greatest| format!(", max_lod: {}", f32::from(greatest))));
    words
}
