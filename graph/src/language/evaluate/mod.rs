//! Entries become the flat lists of a pipeline, for one choice of settings, scene, view and device.

mod circles;
mod evaluation;
mod lists;
mod memory;
mod passes;
mod pipeline;
mod previous;
mod properties;
mod put_in;
mod resources;
mod unused;

pub(crate) use evaluation::Purpose;
pub(crate) use memory::Memory;
pub(crate) use pipeline::evaluate;
