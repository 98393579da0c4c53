//! One file per stage, each a function from data to data.
