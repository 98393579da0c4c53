//! Frames that were built in memory and can't be made: each is refused in words, with any numbers.

use crate::testing::parts::stored;
use crate::testing::plans::refused_on;
use crate::testing::raster::{self, Raster};
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::frame::{
    Blend, ColorSpace, Frame, Groups, Image, ImageIndex, Lifetime, Pass, Resource, Storage, TextureFile, Work,
};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{D32_SFLOAT, R8G8B8A8_SRGB, R16G16B16A16_SFLOAT};
use framewright_graph::vulkan::{
    Accesses, CullMode, Filter, Layout, PrimitiveTopology, Real, Sampler, Shape, Stages, State, Subresources,
};
use std::sync::Arc;

/// Draws into `color`, filters it to `screen`, and has a compute pass write `noise`, which is filtered, too.
fn frame() -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 4);
    let noise = raster.image("noise", R16G16B16A16_SFLOAT, 1);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color);
    raster.full_screen("blend").sample(color).sample(noise).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.passes.insert(0, dispatch("fill", noise));
    frame
}

fn dispatch(name: &str, image: ImageIndex) -> Pass {
    let work = Work::Dispatch { shader: name.into(), groups: Groups::Count([1; 3]) };
    Pass { storage: vec![stored("target", image, false)], ..Pass::new(name, work) }
}

type Change = fn(&mut Frame);

fn half() -> Real {
    Real::try_from(0.5).expect("finite")
}

/// Something that compute shaders saw last.
fn imported(accesses: Accesses, layout: Layout) -> Lifetime {
    Lifetime::Imported { before: State { stages: Stages::COMPUTE_SHADER, accesses, layout }, after: None, owner: None }
}

#[test]
fn the_largest_images_with_the_most_samples_are_added_up_without_overflow() {
    let mut device = raster::device();
    device.formats.iter_mut().for_each(|format| format.samples = vec![1, 2, 4, 8, 16]);
    let mut frame = frame();
    for image in &mut frame.images {
        image.extent = [16384, 16384, 1];
    }
    frame.images[0].samples = 16;
    let plan = compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default()).expect("it is only large");
    assert_eq!(verify(&plan), []);
    // 4 bytes × 16 samples, and once resolved; 8 bytes of noise.
    assert_eq!(plan.totals.transient_bytes, (16384 * 16384) * (4 * 16 + 4 + 8));
}

#[test]
fn what_cannot_be_is_refused_in_words() {
    const NOISE: usize = 1;
    fn noise(frame: &mut Frame) -> &mut Image {
        &mut frame.images[NOISE]
    }
    let changes: [(&str, Change); 42] = [
        ("accesses `color` as storage, which has several samples", |frame| {
            frame.passes.push(dispatch("keep", ImageIndex(0)));
        }),
        ("is 0×64×1", |frame| noise(frame).extent[0] = 0),
        ("is 64×64×0", |frame| noise(frame).extent[2] = 0),
        ("is 4294967295×64", |frame| noise(frame).extent[0] = u32::MAX),
        ("more memory than can be addressed", |frame| {
            noise(frame).layers = u32::MAX;
            noise(frame).extent = [16384, 16384, 1];
            frame.images[0].layers = u32::MAX;
            frame.images[0].extent = [16384, 16384, 1];
        }),
        ("`noise` can't have 0 mip levels: 64×64 texels have 7", |frame| noise(frame).mips = 0),
        ("can't have 8 mip levels", |frame| noise(frame).mips = 8),
        ("can't have 4294967295 mip levels", |frame| noise(frame).mips = u32::MAX),
        ("has no layers", |frame| noise(frame).layers = 0),
        ("has 0 samples", |frame| noise(frame).samples = 0),
        ("has 3 samples", |frame| noise(frame).samples = 3),
        ("`color` has 4 samples, so it is two-dimensional and has one mip level", |frame| frame.images[0].mips = 2),
        ("`blend`: `screen` has 2 mip levels: say which one is drawn into", |frame| frame.images[2].mips = 2),
        ("`blend`: `screen` is three-dimensional and can't be drawn into", |frame| {
            frame.images[2].extent[2] = 2;
            frame.images[2].shape = Shape::D3;
        }),
        ("`blend`: `screen` is three-dimensional and can't be drawn into", |frame| frame.images[2].shape = Shape::D3),
        ("is three-dimensional and can't hold depth", |frame| {
            noise(frame).format = D32_SFLOAT;
            noise(frame).shape = Shape::D3;
        }),
        ("`blend` reads `noise` of 1 frames ago, and it keeps 0", |frame| frame.passes[2].sampled[1].frames_ago = 1),
        ("`blend` names a part of `noise` that it doesn't have: it has 1 mip levels", |frame| {
            frame.passes[2].sampled[1].range = Subresources { base_mip: 1, ..Subresources::WHOLE }
        }),
        ("`blend` names a part of `noise` that it doesn't have: it has 1 layers", |frame| {
            frame.passes[2].sampled[1].range = Subresources { base_layer: u32::MAX, layers: 2, ..Subresources::WHOLE }
        }),
        ("`blend` reads `noise` before anything has written it", |frame| frame.passes.swap(0, 2)),
        ("`noise` holds colour (R16G16B16A16_SFLOAT) and can't be in the layout DEPTH_READ_ONLY_OPTIMAL", |frame| {
            noise(frame).lifetime = imported(Accesses::empty(), Layout::DepthReadOnlyOptimal)
        }),
        ("`noise` can't have seen TRANSFER_WRITE in these stages", |frame| {
            noise(frame).lifetime = imported(Accesses::TRANSFER_WRITE, Layout::TransferDstOptimal)
        }),
        ("`screen` can't be left in the layout UNDEFINED", |frame| {
            let Lifetime::Imported { before, .. } = imported(Accesses::empty(), Layout::Undefined) else { return };
            frame.outputs[0].after = Some(before);
        }),
        ("`noise` comes from a file and has layers", |frame| {
            noise(frame).lifetime = Lifetime::File(Arc::new(TextureFile::picture("a.png", ColorSpace::Linear)));
            noise(frame).layers = 2;
        }),
        ("`on`: `noise` has 2 mip levels: a stand-in forwards between flat images", |frame| {
            noise(frame).mips = 2;
            let (from, to) = (ImageIndex(1), ImageIndex(2));
            frame.passes.push(Pass::new("on", Work::Forward { from, to, because: String::new() }));
        }),
        ("an output does not exist", |frame| frame.outputs[0].resource = Resource::Image(ImageIndex(9))),
        ("names image number 9, which does not exist", |frame| frame.passes[0].storage[0].image = ImageIndex(9)),
        ("`screen` is an output twice", |frame| frame.outputs.push(frame.outputs[0].clone())),
        ("`fill` has attachments and doesn't draw", |frame| frame.passes[0].color = frame.passes[1].color.clone()),
        ("`opaque` draws into nothing: it has no attachment", |frame| frame.passes[1].color.clear()),
        ("`blend` accesses `source1` in stages", |frame| frame.passes[2].sampled[1].stages = Stages::COMPUTE_SHADER),
        ("`fill` accesses `target` in stages", |frame| frame.passes[0].storage[0].stages = Stages::empty()),
        ("`fill` neither reads nor writes `target`", |frame| frame.passes[0].storage[0].write = false),
        ("`opaque` clears `color` to what R8G8B8A8_SRGB doesn't hold", |frame| {
            frame.passes[1].color[0].clear = Some([f64::NAN; 4])
        }),
        ("`fill` accesses `noise` as storage and in another way", |frame| {
            let again = Storage { read: true, write: false, ..frame.passes[0].storage[0].clone() };
            frame.passes[0].storage.push(again);
        }),
        ("pass `blend` has the topology LINE_LIST, and draws triangles", |frame| {
            frame.passes[2].raster.topology = PrimitiveTopology::LineList;
        }),
        ("pass `opaque` begins strips anew, and draws TRIANGLE_LIST", |frame| {
            frame.passes[1].raster.primitive_restart = true;
        }),
        ("pass `blend` promises to cover its targets, and leaves out all faces", |frame| {
            frame.passes[2].covers = true;
            frame.passes[2].raster.cull_mode = Some(CullMode::FrontAndBack);
        }),
        ("pass `opaque` draws lines 0.5 texels wide", |frame| frame.passes[1].raster.line_width = half()),
        ("pass `fill` has a raster state and draws into nothing", |frame| frame.passes[0].raster.depth_clamp = true),
        ("pass `blend` can't sample `source1` so: it is anisotropic, and its filter isn't linear", |frame| {
            frame.passes[2].sampled[1].sampler = Sampler { anisotropy: 4, ..Sampler::new(Filter::Nearest) };
        }),
        ("`opaque` writes `color` in two ways at once", |frame| {
            let again = frame.passes[1].color[0].clone();
            frame.passes[1].color.push(again);
        }),
    ];
    for (words, change) in changes {
        let mut odd = frame();
        change(&mut odd);
        let said = refused_on(&odd, &raster::device());
        assert!(said.iter().any(|message| message.contains(words)), "{words}: {said:?}");
    }
}

#[test]
fn attachments_of_one_pass_have_as_many_layers_and_are_no_more_than_the_device_has() {
    let mut raster = Raster::default();
    let [a, b] = ["a", "b"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("opaque").clear(a).clear(b);
    let mut frame = raster.outputs(&[a, b]);
    let device = Profile { max_color_attachments: 1, ..raster::device() };
    let said = refused_on(&frame, &device);
    assert_eq!(said, ["`opaque` draws into 2 colour images; `a device for tests` has 1"]);
    frame.images[0].layers = 2;
    let said = refused_on(&frame, &raster::device());
    assert_eq!(said, ["pass `opaque` draws into different numbers of layers: `a` and `b`"]);
}

#[test]
fn an_empty_frame_is_an_empty_plan() {
    let device = raster::device();
    let plan = compile(&Frame::default(), &device, &mut MemoryEstimate(&device), &Options::default());
    let plan = plan.expect("there is nothing to refuse");
    assert_eq!((plan.images.len(), plan.steps.len()), (0, 1));
    assert_eq!(verify(&plan), []);
}

#[test]
fn the_unchanged_frame_is_compiled() {
    let device = raster::device();
    let plan = compile(&frame(), &device, &mut MemoryEstimate(&device), &Options::default());
    assert_eq!(verify(&plan.expect("it is valid")), []);
}

/// Of images that are forwarded with equal samples, both get as many as the device has for them together.
#[test]
fn forwarded_images_are_lowered_together() {
    let mut device = raster::device();
    for support in &mut device.formats {
        support.samples = if support.format == R8G8B8A8_SRGB { vec![1, 2, 4] } else { vec![1, 2] };
    }
    let mut raster = Raster::default();
    let [color, other] = ["color", "other"].map(|name| raster.image(name, R8G8B8A8_SRGB, 4));
    let normal = raster.image("normal", R16G16B16A16_SFLOAT, 4);
    raster.objects("opaque").clear(color).clear(normal);
    raster.forward("glow", color, other);
    let plan = compile(&raster.output(other), &device, &mut MemoryEstimate(&device), &Options::default());
    let plan = plan.expect("the frame is valid");
    assert_eq!(plan.totals.inserted_passes, 0, "{}", plan.tree());
}

#[test]
fn a_device_without_the_feature_that_brings_a_state_is_told_of() {
    let mut frame = frame();
    let layout = Layout::ShaderReadOnlyOptimal;
    let before = State { stages: Stages::TASK_SHADER_EXT, accesses: Accesses::SHADER_SAMPLED_READ, layout };
    frame.images[1].lifetime = Lifetime::Imported { before, after: None, owner: None };
    let on = |features: Option<&[&str]>| {
        let features = features.map(|all| all.iter().map(|name| (*name).to_owned()).collect());
        let device = Profile { features, ..raster::device() };
        let plan = compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default());
        plan.map(|plan| assert_eq!(verify(&plan), [])).map_err(|wrong| wrong[0].message.clone())
    };
    let said = on(Some(&[])).expect_err("it lacks the feature");
    assert!(said.starts_with("the state of `noise` needs the feature taskShader, which `"), "{said}");
    for features in [None, Some(&["taskShader"][..])] {
        assert_eq!(on(features), Ok(()));
    }
}
