//! The checker: accepts what is right, catches what is not.

mod accepts;
mod compiled;
mod contents;
mod eyes;
mod form;
mod large;
mod mutations;
mod rules;
