//! The repository itself: its texts are the same in every checkout, and no script goes to a machine of its own choice.

use framewright_tests::render::in_repository;
use std::process::Command;

/// How git keeps each of its files and how they lie here, a line each; `None` where this is no repository, as in an archive.
fn line_endings() -> Option<String> {
    let mut git = Command::new("git");
    git.args(["-c", "safe.directory=*", "ls-files", "--eol"]).current_dir(in_repository(""));
    let listed = git.output().ok().filter(|listed| listed.status.success());
    if listed.is_none() {
        assert!(std::env::var_os("CI").is_none(), "git lists no files");
        eprintln!("skipped: git lists no files");
    }
    String::from_utf8(listed?.stdout).ok()
}

/// Golden files are compared byte by byte, and digests are made of texts (PF-2).
#[test]
fn every_text_of_the_repository_has_line_feeds_alone_in_every_checkout() {
    let Some(listed) = line_endings() else { return };
    assert!(listed.lines().count() > 1000);
    let is_wrong = |line: &&str| {
        // As it is kept, as it lies here, and what is asked for.
        let words: Vec<&str> = line.split_whitespace().collect();
        let fine = |word: &str| ["i/lf", "w/lf", "i/none", "w/none"].contains(&word);
        let is_text = words[0] != "i/-text" && words[0] != "i/";
        is_text && !(fine(words[0]) && fine(words[1]) && words[2..4] == ["attr/text=auto", "eol=lf"])
    };
    let wrong: Vec<&str> = listed.lines().filter(is_wrong).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// `.ci/debian.sh make`, where apt knows these mirrors, and `mmdebstrap` only tells how it was called.
#[cfg(unix)]
fn make_debian(suite: &[&str], mirrors: &str) -> (Option<i32>, String, Option<String>) {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    std::fs::create_dir(path("bin")).expect("made");
    for (name, script) in [
        ("id", "echo 0"),
        ("apt-get", "[ \"$1\" != indextargets ] || cat \"$PLACE/mirrors\""),
        ("mmdebstrap", "echo \"$@\" >\"$PLACE/called\"; exit 1"),
    ] {
        let file = path("bin").join(name);
        std::fs::write(&file, format!("#!/bin/sh\n{script}\n")).expect("written");
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o755)).expect("set");
    }
    std::fs::write(path("mirrors"), mirrors).expect("written");
    let mut script = Command::new(in_repository(".ci/debian.sh"));
    script.arg("make").args(suite).env("PLACE", folder.path()).env("XDG_CACHE_HOME", folder.path());
    script.env("PATH", format!("{}:{}", path("bin").display(), std::env::var("PATH").expect("PATH")));
    script.env_remove("FRAMEWRIGHT_DEBIAN").env_remove("FRAMEWRIGHT_DEBIAN_SUITE");
    let ended = script.output().expect("it runs");
    let called = std::fs::read_to_string(path("called")).ok();
    let called = called.map(|called| called.replace(&folder.path().display().to_string(), "CACHE"));
    (ended.status.code(), String::from_utf8_lossy(&ended.stderr).into_owned(), called)
}

#[cfg(unix)]
#[test]
fn another_debian_is_made_of_the_suite_that_is_asked_for_from_the_mirror_that_apt_knows() {
    let text = std::fs::read_to_string(in_repository(".ci/debian.sh")).expect("a script");
    assert!(!text.contains("://"), "it knows a mirror of its own");
    // Where apt knows no mirror, as on Ubuntu, there is none.
    for none in ["", "file:/media/disc\ncdrom://disc\n"] {
        let (code, said, called) = make_debian(&[], none);
        assert_eq!((code, called), (Some(3), None), "{said}");
        assert!(said.contains("error: apt knows no mirror of Debian on this machine"), "{said}");
    }
    for (suite, name) in [(&[][..], "trixie"), (&["sid"], "sid"), (&["forky"], "forky")] {
        let (code, said, called) =
            make_debian(suite, "file:/a\nhttp://near.example/debian\nhttp://far.example/debian\n");
        assert_eq!(code, Some(3), "{said}");
        let called = called.unwrap_or_else(|| panic!("{said}"));
        let expected = format!(" {name} CACHE/framewright/debian-{name} http://near.example/debian\n");
        assert!(called.ends_with(&expected), "{called}");
    }
}
