//! The live page: a pipeline is drawn anew whenever one of its files or settings changes, and browsers of this machine see it.

mod controls;
mod published_state;
mod server;
mod session;

pub(crate) use published_state::PublishedState;
pub(crate) use server::start;
pub(crate) use session::Session;
