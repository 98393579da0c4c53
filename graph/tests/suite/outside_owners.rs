//! Images and buffers that somebody else has between frames: the Plan takes and gives them, and the checker misses what it doesn't (DO-11).

use crate::queues::Builder;
use crate::testing::pipelines::{INPUTS, right};
use crate::testing::plans::{compiled, on, shipped};
use framewright_graph::device::{Profile, Queues};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Lifetime, Stereo};
use framewright_graph::plan::{OutsideTransfer, OutsideWay, Plan, Queue, Resource, Role, Totals};
use framewright_graph::verify::{Violation, verify};
use framewright_graph::vulkan::{Accesses, Layout, OutsideOwner, Sharing, Stages, State};

/// A camera's picture is scaled into an image for a compositor. `first` and `second`: what their lifetimes say more.
fn shared([first, second]: [&str; 2]) -> Plan {
    let text = format!(
        r#"Pipeline(version: 1, images: [
            (name: "camera", format: R8G8B8A8_UNORM, size: Output, lifetime: Imported(before: Sampled, after: Sampled{first})),
            (name: "half", format: R8G8B8A8_UNORM, size: Scaled(0.5)),
            (name: "shown", format: R8G8B8A8_UNORM, size: Output, lifetime: Imported(before: Undefined, after: (stages: [], accesses: [], layout: GENERAL){second}))],
         passes: [
            (name: "shrink", draw: FullScreen("downsample"), sample: {{"source": "camera"}}, color: ["half"]),
            (name: "show", draw: FullScreen("downsample"), sample: {{"source": "half"}}, color: ["shown"])],
         outputs: ["shown"])"#
    );
    compiled(&right(&text, &INPUTS))
}

const OWNED: [&str; 2] = [", owner: Foreign", ", owner: External"];

fn resource(plan: &Plan, name: &str) -> Resource {
    let image = plan.images.iter().find(|image| *image.name == *name).map(|image| Resource::Image(image.id));
    let buffer = || plan.buffers.iter().find(|it| *it.name == *name).map(|it| Resource::Buffer(it.id));
    image.or_else(buffer).unwrap_or_else(|| panic!("no `{name}`: {}", plan.tree()))
}

/// Each transfer with its step.
fn transfers(plan: &Plan) -> Vec<(usize, OutsideTransfer)> {
    plan.steps.iter().enumerate().flat_map(|(at, step)| step.outside.iter().map(move |it| (at, *it))).collect()
}

#[test]
fn do_11_a_plan_takes_what_has_an_outside_owner_and_gives_it_back() {
    let plan = shared(OWNED);
    let [camera, shown] = ["camera", "shown"].map(|name| resource(&plan, name));
    let last = plan.steps.len() - 1;
    let sampled = State {
        stages: Stages::FRAGMENT_SHADER,
        accesses: Accesses::SHADER_SAMPLED_READ,
        layout: Layout::ShaderReadOnlyOptimal,
    };
    let [Role::External { before, after, owner }, _] = [plan.role(camera), plan.role(shown)] else { panic!() };
    assert_eq!(*owner, Some(OutsideOwner::Foreign));
    let made = transfers(&plan);
    let of = |resource| made.iter().filter(move |(_, it)| it.resource == resource);
    let of_camera: Vec<_> = of(camera).map(|(at, it)| (*at, it.way, it.owner, it.state)).collect();
    let foreign = OutsideOwner::Foreign;
    assert_eq!(
        of_camera,
        [(0, OutsideWay::Acquire, foreign, *before), (of_camera[1].0, OutsideWay::Release, foreign, *after)]
    );
    assert_eq!(before.layout, sampled.layout);
    // What is in no layout isn't taken. Where no stages are stated, all of them are done.
    let everything = State { stages: Stages::ALL_COMMANDS, accesses: Accesses::MEMORY, layout: Layout::General };
    let of_shown: Vec<_> = of(shown).map(|(at, it)| (*at, it.way, it.owner, it.state)).collect();
    assert_eq!(of_shown, [(last, OutsideWay::Release, OutsideOwner::External, everything)]);
    assert_eq!(verify(&plan), []);

    let tree = plan.tree();
    for line in [
        "barrier: `camera`: taken from its foreign owner in SHADER_READ_ONLY_OPTIMAL (test.ron:2)",
        "barrier: `camera`: given back to its foreign owner in SHADER_READ_ONLY_OPTIMAL (test.ron:2)",
        "barrier: `shown`: given back to its external owner in GENERAL (test.ron:4)",
        ": external, its foreign owner has it between frames",
    ] {
        assert!(tree.contains(line), "{line}: {tree}");
    }
    let json = plan.to_json().expect("it has a JSON form");
    assert!(json.contains("\"owner\": \"FOREIGN\"") && json.contains("\"way\": \"acquire\""), "{json}");
    assert_eq!(Plan::from_json(&json).expect("it is read"), plan);
}

#[test]
fn do_11_a_plan_without_outside_owners_says_nothing_of_them() {
    let plan = shared(["", ""]);
    assert_eq!(transfers(&plan), []);
    let json = plan.to_json().expect("it has a JSON form");
    assert!(!json.contains("outside") && !json.contains("owner\""), "{json}");
    let owned = shared(OWNED);
    let more = |of: fn(&Totals) -> u32| of(&owned.totals) - of(&plan.totals);
    assert_eq!([more(|it| it.image_barriers), more(|it| it.barrier_calls), more(|it| it.memory_barriers)], [3, 3, 0]);
}

#[test]
fn do_11_owners_that_the_program_tells_make_the_plan_that_is_compiled_with_them() {
    let (plain, owned) = (shared(["", ""]), shared(OWNED));
    let mut told = plain.clone();
    let [camera, shown, half] = ["camera", "shown", "half"].map(|name| resource(&plain, name));
    told.set_owner(camera, Some(OutsideOwner::External)).expect("it is external");
    assert_eq!(verify(&told), []);
    told.set_owner(camera, Some(OutsideOwner::Foreign)).expect("it is external");
    told.set_owner(shown, Some(OutsideOwner::External)).expect("it is external");
    assert_eq!(told, owned);
    told.set_owner(camera, None).expect("it is external");
    told.set_owner(shown, None).expect("it is external");
    assert_eq!(told, plain);
    assert_eq!(told.set_owner(half, None), Err("`half` isn't external".to_owned()));
    assert_eq!(told, plain);
}

/// What the checker says of a Plan that was right.
fn broken(plan: &Plan, change: impl FnOnce(&mut Plan)) -> Vec<Violation> {
    let mut plan = plan.clone();
    change(&mut plan);
    plan.totals = Totals {
        transient_bytes: plan.totals.transient_bytes,
        placed_bytes: plan.totals.placed_bytes,
        live_peak_bytes: plan.totals.live_peak_bytes,
        kept_bytes: plan.totals.kept_bytes,
        ..Totals::count(&plan.steps)
    };
    verify(&plan)
}

#[test]
fn do_11_the_checker_finds_each_transfer_that_is_missing_or_wrong() {
    let plan = shared(OWNED);
    assert_eq!(broken(&plan, |_| {}), []);
    let last = plan.steps.len() - 1;
    let mut said = String::new();
    for (step, transfer) in transfers(&plan) {
        let at = plan.steps[step].outside.iter().position(|it| *it == transfer).expect("it is there");
        let mut fault = |what: &str, change: &dyn Fn(&mut Plan)| {
            let found = broken(&plan, change);
            assert!(!found.is_empty(), "{what}: {transfer:?} in step {step}");
            found.iter().for_each(|it| said += &format!("{what}: {it}\n"));
        };
        fault("missing", &|plan| {
            plan.steps[step].outside.remove(at);
        });
        fault("twice", &|plan| plan.steps[step].outside.push(transfer));
        fault("of another owner", &|plan| {
            plan.steps[step].outside[at].owner = match transfer.owner {
                OutsideOwner::External => OutsideOwner::Foreign,
                OutsideOwner::Foreign => OutsideOwner::External,
            };
        });
        fault("the other way", &|plan| {
            plan.steps[step].outside[at].way = match transfer.way {
                OutsideWay::Acquire => OutsideWay::Release,
                OutsideWay::Release => OutsideWay::Acquire,
            };
        });
        fault("in another layout", &|plan| plan.steps[step].outside[at].state.layout = Layout::TransferDstOptimal);
        fault("in fewer stages", &|plan| plan.steps[step].outside[at].state.stages = Stages::COPY);
        fault("for fewer accesses", &|plan| plan.steps[step].outside[at].state.accesses = Accesses::empty());
        fault("for unknown accesses", &|plan| {
            plan.steps[step].outside[at].state.accesses = Accesses::from_bits_retain(1 << 60);
        });
        let elsewhere = if transfer.way == OutsideWay::Acquire { last } else { 0 };
        if elsewhere != step {
            fault("too late or too early", &|plan| {
                let transfer = plan.steps[step].outside.remove(at);
                plan.steps[elsewhere].outside.push(transfer);
            });
        }
        fault("of what has no owner", &|plan| {
            let half = resource(plan, "half");
            plan.steps[step].outside.push(OutsideTransfer { resource: half, ..transfer });
        });
        fault("on another queue", &|plan| plan.steps[step].queue = Queue::Compute);
    }
    insta::assert_snapshot!(said);
}

#[test]
fn do_11_a_plan_from_outside_names_what_it_has() {
    let mut plan = shared(OWNED);
    let (step, _) = transfers(&plan)[0];
    plan.steps[step].outside[0].resource = Resource::Image(framewright_graph::plan::ImageId(99));
    let said = Plan::from_json(&plan.to_json().expect("it has a JSON form")).expect_err("there is no such image");
    assert!(said.to_string().contains(&format!("steps[{step}].outside")), "{said}");
}

/// A buffer that a dispatch reads goes to the compute queue, unless somebody else has it between frames.
#[test]
fn do_11_what_has_an_outside_owner_stays_on_one_queue() {
    let queues = Queues { compute: true, transfer: true, sharing: Sharing::Exclusive, wait_bytes: 0 };
    let plans = [None, Some(OutsideOwner::External)].map(|owner| {
        let mut builder = Builder::default();
        let before = State { stages: Stages::COPY, accesses: Accesses::TRANSFER_WRITE, layout: Layout::Undefined };
        let [shadow, texture, screen] = ["shadow", "texture", "screen"].map(|name| builder.image(name));
        let staging = builder.buffer("staging", Lifetime::Imported { before, after: None, owner });
        builder.copy(
            "upload",
            framewright_graph::frame::Resource::Buffer(staging),
            framewright_graph::frame::Resource::Image(texture),
        );
        builder.draw("shadows", &[], &[], shadow);
        builder.draw("lit", &[shadow, texture], &[], screen);
        on(&builder.output(screen), &Profile { queues, ..shipped("lavapipe") }).expect("it is right")
    });
    let [plain, mut owned] = plans;
    assert!(plain.steps.iter().any(|step| step.queue == Queue::Transfer), "{}", plain.tree());
    assert!(owned.steps.iter().all(|step| step.queue == Queue::Graphics), "{}", owned.tree());
    assert_eq!(transfers(&owned).len(), 2, "{}", owned.tree());
    assert_eq!(verify(&owned), []);
    assert!(owned.tree().contains("`staging`: taken from its external owner"), "{}", owned.tree());
    // Two queues: the program is told, and the checker says so of such a Plan.
    let staging = resource(&owned, "staging");
    let user = owned.steps.iter().position(|step| step.touched().any(|it| it == staging)).expect("it is used");
    let copy = owned.steps[user].clone();
    owned.steps.push(framewright_graph::plan::Step { queue: Queue::Compute, outside: Vec::new(), ..copy });
    let said = owned.set_owner(staging, Some(OutsideOwner::Foreign)).expect_err("two queues use it");
    assert!(said.contains("several queues use `staging`"), "{said}");
    assert!(verify(&owned).iter().any(|it| it.to_string().contains("is used on two queues")), "{:?}", verify(&owned));
}

/// Two passes that run in these frames shrink a camera's picture, and others show what they made.
fn taken_now_and_then([first, second]: [&str; 2], owner: &str) -> Plan {
    let text = format!(
        r#"Pipeline(version: 1, images: [
            (name: "camera", format: R8G8B8A8_UNORM, size: Output, lifetime: Imported(before: Sampled, after: Sampled{owner})),
            (name: "half", format: R8G8B8A8_UNORM, size: Scaled(0.5)), (name: "other_half", format: R8G8B8A8_UNORM, size: Scaled(0.5)),
            (name: "shown", format: R8G8B8A8_UNORM, size: Output), (name: "other", format: R8G8B8A8_UNORM, size: Output)],
         passes: [
            (name: "first", run: {first}, draw: FullScreen("downsample"), sample: {{"source": "camera"}}, color: ["half"]),
            (name: "second", run: {second}, draw: FullScreen("downsample"), sample: {{"source": "camera"}}, color: ["other_half"]),
            (name: "show", draw: FullScreen("downsample"), sample: {{"source": "half"}}, color: ["shown"]),
            (name: "show_other", draw: FullScreen("downsample"), sample: {{"source": "other_half"}}, color: ["other"])],
         outputs: ["shown", "other"])"#
    );
    compiled(&right(&text, &INPUTS))
}

/// Barriers stand in every frame, so a step that is left out takes and gives as it does where it runs (DO-9).
#[test]
fn do_11_what_has_an_outside_owner_changes_hands_in_frames_that_leave_its_users_out() {
    for runs in [["Once", "Always"], ["Always", "Once"], ["Once", "Once"], ["Every(4)", "Once"]] {
        let plan = taken_now_and_then(runs, ", owner: Foreign");
        let (camera, tree) = (resource(&plan, "camera"), plan.tree());
        let users = (0..plan.steps.len()).filter(|step| plan.steps[*step].work.used().any(|(it, _)| it == camera));
        let users: Vec<usize> = users.collect();
        assert_eq!(users.len(), 2, "{runs:?}: {tree}");
        assert!(users.iter().any(|step| !plan.steps[*step].run.is_always()), "{runs:?}: {tree}");
        let made: Vec<_> = transfers(&plan).into_iter().map(|(step, it)| (step, it.way)).collect();
        assert_eq!(made, [(users[0], OutsideWay::Acquire), (users[1], OutsideWay::Release)], "{runs:?}: {tree}");
        assert_eq!(verify(&plan), [], "{runs:?}: {tree}");
        let mut told = taken_now_and_then(runs, "");
        told.set_owner(camera, Some(OutsideOwner::Foreign)).expect("it is external");
        assert_eq!(told, plan, "{runs:?}");
        // What always runs can't take it for what ran before it once, and what runs once can't give it back too early.
        for [from, to] in [[users[0], users[1]], [users[1], users[0]]] {
            let found = broken(&plan, |plan| {
                let transfer = plan.steps[from].outside.remove(0);
                plan.steps[to].outside.push(transfer);
            });
            assert!(
                found.iter().any(|it| it.to_string().contains("is given back") || it.to_string().contains("is taken"))
            );
        }
    }
}

/// Each eye's image is taken for itself, and an image that holds both eyes' parts as a whole.
#[test]
fn do_11_what_each_eye_has_changes_hands_for_both() {
    let plan = |stereo, [first, second]: [&str; 2]| {
        let text = format!(
            r#"Pipeline(version: 1, images: [
                (name: "camera", format: R8G8B8A8_UNORM, size: Output, per_eye: true, lifetime: Imported(before: Sampled, after: Sampled{first})),
                (name: "shown", format: R8G8B8A8_UNORM, size: Output, per_eye: true,
                    lifetime: Imported(before: Undefined, after: (stages: [], accesses: [], layout: GENERAL){second}))],
             passes: [(name: "show", draw: FullScreen("reinhard"), sample: {{"source": "camera"}}, color: ["shown"])],
             outputs: ["shown"])"#
        );
        compiled(&right(&text, &Inputs { stereo, ..INPUTS }))
    };
    let sides = ["camera (left)", "camera (right)", "shown (left)", "shown (right)"];
    let whole = ["camera", "shown"];
    for (stereo, names) in [
        (Stereo::Off, &whole[..]),
        (Stereo::MultiPass, &sides[..]),
        (Stereo::DoubleWide, &whole[..]),
        (Stereo::Instanced, &whole[..]),
        (Stereo::Multiview, &whole[..]),
    ] {
        let owned = plan(stereo, OWNED);
        let tree = owned.tree();
        let of = |name: &str| {
            let resource = resource(&owned, name);
            let made = transfers(&owned).into_iter().filter(move |(_, it)| it.resource == resource);
            made.map(|(_, it)| (it.way, it.owner)).collect::<Vec<_>>()
        };
        for name in names {
            let expected = if name.starts_with("camera") {
                vec![(OutsideWay::Acquire, OutsideOwner::Foreign), (OutsideWay::Release, OutsideOwner::Foreign)]
            } else {
                vec![(OutsideWay::Release, OutsideOwner::External)]
            };
            assert_eq!(of(name), expected, "{stereo:?}, `{name}`: {tree}");
            let Resource::Image(image) = resource(&owned, name) else { panic!("`{name}` is an image") };
            let at_once = stereo != Stereo::Off && names.len() == whole.len();
            assert_eq!(owned.image(image).eyes.is_some(), at_once, "{stereo:?}, `{name}`: {tree}");
        }
        assert_eq!(transfers(&owned).len(), names.len() / 2 * 3, "{stereo:?}: {tree}");
        assert_eq!(verify(&owned), [], "{stereo:?}: {tree}");
        let mut told = plan(stereo, ["", ""]);
        for name in names {
            let owner = if name.starts_with("camera") { OutsideOwner::Foreign } else { OutsideOwner::External };
            told.set_owner(resource(&told, name), Some(owner)).expect("it is external");
        }
        assert_eq!(told, owned, "{stereo:?}");
    }
}
