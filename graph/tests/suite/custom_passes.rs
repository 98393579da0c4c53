//! What the program records may use any command for what its pass reads and writes: the Plan waits for all of them.

use crate::testing::parts::device;
use crate::testing::pipelines::{INPUTS, right};
use crate::testing::plans::{compiled, image, on, refused, shipped};
use framewright_graph::base::Span;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues};
use framewright_graph::frame::{
    Buffer, BufferIndex, BufferRole, BufferUse, ColorTarget, Draw, Frame, Groups, Image, ImageIndex, Lifetime, Pass,
    Resource, SampledImage, TransferUse, Work,
};
use framewright_graph::plan::{self, Plan};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{
    Accesses, BufferUsage, FillValue, Format, Layout, Sharing, Stages, Subresources, Usage,
};

fn buffer(name: &str, lifetime: Lifetime) -> Buffer {
    Buffer { name: name.into(), span: Span::NONE, bytes: 256, lifetime }
}

fn transfer(buffer: u32, write: bool) -> TransferUse {
    let resource = Resource::Buffer(BufferIndex(buffer));
    TransferUse { resource, range: Subresources::WHOLE, frames_ago: 0, span: Span::NONE, write, keeps: false }
}

fn block(name: &str, buffer: u32, read: bool, stages: Stages) -> BufferUse {
    BufferUse {
        binding: Some(name.into()),
        buffer: BufferIndex(buffer),
        frames_ago: 0,
        span: Span::NONE,
        role: BufferRole::Storage { read, write: !read },
        stages,
    }
}

fn target(image: u32) -> ColorTarget {
    let (range, span) = (Subresources::WHOLE, Span::NONE);
    ColorTarget {
        image: ImageIndex(image),
        range,
        span,
        clear: Some([0.0; 4]),
        blend: Default::default(),
        write_mask: Default::default(),
    }
}

/// A compute pass and a fill write what two custom passes read, and a compute pass reads what one of them writes.
fn frame() -> Frame {
    let mut frame = Frame {
        images: ["picture", "seen"].map(|name| Image::new(name, Format::R8G8B8A8_UNORM, 16, 16)).into(),
        buffers: ["counts", "filled", "moved", "last"].map(|name| buffer(name, Lifetime::Transient)).into(),
        ..Frame::default()
    };
    let make = Work::Dispatch { shader: "make".into(), groups: Groups::Count([1; 3]) };
    let draw = |draw| Work::Draw { draw, shader: "own".into(), discards: false, per_sample: false };
    frame.passes = vec![
        Pass { buffers: vec![block("counts", 0, false, Stages::COMPUTE_SHADER)], ..Pass::new("make", make.clone()) },
        Pass { transfers: vec![transfer(1, true)], ..Pass::new("fill", Work::Fill { value: FillValue::Bits([1; 4]) }) },
        Pass { color: vec![target(1)], ..Pass::new("paint", draw(Draw::FullScreen)) },
        Pass {
            color: vec![target(0)],
            buffers: vec![block("counts", 0, true, Stages::FRAGMENT_SHADER)],
            sampled: vec![SampledImage::new("seen", ImageIndex(1), Stages::FRAGMENT_SHADER)],
            ..Pass::new("meshes", draw(Draw::Custom))
        },
        Pass {
            transfers: vec![transfer(1, false), transfer(2, true)],
            ..Pass::new("build", Work::Custom { callback: "build".into() })
        },
        Pass {
            buffers: vec![
                block("counts", 2, true, Stages::COMPUTE_SHADER),
                block("last", 3, false, Stages::COMPUTE_SHADER),
            ],
            ..Pass::new("after", make)
        },
    ];
    frame.outputs = vec![Resource::Image(ImageIndex(0)).into(), Resource::Buffer(BufferIndex(3)).into()];
    frame
}

fn planned() -> Plan {
    let device = device();
    let plan = compile(&frame(), &device, &mut MemoryEstimate(&device), &Options::default());
    plan.unwrap_or_else(|errors| panic!("{errors:?}"))
}

fn step<'p>(plan: &'p Plan, pass: &str) -> &'p plan::Step {
    let has = |step: &&plan::Step| match &step.work {
        plan::Work::Render(scope) => scope.passes.iter().any(|it| *it.name == *pass),
        plan::Work::Dispatch(it) | plan::Work::Custom(it) => *it.name == *pass,
        _ => false,
    };
    plan.steps.iter().find(has).unwrap_or_else(|| panic!("no `{pass}`: {}", plan.tree()))
}

#[test]
fn a_custom_pass_waits_with_all_that_it_may_record_and_is_waited_for_by_all_of_it() {
    let plan = planned();
    assert_eq!(verify(&plan), []);
    let (any, all) = (Stages::ALL_COMMANDS, Accesses::MEMORY_READ);
    // One call serves both, before the first of them.
    let barriers = &step(&plan, "meshes").memory_barriers;
    for writer in [Accesses::SHADER_STORAGE_WRITE, Accesses::TRANSFER_WRITE] {
        let waits = |it: &&plan::MemoryBarrier| it.src_accesses.contains(writer) && it.dst_accesses.contains(all);
        let barrier = barriers.iter().find(waits).unwrap_or_else(|| panic!("{writer:?}: {}", plan.tree()));
        assert!(barrier.dst_stages.contains(any), "{writer:?}: {barrier:?}");
    }
    let sampled = &step(&plan, "meshes").image_barriers;
    assert!(sampled.iter().any(|it| it.dst_stages.contains(any) && it.dst_accesses.contains(all)), "{sampled:?}");
    // Whatever wrote there is waited for.
    let after = &step(&plan, "after").memory_barriers;
    let written = |it: &&plan::MemoryBarrier| it.src_accesses.contains(Accesses::MEMORY_WRITE);
    assert!(after.iter().find(written).is_some_and(|it| it.src_stages.contains(any)), "{after:?}");
    // The buffers are made for whatever reads them.
    let usage = |name: &str| plan.buffers.iter().find(|it| *it.name == *name).expect("it is used").usage;
    let read = BufferUsage::INDIRECT_BUFFER | BufferUsage::VERTEX_BUFFER | BufferUsage::INDEX_BUFFER;
    assert!(usage("counts").contains(read) && usage("filled").contains(read), "{:?}", usage("filled"));
    assert!(!usage("last").intersects(read));
}

#[test]
fn a_custom_pass_that_waits_only_for_what_it_declares_is_refused() {
    let narrow: [fn(&mut Stages, &mut Accesses); 2] = [
        |stages, _| *stages = Stages::COPY | Stages::FRAGMENT_SHADER,
        |_, accesses| *accesses -= Accesses::MEMORY_READ | Accesses::MEMORY_WRITE,
    ];
    for narrow in narrow {
        let mut plan = planned();
        let passes = plan.steps.iter_mut().flat_map(|step| match &mut step.work {
            plan::Work::Render(scope) => scope.passes.iter_mut().collect::<Vec<_>>(),
            plan::Work::Custom(pass) => vec![pass],
            _ => Vec::new(),
        });
        for pass in passes.filter(|pass| ["meshes", "build"].contains(&&*pass.name)) {
            pass.buffers.iter_mut().for_each(|it| narrow(&mut it.stages, &mut it.accesses));
        }
        let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
        for name in ["counts", "filled", "moved"] {
            let wanted = "is used by commands that only the program knows";
            let told = said.iter().any(|said| said.contains(&format!("`{name}`")) && said.contains(wanted));
            assert!(told, "{name}: {said:#?}");
        }
    }
}

/// The checker takes a barrier whose stages are `HOST` and `ALL_COMMANDS`, with the accesses of the host.
#[test]
fn a_custom_pass_without_uses_reads_what_the_host_wrote() {
    let text = r#"Pipeline(version: 1,
        images: [(name: "screen", format: R8G8B8A8_UNORM, size: Output)],
        buffers: [(name: "args", bytes: 256, lifetime: Imported(before: Host)), (name: "b", bytes: 256)],
        passes: [(name: "sky", draw: FullScreen("plain"), color: ["screen"]),
                 (name: "m", custom: "build", reads: ["args"], writes: ["b"])],
        outputs: ["screen", "b"])"#;
    let plan = compiled(&right(text, &INPUTS));
    assert_eq!(verify(&plan), []);
}

/// A pipeline whose pass `both` is custom, with these fields, and whose pass `look` reads what that may have changed.
fn both(fields: &str) -> Frame {
    let text = format!(
        r#"Pipeline(version: 1,
        images: [(name: "screen", format: R8G8B8A8_UNORM, size: Output),
            (name: "kept", format: R16G16B16A16_SFLOAT, size: Fixed(64, 64), mips: 2, lifetime: Persistent)],
        buffers: [(name: "made", bytes: 256), (name: "old", bytes: 256, lifetime: Persistent),
            (name: "args", bytes: 256, lifetime: Imported(before: Host, after: Host))],
        passes: [(name: "zero", fill: (to: "made", value: 0)),
            (name: "both", custom: "both", side_effect: true, {fields}),
            (name: "look", custom: "look", side_effect: true, reads: ["made", "kept"]),
            (name: "show", draw: FullScreen("plain"), color: ["screen"])],
        outputs: ["screen"])"#
    );
    right(&text, &INPUTS)
}

/// The accesses to images and buffers of the custom pass `both`, each with its layout.
fn of_both(plan: &Plan) -> Vec<(Stages, Accesses, Layout)> {
    let plan::Work::Custom(pass) = &step(plan, "both").work else { panic!("{}", plan.tree()) };
    let images = pass.accesses.iter().map(|it| (it.stages, it.accesses, it.layout));
    images.chain(pass.buffers.iter().map(|it| (it.stages, it.accesses, Layout::Undefined))).collect()
}

/// The test device with one queue and with several, and devices that are shipped.
fn devices() -> Vec<Profile> {
    let several = [Sharing::Concurrent, Sharing::Exclusive].map(|sharing| {
        let queues = Queues { compute: true, transfer: true, sharing, wait_bytes: 0 };
        Profile { queues, ..device() }
    });
    let shipped = ["nvidia-rtx-2080", "amd-rx-7800-xt", "mali-g78", "lavapipe"].map(shipped);
    [device()].into_iter().chain(several).chain(shipped).collect()
}

/// The checker takes no Plan in which a pass accesses one part twice, once to read and once to write (DO-8).
#[test]
fn what_a_custom_pass_reads_and_writes_is_one_access() {
    let all = r#"reads: ["made", "old", "args", "kept"], writes: ["made", "old", "args", "kept"]"#;
    let storage = "stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_READ, SHADER_STORAGE_WRITE]";
    let structure = "stages: [ACCELERATION_STRUCTURE_BUILD_KHR], \
        accesses: [ACCELERATION_STRUCTURE_READ_KHR, ACCELERATION_STRUCTURE_WRITE_KHR]";
    let transfer = "stages: [CLEAR, COPY], accesses: [TRANSFER_READ, TRANSFER_WRITE]";
    let declared = format!(
        r#"{all}, uses: [(buffer: "made", {storage}), (buffer: "old", {storage}), (buffer: "args", {transfer}),
            (image: "kept", {storage}, layout: GENERAL)]"#
    );
    for device in devices() {
        let planned = |fields: &str| on(&both(fields), &device).unwrap_or_else(|errors| panic!("{errors:?}"));
        let plan = planned(all);
        let (any, transfers) = (Accesses::MEMORY_READ | Accesses::MEMORY_WRITE, Accesses::TRANSFER_WRITE);
        let transfers = transfers | Accesses::TRANSFER_READ;
        let accesses = of_both(&plan);
        assert_eq!(accesses.len(), 4, "{}: {}", device.name, plan.tree());
        for (stages, accesses, _) in &accesses {
            assert_eq!((*stages, *accesses), (Stages::ALL_COMMANDS, any | transfers), "{}", device.name);
        }
        assert_eq!(accesses[0].2, Layout::General);
        assert!(image(&plan, "kept").usage.contains(Usage::TRANSFER_SRC | Usage::TRANSFER_DST));

        let plan = planned(&declared);
        let stored = Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE;
        let compute = (Stages::COMPUTE_SHADER, stored, Layout::Undefined);
        let moved = (Stages::CLEAR | Stages::COPY, transfers, Layout::Undefined);
        let expected = [(Stages::COMPUTE_SHADER, stored, Layout::General), compute, compute, moved];
        assert_eq!(of_both(&plan), expected, "{}: {}", device.name, plan.tree());

        let part = r#"(image: "kept", mip: 1)"#;
        let plan = planned(&format!(r#"reads: [{part}, "made"], writes: [(image: "kept", mip: 0), {part}]"#));
        let layouts: Vec<Layout> = of_both(&plan).iter().map(|it| it.2).collect();
        assert_eq!(layouts, [Layout::General, Layout::TransferDstOptimal, Layout::Undefined], "{}", plan.tree());
    }
    // A refit, where the device builds acceleration structures.
    let refit = format!(
        r#"reads: ["made", "old"], writes: ["old"], uses: [(buffer: "old", {structure}),
        (buffer: "made", stages: [ACCELERATION_STRUCTURE_BUILD_KHR], accesses: [SHADER_READ])]"#
    );
    assert_eq!(of_both(&compiled(&both(&refit))).len(), 2);
}

#[test]
fn what_a_custom_pass_cannot_read_and_write_is_refused() {
    let target = r#"color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]"#;
    for (fields, words) in [
        (r#"reads: ["kept"], writes: [(image: "kept", mip: 0)]"#, "parts of `kept` that overlap and aren't the same"),
        (&format!(r#"reads: ["old"], {target}"#), "nothing is transferred beside targets"),
        (&format!(r#"writes: ["old"], {target}"#), "nothing is transferred beside targets"),
    ] {
        let said = refused(&both(fields));
        assert!(said.iter().any(|said| said.contains(words)), "{fields}: {said:?}");
    }
}
