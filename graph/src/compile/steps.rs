//! Steps by number.

/// No step; no barrier.
pub(super) const NEVER: u32 = u32::MAX;

/// Works on each of `count` steps or passes, in order, and gathers what is done in `done`. If the work looks at things that lie
/// `apart` in memory, `read` reads them before.
///
/// Where they are read for several steps one after the other, the processor waits for all of them at once. The work on one step
/// is too long for that.
pub(super) fn in_order<T>(
    done: &mut T,
    count: u32,
    apart: bool,
    read: impl Fn(&T, u32),
    mut work: impl FnMut(&mut T, u32),
) {
    /// How many steps are read before they are worked on.
    const AHEAD: usize = 16;
    /// What so few steps look at lies close together.
    const FEW: u32 = 2_000;
    let reads = apart && count > FEW;
    for first in (0..count).step_by(AHEAD) {
        let steps = first..count.min(first + AHEAD as u32);
        if reads {
            steps.clone().for_each(|step| read(done, step));
        }
        steps.for_each(|step| work(done, step));
    }
}

/// The entries of one step in a list that is sorted by step.
pub(super) fn of_step<T>(list: &[T], step: u32, at: impl Fn(&T) -> u32) -> &[T] {
    let start = list.partition_point(|it| at(it) < step);
    let rest = &list[start..];
    &rest[..rest.partition_point(|it| at(it) <= step)]
}

#[cfg(test)]
mod tests {
    use super::in_order;
    use std::cell::Cell;

    #[test]
    fn each_step_is_worked_on_in_order_and_where_many_lie_apart_read_before() {
        for (count, apart, reads) in [
            (0, true, 0),
            (1, true, 0),
            (16, true, 0),
            (2_000, true, 0),
            (2_001, true, 2_001),
            (2_016, true, 2_016),
            (2_016, false, 0),
        ] {
            let (read, mut done) = (Cell::new(0), Vec::new());
            let work = |done: &mut Vec<u32>, step| {
                assert!(reads == 0 || read.get() > step, "step {step} of {count}");
                done.push(step);
            };
            in_order(&mut done, count, apart, |_, _| read.set(read.get() + 1), work);
            assert_eq!((done, read.get()), ((0..count).collect(), reads));
        }
    }
}
