//! The dependencies between runs, as lists.

use super::accesses::Access;
use super::runs::Runs;
use crate::compile::access_chain::AccessChain;
use crate::vulkan::Layout;

/// For each run those that depend on it at once. Some may be named twice.
#[derive(Debug)]
pub(super) struct Dependencies {
    /// Pairs of a run and one that depends on it.
    pairs: Vec<(u32, u32)>,
    starts: Vec<u32>,
    followers: Vec<u32>,
}

impl Dependencies {
    /// The dependencies between `runs`. Reads in different layouts don't depend on each other here: they may run in any order, and the
    /// layout is changed in that order.
    pub(super) fn between(runs: &Runs) -> Dependencies {
        let layout = Layout::Undefined;
        let mut chains: Vec<AccessChain<Option<u32>>> = vec![AccessChain::new(); runs.subresources()];
        // The writers, and the readers in lists: each with the place of the next one.
        let mut listed: Vec<(u32, Option<u32>)> = Vec::new();
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for run in 0..runs.len() {
            for Access { subresource, writes, .. } in runs.accesses(run) {
                let chain = &mut chains[*subresource as usize];
                for mut place in chain.behind(*writes, layout) {
                    while let Some((before, next)) = place.and_then(|place| listed.get(place as usize)) {
                        pairs.push((*before, run));
                        place = *next;
                    }
                }
                chain.add(*writes, layout, |readers| {
                    listed.push((run, readers));
                    Some(listed.len() as u32 - 1)
                });
            }
        }
        pairs.retain(|(before, after)| before != after);
        Dependencies::list(pairs, runs.len())
    }

    fn list(pairs: Vec<(u32, u32)>, runs: u32) -> Dependencies {
        let (starts, followers) = super::memory::lists(&pairs, runs);
        Dependencies { pairs, starts, followers }
    }

    /// The same from the last to the first.
    pub(super) fn reversed(&self) -> Dependencies {
        Dependencies::list(self.pairs.iter().map(|(before, after)| (*after, *before)).collect(), self.len())
    }

    pub(super) fn len(&self) -> u32 {
        self.starts.len() as u32 - 1
    }

    /// The runs that depend on a run.
    pub(super) fn followers(&self, run: u32) -> &[u32] {
        &self.followers[self.starts[run as usize] as usize..self.starts[run as usize + 1] as usize]
    }

    /// For each run how often it is a follower.
    pub(super) fn counts(&self) -> Vec<u32> {
        let mut counts = vec![0; self.len() as usize];
        self.followers.iter().for_each(|run| counts[*run as usize] += 1);
        counts
    }

    /// Any valid order, the same for the same seed.
    pub(super) fn random_order(&self, seed: u64) -> Vec<u32> {
        let mut waits_for = self.counts();
        let mut ready: Vec<u32> = (0..self.len()).filter(|run| waits_for[*run as usize] == 0).collect();
        let mut order = Vec::with_capacity(waits_for.len());
        let mut state = seed;
        while !ready.is_empty() {
            // SplitMix64.
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mixed = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            let run = ready.swap_remove(((mixed ^ (mixed >> 31)) % ready.len() as u64) as usize);
            order.push(run);
            for follower in self.followers(run) {
                waits_for[*follower as usize] -= 1;
                if waits_for[*follower as usize] == 0 {
                    ready.push(*follower);
                }
            }
        }
        order
    }
}
