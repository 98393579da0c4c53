//! Prints lines and Rust tokens of the sources of a checkout by folder, tests not counted: what two states of the program take.
//! Comments are lines and no tokens.

use framewright_tests::render::in_repository;
use framewright_tests::sources::{FOLDERS, Source, below, flat};
use std::path::PathBuf;

fn main() {
    let root = std::env::args_os().nth(1).map_or_else(|| in_repository(""), PathBuf::from);
    let mut all = [0; 3];
    println!("{:24} {:>8} {:>8} {:>10}", "", "files", "lines", "tokens");
    for folder in FOLDERS {
        let sources = below(&root, folder);
        let size = [sources.len(), sources.iter().map(lines).sum(), sources.iter().map(tokens).sum()];
        all = [0, 1, 2].map(|which| all[which] + size[which]);
        println!("{folder:24} {:>8} {:>8} {:>10}", size[0], size[1], size[2]);
    }
    println!("{:24} {:>8} {:>8} {:>10}", "together", all[0], all[1], all[2]);
}

/// Lines up to the tests at the end of the file.
fn lines(source: &Source) -> usize {
    source.text.lines().take_while(|line| line.trim() != "#[cfg(test)]").count()
}

fn tokens(source: &Source) -> usize {
    let mut all = Vec::new();
    flat(&source.tokens, &mut all);
    // A documenting comment is `#[doc = "…"]`, six tokens, or seven with `#!`.
    let is_doc = |tokens: &&[String]| tokens[1] == "(" && tokens[2] == "doc" && tokens[3] == "=";
    let documenting = all.windows(4).filter(is_doc);
    all.len() - documenting.map(|tokens| if tokens[0] == "!" { 7 } else { 6 }).sum::<usize>()
}
