//! The inputs of an evaluation besides values of settings: facts of the scene, the view and the device.

mod facts;
mod reads;
mod surroundings;

pub use facts::{Fact, FactType, FactValue, Facts};
pub use reads::{Read, Reads};
pub use surroundings::{Surroundings, names_of};
pub(crate) use surroundings::{find, names};
