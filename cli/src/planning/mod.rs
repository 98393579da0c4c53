//! From a pipeline file to its verified Plan: what `check`, `inspect` and `run` share.

pub(crate) mod device;
pub(crate) mod helper;
mod loaded;
pub(crate) mod notes;
mod other_devices;
pub(crate) mod totals;

pub(crate) use loaded::{Loaded, Planned, View, inputs, load, load_with};
