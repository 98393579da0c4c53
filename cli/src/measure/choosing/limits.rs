//! The things that a user limits.

use super::candidates::Candidate;
use crate::metric::Metric;

/// A thing that is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
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
pub(crate) struct Limit {
    pub(crate) quantity: Quantity,
    pub(crate) value: f64,
}

impl Quantity {
    /// The option that limits it.
    #[must_use]
    pub(crate) fn option(self) -> &'static str {
        match self {
            Quantity::Milliseconds => "--max-ms",
            Quantity::Ratio => "--max-ratio",
            Quantity::Mebibytes => "--max-mib",
            Quantity::MovedMebibytes => "--max-moved-mib",
            Quantity::Flicker => "--max-flicker",
            Quantity::Error(Metric::Flip) => "--max-flip",
            Quantity::Error(Metric::Rmse) => "--max-rmse",
            Quantity::Error(Metric::MaxError) => "--max-error",
            Quantity::Error(Metric::RelativeMse) => "--max-relative-mse",
            Quantity::Error(Metric::Psnr) => "--min-psnr",
            Quantity::Error(Metric::Ssim) => "--min-ssim",
        }
    }

    /// Whether it is a cost: all others are errors.
    pub(super) fn is_cost(self) -> bool {
        !matches!(self, Quantity::Error(_) | Quantity::Flicker)
    }
}

impl Limit {
    /// How far settings are beyond the limit, as a part of it; of a limit of 0 the distance itself. 0 or below: they hold it.
    #[must_use]
    pub(crate) fn overshoot(&self, candidate: &Candidate) -> f64 {
        let figure = candidate.of(self.quantity);
        let beyond = match self.quantity {
            Quantity::Error(metric) if metric.is_likeness() => self.value - figure,
            _ => figure - self.value,
        };
        if self.value == 0.0 { beyond } else { beyond / self.value.abs() }
    }
}
