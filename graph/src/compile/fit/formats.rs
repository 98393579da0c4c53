//! Format fallback: where the device can't use a format as the frame does, another one that holds at least as much.
//!
//! A format that the pipeline chose by a policy is replaced by the format that it would have without the policy. Any other
//! format is replaced only if nothing outside of the frame sees the image, and no shader or program is told the layout of
//! its texels. So imported images, outputs and storage images keep their formats, and so do images that are copied to or
//! from buffers or by custom passes. A texture in a compressed format is decoded when it is loaded. An output that is encoded
//! for HDR10 may have 16 bits instead of 10.

use super::needs::{Needs, Supports};
use crate::device::Profile;
use crate::frame::{Frame, Image, ImageIndex, Lifetime, Pass, Resource};
use crate::plan::{Note, NoteKind};
use crate::vulkan::Format::{self, *};
use crate::vulkan::{ColorComponents, Encoding};
use petgraph::unionfind::UnionFind;
use std::collections::BTreeMap;

/// Formats that hold all that a format holds, the smallest first. Fixed-point colour that becomes floating-point isn't
/// clamped to 0 to 1 any more, and a format without alpha gains one; the note says so.
fn substitutes(format: Format) -> &'static [Format] {
    match format {
        R8G8B8A8_UNORM => &[B8G8R8A8_UNORM],
        B8G8R8A8_UNORM => &[R8G8B8A8_UNORM],
        R8G8B8A8_SRGB => &[B8G8R8A8_SRGB],
        B8G8R8A8_SRGB => &[R8G8B8A8_SRGB],
        A2R10G10B10_UNORM_PACK32 => &[A2B10G10R10_UNORM_PACK32, R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT],
        A2B10G10R10_UNORM_PACK32 => &[R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT],
        B10G11R11_UFLOAT_PACK32 | E5B9G9R9_UFLOAT_PACK32 => &[R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT],
        R16_UNORM | R16_SNORM | R16_SFLOAT => &[R32_SFLOAT],
        R16G16_UNORM | R16G16_SNORM | R16G16_SFLOAT => &[R32G32_SFLOAT],
        R8_SNORM => &[R16_SFLOAT, R32_SFLOAT],
        R8G8_SNORM => &[R16G16_SFLOAT, R32G32_SFLOAT],
        R8G8B8A8_SNORM => &[R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT],
        R16G16B16A16_UNORM | R16G16B16A16_SNORM | R16G16B16A16_SFLOAT => &[R32G32B32A32_SFLOAT],
        D16_UNORM => &[X8_D24_UNORM_PACK32, D32_SFLOAT],
        X8_D24_UNORM_PACK32 => &[D32_SFLOAT],
        D24_UNORM_S8_UINT => &[D32_SFLOAT_S8_UINT],
        R8_UINT | R8_SINT => &[],
        R8G8_UINT | R8G8_SINT | R8G8B8A8_UINT | R8G8B8A8_SINT => &[],
        R16_UINT | R16_SINT | R16G16_UINT | R16G16_SINT | R16G16B16A16_UINT | R16G16B16A16_SINT => &[],
        R32_UINT | R32_SINT | R32G32_UINT | R32G32_SINT | R32G32B32A32_UINT | R32G32B32A32_SINT => &[],
        R8_UNORM | R8G8_UNORM | R32_SFLOAT | R32G32_SFLOAT | R32G32B32A32_SFLOAT => &[],
        D32_SFLOAT | D32_SFLOAT_S8_UINT => &[],
        // `decoded` names the one that holds them.
        _compressed => &[],
    }
}

/// Formats that hold HDR10 as well as `format` does.
fn hdr10_substitutes(format: Format) -> &'static [Format] {
    if format == A2B10G10R10_UNORM_PACK32 { &[R16G16B16A16_UNORM] } else { &[] }
}

/// Formats in place of one that a policy chose: its substitutes, up to and with the usual format.
fn up_to(chosen: Format, usual: Format) -> Vec<Format> {
    let larger = substitutes(chosen);
    let last = larger.iter().position(|format| *format == usual).unwrap_or(0);
    larger[..last].iter().copied().chain([usual]).collect()
}

/// Demands of a frame on the formats of its images, and other formats where the device lacks those.
pub(crate) struct Formats<'d> {
    pub(crate) supports: Supports<'d>,
    /// The needs of each image, in the formats that are taken.
    pub(super) needs: Vec<Needs>,
    /// Whether the device has all that the images need of their formats.
    pub(super) are_met: bool,
    /// The frame with other formats, if it takes any.
    pub(crate) substitute: Option<Frame>,
    /// One for each other format.
    pub(crate) notes: Vec<Note>,
}

impl Formats<'_> {
    /// The frame with the formats that are taken.
    pub(crate) fn frame<'f>(&'f self, asked: &'f Frame) -> &'f Frame {
        self.substitute.as_ref().unwrap_or(asked)
    }
}

/// Finds substitutes for formats that the device can't use as the passes `live` do. Without a substitute the frame's own
/// format stays, to be refused.
pub(crate) fn formats<'d>(frame: &Frame, live: &[u32], device: &'d Profile) -> Formats<'d> {
    let supports = Supports::new(device);
    let passes = || live.iter().map(|pass| &frame.passes[*pass as usize]);
    let needs = Needs::of(frame, passes());
    if are_met(frame, &needs, &supports) {
        return Formats { supports, needs, are_met: true, substitute: None, notes: Vec::new() };
    }
    match fall_back(frame, live, &needs, &supports) {
        None => Formats { supports, needs, are_met: false, substitute: None, notes: Vec::new() },
        Some((substitute, notes)) => {
            let needs = Needs::of(&substitute, live.iter().map(|pass| &substitute.passes[*pass as usize]));
            let are_met = are_met(&substitute, &needs, &supports);
            Formats { supports, needs, are_met, substitute: Some(substitute), notes }
        }
    }
}

fn are_met(frame: &Frame, needs: &[Needs], supports: &Supports<'_>) -> bool {
    let of = |image: &Image| supports.of_shape(image.format, image.shape);
    frame.images.iter().zip(needs).all(|(image, needs)| needs.are_met(of(image)))
}

/// The frame with other formats, and a note for each; `None` if there is no substitute.
fn fall_back(frame: &Frame, live: &[u32], needs: &[Needs], supports: &Supports<'_>) -> Option<(Frame, Vec<Note>)> {
    let passes = || live.iter().map(|pass| &frame.passes[*pass as usize]);
    let fixed = fixed(frame, passes());
    let mut alike = UnionFind::<u32>::new(frame.images.len());
    passes().filter_map(|pass| alike_in(frame, pass)).for_each(|[one, other]| {
        alike.union(one, other);
    });
    let mut substitute = frame.clone();
    let mut notes = Vec::new();
    let mut groups: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    (0..frame.images.len()).for_each(|image| groups.entry(alike.find(image as u32)).or_default().push(image));
    let mut made: Vec<Option<(Format, String)>> = vec![None; frame.images.len()];
    for group in groups.values() {
        // Images that are copied texel for texel share one format.
        let format = frame.images[group[0]].format;
        let shape = |image: &usize| frame.images[*image].shape;
        let lacks = |format: Format, image: &usize| !needs[*image].are_met(supports.of_shape(format, shape(image)));
        let Some(first) = group.iter().find(|image| lacks(format, image)) else { continue };
        let usual = group.iter().find_map(|image| frame.images[*image].chosen.as_ref()).map(|chosen| chosen.usual);
        if usual.is_none() && group.iter().any(|image| fixed[*image]) {
            return None;
        }
        let fits = |format: &Format| !group.iter().any(|image| lacks(*format, image));
        let hdr10 = group.iter().any(|image| is_hdr10(frame, *image));
        let substitutes = match usual {
            Some(usual) => up_to(format, usual),
            None if hdr10 => hdr10_substitutes(format).to_vec(),
            None => format.decoded().into_iter().chain(substitutes(format).iter().copied()).collect(),
        };
        let other = substitutes.into_iter().find(fits)?;
        let missing = needs[*first].missing(supports.of_shape(format, shape(first)));
        group.iter().for_each(|image| made[*image] = Some((other, missing.clone())));
    }
    for (number, made) in made.into_iter().enumerate() {
        let Some((format, missing)) = made else { continue };
        let image = &mut substitute.images[number];
        // A pass that writes all channels of the format writes those that the other one has more.
        let all = ColorComponents::first(image.format.components());
        image.format = format;
        let targets = substitute.passes.iter_mut().flat_map(|pass| &mut pass.color);
        let whole = targets.filter(|target| target.image.0 as usize == number && target.write_mask.contains(all));
        whole.for_each(|target| target.write_mask = ColorComponents::RGBA);
        image.chosen.take_if(|chosen| chosen.usual == format);
        notes.push(note(frame, number, format, &format!("`{}` has no {missing} for it", supports.device.name)));
    }
    (!notes.is_empty()).then_some((substitute, notes))
}

/// By image, whether the embedding program, a shader or a copy relies on its very format. An output in HDR10 may have either of
/// two formats, and the Plan says which it is.
fn fixed<'f>(frame: &Frame, passes: impl Iterator<Item = &'f Pass>) -> Vec<bool> {
    let imported = |image: &Image| matches!(image.lifetime, Lifetime::Imported { .. });
    let mut fixed: Vec<bool> = frame.images.iter().map(imported).collect();
    let outputs = frame.outputs.iter().filter(|output| output.encoding != Some(Encoding::Hdr10));
    let format = |image: ImageIndex| frame.images.get(image.0 as usize).map(|image| image.format);
    let relied = passes.flat_map(|pass| pass.accesses().filter(|access| pass.relies_on_format(access, format)));
    for resource in outputs.map(|output| output.resource).chain(relied.map(|access| access.resource())) {
        if let Resource::Image(image) = resource {
            fixed[image.0 as usize] = true;
        }
    }
    fixed
}

/// Whether an image leaves the frame as HDR10.
fn is_hdr10(frame: &Frame, image: usize) -> bool {
    let image = Resource::Image(ImageIndex(image as u32));
    frame.outputs.iter().any(|output| output.resource == image && output.encoding == Some(Encoding::Hdr10))
}

/// Two images of which a pass copies one into the other texel for texel.
fn alike_in(frame: &Frame, pass: &Pass) -> Option<[u32; 2]> {
    let pair = pass.moved_images()?;
    let [one, other] = pair.map(|image| frame.images[image.0 as usize].format);
    (one == other).then(|| pair.map(|image| image.0))
}

fn note(frame: &Frame, image: usize, made: Format, why: &str) -> Note {
    let declared = &frame.images[image];
    let gains = match declared.format {
        A2R10G10B10_UNORM_PACK32 if made == A2B10G10R10_UNORM_PACK32 => "",
        A2R10G10B10_UNORM_PACK32 => "; values outside of 0 to 1 are kept",
        A2B10G10R10_UNORM_PACK32 if made != R16G16B16A16_UNORM => "; values outside of 0 to 1 are kept",
        _ if declared.format.is_compressed() => "; the file's texels are decoded",
        B10G11R11_UFLOAT_PACK32 | E5B9G9R9_UFLOAT_PACK32 => "; it has an alpha, and negative values are kept",
        _ => "",
    };
    let text = format!("{} was asked for, {made} is made: {why}{gains}", declared.format);
    Note::new(NoteKind::OtherFormat, declared.name.clone(), text, frame.sources.place(declared.span))
}
