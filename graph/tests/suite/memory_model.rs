//! The estimates of memory needs: models say what devices said, and nothing overflows.

use framewright_graph::device::{
    BufferDescriptor, ImageDescriptor, KnownNeeds, MemoryEstimate, MemoryModel, MemoryNeeds, MemoryProvider, Profile,
    SHIPPED_PROFILES,
};
use framewright_graph::vulkan::{BufferUsage, Format, Shape, Sharing, Usage};

fn image(format: Format, extent: [u32; 3]) -> ImageDescriptor {
    let (usage, sharing) = (Usage::SAMPLED, Sharing::Exclusive);
    ImageDescriptor { format, shape: Shape::D2, extent, mips: 1, layers: 1, samples: 1, usage, sharing }
}

fn model() -> MemoryModel {
    MemoryModel {
        alignment: 16,
        row_texels: 4,
        row_bytes: 64,
        rows: 4,
        separate_stencil: false,
        buffer_alignment: 64,
        type_bits: 1,
        heap_bytes: None,
    }
}

/// Figures that lavapipe (Mesa 22.3.6) gave.
#[test]
fn the_model_with_rows_in_bytes_says_what_lavapipe_says() {
    let bytes = |image: ImageDescriptor| model().image(&image).bytes;
    assert_eq!(bytes(image(Format::R8_UNORM, [100, 50, 1])), 6656);
    assert_eq!(bytes(image(Format::R16G16B16A16_SFLOAT, [17, 17, 1])), 3840);
    assert_eq!(bytes(image(Format::R32G32B32A32_SFLOAT, [33, 1, 1])), 2304);
    assert_eq!(bytes(ImageDescriptor { mips: 4, ..image(Format::R8_UNORM, [100, 50, 1]) }), 9728);
    assert_eq!(bytes(ImageDescriptor { mips: 4, layers: 3, ..image(Format::R8_UNORM, [100, 50, 1]) }), 29184);
    assert_eq!(bytes(ImageDescriptor { samples: 4, ..image(Format::D32_SFLOAT_S8_UINT, [5, 5, 1]) }), 2048);
    assert_eq!(bytes(ImageDescriptor { shape: Shape::D3, ..image(Format::R8G8B8A8_UNORM, [10, 10, 10]) }), 7680);
}

/// Figures that SwiftShader (of Chromium) gave.
#[test]
fn the_model_with_rows_in_texels_and_stencil_apart_says_what_swiftshader_says() {
    let model = MemoryModel { row_texels: 2, row_bytes: 1, rows: 2, separate_stencil: true, ..model() };
    let bytes = |image: ImageDescriptor| model.image(&image).bytes;
    assert_eq!(bytes(image(Format::R8_UNORM, [17, 17, 1])), 336);
    assert_eq!(bytes(image(Format::R32G32B32A32_SFLOAT, [5, 5, 1])), 576);
    assert_eq!(bytes(ImageDescriptor { mips: 4, layers: 3, ..image(Format::R8_UNORM, [100, 50, 1]) }), 20160);
    assert_eq!(bytes(ImageDescriptor { samples: 4, ..image(Format::D32_SFLOAT_S8_UINT, [5, 5, 1]) }), 768);
    assert_eq!(bytes(ImageDescriptor { samples: 4, ..image(Format::R8_UNORM, [5, 5, 1]) }), 192);
}

/// A device that does what a model says.
struct Model(MemoryModel);

impl MemoryProvider for Model {
    fn exact(&self) -> bool {
        true
    }
    fn image(&mut self, descriptor: &ImageDescriptor) -> MemoryNeeds {
        self.0.image(descriptor)
    }
    fn buffer(&mut self, descriptor: &BufferDescriptor) -> MemoryNeeds {
        self.0.buffer(descriptor)
    }
}

#[test]
fn fitting_finds_the_model_that_a_device_follows() {
    let formats = &Profile::from_ron(SHIPPED_PROFILES[0].1).expect("a profile").formats;
    for row_texels in [1, 2, 64] {
        for rows in [1, 8, 128] {
            for separate_stencil in [false, true] {
                let followed = MemoryModel { row_texels, row_bytes: 1, rows, separate_stencil, ..model() };
                assert_eq!(MemoryModel::fitted(&mut Model(followed.clone()), formats), followed);
            }
        }
    }
    let bytes = MemoryModel { row_texels: 4, row_bytes: 64, alignment: 65536, ..model() };
    assert_eq!(MemoryModel::fitted(&mut Model(bytes.clone()), formats), bytes);
}

#[test]
fn no_image_and_no_model_overflow() {
    let largest = ImageDescriptor {
        mips: u32::MAX,
        layers: u32::MAX,
        samples: u32::MAX,
        ..image(Format::R32G32B32A32_SFLOAT, [u32::MAX; 3])
    };
    for figure in [0, 1, 3, u32::MAX] {
        let model = MemoryModel {
            alignment: if figure == u32::MAX { u64::MAX } else { figure.into() },
            row_texels: figure,
            row_bytes: figure,
            rows: figure,
            separate_stencil: true,
            buffer_alignment: if figure == u32::MAX { u64::MAX } else { figure.into() },
            type_bits: figure,
            heap_bytes: None,
        };
        let needs = model.image(&largest);
        assert!(needs.bytes >= 1 << 62 && needs.alignment.is_power_of_two(), "{figure}: {needs:?}");
        let buffer = BufferDescriptor { bytes: u64::MAX, usage: BufferUsage::all(), sharing: Sharing::Exclusive };
        assert!(model.buffer(&buffer).alignment.is_power_of_two());
    }
    let full = ImageDescriptor { samples: 16, ..image(Format::R32G32B32A32_SFLOAT, [16384, 16384, 1]) };
    assert_eq!(model().image(&full).bytes, 16 * 16 * 16384 * 16384);
}

#[test]
fn what_was_read_from_a_device_goes_before_the_model() {
    let mut profile = Profile::from_ron(SHIPPED_PROFILES[0].1).expect("a profile");
    let odd = image(Format::R8_UNORM, [1920, 1080, 1]);
    let read = MemoryNeeds { bytes: 12_345_678, alignment: 512, type_bits: 6 };
    profile.known_needs = vec![KnownNeeds {
        format: odd.format,
        samples: 1,
        usages: vec![Usage::STORAGE, odd.usage],
        sizes: vec![([1280, 720], read), ([1920, 1080], read)],
    }];
    let modelled = profile.memory.image(&odd);
    let mut estimated = MemoryEstimate(&profile);
    assert_eq!(estimated.image(&odd), read);
    for other in [
        ImageDescriptor { samples: 4, ..odd },
        ImageDescriptor { usage: Usage::COLOR_ATTACHMENT, ..odd },
        ImageDescriptor { sharing: Sharing::Concurrent, ..odd },
        ImageDescriptor { mips: 2, ..odd },
    ] {
        assert_ne!(estimated.image(&other), read, "{other:?}");
    }
    assert_ne!(modelled, read);
}
