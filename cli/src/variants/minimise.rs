//! The smallest cause of a failure: delta debugging, after Zeller and Hildebrandt, "Simplifying and Isolating
//! Failure-Inducing Input" (2002).

/// A part of `all` that still fails, and none of whose members can be left out. `fails` must hold for all of them.
pub(crate) fn minimise<T: Copy>(all: &[T], fails: &mut dyn FnMut(&[T]) -> bool) -> Vec<T> {
    if fails(&[]) {
        return Vec::new();
    }
    let mut needed = all.to_vec();
    let mut parts = 2;
    while needed.len() > 1 {
        let size = needed.len().div_ceil(parts);
        let smaller = (0..needed.len()).step_by(size).find_map(|at| {
            let rest = [&needed[..at], &needed[(at + size).min(needed.len())..]].concat();
            fails(&rest).then_some(rest)
        });
        match smaller {
            Some(rest) => {
                needed = rest;
                parts = (parts - 1).max(2);
            }
            None if size == 1 => break,
            None => parts = (parts * 2).min(needed.len()),
        }
    }
    needed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_exactly_what_it_takes() {
        let all: Vec<u32> = (0..40).collect();
        for needed in [&[][..], &[0], &[39], &[3, 17], &[0, 1, 2], &[5, 20, 21, 39]] {
            let mut runs = 0;
            let found = minimise(&all, &mut |some| {
                runs += 1;
                needed.iter().all(|one| some.contains(one))
            });
            assert_eq!(found, needed);
            assert!(runs < 150, "{runs} runs for {needed:?}");
        }
    }

    #[test]
    fn each_member_that_is_left_is_needed_even_where_several_causes_overlap() {
        let mut fails = |some: &[u32]| some.iter().filter(|one| **one % 3 == 0).count() >= 2 || some.contains(&7);
        let found = minimise(&(0..20).collect::<Vec<_>>(), &mut fails);
        assert!(fails(&found));
        for at in 0..found.len() {
            let mut without = found.clone();
            without.remove(at);
            assert!(!fails(&without), "{found:?} without {}", found[at]);
        }
    }
}
