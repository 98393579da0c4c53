//! The live page: a pipeline is drawn anew whenever one of its files or settings changes, and browsers of this machine see it.

mod controls;
mod published;
mod server;
mod session;

pub(crate) use published::Published;
pub(crate) use server::start;
pub(crate) use session::Session;
