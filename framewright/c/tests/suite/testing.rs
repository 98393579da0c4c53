//! Programs in C: built, and run.

use framewright_tests::render::in_repository;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// What every program is compiled with.
const FLAGS: [&str; 5] = ["-std=c11", "-pedantic", "-Wall", "-Wextra", "-Werror"];

/// The folder of the shared library, which Cargo builds for these tests.
fn library() -> PathBuf {
    let tests = std::env::current_exe().expect("a path");
    tests.parent().expect("a folder").to_owned()
}

/// Whether the machine has a tool. With `CI` set it must.
pub(crate) fn has(tool: &str) -> bool {
    let there = Command::new(tool).arg("--version").output().is_ok();
    assert!(there || std::env::var_os("CI").is_none(), "in CI this is a failure: there is no {tool}");
    if !there {
        eprintln!("SKIPPED: there is no {tool}");
    }
    there
}

/// Whether the machine has Vulkan's headers, which programs need.
pub(crate) fn has_headers() -> bool {
    let there = Path::new("/usr/include/vulkan/vulkan_core.h").exists();
    assert!(there || std::env::var_os("CI").is_none(), "in CI this is a failure: apt-get install libvulkan-dev");
    if !there {
        eprintln!("SKIPPED: apt-get install libvulkan-dev");
    }
    there
}

/// Runs a compiler, and expects that it has nothing to say.
pub(crate) fn compile(compiler: &str, arguments: &[&str]) {
    let folders = ["framewright/c", "framewright/c/tests/programs"].map(in_repository);
    let folders = folders.iter().flat_map(|folder| ["-I".as_ref(), folder.as_os_str()]);
    let out = Command::new(compiler).args(arguments).args(folders).output();
    let out = out.expect("it runs");
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(out.status.success() && said.is_empty(), "{compiler} {arguments:?}: {said}");
}

/// A program that was built, in a folder of its own.
pub(crate) struct Program(TempDir);

impl Program {
    /// Builds the program of a text.
    pub(crate) fn of(text: &str) -> Program {
        Program::with(text, &[])
    }

    /// Builds it by further options of the compiler.
    pub(crate) fn with(text: &str, options: &[&str]) -> Program {
        let folder = tempfile::tempdir().expect("a folder");
        let source = folder.path().join("program.c");
        std::fs::write(&source, text).expect("written");
        let (source, built) = (source.to_string_lossy().into_owned(), folder.path().join("program"));
        let search = format!("-L{}", library().display());
        let linked = ["-o", &built.to_string_lossy(), &source, &search, "-lframewright_c", "-lvulkan"];
        compile("cc", &[&FLAGS[..], options, &linked[..]].concat());
        Program(folder)
    }

    /// Runs it with arguments and variables.
    pub(crate) fn run(&self, arguments: &[&str], variables: &[(&str, &str)]) -> Output {
        self.command(arguments, variables).output().expect("it runs")
    }

    /// The command that runs it.
    pub(crate) fn command(&self, arguments: &[&str], variables: &[(&str, &str)]) -> Command {
        let mut command = Command::new(self.path("program"));
        command.args(arguments).envs(variables.iter().copied()).env("LD_LIBRARY_PATH", library());
        command.current_dir(self.0.path());
        command
    }

    /// The path of one of its files.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}

/// A text of the repository.
pub(crate) fn text(path: &str) -> String {
    std::fs::read_to_string(in_repository(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}
