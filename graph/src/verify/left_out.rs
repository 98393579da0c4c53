//! Steps that don't run in each frame: a Plan must hold where they are left out.
//!
//! Barriers and waits stand in every frame. So leaving work out changes what is known of the images and buffers that it uses, of those that
//! take each other's bytes, and of those that become each other; of all others it changes nothing. Cadences that have none of them in
//! common are left out in one walk: that finds what a walk for each would find.

use super::findings::role;
use crate::frame::Cadence;
use crate::plan::{Plan, Resource, Role};

/// Steps that are left out between the first frame and the last one; empty: none.
#[derive(Debug, Default)]
pub(super) struct LeftOut(Vec<bool>);

/// The most groups of cadences of which each is tried alone: its steps left out, and the steps of all others left out.
const MOST_ALONE: usize = 16;

/// A cadence, and what its steps use: numbers of [`joined`].
struct UsedBy<'p> {
    cadence: &'p Cadence,
    uses: Vec<u32>,
    /// Cadences of one group have nothing in common.
    group: usize,
}

impl LeftOut {
    /// The choices of steps that are tried: all that may be left out, and of the first groups of cadences the steps of each alone, and all but
    /// those. `circles`: images and buffers that become each other, by their numbers in one row.
    pub(super) fn choices(plan: &Plan, circles: &[Vec<u32>]) -> Vec<LeftOut> {
        if plan.steps.iter().all(|step| step.run.is_always()) {
            return Vec::new();
        }
        let (of, groups) = grouped(plan, circles);
        let choice =
            |is_out: &dyn Fn(usize) -> bool| LeftOut(of.iter().map(|group| group.is_some_and(is_out)).collect());
        let mut choices = vec![choice(&|_| true)];
        if groups > 1 {
            for group in (0..groups).take(MOST_ALONE) {
                choices.push(choice(&|other| other == group));
                // Of two groups, all but one is the other.
                if groups > 2 {
                    choices.push(choice(&|other| other != group));
                }
            }
        }
        choices
    }

    /// Whether a step runs in the frame of this number, of so many.
    pub(super) fn runs(&self, step: u32, frame: u32, frames: u32) -> bool {
        frame == 0 || frame + 1 == frames || !self.0.get(step as usize).is_some_and(|out| *out)
    }
}

/// For each step the group of its cadence, unless it always runs; and how many groups there are.
fn grouped(plan: &Plan, circles: &[Vec<u32>]) -> (Vec<Option<usize>>, usize) {
    let (joined, images) = (joined(plan, circles), plan.images.len());
    let mut known: Vec<UsedBy<'_>> = Vec::new();
    let mut of = Vec::with_capacity(plan.steps.len());
    for step in &plan.steps {
        if step.run.is_always() {
            of.push(None);
            continue;
        }
        let at = known.iter().position(|it| *it.cadence == step.run).unwrap_or(known.len());
        if at == known.len() {
            known.push(UsedBy { cadence: &step.run, uses: Vec::new(), group: 0 });
        }
        known[at].uses.extend(step.work.used().map(|(resource, _)| match resource {
            Resource::Image(image) => joined[image.0 as usize],
            Resource::Buffer(buffer) => joined[images + buffer.0 as usize],
        }));
        of.push(Some(at));
    }
    let mut groups = 0;
    for at in 0..known.len() {
        let meets = |other: &&UsedBy<'_>| other.uses.iter().any(|it| known[at].uses.contains(it));
        let taken: Vec<usize> = known[..at].iter().filter(meets).map(|it| it.group).collect();
        let group = (0..).find(|group| !taken.contains(group)).unwrap_or(at);
        groups = groups.max(group + 1);
        known[at].group = group;
    }
    (of.into_iter().map(|at| at.map(|at: usize| known[at].group)).collect(), groups)
}

/// For each image, then each buffer, the least number among those that it shares bytes with or becomes, and among those of these.
fn joined(plan: &Plan, circles: &[Vec<u32>]) -> Vec<u32> {
    let count = (plan.images.len() + plan.buffers.len()) as u32;
    let mut joined: Vec<u32> = (0..count).collect();
    let mut join = |one: u32, other: u32| {
        let (one, other) = (joined[one as usize], joined[other as usize]);
        let (least, most) = (one.min(other), one.max(other));
        if least != most {
            joined.iter_mut().filter(|it| **it == most).for_each(|it| *it = least);
        }
    };
    for circle in circles {
        circle.windows(2).for_each(|pair| join(pair[0], pair[1]));
    }
    let mut placed: Vec<(u32, u64, u64, u32)> = Vec::new();
    for number in 0..count {
        if let Role::Transient(it) = role(plan, number) {
            placed.push((it.heap, it.offset, it.offset.saturating_add(it.bytes), number));
        }
    }
    placed.sort_unstable();
    // The one that reaches furthest so far.
    let mut furthest: Option<(u32, u64, u32)> = None;
    for (heap, begin, end, number) in placed {
        match furthest {
            Some((of, reach, last)) if of == heap && begin < reach => {
                join(last, number);
                furthest = Some((heap, reach.max(end), if end > reach { number } else { last }));
            }
            Some(_) | None => furthest = Some((heap, end, number)),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Stereo;
    use crate::plan::{
        Buffer, BufferId, Cause, DeviceUsed, FORMAT_VERSION, Fill, FirstContents, Placement, Queue, Side, Step, StepId,
        Totals, Work,
    };
    use crate::vulkan::{Accesses, BufferUsage, FillValue, Layout, Sharing, Stages, State};

    /// A Plan of fills of buffers, each in its own frames, or in all if its number is 0.
    fn plan(roles: Vec<Role>, fills: &[(u32, u32)]) -> Plan {
        let buffer = |(id, role): (u32, Role)| Buffer {
            id: BufferId(id),
            name: format!("{id}").into(),
            cause: Cause::Written(None),
            bytes: 4,
            usage: BufferUsage::TRANSFER_DST,
            sharing: Sharing::Exclusive,
            role,
        };
        let step = |(buffer, frames): &(u32, u32)| {
            let target = Side::Buffer { buffer: BufferId(*buffer), bytes: 4 };
            let fill = Fill { name: None, cause: Cause::Written(None), target, value: FillValue::Bits([0; 4]) };
            Step {
                queue: Queue::Graphics,
                run: if *frames == 0 { Cadence::Always } else { Cadence::Every { count: 9, at: *frames } },
                waits: Vec::new(),
                memory_barriers: Vec::new(),
                image_barriers: Vec::new(),
                work: Work::Fill(fill),
                releases: Vec::new(),
                outside: Vec::new(),
            }
        };
        Plan {
            format_version: FORMAT_VERSION,
            device: DeviceUsed { name: String::new(), exact_memory: true },
            settings: Vec::new(),
            changes: Vec::new(),
            decided: [].into(),
            extent: [1, 1],
            stereo: Stereo::Off,
            views: Vec::new(),
            images: Vec::new(),
            buffers: (0..).zip(roles).map(buffer).collect(),
            heaps: Vec::new(),
            steps: fills.iter().map(step).collect(),
            outputs: Vec::new(),
            notes: Vec::new(),
            totals: Totals::default(),
        }
    }

    fn kept(count: u32) -> Vec<Role> {
        let state = State { stages: Stages::CLEAR, accesses: Accesses::TRANSFER_WRITE, layout: Layout::Undefined };
        let initial = FirstContents::Value(FillValue::Bits([0; 4]));
        let role = |becomes| Role::Persistent { becomes, initial: initial.clone(), before: state, after: state };
        (0..count).map(role).collect()
    }

    fn choices(plan: &Plan, circles: &[Vec<u32>]) -> Vec<String> {
        let word = |choice: LeftOut| choice.0.iter().map(|out| if *out { '-' } else { '+' }).collect();
        LeftOut::choices(plan, circles).into_iter().map(word).collect()
    }

    #[test]
    fn do_9_cadences_with_nothing_in_common_are_left_out_in_one_walk() {
        let none: [&str; 0] = [];
        assert_eq!(choices(&plan(kept(1), &[(0, 0)]), &[]), none);
        assert_eq!(choices(&plan(kept(4), &[(0, 1), (1, 2), (2, 3), (3, 0)]), &[]), ["---+"]);
        // Two of one buffer are told apart, and a third one of another buffer goes with the first.
        assert_eq!(choices(&plan(kept(2), &[(0, 1), (0, 2), (1, 3)]), &[]), ["---", "-+-", "+-+"]);
        let all = ["---", "-++", "+--", "+-+", "-+-", "++-", "--+"];
        assert_eq!(choices(&plan(kept(1), &[(0, 1), (0, 2), (0, 3)]), &[]), all);
        // What becomes the other in the next frame is the other.
        assert_eq!(choices(&plan(kept(3), &[(0, 1), (1, 2), (2, 3)]), &[vec![0, 1, 2]]), all);
        assert_eq!(choices(&plan(kept(2), &[(0, 1), (1, 2)]), &[vec![0, 1]]), ["--", "-+", "+-"]);
    }

    #[test]
    fn do_9_cadences_whose_memory_overlaps_are_told_apart() {
        let place = |heap, offset, bytes| {
            let lifetime = [StepId(0), StepId(0)];
            Role::Transient(Placement { heap, offset, bytes, alignment: 4, type_bits: 1, lifetime })
        };
        // The first one reaches over the second to the third.
        let fills = [(0, 1), (1, 2), (2, 3)];
        let apart = plan(vec![place(0, 0, 4), place(0, 4, 4), place(1, 0, 4)], &fills);
        assert_eq!(choices(&apart, &[]), ["---"]);
        let over = plan(vec![place(0, 0, 12), place(0, 0, 4), place(0, 8, 4)], &fills);
        assert_eq!(choices(&over, &[]).len(), 7);
        let chain = plan(vec![place(0, 0, 8), place(0, 4, 8), place(0, 8, 8)], &fills);
        assert_eq!(choices(&chain, &[]).len(), 7);
    }

    #[test]
    fn do_9_as_many_walks_as_there_are_allowed() {
        let fills: Vec<(u32, u32)> = (1..40).map(|frames| (0, frames)).collect();
        assert_eq!(choices(&plan(kept(1), &fills), &[]).len(), 1 + 2 * MOST_ALONE);
        let apart: Vec<(u32, u32)> = (1..40).map(|frames| (frames - 1, frames)).collect();
        assert_eq!(choices(&plan(kept(39), &apart), &[]).len(), 1);
    }
}
