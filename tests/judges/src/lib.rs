//! Nothing is built here: Cargo.toml says what this is for.
