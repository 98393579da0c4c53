//! Passes of the frame: targets that fit each other, and what the shader is given.

use super::images::Resolved;
use super::shader::{self, Checked};
use super::{Chosen, params, supplied};
use crate::describe::{self, Diagnostic, ImageRef};
use crate::frame::{Blend, ColorTarget, DepthTarget, Pass, Work};
use crate::vocabulary::Subresources;

/// The pass as it runs. `None` if its shader can't be had; mistakes were reported then.
pub(super) fn lower(
    chosen: &Chosen<'_>,
    images: &[Option<Resolved>],
    pass: &describe::Pass,
    shaders: &mut Checked<'_>,
    errors: &mut Vec<Diagnostic>,
) -> Option<Pass> {
    let interface = shaders.interface(pass, errors)?;
    supplied::check(shaders, pass, &interface, errors);
    let sampled = shader::sampled(chosen, images, pass, &interface, errors);
    let params = params::give(chosen, pass, &interface, errors);
    shader::outputs(images, pass, &interface, errors);
    let work = Work::Draw {
        draw: pass.draw,
        shader: pass.shader.text.clone(),
        discards: interface.discards,
        per_sample: interface.per_sample,
    };
    Some(Pass {
        span: pass.name.span,
        sampled,
        color: pass
            .color
            .iter()
            .map(|target| ColorTarget {
                image: target.image.index,
                range: Subresources::WHOLE,
                span: target.image.span,
                clear: target.clear,
                blend: target.blend.value,
            })
            .collect(),
        depth: pass.depth.as_ref().map(|target| DepthTarget {
            image: target.image.index,
            range: Subresources::WHOLE,
            span: target.image.span,
            clear: target.clear,
            test: target.test,
            write: target.write,
            stencil: None,
        }),
        params,
        ..Pass::new(&pass.name.text, work)
    })
}

/// What runs in place of a pass that is off, if its target must be filled all the same.
pub(super) fn stand_in(pass: &describe::Pass, because: String) -> Option<Pass> {
    let forward = pass.otherwise?;
    let work = Work::Forward { from: forward.from.index, to: forward.to.index, because };
    Some(Pass { span: pass.name.span, ..Pass::new(&pass.name.text, work) })
}

/// Targets have formats that fit their use, and agree in size and sample count; a stand-in keeps to one kind of image.
pub(super) fn targets_fit(
    chosen: &Chosen<'_>,
    images: &[Option<Resolved>],
    pass: &describe::Pass,
    errors: &mut Vec<Diagnostic>,
) {
    let resolved = |image: ImageRef| images[image.index.0 as usize].as_ref();
    let declared = |image: ImageRef| chosen.image(image.index).format.span;
    for target in &pass.color {
        let Some(image) = resolved(target.image) else { continue };
        let format = image.image.format;
        if format.is_depth() {
            let message = format!("`{}` is a depth image ({format}) and can't be a colour target", image.image.name);
            errors.push(Diagnostic::new(target.image.span, message).label(declared(target.image), "its format"));
        } else if format.is_integer() && target.blend.value != Blend::Replace {
            let message = format!("`{}` holds integers ({format}), which can't be blended", image.image.name);
            errors.push(Diagnostic::new(target.blend.span, message).label(declared(target.image), "its format"));
        }
    }
    if let Some(target) = &pass.depth
        && let Some(image) = resolved(target.image)
        && !image.image.format.is_depth()
    {
        let message = format!("`{}` has no depth ({})", image.image.name, image.image.format);
        errors.push(Diagnostic::new(target.image.span, message).label(declared(target.image), "its format"));
    }
    agree(images, pass, errors);
    if let Some(forward) = pass.otherwise
        && let (Some(from), Some(to)) = (resolved(forward.from), resolved(forward.to))
        && kind(from) != kind(to)
    {
        let message = format!("`{}` can't take what `{}` holds", to.image.name, from.image.name);
        errors.push(
            Diagnostic::new(forward.from.span, message)
                .remark(format!("{} ({})", kind(from), from.image.format))
                .label(forward.to.span, format!("{} ({})", kind(to), to.image.format)),
        );
    }
}

/// What an image holds, in words.
fn kind(image: &Resolved) -> &'static str {
    match image.image.format {
        format if format.is_depth() => "depth",
        format if format.is_integer() => "integers",
        _ => "colour",
    }
}

/// All targets of a pass have one size and one sample count.
fn agree(images: &[Option<Resolved>], pass: &describe::Pass, errors: &mut Vec<Diagnostic>) {
    let targets = pass.color.iter().map(|target| target.image).chain(pass.depth.iter().map(|target| target.image));
    let mut resolved = targets.filter_map(|target| Some((target, images[target.index.0 as usize].as_ref()?)));
    let Some((first, with)) = resolved.next() else { return };
    for (target, image) in resolved {
        let (one, other) = (&with.image, &image.image);
        if one.extent != other.extent {
            let size = |image: &crate::frame::Image| format!("{}×{}", image.extent[0], image.extent[1]);
            let message = format!(
                "pass `{}` draws into images of different sizes: `{}` and `{}`",
                pass.name.text, one.name, other.name
            );
            errors.push(
                Diagnostic::new(target.span, message)
                    .remark(size(other))
                    .label(first.span, size(one))
                    .help(format!("let one follow the other: `size: Like(\"{}\")`", one.name)),
            );
        }
        if one.samples != other.samples {
            let message = format!(
                "pass `{}` draws into images with different sample counts: `{}` and `{}`",
                pass.name.text, one.name, other.name
            );
            errors.push(
                Diagnostic::new(target.span, message)
                    .remark(image.samples_words())
                    .label(first.span, with.samples_words())
                    .help(format!("let one follow the other: `samples: Like(\"{}\")`", one.name)),
            );
        }
    }
}

impl Resolved {
    /// How many samples, and why: "4 samples (msaa = 4)".
    pub(super) fn samples_words(&self) -> String {
        let samples = self.image.samples;
        let count = if samples == 1 { "1 sample".to_owned() } else { format!("{samples} samples") };
        match &self.samples_because {
            Some(because) => format!("{count} ({because})"),
            None => count,
        }
    }
}
