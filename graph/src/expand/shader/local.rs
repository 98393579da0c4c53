//! Reads of images at a fragment's own position: devices with local reads let shaders read such images as input attachments.

use super::interfaces::CheckedShaders;
use crate::base::{Code, Diagnostic};
use crate::expand::resources::Resources;
use crate::frame::{Face, Pass};
use crate::language;
use crate::shader::{PASS_SET, ShaderInterface, Variant};

/// Reports images that a pass reads at its own position, if its shader compiled for local reads can't read them so.
/// `interface`: the shader compiled without local reads, as `variant`; mistakes in it are reported already.
pub(in crate::expand) fn check(
    resources: &Resources<'_>,
    pass: &language::Pass,
    lowered: &Pass,
    (interface, variant): (&ShaderInterface, &Variant),
    shaders: &mut CheckedShaders<'_>,
    errors: &mut Vec<Diagnostic>,
) {
    let declared = |name: &str| interface.bindings.iter().any(|it| it.set == PASS_SET && *it.name == *name);
    let read = |sample: &&language::Sample| {
        let name = &sample.binding.text;
        let sampled = lowered.sampled.iter().find(|sampled| sampled.binding == *name);
        // Depth and single samples are read from memory on every device.
        sampled.is_some_and(|sampled| {
            let image = resources.image(sampled.image);
            let color = image.is_some_and(|image| !image.image.format.is_depth());
            sampled.own_pixel && sampled.face == Face::Resolved && color && declared(name)
        })
    };
    let own: Vec<&language::Sample> = pass.sample.iter().filter(read).collect();
    if own.is_empty() {
        return;
    }
    let local = own.iter().map(|sample| sample.binding.text.clone()).collect();
    let variant = Variant { local, ..variant.clone() };
    let Some(local) = shaders.interface(pass, &variant, errors) else { return };
    let shader = pass.shader().map_or("", |shader| &*shader.text);
    for sample in own {
        let name = &sample.binding.text;
        let reads = local
            .bindings
            .iter()
            .any(|binding| binding.set == PASS_SET && *binding.name == **name && binding.kind.is_input_attachment());
        if !reads {
            let span = sample.own_pixel.map_or(sample.part.image.span, |own| own.span);
            let message = format!(
                "`{name}` is read at the fragment's own position, but shader `{shader}` can't read it as an input attachment"
            );
            let help = format!(
                "declare it `subpassInput` where `LOCAL_READ_{name}` is defined, as it is on devices with local reads; or \
                 leave `own_pixel` out"
            );
            errors.push(Diagnostic::new(Code::OWN_PIXEL, span, message).help(help));
        }
    }
}
