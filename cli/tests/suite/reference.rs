//! Whole files in the reference can be copied: the command itself says that they are fine.

use crate::testing::{Place, pages, repository};
use std::collections::BTreeSet;

/// Each block of RON in the README and the pages under `docs/`.
fn examples() -> Vec<String> {
    let texts = pages().into_iter().map(|page| std::fs::read_to_string(page).expect("a text"));
    let blocks = texts.flat_map(|text| text.split("```ron\n").skip(1).map(str::to_owned).collect::<Vec<_>>());
    blocks.map(|after| after.split("```").next().unwrap_or_default().to_owned()).collect()
}

/// The smallest picture.
fn picture() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(4, 4).write_to(&mut bytes, image::ImageFormat::Png).expect("written");
    bytes.into_inner()
}

#[test]
fn every_whole_file_of_the_reference_is_fine() {
    let place = Place::new();
    place.file("grain.png", picture());
    let mut checked = 0;
    for example in examples() {
        let file = place.file("example.ron", &example);
        let name = file.to_str().expect("a plain path");
        let arguments = match example.split('(').next() {
            Some("Pipeline") => vec!["check", name],
            Some("Extension") => vec!["check", "forward", "--extend", name],
            Some("Settings") => vec!["check", "post", "--settings", name],
            Some("Fragments") => {
                let including = "Pipeline(version: 1, include: [\"example.ron\"], \
                    images: [(name: \"screen\", format: Output, size: Output)], \
                    passes: [(use: \"wipe\", name: \"all\", with: {\"target\": \"screen\"})], outputs: [\"screen\"])";
                place.file("including.ron", including);
                vec!["check", "including.ron"]
            }
            // A part of a file, which a test of the reference puts into one.
            _ => continue,
        };
        checked += 1;
        let outcome = place.run(&arguments);
        assert_eq!(outcome.code, Some(0), "{example}\n{}", outcome.err);
    }
    assert!(checked >= 11, "{checked} whole files");
}

/// The commands.
const COMMANDS: [&str; 17] = [
    "check", "inspect", "diff", "explain", "run", "serve", "attach", "window", "facts", "compare", "measure", "choose",
    "merge", "new", "schema", "devices", "cache",
];

/// The options of all commands, as their helps list them.
fn options() -> BTreeSet<String> {
    let place = Place::new();
    let helps = COMMANDS.map(|command| place.run(&[command, "--help"]).out);
    helps.iter().flat_map(|help| options_in(help)).collect()
}

/// The options that a text names, without their dashes.
fn options_in(text: &str) -> BTreeSet<String> {
    let words = text.split(|letter: char| !letter.is_alphanumeric() && letter != '-');
    let options = words.filter_map(|word| word.strip_prefix("--"));
    options.filter(|word| word.starts_with(char::is_alphabetic)).map(str::to_owned).collect()
}

#[test]
fn the_page_of_the_command_lists_every_command_and_option() {
    let page = std::fs::read_to_string(repository("docs/command.md")).expect("the page");
    for command in COMMANDS {
        assert!(page.contains(&format!("\n## {command}\n")), "docs/command.md has no section `{command}`");
    }
    let of_the_command = BTreeSet::from(["version".to_owned()]);
    assert_eq!(options_in(&page), &options() | &of_the_command, "named in docs/command.md, and by --help");
}

/// The texts of all Rust files in a folder, without lines that are comments.
fn code(folder: &std::path::Path) -> String {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable").path());
    let text = |path: std::path::PathBuf| match path.extension() {
        _ if path.is_dir() => code(&path),
        Some(end) if end == "rs" => std::fs::read_to_string(path).expect("a text"),
        _ => String::new(),
    };
    let texts: String = entries.map(text).collect();
    texts.lines().filter(|line| !line.trim_start().starts_with("//")).map(|line| line.to_owned() + "\n").collect()
}

#[test]
fn no_library_names_an_option_of_the_command() {
    let options = options();
    assert!(options.contains("shader-memory") && options.len() > 25, "{options:?}");
    for library in [
        "graph/src",
        "passes/src",
        "backend-vulkan/src",
        "framewright/src",
        "framewright/lab/src",
        "framewright/viewer/src",
        "framewright/viewer/what-if/src",
    ] {
        let code = code(&repository(library));
        for option in &options {
            // `--target-env` of another program's isn't `--target`.
            let ends = |rest: &str| !rest.starts_with(|it: char| it == '-' || it.is_ascii_alphanumeric());
            let names = |line: &&str| line.split(&format!("--{option}")).skip(1).any(ends);
            let named = code.lines().find(names);
            assert_eq!(named, None, "{library}");
        }
    }
}
