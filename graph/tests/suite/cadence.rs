//! Passes that don't run in every frame: what they leave stays, and a Plan holds where they are left out (DO-9).

use crate::testing::pipelines::{INPUTS, right, set, wrong};
use crate::testing::plans::{compiled, image, on, refused};
use framewright_graph::compile::{Compiler, Options, Reuse};
use framewright_graph::device::{MemoryEstimate, Profile, Queues};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Cadence, Frame, FrameValue, ParamValue, Stereo};
use framewright_graph::plan::{AttachmentKind, NoteKind, Plan, Role, Step, Work};
use framewright_graph::verify::{Rule, verify};
use framewright_graph::vulkan::{Layout, LoadOp, StoreOp};
use std::sync::Arc;

/// A pipeline of a map that `draw` draws and `show` samples.
fn map(samples: u32, run: &str, more: &str) -> String {
    format!(
        r#"Pipeline(version: 1, settings: [(name: "n", value: OneOf(default: 4, of: [1, 2, 4]))], images: [
            (name: "map", format: R16G16B16A16_SFLOAT, size: Fixed(64, 64), samples: {samples}),
            (name: "depth", format: D32_SFLOAT, size: Like("map"), samples: Like("map")),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [
            (name: "draw", {run} draw: Objects(Opaque), shader: "lit", color: [(image: "map", clear: (0, 0, 0, 1))],
             depth: (image: "depth", clear: 0.0)),
            {more}
            (name: "show", draw: FullScreen("tone_map"), sample: {{"source": "map"}}, params: {{"exposure": 1.0, "white_point": 1.0}},
             color: ["screen"])], outputs: ["screen"])"#
    )
}

fn planned(text: &str) -> Plan {
    compiled(&right(text, &INPUTS))
}

/// What the compiler refuses in a pipeline that the language takes.
fn refused_text(text: &str) -> String {
    refused(&right(text, &INPUTS)).join("\n")
}

fn step<'p>(plan: &'p Plan, name: &str) -> &'p Step {
    let has = |step: &&Step| step.work.passes().iter().any(|pass| *pass.name == *name);
    plan.steps.iter().find(has).unwrap_or_else(|| panic!("no `{name}`: {}", plan.tree()))
}

fn is_kept(plan: &Plan, name: &str) -> bool {
    matches!(image(plan, name).role, Role::Persistent { becomes, .. } if becomes == image(plan, name).id.0)
}

#[test]
fn do_9_what_a_pass_leaves_for_other_frames_has_memory_of_its_own() {
    let plan = planned(&map(1, "run: Every(4),", ""));
    let draw = step(&plan, "draw");
    assert_eq!(draw.run, Cadence::Every { count: 4, at: 0 });
    assert_eq!(step(&plan, "show").run, Cadence::Always);
    assert!(is_kept(&plan, "map"));
    // Depth serves its own scope alone: it is transient, and never stored.
    assert!(matches!(image(&plan, "depth").role, Role::Transient(_)));
    let attachments = &draw.work.scope().expect("it draws").attachments;
    let [color, depth] = &attachments[..] else { panic!("{}", plan.tree()) };
    assert_eq!((color.load, color.store), (LoadOp::Clear, StoreOp::Store));
    assert_eq!((depth.kind, depth.store), (AttachmentKind::Depth, StoreOp::DontCare));
    // The barrier stands in each frame: it keeps what was drawn.
    let map = image(&plan, "map").id;
    let barrier = draw.image_barriers.iter().find(|it| it.image == map).expect("the layout changes");
    assert_ne!(barrier.old_layout, Layout::Undefined, "{}", plan.tree());
    let note = plan.notes.iter().find(|note| note.kind == NoteKind::Stays).expect("the Plan says why");
    assert_eq!((&*note.subject, note.at.as_ref().map(|at| at.line)), ("map", Some(6)));
    assert_eq!(note.text, "stays from frame to frame: `draw`, which runs every 4 frames, writes it for `show`");
    assert!(plan.tree().contains("step 0, runs every 4 frames: rendering scope"), "{}", plan.tree());
}

#[test]
fn do_9_what_runs_together_leaves_nothing_and_shares_memory() {
    let all = map(1, "run: Once,", "").replace(r#"(name: "show","#, r#"(name: "show", run: Once,"#);
    let text = all.replace(
        r#"(name: "screen", format: R8G8B8A8_UNORM, size: Output)"#,
        r#"(name: "screen", format: R8G8B8A8_UNORM, size: Output, lifetime: Persistent)"#,
    );
    let plan = planned(&text);
    assert!(matches!(image(&plan, "map").role, Role::Transient(_)), "{}", plan.tree());
    assert!(step(&plan, "draw").run == Cadence::Once && step(&plan, "show").run == Cadence::Once);
}

#[test]
fn do_9_a_plan_of_passes_that_always_run_is_what_it_was() {
    let (plain, said) = (planned(&map(4, "", "")), planned(&map(4, "run: Always,", "")));
    assert_eq!(plain.steps, said.steps);
    let json = serde_json::to_string(&said).expect("a Plan is written");
    assert!(!json.contains("\"run\""), "{json}");
    let every = planned(&map(4, r#"run: Every("n"),"#, ""));
    let json = serde_json::to_string(&every).expect("a Plan is written");
    assert!(json.contains(r#""run":{"every":{"count":4,"at":0}}"#), "{json}");
    assert_eq!(serde_json::from_str::<Plan>(&json).expect("it is read"), every);
    // One frame of one is each frame.
    let one = Inputs { set: &set(&[("n", "1")]), ..INPUTS };
    let one = compiled(&right(&map(4, r#"run: Every("n"),"#, ""), &one));
    assert!(one.steps.iter().all(|step| step.run == Cadence::Always));
}

#[test]
fn do_9_resolves_follow_what_they_resolve() {
    for run in ["Once", "Every(count: 3, at: 2)", r#"WhenDirty("sun")"#] {
        let plan = planned(&map(4, &format!("run: {run},"), ""));
        let scope = step(&plan, "draw").work.scope().expect("it draws");
        assert!(scope.attachments[0].resolve.is_some(), "{}", plan.tree());
        assert!(is_kept(&plan, "map (resolved)"), "{}", plan.tree());
        assert!(matches!(image(&plan, "map").role, Role::Transient(_)), "{}", plan.tree());
        assert_eq!(scope.attachments[0].store, StoreOp::DontCare);
    }
}

#[test]
fn do_9_scopes_are_shared_by_passes_that_run_together() {
    let blend = |run: &str| {
        format!(
            r#"(name: "more", {run} draw: Objects(Transparent), shader: "lit", color: [(image: "map", blend: Alpha)]),"#
        )
    };
    let together = planned(&map(1, "run: Once,", &blend("run: Once,")));
    assert_eq!(step(&together, "draw").work.passes().len(), 2);
    // `more` adds to what is there, and the pass that reads it runs in other frames: that can't be told apart.
    let apart = refused_text(&map(1, "", &blend("run: Once,")));
    assert!(
        apart.contains(
            "`draw` runs always and writes `map`, which `more` writes too, once; `show` reads it in other frames"
        ),
        "{apart}"
    );
    // Of an image that is declared to persist, what was written last stands.
    let persistent =
        map(1, "", &blend("run: Once,")).replace("size: Fixed(64, 64),", "size: Fixed(64, 64), lifetime: Persistent,");
    let plan = planned(&persistent);
    assert!(step(&plan, "draw").work.passes().len() == 1 && step(&plan, "more").run == Cadence::Once);
    let note = plan.notes.iter().find(|note| note.kind == NoteKind::OwnScope && &*note.subject == "more");
    assert!(note.is_some_and(|note| note.text.ends_with("the scope before it runs always")), "{}", plan.tree());
}

#[test]
fn do_9_what_a_pass_would_replace_stays_where_it_is_left_out() {
    // `fill` runs in each frame, and `replace` sometimes covers all that it wrote: its contents are stored, and it isn't culled.
    let text = r#"Pipeline(version: 1, images: [
            (name: "kept", format: R8G8B8A8_UNORM, size: Output, lifetime: Persistent),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [
            (name: "fill", draw: FullScreen("plain"), color: ["kept"]),
            (name: "replace", run: WhenDirty("kept"), draw: FullScreen("plain"), color: [(image: "kept", clear: (0, 0, 0, 1))]),
            (name: "show", draw: FullScreen("copy"), sample: {"source": "kept"}, color: ["screen"])], outputs: ["screen"])"#;
    let plan = planned(text);
    let scope = step(&plan, "fill").work.scope().expect("it draws");
    assert_eq!(scope.attachments[0].store, StoreOp::Store, "{}", plan.tree());
    let of_replace = &step(&plan, "replace").image_barriers;
    assert!(of_replace.iter().all(|barrier| barrier.old_layout != Layout::Undefined), "{}", plan.tree());
}

/// Six faces, each drawn in one frame of six with a depth image that all of them use.
const FACES: &str = r#"Pipeline(version: 1, images: [
        (name: "faces", format: R8G8B8A8_UNORM, size: Fixed(64, 64), layers: 6),
        (name: "depth", format: D32_SFLOAT, size: Fixed(64, 64)),
        (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
     passes: [
        (name: "face", repeat: ("i", 6), run: Every(count: 6, at: "i"), draw: Objects(Opaque), shader: "lit",
         color: [(image: "faces", layer: "i", clear: (0, 0, 0, 1))], depth: (image: "depth", clear: 0.0)),
        (name: "show", custom: "show", reads: ["faces"], writes: ["screen"])], outputs: ["screen"])"#;

#[test]
fn do_9_faces_of_a_cube_are_drawn_one_a_frame() {
    let plan = planned(FACES);
    for at in 0..6 {
        assert_eq!(step(&plan, &format!("face[{at}]")).run, Cadence::Every { count: 6, at });
    }
    assert!(is_kept(&plan, "faces"));
    assert!(matches!(image(&plan, "depth").role, Role::Transient(_)), "{}", plan.tree());
    assert_eq!(plan.notes.iter().filter(|note| note.kind == NoteKind::Stays).count(), 1);
}

#[test]
fn do_9_a_use_says_it_for_all_its_passes() {
    let text = r#"Pipeline(version: 1, fragments: [(name: "half", parameters: [(name: "to", value: Image)],
            passes: [(name: "a", draw: FullScreen("plain"), color: ["to"]),
                (name: "b", run: Always, custom: "note", reads: ["to"], side_effect: true)])],
         images: [(name: "map", format: R8G8B8A8_UNORM, size: Output), (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [(use: "half", name: "first", run: Every(count: 8, at: 7), with: {"to": "map"}),
            (name: "show", draw: FullScreen("copy"), sample: {"source": "map"}, color: ["screen"])], outputs: ["screen"])"#;
    let plan = planned(text);
    assert_eq!(step(&plan, "first.a").run, Cadence::Every { count: 8, at: 7 });
    assert_eq!(step(&plan, "first.b").run, Cadence::Always);
}

#[test]
fn do_9_several_queues_and_two_eyes() {
    let text = r#"Pipeline(version: 1, images: [
            (name: "map", format: R16G16B16A16_SFLOAT, size: Fixed(256, 256), per_eye: true),
            (name: "half", format: R16G16B16A16_SFLOAT, size: Fixed(256, 256), per_eye: true),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output, per_eye: true)],
         passes: [
            (name: "draw", run: Every(2), draw: Objects(Opaque), shader: "lit", color: [(image: "map", clear: (0, 0, 0, 1))]),
            (name: "halve", run: Every(count: 2, at: 1), dispatch: "halve", groups: Texels("half"), sample: {"source": "map"}, storage: {"target": "half"}),
            (name: "show", draw: FullScreen("copy"), sample: {"source": "half"}, color: ["screen"])], outputs: ["screen"])"#;
    for stereo in [Stereo::Off, Stereo::MultiPass, Stereo::Multiview] {
        let frame = match stereo {
            Stereo::Multiview => right(&text.replace("per_eye: true", "per_eye: false"), &INPUTS),
            _ => right(text, &Inputs { stereo, ..INPUTS }),
        };
        for queues in [Queues::default(), Queues { compute: true, transfer: true, ..Queues::default() }] {
            let device = Profile { queues, ..crate::testing::parts::device() };
            let plan = on(&frame, &device).unwrap_or_else(|errors| panic!("{errors:?}"));
            let runs = plan.steps.iter().filter(|step| step.run != Cadence::Always).count();
            assert_eq!(runs, if stereo == Stereo::MultiPass { 4 } else { 2 }, "{}", plan.tree());
        }
    }
}

#[test]
fn do_9_a_change_of_run_is_compiled_anew() {
    let [one, other] = ["run: Once,", "run: Every(2),"].map(|run| right(&map(1, run, ""), &INPUTS));
    let device = Arc::new(crate::testing::parts::device());
    let mut compiler = Compiler::new();
    let mut compile = |frame: &Frame| {
        let memory = &mut MemoryEstimate(&device);
        let plan = compiler.compile(&Arc::new(frame.clone()), &device, memory, &Options::default());
        let plan = plan.expect("it is valid").clone();
        (plan, compiler.reuse())
    };
    compile(&one);
    let (plan, reuse) = compile(&other);
    assert!(reuse == Reuse::Nothing && step(&plan, "draw").run == Cadence::Every { count: 2, at: 0 });
    assert!(compiled(&one).differs_beyond_values(&plan).is_some());
}

#[test]
fn do_9_the_checker_walks_without_what_is_left_out() {
    let plan = planned(&map(1, "run: Every(4),", ""));
    let rules = |edit: &dyn Fn(&mut Plan)| -> Vec<Rule> {
        let mut wrong = plan.clone();
        edit(&mut wrong);
        verify(&wrong).into_iter().map(|violation| violation.rule).collect()
    };
    // The barrier before the map's clear may forget what was there, unless the clear is left out.
    let map = image(&plan, "map").id;
    let forget = |plan: &mut Plan| {
        let barriers = plan.steps[0].image_barriers.iter_mut().filter(|barrier| barrier.image == map);
        barriers.for_each(|barrier| barrier.old_layout = Layout::Undefined);
    };
    let forgets = rules(&forget);
    assert!(matches!(forgets[..], [Rule::LostWrite { .. }]), "{forgets:?}");
    let always = rules(&|plan| {
        forget(plan);
        plan.steps[0].run = Cadence::Always;
    });
    assert_eq!(always, []);
    for run in [Cadence::Every { count: 1, at: 0 }, Cadence::Every { count: 3, at: 3 }, Cadence::WhenDirty("".into())] {
        let found = rules(&|plan| plan.steps[0].run = run.clone());
        assert!(matches!(&found[..], [Rule::Structure { .. }]), "{found:?}");
    }
    let export = plan.steps.iter().position(|step| matches!(step.work, Work::Export));
    if let Some(export) = export {
        assert!(!rules(&|plan| plan.steps[export].run = Cadence::Once).is_empty());
    }
}

#[test]
fn do_9_mistakes() {
    // E0722
    let numbers = wrong(&map(1, "run: Every(count: 4, at: 4),", ""), &INPUTS);
    assert!(
        numbers.contains("E0722") && numbers.contains("in frame 4 of 4, which are numbered from 0 to 3"),
        "{numbers}"
    );
    let zero = wrong(&map(1, "run: Every(0),", ""), &INPUTS);
    assert!(zero.contains("0 is no number of frames: 1 to 1000000"), "{zero}");
    let huge = wrong(&map(1, "run: Every(1000001),", ""), &INPUTS);
    assert!(huge.contains("1000001 is no number of frames"), "{huge}");
    let word = wrong(&map(1, "run: Sometimes,", ""), &INPUTS);
    assert!(word.contains("`Always`, `Once`, `Every(4)`"), "{word}");
    assert!(wrong(&map(1, "run: WhenDirty,", ""), &INPUTS).contains("WhenDirty(\"name\")"));
    assert!(
        wrong(&map(1, r#"run: WhenDirty("a b"),"#, ""), &INPUTS)
            .contains("can't be the name of what the program calls dirty")
    );
    let mut frame = right(&map(1, "", ""), &INPUTS);
    for (run, what) in [
        (Cadence::Every { count: 0, at: 0 }, "every 0 frames; 2 to 1000000 are possible"),
        (Cadence::Every { count: 3, at: 5 }, "in frame 5 of 3"),
        (Cadence::Every { count: 1, at: 1 }, "in frame 1 of 1, which has the number 0"),
        (Cadence::WhenDirty("".into()), "without a name"),
    ] {
        frame.passes[0].run = run;
        assert!(refused(&frame).join("\n").contains(what), "{:?}", refused(&frame));
    }
    // E0723: others write what stays, before or after it is read.
    let again =
        r#"(name: "again", draw: Objects(Opaque), shader: "lit", color: [(image: "map", clear: (0, 0, 0, 1))]),"#;
    let others = map(1, "", again).replace(r#"(name: "again","#, r#"(name: "again", run: Once,"#);
    assert!(refused_text(&others).contains("`draw` runs always and writes `map`, which `again` writes too, once"));
    let between = r#"(name: "early", custom: "look", reads: ["map"], side_effect: true),
        (name: "later", run: Once, draw: Objects(Transparent), shader: "lit", color: [(image: "map", blend: Alpha)]),"#;
    let between = refused_text(&map(1, "run: Once,", between));
    assert!(between.contains("`later` writes `map` after `early` read it"), "{between}");
    // E0724: what can't stay.
    let outputs = map(1, "", "").replace(r#"(name: "show","#, r#"(name: "show", run: Every(2),"#);
    let outputs = refused_text(&outputs);
    assert!(outputs.contains("`show` runs every 2 frames, and writes `screen`, which is an output"), "{outputs}");
    let past = r#"(name: "past", custom: "past", reads: [(image: "map", previous: 1)], side_effect: true),"#;
    for (lifetime, more, what) in [
        ("History", past, "has a history, which each frame writes anew"),
        ("Imported(before: Undefined)", "", "is handed in"),
    ] {
        let text = map(1, "run: Once,", more)
            .replace("size: Fixed(64, 64),", &format!("size: Fixed(64, 64), lifetime: {lifetime},"));
        let refused = refused_text(&text);
        assert!(refused.contains(what), "{refused}");
    }
}

#[test]
fn do_9_an_image_that_changes_its_size_can_t_stay() {
    let mut frame = right(&map(1, "run: Once,", ""), &INPUTS);
    for image in &mut frame.images[..2] {
        image.allocated = Some([128, 128]);
    }
    assert!(refused(&frame).join("\n").contains("changes its size from frame to frame"), "{:?}", refused(&frame));
}

#[test]
fn do_9_a_forwarded_image_is_no_way_around_the_rules() {
    // `grade` is off: `map` and `out` are one image, into which `more` draws in each frame.
    let text = r#"Pipeline(version: 1, settings: [(name: "on", value: Bool(default: false))], images: [
            (name: "map", format: R8G8B8A8_UNORM, size: Output), (name: "out", format: R8G8B8A8_UNORM, size: Output),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [
            (name: "draw", run: Once, draw: FullScreen("plain"), color: ["map"]),
            (name: "grade", when: "on", draw: FullScreen("copy"), sample: {"source": "map"}, color: ["out"],
             otherwise: Forward(from: "map", to: "out")),
            (name: "more", draw: Objects(Transparent), shader: "lit", color: [(image: "out", blend: Alpha)]),
            (name: "show", draw: FullScreen("copy"), sample: {"source": "out"}, color: ["screen"])], outputs: ["screen"])"#;
    assert!(compiled(&right(text, &Inputs { set: &set(&[("on", "true")]), ..INPUTS })).steps.len() > 2);
    let forwarded = refused_text(text);
    assert!(forwarded.contains("`draw` runs once, and writes") && forwarded.contains("`more`"), "{forwarded}");
}

/// A full-screen pass whose parameter `exposure` is this, and what else the pipeline declares.
fn exposed(exposure: &str, settings: &str) -> String {
    map(1, "", "")
        .replace(r#""exposure": 1.0"#, &format!(r#""exposure": {exposure}"#))
        .replace("settings: [", &format!("settings: [{settings}"))
}

#[test]
fn do_9_the_frame_s_number_and_time_are_parameters() {
    let plan = planned(&exposed(r#""time""#, ""));
    let value = |plan: &Plan| step(plan, "show").work.passes()[0].params[0].value.clone();
    assert_eq!(value(&plan), ParamValue::OfFrame(FrameValue::Time));
    let json = serde_json::to_string(&plan).expect("a Plan is written");
    assert!(json.contains(r#"{"name":"exposure","value":"time"}"#), "{json}");
    assert_eq!(serde_json::from_str::<Plan>(&json).expect("it is read"), plan);
    assert!(plan.tree().contains("exposure = time"), "{}", plan.tree());
    // What the pipeline calls so itself is that.
    let own = planned(&exposed(r#""time""#, r#"(name: "time", value: Number(default: 3.0, min: 0.0, max: 9.0)), "#));
    assert_eq!(value(&own), ParamValue::Number(3.0));
    // Another value, and no other Plan.
    let constant = planned(&exposed("2.0", ""));
    assert_eq!(constant.differs_beyond_values(&plan), None);
}

#[test]
fn do_9_the_frame_s_number_and_time_stand_alone_and_in_parameters_alone() {
    let integer = wrong(&exposed(r#""frame""#, ""), &INPUTS);
    assert!(integer.contains("E0807") || integer.contains("can't be `frame`"), "{integer}");
    assert!(integer.contains("`frame` is a `uint`, and `time` a `float`"), "{integer}");
    let sum = wrong(&exposed(r#""time + 1.0""#, ""), &INPUTS);
    assert!(sum.contains("E0311") && sum.contains("`time` is another value in each frame"), "{sum}");
    assert!(sum.contains("it stands alone in `params`"), "{sum}");
    let size = wrong(&map(1, "", "").replace("Fixed(64, 64)", r#"Fixed("frame + 1", 64)"#), &INPUTS);
    assert!(size.contains("E0311") && size.contains("`frame` is another value in each frame"), "{size}");
    assert!(size.contains("`run: Once`"), "{size}");
}

/// `sky` is drawn once, and `grade` is off: it forwards `sky` to `kept`, an image of this lifetime.
fn forwarded(lifetime: &str) -> String {
    format!(
        r#"Pipeline(version: 1, settings: [(name: "on", value: Bool(default: false))], images: [
            (name: "sky", format: R8G8B8A8_UNORM, size: Output),
            (name: "kept", format: R8G8B8A8_UNORM, size: Output, lifetime: {lifetime}),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [
            (name: "draw", run: Once, draw: FullScreen("plain"), color: ["sky"]),
            (name: "grade", when: "on", draw: FullScreen("copy"), sample: {{"source": "sky"}}, color: ["kept"],
             otherwise: Forward(from: "sky", to: "kept")),
            (name: "past", custom: "past", reads: [(image: "kept", previous: 1)], side_effect: true),
            (name: "show", draw: FullScreen("copy"), sample: {{"source": "kept"}}, color: ["screen"])], outputs: ["screen"])"#
    )
}

#[test]
fn do_9_an_image_that_a_pass_which_is_off_forwards_is_copied_in_each_frame() {
    let plan = planned(&forwarded("History"));
    let copy = plan.steps.iter().find(|step| matches!(step.work, Work::Copy(_))).expect("the images aren't one");
    assert_eq!(copy.run, Cadence::Always, "{}", plan.tree());
    assert_eq!(step(&plan, "draw").run, Cadence::Once);
    assert!(is_kept(&plan, "sky"), "{}", plan.tree());
}

#[test]
fn do_9_a_stand_in_that_clears_runs_as_its_pass_does() {
    let first = r#"(name: "first", run: Once, when: "n == 2", draw: Objects(Opaque), shader: "lit",
        color: [(image: "map", clear: (0, 0, 0, 1))], otherwise: Clear(image: "map", value: (0, 0, 0, 1))),
        (name: "draw", run: Once, draw: Objects(Transparent), shader: "lit", color: [(image: "map", blend: Alpha)]),"#;
    let text = map(1, "", first);
    let own = text.find(r#"(name: "draw",  draw"#).expect("the first pass");
    let end = text.find(r#"(name: "first""#).expect("the next one");
    let text = [&text[..own], &text[end..]].concat();
    let plan = planned(&text);
    let fill = plan.steps.iter().find(|step| matches!(step.work, Work::Fill(_)));
    let fill = fill.map_or_else(|| &step(&plan, "draw").run, |step| &step.run);
    assert_eq!(*fill, Cadence::Once, "{}", plan.tree());
}

#[test]
fn do_9_bytes_behind_texels_are_filled_when_they_are_copied() {
    let text = r#"Pipeline(version: 1,
        images: [(name: "a", format: R8_UNORM, size: Fixed(3, 1), lifetime: Persistent)],
        buffers: [(name: "b", bytes: 4), (name: "c", bytes: 4)],
        passes: [(name: "read_back", run: Every(2), copy: (from: "a", to: "b")), (name: "on", copy: (from: "b", to: "c"))],
        outputs: [(buffer: "c")])"#;
    let plan = planned(text);
    let runs: Vec<&Cadence> = plan.steps.iter().map(|step| &step.run).take(2).collect();
    assert_eq!(runs, [&Cadence::Every { count: 2, at: 0 }; 2], "{}", plan.tree());
}

#[test]
fn do_9_a_pass_that_only_clears_what_nobody_reads_is_culled() {
    // `both` clears `map` and `other` once; nobody reads `map`, so `first` clears it for nothing.
    let text = r#"Pipeline(version: 1, images: [
            (name: "map", format: R8G8B8A8_UNORM, size: Output), (name: "other", format: R8G8B8A8_UNORM, size: Output),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [
            (name: "first", draw: Objects(Opaque), shader: "lit", color: [(image: "map", clear: (0, 0, 0, 1))]),
            (name: "both", run: Once, custom: "both", writes: ["map", "other"]),
            (name: "show", draw: FullScreen("copy"), sample: {"source": "other"}, color: ["screen"])], outputs: ["screen"])"#;
    let plan = planned(text);
    let has = |name: &str| plan.steps.iter().any(|step| step.work.passes().iter().any(|pass| *pass.name == *name));
    assert!(!has("first") && has("show"), "{}", plan.tree());
}

#[test]
fn do_9_a_transient_image_of_several_passes_that_run_seldom_is_never_stored() {
    let face = |at: u32| {
        format!(
            r#"(name: "a{at}", run: Every(count: 2, at: {at}), draw: Objects(Opaque), shader: "lit",
             color: [(image: "faces", layer: {at}, clear: (0, 0, 0, 1))], depth: (image: "depth", clear: 0.0)),
            (name: "b{at}", run: Every(count: 2, at: {at}), draw: Objects(Transparent), shader: "lit",
             color: [(image: "faces", layer: {at}, blend: Alpha)], depth: (image: "depth", write: false)),"#
        )
    };
    let text = format!(
        r#"Pipeline(version: 1, images: [
            (name: "faces", format: R8G8B8A8_UNORM, size: Fixed(64, 64), layers: 2),
            (name: "depth", format: D32_SFLOAT, size: Fixed(64, 64)),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [{}{}
            (name: "show", custom: "show", reads: ["faces"], writes: ["screen"])], outputs: ["screen"])"#,
        face(0),
        face(1)
    );
    let plan = planned(&text);
    for name in ["a0", "a1"] {
        let scope = step(&plan, name).work.scope().expect("it draws");
        let depth = scope.attachments.iter().find(|it| it.kind == AttachmentKind::Depth).expect("it has depth");
        assert_eq!((depth.load, depth.store), (LoadOp::Clear, StoreOp::DontCare), "{name}: {}", plan.tree());
    }
}

#[test]
fn do_9_a_dump_of_what_stays_is_refused_in_words_of_the_dump() {
    let dump = |image: &str| [image.to_owned()];
    let refused = wrong(&map(1, "run: Every(4),", ""), &Inputs { dump: &dump("map"), ..INPUTS });
    assert!(
        refused
            .contains("`map` can't be dumped: `draw` runs every 4 frames, and what is dumped is written in each frame"),
        "{refused}"
    );
    right(&map(1, "run: Every(4),", ""), &Inputs { dump: &dump("screen"), ..INPUTS });
    right(&map(1, "", ""), &Inputs { dump: &dump("map"), ..INPUTS });
    let persistent =
        map(1, "run: Every(4),", "").replace("size: Fixed(64, 64),", "size: Fixed(64, 64), lifetime: Persistent,");
    compiled(&right(&persistent, &Inputs { dump: &dump("map"), ..INPUTS }));
}
