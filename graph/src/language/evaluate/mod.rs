//! Entries become the flat lists of a pipeline, for one choice of settings, scene, view and device.

mod circles;
mod evaluation;
mod fragment_use;
mod lists;
mod memory;
mod passes;
mod pipeline;
mod previous;
mod properties;
mod resources;
mod unused_fragments;

pub(crate) use evaluation::Purpose;
pub(crate) use memory::Memory;
pub(crate) use pipeline::evaluate;
