//! Demands of passes on the formats of images, and the support of a device for formats.

use crate::device::{FormatSupport, Profile};
use crate::frame::{Access, Blend, Frame, ImageIndex, Lifetime, Pass, Resource, VisitAccess};
use crate::vulkan::{Format, Shape, State, Usage};

/// Support of a device for each format, indexed by format.
pub(crate) struct Supports<'d> {
    pub(super) device: &'d Profile,
    of: [Option<&'d FormatSupport>; Format::ALL.len()],
}

impl<'d> Supports<'d> {
    pub(super) fn new(device: &'d Profile) -> Supports<'d> {
        let mut of = [None; Format::ALL.len()];
        // Backwards, so that the first of several entries counts.
        device.formats.iter().rev().for_each(|support| of[support.format as usize] = Some(support));
        let lacks =
            |support: &mut &FormatSupport| support.format.feature().is_some_and(|feature| !device.has_feature(feature));
        of.iter_mut().for_each(|support| _ = support.take_if(lacks));
        Supports { device, of }
    }

    pub(super) fn of(&self, format: Format) -> Option<&'d FormatSupport> {
        self.of[format as usize]
    }

    /// The support for images of a format and shape. Three-dimensional ones in blocks are certain only of BC (Vulkan,
    /// `VkPhysicalDeviceFeatures`).
    pub(super) fn of_shape(&self, format: Format, shape: Shape) -> Option<&'d FormatSupport> {
        let is_odd = shape == Shape::D3 && format.feature().is_some_and(|feature| feature != "textureCompressionBC");
        self.of(format).filter(|_| !is_odd)
    }
}

/// Demands on an image's format: from passes, and from the states in which the image comes and goes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Needs {
    pub(super) usage: Usage,
    pub(super) linear_filter: bool,
    pub(super) blend: bool,
}

impl Needs {
    /// The needs of each image of a frame.
    pub(super) fn of<'f>(frame: &'f Frame, passes: impl Iterator<Item = &'f Pass>) -> Vec<Needs> {
        let mut needs = vec![Needs::default(); frame.images.len()];
        for pass in passes {
            pass.visit_accesses(&mut AddNeeds(&mut needs));
            if let Some([from, to]) = pass.work.forwarded()
                && is_drawn(frame, from, to)
            {
                needs[from.0 as usize].usage |= Usage::SAMPLED;
                needs[to.0 as usize].usage |= Usage::COLOR_ATTACHMENT;
            }
        }
        note_states(frame, &mut needs);
        needs
    }

    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    fn add(&mut self, access: Access<'_>) {
        self.usage |= match access {
            Access::Sampled(_) => Usage::SAMPLED,
            Access::Storage(_) => Usage::STORAGE,
            Access::Color(_) => Usage::COLOR_ATTACHMENT,
            Access::Depth(_) => Usage::DEPTH_STENCIL_ATTACHMENT,
            Access::Transfer(used) if used.write => Usage::TRANSFER_DST,
            Access::Transfer(_) => Usage::TRANSFER_SRC,
            Access::Buffer(_) | Access::ForwardSource(..) | Access::ForwardTarget(..) => Usage::empty(),
        };
        self.linear_filter |= matches!(access, Access::Sampled(sampled) if sampled.sampler.is_linear());
        self.blend |= matches!(access, Access::Color(target) if target.blend != Blend::Replace);
    }

    /// Whether a format with this support does.
    pub(super) fn are_met(self, support: Option<&FormatSupport>) -> bool {
        match support {
            None => self.usage.is_empty(),
            Some(support) => {
                support.usage.contains(self.usage)
                    && (support.linear_filter || !self.linear_filter)
                    && (support.blend || !self.blend)
            }
        }
    }

    /// The features that a format with this support lacks, in words.
    pub(super) fn missing(self, support: Option<&FormatSupport>) -> String {
        let usage = support.map_or(Usage::empty(), |support| support.usage);
        let mut missing: Vec<&str> = self.usage.difference(usage).iter_names().map(|(name, _)| name).collect();
        if let Some(support) = support {
            missing.extend((self.linear_filter && !support.linear_filter).then_some("linear filtering"));
            missing.extend((self.blend && !support.blend).then_some("blending"));
        }
        missing.join(", ")
    }
}

/// Adds the needs of accesses to those of each image.
struct AddNeeds<'n>(&'n mut [Needs]);

impl VisitAccess<'_> for AddNeeds<'_> {
    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    fn visit(&mut self, access: Access<'_>) {
        if let Resource::Image(image) = access.resource() {
            self.0[image.0 as usize].add(access);
        }
    }
}

/// Whether a forwarded image has to be drawn into its target.
fn is_drawn(frame: &Frame, from: ImageIndex, to: ImageIndex) -> bool {
    let shape = |image: ImageIndex| {
        let image = &frame.images[image.0 as usize];
        (image.format, image.extent, image.allocated, image.eyes)
    };
    shape(from) != shape(to)
}

/// Adds the needs of the images in use for the states in which they come and go.
fn note_states(frame: &Frame, needs: &mut [Needs]) {
    let mut add = |image: usize, state: &State| {
        if !needs[image].usage.is_empty() {
            needs[image].usage |= state.layout.usage();
        }
    };
    for (number, image) in frame.images.iter().enumerate() {
        if let Lifetime::Imported { before, after, .. } = &image.lifetime {
            add(number, before);
            after.iter().for_each(|after| add(number, after));
        }
    }
    for output in &frame.outputs {
        if let (Resource::Image(image), Some(after)) = (output.resource, &output.after) {
            add(image.0 as usize, after);
        }
    }
}
