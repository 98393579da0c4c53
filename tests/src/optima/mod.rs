//! The least cost of a small frame: fewest resolves, fewest image barriers, least memory.
//!
//! Found by trying every valid order and every placement, from the meaning of the frame alone: neither the dependencies
//! nor the counts are the compiler's. The frames ([`graphs`]) have up to eight passes, all needed, over images of one mip
//! level and one layer; each image is begun once.

pub mod graphs;
mod least;
mod orders;
mod packing;

pub use least::{Cost, costs};
pub use orders::{in_order, orders};
