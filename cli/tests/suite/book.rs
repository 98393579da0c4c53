//! The README and the pages under `docs/`, which are an mdBook: all are listed, and all that they point to is there.

use crate::testing::{pages, repository};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Words that the README may have, code included, as `wc -w` counts them.
const MOST_WORDS: usize = 1300;

#[test]
fn the_readme_is_read_in_one_sitting() {
    let words = text(&repository("README.md")).split_whitespace().count();
    assert!(words <= MOST_WORDS, "README.md has {words} words, of at most {MOST_WORDS}");
}

#[test]
fn the_summary_lists_every_page_once() {
    let listed: Vec<String> = links(&text(&repository("docs/SUMMARY.md")));
    let once: BTreeSet<&String> = listed.iter().collect();
    assert_eq!(once.len(), listed.len(), "docs/SUMMARY.md lists a page twice: {listed:?}");
    let name = |page: PathBuf| page.file_name().expect("a name").to_string_lossy().into_owned();
    let docs = pages().into_iter().filter(|page| page.parent() == Some(&*repository("docs")));
    let there: Vec<String> = docs.map(name).filter(|name| name != "SUMMARY.md").collect();
    assert_eq!(once, there.iter().collect(), "listed in docs/SUMMARY.md, and there");
}

#[test]
fn every_link_leads_somewhere() {
    let mut links_of_all = 0;
    let mut wrong = Vec::new();
    for page in pages() {
        let links = links(&text(&page));
        links_of_all += links.len();
        let broken =
            links.iter().filter_map(|link| Some(format!("{}: {link}: {}", page.display(), problem(&page, link)?)));
        wrong.extend(broken);
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(links_of_all > 150, "{links_of_all} links");
}

/// The mistake of a link of a page.
fn problem(page: &Path, link: &str) -> Option<&'static str> {
    if link.starts_with("https://") {
        return None;
    }
    let (path, anchor) = link.split_once('#').map_or((link, None), |(path, anchor)| (path, Some(anchor)));
    let target = match path {
        "" => page.to_owned(),
        path => page.parent().expect("a folder").join(path),
    };
    // mdBook turns `.md` into `.html`, which is there for pages of the book alone; the book lies just as deep as `docs/`.
    let leaves = path.starts_with("../");
    if leaves && (path.ends_with(".md") || path.starts_with("../../")) {
        return Some("leads out of the book");
    }
    if !target.exists() {
        return Some("there is no such file");
    }
    let missing = anchor.is_some_and(|anchor| !anchors(&text(&target)).contains(anchor));
    missing.then_some("there is no such heading")
}

/// Paths of this repository that stand in pages as code.
#[test]
fn every_path_that_is_named_exists() {
    let folders = [
        "backend-vulkan/",
        "cli/",
        "docs/",
        "examples/",
        "framewright/",
        "graph/",
        "passes/",
        "shaders/",
        "tests/",
        ".ci/",
    ];
    let mut named = 0;
    let mut missing = Vec::new();
    for page in pages() {
        let text = prose(&text(&page));
        let code = text.split('`').skip(1).step_by(2).filter(|code| !code.contains(' '));
        for path in code.filter(|code| folders.iter().any(|folder| code.starts_with(folder))) {
            named += 1;
            if !repository(path).exists() {
                missing.push(format!("{}: {path}", page.display()));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
    assert!(named > 30, "{named} paths");
}

fn text(page: &Path) -> String {
    std::fs::read_to_string(page).expect("a page")
}

/// A page without its blocks of code.
fn prose(page: &str) -> String {
    let mut code = false;
    let lines = page.lines().filter(|line| {
        let fence = line.trim_start().starts_with("```");
        code ^= fence;
        !code && !fence
    });
    lines.map(|line| line.to_owned() + "\n").collect()
}

/// Where the links of a page lead: `[text](link)` and `[text]: link`.
fn links(page: &str) -> Vec<String> {
    let prose = prose(page);
    // Text between backticks is code.
    let plain: String = prose.split('`').step_by(2).collect::<Vec<_>>().join("code");
    let inline = plain.split("](").skip(1).filter_map(|after| Some(after.split_once(')')?.0.to_owned()));
    let defined = plain.lines().filter(|line| line.starts_with('[')).filter_map(|line| line.split_once("]: "));
    inline.chain(defined.map(|(_, link)| link.to_owned())).filter(|link| !link.contains(' ')).collect()
}

/// The anchors of a page's headings, as code hosts and mdBook make them.
fn anchors(page: &str) -> BTreeSet<String> {
    let prose = prose(page);
    let headings = prose.lines().filter(|line| line.starts_with('#'));
    let anchor = |line: &str| {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let kept = title.chars().filter(|letter| letter.is_alphanumeric() || " -_".contains(*letter));
        kept.collect::<String>().replace(' ', "-")
    };
    headings.map(anchor).collect()
}
