//! Cargo finds test programs by itself, but not the modules of one: a file that no module declares would never be tested.

use framewright_tests::render::in_repository;
use std::path::{Path, PathBuf};

/// Files and folders below this one that their parent declares as no module.
fn undeclared(folder: &Path) -> Vec<PathBuf> {
    let parents = [folder.join("main.rs"), folder.join("mod.rs"), folder.with_extension("rs")];
    let parent = parents.iter().find(|file| file.exists());
    let text = parent.map(|file| std::fs::read_to_string(file).expect("a text")).unwrap_or_default();
    let declares = |module: &str| {
        let line = format!("mod {module};");
        text.lines().any(|it| it.trim_start_matches("pub(crate) ") == line)
    };
    let mut found = Vec::new();
    for entry in folder.read_dir().expect("a folder") {
        let path = entry.expect("an entry").path();
        let module = path.file_stem().and_then(|stem| stem.to_str()).expect("a name");
        let is_module = path.join("mod.rs").exists() || path.extension().is_some_and(|end| end == "rs");
        if is_module && !["main", "mod"].contains(&module) && !declares(module) {
            found.push(path.clone());
        }
        if path.is_dir() {
            found.extend(undeclared(&path));
        }
    }
    found
}

#[test]
fn every_file_of_a_test_program_is_a_module_of_it() {
    let folders = |folder: &Path| {
        let entries = folder.read_dir().into_iter().flatten().map(|entry| entry.expect("an entry").path());
        entries.filter(|path| path.is_dir()).collect::<Vec<_>>()
    };
    let within =
        ["framewright/c", "framewright/lab", "framewright/viewer", "framewright/viewer/what-if"].map(in_repository);
    let folders_of_packages = folders(&in_repository("")).into_iter().chain(within);
    let packages = folders_of_packages.filter(|folder| folder.join("Cargo.toml").exists());
    let programs = packages.flat_map(|package| folders(&package.join("tests")));
    let programs: Vec<_> = programs.filter(|folder| folder.join("main.rs").exists()).collect();
    assert!(programs.contains(&in_repository("tests/tests/suite")), "{programs:?}");
    for program in programs {
        assert_eq!(undeclared(&program), [] as [PathBuf; 0], "declare them by `mod`");
    }
}
