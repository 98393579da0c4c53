//! What the settings of a pipeline cost, and what they buy.
//!
//! - [`picture`] reads and writes pictures, and [`metric`] tells the errors of one beside another: FLIP, SSIM and others.
//! - A [`Bench`](bench::Bench) draws the [choices](bench::Choice) of a [`sweep`] on a device, in turns with a baseline, and gives their
//!   [`results`]: time, memory, and errors beside a converged reference.
//! - [`results::joined`] merges the results of several machines' parts of a sweep, and [`choosing`] finds the best settings under a
//!   budget.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use framewright::{Choices, Device, DeviceOptions, Pipeline, ReadFiles, RendererOptions, Stereo, load_scene};
//! use framewright_lab::bench::{Bench, BenchOptions, Choice, MeasuredScene, Program};
//! use framewright_lab::choosing::{Candidates, Limit, Quantity, SettingsAnswer};
//! use framewright_lab::results::{FORMAT_VERSION, Results};
//! use framewright_lab::sweep::{self, Combination, Sweep};
//! use std::collections::BTreeMap;
//! use std::rc::Rc;
//!
//! /// A program that keeps no files.
//! struct Quiet;
//! impl Program for Quiet {}
//!
//! let device = Device::open(&DeviceOptions::default())?;
//! let pipeline = Pipeline::open("forward", &RendererOptions::default(), &ReadFiles::default())?;
//! let scene = Rc::new(MeasuredScene::new("spheres_and_cubes".to_owned(), load_scene("spheres_and_cubes")?));
//! let baseline = Choice { values: BTreeMap::new(), scene, size: [640, 360], stereo: vec![Stereo::Off] };
//! let swept = [Sweep { name: "msaa".to_owned(), values: vec!["1".to_owned(), "4".to_owned()] }];
//! let choices = sweep::choices(&swept, Combination::All)?.into_iter().map(|values| Choice { values, ..baseline.clone() });
//! let choices: Vec<Choice> = choices.collect();
//!
//! let mut bench = Bench::new(&device, pipeline, Choices::default(), BenchOptions::default(), &Quiet)?;
//! let subject = bench.subject("forward".to_owned(), &baseline)?;
//! let mut rows = Vec::new();
//! bench.batch((&baseline, &subject), &choices, &|_| (), &mut rows)?;
//!
//! let candidates = Candidates::of(&Results { format_version: FORMAT_VERSION, subject, rows });
//! let limits = [Limit { quantity: Quantity::Milliseconds, value: 4.0 }];
//! if let SettingsAnswer::Best { best, .. } = candidates.choose(&limits) {
//!     println!("msaa = {}", best.settings["msaa"]);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! The command `framewright` is made of it: `compare`, `measure`, `merge` and `choose` only read arguments and files, and print.

pub mod bench;
pub mod choosing;
mod digest;
mod error;
pub mod mentions;
pub mod metric;
pub mod outputs;
pub mod picture;
pub mod quantiles;
pub mod results;
pub mod sweep;
pub mod timings;

pub use digest::Digest;
pub use error::Error;
