//! From a pipeline file to its verified Plan: what `check`, `inspect` and `run` share.

mod assets;
pub(crate) mod device;
pub(crate) mod helper;
pub(crate) mod layer;
mod loaded;
pub(crate) mod notes;
mod other_devices;
pub(crate) mod plan_file;
pub(crate) mod totals;

pub(crate) use assets::{Assets, draws, precompiled};
pub(crate) use loaded::{Loaded, Planned, View, inputs, load, load_with, planned};
