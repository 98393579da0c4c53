//! Reports of the checker: data first, a sentence where it is shown.

use crate::plan::names::ShownText;
use crate::plan::{Plan, Queue, StepId};
use crate::vulkan::{Accesses, Layout, Stages, Subresources, name_of};
use std::fmt;
use std::fmt::{Display, Formatter};
use std::sync::Arc;

/// One mistake in a Plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation {
    /// Which rule is broken, and how.
    pub rule: Rule,
    /// The step where the mistake shows: for the state of outputs, the last one; `None`: the Plan as a whole.
    pub step: Option<StepName>,
    /// The other step: one that this step collides with, or that should have been waited for.
    pub other: Option<StepName>,
    /// The image or buffer, by its name.
    pub resource: Option<Arc<str>>,
    /// The part of the image.
    pub range: Option<Subresources>,
    /// First byte and one past the last byte: in its heap where memory is the matter, else of the buffer.
    pub bytes: Option<[u64; 2]>,
}

/// A step as people call it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StepName {
    /// Which step.
    pub step: StepId,
    /// Its passes, or its source and target; escaped.
    pub name: String,
    /// How many frames before it ran.
    pub frames_ago: u32,
}

/// The rules of a Plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Rule {
    /// Parts of the Plan disagree with each other or with Vulkan.
    Structure {
        /// The mistake, as a sentence without final stop; names are escaped.
        what: String,
    },
    /// The image is in another layout than the access or barrier names.
    Layout {
        /// The layout it is in.
        found: Layout,
        /// The layout that was named.
        needed: Layout,
    },
    /// No execution dependency orders two accesses, of which one writes.
    Execution {
        /// The earlier one.
        earlier: Accessed,
        /// The later one.
        later: Accessed,
    },
    /// They are ordered, but the write isn't made available.
    Availability {
        /// The write.
        earlier: Accessed,
        /// The later access.
        later: Accessed,
    },
    /// The write is available, but not visible to the later access.
    Visibility {
        /// The write.
        earlier: Accessed,
        /// The later access.
        later: Accessed,
    },
    /// A read of contents that no step of the frame wrote.
    Uninitialised {
        /// Some step wrote them, but none that is sure to have written all of them.
        in_part: bool,
    },
    /// A read of contents that were written, but lost since.
    LostWrite {
        /// How they were lost.
        loss: Loss,
    },
    /// Two images use the same bytes at the same time.
    Overlap {
        /// The other image.
        with: Arc<str>,
    },
    /// Memory changes hands before its last owner is done.
    HandOver {
        /// The last owner.
        from: Arc<str>,
        /// Its access.
        earlier: Accessed,
        /// Whether the access is waited for, but the write not made available.
        waited: bool,
    },
    /// An image is used outside the lifetime that the Plan states.
    Lifetime {
        /// The stated first and last step.
        stated: [StepId; 2],
    },
    /// An image or buffer that one queue at a time may use is used on another than its own.
    Ownership {
        /// The kind of mistake.
        fault: OwnershipFault,
    },
    /// A sum is wrong.
    Total {
        /// Its field.
        field: &'static str,
        /// The sum that the Plan states.
        stated: u64,
        /// The sum that its steps, images and heaps give.
        counted: u64,
    },
}

/// An access to an image in a report, or an event that counts as one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accessed {
    /// An access.
    By(Stages, Accesses),
    /// Any read in a stage.
    Read(Stages),
    /// A barrier that changes the layout, which counts as a write.
    LayoutChange,
    /// Nothing more than waiting.
    Wait(Stages),
    /// A use after the frame that relies on the promised state.
    AfterFrame,
}

/// How queues disagree about who may use something. The other step is the one that used it, or handed it over, last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnershipFault {
    /// It belongs to another queue and was not handed over.
    Elsewhere {
        /// The queue that it belongs to.
        owner: Queue,
        /// The queue that uses it.
        user: Queue,
    },
    /// It was released, and used before it was acquired.
    NotAcquired {
        /// The two queues of the release.
        released: [Queue; 2],
    },
    /// It is acquired and was not released.
    NotReleased {
        /// The two queues of the acquiring barrier.
        acquired: [Queue; 2],
    },
    /// The two halves name other queues, ranges or layouts.
    Unequal {
        /// The two queues of the release.
        released: [Queue; 2],
        /// The two queues of the acquiring barrier.
        acquired: [Queue; 2],
    },
    /// It was released, and its contents were forgotten instead of acquired.
    NeverAcquired {
        /// The two queues of the release.
        released: [Queue; 2],
    },
}

/// How contents were lost.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Loss {
    /// A barrier from `UNDEFINED`.
    Forgotten,
    /// A `DONT_CARE` load over them, and no draw since that is sure to cover the image.
    NotLoaded,
    /// A `DONT_CARE` store, or `NONE` after a write.
    NotStored,
    /// Another image took their memory.
    Taken {
        /// That image.
        by: Arc<str>,
    },
}

impl StepName {
    pub(super) fn new(plan: &Plan, step: StepId, frames_ago: u32) -> StepName {
        StepName { step, name: plan.step_name(step), frames_ago }
    }
}

impl Display for StepName {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "step {} {}", self.step.0, self.name)?;
        match self.frames_ago {
            0 => Ok(()),
            1 => f.write_str(" of the frame before"),
            more => write!(f, " of {more} frames before"),
        }
    }
}

impl Display for Accessed {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Accessed::By(stages, accesses) => write!(f, "{} in {}", name_of(accesses), name_of(stages)),
            Accessed::Read(stages) => write!(f, "the read in {}", name_of(stages)),
            Accessed::LayoutChange => f.write_str("the layout change"),
            Accessed::Wait(stages) => name_of(stages).fmt(f),
            Accessed::AfterFrame => f.write_str("what relies on the state after the frame"),
        }
    }
}

impl Display for Violation {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.step {
            Some(step) => step.fmt(f)?,
            None => f.write_str("the Plan")?,
        }
        if let Some(resource) = &self.resource {
            write!(f, ": `{}`", ShownText(resource))?;
        }
        match (&self.range, &self.bytes) {
            (Some(range), None) => write!(f, " ({range})")?,
            (Some(range), Some([start, end])) => write!(f, " ({range}; bytes {start}–{end})")?,
            (None, Some([start, end])) => write!(f, " (bytes {start}–{end})")?,
            (None, None) => {}
        }
        f.write_str(": ")?;
        let other = OtherStep(self.other.as_ref());
        match &self.rule {
            Rule::Structure { what } => match &self.other {
                Some(other) => write!(f, "{what} ({other})"),
                None => f.write_str(what),
            },
            Rule::Layout { found: Layout::Undefined, needed } => {
                write!(f, "named in layout {}, but no barrier brings it there after {other}", name_of(needed))
            }
            Rule::Layout { found, needed } => {
                write!(f, "named in layout {}, but it is in {} since {other}", name_of(needed), name_of(found))
            }
            Rule::Execution { earlier, later } => {
                write!(f, "{later} doesn't wait for {earlier} by {other}")
            }
            Rule::Availability { earlier, later } => {
                write!(f, "{later} comes after {earlier} by {other}, but no barrier makes that write available")
            }
            Rule::Visibility { earlier, later } => {
                write!(f, "{later} comes after {earlier} by {other}, but no barrier makes that write visible to it")
            }
            Rule::Uninitialised { in_part: true } => write!(f, "read, but {other} may leave some of it unwritten"),
            Rule::Uninitialised { in_part: false } => match &self.other {
                other if *other == self.step => f.write_str("read, but nothing in the frame has written it"),
                _ => write!(f, "read, but nothing in the frame has written it ({other} only prepares it)"),
            },
            Rule::LostWrite { loss } => match loss {
                Loss::Forgotten => write!(f, "read, but a barrier from UNDEFINED before {other} lost its contents"),
                Loss::NotLoaded => write!(f, "needed, but the DONT_CARE load of {other} lost its contents"),
                Loss::NotStored => write!(f, "read, but {other} doesn't store its contents"),
                Loss::Taken { by } => write!(f, "read, but `{}` took its memory before {other}", ShownText(by)),
            },
            Rule::Overlap { with } => {
                write!(f, "takes memory that `{}` still needs in {other}", ShownText(with))
            }
            Rule::HandOver { from, earlier, waited: false } => {
                write!(f, "takes the memory of `{}`, but doesn't wait for {earlier} by {other}", ShownText(from))
            }
            Rule::HandOver { from, earlier, waited: true } => {
                write!(
                    f,
                    "takes the memory of `{}`, but {earlier} by {other} isn't made available first",
                    ShownText(from)
                )
            }
            Rule::Lifetime { stated: [first, last] } => {
                write!(f, "used outside its stated lifetime, steps {} to {} (nearest: {other})", first.0, last.0)
            }
            Rule::Ownership { fault } => {
                let queues = |[from, to]: &[Queue; 2]| format!("{} to {}", name_of(from), name_of(to));
                match fault {
                    OwnershipFault::Elsewhere { owner, user } => {
                        let (owner, user) = (name_of(owner), name_of(user));
                        write!(f, "used on {user}, but it belongs to {owner} since {other} and isn't handed over")
                    }
                    OwnershipFault::NotAcquired { released } => {
                        write!(f, "used before a barrier acquires what {other} released from {}", queues(released))
                    }
                    OwnershipFault::NotReleased { acquired } => {
                        write!(f, "acquired from {}, but not released since {other}", queues(acquired))
                    }
                    OwnershipFault::Unequal { released, acquired } => {
                        let (released, acquired) = (queues(released), queues(acquired));
                        write!(
                            f,
                            "acquired from {acquired} with another range, other layouts or queues than {other} "
                        )?;
                        write!(f, "released it with from {released}")
                    }
                    OwnershipFault::NeverAcquired { released } => {
                        write!(f, "begun anew, but {other} released it from {} for nothing", queues(released))
                    }
                }
            }
            Rule::Total { field, stated, counted } => {
                write!(f, "totals.{field} is {stated}, its parts add up to {counted}")
            }
        }
    }
}

/// The other step, or the words that stand for it.
struct OtherStep<'v>(Option<&'v StepName>);

impl Display for OtherStep<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(step) => step.fmt(f),
            None => f.write_str("before the frame"),
        }
    }
}
