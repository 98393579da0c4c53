//! The entries of a Plan: its parts that people read about by themselves. The text of a Plan, its differences, what is explained and pages
//! print them.

use super::{
    Attachment, AttachmentResolve, Buffer, BufferId, Cause, Change, Image, ImageBarrier, ImageId, MemoryBarrier, Note,
    Output, OutsideTransfer, OutsideWay, Pass, Plan, Resource, SettingUsed, Step, StepId, View, Wait,
};
use serde::Serialize;
use std::sync::Arc;

/// The kind of an entry, and of a line of a Plan's text. Differences are told in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EntryKind {
    /// A setting.
    Setting,
    /// A view.
    View,
    /// A pass, an inserted one too.
    Pass,
    /// A resolve. In the text of a Plan, a resolve that is a step of its own is told as a step.
    Resolve,
    /// A copy, blit or fill. In the text of a Plan it is a step.
    Transfer,
    /// The load and store operation of an attachment.
    Attachment,
    /// An image.
    Image,
    /// A buffer.
    Buffer,
    /// An output.
    Output,
    /// A barrier.
    Barrier,
    /// A wait for another queue.
    Wait,
    /// A note of the compiler.
    Note,
    /// A change that a file made to the pipeline.
    Change,
    /// A step.
    Step,
    /// The Plan as a whole.
    Plan,
    /// The sums.
    Total,
    /// What is said beside the line above it.
    Detail,
}

/// The part of a Plan that a line is about.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum About {
    /// A step.
    Step(StepId),
    /// A pass, by its name.
    Pass(Arc<str>),
    /// An image.
    Image(ImageId),
    /// A buffer.
    Buffer(BufferId),
}

impl About {
    /// An image or buffer.
    fn of(resource: Resource) -> About {
        match resource {
            Resource::Image(image) => About::Image(image),
            Resource::Buffer(buffer) => About::Buffer(buffer),
        }
    }
}

/// An entry of a Plan.
#[derive(Debug, Clone, Copy)]
pub struct Entry<'p> {
    /// The step that it is or belongs to; `None`: it is no part of a step.
    pub step: Option<StepId>,
    /// The part of the Plan.
    pub item: Item<'p>,
}

/// A part of a Plan that is an entry.
#[derive(Debug, Clone, Copy)]
pub enum Item<'p> {
    /// A setting.
    Setting(&'p SettingUsed),
    /// A change that a file made to the pipeline.
    Change(&'p Change),
    /// A view.
    View(&'p View),
    /// A step.
    Step(&'p Step),
    /// What a step waits for.
    Wait(&'p Wait),
    /// A memory barrier.
    MemoryBarrier(&'p MemoryBarrier),
    /// An image barrier, before the work of a step or after it.
    ImageBarrier(&'p ImageBarrier),
    /// What a step takes from an outside owner, or gives back to it.
    Outside(&'p OutsideTransfer),
    /// An attachment of a rendering scope, and its number among them: the location of a colour attachment.
    Attachment(usize, &'p Attachment),
    /// A pass.
    Pass(&'p Pass),
    /// A resolve that a rendering scope carries, with the attachment whose samples it resolves.
    Resolve(&'p Attachment, &'p AttachmentResolve),
    /// An image.
    Image(&'p Image),
    /// A buffer.
    Buffer(&'p Buffer),
    /// An output.
    Output(&'p Output),
    /// A note, but for those that users of a shipped fragment can do nothing about.
    Note(&'p Note),
}

impl EntryKind {
    /// The heading over entries of this kind.
    #[must_use]
    pub fn heading(self) -> &'static str {
        match self {
            EntryKind::Setting => "settings",
            EntryKind::View => "views",
            EntryKind::Pass => "passes",
            EntryKind::Resolve => "resolves",
            EntryKind::Transfer => "copies, blits and fills",
            EntryKind::Attachment => "attachments",
            EntryKind::Image => "images",
            EntryKind::Buffer => "buffers",
            EntryKind::Output => "outputs",
            EntryKind::Barrier => "barriers",
            EntryKind::Wait => "waits between queues",
            EntryKind::Note => "notes",
            EntryKind::Change => "changes",
            EntryKind::Step => "steps",
            EntryKind::Plan => "Plans",
            EntryKind::Total => "totals",
            EntryKind::Detail => "details",
        }
    }
}

impl Plan {
    /// Its entries. Those within a step are [parts](Entry::parts) of it.
    pub fn entries(&self) -> impl Iterator<Item = Entry<'_>> {
        let steps = (0..).map(StepId).zip(&self.steps);
        let steps = steps.map(|(id, step)| Entry { step: Some(id), item: Item::Step(step) });
        let notes = self.notes.iter().filter(|note| !note.is_of_shipped_fragment());
        let before = self.settings.iter().map(Item::Setting);
        let before = before.chain(self.changes.iter().map(Item::Change)).chain(self.views.iter().map(Item::View));
        let after = self.images.iter().map(Item::Image).chain(self.buffers.iter().map(Item::Buffer));
        let after = after.chain(self.outputs.iter().map(Item::Output)).chain(notes.map(Item::Note));
        let apart = |item| Entry { step: None, item };
        before.map(apart).chain(steps).chain(after.map(apart))
    }

    /// The pass that needs a barrier, if it is a pass: the first of step `needed_by` that uses `resource`.
    pub fn needing(&self, needed_by: Option<StepId>, resource: Resource) -> Option<&Pass> {
        let uses = |pass: &&Pass| match resource {
            Resource::Image(image) => pass.accesses.iter().any(|access| access.image == image),
            Resource::Buffer(buffer) => pass.buffers.iter().any(|access| access.buffer == buffer),
        };
        self.steps.get(needed_by?.0 as usize)?.work.passes().iter().find(uses)
    }
}

impl<'p> Entry<'p> {
    /// The entries within a step: what it waits for, its barriers, its work, and what it hands to other queues.
    pub fn parts(self) -> impl Iterator<Item = Entry<'p>> {
        let step = if let Item::Step(step) = self.item { Some(step) } else { None };
        step.into_iter().flat_map(items).map(move |item| Entry { step: self.step, item })
    }

    /// Its kind.
    #[must_use]
    pub fn kind(self) -> EntryKind {
        self.described().0
    }

    /// The part of the Plan that it is about, if it is about one.
    #[must_use]
    pub fn about(self) -> Option<About> {
        self.described().1
    }

    /// Why it is there, if the Plan says so.
    #[must_use]
    pub fn cause(self) -> Option<&'p Cause> {
        self.described().2
    }

    /// Kind, the part of the Plan, and cause: a row for each kind of item.
    fn described(self) -> (EntryKind, Option<About>, Option<&'p Cause>) {
        let image = |id| Some(About::Image(id));
        match self.item {
            Item::Setting(_) => (EntryKind::Setting, None, None),
            Item::Change(_) => (EntryKind::Change, None, None),
            Item::View(_) => (EntryKind::View, None, None),
            Item::Step(step) => (EntryKind::Step, self.step.map(About::Step), step.work.cause()),
            Item::Wait(wait) => (EntryKind::Wait, Some(About::Step(wait.step)), None),
            Item::MemoryBarrier(_) => (EntryKind::Barrier, None, None),
            Item::ImageBarrier(barrier) => (EntryKind::Barrier, image(barrier.image), None),
            Item::Outside(transfer) => (EntryKind::Barrier, Some(About::of(transfer.resource)), None),
            Item::Attachment(_, attachment) => (EntryKind::Attachment, image(attachment.image), None),
            Item::Pass(pass) => (EntryKind::Pass, Some(About::Pass(pass.name.clone())), Some(&pass.cause)),
            Item::Resolve(_, resolve) => (EntryKind::Resolve, image(resolve.image), Some(&resolve.cause)),
            Item::Image(it) => (EntryKind::Image, image(it.id), Some(&it.cause)),
            Item::Buffer(it) => (EntryKind::Buffer, Some(About::Buffer(it.id)), Some(&it.cause)),
            Item::Output(_) => (EntryKind::Output, None, None),
            Item::Note(_) => (EntryKind::Note, None, None),
        }
    }
}

impl MemoryBarrier {
    /// Images and buffers that it is there for, each with the step that needs it as far as one is known.
    pub fn guarded(&self) -> impl Iterator<Item = (Resource, Option<StepId>)> {
        let hands = self.hand_overs.iter().flatten().map(|resource| (*resource, None));
        hands.chain(self.buffers.iter().map(|it| (Resource::Buffer(it.buffer), it.needed_by)))
    }
}

/// The parts of a step that are entries.
fn items(step: &Step) -> impl Iterator<Item = Item<'_>> {
    let attachments = step.work.attachments().enumerate().map(|(at, attachment)| Item::Attachment(at, attachment));
    let resolves = step.work.attachments().filter_map(|it| Some(Item::Resolve(it, it.resolve.as_ref()?)));
    let waits = step.waits.iter().map(Item::Wait);
    let memory = step.memory_barriers.iter().map(Item::MemoryBarrier);
    let outside = |way| step.outside.iter().filter(move |it| it.way == way).map(Item::Outside);
    let before = waits.chain(outside(OutsideWay::Acquire)).chain(memory);
    let before = before.chain(step.image_barriers.iter().map(Item::ImageBarrier));
    let work = attachments.chain(step.work.passes().iter().map(Item::Pass)).chain(resolves);
    let after = step.releases.iter().map(Item::ImageBarrier).chain(outside(OutsideWay::Release));
    before.chain(work).chain(after)
}
