//! From a pipeline file to its verified Plan: what `check`, `inspect` and `run` share.

pub(crate) mod device;
pub(crate) mod helper;
pub(crate) mod layer;
pub(crate) mod notes;
mod other_devices;
mod pipeline;
pub(crate) mod plan_file;
pub(crate) mod totals;
pub(crate) mod what_if;

pub(crate) use other_devices::on_other_devices;
pub(crate) use pipeline::{choices, draws, load, load_with, options, planned, precompiled, undrawn};
