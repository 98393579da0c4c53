//! The rules of synchronisation, one by one, on dispatches that share two images.

use crate::testing::hand_written_plans::build::{
    self, State, UNDEFINED, barrier, between, dispatch, step, storage, transient,
};
use framewright_graph::plan::{Hazard, Image, ImageBarrier, MemoryBarrier, Plan, Role, Step, Work};
use framewright_graph::verify::{Rule, Violation, verify};
use framewright_graph::vulkan::{Accesses, Format, Layout, Stages, Subresources, Usage};

const CS: Stages = Stages::COMPUTE_SHADER;
const NONE: Accesses = Accesses::empty();
const READ: Accesses = Accesses::SHADER_STORAGE_READ;
const WRITE: Accesses = Accesses::SHADER_STORAGE_WRITE;
const READS: State = (CS, READ, Layout::General);
const WRITES: State = (CS, WRITE, Layout::General);
const BOTH: State = (CS, READ.union(WRITE), Layout::General);

/// Two storage images, each in memory of its own.
fn images(steps: u32) -> [Image; 2] {
    let image = |id: u32, name: &str| {
        let place = [u64::from(id) * 16384, 16384];
        transient(id, name, Format::R16G16B16A16_SFLOAT, 1, Usage::STORAGE, place, [0, steps - 1])
    };
    [image(0, "a"), image(1, "b")]
}

/// A dispatch that does this to the images.
fn uses(name: &str, line: u32, of: &[(&Image, State)]) -> Work {
    Work::Dispatch(dispatch(name, line, of.iter().map(|(image, state)| storage(&image.name, image, *state)).collect()))
}

fn memory(src: (Stages, Accesses), dst: (Stages, Accesses)) -> MemoryBarrier {
    let [(src_stages, src_accesses), (dst_stages, dst_accesses)] = [src, dst];
    MemoryBarrier { src_stages, src_accesses, dst_stages, dst_accesses, hand_overs: Vec::new(), buffers: Vec::new() }
}

/// The first barrier on an image: waits for all of the frame before.
fn first(image: &Image, to: State) -> ImageBarrier {
    barrier(image, (Stages::ALL_COMMANDS, Accesses::MEMORY_WRITE), UNDEFINED, to, Hazard::FirstUse, None)
}

fn plan_of(images: &[Image], steps: Vec<Step>) -> Plan {
    build::plan(images.to_vec(), 1 << 20, steps)
}

/// `write` writes both images, then come the barriers of each following step; the last one reads `a`.
fn read_after(barriers: Vec<(Vec<MemoryBarrier>, Vec<ImageBarrier>)>) -> Vec<Violation> {
    let images = images(barriers.len() as u32 + 1);
    let [a, b] = &images;
    let mut steps = vec![step(vec![first(a, WRITES), first(b, WRITES)], uses("write", 1, &[(a, WRITES), (b, WRITES)]))];
    let last = barriers.len() - 1;
    for (at, (memory_barriers, image_barriers)) in barriers.into_iter().enumerate() {
        let work = if at == last { uses("read", 2, &[(a, READS)]) } else { Work::Export };
        steps.push(Step { memory_barriers, ..step(image_barriers, work) });
    }
    verify(&plan_of(&images, steps))
}

fn only(violations: Vec<Violation>) -> Violation {
    let said: Vec<String> = violations.iter().map(ToString::to_string).collect();
    let [violation] = <[Violation; 1]>::try_from(violations).unwrap_or_else(|_| panic!("not one violation: {said:#?}"));
    violation
}

#[test]
fn a_memory_barrier_orders_and_shows() {
    assert_eq!(read_after(vec![(vec![memory((CS, WRITE), (CS, READ))], vec![])]), []);
}

#[test]
fn a_chain_of_barriers_orders_and_shows() {
    let to_copy = memory((CS, WRITE), (Stages::COPY, NONE));
    let from_copy = memory((Stages::COPY, NONE), (CS, READ));
    assert_eq!(read_after(vec![(vec![to_copy.clone()], vec![]), (vec![from_copy.clone()], vec![])]), []);
    // In one call they are no chain.
    let violation = only(read_after(vec![(vec![to_copy.clone(), from_copy], vec![])]));
    assert!(matches!(violation.rule, Rule::Execution { .. }), "{violation}");
    // A chain needs a stage in common.
    let from_resolve = memory((Stages::RESOLVE, NONE), (CS, READ));
    let violation = only(read_after(vec![(vec![to_copy], vec![]), (vec![from_resolve], vec![])]));
    assert!(matches!(violation.rule, Rule::Execution { .. }), "{violation}");
}

#[test]
fn a_barrier_on_another_image_orders_but_makes_nothing_available() {
    let [_, b] = images(2);
    let on_b = between(&b, WRITES, READS, Hazard::ReadAfterWrite, 0);
    let violation = only(read_after(vec![(vec![], vec![on_b])]));
    assert!(matches!(violation.rule, Rule::Availability { .. }), "{violation}");
    assert_eq!(
        violation.to_string(),
        "step 1 `read`: `a` (COLOR, mip 0, layer 0): SHADER_STORAGE_READ in COMPUTE_SHADER comes after \
         SHADER_STORAGE_WRITE in COMPUTE_SHADER by step 0 `write`, but no barrier makes that write available"
    );
}

#[test]
fn what_an_image_barrier_made_available_a_later_memory_barrier_can_show() {
    let [a, _] = images(3);
    let available = barrier(&a, (CS, WRITE), WRITES.2, (Stages::COPY, NONE, WRITES.2), Hazard::ReadAfterWrite, Some(0));
    let shown = memory((Stages::COPY, NONE), (CS, READ));
    assert_eq!(read_after(vec![(vec![], vec![available.clone()]), (vec![shown], vec![])]), []);
    let hidden = memory((Stages::COPY, NONE), (CS, Accesses::UNIFORM_READ));
    let violation = only(read_after(vec![(vec![], vec![available]), (vec![hidden], vec![])]));
    assert!(matches!(violation.rule, Rule::Visibility { .. }), "{violation}");
}

/// Write, two reads, write again: with barriers before the reads and before the second write.
fn rewritten(before_reads: ImageBarrier, before_write: Option<ImageBarrier>) -> Vec<Violation> {
    let images = images(4);
    let [a, _] = &images;
    let steps = vec![
        step(vec![first(a, WRITES)], uses("write", 1, &[(a, WRITES)])),
        step(vec![before_reads], uses("read", 2, &[(a, READS)])),
        step(vec![], uses("read again", 3, &[(a, READS)])),
        step(before_write.into_iter().collect(), uses("rewrite", 4, &[(a, WRITES)])),
    ];
    verify(&plan_of(&images, steps))
}

#[test]
fn reads_need_no_barrier_between_them_and_a_write_after_them_no_availability() {
    let [a, _] = images(4);
    let before_reads = between(&a, WRITES, READS, Hazard::ReadAfterWrite, 0);
    let before_write = barrier(&a, (CS, NONE), READS.2, WRITES, Hazard::WriteAfterRead, Some(2));
    assert_eq!(rewritten(before_reads.clone(), Some(before_write)), []);
    let violation = only(rewritten(before_reads, None));
    assert_eq!(violation.step.map(|step| step.name), Some("`rewrite`".to_owned()));
}

#[test]
fn one_missing_barrier_is_reported_once() {
    let [a, _] = images(4);
    let nothing = barrier(&a, (Stages::COPY, NONE), WRITES.2, READS, Hazard::ReadAfterWrite, Some(0));
    let before_write = barrier(&a, (CS, WRITE), READS.2, WRITES, Hazard::WriteAfterRead, Some(2));
    let violation = only(rewritten(nothing, Some(before_write)));
    assert_eq!(violation.step.map(|step| step.name), Some("`read`".to_owned()), "and not `read again`");
}

#[test]
fn what_only_goes_wrong_in_the_next_frame_is_found() {
    let images = images(1);
    let [a, _] = &images;
    let hasty = barrier(a, (Stages::COPY, NONE), UNDEFINED, WRITES, Hazard::FirstUse, None);
    let violation = only(verify(&plan_of(&images, vec![step(vec![hasty], uses("write", 1, &[(a, WRITES)]))])));
    assert!(violation.other.as_ref().is_some_and(|other| other.frames_ago == 1), "{violation}");
    assert!(violation.to_string().contains("by step 0 `write` of the frame before"), "{violation}");
}

#[test]
fn each_mip_level_is_followed_on_its_own() {
    let level = |base_mip: u32| Subresources { base_mip, mips: 1, ..build::range(Format::R16G16B16A16_SFLOAT) };
    let mut images = images(3);
    images[0].mips = 3;
    let [a, _] = &images;
    let down = |name: &str, line: u32, from: Option<u32>, to: u32| {
        let uses_of = from.into_iter().map(|level| (level, READS)).chain([(to, WRITES)]).collect::<Vec<_>>();
        let mut work = uses(name, line, &uses_of.iter().map(|(_, state)| (a, *state)).collect::<Vec<_>>());
        if let Work::Dispatch(pass) = &mut work {
            for (at, (mip, _)) in uses_of.iter().enumerate() {
                pass.accesses[at].range = level(*mip);
            }
        }
        work
    };
    let all = |barrier: ImageBarrier| ImageBarrier { range: Subresources { mips: 3, ..barrier.range }, ..barrier };
    let read = |mip: u32, after: u32| {
        let barrier = between(a, WRITES, READS, Hazard::ReadAfterWrite, after);
        ImageBarrier { range: level(mip), ..barrier }
    };
    let steps = vec![
        step(vec![all(first(a, WRITES))], down("top", 1, None, 0)),
        step(vec![read(0, 0)], down("middle", 2, Some(0), 1)),
        step(vec![read(1, 1)], down("bottom", 3, Some(1), 2)),
    ];
    let mut plan = plan_of(&images, steps);
    assert_eq!(verify(&plan), []);
    plan.steps[2].image_barriers[0].range = level(0);
    let violation = only(verify(&plan));
    assert_eq!(violation.range, Some(level(1)), "{violation}");
}

/// `b` takes the memory of `a`, whose last access is a write, with these barriers before it.
fn handed_over(
    memory_barriers: Vec<MemoryBarrier>,
    on_a: Option<ImageBarrier>,
    source: (Stages, Accesses),
) -> Vec<Violation> {
    let images = [[0, 0], [1, 1]].into_iter().zip(0..).map(|(lifetime, id)| {
        let name = ["a", "b"][id as usize];
        transient(id, name, Format::R16G16B16A16_SFLOAT, 1, Usage::STORAGE, [0, 16384], lifetime)
    });
    let mut images: Vec<Image> = images.collect();
    let mut steps = Vec::new();
    let taking = barrier(&images[1], source, UNDEFINED, WRITES, Hazard::FirstUse, Some(0));
    let back = vec![memory((CS, WRITE), (CS, NONE))];
    steps.push(Step {
        memory_barriers: back,
        ..step(vec![first(&images[0], WRITES)], uses("write", 1, &[(&images[0], WRITES)]))
    });
    if on_a.is_some() {
        let lifetimes =
            [crate::testing::hand_written_plans::lifetime(0, 1), crate::testing::hand_written_plans::lifetime(2, 2)];
        for (image, lifetime) in images.iter_mut().zip(lifetimes) {
            if let Role::Transient(placement) = &mut image.role {
                placement.lifetime = lifetime;
            }
        }
        steps.push(step(on_a.into_iter().collect(), Work::Export));
    }
    steps.push(Step { memory_barriers, ..step(vec![taking], uses("overwrite", 2, &[(&images[1], WRITES)])) });
    verify(&plan_of(&images, steps))
}

#[test]
fn memory_changes_hands_by_a_memory_barrier_or_by_one_on_the_last_owner() {
    assert_eq!(handed_over(vec![memory((CS, WRITE), (CS, WRITE))], None, (CS, NONE)), []);
    let [a, _] = images(1);
    let on_a = barrier(&a, (CS, WRITE), WRITES.2, (CS, NONE, WRITES.2), Hazard::WriteAfterWrite, Some(0));
    assert_eq!(handed_over(vec![], Some(on_a), (CS, NONE)), []);
    // The source scope of the barrier on `b` makes nothing available that went through `a`.
    for source in [(CS, NONE), (CS, WRITE), (Stages::ALL_COMMANDS, Accesses::MEMORY_WRITE)] {
        let violation = only(handed_over(vec![], None, source));
        assert!(matches!(violation.rule, Rule::HandOver { waited: true, .. }), "{violation}");
        assert_eq!(violation.bytes, Some([0, 16384]));
        assert_eq!(
            violation.to_string(),
            "step 1 `overwrite`: `b` (COLOR, mip 0, layer 0; bytes 0–16384): takes the memory of `a`, but \
             SHADER_STORAGE_WRITE in COMPUTE_SHADER by step 0 `write` isn't made available first"
        );
    }
    // The memory barrier doesn't make an image barrier wait that goes on from other stages.
    let violation = only(handed_over(vec![memory((CS, WRITE), (CS, WRITE))], None, (Stages::COPY, NONE)));
    assert!(matches!(violation.rule, Rule::HandOver { waited: false, .. }), "{violation}");
}

/// The two barriers are calls that follow each other: what the first makes available is there before the second's layout
/// change only if they form an execution dependency chain. Waiting for the writer itself isn't enough.
#[test]
fn an_image_barrier_goes_on_from_the_memory_barrier_that_makes_the_last_owners_writes_available() {
    let chained = |to| handed_over(vec![memory((CS, WRITE), (to, NONE))], None, (CS, NONE));
    assert_eq!(chained(CS), []);
    for elsewhere in [Stages::empty(), Stages::COPY, Stages::FRAGMENT_SHADER] {
        let violation = only(chained(elsewhere));
        assert!(matches!(violation.rule, Rule::HandOver { waited: true, .. }), "{elsewhere:?}: {violation}");
    }
}

#[test]
fn two_images_that_live_at_once_in_one_place_are_reported_once() {
    let mut images = images(3);
    if let Role::Transient(placement) = &mut images[1].role {
        placement.offset = 8192;
    }
    let [a, b] = &images;
    let steps = vec![
        step(vec![first(a, WRITES)], uses("write", 1, &[(a, WRITES)])),
        step(vec![first(b, WRITES)], uses("overwrite", 2, &[(b, WRITES)])),
        step(vec![between(a, WRITES, READS, Hazard::ReadAfterWrite, 0)], uses("read", 3, &[(a, READS)])),
    ];
    let violation = only(verify(&plan_of(&images, steps)));
    assert_eq!(
        violation.to_string(),
        "step 1 `overwrite`: `b` (COLOR, mip 0, layer 0; bytes 8192–16384): takes memory that `a` still needs in step 2 `read`"
    );
}

#[test]
fn reading_and_writing_at_once_takes_one_access() {
    let images = images(1);
    let [a, _] = &images;
    let steps = |of: &[(&Image, State)]| vec![step(vec![first(a, BOTH)], uses("mix", 1, of))];
    let violation = only(verify(&plan_of(&images, steps(&[(a, WRITES), (a, READS)]))));
    assert_eq!(violation.step, violation.other, "{violation}");
}
