//! The timeline: the accesses to each cell, step by step, and the barriers and waits between them.
//!
//! Consecutive reads in one layout share one barrier, widened to cover them.

use super::cell::{CellAccess, CellBarrier, CellState};
use super::crossed::{self, Crossed};
use crate::compile::model::{CellIndex, StoreIndex};
use crate::compile::queues::Queues;
use crate::plan::Hazard;
use crate::vulkan::{Accesses, Layout, Stages, State};
use std::ops::Range;

/// All accesses of a frame.
#[derive(Debug)]
pub(in crate::compile) struct Timeline {
    pub(super) cells: Vec<CellState>,
    /// In the order of steps. Initial barriers don't have their first scope yet.
    pub(in crate::compile) barriers: Vec<CellBarrier>,
    /// For each physical resource the first and the last step that use it.
    pub(in crate::compile) lifetimes: Vec<[u32; 2]>,
    pub(in crate::compile) queues: Queues,
    /// For each physical resource its states around the frame; `None` if it lives within the frame.
    pub(in crate::compile) states: Vec<Option<States>>,
    /// Uses, by index, that are in another layout than they ask for, because their step uses the same cell in other ways.
    pub(in crate::compile) layouts: Vec<(u32, Layout)>,
}

/// States of what outlives the frame.
#[derive(Debug, Clone, Copy)]
pub(in crate::compile) struct States {
    pub(in crate::compile) before: State,
    pub(in crate::compile) after: State,
}

impl Timeline {
    /// Usage bits of a physical resource that has these cells.
    pub(in crate::compile) fn usage(&self, cells: Range<u32>) -> u32 {
        self.cells[cells.start as usize..cells.end as usize].iter().fold(0, |usage, cell| usage | cell.usage)
    }

    /// Drops what only other timelines and barriers are made from.
    pub(in crate::compile) fn forget_cells(&mut self) {
        (self.cells, self.lifetimes) = (Vec::new(), Vec::new());
    }

    /// Adds the accesses of a step. `lasts`: it is one of the frame's own steps, not the one behind all of them.
    pub(super) fn add(&mut self, accesses: &[CellAccess], step: u32, lasts: bool) {
        if self.queues.is_one() {
            accesses.iter().for_each(|access| self.access(access, None, step, lasts));
            return;
        }
        crossed::wait(&self.cells, &mut self.queues, accesses, step);
        for access in accesses {
            let crossed = Crossed::of(&self.queues, access, step);
            self.access(access, crossed, step, lasts);
        }
    }

    /// Leaves a cell in a state, in the step behind all others.
    pub(super) fn leave(&mut self, store: StoreIndex, cell: CellIndex, step: u32, state: State) {
        let State { stages, accesses, layout } = state;
        let access = CellAccess { cell, store, stages, accesses, layout, keeps: true, usage: 0 };
        let first = self.barriers.len();
        self.add(&[access], step, false);
        self.barriers[first..].iter_mut().for_each(|barrier| barrier.hazard = Hazard::Export);
    }

    /// Widens the barrier before the last reads of a cell.
    pub(super) fn read_also(&mut self, cell: CellIndex, stages: Stages, accesses: Accesses) {
        let known = &mut self.cells[cell as usize];
        known.stages |= stages;
        known.accesses |= accesses;
        if let Some(barrier) = self.barriers.get_mut(known.barrier as usize) {
            barrier.widen(stages, accesses);
        }
    }

    /// Puts a barrier before an access, or widens the one before earlier reads. A final state (not `lasts`) waits for the
    /// stages that it names, and for no others.
    #[inline(always)]
    fn access(&mut self, access: &CellAccess, crossed: Option<Crossed>, step: u32, lasts: bool) {
        let Timeline { cells, barriers, lifetimes, queues, .. } = self;
        let cell = &mut cells[access.cell as usize];
        cell.usage |= access.usage;
        if lasts {
            let lifetime = &mut lifetimes[access.store as usize];
            *lifetime = [lifetime[0].min(step), step];
        }
        let joins = match crossed {
            None => cell.is_read_on(access) && !cell.writes() && (lasts || access.stages.contains(cell.stages)),
            Some(crossed) => crossed.joins(queues.uses(access.cell), cell, access),
        };
        if joins {
            cell.stages |= access.stages;
            cell.accesses |= access.accesses;
            (cell.layout, cell.last) = (access.layout, step);
            return match crossed {
                None => barriers[cell.barrier as usize].widen(access.stages, access.accesses),
                Some(crossed) => crossed.join(queues, barriers, access, step, lasts),
            };
        }
        let source = match crossed {
            None => Some((cell.stages, cell.accesses.writes())),
            Some(crossed) => crossed.source(queues, cell, access, step),
        };
        let number = barriers.len() as u32;
        if let Some(source) = source {
            let transfers = crossed.is_some_and(|it| it.transfers(queues.uses(access.cell), cell, access));
            let hazard = if transfers { Hazard::Ownership } else { cell.hazard(access) };
            let old_layout = if access.keeps { cell.layout } else { Layout::Undefined };
            barriers.push(CellBarrier::before(access, step, (source, cell.last), old_layout, hazard));
            if !cell.is_touched() {
                cell.first_barrier = number;
            } else if cell.barrier == cell.first_barrier {
                cell.second_barrier = number;
            }
            cell.barrier = number;
        }
        if let Some(crossed) = crossed {
            crossed.renew(queues, cell, access, (step, lasts), source.map(|_| number));
        }
        (cell.stages, cell.accesses) = (access.stages, access.accesses);
        (cell.layout, cell.last) = (access.layout, step);
    }
}
