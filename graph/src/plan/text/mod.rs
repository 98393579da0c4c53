//! A Plan as text for people.

mod changes;
mod decided;
mod lists;
mod outline;
mod tree;
mod words;
