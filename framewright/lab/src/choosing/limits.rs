//! The things that a user limits.

use super::candidates::Candidate;
use crate::metric::Metric;

/// A thing that is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Milliseconds on the device.
    Milliseconds,
    /// The time on the device relative to the baseline's.
    Ratio,
    /// MiB of transient memory.
    Mebibytes,
    /// MiB that loads, stores, resolves and copies move.
    MovedMebibytes,
    /// The mean flicker over frames of the moving scene.
    Flicker,
    /// An error beside the reference.
    Error(Metric),
}

/// A limit that the user states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// What is limited.
    pub quantity: Quantity,
    /// The least that a likeness may be, and the most that anything else may.
    pub value: f64,
}

impl Quantity {
    /// Whether it is a cost: all others are errors.
    pub(super) fn is_cost(self) -> bool {
        !matches!(self, Quantity::Error(_) | Quantity::Flicker)
    }
}

impl Limit {
    /// How far settings are beyond the limit, as a part of it; of a limit of 0 the distance itself. 0 or below: they hold it.
    #[must_use]
    pub fn overshoot(&self, candidate: &Candidate) -> f64 {
        let figure = candidate.of(self.quantity);
        let beyond = match self.quantity {
            Quantity::Error(metric) if metric.is_likeness() => self.value - figure,
            _ => figure - self.value,
        };
        if self.value == 0.0 { beyond } else { beyond / self.value.abs() }
    }
}
