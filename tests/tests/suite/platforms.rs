//! What differs between operating systems stands in one file of a crate, so that porting is reading three files.

use framewright_tests::render::in_repository;
use std::path::Path;

/// Marks of code that asks for an operating system, or calls one.
const MARKS: [&str; 8] =
    ["std::os::", "nix::", "libc::", "cfg(unix", "cfg(windows", "cfg!(unix", "cfg!(windows", "target_os"];

/// The files below a folder with such a mark outside their tests, which stand last.
fn marked(src: &Path, folder: &Path, found: &mut Vec<String>) {
    for entry in folder.read_dir().expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            marked(src, &path, found);
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        let tests = ["#[cfg(test)]", "#[cfg(all(test"].iter().filter_map(|mark| text.find(mark)).min();
        let code = &text[..tests.unwrap_or(text.len())];
        if path.extension().is_some_and(|end| end == "rs") && MARKS.iter().any(|mark| code.contains(mark)) {
            found.push(path.strip_prefix(src).expect("below it").display().to_string());
        }
    }
}

#[test]
fn one_file_of_a_crate_knows_operating_systems() {
    let expected: [(&str, &[&str]); 8] = [
        ("graph", &["base/machine.rs", "base/read_files.rs"]),
        ("backend-vulkan", &["base/platform.rs"]),
        ("passes", &[]),
        ("framewright", &[]),
        ("framewright/lab", &[]),
        ("framewright/viewer", &[]),
        ("framewright/viewer/what-if", &[]),
        ("cli", &["system/platform.rs"]),
    ];
    for (name, files) in expected {
        let src = in_repository(name).join("src");
        let mut found = Vec::new();
        marked(&src, &src, &mut found);
        assert_eq!(found, files, "{name}/src");
    }
}
