//! Images as files that other programs open, and such files as images.
//!
//! A PNG holds encoded values as they are, with a chunk that names the encoding: 8 bits where the format has 8, else 16.
//! All else is shown as a display would show it: clamped to 0…1 and encoded with the sRGB curve, NaN as 0. Alpha is left
//! out, since what lies on a screen is opaque; that is said where it isn't 1. Depth is shown like light, as a share of the image's own largest value: with
//! reversed depth the nearest texel is white and infinitely far is black. Integers are greys or colours of their own value,
//! at most 255. Images of one component are grey, and those of two have no blue.
//!
//! An OpenEXR file holds every component of floating-point images bit for bit, and every integer.

mod data;
mod exr;
mod file_format;
mod light;
mod png;
mod texel;
pub mod values;

pub use data::{EncodingError, Picture};
pub use file_format::{FileFormat, steps};
pub use light::{DecodingError, Light};
