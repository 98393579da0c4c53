//! Twins of `shaders/accumulate.frag` and `shaders/average_frames.frag`: averages over time.

use super::radiance::{guard_alpha, guard_radiance};

/// The colour that is kept: `drawn` and what was `kept` of the frames before, of which the share counts as far as its alpha
/// says that there was any.
#[must_use]
pub fn accumulated(drawn: [f64; 3], kept: [f64; 4], share: f64) -> [f64; 4] {
    let of_kept = share.clamp(0.0, 1.0) * guard_alpha(kept[3]);
    let channel = |at: usize| guard_radiance(drawn[at]) * (1.0 - of_kept) + guard_radiance(kept[at]) * of_kept;
    [channel(0), channel(1), channel(2), 1.0]
}

/// The mean of frames, and in alpha how many there were: `drawn` is added to the mean that was `kept`, unless that is one of
/// `frames` already. Twin of `shaders/average_frames.frag`.
#[must_use]
pub fn averaged(drawn: [f64; 3], kept: [f64; 4], frames: f64) -> [f64; 4] {
    let number = guard_radiance(kept[3]);
    let mean = [0, 1, 2].map(|at| guard_radiance(kept[at]));
    if number >= frames {
        return [mean[0], mean[1], mean[2], number];
    }
    let channel = |at: usize| mean[at] + (guard_radiance(drawn[at]) - mean[at]) / (number + 1.0);
    [channel(0), channel(1), channel(2), number + 1.0]
}
