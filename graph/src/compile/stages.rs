//! Runs the stages, one after the other.

use super::cull::{self, LivePasses};
use super::memory::{self, AliasEdge, PlacedResources};
use super::model::AdaptedFrame;
use super::options::{Options, Order};
use super::queues::{self, QueueAssignment};
use super::retain::{self, LoadStoreOps};
use super::scope::{self, ScopedSteps};
use super::sync::{self, AccessTimeline, Barriers, States};
use super::{adapt, fit, schedule, usage};
use crate::base::Diagnostic;
use crate::device::{MemoryProvider, Profile};
use crate::frame::Frame;
use crate::plan::Note;

/// All that was decided about a frame: the Plan is made of it.
#[derive(Debug)]
pub(super) struct Decisions {
    pub(super) live: LivePasses,
    /// Notes of the stages from `fit` on, in their order.
    pub(super) notes: Vec<Note>,
    pub(super) adapted: AdaptedFrame,
    pub(super) scoped: ScopedSteps,
    pub(super) load_store: LoadStoreOps,
    /// For each physical resource its states around the frame; `None` if it lives within the frame.
    pub(super) states: Vec<Option<States>>,
    pub(super) placed: PlacedResources,
    pub(super) barriers: Barriers,
    pub(super) exact_memory: bool,
}

/// Runs all stages but `emit`. Where the device can't use formats as the frame does, it runs them for a frame with others, which
/// is returned too.
pub(super) fn decide(
    frame: &Frame,
    device: &Profile,
    memory: &mut dyn MemoryProvider,
    options: &Options,
) -> Result<(Decisions, Option<Frame>), Vec<Diagnostic>> {
    let (grids, live) = cull::live(frame)?;
    let formats = fit::formats(frame, &live.passes, device);
    let frame = formats.frame(frame);
    let of_needs = fit::check_needs(frame, &live.passes, device)?;
    let negotiated = fit::negotiate(frame, &live.passes, &formats)?;
    let input = adapt::Input { frame, grids: &grids, live: &live, negotiated: &negotiated, device, options };
    let (adapted, of_adapt) = adapt::adapt(input)?;
    let order = schedule::schedule(&adapted, options.order);
    let (scoped, adapted, of_scope) = scope::scope(frame, adapted, &order, device);
    let QueueAssignment { scoped, queues, notes: of_queues, sharing } =
        queues::assign(frame, &adapted, scoped, device, options);
    let load_store = retain::retain(frame, &adapted, &scoped);
    let mut timeline = sync::timeline(&adapted, &scoped, &load_store, queues);
    let adapted = usage::finish(adapted, &sharing, &timeline, &load_store, &scoped, options);
    fit::check_support(frame, &adapted, &scoped, &formats.supports)?;
    let (placed, edges) = place(&adapted, &scoped, &timeline, device, memory, options)?;
    let (barriers, steps) = (std::mem::take(&mut timeline.barriers), scoped.steps.len() as u32);
    let barriers = sync::barriers(&adapted, &timeline, barriers, &edges, steps, options.poison);
    let notes = [formats.notes, of_needs, negotiated.notes, of_adapt, of_scope, of_queues];
    let decisions = Decisions {
        live,
        notes: notes.into_iter().flatten().collect(),
        adapted,
        scoped,
        load_store,
        states: timeline.states,
        placed,
        barriers,
        exact_memory: memory.exact(),
    };
    Ok((decisions, formats.substitute))
}

/// Places transient images and buffers in memory. Returns who takes over whose memory, too.
fn place(
    adapted: &AdaptedFrame,
    scoped: &ScopedSteps,
    timeline: &AccessTimeline,
    device: &Profile,
    memory: &mut dyn MemoryProvider,
    options: &Options,
) -> Result<(PlacedResources, Vec<AliasEdge>), Vec<Diagnostic>> {
    let lifetimes = &timeline.lifetimes[..];
    let by_first_step = memory::by_first_step(adapted, lifetimes);
    let spans = timeline.queues.memory_spans(adapted, scoped, lifetimes);
    let by_first_span = spans.as_ref().map(|spans| memory::by_first_step(adapted, spans));
    let saves_calls = options.order != Order::LowMemory && timeline.queues.is_one();
    let waits = saves_calls.then(|| sync::waits(&timeline.barriers, scoped.steps.len()));
    let order = by_first_span.as_ref().unwrap_or(&by_first_step);
    let times = memory::Times { lifetimes, spans: spans.as_deref(), order, waits: waits.as_deref() };
    let placed = memory::place(adapted, times, device, memory, options)?;
    let edges = memory::alias_edges(&placed, &by_first_step);
    Ok((placed, edges))
}
