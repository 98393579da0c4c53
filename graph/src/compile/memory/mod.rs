//! Memory of transient resources: the heap and offset of each, and the alias edges between them.

mod aliasing;
mod intervals;
mod pack;
mod place;

pub(super) use aliasing::{AliasEdge, alias_edges};
pub(super) use place::{PlacedResources, Times, by_first_step, place};
