//! The least height of boxes whose times are given, found by trying every placement that can matter.

/// An allocation: first and last step, bytes.
pub(super) type Piece = (usize, usize, u64);

/// The largest total that is alive at one step: no placement can need less.
pub(super) fn live_peak(pieces: &[Piece]) -> u64 {
    let steps = pieces.iter().map(|piece| piece.1 + 1).max().unwrap_or(0);
    let alive = |step| pieces.iter().filter(move |piece| piece.0 <= step && step <= piece.1).map(|piece| piece.2).sum();
    (0..steps).map(alive).max().unwrap_or(0)
}

/// The least memory in which they all fit. Every packing can be made by placing the pieces from the lowest offset to the
/// highest, each as low as it goes; so all sequences are tried, as long as they can still beat the best.
pub(super) fn least(pieces: &[Piece]) -> u64 {
    let floor = live_peak(pieces);
    let mut best = pieces.iter().map(|piece| piece.2).sum();
    place(pieces, &mut vec![None; pieces.len()], 0, floor, &mut best);
    best
}

fn place(pieces: &[Piece], offsets: &mut Vec<Option<u64>>, height: u64, floor: u64, best: &mut u64) {
    if offsets.iter().all(Option::is_some) {
        *best = height.min(*best);
        return;
    }
    for next in 0..pieces.len() {
        if offsets[next].is_some() || *best == floor {
            continue;
        }
        let offset = lowest(pieces, offsets, next);
        let top = height.max(offset + pieces[next].2);
        // From the lowest to the highest: what is placed below an earlier piece was tried before.
        let rising = offsets.iter().flatten().all(|earlier| *earlier <= offset);
        if rising && top < *best {
            offsets[next] = Some(offset);
            place(pieces, offsets, top, floor, best);
            offsets[next] = None;
        }
    }
}

/// The lowest offset at which a piece meets no other that is alive with it.
fn lowest(pieces: &[Piece], offsets: &[Option<u64>], piece: usize) -> u64 {
    let (first, last, bytes) = pieces[piece];
    let mut taken: Vec<(u64, u64)> = pieces
        .iter()
        .zip(offsets)
        .filter(|((other_first, other_last, _), _)| *other_first <= last && first <= *other_last)
        .filter_map(|((.., bytes), offset)| offset.map(|offset| (offset, offset + bytes)))
        .collect();
    taken.sort_unstable();
    taken.into_iter().fold(0, |at, (start, end)| if start < at + bytes && at < end { end } else { at })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_that_never_meet_share_a_place() {
        assert_eq!(least(&[(0, 1, 10), (2, 3, 20), (4, 4, 5)]), 20);
    }

    #[test]
    fn a_packing_above_the_live_peak_is_found_where_nothing_lower_exists() {
        // Each piece at each of all whole offsets was tried elsewhere: none of those placements ends at 4.
        let pieces =
            [(0, 0, 2), (0, 1, 2), (1, 2, 1), (1, 4, 1), (2, 2, 1), (2, 4, 1), (3, 3, 2), (4, 5, 2), (5, 5, 2)];
        assert_eq!((live_peak(&pieces), least(&pieces)), (4, 5));
    }
}
