//! The command line: its arguments, and the options that messages name.

pub(crate) mod args;
pub(crate) mod attaching;
pub(crate) mod choosing;
pub(crate) mod comparing;
pub(crate) mod differing;
pub(crate) mod explaining;
pub(crate) mod measuring;
pub(crate) mod merging;
pub(crate) mod options;
mod pipeline;
pub(crate) mod scenes;
pub(crate) mod serving;
pub(crate) mod subject;
pub(crate) mod values;
pub(crate) mod windows;
