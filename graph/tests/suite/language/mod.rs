//! The language of pipeline files: what its words come to, what is wrong with a file, and where.
//!
//! Answers to bad files are pinned whole; `INSTA_UPDATE=always cargo test -p framewright-graph --test suite language` accepts
//! new ones, and the difference in git shows them.

mod arrays;
mod bad;
mod bombs;
mod both_eyes;
mod choices;
mod covering;
mod dynamic_sizes;
mod encodings;
mod exact_values;
mod extend;
mod eyes;
mod fragments;
mod helps;
mod history;
mod left_alone;
mod library;
mod many_changes;
mod misuse;
mod precision;
mod random;
mod repeat;
mod resolves;
mod resources;
mod samplers;
mod shipped;
mod texture_declarations;
mod textures;
mod views;
mod whole;
mod words;
mod works;
