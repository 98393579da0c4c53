//! Every order in which a frame's passes may run without changing what it means.

use framewright_graph::frame::{Frame, ImageIndex, Pass};
use std::collections::BTreeSet;

/// Images that a pass reads and that it writes.
pub(super) fn touched(pass: &Pass) -> [BTreeSet<ImageIndex>; 2] {
    let mut reads: BTreeSet<ImageIndex> = pass.sampled.iter().map(|sampled| sampled.image).collect();
    let mut writes: BTreeSet<ImageIndex> = pass.color.iter().map(|target| target.image).collect();
    for storage in &pass.storage {
        if storage.read {
            reads.insert(storage.image);
        }
        writes.insert(storage.image);
    }
    if let Some(depth) = &pass.depth {
        reads.insert(depth.image);
        if depth.write || depth.clear.is_some() {
            writes.insert(depth.image);
        }
    }
    [reads, writes]
}

/// Whether the later of two passes must stay the later one.
fn depends(earlier: &Pass, later: &Pass) -> bool {
    let [reads, writes] = touched(earlier);
    let [later_reads, later_writes] = touched(later);
    !writes.is_disjoint(&later_reads) || !writes.is_disjoint(&later_writes) || !reads.is_disjoint(&later_writes)
}

/// All valid orders; `None` if there are more than `most`.
#[must_use]
pub fn orders(frame: &Frame, most: usize) -> Option<Vec<Vec<usize>>> {
    let count = frame.passes.len();
    let before: Vec<Vec<usize>> = (0..count)
        .map(|later| (0..later).filter(|earlier| depends(&frame.passes[*earlier], &frame.passes[later])).collect())
        .collect();
    let mut all = Vec::new();
    extend(&before, &mut Vec::new(), most, &mut all).then_some(all)
}

fn extend(before: &[Vec<usize>], so_far: &mut Vec<usize>, most: usize, all: &mut Vec<Vec<usize>>) -> bool {
    if so_far.len() == before.len() {
        all.push(so_far.clone());
        return all.len() <= most;
    }
    for next in 0..before.len() {
        if !so_far.contains(&next) && before[next].iter().all(|earlier| so_far.contains(earlier)) {
            so_far.push(next);
            let fits = extend(before, so_far, most, all);
            so_far.pop();
            if !fits {
                return false;
            }
        }
    }
    true
}

/// The frame with its passes in another order.
#[must_use]
pub fn in_order(frame: &Frame, order: &[usize]) -> Frame {
    Frame { passes: order.iter().map(|pass| frame.passes[*pass].clone()).collect(), ..frame.clone() }
}
