//! Which images a saved profile knows the memory needs of: the usual formats, sizes, sample counts and usages.

use super::{FormatSupport, ImageDescriptor, KnownNeeds, MemoryNeeds, MemoryProvider, Profile};
use crate::vulkan::{Shape, Sharing, Usage};

/// Sizes of screens and shadow maps, rising.
const SIZES: [[u32; 2]; 9] = [
    [256, 256],
    [512, 512],
    [1024, 1024],
    [1280, 720],
    [1920, 1080],
    [2048, 2048],
    [2560, 1440],
    [3840, 2160],
    [4096, 4096],
];

/// Usages that frames usually give images: drawn and sampled, drawn and read back, drawn and forgotten within a rendering
/// scope, written by compute passes, filled and sampled.
const USAGES: [Usage; 13] = [
    Usage::COLOR_ATTACHMENT,
    Usage::COLOR_ATTACHMENT.union(Usage::SAMPLED),
    Usage::COLOR_ATTACHMENT.union(Usage::TRANSFER_SRC),
    Usage::COLOR_ATTACHMENT.union(Usage::SAMPLED).union(Usage::TRANSFER_SRC),
    Usage::COLOR_ATTACHMENT.union(Usage::TRANSIENT_ATTACHMENT),
    Usage::DEPTH_STENCIL_ATTACHMENT,
    Usage::DEPTH_STENCIL_ATTACHMENT.union(Usage::SAMPLED),
    Usage::DEPTH_STENCIL_ATTACHMENT.union(Usage::SAMPLED).union(Usage::TRANSFER_SRC),
    Usage::DEPTH_STENCIL_ATTACHMENT.union(Usage::TRANSIENT_ATTACHMENT),
    Usage::SAMPLED.union(Usage::STORAGE),
    Usage::SAMPLED.union(Usage::STORAGE).union(Usage::TRANSFER_SRC),
    Usage::STORAGE.union(Usage::TRANSFER_SRC),
    Usage::SAMPLED.union(Usage::TRANSFER_DST),
];

/// Memory needs of the usual images, as `memory` says them; images that the device can't make are left out.
fn needs(formats: &[FormatSupport], largest: u32, memory: &mut dyn MemoryProvider) -> Vec<KnownNeeds> {
    let mut all = Vec::new();
    // Compressed images lie in no heap, since they outlive the frame.
    for support in formats.iter().filter(|support| !support.format.is_compressed()) {
        let single = if support.samples.is_empty() { &[1][..] } else { &support.samples };
        for samples in single {
            let from = all.len();
            for usage in USAGES.into_iter().filter(|usage| possible(support, *samples, *usage)) {
                let sizes = sizes(support, *samples, usage, largest, memory);
                let alike = all[from..].iter_mut().find(|known: &&mut KnownNeeds| known.sizes == sizes);
                match alike {
                    Some(known) => known.usages.push(usage),
                    None if sizes.is_empty() => {}
                    None => {
                        let (format, samples) = (support.format, *samples);
                        all.push(KnownNeeds { format, samples, usages: vec![usage], sizes });
                    }
                }
            }
        }
    }
    all.sort_by_key(|known| (known.format, known.samples));
    all
}

/// Storage images and images that are filled have one sample.
fn possible(support: &FormatSupport, samples: u32, usage: Usage) -> bool {
    support.usage.contains(usage) && (samples == 1 || !usage.intersects(Usage::STORAGE | Usage::TRANSFER_DST))
}

fn sizes(
    support: &FormatSupport,
    samples: u32,
    usage: Usage,
    largest: u32,
    memory: &mut dyn MemoryProvider,
) -> Vec<([u32; 2], MemoryNeeds)> {
    let within = SIZES.into_iter().filter(|size| size[0].max(size[1]) <= largest);
    let needs = within.map(|[width, height]| {
        let descriptor = ImageDescriptor {
            format: support.format,
            shape: Shape::D2,
            extent: [width, height, 1],
            mips: 1,
            layers: 1,
            samples,
            usage,
            sharing: Sharing::Exclusive,
        };
        ([width, height], memory.image(&descriptor))
    });
    needs.filter(|(_, needs)| needs.bytes < u64::MAX).collect()
}

impl Profile {
    /// The profile with the memory needs of the usual images added, as `memory` says them. Such a profile is enough to plan
    /// for the device without the device at hand.
    #[must_use]
    pub fn with_usual_needs(mut self, memory: &mut dyn MemoryProvider) -> Profile {
        self.known_needs = needs(&self.formats, self.max_attachment_extent, memory);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{MemoryEstimate, Profile, SHIPPED_PROFILES};

    #[test]
    fn sizes_rise() {
        assert!(SIZES.is_sorted());
    }

    #[test]
    fn usual_needs_are_those_of_the_device_and_what_it_can_not_make_is_left_out() {
        for (name, text) in SHIPPED_PROFILES {
            let profile = Profile::from_ron(text).expect("a profile");
            let bare = Profile { known_needs: Vec::new(), ..profile };
            let known = bare.clone().with_usual_needs(&mut MemoryEstimate(&bare));
            // Formats that are attachments have several sample counts.
            let attachments = known.formats.iter().filter(|support| !support.samples.is_empty()).count();
            let plain = known.formats.iter().filter(|support| !support.format.is_compressed()).count();
            assert!(known.known_needs.len() >= plain + attachments, "{name}");
            for needs in &known.known_needs {
                let support = bare.format(needs.format).expect("supported");
                assert!(needs.samples == 1 || support.samples.contains(&needs.samples), "{name}: {needs:?}");
                assert!(needs.usages.iter().all(|usage| support.usage.contains(*usage)), "{name}: {needs:?}");
            }
            let text = known.to_ron().expect("written");
            assert_eq!(Profile::from_ron(&text), Ok(known), "{name}: what is saved is read back as sound");
        }
    }
}
