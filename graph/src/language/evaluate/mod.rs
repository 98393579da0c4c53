//! A document becomes the flat lists of a pipeline, for one choice of settings, scene, view and device.

pub(crate) mod circles;
pub(crate) mod lower;
pub(crate) mod previous;
pub(crate) mod properties;
pub(crate) mod put_in;
pub(crate) mod unused;
pub(crate) mod views;
