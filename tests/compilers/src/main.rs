//! Holds what Framewright reads off modules against spirv-cross and spirv-reflect: `reflections FOLDER`, of a folder that
//! tests/compilers/corpus.sh made. It prints a table, and each kind of disagreement with a few examples. `reflections FOLDER JUDGE` asks
//! one of them.

mod facts;
mod spirv_cross;
mod spirv_reflect;

use facts::{Facts, Module};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A reader that isn't ours: its name, and how it reads an entry point. An error in words: it can't.
struct Judge {
    name: &'static str,
    read: fn(file: &Path, entry: &str, stage: &str) -> Result<Facts, String>,
}

const JUDGES: [Judge; 2] =
    [Judge { name: "spirv-cross", read: spirv_cross::read }, Judge { name: "spirv-reflect", read: apart }];

/// What a compiler's modules came to.
#[derive(Default)]
struct Row {
    modules: BTreeSet<String>,
    entries: usize,
    refused: usize,
    facts: usize,
    equal: usize,
    unread: usize,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match &arguments[..] {
        [word, file, entry] if word == "--spirv-reflect" => match spirv_reflect::read(Path::new(file), entry) {
            Ok(facts) => print!("{}", facts::text(&facts)),
            Err(what) => {
                eprintln!("{what}");
                std::process::exit(1);
            }
        },
        [folder] => compare(Path::new(folder), ""),
        [folder, judge] => compare(Path::new(folder), judge),
        _ => eprintln!("reflections FOLDER"),
    }
}

/// spirv-reflect in a process of its own with a bound on its time: it is C, and some modules end it or keep it busy forever.
fn apart(file: &Path, entry: &str, _: &str) -> Result<Facts, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new("timeout")
        .arg("5")
        .arg(own)
        .arg("--spirv-reflect")
        .arg(file)
        .arg(entry)
        .output()
        .map_err(|it| it.to_string())?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{} {}", output.status, said.lines().next().unwrap_or_default()));
    }
    Ok(facts::of_text(&String::from_utf8_lossy(&output.stdout)))
}

fn compare(folder: &Path, only: &str) {
    let modules = facts::modules(&folder.join("facts"));
    let mut rows: BTreeMap<(String, &str), Row> = BTreeMap::new();
    let mut different: BTreeMap<(&str, String), (usize, BTreeSet<String>, Vec<String>)> = BTreeMap::new();
    for module in &modules {
        let compiler = module.file.split('/').next().unwrap_or_default().to_owned();
        for judge in JUDGES.iter().filter(|judge| judge.name.contains(only)) {
            let row = rows.entry((compiler.clone(), judge.name)).or_default();
            row.modules.insert(module.file.clone());
            row.entries += 1;
            let mut tell = |kind: String, example: String| {
                let (count, compilers, examples) = different.entry((judge.name, kind)).or_default();
                *count += 1;
                compilers.insert(compiler.clone());
                examples.push(format!("{}:{}: {example}", module.file, module.entry));
            };
            if let Some(what) = module.facts.get(&("refused".to_owned(), String::new())) {
                row.refused += 1;
                tell(format!("refused: {}", facts::rule(what)), what.clone());
                continue;
            }
            let file: PathBuf = folder.join("modules").join(&module.file);
            let theirs = match (judge.read)(&file, &module.entry, &module.stage) {
                Ok(theirs) => theirs,
                Err(what) => {
                    row.unread += 1;
                    tell("the other can't read it".to_owned(), what);
                    continue;
                }
            };
            let (equal, unequal) = against(module, &theirs);
            row.facts += equal + unequal.len();
            row.equal += equal;
            unequal.into_iter().for_each(|(kind, example)| tell(kind, example));
        }
    }
    print(&rows, &different);
}

/// How many facts are equal, and those that aren't: their kind, and what each says.
fn against(module: &Module, theirs: &Facts) -> (usize, Vec<(String, String)>) {
    let (mut equal, mut unequal) = (0, Vec::new());
    let ours = &module.facts;
    let is_other = |of: &str| {
        let place = of.split(' ').take(2).collect::<Vec<_>>().join(" ");
        ours.get(&("resource".to_owned(), place)).is_some_and(|kind| kind == "other")
    };
    let kinds: BTreeSet<&str> = theirs.keys().map(|(kind, _)| kind.as_str()).collect();
    // Kinds of which a judge says nothing where there is nothing: all kinds of things, and nothing about each.
    let things = ["resource", "input", "output", "constant", "member"];
    for (key @ (kind, of), is) in theirs {
        let idle = ours.get(&(format!("idle_{kind}"), of.clone()));
        if idle.is_some() || is.is_empty() || is_other(of) && !kind.starts_with("in") && !kind.starts_with("out") {
            continue;
        }
        match ours.get(key) {
            Some(own) if own == is || kind.ends_with("name") && facts::is_place(own) => equal += 1,
            Some(own) => unequal.push((format!("{kind} differs"), format!("{kind} {of}: {own}, and there {is}"))),
            None if kind.ends_with("name") => {}
            // What is said of a resource that one reader leaves out is no further disagreement; nor are Framewright's own constants.
            None if is_left_out(ours, kind, of)
                || kind == "constant" && (100..=102).any(|own| *of == own.to_string()) => {}
            None => unequal.push((format!("{kind} only there"), format!("{kind} {of}: {is}"))),
        }
    }
    for ((kind, of), is) in ours.iter().filter(|((kind, _), _)| things.contains(&kind.as_str())) {
        let known = kinds.contains(kind.as_str()) || kind != "constant" && kind != "member";
        if known && !theirs.contains_key(&(kind.clone(), of.clone())) && is != "other" {
            unequal.push((format!("{kind} only here"), format!("{kind} {of}: {is}")));
        }
    }
    (equal, unequal)
}

/// Whether something is of a resource that isn't there, and isn't that resource itself.
fn is_left_out(ours: &Facts, kind: &str, of: &str) -> bool {
    let place = of.split(' ').take(2).collect::<Vec<_>>().join(" ");
    let of_resource = ["count", "shape", "component", "access", "bytes", "member"].contains(&kind);
    of_resource && !ours.contains_key(&("resource".to_owned(), place))
}

type Different = BTreeMap<(&'static str, String), (usize, BTreeSet<String>, Vec<String>)>;

fn print(rows: &BTreeMap<(String, &str), Row>, different: &Different) {
    println!("| compiler | judge | modules | entry points | refused | unread by the judge | facts | equal |");
    println!("|---|---|---|---|---|---|---|---|");
    for ((compiler, judge), row) in rows {
        let Row { modules, entries, refused, facts, equal, unread } = row;
        println!("| {compiler} | {judge} | {} | {entries} | {refused} | {unread} | {facts} | {equal} |", modules.len());
    }
    for ((judge, kind), (count, compilers, examples)) in different {
        println!("\n{judge}: {kind}: {count} ({})", compilers.iter().cloned().collect::<Vec<_>>().join(", "));
        let step = (examples.len() / 8).max(1);
        examples.iter().step_by(step).take(8).for_each(|example| println!("    {example}"));
    }
}
