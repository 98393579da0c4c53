//! Commands that the README and the pages under `docs/` show print what stands there.

use crate::testing::{Place, Vulkan, outcome, pages, repository};
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// How a renewed page is seen and accepted.
const UPDATE: &str = "FRAMEWRIGHT_UPDATE";

/// The line before a command and its output.
const CONSOLE: &str = "```console\n$ ";

#[test]
fn the_readme_shows_what_new_writes() {
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let written = std::fs::read_to_string(place.path("first.ron")).expect("a text");
    assert_eq!(block(&text(&repository("README.md")), "```ron\n"), written);
}

/// Each command in a `console` block runs in a folder that holds the README's pipeline; its output must stand below it.
/// `FRAMEWRIGHT_UPDATE=1` writes the output into the page instead.
#[test]
fn pages_show_what_commands_print() {
    let mut commands = 0;
    for page in pages() {
        let shown = text(&page);
        if !shown.contains(CONSOLE) {
            continue;
        }
        let renewed = renewed(&shown, &mut commands);
        if std::env::var_os(UPDATE).is_some() {
            std::fs::write(&page, renewed).expect("written");
            continue;
        }
        let differs = shown.lines().zip(renewed.lines()).find(|(shown, renewed)| shown != renewed);
        assert!(
            shown == renewed,
            "{} shows other output than the command prints, first {differs:#?}\n\
             see:    {UPDATE}=1 cargo test --package framewright-cli --test suite readme; git diff\n\
             accept: git add README.md docs",
            page.display()
        );
    }
    assert!(commands >= 8, "{commands} commands are shown");
}

/// A page with the output of its commands as it is now. `commands` counts them.
fn renewed(page: &str, commands: &mut u32) -> String {
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let mut renewed = String::new();
    let mut rest = page;
    while let Some((before, after)) = rest.split_once(CONSOLE) {
        let (shown, after) = after.split_once("\n```").expect("the block ends");
        let command = shown.lines().next().expect("a command");
        renewed += &format!("{before}{CONSOLE}{command}\n{}\n```", printed(&place, command));
        rest = after;
        *commands += 1;
    }
    renewed + rest
}

/// Times and drivers differ from machine to machine, so of `run` the page shows what each line is about.
#[test]
fn the_page_of_the_command_shows_the_lines_of_a_run() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let page = text(&repository("docs/command.md"));
    let shown = block(&page, "```text\n$ framewright run ");
    let (arguments, shown) = shown.split_once('\n').expect("its output");
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let arguments: Vec<&str> = std::iter::once("run").chain(arguments.split_whitespace()).collect();
    let outcome = place.run_with(&variables, &arguments).exits(0);
    assert_eq!(labels(shown), labels(&outcome.out));
}

/// The subject of each line: of a table its first two columns, else what stands before a colon. Notes stand apart, on standard
/// error, where a slow machine has more of them.
fn labels(printed: &str) -> Vec<String> {
    let label = |line: &str| match line.strip_prefix('|') {
        Some(row) => row.split('|').take(2).collect(),
        None => line.split(':').take(1).collect(),
    };
    printed.lines().filter(|line| !line.starts_with("note: ")).map(label).collect()
}

fn text(page: &PathBuf) -> String {
    std::fs::read_to_string(page).expect("a page")
}

/// The first block of code that `begins` so, from there on.
fn block<'a>(page: &'a str, begins: &str) -> &'a str {
    let after = page.split_once(begins).expect("there is one").1;
    after.split_once("```").expect("it ends").0
}

/// The output of a shell, errors included.
fn printed(place: &Place, command: &str) -> String {
    let binary = std::path::Path::new(env!("CARGO_BIN_EXE_framewright"));
    let folder = binary.parent().expect("a folder").to_str().expect("a plain path");
    let path = format!("{folder}:{}", std::env::var("PATH").unwrap_or_default());
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &format!("{{ {command}; }} 2>&1")])
        .env("PATH", path)
        .current_dir(place.path(""))
        .stdin(Stdio::null());
    let outcome = outcome(&mut shell);
    outcome.out.trim_end().to_owned()
}
