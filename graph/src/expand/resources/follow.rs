//! `Like`: an image or buffer that follows another takes the other's value, or a value made from it.

/// The values that are known so far: `Some(None)` after a mistake.
pub(in crate::expand) type KnownValues<T> = Vec<Option<Option<T>>>;

/// The value of number `start`: its own, or made from the value of the one that it follows. Each value is found once.
///
/// Walks along the chain without recursion, since a chain may be as long as the file.
pub(in crate::expand) fn follow<N, T: Clone>(
    all: &[N],
    known: &mut KnownValues<T>,
    start: usize,
    next: impl Fn(&N) -> Option<usize>,
    mut value: impl FnMut(&N, Option<T>) -> Option<T>,
) -> Option<T> {
    if known[start].is_none() && next(&all[start]).is_none() {
        known[start] = Some(value(&all[start], None));
    }
    if let Some(known) = &known[start] {
        return known.clone();
    }
    let mut path = vec![start];
    while let Some(&at) = path.last() {
        let to = next(&all[at]).map(|to| (to, known[to].clone()));
        match to {
            _ if known[at].is_some() => {}
            // A circle would be longer than all together; reading a pipeline has ruled it out.
            Some((to, None)) if path.len() <= all.len() => {
                path.push(to);
                continue;
            }
            Some((_, followed)) => known[at] = Some(followed.flatten().and_then(|of| value(&all[at], Some(of)))),
            None => known[at] = Some(value(&all[at], None)),
        }
        path.pop();
    }
    known[start].clone().flatten()
}

/// The values of all items.
pub(in crate::expand) fn follow_all<N, T: Clone>(
    all: &[N],
    next: impl Fn(&N) -> Option<usize>,
    mut value: impl FnMut(&N, Option<T>) -> Option<T>,
) -> Vec<Option<T>> {
    let mut known = vec![None; all.len()];
    (0..all.len()).map(|at| follow(all, &mut known, at, &next, &mut value)).collect()
}
