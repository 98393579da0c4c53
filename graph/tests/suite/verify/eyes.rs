//! Images that hold both eyes' parts and aren't used for both eyes are found in any Plan.

use crate::testing::raster::{self, Raster};
use framewright_graph::base::Span;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::{
    Blend, Draw, Eye, EyeForm, Groups, Image, ImageIndex, Pass, Resource, Stereo, Storage, TransferUse,
    Work as Described,
};
use framewright_graph::plan::{Plan, RenderScope, Side, Transfer, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{R8G8B8A8_SRGB, R16G16B16A16_SFLOAT};
use framewright_graph::vulkan::{Accesses, Filter, Layout, Shape, Subresources};

/// `color`, multisampled, and `screen` hold both eyes' parts, as does `kept`, a copy of `screen`; `mirror` shows the right eye's.
fn plan(stereo: Stereo, form: EyeForm) -> Plan {
    let mut raster = Raster::default();
    let color = raster.image("color", R16G16B16A16_SFLOAT, 4);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    let kept = raster.image("kept", R8G8B8A8_SRGB, 1);
    let mirror = raster.image("mirror", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color);
    raster.full_screen("show").sample(color).color(screen, Blend::Replace);
    raster.full_screen("mirror").sample(screen).color(mirror, Blend::Replace);
    let mut frame = raster.outputs(&[screen, kept, mirror]);
    frame.stereo = stereo;
    frame.images[..3].iter_mut().for_each(|image: &mut Image| image.eyes = Some(form));
    frame.passes[2].sampled[0].eye = Some(Eye::Right);
    let used = |image: ImageIndex, write| TransferUse {
        resource: Resource::Image(image),
        range: Subresources::WHOLE,
        frames_ago: 0,
        span: Span::NONE,
        write,
        keeps: false,
    };
    let transfers = vec![used(screen, false), used(kept, true)];
    frame.passes.push(Pass { transfers, ..Pass::new("keep", Described::Copy) });
    let device = raster::device();
    let plan = compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default()).expect("the frame is valid");
    assert_eq!(verify(&plan), [], "{}", plan.tree());
    plan
}

const MODES: [(Stereo, EyeForm); 4] = [
    (Stereo::DoubleWide, EyeForm::Halves),
    (Stereo::Instanced, EyeForm::Halves),
    (Stereo::Instanced, EyeForm::Layers),
    (Stereo::Multiview, EyeForm::Layers),
];

fn image(plan: &Plan, name: &str) -> usize {
    plan.images.iter().position(|it| *it.name == *name).unwrap_or_else(|| panic!("no `{name}`:\n{}", plan.tree()))
}

/// The scope in which this pass draws.
fn scope<'p>(plan: &'p mut Plan, pass: &str) -> &'p mut RenderScope {
    let scopes = plan.steps.iter_mut().filter_map(|step| match &mut step.work {
        Work::Render(scope) => Some(&mut **scope),
        _ => None,
    });
    scopes.into_iter().find(|scope| scope.passes.iter().any(|it| *it.name == *pass)).expect("it draws")
}

fn copy(plan: &mut Plan) -> &mut Work {
    plan.steps.iter_mut().map(|step| &mut step.work).find(|work| matches!(work, Work::Copy(_))).expect("it copies")
}

fn transfer(plan: &mut Plan) -> &mut Transfer {
    let Work::Copy(transfer) = copy(plan) else { panic!("it copies") };
    transfer
}

/// The access of a pass that samples.
fn sampling<'p>(plan: &'p mut Plan, pass: &str) -> &'p mut framewright_graph::plan::Access {
    let passes = &mut scope(plan, pass).passes;
    let pass = passes.iter_mut().find(|it| *it.name == *pass).expect("it draws");
    pass.accesses.iter_mut().find(|access| access.binding.is_some()).expect("it samples")
}

type Change = fn(&mut Plan);

/// The change, and the start of its message; the name of the image first.
const CHANGES: &[(Change, &str)] = &[
    (|plan| plan.stereo = Stereo::MultiPass, "`screen`: holds both eyes' parts as `multi-pass` doesn't draw them"),
    (|plan| plan.stereo = Stereo::Off, "`kept`: holds both eyes' parts as `off` doesn't draw them"),
    (
        |plan| {
            let at = image(plan, "color");
            plan.images[at].shape = Shape::D3;
        },
        "`color`: holds both eyes' parts, which aren't flat or have layers of their own",
    ),
    (
        |plan| {
            let at = image(plan, "kept");
            plan.images[at].layers = 2;
        },
        "`kept`: holds both eyes' parts, which aren't flat or have layers of their own",
    ),
    (
        |plan| {
            let at = image(plan, "color (resolved)");
            plan.images[at].eyes = None;
        },
        "`color (resolved)`: is drawn beside an image that holds both eyes' parts otherwise",
    ),
    (
        |plan| {
            let at = image(plan, "color");
            plan.images[at].eyes = None;
        },
        "`color (resolved)`: is drawn beside an image that holds both eyes' parts otherwise",
    ),
    (
        |plan| {
            let other = scope(plan, "mirror").attachments[0].clone();
            scope(plan, "show").attachments.push(other);
        },
        "`mirror`: is drawn beside an image that holds both eyes' parts otherwise",
    ),
    (
        |plan| sampling(plan, "show").accesses |= Accesses::SHADER_STORAGE_READ,
        "`color (resolved)`: holds both eyes' parts, and a pass accesses it as one",
    ),
    (
        |plan| sampling(plan, "mirror").accesses |= Accesses::TRANSFER_READ,
        "`screen`: holds both eyes' parts, and a pass accesses it as one",
    ),
    (
        |plan| sampling(plan, "mirror").eye = None,
        "`screen`: holds both eyes' parts, and a pass doesn't say whose it reads",
    ),
    (
        |plan| {
            let at = image(plan, "screen");
            plan.images[at].eyes = None;
        },
        "`screen`: is no eye's, and a pass reads one eye's part of it",
    ),
    (
        |plan| sampling(plan, "mirror").accesses |= Accesses::INPUT_ATTACHMENT_READ,
        "`screen`: is read at each fragment's own position, and one eye's part of it is meant",
    ),
    (
        |plan| {
            let at = image(plan, "kept");
            plan.images[at].eyes = None;
        },
        "`kept`: is copied, and holds both eyes' parts on only one side",
    ),
    (
        |plan| {
            let mirror = image(plan, "mirror") as u32;
            let Side::Image { image, .. } = &mut transfer(plan).source else { panic!("of an image") };
            image.0 = mirror;
        },
        "`kept`: is copied, and holds both eyes' parts on only one side",
    ),
    (
        |plan| {
            let mut blit = transfer(plan).clone();
            blit.filter = Some(Filter::Nearest);
            *copy(plan) = Work::Blit(blit);
        },
        "`screen`: holds both eyes' parts and is scaled by a blit",
    ),
    (
        |plan| {
            let mut blit = transfer(plan).clone();
            blit.filter = Some(Filter::Nearest);
            *copy(plan) = Work::Blit(blit);
        },
        "`kept`: holds both eyes' parts and is scaled by a blit",
    ),
];

#[test]
fn whatever_is_not_for_both_eyes_is_found() {
    let mut missed = Vec::new();
    for (stereo, form) in MODES {
        let right = plan(stereo, form);
        for (change, expected) in CHANGES {
            let mut plan = right.clone();
            change(&mut plan);
            let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
            if !said.iter().any(|it| it.contains(expected)) {
                missed.push(format!("{stereo:?} {form:?}: `{expected}` is not in {said:#?}"));
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn the_other_form_is_found_where_a_mode_draws_one() {
    for (stereo, form) in MODES {
        let mut plan = plan(stereo, form);
        let other = if form == EyeForm::Layers { EyeForm::Halves } else { EyeForm::Layers };
        plan.images.iter_mut().for_each(|image| image.eyes = image.eyes.map(|_| other));
        let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
        let form = format!("holds both eyes' parts as `{}` doesn't draw them", stereo.name());
        let found = said.iter().filter(|it| it.contains(&form)).count();
        // `color`, what it is resolved into, `screen` and `kept`.
        assert_eq!(found, if stereo == Stereo::Instanced { 0 } else { 4 }, "{stereo:?}: {said:#?}");
    }
}

#[test]
fn an_image_in_another_form_than_the_rest_of_its_scope_is_found() {
    let mut plan = plan(Stereo::Instanced, EyeForm::Layers);
    let at = image(&plan, "color (resolved)");
    plan.images[at].eyes = Some(EyeForm::Halves);
    let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
    let expected = "`color (resolved)`: is drawn beside an image that holds both eyes' parts otherwise";
    assert!(said.iter().any(|it| it.contains(expected)), "{said:#?}");
}

/// DO-12: what the program records for both eyes at once says so, and has something of both.
#[test]
fn what_the_program_does_not_record_for_both_eyes_is_found() {
    for (stereo, form) in MODES {
        let mut raster = Raster::default();
        let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
        raster.objects("draw").clear(screen);
        let mut frame = raster.output(screen);
        (frame.stereo, frame.images[0].eyes) = (stereo, Some(form));
        let draw = Draw::Custom;
        frame.passes[0].work = Described::Draw { draw, shader: "it".into(), discards: false, per_sample: false };
        frame.passes[0].both_eyes = true;
        let (resource, range, span) = (Resource::Image(screen), Subresources::WHOLE, Span::NONE);
        let used = TransferUse { resource, range, frames_ago: 0, span, write: false, keeps: false };
        let mark = Pass::new("mark", Described::Custom { callback: "it".into() });
        frame.passes.push(Pass { transfers: vec![used], both_eyes: true, side_effect: true, ..mark });
        let device = raster::device();
        let plan = compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default()).expect("it is valid");
        assert_eq!(verify(&plan), [], "{}", plan.tree());
        let said = |change: &dyn Fn(&mut Plan)| {
            let mut plan = plan.clone();
            change(&mut plan);
            verify(&plan).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
        };
        let custom = |plan: &mut Plan, change: &dyn Fn(&mut framewright_graph::plan::Pass)| {
            for step in &mut plan.steps {
                if let Work::Custom(pass) = &mut step.work {
                    change(pass);
                }
            }
        };
        let scope_of_one = said(&|plan| scope(plan, "draw").passes[0].both_eyes = false);
        let expected = "`screen`: holds both eyes' parts, and the program records `draw` for one eye";
        assert!(scope_of_one.contains(expected), "{stereo:?}: {scope_of_one}");
        let outside_of_one = said(&|plan| custom(plan, &|pass| pass.both_eyes = false));
        assert!(outside_of_one.contains("and a pass accesses it as one"), "{stereo:?}: {outside_of_one}");
        let of_none = said(&|plan| custom(plan, &|pass| pass.accesses[0].eye = Some(Eye::Left)));
        assert!(of_none.contains("is recorded for both eyes, and touches nothing that holds"), "{stereo:?}: {of_none}");
        let nothing = said(&|plan| {
            plan.images.iter_mut().for_each(|image| image.eyes = None);
        });
        for expected in [
            "`draw` is recorded for both eyes, and draws into nothing that",
            "for both eyes, and touches nothing that holds",
        ] {
            assert!(nothing.contains(expected), "{stereo:?}: {nothing}");
        }
        let of_file = said(&|plan| scope(plan, "draw").passes[0].draw = Some(Draw::FullScreen));
        let expected = "`draw` is recorded for both eyes, and by no program";
        assert!(of_file.contains(expected), "{stereo:?}: {of_file}");
    }
}

/// `stored` is written by a compute pass of each eye, and `screen` is drawn from it.
fn stored_by_layer(stereo: Stereo) -> Plan {
    let mut raster = Raster::default();
    let stored = raster.image("stored", R16G16B16A16_SFLOAT, 1);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.full_screen("show").sample(stored).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.stereo = stereo;
    frame.images.iter_mut().for_each(|image: &mut Image| image.eyes = Some(EyeForm::Layers));
    let store = |eye: Eye| {
        let work = Described::Dispatch { shader: "store".into(), groups: Groups::Count([1; 3]) };
        let storage = Storage { eye: Some(eye), ..crate::testing::parts::stored("target", stored, eye == Eye::Right) };
        Pass { storage: vec![storage], ..Pass::new(&eye.named("store"), work) }
    };
    frame.passes.splice(0..0, Eye::BOTH.map(store));
    let device = raster::device();
    let plan = compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default()).expect("the frame is valid");
    assert_eq!(verify(&plan), [], "{}", plan.tree());
    plan
}

#[test]
fn a_layer_that_no_compute_pass_has_written_is_found_where_it_is_read() {
    let stores = |plan: &mut Plan, change: &mut dyn FnMut(&mut framewright_graph::plan::Step)| {
        plan.steps.iter_mut().filter(|step| matches!(step.work, Work::Dispatch(_))).for_each(change);
    };
    let eye = |step: &mut framewright_graph::plan::Step, eye| step.work.passes_mut()[0].accesses[0].eye = eye;
    for stereo in [Stereo::Instanced, Stereo::Multiview] {
        let right = stored_by_layer(stereo);
        let said = |change: &dyn Fn(&mut Plan)| {
            let mut plan = right.clone();
            change(&mut plan);
            verify(&plan).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
        };
        let missing = "`stored`: is read, and nothing has written the layer of the";
        let left_twice = said(&|plan| stores(plan, &mut |step| eye(step, Some(Eye::Left))));
        assert!(left_twice.contains(&format!("{missing} right eye")), "{stereo:?}: {left_twice}");
        // What the second one forgets is the first one's layer.
        let forgotten = said(&|plan| {
            let barriers = plan.steps.iter_mut().flat_map(|step| &mut step.image_barriers);
            barriers.filter(|barrier| barrier.image.0 == 0).for_each(|barrier| barrier.old_layout = Layout::Undefined);
        });
        assert!(forgotten.contains(&format!("{missing} left eye")), "{stereo:?}: {forgotten}");
        let unsaid = said(&|plan| stores(plan, &mut |step| eye(step, None)));
        assert!(unsaid.contains("`stored`: holds both eyes' parts, and a pass accesses it as one"), "{unsaid}");
        let in_halves = said(&|plan| plan.images[0].eyes = Some(EyeForm::Halves));
        assert!(in_halves.contains("`stored`: holds both eyes' parts, and a pass accesses it as one"), "{in_halves}");
    }
}

#[test]
fn draws_whose_instances_a_buffer_says_are_found_where_instances_are_both_eyes() {
    for (stereo, form) in MODES {
        let mut plan = plan(stereo, form);
        scope(&mut plan, "show").passes[0].draw = Some(Draw::Indirect);
        let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
        let expected = "`screen`: holds both eyes' parts, and `show` draws the instances that a buffer says";
        assert_eq!(said.iter().any(|it| it.contains(expected)), stereo != Stereo::Multiview, "{said:#?}");
    }
}

#[test]
fn mip_levels_of_halves_are_found() {
    for (stereo, form) in MODES {
        let mut plan = plan(stereo, form);
        let at = image(&plan, "kept");
        plan.images[at].mips = 2;
        let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
        let expected = "`kept`: holds both eyes' parts side by side, and has mip levels";
        assert_eq!(said.iter().any(|it| it.contains(expected)), form == EyeForm::Halves, "{said:#?}");
    }
}
