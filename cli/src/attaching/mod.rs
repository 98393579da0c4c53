//! The viewer of a running program: where it is, and what it is asked.

mod address;
mod asking;

pub(crate) use asking::ProgramViewer;
