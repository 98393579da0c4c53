//! Format fallback: what a device can't use becomes a format that holds at least as much, and the Plan says so; where somebody
//! relies on the format, it is refused.

use crate::testing::plans::on;
use crate::testing::raster::{self, Raster};
use framewright_graph::base::Span;
use framewright_graph::compile::{Compiler, Options};
use framewright_graph::device::{MemoryEstimate, Profile, SHIPPED_PROFILES};
use framewright_graph::frame::{Blend, Frame, ImageIndex, Lifetime, Pass, Resource, Storage, TransferUse, Work};
use framewright_graph::plan::{Plan, Stage};
use framewright_graph::vulkan::Format::{self, *};
use framewright_graph::vulkan::{Accesses, FillValue, Layout, Stages, State, Subresources, Usage};
use std::sync::Arc;

/// Draws into `color` with `depth`, and filters it to `screen`.
fn frame(color: Format, depth: Format) -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", color, 4);
    let depth = raster.image("depth", depth, 4);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.full_screen("show").sample(color).color(screen, Blend::Replace);
    raster.output(screen)
}

/// A device that has everything but these formats.
fn without(formats: &[Format]) -> Profile {
    let mut device = raster::device();
    device.formats.retain(|support| !formats.contains(&support.format));
    device
}

fn format(plan: &Plan, name: &str) -> Format {
    plan.images.iter().find(|image| *image.name == *name).expect("it is in the Plan").format
}

fn note(plan: &Plan, subject: &str) -> String {
    let is_it = |note: &&framewright_graph::plan::Note| note.stage() == Stage::Fit && *note.subject == *subject;
    plan.notes.iter().find(is_it).map(|note| note.text.clone()).unwrap_or_default()
}

#[test]
fn what_a_device_lacks_becomes_what_holds_as_much_and_is_said() {
    for (wanted, made) in [
        (B10G11R11_UFLOAT_PACK32, R16G16B16A16_SFLOAT),
        (A2B10G10R10_UNORM_PACK32, R16G16B16A16_SFLOAT),
        (B8G8R8A8_UNORM, R8G8B8A8_UNORM),
        (R16G16_SFLOAT, R32G32_SFLOAT),
    ] {
        let plan = on(&frame(wanted, D32_SFLOAT), &without(&[wanted])).expect("there is a substitute");
        assert_eq!(format(&plan, "color"), made);
        let missing = "`a device for tests` has no SAMPLED, COLOR_ATTACHMENT for it";
        let said = note(&plan, "color");
        assert!(said.starts_with(&format!("{wanted} was asked for, {made} is made: {missing}")), "{said}");
        // The resolved image has its format, too.
        assert_eq!(format(&plan, "color (resolved)"), made);
    }
}

#[test]
fn depth_keeps_its_bits_and_its_stencil() {
    let plan = on(&frame(R8G8B8A8_UNORM, D24_UNORM_S8_UINT), &without(&[D24_UNORM_S8_UINT]));
    assert_eq!(format(&plan.expect("there is a substitute"), "depth"), D32_SFLOAT_S8_UINT);
    let plan = on(&frame(R8G8B8A8_UNORM, D16_UNORM), &without(&[D16_UNORM, X8_D24_UNORM_PACK32]));
    assert_eq!(format(&plan.expect("there is a substitute"), "depth"), D32_SFLOAT);
    // Fewer bits than asked for are never made.
    let refused = on(&frame(R8G8B8A8_UNORM, D32_SFLOAT_S8_UINT), &without(&[D32_SFLOAT_S8_UINT]));
    let message = &refused.expect_err("nothing holds as much")[0].message;
    assert_eq!(message, "`depth` can't be D32_SFLOAT_S8_UINT on `a device for tests`: no DEPTH_STENCIL_ATTACHMENT");
}

#[test]
fn one_missing_use_is_enough_and_is_named() {
    let mut device = raster::device();
    for support in device.formats.iter_mut().filter(|support| support.format == B10G11R11_UFLOAT_PACK32) {
        support.usage.remove(Usage::COLOR_ATTACHMENT);
    }
    let plan = on(&frame(B10G11R11_UFLOAT_PACK32, D32_SFLOAT), &device).expect("there is a substitute");
    assert!(
        note(&plan, "color").contains("has no COLOR_ATTACHMENT for it; it has an alpha"),
        "{}",
        note(&plan, "color")
    );
}

/// A change of a frame after which somebody relies on the format of `color`.
type Change = fn(&mut Frame);

#[test]
fn what_is_promised_outside_keeps_its_format() {
    let relied: [Change; 3] = [
        |frame| {
            let (stages, accesses) = (Stages::COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE);
            let before = State { stages, accesses, layout: Layout::General };
            frame.images[0].lifetime = Lifetime::Imported { before, after: None, owner: None };
        },
        |frame| {
            let mut output = frame.outputs[0].clone();
            output.resource = Resource::Image(ImageIndex(0));
            frame.outputs.push(output);
        },
        |frame| {
            frame.images[0].samples = 1;
            frame.images[1].samples = 1;
            let image = ImageIndex(0);
            let (range, span, stages) = (Subresources::WHOLE, Span::NONE, Stages::FRAGMENT_SHADER);
            let storage =
                Storage { binding: "b".into(), image, range, span, read: true, write: false, eye: None, stages };
            frame.passes[1].storage.push(storage);
        },
    ];
    for change in relied {
        let mut frame = frame(B10G11R11_UFLOAT_PACK32, D32_SFLOAT);
        change(&mut frame);
        let refused = on(&frame, &without(&[B10G11R11_UFLOAT_PACK32])).expect_err("somebody relies on it");
        assert!(refused[0].message.contains("`color` can't be B10G11R11_UFLOAT_PACK32"), "{refused:?}");
    }
}

#[test]
fn history_and_what_it_is_forwarded_to_change_together() {
    let mut raster = Raster::default();
    let [a, b] = ["a", "b"].map(|name| raster.image(name, R16G16_SFLOAT, 1));
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(a);
    raster.forward("off", a, b);
    raster.full_screen("show").sample(b).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.images[1].lifetime = Lifetime::History { frames: 1, initial: FillValue::Color([0.0; 4]) };
    let plan = on(&frame, &without(&[R16G16_SFLOAT])).expect("there is a substitute");
    assert_eq!(["a", "b", "b (1 frame ago)"].map(|name| format(&plan, name)), [R32G32_SFLOAT; 3]);
}

#[test]
fn shipped_devices_without_24_bit_depth_draw_with_32() {
    let mut fell_back = 0;
    for (name, text) in SHIPPED_PROFILES.iter().copied() {
        let device = Profile::from_ron(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        let has = device.format(D24_UNORM_S8_UINT).is_some_and(|it| it.usage.contains(Usage::DEPTH_STENCIL_ATTACHMENT));
        let plan = on(&frame(R8G8B8A8_UNORM, D24_UNORM_S8_UINT), &device).expect("each has one of them");
        assert_eq!(format(&plan, "depth"), if has { D24_UNORM_S8_UINT } else { D32_SFLOAT_S8_UINT }, "{name}");
        fell_back += u32::from(!has);
    }
    assert!(fell_back > 0, "no shipped device lacks it");
}

#[test]
fn a_frame_that_fell_back_is_compiled_anew_when_it_changes() {
    let device = Arc::new(without(&[B10G11R11_UFLOAT_PACK32]));
    let mut compiler = Compiler::new();
    let mut frame = frame(B10G11R11_UFLOAT_PACK32, D32_SFLOAT);
    for side in [64, 32] {
        frame.images.iter_mut().for_each(|image| image.extent = [side, side, 1]);
        let again =
            compiler.compile(&Arc::new(frame.clone()), &device, &mut MemoryEstimate(&device), &Options::default());
        assert_eq!(again.ok(), on(&frame, &device).ok().as_ref());
    }
}

/// Inserted copies and resolves need more of a format than the passes say.
#[test]
fn what_is_inserted_and_the_format_cannot_do_is_refused_and_said() {
    let lacking = |format: Format, usage: Usage| {
        let mut device = raster::device();
        let supports = device.formats.iter_mut().filter(|support| support.format == format);
        supports.for_each(|support| support.usage.remove(usage));
        device
    };
    let said = |frame: &Frame, device: &Profile| -> Vec<(String, String)> {
        let errors = on(frame, device).expect_err("the format can't do that");
        errors.into_iter().map(|error| (error.message, error.help.unwrap_or_default())).collect()
    };
    // A pass that samples what it writes samples a copy.
    let mut raster = Raster::default();
    let color = raster.image("color", R16G16B16A16_SFLOAT, 1);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color);
    raster.full_screen("again").sample(color).color(color, Blend::Alpha);
    raster.full_screen("show").sample(color).color(screen, Blend::Replace);
    let again = raster.output(screen);
    let (why, copied) = ("`again` samples `color` while it writes it", Usage::TRANSFER_SRC | Usage::TRANSFER_DST);
    let refused = said(&again, &lacking(R16G16B16A16_SFLOAT, copied));
    let words = |name: &str, missing: &str| {
        (
            format!("`{name}` can't be R16G16B16A16_SFLOAT on `a device for tests`: no {missing}"),
            format!("it takes that since {why}; choose another format"),
        )
    };
    assert_eq!(refused, [words("color", "TRANSFER_SRC"), words("color (copy)", "TRANSFER_DST")]);
    assert!(on(&again, &lacking(B8G8R8A8_SRGB, copied)).is_ok());

    // Several layers are resolved by a step of its own.
    let mut layered = frame(R16G16B16A16_SFLOAT, D32_SFLOAT);
    layered.images[..2].iter_mut().for_each(|image| image.layers = 2);
    let refused = said(&layered, &lacking(R16G16B16A16_SFLOAT, Usage::TRANSFER_SRC));
    assert_eq!(refused.len(), 1, "{refused:?}");
    assert!(refused[0].1.contains("`show` samples `color` and it has 4 samples"), "{refused:?}");

    // The program that takes an output can copy it.
    let refused = said(&again, &lacking(R8G8B8A8_SRGB, Usage::TRANSFER_SRC));
    assert!(refused[0].1.contains("outputs can be copied"), "{refused:?}");
}

#[test]
fn a_copy_into_another_format_takes_texels_of_as_many_bytes_and_neither_format_falls_back() {
    let mut raster = Raster::default();
    let [from, to] = [("from", R16_SFLOAT), ("to", R8G8_UNORM)].map(|(name, format)| raster.image(name, format, 1));
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.full_screen("draw").color(from, Blend::Replace);
    raster.full_screen("show").sample(to).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    let side = |image, write| {
        let (resource, range) = (Resource::Image(image), Subresources::WHOLE);
        TransferUse { resource, range, frames_ago: 0, span: Span::NONE, write, keeps: false }
    };
    let copy = Pass { transfers: vec![side(from, false), side(to, true)], ..Pass::new("copy", Work::Copy) };
    frame.passes.insert(1, copy);
    let plan = on(&frame, &raster::device()).expect("both have texels of 2 bytes");
    assert_eq!((format(&plan, "from"), format(&plan, "to")), (R16_SFLOAT, R8G8_UNORM));
    // R32_SFLOAT holds as much, but its texels have 4 bytes.
    let refused = on(&frame, &without(&[R16_SFLOAT])).expect_err("it can't be another one");
    assert_eq!(
        refused[0].message,
        "`from` can't be R16_SFLOAT on `a device for tests`: no TRANSFER_SRC, COLOR_ATTACHMENT"
    );
}
