//! Why each pass that isn't drawn runs on its queue, in words and figures.

use super::cost::Balance;
use super::eligible_queues::GraphicsOnly;
use crate::base::amount::bytes;
use crate::compile::model::{AdaptedFrame, OpKind};
use crate::compile::scope::{Step, op_name, resource_name};
use crate::frame::Frame;
use crate::plan::{Note, NoteKind, Queue};

/// Why a step runs on its queue.
#[derive(Debug, Clone, Copy)]
pub(super) enum QueueReason {
    /// No other queue can run it.
    GraphicsOnly(GraphicsOnly),
    /// What it would save, and what its waits would cost.
    Balance(Balance),
    /// Another queue uses the same imported image or buffer.
    Split,
    /// That was not found out.
    Undecided,
}

impl QueueReason {
    const fn kind(self) -> NoteKind {
        match self {
            QueueReason::GraphicsOnly(_) => NoteKind::GraphicsOnly,
            QueueReason::Balance(_) => NoteKind::QueueWeighed,
            QueueReason::Split => NoteKind::SharedWithQueue,
            QueueReason::Undecided => NoteKind::QueueUndecided,
        }
    }
}

/// The notes of all passes that are steps of their own.
pub(super) fn notes(
    frame: &Frame,
    adapted: &AdaptedFrame,
    steps: &[Step],
    queues: &[Queue],
    why: &[Option<QueueReason>],
) -> Vec<Note> {
    let mut notes = Vec::new();
    for ((step, queue), why) in steps.iter().zip(queues).zip(why) {
        let Step::Single(op) = step else { continue };
        let OpKind::Pass(pass) = adapted.ops[*op as usize].kind else { continue };
        let name = |step: u32| first_name(frame, adapted, &steps[step as usize]);
        let Some(why) = why else { continue };
        let Some(text) = words(*queue, *why, name) else { continue };
        let declared = &frame.passes[pass as usize];
        let (subject, at) = (declared.name.clone(), frame.sources.place(declared.span));
        notes.push(Note::new(why.kind(), subject, text, at));
    }
    notes
}

fn words<'f>(queue: Queue, why: QueueReason, name: impl Fn(u32) -> Option<&'f str>) -> Option<String> {
    let stays = |why: &str| Some(format!("stays on the graphics queue: {why}"));
    let balance = match why {
        QueueReason::GraphicsOnly(why) => return why.why().and_then(stays),
        QueueReason::Split => return stays("it uses something that is handed in and that another queue uses, too"),
        QueueReason::Undecided => {
            return stays(
                "what can run beside what was not found out in as many rounds as are tried, so nothing leaves it",
            );
        }
        QueueReason::Balance(balance) => balance,
    };
    let Balance { steps, waits, cost, saved, alone } = balance;
    let most = if balance.is_hopeless() { alone } else { saved };
    let Some((first, more)) = most.beside else {
        return stays("nothing that neither waits for it nor is waited for runs beside it");
    };
    let name = name(first).map_or_else(String::new, |name| format!("`{name}`"));
    let beside = if more == 0 { name } else { format!("{name} and {more} more") };
    let (saved, cost) = (bytes(most.bytes), bytes(cost));
    let others = match steps - 1 {
        0 => "",
        1 => " and the other step that needs the same waits",
        others => &format!(" and the {others} other steps that need the same waits"),
    };
    let waits = match waits {
        0 => "it takes no more waits".to_owned(),
        1 => format!("1 wait costs as much as {cost}"),
        waits => format!("{waits} waits cost as much as {cost}"),
    };
    match queue {
        Queue::Graphics => {
            stays(&format!("moving it{others} would save at most {saved} of work beside {beside}, and {waits}"))
        }
        Queue::Compute | Queue::Transfer => {
            let queue = if queue == Queue::Compute { "compute" } else { "transfer" };
            let others = if others.is_empty() { String::new() } else { format!(" for it{others}") };
            Some(format!(
                "runs on the {queue} queue, beside {beside}: that saves up to {saved} of work{others}, and {waits}"
            ))
        }
    }
}

/// The name of a step in notes.
fn first_name<'f>(frame: &'f Frame, adapted: &'f AdaptedFrame, step: &Step) -> Option<&'f str> {
    let named = step.ops().iter().find_map(|op| op_name(frame, adapted, *op));
    let transferred = || {
        let used = adapted.uses(*step.ops().first()?).first()?;
        Some(resource_name(frame, adapted, used.resource))
    };
    named.or_else(transferred).map(|name| &**name)
}
