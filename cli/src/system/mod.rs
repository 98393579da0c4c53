//! The process around a command: exit codes, signals, symbolic links, printed text and progress bars.

pub(crate) mod counted;
mod exit;
pub(crate) mod interrupt;
pub(crate) mod links;
pub(crate) mod progress;
pub(crate) mod text;

pub(crate) use exit::Exit;
