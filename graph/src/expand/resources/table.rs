//! Images and buffers of the frame, each from its declaration and the image or buffer that it follows.

use super::follow::{follow, follow_all};
use super::{fills, images, states};
use crate::base::{Code, Diagnostic, Span};
use crate::expand::inputs::Inputs;
use crate::expand::mistakes::{ReportedMistakes, used_here};
use crate::frame::{Buffer, BufferIndex, ImageIndex, Lifetime, Resource};
use crate::language::{self, Bytes, LARGEST_BUFFER, Lifetime as Described, Part, Pipeline};
use crate::ron::{Name, Spanned};
use crate::vulkan::states::{StateTime, Subject};
use crate::vulkan::{Format, State};
use std::sync::Arc;

/// The pipeline at hand, with everything that passes name; `None` where a mistake was reported.
pub(in crate::expand) struct Resources<'a> {
    pub(in crate::expand) pipeline: &'a Pipeline,
    pub(in crate::expand) images: Vec<Option<images::FrameImage>>,
    pub(in crate::expand) buffers: Vec<Option<Buffer>>,
}

impl<'a> Resources<'a> {
    /// Resolves all of them, for a frame with these inputs. Each mistake in a repeated declaration is told once.
    pub(in crate::expand) fn resolve(
        pipeline: &'a Pipeline,
        inputs: &Inputs<'_>,
        reported: &mut ReportedMistakes,
        errors: &mut Vec<Diagnostic>,
    ) -> Resources<'a> {
        let output = inputs.window.unwrap_or(Format::R8G8B8A8_SRGB);
        let mut images = images::resolve(pipeline, inputs.output_extent, output, (reported, errors));
        let lifetimes = lifetimes(pipeline);
        let (of_images, of_buffers) = lifetimes.split_at(images.len());
        for ((image, described), kept) in images.iter_mut().zip(&pipeline.images).zip(of_images) {
            if let Some(resolved) = image {
                let (format, samples) = (Some(resolved.image.format), resolved.image.samples);
                let subject = Subject { name: &described.name.text, format, samples };
                let before = errors.len();
                match lifetime(described.lifetime.span, *kept, subject, errors) {
                    Some(lifetime) => resolved.image.lifetime = lifetime,
                    None => *image = None,
                }
                reported.once(errors, before);
                used_here(pipeline, described.instance, &mut errors[before..]);
            }
        }
        let mut sizes = vec![None; pipeline.buffers.len()];
        let buffers = &pipeline.buffers;
        let buffers = buffers.iter().enumerate().map(|(at, buffer)| {
            let before = errors.len();
            let next = |buffer: &language::Buffer| match buffer.bytes.value {
                Bytes::Like(of) => Some(of.index.0 as usize),
                _ => None,
            };
            let bytes =
                follow(buffers, &mut sizes, at, next, |buffer, followed| bytes(&images, buffer, followed, errors));
            let subject = Subject { name: &buffer.name.text, format: None, samples: 1 };
            let lifetime = lifetime(buffer.lifetime.span, of_buffers[at], subject, errors);
            reported.once(errors, before);
            used_here(pipeline, buffer.instance, &mut errors[before..]);
            let (name, span) = (buffer.name.text.clone(), buffer.name.span);
            Some(Buffer { name, span, bytes: bytes?, lifetime: lifetime? })
        });
        let buffers = buffers.collect();
        Resources { pipeline, images, buffers }
    }

    /// The declaration of an image in the file.
    pub(in crate::expand) fn declared(&self, index: ImageIndex) -> &'a language::Image {
        &self.pipeline.images[index.0 as usize]
    }

    /// The name of an image or buffer.
    pub(in crate::expand) fn name(&self, of: Resource) -> &'a Name {
        match of {
            Resource::Image(index) => &self.pipeline.images[index.0 as usize].name,
            Resource::Buffer(index) => &self.pipeline.buffers[index.0 as usize].name,
        }
    }

    /// The image, if it could be resolved.
    pub(in crate::expand) fn image(&self, index: ImageIndex) -> Option<&images::FrameImage> {
        self.images.get(index.0 as usize)?.as_ref()
    }

    /// What of an image or buffer a part of it is.
    pub(in crate::expand) fn filled(&self, part: &Part) -> fills::FillSubject {
        let Part::Image(part) = part else { return None };
        let format = self.image(part.image.index)?.image.format;
        Some((format, part.plane.map_or(format.aspects(), |plane| plane.value)))
    }

    /// Reports a buffer that is too small for the bytes that are read there.
    pub(in crate::expand) fn holds(
        &self,
        buffer: &language::BufferRef,
        bytes: u64,
        what: &str,
        span: Span,
        errors: &mut Vec<Diagnostic>,
    ) {
        let Some(there) = self.buffer(buffer.index) else { return };
        if there.bytes < bytes {
            let message = format!("`{}` has {} bytes; {what} take {bytes}", there.name, there.bytes);
            errors.push(Diagnostic::new(Code::BUFFER_SIZE_UNFIT, span, message).label(there.span, "declared here"));
        }
    }

    /// The buffer, if it could be resolved.
    pub(in crate::expand) fn buffer(&self, index: BufferIndex) -> Option<&Buffer> {
        self.buffers.get(index.0 as usize)?.as_ref()
    }

    /// The state in which an output is to be left, if nothing contradicts it.
    pub(in crate::expand) fn left(
        &self,
        of: Resource,
        after: Spanned<language::State>,
        errors: &mut Vec<Diagnostic>,
    ) -> Option<State> {
        let image = match of {
            Resource::Image(index) => Some(&self.image(index)?.image),
            Resource::Buffer(_) => None,
        };
        let (format, samples) = (image.map(|image| image.format), image.map_or(1, |image| image.samples));
        let name = self.name(of);
        let lowered = states::lower(after, Subject { name: &name.text, format, samples }, StateTime::After, errors)?;
        if let Some(Lifetime::Imported { after: Some(promised), .. }) = self.lifetime(of)
            && *promised != lowered
        {
            let message = format!("`{}` is to be left in two states", name.text);
            let wrong = Diagnostic::new(Code::TWO_STATES, after.span, message).remark("one is asked for here");
            errors.push(wrong.label(name.span, "the other where it is imported").help("leave one of them out"));
            return None;
        }
        Some(lowered)
    }

    /// How long the contents of an image or buffer live.
    pub(in crate::expand) fn lifetime(&self, of: Resource) -> Option<&Lifetime> {
        match of {
            Resource::Image(index) => self.image(index).map(|image| &image.image.lifetime),
            Resource::Buffer(index) => self.buffer(index).map(|buffer| &buffer.lifetime),
        }
    }
}

/// The size of a buffer.
fn bytes(
    images: &[Option<images::FrameImage>],
    buffer: &language::Buffer,
    followed: Option<u64>,
    errors: &mut Vec<Diagnostic>,
) -> Option<u64> {
    let (bytes, because) = match buffer.bytes.value {
        Bytes::Count(bytes) => (bytes.checked_next_multiple_of(4), format!("{bytes} bytes")),
        Bytes::Times(each, count) => {
            let because = buffer.bytes.because.as_ref().map(|because| format!(" ({because})")).unwrap_or_default();
            (each.checked_mul(count), format!("{each} bytes times {count}{because}"))
        }
        Bytes::PerTexel(each, of) => {
            let image = &images[of.index.0 as usize].as_ref()?.image;
            let [width, height, depth] = image.extent.map(u64::from);
            let texels = width * height * depth * u64::from(image.layers);
            (each.checked_mul(texels), format!("{each} bytes times {texels} texels of `{}`", image.name))
        }
        Bytes::Like(_) => return followed,
    };
    let most = LARGEST_BUFFER.unsigned_abs();
    let rounded = bytes.and_then(|bytes| bytes.checked_next_multiple_of(4)).filter(|bytes| *bytes <= most);
    if rounded.is_none() {
        let message = format!("buffer `{}` would be too large: {most} bytes are allowed", buffer.name.text);
        errors.push(Diagnostic::new(Code::BUFFER_SIZE, buffer.bytes.span, message).remark(because));
    }
    rounded
}

/// The lifetime in the file of each image, then of each buffer: its own, or that of the image or buffer that it follows.
fn lifetimes(Pipeline { images, buffers, .. }: &Pipeline) -> Vec<Option<&Spanned<Described>>> {
    let of_images = images.iter().map(|image| &image.lifetime);
    let all: Vec<_> = of_images.chain(buffers.iter().map(|buffer| &buffer.lifetime)).collect();
    let next = |lifetime: &&Spanned<Described>| match &lifetime.value {
        Described::Like(of) => Some(match of.resource {
            Resource::Image(index) => index.0 as usize,
            Resource::Buffer(index) => images.len() + index.0 as usize,
        }),
        _ => None,
    };
    follow_all(&all, next, |own, followed| followed.or(Some(*own)))
}

/// The lifetime that is declared at `own`; `kept` is the lifetime that it follows in the end.
fn lifetime(
    own: Span,
    kept: Option<&Spanned<Described>>,
    of: Subject<'_>,
    errors: &mut Vec<Diagnostic>,
) -> Option<Lifetime> {
    let value = kept?;
    // A mistake in a followed lifetime is shown at the follower, too: the lifetime may mean something else there.
    let here = |span: Span| if value.span == own { span } else { own };
    let initial = |fill: Option<Spanned<language::Fill>>, errors: &mut Vec<Diagnostic>| {
        let Some(fill) = fill else { return Some(fills::zero(of.format)) };
        match fills::typed(fill.value, of.format.map(|format| (format, format.aspects()))) {
            Ok(value) => Some(value),
            Err((message, help)) => {
                let message = format!("`{}` can't begin like this: {message}", of.name);
                errors.push(Diagnostic::new(Code::FILL_UNFIT, here(fill.span), message).help(help));
                None
            }
        }
    };
    Some(match &value.value {
        Described::Transient | Described::Like(_) => Lifetime::Transient,
        Described::Persistent { initial: fill } => Lifetime::Persistent { initial: initial(*fill, errors)? },
        Described::History { frames, initial: fill } => {
            Lifetime::History { frames: *frames, initial: initial(*fill, errors)? }
        }
        Described::Imported { before, after, owner } => {
            let state = |state: Spanned<language::State>, when, errors: &mut Vec<Diagnostic>| {
                states::lower(Spanned { span: here(state.span), ..state }, of, when, errors)
            };
            let before = state(*before, StateTime::Before, errors);
            let after = match after {
                Some(after) => state(*after, StateTime::After, errors).map(Some),
                None => Some(None),
            };
            Lifetime::Imported { before: before?, after: after?, owner: *owner }
        }
        Described::File(file) if value.span == own => Lifetime::File(Arc::clone(file)),
        Described::File(_) => {
            let message = format!("`{}` can't live like a texture: its contents come from no file", of.name);
            errors.push(Diagnostic::new(Code::LIFETIME, own, message).label(value.span, "the texture's file"));
            return None;
        }
    })
}
