//! The process around a command: exit codes, signals, symbolic links, the operating system, printed text, pages and progress bars.

pub(crate) mod counted_work;
mod exit;
pub(crate) mod interrupt;
pub(crate) mod links;
pub(crate) mod platform;
pub(crate) mod progress;
pub(crate) mod text;

pub(crate) use exit::Exit;
