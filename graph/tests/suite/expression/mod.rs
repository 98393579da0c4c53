//! Expressions: what they come to, what decided that, what is wrong with one and where.
//!
//! Messages are pinned whole; `INSTA_UPDATE=always cargo test -p framewright-graph --test suite expression` accepts new ones,
//! and the difference in git shows them.

mod bounds;
mod mistakes;
mod outcomes;
mod random;
mod types;
mod values;
mod world;
