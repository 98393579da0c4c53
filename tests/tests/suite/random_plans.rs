//! Random pipelines without a device: for every order and all options, their Plans are valid to the checker and do no harm to
//! the brute-force judge, which shares no code with either.

use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues};
use framewright_graph::frame::{Frame, ImageIndex, Lifetime, Output, Pass, Resource, StencilState, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Accesses, CompareOp, Format, Layout, Sharing, Stages, State, StencilOp};
use framewright_tests::frames::device;
use framewright_tests::happens_before::judge;
use framewright_tests::random_pipelines::allowed::Allowed;
use framewright_tests::random_pipelines::rng::Rng;
use framewright_tests::random_pipelines::{generate, passes, to_frame};
use framewright_tests::sweep;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Options that differ in everything, by number.
fn options(seed: u64) -> Options {
    let number = seed / 3;
    let orders = [Order::Default, Order::File, Order::LowMemory, Order::Random(number)];
    Options {
        alias: number & 1 == 0,
        poison: number & 2 != 0,
        readable: false,
        order: orders[(number / 8 % 4) as usize],
        demote: number & 4 == 0,
        queues: true,
    }
}

/// The mistakes in the Plan of a frame.
fn fault(frame: &Frame, options: &Options, seed: u64) -> Option<String> {
    let sharing = if seed % 5 == 1 { Sharing::Concurrent } else { Sharing::Exclusive };
    // Waits that cost nothing, about as much as what passes move, and more than that.
    let wait_bytes = [0, 4 << 10, 64 << 10][(seed / 5 % 3) as usize];
    let queues = Queues { compute: seed % 5 < 3, transfer: seed % 5 < 2, sharing, wait_bytes };
    let device = Profile { local_read: seed.is_multiple_of(2), queues, ..device() };
    let compiled = catch_unwind(AssertUnwindSafe(|| compile(frame, &device, &mut MemoryEstimate(&device), options)));
    let plan = match compiled {
        Err(_) => return Some("panics".to_owned()),
        Ok(Err(errors)) => return Some(format!("is refused: {}", errors[0].message)),
        Ok(Ok(plan)) => plan,
    };
    if let Some(violation) = verify(&plan).first() {
        return Some(format!("the checker finds: {violation}"));
    }
    judge(&plan).harms.first().map(|harm| format!("the judge finds: {harm:?}"))
}

/// States in which images come and go.
const STATES: [State; 6] = [
    state(Stages::COMPUTE_SHADER, Accesses::SHADER_SAMPLED_READ, Layout::ShaderReadOnlyOptimal),
    state(SHADERS, Accesses::SHADER_SAMPLED_READ, Layout::ShaderReadOnlyOptimal),
    state(Stages::COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE, Layout::General),
    state(SHADERS, Accesses::SHADER_STORAGE_READ, Layout::General),
    state(Stages::COPY, Accesses::TRANSFER_READ, Layout::TransferSrcOptimal),
    state(Stages::COPY, Accesses::TRANSFER_WRITE, Layout::TransferDstOptimal),
];
const SHADERS: Stages = Stages::COMPUTE_SHADER.union(Stages::FRAGMENT_SHADER);

const fn state(stages: Stages, accesses: Accesses, layout: Layout) -> State {
    State { stages, accesses, layout }
}

/// Adds what random pipelines don't say: many states in which things come and go, and stencil planes.
fn vary(frame: &mut Frame, seed: u64) {
    let mut rng = Rng::new(seed ^ 0xABCD);
    let leaves = |at: u32, frame: &Frame| {
        let is_it = |output: &Output| output.resource == Resource::Image(ImageIndex(at));
        frame.outputs.iter().any(is_it)
    };
    for at in 0..frame.images.len() as u32 {
        let image = ImageIndex(at);
        let leaves = leaves(at, frame);
        let declared = &mut frame.images[at as usize];
        if let Lifetime::Imported { before, after, .. } = &mut declared.lifetime {
            *before = rng.of(STATES);
            *after = rng.one_in(2).then(|| rng.of(STATES));
        }
        let copied = |pass: &Pass| {
            let resource = Resource::Image(image);
            let copied = pass.transfers.iter().any(|used| used.resource == resource);
            copied || matches!(pass.work, Work::Forward { from, to, .. } if from == image || to == image)
        };
        let fits = declared.format == Format::D32_SFLOAT && declared.samples == 1;
        if fits && !leaves && !frame.passes.iter().any(copied) {
            declared.format = Format::D24_UNORM_S8_UINT;
            for depth in frame.passes.iter_mut().filter_map(|pass| pass.depth.as_mut()) {
                // A stencil test keeps a draw from covering its colour.
                let covers = depth.test == CompareOp::Always;
                if depth.image == image && depth.clear.is_some() && !covers {
                    let (test, pass) = (CompareOp::Always, StencilOp::Replace);
                    depth.stencil = Some(StencilState { clear: Some(3), test, reference: 1, pass });
                }
            }
        }
    }
    for output in &mut frame.outputs {
        if rng.one_in(3) {
            let kept =
                |index: ImageIndex| !matches!(frame.images[index.0 as usize].lifetime, Lifetime::Imported { .. });
            output.after = match output.resource {
                Resource::Image(image) => kept(image).then(|| rng.of(STATES)),
                Resource::Buffer(_) => Some(State { layout: Layout::Undefined, ..rng.of(STATES) }),
            };
            if let (Resource::Buffer(_), Some(after)) = (output.resource, &mut output.after) {
                after.accesses = Accesses::MEMORY_READ;
            }
        }
    }
}

/// Checks frames of all `seeds` and up to `most` passes, under options that differ from seed to seed.
fn check(seeds: Range<u64>, most: u32) {
    let mut faults = Vec::new();
    for seed in seeds {
        let passes = passes(seed, most);
        let mut frame = to_frame::to_frame(&generate::pipeline(seed, passes, &Allowed::default()));
        vary(&mut frame, seed);
        let options = options(seed);
        if let Some(fault) = fault(&frame, &options, seed) {
            faults.push(format!("seed {seed}, {passes} passes, {options:?}: {fault}"));
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn plans_of_random_pipelines_do_no_harm_whatever_the_options() {
    check(sweep::row("random Plans", 0..1000, 500), 40);
}

#[test]
fn plans_of_long_random_pipelines_do_no_harm_either() {
    check(sweep::row("long random Plans", 5000..5100, 30), 200);
}
