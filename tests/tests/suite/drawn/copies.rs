//! Copies take bits as they are, into colour formats of equal texel size and of one plane to and from buffers.

use framewright_graph::compile::Options;
use framewright_graph::vulkan::Format;
use framewright_tests::render::{Setup, device, draw, silent};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const TEXELS: u32 = 64;

/// The outputs of `tests/pipelines/copies.ron`.
struct Copied {
    /// The images, in the file's order.
    images: Vec<Vec<u8>>,
    /// Depth and stencil that were copied back.
    depths: Vec<u32>,
    marks: Vec<u8>,
}

fn copied(packed: bool) -> Result<Option<Copied>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    if packed && !device.profile().formats.iter().any(|support| support.format == Format::D24_UNORM_S8_UINT) {
        return Ok(None);
    }
    let scene = empty_scene();
    let set = [("packed", if packed { "true" } else { "false" })];
    let setup = Setup { pipeline: "tests/pipelines/copies.ron", set: &set, scene: &scene, extent: [8, 8] };
    let (plan, mut executor) = draw(device, &setup, &Options::default(), 1)?;
    let stored = if packed { Format::D24_UNORM_S8_UINT } else { Format::D32_SFLOAT_S8_UINT };
    assert!(plan.images.iter().any(|image| image.format == stored), "{}", plan.tree());
    let images = (0..7).map(|output| Ok(executor.read(output)?.bytes)).collect::<Result<_, Box<dyn Error>>>()?;
    let depths = words(&executor.read_buffer("depths_back")?);
    let marks = executor.read_buffer("marks_back")?;
    silent(device)?;
    Ok(Some(Copied { images, depths, marks }))
}

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word)).collect()
}

#[test]
fn texels_are_copied_bit_for_bit_into_other_formats_of_their_size() -> Result<(), Box<dyn Error>> {
    let Some(Copied { images, .. }) = copied(false)? else { return Ok(()) };
    let expected: Vec<u8> = (0..TEXELS).flat_map(|at| [0, 71, 142, 213].map(|more| (37 * at + more) as u8)).collect();
    for (image, format) in
        images.iter().zip(["R8G8B8A8_UNORM", "R32_UINT", "A2B10G10R10", "R32_SFLOAT", "B8G8R8A8_SRGB"])
    {
        assert!(*image == expected, "{format}");
    }
    let [.., seen, wide] = &images[..] else { return Err("no seven images".into()) };
    assert!(seen == wide, "R16G16B16A16_UNORM");
    Ok(())
}

#[test]
fn one_plane_is_copied_from_a_buffer_and_to_one() -> Result<(), Box<dyn Error>> {
    for packed in [false, true] {
        let Some(Copied { images, depths, marks }) = copied(packed)? else { continue };
        let seen = words(&images[5]);
        for (at, [depth, mark]) in (0..TEXELS).zip(seen.as_chunks::<2>().0) {
            let (word, depth_there) = match packed {
                true => ((at << 18) + at, f64::from((at << 18) + at) / f64::from((1 << 24) - 1)),
                false => (((at + 1) as f32 / 64.0).to_bits(), f64::from(at + 1) / 64.0),
            };
            let mark_there = (11 * at + 5) as u8;
            // Above 24 bits of depth a buffer has undefined ones.
            let kept = if packed { (1 << 24) - 1 } else { u32::MAX };
            assert_eq!((depths[at as usize] & kept, marks[at as usize]), (word, mark_there), "texel {at} in buffers");
            let [depth, mark] = [*depth, *mark].map(|bits| f64::from(f32::from_bits(bits)));
            // A driver may divide 24 bits in single precision.
            let apart = if packed { 1.0 / 8_388_608.0 } else { 0.0 };
            assert!((depth - depth_there).abs() <= apart, "depth {depth} of texel {at}, not {depth_there}");
            assert_eq!(mark, f64::from(mark_there), "stencil of texel {at}");
        }
    }
    Ok(())
}
