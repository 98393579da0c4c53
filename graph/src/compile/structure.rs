//! Runs the stages: first those that don't depend on sizes and values, then those that do.

use super::cull::{self, Live};
use super::memory::{self, Aliasing, Placed};
use super::model::{Adapted, PhysicalIndex, Use};
use super::options::{Options, Order};
use super::parts::Grids;
use super::queues::{self, Assigned};
use super::retain::{self, LoadStoreOps};
use super::schedule::{self, Scheduled};
use super::scope::{self, Scoped, Step};
use super::sync::{self, AccessTimeline, Barriers, SubresourceBarrier};
use super::{adapt, fit, usage};
use crate::base::Diagnostic;
use crate::device::{MemoryProvider, Profile};
use crate::frame::Frame;
use crate::plan::Note;

/// The results of the stages before `place`.
#[derive(Debug)]
pub(super) struct Structure {
    pub(super) live: Live,
    /// Notes of the stages from `fit` on, in their order, without those about queues.
    pub(super) notes: Vec<Note>,
    /// Why passes run on their queues, the last notes of all.
    pub(super) queue_notes: Vec<Note>,
    pub(super) adapted: Adapted,
    /// Uses as `adapt` left them, if the order can be found again only from those.
    uses: Vec<Use>,
    scheduled: Scheduled,
    /// Which draws have the area of the draw before them, in execution order, if that may decide anything.
    same_areas: Vec<bool>,
    pub(super) scoped: Scoped,
    pub(super) load_store: LoadStoreOps,
    pub(super) timeline: AccessTimeline,
    /// How long memory is taken, where steps of several queues run side by side, and transient resources in the order in
    /// which they begin to take it.
    spans: Option<(Vec<[u32; 2]>, Vec<PhysicalIndex>)>,
    /// Transient resources in the order of their first steps.
    by_first_step: Vec<PhysicalIndex>,
}

/// The results of the stages from `place` on.
#[derive(Debug)]
pub(super) struct Settled {
    pub(super) placed: Placed,
    aliasing: Aliasing,
    pub(super) barriers: Barriers,
    pub(super) exact_memory: bool,
}

/// How much of what was settled holds for other sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Settling {
    /// All but sizes and offsets.
    Same,
    /// Memory is aliased in another way, so barriers differ.
    OtherBarriers,
    /// Nothing.
    Nothing,
}

impl Structure {
    /// Runs the stages before `place`. Where the device can't use formats as the frame does, it runs them for a frame with
    /// others, which is returned too. `keeps`: for [`Structure::still_holds`], later.
    pub(super) fn find_with_fallback(
        frame: &Frame,
        device: &Profile,
        options: &Options,
        keeps: bool,
    ) -> Result<(Structure, Option<Frame>), Vec<Diagnostic>> {
        let (grids, live) = cull::live(frame)?;
        let formats = fit::formats(frame, &live.passes, device);
        let of_needs = fit::check_needs(frame, &live.passes, device)?;
        let mut structure = Structure::find(formats.frame(frame), (grids, live), &formats, device, options, keeps)?;
        structure.notes.splice(0..0, formats.notes.into_iter().chain(of_needs));
        Ok((structure, formats.substitute))
    }

    fn find(
        frame: &Frame,
        (grids, live): (Grids, Live),
        formats: &fit::Formats<'_>,
        device: &Profile,
        options: &Options,
        keeps: bool,
    ) -> Result<Structure, Vec<Diagnostic>> {
        let negotiated = fit::negotiate(frame, &live.passes, formats)?;
        let input = adapt::Input { frame, grids: &grids, live: &live, negotiated: &negotiated, device, options };
        let (adapted, of_adapt) = adapt::adapt(input)?;
        let scheduled = schedule::schedule(&adapted, options.order, keeps);
        let areas = || scope::same_areas(&adapted, &scheduled.order, device).collect();
        let same_areas = if keeps { areas() } else { Vec::new() };
        let uses = if keeps && options.order == Order::LowMemory { adapted.uses.clone() } else { Vec::new() };
        let (scoped, adapted, of_scope) = scope::scope(frame, adapted, &scheduled.order, device);
        let Assigned { scoped, queues, notes: queue_notes, sharing } =
            queues::assign(frame, &adapted, scoped, device, options);
        let load_store = retain::retain(frame, &adapted, &scoped);
        let mut timeline = sync::timeline(&adapted, &scoped, &load_store, queues);
        let spans = timeline.queues.memory_spans(&adapted, &scoped, &timeline.lifetimes).map(|spans| {
            let order = memory::by_first_step(&adapted, &spans);
            (spans, order)
        });
        let by_first_step = memory::by_first_step(&adapted, &timeline.lifetimes);
        let adapted = usage::finish(adapted, &sharing, &mut timeline, &load_store, &scoped, options);
        fit::check_support(frame, &adapted, &scoped, &formats.supports)?;
        let notes = [negotiated.notes, of_adapt, of_scope].into_iter().flatten().collect();
        Ok(Structure {
            live,
            notes,
            queue_notes,
            adapted,
            uses,
            scheduled,
            same_areas,
            scoped,
            load_store,
            timeline,
            spans,
            by_first_step,
        })
    }

    /// Whether it holds for another valid frame, which differs only in sizes and values, and forwards only between images of
    /// the same proportions. Takes over the sizes. If it doesn't hold, it must not be used any more.
    pub(super) fn still_holds(&mut self, frame: &Frame, device: &Profile, options: &Options) -> bool {
        if !fit::still_holds(frame, &self.live.passes, device) {
            return false;
        }
        let Structure { adapted, uses, scheduled, same_areas, .. } = self;
        adapted.resize(frame);
        if !scope::same_areas(adapted, &scheduled.order, device).eq(same_areas.iter().copied()) {
            return false;
        }
        let as_adapted = options.order == Order::LowMemory;
        if as_adapted {
            std::mem::swap(&mut adapted.uses, uses);
        }
        let same_order = scheduled.still_holds(adapted, options.order);
        if as_adapted {
            std::mem::swap(&mut adapted.uses, uses);
        }
        same_order && self.same_queues(frame, device, options)
    }

    /// Whether the same steps gain by leaving the graphics queue. Takes over the figures.
    fn same_queues(&mut self, frame: &Frame, device: &Profile, options: &Options) -> bool {
        if self.queue_notes.is_empty() {
            return true;
        }
        let Structure { adapted, scoped, timeline, queue_notes, .. } = self;
        // Queues are decided before layouts are joined.
        timeline.swap_layouts(&mut adapted.uses);
        let decision = queues::decide(frame, adapted, &scoped.steps, device, options);
        timeline.swap_layouts(&mut adapted.uses);
        *queue_notes = decision.notes;
        let does_work = scoped.steps.iter().map(|step| *step != Step::BarriersOnly);
        let mut decided = (0..).zip(&decision.queues).zip(does_work);
        decided.all(|((at, queue), works)| !works || timeline.queues.queue(at) == *queue)
    }

    /// Runs the stages from `place` on. `barriers`: those of the timeline.
    pub(super) fn settle(
        &self,
        barriers: Vec<SubresourceBarrier>,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Settled, Vec<Diagnostic>> {
        let placed = self.place(&barriers, device, memory, options)?;
        let aliasing = Aliasing::of(&placed, &self.by_first_step);
        let barriers = self.barriers(barriers, &aliasing, options);
        Ok(Settled { placed, aliasing, barriers, exact_memory: memory.exact() })
    }

    /// Settles again for other sizes.
    pub(super) fn settle_again(
        &self,
        settled: &mut Settled,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Settling, Vec<Diagnostic>> {
        settled.placed = self.place(&self.timeline.barriers, device, memory, options)?;
        if settled.aliasing.still_holds(&settled.placed) {
            return Ok(Settling::Same);
        }
        let aliasing = Aliasing::of(&settled.placed, &self.by_first_step);
        let before = std::mem::replace(&mut settled.aliasing, aliasing);
        if before.edges == settled.aliasing.edges {
            return Ok(Settling::Same);
        }
        // The waits of several queues depend on aliasing too.
        if !self.timeline.queues.is_one() {
            return Ok(Settling::Nothing);
        }
        let mut barriers = std::mem::take(&mut settled.barriers.barriers);
        barriers.clone_from(&self.timeline.barriers);
        settled.barriers = self.barriers(barriers, &settled.aliasing, options);
        Ok(Settling::OtherBarriers)
    }

    /// `barriers`: those of the timeline.
    fn place(
        &self,
        barriers: &[SubresourceBarrier],
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Placed, Vec<Diagnostic>> {
        let (spans, order) = match &self.spans {
            Some((spans, order)) => (Some(&spans[..]), &order[..]),
            None => (None, &self.by_first_step[..]),
        };
        let saves_calls = options.order != Order::LowMemory && self.timeline.queues.is_one();
        let waits = saves_calls.then(|| sync::waits(barriers, self.scoped.steps.len()));
        let lifetimes = &self.timeline.lifetimes[..];
        let times = memory::Times { lifetimes, spans, order, waits: waits.as_deref() };
        memory::place(&self.adapted, times, device, memory, options)
    }

    fn barriers(&self, barriers: Vec<SubresourceBarrier>, aliasing: &Aliasing, options: &Options) -> Barriers {
        let steps = self.scoped.steps.len() as u32;
        sync::barriers(&self.adapted, &self.timeline, barriers, &aliasing.edges, steps, options.poison)
    }
}
