//! `docs/numbers.md`: how far each closed formula of the shaders is from its twin over its whole range (NU-5), and what becomes
//! of extremes (NU-4). The bounds in the table hold on every software driver: each is a little above the largest error that was
//! measured on any. On every driver hold the bounds that Vulkan's precision of operations comes to.

mod arguments;
mod extremes;
mod formulas;
mod images;

use extremes::EXTREMES;
use framewright_tests::render::{device, in_repository};
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

/// Writes the page instead of comparing it: bounds that are too low are raised. To lower one, remove its line before.
const UPDATE: &str = "FRAMEWRIGHT_UPDATE";
/// By how much a new bound exceeds what was measured.
const HEADROOM: f64 = 1.25;

/// The most that a sum, a difference or a product is off by, as a share of it: Vulkan has them rounded correctly.
const ROUNDING: f64 = 1.0 / 16_777_216.0;
/// What Vulkan allows a quotient, in ulp ("Precision and Operation of SPIR-V Instructions").
const QUOTIENT: f64 = 2.5;

/// The largest error of a sum with this many roundings and quotients, in units of [`ROUNDING`]. A quotient's error is given in ulp, and an
/// ulp is one to two of these units.
fn within(roundings: u32, quotients: u32) -> f64 {
    f64::from(roundings) + 2.0 * QUOTIENT * f64::from(quotients)
}

/// What an error is counted in.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Unit {
    /// The distance from a 32-bit number to the next one.
    Ulp,
    /// 1/255.
    Steps,
}

/// A number of the GPU, and what the twin says. Its error is counted in steps of the size of `scale`: the number itself, or the
/// largest one that goes into it where one is taken from another.
#[derive(Debug, Clone, Copy)]
struct Compared {
    found: f64,
    expected: f64,
    scale: f64,
}

impl Compared {
    /// Counted in steps of the number itself.
    fn own(found: f64, expected: f64) -> Compared {
        Compared { found, expected, scale: expected }
    }

    fn error(&self, unit: Unit) -> f64 {
        let tiny = f64::from(f32::MIN_POSITIVE);
        // Numbers below the smallest normal one may be flushed to zero.
        if self.found == self.expected || self.found.abs().max(self.expected.abs()) < tiny {
            return 0.0;
        }
        let apart = (self.found - self.expected).abs();
        let error = match unit {
            Unit::Ulp => apart / (self.scale.abs().max(tiny).log2().floor() - 23.0).exp2(),
            Unit::Steps => 255.0 * apart,
        };
        if error.is_nan() { f64::INFINITY } else { error }
    }
}

/// A row of the table, measured.
struct Row {
    /// Modules and functions of the twins.
    formula: &'static str,
    range: &'static str,
    unit: Unit,
    /// The most that Vulkan's precision comes to.
    allowed: f64,
    error: f64,
}

impl Row {
    fn of(
        formula: &'static str,
        range: &'static str,
        unit: Unit,
        allowed: f64,
        all: impl IntoIterator<Item = Compared>,
    ) -> Row {
        let error = all.into_iter().map(|one| one.error(unit)).fold(0.0, f64::max);
        Row { formula, range, unit, allowed, error }
    }
}

/// With two digits, rounded up.
fn rounded_up(bound: f64) -> String {
    if bound == 0.0 {
        return "0".to_owned();
    }
    let digits = (1.0 - bound.log10().floor()).max(0.0) as usize;
    let power = 10_f64.powi(digits as i32);
    format!("{:.digits$}", (bound * power).ceil() / power)
}

fn page() -> PathBuf {
    in_repository("docs/numbers.md")
}

/// The bounds that a page states, by formula and range.
fn stated(page: &str) -> BTreeMap<(String, String), f64> {
    let rows = page.lines().filter_map(|line| {
        let cells: Vec<&str> = line.strip_prefix("| `")?.split(" | ").collect();
        let [formula, range, error] = cells[..] else { return None };
        let bound = error.split(' ').next()?.parse().ok()?;
        Some(((formula.trim_end_matches('`').to_owned(), range.to_owned()), bound))
    });
    rows.collect()
}

fn made(rows: &[Row], bounds: &BTreeMap<(String, String), f64>) -> String {
    let mut table = String::new();
    for Row { formula, range, unit, error, .. } in rows {
        let bound = bounds.get(&((*formula).to_owned(), (*range).to_owned())).copied();
        let bound =
            bound.filter(|bound| error <= bound).map_or_else(|| rounded_up(error * HEADROOM), |it| it.to_string());
        let unit = if *unit == Unit::Ulp { "ulp" } else { "steps" };
        let bound = if bound == "0" { "0, equal".to_owned() } else { format!("{bound} {unit}") };
        writeln!(table, "| `{formula}` | {range} | {bound} |").expect("a string takes everything");
    }
    let mut extremes = String::new();
    for (what, result, test) in EXTREMES {
        writeln!(extremes, "| {what} | {result} | `{test}` |").expect("a string takes everything");
    }
    include_str!("numbers.md").replace("FORMULAS\n", &table).replace("EXTREMES\n", &extremes)
}

/// NU-5: no formula is farther from its twin, on the driver at hand, than Vulkan's precision allows; nor, where that is a software
/// driver, than the page says.
#[test]
fn no_formula_is_farther_from_its_twin_than_the_page_says() -> Result<(), Box<dyn Error>> {
    let Some(mut rows) = formulas::rows()? else { return Ok(()) };
    rows.extend(images::rows()?);
    let there = std::fs::read_to_string(page()).unwrap_or_default();
    let bounds = stated(&there);
    let made = made(&rows, &bounds);
    if std::env::var_os(UPDATE).is_some() {
        std::fs::write(page(), made)?;
        return Ok(());
    }
    for Row { formula, range, error, allowed, .. } in &rows {
        println!("{formula}, {range}: {error} of {allowed}");
        assert!(error <= allowed, "{formula}, {range}: {error}, and Vulkan's precision comes to {allowed}");
    }
    if device().is_some_and(|device| device.summary().kind != "cpu") {
        return Ok(());
    }
    let differs = there.lines().zip(made.lines()).find(|(there, made)| there != made);
    assert!(
        there == made,
        "docs/numbers.md is not what was measured, first {differs:#?}\n\
         see:    {UPDATE}=1 cargo test -p framewright-tests --test suite drawn::numbers; git diff docs/numbers.md\n\
         accept: git add docs/numbers.md"
    );
    Ok(())
}

/// Every public function of the twins is named by a line of the page that begins with one of its file: in a table, or in the text
/// between them.
#[test]
fn every_twin_is_on_the_page() -> Result<(), Box<dyn Error>> {
    let page = std::fs::read_to_string(page())?;
    let mut functions = 0;
    for file in std::fs::read_dir(in_repository("passes/src/twin"))? {
        let path = file?.path();
        let module = path.file_stem().ok_or("no file")?.to_string_lossy().into_owned();
        let lines: Vec<&str> = page.lines().filter(|line| line.contains(&format!("`{module}::"))).collect();
        for line in std::fs::read_to_string(&path)?.lines() {
            let Some(rest) = line.trim_start().strip_prefix("pub fn ") else { continue };
            let (function, _) = rest.split_once('(').ok_or(rest)?;
            let words =
                |line: &str| line.split(|it: char| !it.is_alphanumeric() && it != '_').any(|word| word == function);
            assert!(lines.iter().any(|line| words(line)), "{module}::{function} is not on the page");
            functions += 1;
        }
    }
    assert!(functions > 70, "{functions} functions");
    Ok(())
}

/// NU-4: each extreme names a test, and that test is there.
#[test]
fn every_extreme_names_a_test_that_is_there() -> Result<(), Box<dyn Error>> {
    let page = include_str!("numbers.md");
    let between: Vec<&str> = page.split('`').filter(|word| word.starts_with("drawn::")).collect();
    assert!(between.len() > 4, "{between:?}");
    for test in EXTREMES.iter().map(|(_, _, test)| *test).chain(between) {
        let (module, function) = test.rsplit_once("::").ok_or(test)?;
        let path = format!("tests/tests/suite/{}", module.replace("::", "/"));
        let file = [format!("{path}.rs"), format!("{path}/mod.rs")]
            .map(|path| in_repository(&path))
            .into_iter()
            .find(|file| file.exists());
        let text = std::fs::read_to_string(file.ok_or_else(|| format!("{test}: no such file"))?)?;
        assert!(text.contains(&format!("#[test]\nfn {function}()")), "{test} is not there");
    }
    Ok(())
}
