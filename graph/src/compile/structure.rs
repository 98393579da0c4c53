//! What doesn't depend on sizes and values, and what follows from it once sizes are known.

use super::batch::{self, Batched};
use super::cull::{self, Live};
use super::hand_over::{self, MemoryScopes};
use super::model::{Adapted, Use};
use super::outlive::{self, States};
use super::parts::Grids;
use super::place::{self, Placed};
use super::retain::{self, Retained};
use super::schedule;
use super::scope::{self, Scoped, Step};
use super::synchronise::{self, Walked};
use super::{Options, adapt, formats, legal, link, purpose, queues, samples, take_over};
use crate::describe::Diagnostic;
use crate::device::{MemoryProvider, Profile};
use crate::frame::Frame;
use crate::plan::Note;
use std::ops::Range;

/// What the stages before `place` decided.
#[derive(Debug)]
pub(super) struct Structure {
    pub(super) grids: Grids,
    pub(super) live: Live,
    /// Sample counts in force, for each image of the frame.
    pub(super) samples: Vec<u32>,
    /// Notes of the stages before `adapt`.
    pub(super) notes: Vec<Note>,
    pub(super) adapted: Adapted,
    /// Uses as `adapt` left them; none unless they are kept.
    pub(super) uses: Vec<Use>,
    /// Which of the notes are those of `scope`.
    pub(super) notes_of_scope: Range<usize>,
    /// Indices of operations in execution order.
    pub(super) order: Vec<u32>,
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
    pub(super) batched: Vec<Batched>,
    pub(super) memory: Vec<(u32, MemoryScopes)>,
    pub(super) exact_memory: bool,
}

impl Structure {
    /// As [`Structure::find`]; where the device can't use formats as they are used, it is found for a frame with others,
    /// which is returned too.
    pub(super) fn find_with_fallback(
        frame: &Frame,
        device: &Profile,
        options: &Options,
        keeps: bool,
    ) -> Result<(Structure, Option<Frame>), Vec<Diagnostic>> {
        let errors = match Structure::find(frame, device, options, keeps) {
            Ok(structure) => return Ok((structure, None)),
            Err(errors) => errors,
        };
        let Some((substitute, notes)) = formats::fall_back(frame, device) else { return Err(errors) };
        let mut structure = Structure::find(&substitute, device, options, keeps)?;
        structure.notes.splice(0..0, notes);
        Ok((structure, Some(substitute)))
    }

    /// Runs the stages before `place`. `keeps`: for [`Structure::still_holds`], later.
    pub(super) fn find(
        frame: &Frame,
        device: &Profile,
        options: &Options,
        keeps: bool,
    ) -> Result<Structure, Vec<Diagnostic>> {
        legal::check(frame)?;
        let grids = Grids::new(frame);
        let linked = link::link(frame, &grids)?;
        let live = cull::cull(frame, &linked);
        let mut negotiated = samples::negotiate(frame, &live.passes, device)?;
        let notes = std::mem::take(&mut negotiated.notes);
        let input = adapt::Input { frame, grids: &grids, live: &live, negotiated: &negotiated, device, options };
        let mut adapted = adapt::adapt(input)?;
        let order = schedule::schedule(&grids, &adapted, options.order);
        let uses = if keeps { adapted.uses.clone() } else { Vec::new() };
        let notes_of_adapt = adapted.notes.len();
        let mut scoped = scope::scope(frame, &grids, &mut adapted, &order, device);
        let notes_of_scope = notes_of_adapt..adapted.notes.len();
        let queues = queues::assign(frame, &grids, &mut adapted, &mut scoped, device, options);
        let retained = retain::retain(frame, &grids, &adapted, &scoped);
        let mut walked = synchronise::walk(&grids, &mut adapted, &scoped, &retained, queues);
        let export = scoped.steps.len() as u32;
        let states = outlive::promise(&grids, &adapted, &mut walked, export);
        purpose::note(&grids, &mut adapted, &walked, &states, &retained, &scoped, options);
        let samples = negotiated.samples;
        Ok(Structure {
            grids,
            live,
            samples,
            notes,
            adapted,
            uses,
            notes_of_scope,
            order,
            scoped,
            retained,
            walked,
            states,
            export,
        })
    }

    /// Whether a frame that differs from the one it was found for in nothing but sizes and values has the same structure.
    /// Takes over the sizes; if it says no, nothing here is of use any more.
    ///
    /// # Errors
    /// What is wrong with the new sizes.
    pub(super) fn still_holds(
        &mut self,
        frame: &Frame,
        device: &Profile,
        options: &Options,
    ) -> Result<bool, Vec<Diagnostic>> {
        let negotiated = samples::negotiate(frame, &self.live.passes, device)?;
        if negotiated.samples != self.samples || negotiated.notes != self.notes {
            return Ok(false);
        }
        let Structure { grids, adapted, uses, scoped, .. } = self;
        adapted.stores.iter_mut().for_each(|store| store.resize(frame));
        std::mem::swap(&mut adapted.uses, uses);
        let same_order = schedule::schedule(grids, adapted, options.order) == self.order;
        let mut same_steps = true;
        if adapted.ops.iter().any(|op| op.kind.draws()) {
            let later = adapted.notes.split_off(self.notes_of_scope.end);
            adapted.notes.truncate(self.notes_of_scope.start);
            let again = scope::scope(frame, grids, adapted, &self.order, device);
            self.notes_of_scope.end = adapted.notes.len();
            adapted.notes.extend(later);
            same_steps = again.steps == scoped.steps[..self.export as usize];
            *scoped = again;
        }
        std::mem::swap(&mut adapted.uses, uses);
        Ok(same_order && same_steps)
    }

    /// Runs the stages from `place` on; barriers before first uses must be as `find` left them.
    pub(super) fn settle(
        &mut self,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Settled, Vec<Diagnostic>> {
        let Structure { grids, adapted, scoped, walked, states, export, .. } = self;
        let spans = walked.queues.as_ref().map(|queues| queues.spans(adapted, scoped, &walked.lifetimes));
        let placed = place::place(adapted, &walked.lifetimes, spans.as_deref(), device, memory, options)?;
        let hand_overs = take_over::take_over(grids, adapted, states, &placed, walked);
        let (pending, queues) = (&walked.barriers, &walked.queues);
        let batched = match queues {
            None => batch::batch(pending),
            Some(queues) => batch::batch_on(queues, pending),
        };
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
        Ok(Settled { placed, batched, memory: memory_barriers, exact_memory: memory.exact() })
    }
}
