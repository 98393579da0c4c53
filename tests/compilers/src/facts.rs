//! Facts of a stage's interface, in a form that all readers share.

use std::collections::BTreeMap;
use std::path::Path;

/// What is known: by kind, and by what it is of.
///
/// `resource`, `name`, `count`, `shape`, `component`, `access` and `bytes` are of a set and a binding, `member` and `member_name` of
/// these and an offset, `input`, `output` and their names of a location and a component, `constant` and its name of a number.
pub type Facts = BTreeMap<(String, String), String>;

/// An entry point of a module.
pub struct Module {
    /// Its file below the folder of modules.
    pub file: String,
    /// Its name.
    pub entry: String,
    /// `vert`, `frag` or `comp`.
    pub stage: String,
    /// What Framewright reads off it.
    pub facts: Facts,
}

/// The modules of a file of facts.
pub fn modules(file: &Path) -> Vec<Module> {
    let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let mut modules: Vec<Module> = Vec::new();
    for line in text.lines() {
        match &line.split('\t').collect::<Vec<_>>()[..] {
            ["module", file, entry, stage] => {
                let [file, entry, stage] = [file, entry, stage].map(|it| (*it).to_owned());
                modules.push(Module { file, entry, stage, facts: Facts::new() });
            }
            [kind, of, is] => {
                let Some(module) = modules.last_mut() else { continue };
                module.facts.insert(((*kind).to_owned(), (*of).to_owned()), (*is).to_owned());
            }
            _ => panic!("{line}"),
        }
    }
    modules
}

/// Facts, a line each.
pub fn text(facts: &Facts) -> String {
    facts.iter().map(|((kind, of), is)| format!("{kind}\t{of}\t{is}\n")).collect()
}

/// Facts that were written as lines.
pub fn of_text(text: &str) -> Facts {
    let facts = text.lines().filter_map(|line| {
        let mut parts = line.splitn(3, '\t').map(str::to_owned);
        Some(((parts.next()?, parts.next()?), parts.next()?))
    });
    facts.collect()
}

/// A reason without what it speaks of, so that equal reasons are counted together.
pub fn rule(what: &str) -> String {
    let mut words: Vec<&str> = Vec::new();
    for (at, part) in what.split(['`', '\'']).enumerate() {
        words.push(if at % 2 == 0 { part } else { "…" });
    }
    let text: String = words.concat();
    let mut rule = String::new();
    for letter in text.chars().take(160) {
        match letter.is_ascii_digit() {
            true if rule.ends_with('#') => {}
            true => rule.push('#'),
            false => rule.push(letter),
        }
    }
    rule
}

/// Whether a name is one by place, which stands where a module has none.
pub fn is_place(name: &str) -> bool {
    ["binding ", "offset ", "location ", "constant "].iter().any(|beginning| name.starts_with(beginning))
        || name == "params"
}

/// Adds a fact.
pub fn add(facts: &mut Facts, kind: &str, of: &str, is: impl ToString) {
    facts.insert((kind.to_owned(), of.to_owned()), is.to_string());
}

/// The name, unless it stands for none.
pub fn own(name: &str) -> &str {
    let stands = name.strip_prefix('_').is_some_and(|rest| rest.starts_with(|it: char| it.is_ascii_digit()));
    if stands { "" } else { name }
}

/// Adds a sampler, and makes one resource of an image and a sampler at one place.
pub fn add_sampler(facts: &mut Facts, place: &str) {
    let key = ("resource".to_owned(), place.to_owned());
    let is = if facts.get(&key).is_some_and(|kind| kind == "image") { "combined" } else { "sampler" };
    facts.insert(key, is.to_owned());
}

/// The place of push constants, which Framewright makes a uniform block of.
pub const PUSHED: &str = "0 255";

/// The bytes of a uniform block, in whole 16.
pub fn rounded(bytes: u64) -> u64 {
    bytes.div_ceil(16) * 16
}
