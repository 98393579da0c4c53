//! Custom passes that declare what they do: the Plan waits for that alone, and what can't be is refused (DO-8).

use crate::testing::parts;
use crate::testing::pipelines::{INPUTS, right, wrong};
use crate::testing::plans::{compiled, image, on, refused};
use framewright_graph::device::{Profile, Queues};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{DeclaredUse, Eye, ImageIndex, Pass, Resource, Stereo, Work};
use framewright_graph::plan::{self, Plan, Queue, Step};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Accesses, BufferUsage, Layout, Sharing, Stages, State, Usage};

/// A pipeline whose pass `build` is custom: what it names and declares is `fields`.
fn text(fields: &str) -> String {
    format!(
        r#"Pipeline(version: 1, images: [
            (name: "screen", format: R8G8B8A8_UNORM, size: Output),
            (name: "mask", format: R16G16B16A16_SFLOAT, size: Fixed(64, 64), mips: 3, layers: 2),
            (name: "kept", format: R16G16B16A16_SFLOAT, size: Fixed(64, 64), lifetime: Persistent),
            (name: "stencil", format: D32_SFLOAT_S8_UINT, size: Output, lifetime: Persistent),
            (name: "msaa", format: R8G8B8A8_UNORM, size: Output, samples: 4, lifetime: Persistent),
            (name: "past", format: R16G16B16A16_SFLOAT, size: Fixed(64, 64), lifetime: History)],
         buffers: [(name: "list", bytes: 256), (name: "old", bytes: 256, lifetime: Persistent)],
         passes: [(name: "build", custom: "build", side_effect: true, {fields}),
            (name: "show", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#
    )
}

fn planned(fields: &str) -> Plan {
    compiled(&right(&text(fields), &INPUTS))
}

/// What is wrong with the pass, without the lines of the file.
fn mistakes(fields: &str) -> String {
    wrong(&text(fields), &INPUTS)
}

fn step<'p>(plan: &'p Plan, name: &str) -> &'p Step {
    let has = |step: &&Step| step.work.passes().iter().any(|pass| *pass.name == *name);
    plan.steps.iter().find(has).unwrap_or_else(|| panic!("no `{name}`: {}", plan.tree()))
}

fn custom<'p>(plan: &'p Plan, name: &str) -> &'p plan::Pass {
    &step(plan, name).work.passes()[0]
}

const MASK: &str = r#"writes: ["mask"],
    uses: [(image: "mask", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)]"#;

#[test]
fn what_is_declared_is_all_that_is_waited_for() {
    let plan = planned(MASK);
    let [access] = &custom(&plan, "build").accesses[..] else { panic!("{}", plan.tree()) };
    assert!(access.declared && access.binding.is_none());
    let state = (access.stages, access.accesses, access.layout);
    assert_eq!(state, (Stages::COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE, Layout::General));
    let mask = image(&plan, "mask").id;
    let barriers = &step(&plan, "build").image_barriers;
    let barrier = barriers.iter().find(|it| it.image == mask).unwrap_or_else(|| panic!("{}", plan.tree()));
    assert_eq!(barrier.new_layout, Layout::General);
    assert_eq!((barrier.dst_stages, barrier.dst_accesses), (Stages::COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE));
    // The flags follow from the accesses: nothing is transferred.
    assert_eq!(image(&plan, "mask").usage, Usage::STORAGE);
    // Without a word it is any command, in the layout of transfers.
    let wide = planned(r#"writes: ["mask"]"#);
    let [access] = &custom(&wide, "build").accesses[..] else { panic!("{}", wide.tree()) };
    assert!(!access.declared && access.stages == Stages::ALL_COMMANDS);
    assert_eq!(access.layout, Layout::TransferDstOptimal);
    let json = serde_json::to_string(&wide).expect("a Plan is written");
    assert!(!json.contains("declared"), "the form of other Plans is what it was");
}

#[test]
fn those_who_come_after_wait_for_what_is_declared() {
    let uses = r#"uses: [(image: "kept", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL),
                         (buffer: "list", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE])]"#;
    let fields = format!(
        r#"writes: ["kept", "list"], {uses}),
        (name: "use", custom: "use", side_effect: true, reads: ["kept", "list"],
         uses: [(image: "kept", stages: [FRAGMENT_SHADER], accesses: [SHADER_SAMPLED_READ], layout: SHADER_READ_ONLY_OPTIMAL),
                (buffer: "list", stages: [DRAW_INDIRECT], accesses: [INDIRECT_COMMAND_READ])]"#
    );
    let plan = planned(&fields);
    let after = step(&plan, "use");
    let [barrier] = &after.image_barriers[..] else { panic!("{}", plan.tree()) };
    assert_eq!((barrier.src_stages, barrier.src_accesses), (Stages::COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE));
    assert_eq!((barrier.old_layout, barrier.new_layout), (Layout::General, Layout::ShaderReadOnlyOptimal));
    assert_eq!((barrier.dst_stages, barrier.dst_accesses), (Stages::FRAGMENT_SHADER, Accesses::SHADER_SAMPLED_READ));
    let [memory] = &after.memory_barriers[..] else { panic!("{}", plan.tree()) };
    assert_eq!((memory.src_stages, memory.dst_stages), (Stages::COMPUTE_SHADER, Stages::DRAW_INDIRECT));
    assert_eq!(memory.dst_accesses, Accesses::INDIRECT_COMMAND_READ);
    let usage = plan.buffers.iter().find(|it| &*it.name == "list").expect("it is used").usage;
    assert_eq!(usage, BufferUsage::STORAGE_BUFFER | BufferUsage::INDIRECT_BUFFER);
}

#[test]
fn parts_and_earlier_frames_are_declared_by_themselves() {
    let plan = planned(
        r#"writes: [(image: "mask", mip: 0)],
           uses: [(image: "mask", stages: [CLEAR], accesses: [TRANSFER_WRITE], layout: TRANSFER_DST_OPTIMAL)]),
        (name: "down", custom: "down", side_effect: true,
         reads: [(image: "past", previous: 1), (image: "mask", mip: 0)], writes: ["past", (image: "mask", mip: 1, layers: 1)],
         uses: [(image: "past", previous: 1, stages: [COMPUTE_SHADER], accesses: [SHADER_SAMPLED_READ], layout: SHADER_READ_ONLY_OPTIMAL),
                (image: "past", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL),
                (image: "mask", mip: 1, stages: [BLIT], accesses: [TRANSFER_WRITE], layout: TRANSFER_DST_OPTIMAL),
                (image: "mask", mip: 0, stages: [BLIT], accesses: [TRANSFER_READ], layout: TRANSFER_SRC_OPTIMAL)]"#,
    );
    let listed: Vec<_> = custom(&plan, "down").accesses.iter().map(|it| (it.stages, it.accesses, it.layout)).collect();
    let expected = [
        (Stages::COMPUTE_SHADER, Accesses::SHADER_SAMPLED_READ, Layout::ShaderReadOnlyOptimal),
        (Stages::BLIT, Accesses::TRANSFER_READ, Layout::TransferSrcOptimal),
        (Stages::COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE, Layout::General),
        (Stages::BLIT, Accesses::TRANSFER_WRITE, Layout::TransferDstOptimal),
    ];
    assert_eq!(listed, expected, "{}", plan.tree());
}

#[test]
fn custom_passes_of_both_eyes_declare_for_each() {
    let pipeline = r#"Pipeline(version: 1, images: [
            (name: "color", format: R16G16B16A16_SFLOAT, size: Output, per_eye: true),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output, per_eye: true)],
        passes: [(name: "make", custom: "make", writes: ["color"],
            uses: [(image: "color", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)]),
            (name: "show", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["screen"])],
        outputs: ["screen"])"#;
    for stereo in [Stereo::MultiPass, Stereo::Multiview, Stereo::DoubleWide] {
        let frame = right(pipeline, &Inputs { stereo, ..INPUTS });
        let plan = compiled(&frame);
        for eye in [Eye::Left, Eye::Right] {
            let [access] = &custom(&plan, &eye.named("make")).accesses[..] else { panic!("{}", plan.tree()) };
            assert!(access.declared && access.stages == Stages::COMPUTE_SHADER, "{stereo:?}");
            assert_eq!(plan.image(access.image).name, eye.named("color"), "{stereo:?}");
        }
    }
}

#[test]
fn within_a_scope_what_a_draw_reads_is_declared() {
    let plan = planned(
        r#"color: [(image: "msaa", clear: (0.0, 0.0, 0.0, 0.0))], sample: {"tex": "kept"}, uniform: {"block": "old"},
           uses: [(image: "kept", stages: [VERTEX_SHADER], accesses: [SHADER_SAMPLED_READ], layout: GENERAL),
                  (buffer: "old", stages: [VERTEX_INPUT], accesses: [VERTEX_ATTRIBUTE_READ])]"#,
    );
    let pass = custom(&plan, "build");
    let access = pass.accesses.iter().find(|access| access.declared).expect("one is declared");
    assert_eq!((access.stages, access.layout), (Stages::VERTEX_SHADER, Layout::General));
    assert!(access.binding.as_ref().is_some_and(|binding| &*binding.name == "tex"));
    let [buffer] = &pass.buffers[..] else { panic!("{}", plan.tree()) };
    assert_eq!((buffer.stages, buffer.accesses), (Stages::VERTEX_INPUT, Accesses::VERTEX_ATTRIBUTE_READ));
    assert!(buffer.declared && buffer.binding.as_deref() == Some("block"));
}

/// What is wrong with a use, and the words that say so.
const WRONG: [(&str, &str); 19] = [
    (
        r#"writes: ["mask"], uses: [(image: "mask", stages: [COPY], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)]"#,
        "SHADER_STORAGE_WRITE doesn't happen in COPY",
    ),
    (
        r#"writes: ["mask"], uses: [(image: "mask", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: TRANSFER_DST_OPTIMAL)]"#,
        "SHADER_STORAGE_WRITE doesn't happen in the layout TRANSFER_DST_OPTIMAL",
    ),
    (
        r#"writes: ["mask"], uses: [(image: "mask", stages: [EARLY_FRAGMENT_TESTS], accesses: [DEPTH_STENCIL_ATTACHMENT_WRITE], layout: DEPTH_STENCIL_ATTACHMENT_OPTIMAL)]"#,
        "COLOR of `mask` (R16G16B16A16_SFLOAT) can't be used in the layout DEPTH_STENCIL_ATTACHMENT_OPTIMAL",
    ),
    (
        r#"writes: ["kept"], uses: [(image: "mask", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)]"#,
        "the pass names no such part of `mask`",
    ),
    (
        r#"writes: [(image: "mask", mip: 1)], uses: [(image: "mask", mip: 2, stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)]"#,
        "the pass names no such part of `mask`",
    ),
    (
        r#"writes: ["mask"], uses: [(image: "mask", mip: 2, stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)]"#,
        "it is of a part of `mask`, and the pass names more in one",
    ),
    (
        r#"reads: ["kept"], uses: [(image: "kept", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_READ, SHADER_STORAGE_WRITE], layout: GENERAL)]"#,
        "SHADER_STORAGE_WRITE writes `kept`, and the pass only reads it",
    ),
    (
        r#"writes: ["kept"], uses: [(image: "kept", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_READ, SHADER_STORAGE_WRITE], layout: GENERAL)]"#,
        "SHADER_STORAGE_READ reads `kept`, and the pass only writes it",
    ),
    (
        r#"writes: ["kept"], uses: [(image: "kept", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_READ], layout: GENERAL)]"#,
        "the pass writes `kept`, and no access of this use does",
    ),
    (
        r#"writes: ["kept"], uses: [(image: "kept", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL),
                                 (image: "kept", stages: [COPY], accesses: [TRANSFER_WRITE], layout: TRANSFER_DST_OPTIMAL)]"#,
        "two uses are of one part of `kept`",
    ),
    (
        r#"writes: ["kept"], uses: [(image: "kept", stages: [], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)]"#,
        "the use of `kept` has no stages",
    ),
    (
        r#"writes: ["kept"], uses: [(image: "kept", stages: [ALL_COMMANDS], accesses: [MEMORY_WRITE], layout: GENERAL)]"#,
        "MEMORY_WRITE says nothing of how `kept` is used",
    ),
    (
        r#"reads: ["old"], uses: [(buffer: "old", stages: [HOST], accesses: [HOST_READ])]"#,
        "`old` is used by commands, and the host is none",
    ),
    (
        r#"reads: ["old"], uses: [(buffer: "old", stages: [COMPUTE_SHADER], accesses: [SHADER_SAMPLED_READ])]"#,
        "`old` is a buffer, which sees no SHADER_SAMPLED_READ",
    ),
    (
        r#"reads: ["old"], uses: [(buffer: "old", stages: [COMPUTE_SHADER], accesses: [UNIFORM_READ], layout: GENERAL)]"#,
        "a buffer has no layout",
    ),
    (
        r#"reads: ["kept"], uses: [(image: "kept", stages: [COMPUTE_SHADER], accesses: [SHADER_SAMPLED_READ])]"#,
        "the state of an image has a layout",
    ),
    (
        r#"writes: ["stencil"], uses: [(image: "stencil", stages: [LATE_FRAGMENT_TESTS], accesses: [DEPTH_STENCIL_ATTACHMENT_WRITE], layout: DEPTH_STENCIL_ATTACHMENT_OPTIMAL)]"#,
        "DEPTH | STENCIL of `stencil` (D32_SFLOAT_S8_UINT) can't be used in the layout DEPTH_STENCIL_ATTACHMENT_OPTIMAL",
    ),
    (
        r#"writes: ["msaa"], uses: [(image: "msaa", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)]"#,
        "`msaa` has 4 samples, and SHADER_STORAGE_WRITE needs one",
    ),
    (
        r#"color: ["kept"], uses: [(image: "kept", stages: [COLOR_ATTACHMENT_OUTPUT], accesses: [COLOR_ATTACHMENT_WRITE], layout: GENERAL)]"#,
        "`kept` is a target of the pass",
    ),
];

#[test]
fn uses_that_cannot_be_are_refused_at_their_place() {
    for (fields, words) in WRONG {
        let said = mistakes(fields);
        assert!(said.contains(words), "{fields}\n{said}");
        assert!(said.contains("test.ron:"), "{said}");
        assert_eq!(said.matches("error").count(), 1, "{said}");
    }
    let drawn = mistakes(
        r#"color: ["kept"], sample: {"tex": "past"},
           uses: [(image: "past", stages: [COMPUTE_SHADER], accesses: [SHADER_SAMPLED_READ], layout: GENERAL)]"#,
    );
    assert!(drawn.contains("where no COMPUTE_SHADER is"), "{drawn}");
    let foreign = wrong(&text("").replace("FullScreen(\"plain\")", "FullScreen(\"plain\"), uses: []"), &INPUTS);
    assert!(foreign.contains("`uses`, which means nothing beside `draw`"), "{foreign}");
}

#[test]
fn a_frame_of_a_program_is_checked_alike() {
    let state = |stages, accesses, layout| State { stages, accesses, layout };
    let mut frame = right(&text(MASK), &INPUTS);
    let fitting = frame.passes[0].uses[0].clone();
    assert_eq!(fitting.resource, Resource::Image(ImageIndex(1)));
    let of = |index, state| DeclaredUse::new(Resource::Image(ImageIndex(index)), state);
    let write = state(Stages::COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE, Layout::General);
    for (wrong, words) in [
        (of(99, write), "names image number 99"),
        (of(2, write), "names no such part of `kept`"),
        (of(1, State { layout: Layout::Undefined, ..write }), "can't be used in the layout UNDEFINED"),
    ] {
        frame.passes[0].uses = vec![wrong];
        let said = refused(&frame);
        assert!(said.iter().any(|said| said.starts_with("`build`") && said.contains(words)), "{said:?}");
    }
    frame.passes[0].uses.clear();
    frame.passes[1].uses = vec![fitting];
    assert!(refused(&frame)[0].contains("no program records it"));
    let _: &Pass = &frame.passes[1];
    assert!(matches!(frame.passes[0].work, Work::Custom { .. }));
}

/// A Plan with a change to its step of `build` or of `use`.
fn changed(plan: &Plan, change: impl Fn(&mut Step)) -> Vec<String> {
    let mut plan = plan.clone();
    let is_custom = |step: &&mut Step| step.work.is_custom();
    plan.steps.iter_mut().filter(is_custom).for_each(change);
    verify(&plan).iter().map(ToString::to_string).collect()
}

#[test]
fn verify_holds_plans_to_what_is_declared() {
    let plan = planned(
        r#"writes: ["kept"], uses: [(image: "kept", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)]),
        (name: "use", custom: "use", side_effect: true, reads: ["kept"],
         uses: [(image: "kept", stages: [FRAGMENT_SHADER], accesses: [SHADER_SAMPLED_READ], layout: SHADER_READ_ONLY_OPTIMAL)]"#,
    );
    assert_eq!(verify(&plan), []);
    let accesses = |step: &mut Step, change: fn(&mut plan::Access)| {
        step.work.passes_mut().iter_mut().flat_map(|pass| &mut pass.accesses).for_each(change);
    };
    let caught: [(&str, Vec<String>); 8] = [
        ("no barrier", changed(&plan, |step| step.image_barriers.clear())),
        (
            "a stage too few",
            changed(&plan, |step| {
                step.image_barriers.iter_mut().for_each(|it| it.dst_stages = Stages::COPY);
                step.image_barriers.iter_mut().for_each(|it| it.dst_accesses = Accesses::TRANSFER_READ);
            }),
        ),
        (
            "nothing before is waited for",
            changed(&plan, |step| {
                step.image_barriers.iter_mut().for_each(|it| it.src_stages = Stages::COPY);
                step.image_barriers.iter_mut().for_each(|it| it.src_accesses = Accesses::empty());
            }),
        ),
        ("another layout", changed(&plan, |step| accesses(step, |it| it.layout = Layout::TransferDstOptimal))),
        ("an undeclared one is any command", changed(&plan, |step| accesses(step, |it| it.declared = false))),
        ("no stage", changed(&plan, |step| accesses(step, |it| it.stages = Stages::HOST))),
        (
            "of buffers",
            changed(&plan, |step| {
                accesses(step, |it| {
                    (it.stages, it.accesses) = (Stages::VERTEX_INPUT, Accesses::INDEX_READ);
                })
            }),
        ),
        ("of any memory", changed(&plan, |step| accesses(step, |it| it.accesses = Accesses::MEMORY_WRITE))),
    ];
    for (what, said) in caught {
        assert!(!said.is_empty(), "{what}");
    }
    let mut foreign = plan.clone();
    let drawn = foreign.steps.iter_mut().filter(|step| !step.work.is_custom()).flat_map(|step| step.work.passes_mut());
    drawn.flat_map(|pass| &mut pass.accesses).for_each(|access| access.declared = true);
    let said: Vec<String> = verify(&foreign).iter().map(ToString::to_string).collect();
    assert!(said.iter().any(|said| said.contains("no program records that")), "{said:?}");
    let mut unused = plan;
    unused.images.iter_mut().filter(|it| &*it.name == "kept").for_each(|it| it.usage -= Usage::STORAGE);
    assert!(!verify(&unused).is_empty(), "the usage follows the accesses");
}

/// A pipeline in which `bins` could run beside `paint`: it reads and writes what `uses` declares.
fn beside(fields: &str) -> String {
    format!(
        r#"Pipeline(version: 1, images: [
            (name: "screen", format: R16G16B16A16_SFLOAT, size: Output),
            (name: "color", format: R16G16B16A16_SFLOAT, size: Output)],
         buffers: [(name: "seed", bytes: 262144), (name: "list", bytes: 262144), (name: "own", bytes: 262144)],
         passes: [(name: "first", fill: (to: "seed", value: 1)),
            (name: "bins", custom: "bins", reads: ["seed"], writes: ["list"]{fields}),
            (name: "paint", draw: FullScreen("plain"), color: ["color"]),
            (name: "show", draw: FullScreen("reinhard"), sample: {{"source": "color"}}, color: ["screen"]),
            (name: "take", copy: (from: "list", to: "own"))],
         outputs: ["screen", "own"])"#
    )
}

const BINS: &str = r#", queue: Any, uses: [
    (buffer: "seed", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_READ]),
    (buffer: "list", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE])]"#;

#[test]
fn any_queue_may_run_what_declares_all_that_it_does() {
    let queues = Queues { compute: true, transfer: false, sharing: Sharing::Concurrent, wait_bytes: 0 };
    let device = Profile { queues, ..parts::device() };
    let planned = |text: &str| {
        let plan = on(&right(text, &INPUTS), &device).unwrap_or_else(|errors| panic!("{errors:?}"));
        let (queue, any) = (step(&plan, "bins").queue, custom(&plan, "bins").any_queue);
        (plan, queue, any)
    };
    let (plan, queue, any) = planned(&beside(BINS));
    assert_eq!((queue, any), (Queue::Compute, true), "{}", plan.tree());
    // Without the word, or without a use of everything, the program has the queue for graphics.
    assert_eq!(planned(&beside(&BINS.replace("queue: Any, ", ""))).1, Queue::Graphics);
    assert_eq!(planned(&beside("")).1, Queue::Graphics);
    // Stages that no queue for compute has keep it there.
    let drawn = BINS
        .replace("COMPUTE_SHADER], accesses: [SHADER_STORAGE_READ", "VERTEX_SHADER], accesses: [SHADER_STORAGE_READ");
    assert_eq!(planned(&beside(&drawn)).1, Queue::Graphics);
    let half = wrong(
        &beside(&BINS.replace("(buffer: \"seed\", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_READ]),", "")),
        &INPUTS,
    );
    assert!(half.contains("any queue may run the pass, and nothing says how it uses `seed`"), "{half}");
    assert!(half.contains("test.ron:6:"), "{half}");
    let scope = mistakes(r#"color: ["kept"], queue: Any"#);
    assert!(scope.contains("draws within a rendering scope"), "{scope}");

    // Verify holds Plans to it.
    let said = |change: fn(&mut plan::Pass)| {
        let mut plan = plan.clone();
        plan.steps
            .iter_mut()
            .flat_map(|step| step.work.passes_mut())
            .filter(|pass| &*pass.name == "bins")
            .for_each(change);
        verify(&plan).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert!(said(|pass| pass.any_queue = false).contains("doesn't say that it can be"));
    assert!(said(|pass| pass.buffers[0].declared = false).contains("doesn't say that it can be"));
}
