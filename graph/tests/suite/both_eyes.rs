//! Images that hold both eyes' parts (ST-2, ST-4), as the compiler treats them: memory, limits, scopes, what it keeps of the
//! last frame; and frames built in memory that it must refuse.

use crate::testing::plans::{self, compiled, image, on, scopes};
use crate::testing::raster::{self, Raster};
use framewright_graph::base::Span;
use framewright_graph::compile::{Compiler, Options, Reuse};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::frame::{
    Blend, Draw, Eye, EyeForm, Frame, Groups, Image, ImageIndex, Pass, Resource, SampledImage, Stereo, Storage,
    TransferUse, Work,
};
use framewright_graph::plan::{ImageId, Plan, Role};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{D32_SFLOAT, R8G8B8A8_SRGB, R16G16B16A16_SFLOAT};
use framewright_graph::vulkan::{Filter, Rotation, Shape, Stages, Subresources};
use std::sync::Arc;

const COLOR: ImageIndex = ImageIndex(0);
const NOISE: ImageIndex = ImageIndex(2);
const SCREEN: ImageIndex = ImageIndex(3);

/// Draws objects into `color` and `depth`, with several samples; `noise`, once for both eyes; and both onto `screen`.
fn frame(stereo: Stereo, form: EyeForm) -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", R16G16B16A16_SFLOAT, 4);
    let depth = raster.image("depth", D32_SFLOAT, 4);
    let noise = raster.image("noise", R16G16B16A16_SFLOAT, 1);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.full_screen("noise").color(noise, Blend::Replace);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.full_screen("show").sample(color).sample(noise).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.stereo = stereo;
    for at in [0, 1, 3] {
        frame.images[at].eyes = Some(form);
    }
    frame
}

const MODES: [(Stereo, EyeForm); 4] = [
    (Stereo::DoubleWide, EyeForm::Halves),
    (Stereo::Instanced, EyeForm::Halves),
    (Stereo::Instanced, EyeForm::Layers),
    (Stereo::Multiview, EyeForm::Layers),
];

fn said(frame: &Frame, device: &Profile) -> Vec<(String, Option<String>)> {
    let errors = on(frame, device).expect_err("it is refused");
    errors.into_iter().map(|it| (it.message, it.help)).collect()
}

fn refused(frame: &Frame) -> String {
    plans::refused(frame).into_iter().map(|message| message + "\n").collect()
}

fn bytes(plan: &Plan, name: &str) -> u64 {
    match &image(plan, name).role {
        Role::Transient(placement) => placement.bytes,
        other => panic!("`{name}`: {other:?}"),
    }
}

#[test]
fn what_holds_both_eyes_parts_takes_the_memory_of_both() {
    let mut mono = frame(Stereo::Off, EyeForm::Layers);
    mono.images.iter_mut().for_each(|image| image.eyes = None);
    let mono = compiled(&mono);
    for (stereo, form) in MODES {
        let both = compiled(&frame(stereo, form));
        // Also what the compiler adds: what several samples of `color` are resolved into.
        for name in ["color", "depth", "color (resolved)"] {
            assert_eq!(image(&both, name).eyes, Some(form), "{stereo:?} {form:?}: {name}");
            assert_eq!(bytes(&both, name), 2 * bytes(&mono, name), "{stereo:?} {form:?}: {name}");
        }
        assert_eq!((image(&both, "noise").eyes, bytes(&both, "noise")), (None, bytes(&mono, "noise")));
        assert_eq!(bytes(&mono, "noise"), 64 * 64 * 8);
        let [one, two] = [&mono, &both].map(|plan| plan.totals.transient_bytes);
        assert_eq!(two, 2 * one - bytes(&mono, "noise"), "{stereo:?} {form:?}");
        assert_eq!(one, 64 * 64 * (4 * 8 + 4 * 4 + 8 + 8));
        // Bytes that are moved are those of both parts, in every mode (NU-1, IN-7): `color` is resolved, `screen` and `noise` are stored.
        let moved =
            |plan: &Plan| [plan.moved().loaded, plan.moved().stored, plan.moved().resolved, plan.moved().copied];
        assert_eq!(moved(&mono), [0, 64 * 64 * (4 + 8), 64 * 64 * 8, 0]);
        assert_eq!(moved(&both), [0, 64 * 64 * (2 * 4 + 8), 2 * 64 * 64 * 8, 0], "{stereo:?} {form:?}");
        // It is as many steps as for one eye.
        assert_eq!(scopes(&both).len(), scopes(&mono).len(), "{}", both.tree());
        assert_eq!(both.totals.passes, mono.totals.passes);
        assert_eq!(both.totals.placed_bytes, both.heaps.iter().map(|heap| heap.bytes).sum::<u64>());
    }
}

#[test]
fn turned_halves_take_twice_the_side_along_which_they_lie() {
    for (rotation, made) in [
        (Rotation::Identity, [128, 32, 1]),
        (Rotation::Rotate90, [32, 128, 1]),
        (Rotation::Rotate180, [128, 32, 1]),
        (Rotation::Rotate270, [32, 128, 1]),
    ] {
        let mut frame = frame(Stereo::DoubleWide, EyeForm::Halves);
        frame.images.iter_mut().for_each(|image| image.extent = [64, 32, 1]);
        frame.outputs[0].rotation = rotation;
        let plan = compiled(&frame);
        let screen = image(&plan, "screen");
        assert_eq!((screen.rotation, screen.made()), (rotation, made), "{rotation:?}");
        assert_eq!(image(&plan, "color").made(), [128, 32, 1], "it stays upright");
    }
}

#[test]
fn a_device_without_images_as_wide_or_with_as_many_layers_is_named_with_what_it_has() {
    let wide = |width: u32| {
        let mut frame = frame(Stereo::DoubleWide, EyeForm::Halves);
        frame.images.iter_mut().for_each(|image| image.extent[0] = width);
        frame
    };
    let device = Profile { max_attachment_extent: 4096, ..raster::device() };
    assert!(on(&wide(2048), &device).is_ok());
    let mistakes = said(&wide(2049), &device);
    let help = "`a device for tests` has images from 1×1 to 4096×4096";
    let expected = ["color", "depth", "screen"].map(|name| (format!("`{name}` is 4098×64"), Some(help.to_owned())));
    assert_eq!(mistakes, expected);
    let mut one_eye = wide(2049);
    one_eye.stereo = Stereo::Off;
    one_eye.images.iter_mut().for_each(|image| image.eyes = None);
    assert!(on(&one_eye, &device).is_ok(), "2049 are fine for one");
    let mut layers = wide(2049);
    layers.stereo = Stereo::Multiview;
    layers.images.iter_mut().for_each(|image| image.eyes = image.eyes.map(|_| EyeForm::Layers));
    assert!(on(&layers, &device).is_ok(), "and beside each other in layers");
    let flat = Profile { max_layers: 1, ..device };
    let mistakes = said(&layers, &flat);
    let help = "`a device for tests` has images of up to 1 layers";
    let expected = ["color", "depth", "screen"].map(|name| (format!("`{name}` has 2 layers"), Some(help.to_owned())));
    assert_eq!(mistakes, expected);
}

#[test]
fn plans_for_two_eyes_drawn_in_other_ways_do_not_serve_for_each_other() {
    let plans: Vec<Plan> = MODES.map(|(stereo, form)| compiled(&frame(stereo, form))).into();
    for (at, one) in plans.iter().enumerate() {
        assert_eq!(one.differs_beyond_values(one), None);
        for (other_at, other) in plans.iter().enumerate().filter(|(other, _)| *other != at) {
            let said = one.differs_beyond_values(other);
            let expected = if MODES[at].0 == MODES[other_at].0 {
                "its images are others"
            } else {
                "it is drawn for two eyes in another way"
            };
            assert_eq!(said.as_deref(), Some(expected), "{:?} and {:?}", MODES[at], MODES[other_at]);
        }
    }
}

#[test]
fn a_compiler_that_remembers_the_last_frame_compiles_another_mode_anew() {
    let device = Arc::new(raster::device());
    let mut compiler = Compiler::new();
    let options = Options::default();
    for (at, (stereo, form)) in MODES.into_iter().chain(MODES).enumerate() {
        let frame = Arc::new(frame(stereo, form));
        let plan = compiler.compile(&frame, &device, &mut MemoryEstimate(&device), &options).expect("valid").clone();
        assert_eq!(compiler.reuse(), Reuse::Nothing, "{at}: {stereo:?} {form:?}");
        assert_eq!(plan, compiled(&frame), "{stereo:?} {form:?}");
        // Another size is another placement, of both eyes' parts.
        let mut larger = Frame::clone(&frame);
        larger.images.iter_mut().for_each(|image| image.extent = [128, 128, 1]);
        let plan = compiler.compile(&Arc::new(larger.clone()), &device, &mut MemoryEstimate(&device), &options);
        assert_eq!(*plan.expect("valid"), compiled(&larger), "{stereo:?} {form:?}");
        assert_eq!(compiler.reuse(), Reuse::Nothing, "{stereo:?} {form:?}");
        compiler.compile(&frame, &device, &mut MemoryEstimate(&device), &options).expect("valid");
    }
}

#[test]
fn a_size_that_only_both_eyes_do_not_fit_in_is_refused_by_a_compiler_that_remembers_a_smaller_one() {
    let device = Arc::new(Profile { max_attachment_extent: 4096, ..raster::device() });
    let (mut compiler, options) = (Compiler::new(), Options::default());
    let mut frame = frame(Stereo::DoubleWide, EyeForm::Halves);
    assert!(compiler.compile(&Arc::new(frame.clone()), &device, &mut MemoryEstimate(&device), &options).is_ok());
    frame.images.iter_mut().for_each(|image| image.extent[0] = 2049);
    assert!(compiler.compile(&Arc::new(frame), &device, &mut MemoryEstimate(&device), &options).is_err());
}

/// `first` draws into `mine`; `second` reads it at its own position and draws into `other`.
fn read_at_its_own_position(stereo: Stereo, forms: [Option<EyeForm>; 2], eye: Option<Eye>) -> Plan {
    let mut raster = Raster::default();
    let mine = raster.image("mine", R16G16B16A16_SFLOAT, 1);
    let other = raster.image("other", R16G16B16A16_SFLOAT, 1);
    raster.full_screen("first").color(mine, Blend::Replace);
    raster.full_screen("second").sample(mine).color(other, Blend::Replace);
    let mut frame = raster.output(other);
    frame.stereo = stereo;
    frame.images.iter_mut().zip(forms).for_each(|(image, form)| image.eyes = form);
    (sampled(&mut frame, 1, 0).own_pixel, sampled(&mut frame, 1, 0).eye) = (true, eye);
    let device = Profile { local_read: true, ..raster::device() };
    let plan = on(&frame, &device).unwrap_or_else(|mistakes| panic!("{mistakes:?}"));
    assert_eq!(verify(&plan), [], "{}", plan.tree());
    plan
}

#[test]
fn what_is_drawn_for_both_eyes_shares_no_scope_with_what_is_drawn_once() {
    for (stereo, form) in MODES {
        let form = Some(form);
        let alike = read_at_its_own_position(stereo, [form, form], None);
        assert_eq!(scopes(&alike).len(), 1, "{stereo:?}: {}", alike.tree());
        let shared_read = read_at_its_own_position(stereo, [None, form], None);
        let one_eyes = read_at_its_own_position(stereo, [form, None], Some(Eye::Right));
        for plan in [shared_read, one_eyes] {
            let found = scopes(&plan);
            assert_eq!(found.len(), 2, "{stereo:?}: {}", plan.tree());
            for scope in found {
                let mut forms = scope.color().iter().map(|it| plan.image(it.image).eyes);
                assert!(forms.all(|it| it == plan.eyes(scope)), "{stereo:?}: {}", plan.tree());
            }
        }
    }
}

#[test]
fn one_eyes_part_is_never_read_at_each_fragments_own_position() {
    for (stereo, form) in MODES {
        let plan = read_at_its_own_position(stereo, [Some(form); 2], Some(Eye::Left));
        assert_eq!(scopes(&plan).len(), 2, "both eyes read the left one's: {}", plan.tree());
        let why = plan.notes.iter().map(|note| &*note.text).find(|text| text.contains("own position"));
        let expected =
            "reads `mine` at its own position from memory: it is one eye's part of it, whichever is drawn for";
        assert_eq!(why, Some(expected), "{stereo:?}");
        assert!(plan.tree().contains("source0 = `mine`, the left eye's, sampled"), "{}", plan.tree());
    }
}

fn dispatch(name: &str, image: ImageIndex, write: bool) -> Pass {
    let binding = "target".into();
    let (range, span, stages) = (Subresources::WHOLE, Span::NONE, Stages::COMPUTE_SHADER);
    let storage = vec![Storage { binding, image, range, span, read: !write, write, eye: None, stages }];
    let work = Work::Dispatch { shader: name.into(), groups: Groups::Count([1; 3]) };
    Pass { storage, side_effect: true, ..Pass::new(name, work) }
}

fn transfers(name: &str, work: Work, of: &[(ImageIndex, bool)]) -> Pass {
    let used = |(image, write): &(ImageIndex, bool)| TransferUse {
        resource: Resource::Image(*image),
        range: Subresources::WHOLE,
        frames_ago: 0,
        span: Span::NONE,
        write: *write,
        keeps: false,
    };
    Pass { transfers: of.iter().map(used).collect(), side_effect: true, ..Pass::new(name, work) }
}

/// Has the program record what a pass draws, for both eyes at once or not.
fn custom(pass: &mut Pass, both_eyes: bool) {
    pass.work = Work::Draw { draw: Draw::Custom, shader: "it".into(), discards: false, per_sample: false };
    pass.both_eyes = both_eyes;
    pass.color[0].clear = Some([0.0; 4]);
}

/// DO-12: within a rendering scope and outside of it.
#[test]
fn what_the_program_records_for_both_eyes_reaches_both_parts() {
    for (stereo, form) in MODES {
        let mut frame = frame(stereo, form);
        custom(&mut frame.passes[2], true);
        let outside = transfers("outside", Work::Custom { callback: "it".into() }, &[(SCREEN, false)]);
        frame.passes.push(Pass { both_eyes: true, ..outside });
        let plan = compiled(&frame);
        assert_eq!(verify(&plan), [], "{stereo:?}: {}", plan.tree());
        assert_eq!(plan.tree().matches("for both eyes at once").count(), 2, "{}", plan.tree());
    }
}

fn sampled(frame: &mut Frame, pass: usize, at: usize) -> &mut SampledImage {
    &mut frame.passes[pass].sampled[at]
}

#[test]
fn frames_that_use_both_eyes_parts_otherwise_than_for_both_are_refused_in_words() {
    type Change = fn(&mut Frame);
    let changes: [(&str, Change); 15] = [
        ("`noise` holds both eyes' parts, so each is flat and has one layer", |frame| {
            (frame.images[2].eyes, frame.images[2].layers) = (frame.images[0].eyes, 2);
        }),
        ("`noise` holds both eyes' parts, so each is flat and has one layer", |frame| {
            (frame.images[2].eyes, frame.images[2].shape) = (frame.images[0].eyes, Shape::D3);
        }),
        ("`noise` holds both eyes' parts, so each is flat and has one layer", |frame| {
            (frame.images[2].eyes, frame.images[2].shape, frame.images[2].layers) =
                (frame.images[0].eyes, Shape::Cube, 6);
        }),
        ("`keep` accesses as storage `screen`, which holds both eyes' parts", |frame| {
            frame.passes.push(dispatch("keep", SCREEN, false));
        }),
        ("`paint` accesses as storage `screen`, which holds both eyes' parts", |frame| {
            frame.passes.push(dispatch("paint", SCREEN, true));
        }),
        (
            "`noise` draws for one eye and doesn't say which it samples of `screen`, which holds both eyes' parts",
            |frame| {
                let mut noise = frame.passes.remove(0);
                noise.sampled = frame.passes[1].sampled[..1].to_vec();
                noise.sampled[0].image = SCREEN;
                frame.passes.push(noise);
            },
        ),
        ("`scale` transfers `screen`, which holds both eyes' parts", |frame| {
            frame.images.push(Image::new("more", R8G8B8A8_SRGB, 32, 32));
            let work = Work::Blit { filter: Filter::Linear };
            frame.passes.push(transfers("scale", work, &[(SCREEN, false), (ImageIndex(4), true)]));
        }),
        ("`outside` transfers `screen`, which holds both eyes' parts", |frame| {
            frame.passes.push(transfers("outside", Work::Custom { callback: "it".into() }, &[(SCREEN, false)]));
        }),
        (
            "`show` is recorded by a program that doesn't say `both_eyes`, and draws into `screen`, which holds both eyes' parts",
            |frame| custom(&mut frame.passes[2], false),
        ),
        ("`show` accesses as storage `color`, which holds both eyes' parts", |frame| {
            (frame.images[0].samples, frame.images[1].samples) = (1, 1);
            frame.passes[2].sampled.remove(0);
            frame.passes[2].storage = dispatch("it", COLOR, false).storage;
            custom(&mut frame.passes[2], true);
        }),
        ("`one` transfers `screen`, which holds both eyes' parts", |frame| {
            frame.images.push(Image::new("more", R8G8B8A8_SRGB, 64, 64));
            frame.passes.push(transfers("one", Work::Copy, &[(SCREEN, false), (ImageIndex(4), true)]));
        }),
        ("`one` transfers `more`, which holds both eyes' parts", |frame| {
            let eyes = frame.images[0].eyes;
            frame.images.push(Image { eyes, ..Image::new("more", R16G16B16A16_SFLOAT, 64, 64) });
            frame.passes.push(transfers("one", Work::Copy, &[(NOISE, false), (ImageIndex(4), true)]));
        }),
        ("`hand on` forwards from or to `screen`, which holds both eyes' parts", |frame| {
            let work = Work::Forward { from: NOISE, to: SCREEN, because: "it is off".to_owned() };
            frame.passes.push(Pass::new("hand on", work));
        }),
        ("`hand on` forwards from or to `color`, which holds both eyes' parts", |frame| {
            let work = Work::Forward { from: COLOR, to: NOISE, because: "it is off".to_owned() };
            frame.passes.push(Pass::new("hand on", work));
        }),
        ("`opaque` draws into images that hold eyes' parts in different ways: `color` and `noise`", |frame| {
            let noise = frame.passes[0].color[0].clone();
            frame.passes[1].color.push(noise);
        }),
    ];
    let mut missed = Vec::new();
    for (stereo, form) in MODES {
        for (expected, change) in changes {
            let mut frame = frame(stereo, form);
            change(&mut frame);
            let said = refused(&frame);
            if !said.contains(expected) {
                missed.push(format!("{stereo:?} {form:?}: `{expected}` is not in\n{said}"));
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

/// What changes color and depth to single samples, and color to two mip levels.
fn with_levels(frame: &mut Frame) {
    (frame.images[0].mips, frame.images[0].samples, frame.images[1].samples) = (2, 1, 1);
    let part = Subresources { mips: 1, ..Subresources::WHOLE };
    (frame.passes[1].color[0].range, frame.passes[2].sampled[0].range) = (part, part);
}

#[test]
fn layers_have_mip_levels_and_halves_do_not() {
    for (stereo, form) in MODES {
        let mut frame = frame(stereo, form);
        with_levels(&mut frame);
        match form {
            EyeForm::Layers => {
                assert_eq!((verify(&compiled(&frame)), image(&compiled(&frame), "color").mips), (vec![], 2))
            }
            EyeForm::Halves => {
                let said = refused(&frame);
                assert!(
                    said.contains("`color` holds both eyes' parts side by side, so it has one mip level"),
                    "{said}"
                );
            }
        }
    }
}

/// Adds what a compute pass stores into `stored`, for one eye after the other, and what samples it for both.
fn stored_by_layer(frame: &mut Frame) {
    let image = ImageIndex(4);
    frame.images.push(Image { eyes: frame.images[0].eyes, ..Image::new("stored", R16G16B16A16_SFLOAT, 64, 64) });
    for eye in Eye::BOTH {
        let mut pass = dispatch(&eye.named("store"), image, true);
        (pass.storage[0].eye, pass.storage[0].read, pass.side_effect) = (Some(eye), eye == Eye::Right, false);
        frame.passes.insert(2, pass);
    }
    frame.passes.swap(2, 3);
    let more = SampledImage { binding: "more".into(), image, ..frame.passes[4].sampled[0].clone() };
    frame.passes[4].sampled.push(more);
}

#[test]
fn a_compute_pass_stores_into_one_eyes_layer_and_no_half() {
    for (stereo, form) in MODES {
        let mut frame = frame(stereo, form);
        stored_by_layer(&mut frame);
        if form == EyeForm::Halves {
            let said = refused(&frame);
            assert!(said.contains("`store (left)` accesses as storage `stored`"), "{said}");
            continue;
        }
        let plan = compiled(&frame);
        assert_eq!(verify(&plan), [], "{}", plan.tree());
        let tree = plan.tree();
        assert!(tree.contains("target = `stored`, the left eye's") && tree.contains("the right eye's"), "{tree}");
        // What both share has no eye.
        frame.passes[2].storage[0].image = NOISE;
        let said = refused(&frame);
        assert!(said.contains("`store (left)` accesses one eye's part of `noise`, which holds one picture"), "{said}");
    }
}

/// DO-12: `both_eyes` is said of what a program records, and of what holds both eyes' parts.
#[test]
fn a_pass_that_can_not_be_recorded_for_both_eyes_and_says_so_is_refused() {
    type Change = fn(&mut Frame);
    let nothing_drawn = "`show` says `both_eyes`, and draws into nothing that holds both eyes' parts";
    let nothing_touched = "`outside` says `both_eyes`, and touches nothing that holds both eyes' parts";
    let changes: [(&str, Change); 9] = [
        ("`opaque` says `both_eyes`, and no program records it", |frame| frame.passes[1].both_eyes = true),
        ("`keep` says `both_eyes`, and no program records it", |frame| {
            frame.passes.push(Pass { both_eyes: true, ..dispatch("keep", SCREEN, false) });
        }),
        ("`keep` accesses as storage `screen`, which holds both eyes' parts", |frame| {
            frame.passes.push(Pass { both_eyes: true, ..dispatch("keep", SCREEN, false) });
        }),
        ("`scale` transfers `screen`, which holds both eyes' parts", |frame| {
            frame.images.push(Image::new("more", R8G8B8A8_SRGB, 32, 32));
            let work = Work::Blit { filter: Filter::Linear };
            let scale = transfers("scale", work, &[(SCREEN, false), (ImageIndex(4), true)]);
            frame.passes.push(Pass { both_eyes: true, ..scale });
        }),
        (nothing_drawn, |frame| draws_alone(frame)),
        // What it draws into decides for whom it samples.
        ("`show` draws for one eye and doesn't say which it samples of `color`", |frame| draws_alone(frame)),
        (nothing_touched, |frame| {
            let outside = transfers("outside", Work::Custom { callback: "it".into() }, &[(NOISE, false)]);
            frame.passes.push(Pass { both_eyes: true, ..outside });
        }),
        (nothing_touched, |frame| {
            let mut outside = Pass::new("outside", Work::Custom { callback: "it".into() });
            outside.sampled = vec![SampledImage { eye: Some(Eye::Left), ..frame.passes[2].sampled[0].clone() }];
            outside.sampled[0].image = SCREEN;
            frame.passes.push(Pass { both_eyes: true, side_effect: true, ..outside });
        }),
        ("`show` samples one eye's part of `noise`, which holds one picture", |frame| {
            sampled(frame, 2, 1).eye = Some(Eye::Right);
        }),
    ];
    let mut missed = Vec::new();
    for (stereo, form) in MODES {
        for (expected, change) in changes {
            let mut frame = frame(stereo, form);
            change(&mut frame);
            let said = refused(&frame);
            if !said.contains(expected) {
                missed.push(format!("{stereo:?} {form:?}: `{expected}` is not in\n{said}"));
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
    // Also where no image holds both.
    let mut plain = frame(Stereo::Off, EyeForm::Layers);
    plain.images.iter_mut().for_each(|image| image.eyes = None);
    compiled(&plain);
    custom(&mut plain.passes[2], true);
    assert!(refused(&plain).contains(nothing_drawn), "{}", refused(&plain));
}

#[test]
fn draws_whose_instances_a_buffer_says_are_refused_where_instances_are_both_eyes() {
    for (stereo, form) in MODES {
        let mut frame = frame(stereo, form);
        let draw = Draw::Indirect;
        frame.passes[2].work = Work::Draw { draw, shader: "it".into(), discards: false, per_sample: false };
        // It has no buffer of counts, so it is refused in each mode.
        let said = refused(&frame);
        let expected = "`show` draws the instances that a buffer says into `screen`, which holds both eyes' parts";
        assert_eq!(said.contains(expected), stereo != Stereo::Multiview, "{stereo:?}: {said}");
    }
}

/// `show` draws into an image that both eyes share.
fn draws_alone(frame: &mut Frame) {
    frame.images.push(Image::new("more", R8G8B8A8_SRGB, 64, 64));
    frame.images[0].samples = 1;
    frame.images[1].samples = 1;
    custom(&mut frame.passes[2], true);
    frame.passes[2].color[0].image = ImageIndex(4);
    frame.outputs = vec![Resource::Image(ImageIndex(4)).into()];
}

#[test]
fn a_form_that_the_mode_does_not_draw_is_refused() {
    for stereo in Stereo::ALL {
        for form in [EyeForm::Layers, EyeForm::Halves] {
            if MODES.contains(&(stereo, form)) {
                compiled(&frame(stereo, form));
                continue;
            }
            let said = refused(&frame(stereo, form));
            for name in ["color", "depth", "screen"] {
                let expected = format!(
                    "`{name}` holds both eyes' parts, which isn't how the frame is drawn for two eyes ({})",
                    stereo.name()
                );
                assert!(said.contains(&expected), "{stereo:?} {form:?}: {said}");
            }
        }
    }
}

#[test]
fn one_eyes_part_may_be_sampled_by_what_draws_once_and_whole_images_may_be_copied() {
    for (stereo, form) in MODES {
        let mut frame = frame(stereo, form);
        let eyes = frame.images[0].eyes;
        frame.images.push(Image::new("mirror", R8G8B8A8_SRGB, 64, 64));
        frame.images.push(Image { eyes, ..Image::new("kept", R8G8B8A8_SRGB, 64, 64) });
        let (mirror, kept) = (ImageIndex(4), ImageIndex(5));
        let mut show = frame.passes[2].clone();
        (show.name, show.color[0].image) = ("mirror".into(), mirror);
        frame.passes.push(show);
        sampled(&mut frame, 3, 0).image = SCREEN;
        sampled(&mut frame, 3, 0).eye = Some(Eye::Right);
        frame.passes.push(transfers("keep", Work::Copy, &[(SCREEN, false), (kept, true)]));
        frame.outputs.extend([mirror, kept].map(|image| Resource::Image(image).into()));
        let plan = compiled(&frame);
        let access = |pass: &str, image: &str| {
            let id = plan.images.iter().position(|it| *it.name == *image).expect("it is there");
            let scopes = scopes(&plan);
            let pass = scopes.iter().flat_map(|scope| &scope.passes).find(|it| *it.name == *pass).expect("it is there");
            pass.accesses.iter().find(|it| it.image == ImageId(id as u32)).expect("it reads it").eye
        };
        assert_eq!(access("mirror", "screen"), Some(Eye::Right));
        assert_eq!(access("show", "color (resolved)"), None);
        assert_eq!(plan.totals.copies, 1);
    }
}
