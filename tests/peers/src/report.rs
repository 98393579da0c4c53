//! The figures as a table for people, and as JSON for programs.

use crate::Graph;
use crate::measure::{Found, Times};
use crate::systems::{ALL, About, Devices};
use serde::Serialize;
use std::time::Duration;

/// A graph in a system. Times are microseconds a pass.
#[derive(Serialize)]
pub(crate) struct Row {
    graph: String,
    passes: u32,
    system: &'static str,
    #[serde(flatten)]
    found: Outcome,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Outcome {
    Measured(Figures),
    /// Why there are no figures.
    Failed(String),
}

#[derive(Serialize, Clone, Copy)]
struct Figures {
    build: f64,
    compile: f64,
    /// `build` and `compile`.
    together: f64,
    /// `compile` over Framewright's.
    compile_ratio: Option<f64>,
    /// `together` over Framewright's.
    together_ratio: Option<f64>,
    image_barriers: Option<u64>,
    barrier_calls: Option<u64>,
}

impl Row {
    /// A row for each system, in the order of [`ALL`]: Framewright is the first one.
    pub(crate) fn of(graph: Graph, found: [Found; ALL.len()]) -> Vec<Row> {
        let each = |time: Duration| time.as_secs_f64() * 1e6 / f64::from(graph.passes);
        let together = |times: Times| each(times.build + times.compile);
        let ours = found[0].as_ref().ok().map(|(times, _)| *times);
        let outcome = |found: Found| match found {
            Ok((times, barriers)) => {
                let compile = each(times.compile);
                Outcome::Measured(Figures {
                    build: each(times.build),
                    compile,
                    together: together(times),
                    compile_ratio: ours.map(|ours| compile / each(ours.compile)),
                    together_ratio: ours.map(|ours| together(times) / together(ours)),
                    image_barriers: barriers.map(|barriers| barriers.images),
                    barrier_calls: barriers.map(|barriers| barriers.calls),
                })
            }
            Err(error) => Outcome::Failed(error),
        };
        let row = |(about, found): (&About, Found)| Row {
            graph: graph.name(),
            passes: graph.passes,
            system: about.system,
            found: outcome(found),
        };
        ALL.iter().zip(found).map(row).collect()
    }
}

/// Everything that is printed as JSON.
#[derive(Serialize)]
struct Report<'a> {
    device: Option<&'a str>,
    systems: Vec<System>,
    rows: &'a [Row],
}

#[derive(Serialize)]
struct System {
    name: &'static str,
    package: &'static str,
    version: &'static str,
    does: &'static str,
    lacks: &'static str,
}

fn systems() -> Vec<System> {
    let system = |about: &About| System {
        name: about.system,
        package: about.package,
        version: version(about.package),
        does: about.does,
        lacks: about.lacks,
    };
    ALL.iter().map(system).collect()
}

/// The version of a package that this program was built with.
fn version(package: &str) -> &'static str {
    const LOCK: &str = include_str!("../Cargo.lock");
    let entry = LOCK.split("[[package]]").find(|entry| entry.contains(&format!("name = \"{package}\"\n")));
    let version = entry.and_then(|entry| entry.split_once("version = \"")?.1.split_once('"'));
    version.map_or("of no known version", |(version, _)| version)
}

pub(crate) fn print_json(devices: &Devices, rows: &[Row]) -> serde_json::Result<()> {
    println!("{}", serde_json::to_string_pretty(&Report { device: devices.name(), systems: systems(), rows })?);
    Ok(())
}

pub(crate) fn print_table(devices: &Devices, rows: &[Row]) {
    println!(
        "Microseconds a pass, the least of many runs; ratios to Framewright. Device: {}\n",
        devices.name().unwrap_or("none")
    );
    println!(
        "{:<14}{:<21}{:>8}{:>10}{:>8}{:>10}{:>8}{:>11}{:>9}",
        "graph", "system", "build", "compile", "ratio", "together", "ratio", "barriers", "calls"
    );
    let mut before = "";
    for row in rows {
        if row.graph != before && !before.is_empty() {
            println!();
        }
        let graph = if row.graph == before { "" } else { &row.graph };
        match &row.found {
            Outcome::Failed(error) => println!("{graph:<14}{:<21}{error}", row.system),
            Outcome::Measured(figures) => println!("{graph:<14}{:<21}{}", row.system, figures.columns()),
        }
        before = &row.graph;
    }
    println!();
    for System { name, package, version, does, lacks } in systems() {
        println!("{name} ({package} {version}): {does}.\n    Not: {lacks}.");
    }
}

impl Figures {
    fn columns(&self) -> String {
        let ratio = |ratio: Option<f64>| ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}"));
        let count = |count: Option<u64>| count.map_or("–".to_owned(), |count| count.to_string());
        format!(
            "{:>8.3}{:>10.3}{:>8}{:>10.3}{:>8}{:>11}{:>9}",
            self.build,
            self.compile,
            ratio(self.compile_ratio),
            self.together,
            ratio(self.together_ratio),
            count(self.image_barriers),
            count(self.barrier_calls)
        )
    }
}
