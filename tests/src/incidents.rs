//! Small frames after what users of other render graphs reported; `tests/suite/drawn/incidents` holds each against its report.

use crate::frames::{Added, Builder};
use framewright_graph::frame::{Blend, Face, Frame, ImageIndex, Lifetime, Resolve, ResolveWay};
use framewright_graph::vulkan::Format::{
    D32_SFLOAT, R8G8B8A8_SRGB, R8G8B8A8_UNORM, R16G16B16A16_SFLOAT, R32_SFLOAT, R32_UINT,
};
use framewright_graph::vulkan::{FillValue, ResolveMode, Subresources};

/// All, with names.
#[must_use]
pub fn all() -> Vec<(String, Frame)> {
    let mut all = vec![
        ("forward, transparent".to_owned(), forward(true)),
        ("forward".to_owned(), forward(false)),
        ("depth sampled".to_owned(), depth_sampled(None)),
        ("depth resolved".to_owned(), depth_sampled(Some(ResolveMode::SampleZero))),
        ("depth resolved by a draw".to_owned(), depth_sampled(Some(ResolveMode::Max))),
        ("weighted resolve".to_owned(), weighted()),
        ("prepass".to_owned(), prepass()),
        ("two versions".to_owned(), two_versions()),
        ("diamond".to_owned(), diamond()),
        ("overlapping writes".to_owned(), overlapping()),
        ("memory shared".to_owned(), memory_shared()),
    ];
    all.extend([1, 4].map(|samples| (format!("scaled, {samples} samples"), scaled(samples, 16, 64))));
    all.extend([1, 3].map(|frames| (format!("history of {frames}"), history(frames))));
    all
}

/// Opaque objects, transparent ones if there are any, then a full-screen pass that shows them: at 4 samples.
#[must_use]
pub fn forward(transparent: bool) -> Frame {
    let mut builder = Builder::default();
    let color = builder.image("color", R16G16B16A16_SFLOAT, 64, 4);
    let depth = builder.image("depth", D32_SFLOAT, 64, 4);
    let screen = builder.image("screen", R8G8B8A8_SRGB, 64, 1);
    builder.objects("opaque").clear(color).depth(depth, Some(0.0), true);
    if transparent {
        builder.objects("glass").color(color, Blend::Alpha).depth(depth, None, false);
    }
    builder.full_screen("show").sample(color).color(screen, Blend::Replace);
    builder.outputs(&[screen])
}

/// A pass blurs by multisampled depth, which is drawn again for it or resolved in this mode.
#[must_use]
pub fn depth_sampled(mode: Option<ResolveMode>) -> Frame {
    let mut builder = Builder::default();
    let depth = builder.image("depth", D32_SFLOAT, 64, 4);
    let color = builder.image("color", R8G8B8A8_SRGB, 64, 4);
    let screen = builder.image("screen", R8G8B8A8_SRGB, 64, 1);
    builder.objects("opaque").clear(color).depth(depth, Some(0.0), true);
    builder.full_screen("blur").sample(depth).sample(color).color(screen, Blend::Replace);
    let mut frame = builder.outputs(&[screen]);
    frame.images[0].resolve = mode.map(|mode| Resolve { way: ResolveWay::By(mode), because: "it says so".into() });
    frame
}

/// Objects at one size, shown at another.
#[must_use]
pub fn scaled(samples: u32, drawn: u32, shown: u32) -> Frame {
    let mut builder = Builder::default();
    let color = builder.image("color", R16G16B16A16_SFLOAT, drawn, samples);
    let depth = builder.image("depth", D32_SFLOAT, drawn, samples);
    let mapped = builder.image("mapped", R8G8B8A8_SRGB, drawn, 1);
    let screen = builder.image("screen", R8G8B8A8_SRGB, shown, 1);
    builder.objects("opaque").clear(color).depth(depth, Some(0.0), true);
    builder.full_screen("map").sample(color).color(mapped, Blend::Replace);
    builder.full_screen("scale").sample(mapped).color(screen, Blend::Replace);
    builder.outputs(&[screen])
}

/// A pass that reads single samples.
#[must_use]
pub fn weighted() -> Frame {
    let mut builder = Builder::default();
    let color = builder.image("color", R16G16B16A16_SFLOAT, 64, 4);
    let screen = builder.image("screen", R8G8B8A8_SRGB, 64, 1);
    builder.objects("opaque").clear(color);
    let pass = builder.full_screen("weighted").sample(color).color(screen, Blend::Replace);
    pass.0.sampled[0].face = Face::Samples;
    builder.outputs(&[screen])
}

/// Colour, normals and ids, all multisampled and all sampled.
#[must_use]
pub fn prepass() -> Frame {
    let mut builder = Builder::default();
    let [color, normals] = ["color", "normals"].map(|name| builder.image(name, R16G16B16A16_SFLOAT, 64, 4));
    let ids = builder.image("ids", R32_UINT, 64, 4);
    let screen = builder.image("screen", R8G8B8A8_SRGB, 64, 1);
    builder.objects("prepass").clear(color).clear(normals).clear(ids);
    builder.full_screen("show").sample(color).sample(normals).sample(ids).color(screen, Blend::Replace);
    builder.outputs(&[screen])
}

/// A multisampled image is sampled, drawn to again, and sampled again.
#[must_use]
pub fn two_versions() -> Frame {
    let mut builder = Builder::default();
    let color = builder.image("color", R8G8B8A8_SRGB, 64, 4);
    let [first, screen] = ["first", "screen"].map(|name| builder.image(name, R8G8B8A8_SRGB, 64, 1));
    builder.objects("opaque").clear(color);
    builder.full_screen("early").sample(color).color(first, Blend::Replace);
    builder.objects("glass").color(color, Blend::Alpha);
    builder.full_screen("late").sample(color).sample(first).color(screen, Blend::Replace);
    builder.outputs(&[screen])
}

/// Two shadow maps, a scene that reads both, and a chain beside them.
#[must_use]
pub fn diamond() -> Frame {
    let mut builder = Builder::default();
    let [left, right] = ["left", "right"].map(|name| builder.image(name, D32_SFLOAT, 32, 1));
    let [scene, noise, screen] = ["scene", "noise", "screen"].map(|name| builder.image(name, R8G8B8A8_UNORM, 32, 1));
    builder.objects("shadow_left").depth(left, Some(0.0), true);
    builder.dispatch("noise").store(noise, false);
    builder.objects("shadow_right").depth(right, Some(0.0), true);
    builder.objects("scene").sample(left).sample(right).clear(scene);
    builder.full_screen("show").sample(scene).sample(noise).color(screen, Blend::Replace);
    builder.outputs(&[screen])
}

/// Two passes write overlapping layers of one image, a third reads them all.
#[must_use]
pub fn overlapping() -> Frame {
    let layers = |base_layer: u32, layers: u32| Subresources { base_layer, layers, ..Subresources::WHOLE };
    let part = |pass: Added<'_>, range: Subresources| pass.0.storage[0].range = range;
    let mut builder = Builder::default();
    let array = builder.image("array", R8G8B8A8_UNORM, 32, 1);
    builder.0.images[0].layers = 3;
    let out = builder.image("out", R8G8B8A8_UNORM, 32, 1);
    part(builder.dispatch("lower").store(array, false), layers(0, 2));
    part(builder.dispatch("upper").store(array, false), layers(1, 2));
    builder.dispatch("read").sample(array).store(out, false);
    builder.outputs(&[out])
}

/// A chain of full-screen passes, of whose images two live at a time.
#[must_use]
pub fn memory_shared() -> Frame {
    let mut builder = Builder::default();
    let images: Vec<ImageIndex> = (0..6).map(|at| builder.image(&format!("i{at}"), R8G8B8A8_UNORM, 64, 1)).collect();
    builder.full_screen("p0").color(images[0], Blend::Replace);
    for at in 1..6 {
        builder.full_screen(&format!("p{at}")).sample(images[at - 1]).color(images[at], Blend::Replace);
    }
    builder.outputs(&[images[5]])
}

/// An image is made from itself as it was `frames` frames ago, beside transient images of its size.
#[must_use]
pub fn history(frames: u32) -> Frame {
    let mut builder = Builder::default();
    let [drawn, trail] = ["drawn", "trail"].map(|name| builder.image(name, R32_SFLOAT, 64, 1));
    let screen = builder.image("screen", R8G8B8A8_SRGB, 64, 1);
    builder.0.images[trail.0 as usize].lifetime = Lifetime::History { frames, initial: FillValue::Color([0.0; 4]) };
    builder.objects("draw").clear(drawn);
    let pass = builder.full_screen("accumulate").sample(drawn).sample(trail).color(trail, Blend::Replace);
    pass.0.sampled[1].frames_ago = frames;
    builder.full_screen("show").sample(trail).color(screen, Blend::Replace);
    builder.outputs(&[screen])
}
