//! The archive of a release: the command in it works wherever it is unpacked, with nothing of the repository around it.
#![cfg(unix)]

use crate::testing::{Place, Vulkan, outcome, repository};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Packs the command that these tests run, into a folder.
fn pack(folder: &Path) -> PathBuf {
    let mut script = Command::new(repository(".ci/release.sh"));
    // Packing faster changes no file.
    script.arg("--command").arg(env!("CARGO_BIN_EXE_framewright")).arg(folder).env("XZ_OPT", "-0");
    let said = outcome(&mut script).exits(0).out;
    PathBuf::from(said.trim_end())
}

#[test]
fn the_same_files_give_the_same_archive_whose_command_works_wherever_it_is_unpacked() {
    let place = Place::new();
    let [archive, again] = ["archives", "again"].map(|folder| pack(&place.path(folder)));
    assert!(fs::read(&archive).expect("packed") == fs::read(again).expect("packed"), "they differ");
    let name = archive.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_suffix(".tar.xz"));
    let name = name.expect("a packed archive");
    let begins = concat!("framewright-", env!("CARGO_PKG_VERSION"), "-");
    assert!(name.strip_prefix(begins).is_some_and(|target| target.contains(std::env::consts::ARCH)), "{name}");
    outcome(Command::new("tar").arg("-xf").arg(&archive).arg("-C").arg(place.path(""))).exits(0);

    let unpacked = place.path(name);
    for file in ["README.md", "LICENSE-MIT", "LICENSE-APACHE", "docs/command.md", "shaders/lit.frag"] {
        let packed = fs::read(unpacked.join(file)).expect(file);
        assert_eq!(packed, fs::read(repository(file)).expect(file), "{file}");
    }
    let packages = fs::read_to_string(unpacked.join("licences/packages.txt")).expect("a list");
    let ash = packages.lines().find(|line| line.starts_with("ash v")).expect("a package of the command");
    let version = ash.split([' ', ':']).nth(1).and_then(|version| version.strip_prefix('v')).expect("a version");
    assert!(ash.contains("MIT OR Apache-2.0"), "{ash}");
    assert!(unpacked.join(format!("licences/ash-{version}/LICENSE-MIT")).exists(), "{ash}");

    // Pipelines of the archive, and the shipped ones without the archive.
    fs::create_dir(place.path("alone")).expect("made");
    let alone = place.path("alone/framewright");
    fs::copy(unpacked.join("framewright"), &alone).expect("copied");
    let run = |command: &Path, folder: &Path, arguments: &[&str], variables: &[(&str, &str)]| {
        let home = ("HOME", place.path("home"));
        let mut command = Command::new(command);
        command.args(arguments).current_dir(folder).env_clear().env(home.0, home.1).envs(variables.iter().copied());
        outcome(&mut command)
    };
    run(&unpacked.join("framewright"), &unpacked, &["check", "examples/pipelines/shadows.ron"], &[]).exits(0);
    run(&alone, &place.path("alone"), &["check", "shadows"], &[]).exits(0);
    // The compiler for pages lies beside the command.
    let page = ["inspect", "post", "--format", "html", "--what-if", "-o", "post.html"];
    run(&unpacked.join("framewright"), &place.path("alone"), &page, &[]).exits(0);
    if let Some(variables) = Vulkan::LAVAPIPE.variables() {
        let draw = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "16x9", "-o", "a.png"];
        run(&alone, &place.path("alone"), &draw, &variables).exits(0);
        assert!(place.path("alone/a.png").exists());
    }
}
