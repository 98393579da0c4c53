//! What the README shows is what the command prints.

use crate::testing::{Place, outcome, repository};
use std::process::{Command, Stdio};

/// Each command in a `console` block is run in a folder that holds the README's pipeline; what it prints must stand below
/// it. `FRAMEWRIGHT_UPDATE=1` writes what it prints into the README instead.
#[test]
fn the_readme_shows_what_the_command_prints() {
    let path = repository("README.md");
    let readme = std::fs::read_to_string(&path).expect("the README is there");
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let written = std::fs::read_to_string(place.path("first.ron")).expect("a text");
    assert_eq!(block(&readme, "ron"), written, "the README shows what `framewright new first` writes");

    let mut renewed = String::new();
    let mut rest = readme.as_str();
    let mut commands = 0;
    while let Some((before, after)) = rest.split_once("```console\n$ ") {
        let (shown, after) = after.split_once("\n```").expect("the block ends");
        let command = shown.lines().next().expect("a command");
        renewed += &format!("{before}```console\n$ {command}\n{}\n```", printed(&place, command));
        rest = after;
        commands += 1;
    }
    renewed += rest;
    assert!(commands >= 4, "the README shows {commands} commands");
    if std::env::var_os("FRAMEWRIGHT_UPDATE").is_some() {
        std::fs::write(path, renewed).expect("written");
        return;
    }
    let differs = readme.lines().zip(renewed.lines()).find(|(shown, printed)| shown != printed);
    assert!(
        readme == renewed,
        "the README shows other output than the command prints, first {differs:#?}\n\
         see:    FRAMEWRIGHT_UPDATE=1 cargo test --package framewright --test suite readme; git diff README.md\n\
         accept: git add README.md"
    );
}

/// The first block of code in `language`.
fn block<'a>(readme: &'a str, language: &str) -> &'a str {
    let after = readme.split_once(&format!("```{language}\n")).expect("there is one").1;
    after.split_once("```").expect("it ends").0
}

/// What a shell prints, errors included.
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
