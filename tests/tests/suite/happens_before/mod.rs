//! The brute-force judge, held against Plans whose faults are known: each rule with the Plan that keeps it and the one that
//! doesn't.

mod build;

use crate::hand_written_plans;
use crate::hand_written_plans::build::{memory, wait};
use Layout::{General, ShaderReadOnlyOptimal, TransferDstOptimal, Undefined};
use build::{CS, NONE, R, W, access, barrier, dispatch, empty, output, persistent, transient};
use framewright_graph::plan::{Plan, Queue, Step, Work};
use framewright_graph::vulkan::{Accesses, Layout, Stages};
use framewright_tests::happens_before::{Harm, Missing, judge};

fn harms(plan: &Plan) -> Vec<Harm> {
    judge(plan).harms
}

#[track_caller]
fn fine(plan: &Plan) {
    assert_eq!(harms(plan), []);
}

/// The kinds of missing dependencies, each once.
fn missing(plan: &Plan) -> Vec<Missing> {
    let mut missing = Vec::new();
    for harm in harms(plan) {
        match harm {
            Harm::Hazard { missing: one, .. } if !missing.contains(&one) => missing.push(one),
            Harm::Hazard { .. } => {}
            Harm::Wrong(what) => panic!("{what}"),
        }
    }
    missing
}

#[track_caller]
fn wrong(plan: &Plan, words: &str) {
    let harms = harms(plan);
    let said = harms.iter().any(|harm| matches!(harm, Harm::Wrong(what) if what.contains(words)));
    assert!(said, "{words}: {harms:#?}");
}

/// `first` writes `a`; `second` samples it and writes the output.
fn written_then_sampled() -> Plan {
    let mut plan = empty();
    let a = transient(&mut plan, "a", 0);
    let out = output(&mut plan, "out");
    let mut first = dispatch("first", vec![access(a, W)]);
    // The frame before sampled it last.
    first.image_barriers.push(barrier(a, [Undefined, General], (CS, Accesses::empty()), (CS, W)));
    let mut second = dispatch("second", vec![access(a, R), access(out, W)]);
    second.image_barriers.push(barrier(a, [General, ShaderReadOnlyOptimal], (CS, W), (CS, R)));
    second.image_barriers.push(barrier(out, [Undefined, General], NONE, (CS, W)));
    plan.steps = vec![first, second];
    plan
}

#[test]
fn what_is_read_at_its_own_position_is_drawn_over_behind_a_local_barrier() {
    let plans = hand_written_plans::all();
    let named = |plan: &Plan, name: &str| {
        let scopes =
            plan.steps.iter().filter_map(|step| if let Work::Render(it) = &step.work { Some(it) } else { None });
        scopes.flat_map(|scope| &scope.passes).any(|pass| &*pass.name == name)
    };
    let (_, plan) = plans.into_iter().find(|(_, plan)| named(plan, "marks")).expect("a Plan with local reads");
    fine(&plan);
    for name in ["lighting", "marks"] {
        let mut without = plan.clone();
        for step in &mut without.steps {
            if let Work::Render(scope) = &mut step.work {
                scope.passes.iter_mut().filter(|pass| &*pass.name == name).for_each(|pass| pass.local_barrier = false);
            }
        }
        assert_ne!(harms(&without), [], "without the local barrier of `{name}`");
    }
}

#[test]
fn a_write_and_a_read_with_their_barrier_do_no_harm() {
    fine(&written_then_sampled());
}

#[test]
fn a_read_that_waits_for_nothing_is_unordered() {
    let mut plan = written_then_sampled();
    plan.steps[1].image_barriers[0].src_stages = Stages::FRAGMENT_SHADER;
    assert!(missing(&plan).contains(&Missing::Order));
}

#[test]
fn a_write_that_no_barrier_names_is_not_available() {
    let mut plan = written_then_sampled();
    plan.steps[1].image_barriers[0].src_accesses = Accesses::empty();
    assert_eq!(missing(&plan), [Missing::Availability]);
}

#[test]
fn a_read_that_no_barrier_names_does_not_see_the_write() {
    let mut plan = written_then_sampled();
    plan.steps[1].image_barriers[0].dst_accesses = Accesses::UNIFORM_READ;
    assert_eq!(missing(&plan), [Missing::Visibility]);
}

#[test]
fn the_frame_before_must_have_read_before_the_next_one_writes() {
    let mut plan = written_then_sampled();
    plan.steps[0].image_barriers[0].src_stages = Stages::empty();
    assert_eq!(missing(&plan), [Missing::Order]);
}

#[test]
fn barriers_form_chains_where_their_scopes_meet() {
    let mut plan = written_then_sampled();
    let transition = &mut plan.steps[1].image_barriers[0];
    (transition.src_stages, transition.src_accesses) = (Stages::COPY, Accesses::empty());
    let mut between = dispatch("between", Vec::new());
    between.memory_barriers.push(memory((CS, W), (Stages::COPY, Accesses::TRANSFER_READ)));
    plan.steps.insert(1, between);
    // The next frame's first barrier finds all of this frame's compute work itself.
    fine(&plan);
    plan.steps[1].memory_barriers[0].dst_stages = Stages::BLIT;
    assert!(missing(&plan).contains(&Missing::Order));
}

#[test]
fn an_image_barrier_goes_on_from_the_memory_barriers_of_its_step_which_are_a_call_before_it() {
    let mut plan = written_then_sampled();
    let transition = &mut plan.steps[1].image_barriers[0];
    (transition.src_stages, transition.src_accesses) = (Stages::COPY, Accesses::empty());
    plan.steps[1].memory_barriers.push(memory((CS, W), (Stages::COPY, Accesses::TRANSFER_READ)));
    fine(&plan);
    plan.steps[1].memory_barriers[0].dst_stages = Stages::BLIT;
    assert!(missing(&plan).contains(&Missing::Order));
}

#[test]
fn two_barriers_of_one_call_form_no_chain() {
    let mut plan = written_then_sampled();
    let transition = &mut plan.steps[1].image_barriers[0];
    (transition.src_stages, transition.src_accesses) = (Stages::COPY, Accesses::empty());
    let [clear, copy] = [Stages::CLEAR, Stages::COPY].map(|stage| (stage, Accesses::TRANSFER_READ));
    plan.steps[1].memory_barriers.extend([memory((CS, W), clear), memory(clear, copy)]);
    assert!(missing(&plan).contains(&Missing::Order));
}

#[test]
fn an_image_in_another_layout_is_found() {
    let mut plan = written_then_sampled();
    plan.steps[1].image_barriers[0].new_layout = TransferDstOptimal;
    wrong(&plan, "`a` is used in ShaderReadOnlyOptimal, but it is in TransferDstOptimal");
    let mut plan = written_then_sampled();
    plan.steps[1].image_barriers[0].old_layout = TransferDstOptimal;
    wrong(&plan, "barrier takes `a` from TransferDstOptimal, but it is in General");
}

#[test]
fn contents_that_a_barrier_forgets_are_undefined() {
    let mut plan = written_then_sampled();
    plan.steps[1].image_barriers[0].old_layout = Undefined;
    wrong(&plan, "`a` is read, but undefined");
}

/// `a` is written and sampled; then `b` takes its memory, is written and sampled.
fn handed_over() -> Plan {
    let mut plan = written_then_sampled();
    let b = transient(&mut plan, "b", 0);
    let a = plan.images[0].id;
    let out = plan.images[1].id;
    let mut third = dispatch("third", vec![access(b, W)]);
    third.image_barriers.push(barrier(b, [Undefined, General], (CS, Accesses::empty()), (CS, W)));
    let mut fourth = dispatch("fourth", vec![access(b, R), access(out, W)]);
    fourth.image_barriers.push(barrier(b, [General, ShaderReadOnlyOptimal], (CS, W), (CS, R)));
    fourth.image_barriers.push(barrier(out, [General, General], (CS, W), (CS, W)));
    plan.steps.extend([third, fourth]);
    assert_eq!(a.0, 0);
    plan
}

#[test]
fn memory_that_was_last_read_changes_hands_by_waiting() {
    fine(&handed_over());
    let mut plan = handed_over();
    plan.steps[2].image_barriers[0].src_stages = Stages::empty();
    assert_eq!(missing(&plan), [Missing::Order]);
}

/// As before, but `a` is written once more when it has been sampled: its memory changes hands with a write in it.
fn handed_over_after_a_write() -> Plan {
    let mut plan = handed_over();
    let a = plan.images[0].id;
    let mut again = dispatch("again", vec![access(a, W)]);
    again.image_barriers.push(barrier(a, [Undefined, General], (CS, Accesses::empty()), (CS, W)));
    plan.steps.insert(2, again);
    plan.steps[3].memory_barriers.push(memory((CS, W), (CS, W)));
    plan
}

#[test]
fn memory_that_was_last_written_changes_hands_by_a_memory_barrier() {
    fine(&handed_over_after_a_write());
    let mut plan = handed_over_after_a_write();
    plan.steps[3].memory_barriers.clear();
    assert_eq!(missing(&plan), [Missing::Availability]);
}

#[test]
fn whose_memory_was_taken_is_undefined() {
    let mut plan = written_then_sampled();
    let b = transient(&mut plan, "b", 0);
    let mut between = dispatch("between", vec![access(b, W)]);
    between.memory_barriers.push(memory((CS, W), (CS, W)));
    between.image_barriers.push(barrier(b, [Undefined, General], (CS, W), (CS, W)));
    plan.steps.insert(1, between);
    wrong(&plan, "`a` is read, but undefined");
}

/// `newest` is written; `older`, what it was one frame ago, is sampled.
fn history() -> Plan {
    let mut plan = empty();
    let newest = persistent(&mut plan, "newest", 1);
    let older = persistent(&mut plan, "older", 0);
    let out = output(&mut plan, "out");
    let mut write = dispatch("write", vec![access(newest, W)]);
    // Sampled in the frame before, when it was the older one; written in the one before that.
    write.image_barriers.push(barrier(newest, [General, General], (CS, W), (CS, W)));
    let mut read = dispatch("read", vec![access(older, R), access(out, W)]);
    read.image_barriers.push(barrier(older, [General, ShaderReadOnlyOptimal], (CS, W), (CS, R)));
    read.image_barriers.push(barrier(out, [Undefined, General], NONE, (CS, W)));
    let mut back = dispatch("back", Vec::new());
    back.image_barriers.push(barrier(older, [ShaderReadOnlyOptimal, General], (CS, Accesses::empty()), (CS, W)));
    plan.steps = vec![write, read, back];
    plan
}

#[test]
fn history_is_followed_from_frame_to_frame() {
    fine(&history());
    let mut plan = history();
    plan.steps[1].image_barriers[0].src_stages = Stages::empty();
    assert!(missing(&plan).contains(&Missing::Order));
    let mut plan = history();
    plan.steps.truncate(2);
    wrong(&plan, "`older` is left in ShaderReadOnlyOptimal, not in General");
}

/// `write` on the compute queue, `read` on the graphics queue; the image is handed over and comes back undefined.
fn two_queues() -> Plan {
    let mut plan = written_then_sampled();
    let a = plan.images[0].id;
    let owners = Some([Queue::Compute, Queue::Graphics]);
    let mut release = barrier(a, [General, ShaderReadOnlyOptimal], (CS, W), NONE);
    release.ownership = owners;
    let [write, read]: &mut [Step; 2] = plan.steps.as_mut_array().expect("two steps");
    write.queue = Queue::Compute;
    write.releases.push(release);
    write.waits.push(wait(1, 1, CS));
    read.image_barriers[0].ownership = owners;
    (read.image_barriers[0].src_stages, read.image_barriers[0].src_accesses) = NONE;
    read.waits.push(wait(0, 0, CS));
    plan
}

#[test]
fn queues_that_wait_for_each_other_and_hand_over_do_no_harm() {
    fine(&two_queues());
}

#[test]
fn a_wait_that_is_left_out_is_found_within_a_frame_and_across_frames() {
    let mut plan = two_queues();
    plan.steps[1].waits.clear();
    wrong(&plan, "`a` is acquired before its release is known to be done");
    let mut plan = two_queues();
    plan.steps[0].waits.clear();
    assert!(missing(&plan).contains(&Missing::Order));
}

#[test]
fn a_hand_over_without_its_other_half_is_found() {
    let mut plan = two_queues();
    plan.steps[0].releases.clear();
    wrong(&plan, "`a` is acquired, but was not released like that");
    let mut plan = two_queues();
    plan.steps[1].image_barriers.remove(0);
    wrong(&plan, "`a` is used by a queue that doesn't own it");
}

#[test]
fn outcomes_tell_what_was_made_of_what() {
    let outcome = |plan: &Plan| judge(plan).outcome;
    assert_eq!(outcome(&written_then_sampled()), outcome(&written_then_sampled()));
    assert_ne!(outcome(&written_then_sampled()), outcome(&handed_over()));
}
