//! A brute-force judge of Plans: every operation of a few frames, the full happens-before closure over them, and from it
//! whether the Plan does harm.
//!
//! It shares no code with the compiler or with `verify`, and none of their short cuts: operations are unrolled over
//! several frames (`timeline`), every pair of them on common bytes is looked at (`hazards`), and what each part of each
//! image holds is followed as a number that stands for how it was made (`contents`). The cost grows with the square of a
//! Plan's operations. It is written from the specification's chapter on synchronisation and its memory model:
//!
//! - A first synchronisation scope takes in logically earlier stages, a second one logically later ones; access scopes
//!   take in neither.
//! - Two barriers form a chain if the second scope of the earlier and the first scope of the later meet, whether or not
//!   anything runs there.
//! - An image barrier makes available and visible only what goes *through* its own image; a memory barrier everything. So
//!   memory that changes hands takes a memory barrier, or the last occupant's own barrier.
//! - A layout transition reads and writes; what is available is visible to it; its own writes are available, and visible to
//!   the second scope of its barrier. Transitions of one image on one queue follow each other.
//! - A signal makes all earlier writes of its queue available; the step that waits is held up whole.

mod contents;
mod hazards;
mod scopes;
mod timeline;
mod touch;
mod uses;
mod world;

use framewright_graph::plan::{Plan, Role};

/// A dependency that is missing between two operations on the same bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    /// Nothing makes the earlier one happen before the later one.
    Order,
    /// The earlier write isn't available by then.
    Availability,
    /// The earlier write isn't visible to the later read.
    Visibility,
}

/// One way in which a Plan does harm.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Harm {
    /// Two operations on the same bytes, of which one writes.
    Hazard {
        /// The dependency that is missing between them.
        missing: Missing,
        /// The one submitted first.
        earlier: String,
        /// The other one.
        later: String,
    },
    /// Anything else, as a sentence.
    Wrong(String),
}

/// The judgement of a Plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// Every harm, in the order of finding.
    pub harms: Vec<Harm>,
    /// Values that outputs, imported resources, persistent ones and custom passes see, frame by frame: numbers that stand for
    /// how they were made; `None`: undefined.
    pub outcome: Vec<Option<u64>>,
}

/// Judges a Plan by itself.
///
/// The Plan's references must be right ([`Plan::from_json`]).
#[must_use]
pub fn judge(plan: &Plan) -> Verdict {
    let world = world::World::new(plan, frames(plan));
    let timeline = timeline::unroll(&world);
    let mut harms = hazards::find(&world, &timeline);
    harms.extend(timeline.unordered_acquisitions.into_iter().map(Harm::Wrong));
    let (wrong, outcome) = contents::follow(&world);
    harms.extend(wrong.into_iter().map(Harm::Wrong));
    Verdict { harms, outcome }
}

/// Enough frames for the oldest history to come round, and for what crosses frames to do so twice.
fn frames(plan: &Plan) -> usize {
    let images = plan.images.iter().map(|image| &image.role);
    let history = |roles: Vec<&Role>| {
        let round = |start: usize| {
            let next = |at: &usize| match roles.get(*at) {
                Some(Role::Persistent { becomes, .. }) => Some(*becomes as usize),
                _ => None,
            };
            1 + std::iter::successors(next(&start), next).take(roles.len()).take_while(|at| *at != start).count()
        };
        (0..roles.len()).map(round).max().unwrap_or(1)
    };
    2 + history(images.collect()).max(history(plan.buffers.iter().map(|buffer| &buffer.role).collect()))
}
