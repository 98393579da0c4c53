//! Steps by number.

/// No step; no barrier.
pub(super) const NEVER: u32 = u32::MAX;

/// The entries of one step in a list that is sorted by step.
pub(super) fn of_step<T>(list: &[T], step: u32, at: impl Fn(&T) -> u32) -> &[T] {
    let start = list.partition_point(|it| at(it) < step);
    let rest = &list[start..];
    &rest[..rest.partition_point(|it| at(it) <= step)]
}
