//! `synchronise`, first part: what each step does to each cell, in order, and the barriers between.
//!
//! Reads in one layout follow each other without a barrier: the one before the first of them is made to name them all.
//! What a cell's first use of the frame waits for is found later, when memory has its place (`take_over`).

use super::model::{Adapted, CellIndex, Role, StoreIndex, Use};
use super::parts::Grids;
use super::queues::{Change, Queues};
use super::retain::{AttachmentOps, Retained};
use super::scope::{Scoped, Step, Target};
use crate::plan::Hazard;
use crate::vulkan::{Accesses, BufferUsage, Layout, LoadOp, Stages, State};

mod cross;

/// No step, no barrier.
pub(super) const NEVER: u32 = u32::MAX;

/// What is known of a cell: its accesses since the last barrier, which is one write, or reads in one layout.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell {
    pub(super) stages: Stages,
    pub(super) accesses: Accesses,
    /// Usage bits of all steps, of an image or a buffer.
    usage: u32,
    /// The barriers before the first use, after the uses that that one serves, and before the last use.
    pub(super) first_barrier: u32,
    pub(super) second_barrier: u32,
    barrier: u32,
    /// The last step that uses it.
    pub(super) last: u32,
    /// Which of the needs of the last step that uses it it is.
    need: u32,
    pub(super) layout: Layout,
}

impl Cell {
    const UNTOUCHED: Cell = Cell {
        stages: Stages::empty(),
        accesses: Accesses::empty(),
        usage: 0,
        first_barrier: NEVER,
        second_barrier: NEVER,
        barrier: NEVER,
        last: NEVER,
        need: NEVER,
        layout: Layout::Undefined,
    };

    pub(super) fn is_touched(&self) -> bool {
        self.last != NEVER
    }

    pub(super) fn writes(&self) -> bool {
        !self.accesses.writes().is_empty()
    }
}

/// A barrier of one cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pending {
    pub(super) cell: CellIndex,
    pub(super) store: StoreIndex,
    /// The step that it must stand before; `NEVER`: it is not needed after all.
    pub(super) step: u32,
    /// The step that it must stand behind, `NEVER` if none of this frame.
    pub(super) after: u32,
    pub(super) src_stages: Stages,
    pub(super) src_accesses: Accesses,
    pub(super) dst_stages: Stages,
    pub(super) dst_accesses: Accesses,
    pub(super) old_layout: Layout,
    pub(super) new_layout: Layout,
    pub(super) hazard: Hazard,
    /// Whether it keeps what was there before the frame.
    pub(super) keeps: bool,
}

/// The state after the walk.
#[derive(Debug)]
pub(super) struct Walked {
    pub(super) cells: Vec<Cell>,
    /// In the order of steps.
    pub(super) barriers: Vec<Pending>,
    /// For each store the first and the last step that use it.
    pub(super) lifetimes: Vec<[u32; 2]>,
    /// The queues, if there are several.
    pub(super) queues: Option<Box<Queues>>,
}

impl Walked {
    /// Usage bits of a store.
    pub(super) fn usage(&self, cells: std::ops::Range<u32>) -> u32 {
        self.cells[cells.start as usize..cells.end as usize].iter().fold(0, |usage, cell| usage | cell.usage)
    }
}

/// What one step does with one cell.
#[derive(Debug, Clone, Copy)]
struct Need {
    cell: CellIndex,
    store: StoreIndex,
    stages: Stages,
    accesses: Accesses,
    layout: Layout,
    /// Whether it needs what was there before.
    keeps: bool,
    usage: u32,
}

impl Need {
    /// A change of layout alone.
    fn of_change(change: &Change) -> Need {
        let Change { cell, store, layout } = *change;
        let (stages, accesses) = (Stages::empty(), Accesses::empty());
        Need { cell, store, stages, accesses, layout, keeps: true, usage: 0 }
    }
}

impl Walked {
    /// Lets the last barrier before a cell's reads serve more of them.
    pub(super) fn read_also(&mut self, cell: CellIndex, stages: Stages, accesses: Accesses) {
        let known = &mut self.cells[cell as usize];
        known.stages |= stages;
        known.accesses |= accesses;
        if let Some(barrier) = self.barriers.get_mut(known.barrier as usize) {
            barrier.dst_stages |= stages;
            barrier.dst_accesses |= accesses;
        }
    }

    /// What is promised to whoever comes after the frame, and waits for the stages of `state` alone.
    pub(super) fn promise(&mut self, store: StoreIndex, cell: CellIndex, step: u32, state: State) {
        let need = Need {
            cell,
            store,
            stages: state.stages,
            accesses: state.accesses,
            layout: state.layout,
            keeps: true,
            usage: 0,
        };
        let first = self.barriers.len();
        match self.queues {
            None => apply(self, &need, step, false),
            Some(_) => cross::step(self, &[need], step, false),
        }
        self.barriers[first..].iter_mut().for_each(|barrier| barrier.hazard = Hazard::Export);
    }
}

pub(super) fn walk(
    grids: &Grids,
    adapted: &mut Adapted,
    scoped: &Scoped,
    retained: &Retained,
    queues: Option<Box<Queues>>,
) -> Walked {
    let mut walk = Walk {
        grids,
        walked: Walked {
            cells: vec![Cell::UNTOUCHED; adapted.cells as usize],
            barriers: Vec::with_capacity(adapted.uses.len() + adapted.uses.len() / 4),
            lifetimes: vec![[NEVER, 0]; adapted.stores.len()],
            queues,
        },
        needs: Vec::new(),
        mixed: false,
    };
    for (step, number) in scoped.steps.iter().zip(0_u32..) {
        walk.step(adapted, step, number, retained);
    }
    walk.walked
}

struct Walk<'g> {
    grids: &'g Grids,
    walked: Walked,
    /// Needs of the step at hand.
    needs: Vec<Need>,
    /// Whether the step at hand uses a cell in several layouts.
    mixed: bool,
}

impl Walk<'_> {
    fn step(&mut self, adapted: &mut Adapted, step: &Step, number: u32, retained: &Retained) {
        self.needs.clear();
        self.mixed = false;
        for op in step.ops() {
            for used in adapted.uses(*op) {
                match used.role {
                    Role::Input => self.read_locally(adapted, used, retained.of(number)),
                    _ => self.used(adapted, used),
                }
            }
        }
        if let Step::Scope(scope) = step {
            for attachment in retained.of(number) {
                let (stages, accesses) = attachment.load_access();
                self.also(adapted, attachment.target, stages, accesses);
                if let Some((stages, accesses)) = attachment.store_access() {
                    self.also(adapted, attachment.target, stages, accesses);
                }
            }
            for op in scope.carries() {
                let [source, target] = adapted.uses(op) else { continue };
                for (used, accesses) in
                    [(source, Accesses::COLOR_ATTACHMENT_READ), (target, Accesses::COLOR_ATTACHMENT_WRITE)]
                {
                    self.resolved(adapted, used, accesses);
                }
            }
        }
        if let Some(queues) = &self.walked.queues {
            self.needs.extend(queues.changes(number).iter().map(|(_, change)| Need::of_change(change)));
            cross::step(&mut self.walked, &self.needs, number, true);
        } else {
            for need in &self.needs {
                apply(&mut self.walked, need, number, true);
            }
        }
        if self.mixed {
            self.settle_layouts(adapted, step);
        }
    }

    fn used(&mut self, adapted: &Adapted, used: &Use) {
        let usage = usage_bits(used);
        let need = |cell| Need {
            cell,
            store: used.store,
            stages: used.stages,
            accesses: used.accesses,
            layout: used.layout,
            keeps: used.reads,
            usage,
        };
        let grids = self.grids;
        adapted.for_each_cell(grids, used, |cell| self.need(need(cell)));
    }

    /// A local read waits only for what its scope loads: the rest its scope draws, and shows it to the read itself.
    fn read_locally(&mut self, adapted: &Adapted, used: &Use, attachments: &[AttachmentOps]) {
        let target = Target::of(adapted, used);
        let loads = attachments.iter().any(|ops| ops.target == target && ops.load == LoadOp::Load);
        let (stages, accesses) = if loads { (used.stages, used.accesses) } else { Default::default() };
        self.used(adapted, &Use { stages, accesses, ..*used });
    }

    /// A resolve that a scope carries, source or target.
    fn resolved(&mut self, adapted: &Adapted, used: &Use, accesses: Accesses) {
        let Some(image) = adapted.stores[used.store as usize].image() else { return };
        let (layout, role) = match image.format.is_depth() {
            true => (Layout::DepthStencilAttachmentOptimal, Role::Depth),
            false => (Layout::ColorAttachmentOptimal, Role::Color),
        };
        let carried = Use { stages: Stages::COLOR_ATTACHMENT_OUTPUT, accesses, layout, role, ..*used };
        self.used(adapted, &carried);
    }

    /// Accesses to an attachment beside those of the passes, which are noted already.
    fn also(&mut self, adapted: &Adapted, target: Target, stages: Stages, accesses: Accesses) {
        let store = &adapted.stores[target.store as usize];
        let Walk { walked, needs, .. } = self;
        let mut add = |cell: CellIndex| {
            let known = &walked.cells[cell as usize];
            if let Some(need) = needs.get_mut(known.need as usize).filter(|need| need.cell == cell) {
                need.stages |= stages;
                need.accesses |= accesses;
            }
        };
        match store.grid(self.grids) {
            None => add(store.first_cell),
            Some(grid) => grid.cover(target.range).for_each(|part| add(store.first_cell + part)),
        }
    }

    /// Joins what one step needs of one cell in several ways. The first use says what is kept.
    fn need(&mut self, new: Need) {
        let known = &mut self.walked.cells[new.cell as usize];
        // An index of an earlier step finds no need, or that of another cell.
        let Some(need) = self.needs.get_mut(known.need as usize).filter(|need| need.cell == new.cell) else {
            known.need = self.needs.len() as u32;
            return self.needs.push(new);
        };
        need.stages |= new.stages;
        need.accesses |= new.accesses;
        need.usage |= new.usage;
        if need.layout != new.layout {
            self.mixed = true;
            need.layout = join_layouts(need.layout, new.layout);
        }
    }

    /// Lets all uses of a step name the layout that was found for all of them together.
    fn settle_layouts(&self, adapted: &mut Adapted, step: &Step) {
        for op in step.ops() {
            let range = adapted.ops[*op as usize].uses.clone();
            for at in range {
                let used = adapted.uses[at as usize];
                let mut layout = used.layout;
                adapted.for_each_cell(self.grids, &used, |cell| layout = self.walked.cells[cell as usize].layout);
                adapted.uses[at as usize].layout = layout;
            }
        }
    }
}

/// Puts a barrier before a need, or lets the one before earlier reads serve it too. What comes after the frame (not
/// `lasts`) waits for nobody but whom it names.
fn apply(walked: &mut Walked, need: &Need, step: u32, lasts: bool) {
    let Walked { cells, barriers, lifetimes, .. } = walked;
    let cell = &mut cells[need.cell as usize];
    let writes = !need.accesses.writes().is_empty();
    cell.usage |= need.usage;
    if lasts {
        let lifetime = &mut lifetimes[need.store as usize];
        *lifetime = [lifetime[0].min(step), step];
    }
    if cell.is_touched()
        && !writes
        && !cell.writes()
        && cell.layout == need.layout
        && (lasts || need.stages.contains(cell.stages))
    {
        cell.stages |= need.stages;
        cell.accesses |= need.accesses;
        cell.last = step;
        let before = &mut barriers[cell.barrier as usize];
        before.dst_stages |= need.stages;
        before.dst_accesses |= need.accesses;
        return;
    }
    let barrier = barriers.len() as u32;
    let mut pending = Pending {
        cell: need.cell,
        store: need.store,
        step,
        after: cell.last,
        src_stages: cell.stages,
        src_accesses: cell.accesses.writes(),
        dst_stages: need.stages,
        dst_accesses: need.accesses,
        old_layout: if need.keeps { cell.layout } else { Layout::Undefined },
        new_layout: need.layout,
        hazard: Hazard::FirstUse,
        keeps: need.keeps,
    };
    if !cell.is_touched() {
        cell.first_barrier = barrier;
    } else {
        if cell.barrier == cell.first_barrier {
            cell.second_barrier = barrier;
        }
        pending.hazard = match (cell.writes(), writes) {
            (true, false) => Hazard::ReadAfterWrite,
            (true, true) => Hazard::WriteAfterWrite,
            (false, true) => Hazard::WriteAfterRead,
            (false, false) => Hazard::LayoutChange,
        };
    }
    (cell.stages, cell.accesses, cell.layout) = (need.stages, need.accesses, need.layout);
    (cell.last, cell.barrier) = (step, barrier);
    barriers.push(pending);
}

/// The layout in which one step can use a cell in two ways.
fn join_layouts(a: Layout, b: Layout) -> Layout {
    let attached = |read_only, attachment| (a, b) == (read_only, attachment) || (a, b) == (attachment, read_only);
    let planes = [
        (Layout::DepthStencilReadOnlyOptimal, Layout::DepthStencilAttachmentOptimal),
        (Layout::DepthReadOnlyOptimal, Layout::DepthAttachmentOptimal),
        (Layout::StencilReadOnlyOptimal, Layout::StencilAttachmentOptimal),
    ];
    if attached(Layout::RenderingLocalReadKhr, Layout::ColorAttachmentOptimal) {
        return Layout::RenderingLocalReadKhr;
    }
    planes.into_iter().find(|(read, write)| attached(*read, *write)).map_or(Layout::General, |(_, write)| write)
}

/// The usage that a use takes, as the bits of `VkImageUsageFlags` or `VkBufferUsageFlags`.
fn usage_bits(used: &Use) -> u32 {
    if used.role != Role::Buffer {
        return used.role.usage().bits();
    }
    let usage = |access, usage| if used.accesses.intersects(access) { usage } else { BufferUsage::empty() };
    let storage = Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE;
    let all = usage(Accesses::UNIFORM_READ, BufferUsage::UNIFORM_BUFFER)
        | usage(storage, BufferUsage::STORAGE_BUFFER)
        | usage(Accesses::VERTEX_ATTRIBUTE_READ, BufferUsage::VERTEX_BUFFER)
        | usage(Accesses::INDEX_READ, BufferUsage::INDEX_BUFFER)
        | usage(Accesses::INDIRECT_COMMAND_READ, BufferUsage::INDIRECT_BUFFER);
    all.bits()
}
