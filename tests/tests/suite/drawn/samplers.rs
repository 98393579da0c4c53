//! Samplers of pipelines (DO-6): what each state makes of a lookup, calculated by hand.

use framewright_tests::render::{Setup, device, floats, render};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::{Device, Texels};
use std::error::Error;
use std::io::Write;

/// The outputs of lookups in `numbers` (a number for each of 16 by 8 texels), `even` and `levels` (five of them, which hold their
/// number), each with the shader's parameters.
fn looked_up(device: &Device, lookups: &[(&str, &str, &str)]) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let (mut images, mut passes, mut outputs) = (String::new(), String::new(), Vec::new());
    for (at, (image, sampler, params)) in lookups.iter().enumerate() {
        images += &format!(r#"(name: "seen_{at}", format: R32G32B32A32_SFLOAT, size: Output),"#);
        passes += &format!(
            r#"(name: "look_{at}", draw: FullScreen("raster_lookup"), params: {{{params}}}, color: ["seen_{at}"],
                   sample: {{"source": (image: "{image}", {sampler})}}),"#
        );
        outputs.push(format!("\"seen_{at}\""));
    }
    let fills: Vec<String> = (0..5)
        .map(|mip| format!(r#"(name: "level_{mip}", fill: (to: (image: "levels", mip: {mip}), value: {mip})),"#))
        .collect();
    let text = format!(
        r#"Pipeline(version: 1,
            images: [(name: "numbers", format: R32_SFLOAT, size: Output), (name: "even", format: R8G8B8A8_UNORM, size: Output),
                     (name: "levels", format: R32_SFLOAT, size: Fixed(16, 16), mips: 5), {images}],
            passes: [(name: "number", draw: FullScreen("raster_numbers"), color: ["numbers"]),
                     (name: "evenly", draw: FullScreen("even"), color: ["even"]), {} {passes}],
            outputs: [{}])"#,
        fills.concat(),
        outputs.join(", ")
    );
    Ok(outputs_of(device, &text)?.iter().map(floats).collect())
}

fn outputs_of(device: &Device, text: &str) -> Result<Vec<Texels>, Box<dyn Error>> {
    let mut file = tempfile::NamedTempFile::new()?;
    file.write_all(text.as_bytes())?;
    let (pipeline, scene) = (file.path().to_str().ok_or("no path")?, empty_scene());
    render(device, &Setup { pipeline, set: &[], scene: &scene, extent: [16, 8] })
}

const HERE: &str = r#""scale": (1.0, 1.0), "offset": (0.0, 0.0), "level": 0.0"#;
const BEYOND: &str = r#""scale": (1.0, 1.0), "offset": (2.0, 0.0), "level": 0.0"#;

#[test]
fn borders_have_their_color_beyond_the_edges() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let borders = [
        ("address: Border", [0.0; 4]),
        ("address: Border, border: FloatTransparentBlack", [0.0; 4]),
        ("address: Border, border: FloatOpaqueBlack", [0.0, 0.0, 0.0, 1.0]),
        ("address: Border, border: FloatOpaqueWhite", [1.0; 4]),
    ];
    let lookups: Vec<_> =
        borders.iter().flat_map(|(sampler, _)| [("even", *sampler, BEYOND), ("even", *sampler, HERE)]).collect();
    let seen = looked_up(device, &lookups)?;
    for ((sampler, border), pair) in borders.iter().zip(seen.as_chunks::<2>().0) {
        assert!(pair[0].as_chunks::<4>().0.iter().all(|texel| texel == border), "{sampler}: {:?}", pair[0]);
        assert!(pair[1].iter().skip(2).step_by(4).all(|blue| *blue == 1.0), "{sampler}: {:?}", pair[1]);
    }
    for (border, expected) in
        [("IntTransparentBlack", [0, 0, 0, 0]), ("IntOpaqueBlack", [0, 0, 0, 1]), ("IntOpaqueWhite", [1, 1, 1, 1])]
    {
        let text = format!(
            r#"Pipeline(version: 1,
                images: [(name: "whole", format: R32G32B32A32_UINT, size: Output), (name: "seen", format: R32G32B32A32_UINT, size: Output)],
                passes: [(name: "sevens", fill: (to: "whole", value: 7)),
                         (name: "look", draw: FullScreen("raster_lookup_uint"), color: ["seen"],
                             sample: {{"source": (image: "whole", address: Border, border: {border})}})],
                outputs: ["seen"])"#
        );
        let outputs = outputs_of(device, &text)?;
        let words: Vec<u32> =
            outputs[0].bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word)).collect();
        assert!(words.as_chunks::<4>().0.iter().all(|texel| *texel == expected), "{border}: {:?}", &words[..4]);
    }
    Ok(())
}

#[test]
fn an_image_is_mirrored_once_and_ends_there() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    if !device.profile().has_feature("samplerMirrorClampToEdge") {
        return Ok(());
    }
    let sampler = "filter: Nearest, address: MirrorOnce";
    let left = r#""scale": (-1.0, 1.0), "offset": (0.0, 0.0), "level": 0.0"#;
    let right = r#""scale": (1.0, 1.0), "offset": (1.0, 0.0), "level": 0.0"#;
    let seen = looked_up(device, &[("numbers", sampler, left), ("numbers", sampler, right)])?;
    for (at, [mirrored, clamped]) in (0..128).map(|at| (at, [0, 1].map(|image: usize| seen[image][4 * at]))) {
        assert_eq!(mirrored, at as f64, "left of the image");
        assert_eq!(clamped, (at / 16 * 16 + 15) as f64, "right of the image");
    }
    Ok(())
}

#[test]
fn the_least_and_the_greatest_of_the_texels_around_are_found() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    if !device.profile().has_feature("samplerFilterMinmax") {
        return Ok(());
    }
    // Between four texels.
    let corner = r#""scale": (1.0, 1.0), "offset": (0.03125, 0.0625), "level": 0.0"#;
    let sampler = |reduction: &str| format!("filter: Linear, reduction: {reduction}");
    let samplers = ["Min", "Max", "WeightedAverage"].map(sampler);
    let lookups: Vec<_> = samplers.iter().map(|sampler| ("numbers", &**sampler, corner)).collect();
    let seen = looked_up(device, &lookups)?;
    for (x, y) in (0..7).flat_map(|y| (0..15).map(move |x| (x, y))) {
        let number = f64::from(x + 16 * y);
        let [least, greatest, mean] = [0, 1, 2].map(|image: usize| seen[image][4 * (x + 16 * y) as usize]);
        assert_eq!([least, greatest], [number, number + 17.0], "({x}, {y})");
        assert!((mean - number - 8.5).abs() < 0.1, "({x}, {y}): {mean}");
    }
    Ok(())
}

#[test]
fn levels_are_moved_and_bounded() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let at = |level: f32| format!(r#""scale": (1.0, 1.0), "offset": (0.0, 0.0), "level": {level:?}"#);
    let cases = [
        ("filter: Nearest", 3.0, 3.0),
        ("filter: Nearest, lod_bias: 2.0", 1.0, 3.0),
        ("filter: Nearest, lod_bias: -1.0", 3.0, 2.0),
        ("filter: Nearest, mip_filter: Linear, lod_bias: 0.5", 1.0, 1.5),
        ("filter: Nearest, min_lod: 2.0", 0.0, 2.0),
        ("filter: Nearest, max_lod: 1.0", 4.0, 1.0),
        ("filter: Nearest, mip_filter: Linear, min_lod: 0.5, max_lod: 0.5", 3.0, 0.5),
    ];
    let params: Vec<String> = cases.iter().map(|(_, level, _)| at(*level)).collect();
    let lookups: Vec<_> =
        cases.iter().zip(&params).map(|((sampler, ..), params)| ("levels", *sampler, &**params)).collect();
    for ((sampler, level, expected), seen) in cases.iter().zip(looked_up(device, &lookups)?) {
        let off = seen.iter().step_by(4).map(|found| (found - expected).abs()).fold(0.0, f64::max);
        assert!(off < 0.02, "{sampler} at {level}: {} instead of {expected}", seen[0]);
    }
    Ok(())
}

/// 16 texels to the right and 2 down are skipped from pixel to pixel: the greater is level 4; eight samples along it leave level 1.
#[test]
fn anisotropy_takes_finer_levels_along_the_slant() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    if !device.profile().has_feature("samplerAnisotropy") {
        return Ok(());
    }
    let slant = r#""scale": (16.0, 1.0), "offset": (0.0, 0.0), "level": -1.0"#;
    let sampler = "filter: Linear, mip_filter: Linear, address: Repeat";
    let sixteen = format!("{sampler}, anisotropy: 16");
    let seen = looked_up(device, &[("levels", sampler, slant), ("levels", &sixteen, slant)])?;
    let [plain, along] = [0, 1].map(|image: usize| seen[image][4 * (5 + 16 * 4)]);
    assert!((plain - 4.0).abs() < 0.1, "{plain}");
    assert!(along < 2.1, "{along}");
    Ok(())
}
