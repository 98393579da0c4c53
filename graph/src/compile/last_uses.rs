//! How something was last used, over all its parts: what is the same of many parts is said once, so that an image of many
//! parts can take over the memory of another without looking at each pair of them.

use crate::vulkan::{Accesses, Stages};

/// The last uses of some parts that have stages and writes in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct LastUse {
    pub(super) stages: Stages,
    pub(super) writes: Accesses,
    /// The latest step.
    pub(super) last: u32,
}

/// The last uses of all parts: most often they are all alike.
#[derive(Debug, Clone, Default)]
pub(super) struct LastUses {
    first: Option<LastUse>,
    others: Vec<LastUse>,
}

impl LastUses {
    /// Adds how a part was used last, in `step`.
    pub(super) fn add(&mut self, stages: Stages, accesses: Accesses, step: u32) {
        let writes = accesses.writes();
        match self.first.iter_mut().chain(&mut self.others).find(|it| it.stages == stages && it.writes == writes) {
            Some(same) => same.last = same.last.max(step),
            None => {
                let new = LastUse { stages, writes, last: step };
                match self.first {
                    None => self.first = Some(new),
                    Some(_) => self.others.push(new),
                }
            }
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &LastUse> {
        self.first.iter().chain(&self.others)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uses_alike_are_one_with_the_latest_step() {
        let mut uses = LastUses::default();
        for step in [3, 7, 5] {
            uses.add(Stages::CLEAR, Accesses::TRANSFER_WRITE, step);
        }
        uses.add(Stages::COPY, Accesses::TRANSFER_READ, 9);
        let [cleared, read] = uses.iter().collect::<Vec<_>>()[..] else { panic!("two kinds of uses") };
        assert_eq!((cleared.writes, cleared.last), (Accesses::TRANSFER_WRITE, 7));
        assert_eq!((read.writes, read.last), (Accesses::empty(), 9));
    }
}
