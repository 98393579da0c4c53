//! What doesn't depend on sizes and values, and what follows from it once sizes are known.

use super::batch::{self, Batched};
use super::cull::{self, Live};
use super::hand_over::{self, MemoryScopes};
use super::model::{Adapted, Use};
use super::occupy::Occupancy;
use super::options::{Options, Order};
use super::outlive::{self, States};
use super::parts::Grids;
use super::place::{self, Placed};
use super::retain::{self, Retained};
use super::schedule::{self, Scheduled};
use super::scope::{self, Scoped, Step};
use super::synchronise::{self, Pending, Walked};
use super::{adapt, fit, queues, redundant, take_over, usage};
use crate::base::Diagnostic;
use crate::device::{MemoryProvider, Profile};
use crate::frame::Frame;
use crate::plan::Note;

/// What the stages before `place` decided.
#[derive(Debug)]
pub(super) struct Structure {
    pub(super) grids: Grids,
    pub(super) live: Live,
    /// Notes of the stages before `adapt`.
    pub(super) notes: Vec<Note>,
    pub(super) adapted: Adapted,
    /// Uses as `adapt` left them, if the order can be found again only from those.
    uses: Vec<Use>,
    scheduled: Scheduled,
    /// Which draws have the area of the draw before them, in execution order, if that may decide anything.
    same_areas: Vec<bool>,
    pub(super) scoped: Scoped,
    pub(super) retained: Retained,
    pub(super) walked: Walked,
    pub(super) states: Vec<Option<States>>,
    /// The number of steps but for the export.
    pub(super) export: u32,
}

/// What the stages from `place` on decided.
#[derive(Debug)]
pub(super) struct Settled {
    pub(super) placed: Placed,
    /// How long memory is taken, where steps of several queues run side by side.
    spans: Option<Vec<[u32; 2]>>,
    occupancy: Occupancy,
    pub(super) batched: Vec<Batched>,
    pub(super) memory: Vec<(u32, MemoryScopes)>,
    pub(super) exact_memory: bool,
}

/// How much of what was settled serves for other sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Settling {
    /// All but sizes and offsets.
    Same,
    /// Memory changes hands in another way, so that barriers are other ones.
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
        let mut structure = Structure::find(formats.frame(frame), (grids, live), &formats, device, options, keeps)?;
        structure.notes.splice(0..0, formats.notes);
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
        let mut negotiated = fit::negotiate(frame, &live.passes, formats)?;
        let notes = std::mem::take(&mut negotiated.notes);
        let input = adapt::Input { frame, grids: &grids, live: &live, negotiated: &negotiated, device, options };
        let mut adapted = adapt::adapt(input)?;
        let scheduled = schedule::schedule(&grids, &adapted, options.order, keeps);
        let areas = || scope::same_areas(&adapted, &scheduled.order, device).collect();
        let same_areas = if keeps { areas() } else { Vec::new() };
        let uses = if keeps && options.order == Order::LowMemory { adapted.uses.clone() } else { Vec::new() };
        let mut scoped = scope::scope(frame, &grids, &mut adapted, &scheduled.order, device);
        let queues = queues::assign(frame, &grids, &mut adapted, &mut scoped, device, options);
        let retained = retain::retain(frame, &grids, &adapted, &scoped);
        let mut walked = synchronise::walk(&grids, &mut adapted, &scoped, &retained, queues);
        let export = scoped.steps.len() as u32;
        let states = outlive::promise(&grids, &adapted, &mut walked, export);
        usage::note(&grids, &mut adapted, &walked, &states, &retained, &scoped, options);
        fit::check_support(frame, &adapted, &scoped, device)?;
        Ok(Structure {
            grids,
            live,
            notes,
            adapted,
            uses,
            scheduled,
            same_areas,
            scoped,
            retained,
            walked,
            states,
            export,
        })
    }

    /// Whether a legal frame that differs from the one it was found for in nothing but sizes and values, and forwards between
    /// images of the same proportions, has the same structure. Takes over the sizes; if it says no, nothing here is of use
    /// any more.
    pub(super) fn still_holds(&mut self, frame: &Frame, device: &Profile, options: &Options) -> bool {
        if !fit::still_holds(frame, &self.live.passes, device) {
            return false;
        }
        let Structure { grids, adapted, uses, scheduled, same_areas, .. } = self;
        adapted.resize(frame);
        if !scope::same_areas(adapted, &scheduled.order, device).eq(same_areas.iter().copied()) {
            return false;
        }
        let as_adapted = options.order == Order::LowMemory;
        if as_adapted {
            std::mem::swap(&mut adapted.uses, uses);
        }
        let same_order = scheduled.still_holds(grids, adapted, options.order);
        if as_adapted {
            std::mem::swap(&mut adapted.uses, uses);
        }
        same_order
    }

    /// Runs the stages from `place` on; barriers before first uses must be as `find` left them.
    pub(super) fn settle(
        &mut self,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Settled, Vec<Diagnostic>> {
        let Structure { adapted, scoped, walked, .. } = self;
        let spans = walked.queues.as_ref().map(|queues| queues.spans(adapted, scoped, &walked.lifetimes));
        let placed = place::place(adapted, &walked.lifetimes, spans.as_deref(), device, memory, options)?;
        let occupancy = Occupancy::of(&placed, &walked.lifetimes);
        let (batched, hand_overs) = self.synchronise(&occupancy);
        Ok(Settled { placed, spans, occupancy, batched, memory: hand_overs, exact_memory: memory.exact() })
    }

    /// As [`Structure::settle`], where nothing is settled again: what only that takes needn't lie beside the Plan.
    pub(super) fn settle_for_good(
        &mut self,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Settled, Vec<Diagnostic>> {
        let mut settled = self.settle(device, memory, options)?;
        settled.occupancy = Occupancy::default();
        self.walked.cells = Vec::new();
        self.walked.lifetimes = Vec::new();
        self.scheduled.order = Vec::new();
        self.walked.barriers.shrink_to_fit();
        self.adapted.uses.shrink_to_fit();
        Ok(settled)
    }

    /// Settles again where the structure held for other sizes. `pending`: barriers as `find` left them.
    pub(super) fn settle_again(
        &mut self,
        settled: &mut Settled,
        pending: &[Pending],
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Settling, Vec<Diagnostic>> {
        let Structure { adapted, walked, .. } = self;
        let spans = settled.spans.as_deref();
        settled.placed = place::place(adapted, &walked.lifetimes, spans, device, memory, options)?;
        if settled.occupancy.still_holds(&settled.placed) {
            return Ok(Settling::Same);
        }
        let occupancy = Occupancy::of(&settled.placed, &walked.lifetimes);
        let before = std::mem::replace(&mut settled.occupancy, occupancy);
        if before.taken == settled.occupancy.taken {
            return Ok(Settling::Same);
        }
        // What steps of several queues wait for depends on who had whose memory.
        if walked.queues.is_some() {
            return Ok(Settling::Nothing);
        }
        walked.barriers.clear();
        walked.barriers.extend_from_slice(pending);
        (settled.batched, settled.memory) = self.synchronise(&settled.occupancy);
        Ok(Settling::OtherBarriers)
    }

    /// Runs the stages behind `occupy`.
    fn synchronise(&mut self, occupancy: &Occupancy) -> (Vec<Batched>, Vec<(u32, MemoryScopes)>) {
        let Structure { grids, adapted, scoped, walked, states, export, .. } = self;
        let hand_overs = take_over::take_over(grids, adapted, states, occupancy, walked);
        let mut batched = match &walked.queues {
            None => batch::batch(&adapted.stores, &walked.barriers),
            Some(queues) => batch::batch_on(queues, &adapted.stores, &walked.barriers),
        };
        redundant::take_out(adapted, walked, &mut batched);
        let (pending, queues) = (&walked.barriers, &walked.queues);
        scoped.steps.truncate(*export as usize);
        let waits = queues.as_ref().is_some_and(|queues| !queues.waits(*export).is_empty());
        if batched.last().is_some_and(|last| last.at == *export) || *export == 0 || waits {
            scoped.steps.push(Step::Export);
        }
        let steps = scoped.steps.len();
        let memory_barriers = match queues {
            None => hand_over::memory_barriers(&hand_overs, pending, &batched, steps),
            Some(queues) => hand_over::memory_barriers_on(queues, &hand_overs, pending, &batched, steps),
        };
        (batched, memory_barriers)
    }
}
