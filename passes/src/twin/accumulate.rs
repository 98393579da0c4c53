//! Twin of `shaders/accumulate.frag`.

use super::radiance::{guard_alpha, guard_radiance};

/// The colour that is kept: `drawn` and what was `kept` of the frames before, of which the share counts as far as its alpha
/// says that there was any.
#[must_use]
pub fn accumulated(drawn: [f64; 3], kept: [f64; 4], share: f64) -> [f64; 4] {
    let of_kept = share.clamp(0.0, 1.0) * guard_alpha(kept[3]);
    let channel = |at: usize| guard_radiance(drawn[at]) * (1.0 - of_kept) + guard_radiance(kept[at]) * of_kept;
    [channel(0), channel(1), channel(2), 1.0]
}
