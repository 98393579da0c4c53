//! Runs the built `framewright` as a user would, and tells what came of it.

pub(crate) mod browser;
pub(crate) mod firefox;
pub(crate) mod results;
pub(crate) mod server;
#[cfg(unix)]
pub(crate) mod shell;

use framewright_graph::device::Profile;
use framewright_tests::drivers::{CURRENT_LAYER, DISTRIBUTION_LAYERS, Driver};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The text of the shipped pipeline `forward`.
pub(crate) const FORWARD: &str = include_str!("../../../../examples/pipelines/forward.ron");

/// The outcome of a command.
#[derive(Debug)]
pub(crate) struct Outcome {
    /// Exit code.
    pub(crate) code: Option<i32>,
    /// Standard output.
    pub(crate) out: String,
    /// Standard error.
    pub(crate) err: String,
}

impl Outcome {
    /// Asserts the exit code, and shows all that was said if it is another.
    #[track_caller]
    pub(crate) fn exits(self, code: i32) -> Outcome {
        assert_eq!(self.code, Some(code), "\n--- stdout\n{}\n--- stderr\n{}", self.out, self.err);
        self
    }

    /// Asserts that standard error is exactly `expected`.
    #[track_caller]
    pub(crate) fn says(self, expected: &str) -> Outcome {
        assert_eq!(self.said(expected).trim_end(), expected.trim(), "\n--- stderr was\n{}", self.err);
        self
    }

    /// Asserts that standard error holds `expected`.
    #[track_caller]
    pub(crate) fn mentions(self, expected: &str) -> Outcome {
        assert!(self.said(expected).contains(expected), "`{expected}` is not in\n{}", self.err);
        self
    }

    /// Standard error, without codes of mistakes unless `expected` has one: a test that is about words says nothing of the code.
    fn said(&self, expected: &str) -> String {
        if expected.contains("[E") { self.err.clone() } else { without_codes(&self.err) }
    }
}

/// A text without the codes of mistakes.
pub(crate) fn without_codes(text: &str) -> String {
    let mut parts = text.split(" [E");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |shown, part| match part.split_once(']') {
        Some((number, after)) if number.len() == 4 && number.bytes().all(|it| it.is_ascii_digit()) => shown + after,
        _ => shown + " [E" + part,
    })
}

/// The command, in a folder of its own: no test sees another's files.
pub(crate) struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    /// A new, empty folder.
    pub(crate) fn new() -> Place {
        Place { folder: tempfile::tempdir().expect("a folder") }
    }

    /// A path in it.
    pub(crate) fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A file in it.
    pub(crate) fn file(&self, name: impl AsRef<Path>, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, contents).expect("written");
        path
    }

    /// Names of the files in it.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.folder.path())
            .expect("listed")
            .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// The command in this folder, without any of the caller's Vulkan settings.
    pub(crate) fn command<A: AsRef<OsStr>>(&self, arguments: &[A]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_framewright"));
        command.args(arguments).current_dir(self.folder.path()).stdin(Stdio::null());
        for (name, _) in std::env::vars_os() {
            if name.to_string_lossy().starts_with("VK_") {
                command.env_remove(name);
            }
        }
        command
    }

    /// Runs the command in this folder.
    pub(crate) fn run<A: AsRef<OsStr>>(&self, arguments: &[A]) -> Outcome {
        outcome(&mut self.command(arguments))
    }

    /// Runs the command in this folder with some variables set.
    pub(crate) fn run_with<A: AsRef<OsStr>>(&self, variables: &[(&str, &str)], arguments: &[A]) -> Outcome {
        outcome(self.command(arguments).envs(variables.iter().copied()))
    }
}

/// The shipped pipeline `forward` with one piece of text replaced.
pub(crate) fn forward_with(old: &str, new: &str) -> String {
    assert!(FORWARD.contains(old), "forward.ron no longer holds {old}");
    FORWARD.replacen(old, new, 1)
}

/// The answer of `check` for a pipeline file.
pub(crate) fn check(contents: impl AsRef<[u8]>) -> Outcome {
    let place = Place::new();
    place.file("p.ron", contents);
    place.run(&["check", "p.ron"])
}

/// The profile that the command saves of the driver that these variables lead to.
pub(crate) fn live_profile(variables: &[(&str, &str)]) -> Profile {
    let place = Place::new();
    place.run_with(variables, &["devices", "--save", "live.ron", "--device", "0"]).exits(0);
    let text = std::fs::read_to_string(place.path("live.ron")).expect("it is written");
    Profile::from_ron(&text).expect("a profile")
}

/// Runs a command.
pub(crate) fn outcome(command: &mut Command) -> Outcome {
    let output = command.output().expect("the command starts");
    Outcome {
        code: output.status.code(),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// The names of all pipelines that are shipped, sorted.
pub(crate) fn shipped_pipelines() -> Vec<String> {
    let files = repository("examples/pipelines").read_dir().expect("the folder of shipped pipelines");
    let paths = files.map(|file| file.expect("an entry").path()).filter(|path| path.is_file());
    let mut names: Vec<String> = paths.map(|path| path.file_stem().expect("a name").display().to_string()).collect();
    names.sort();
    assert!(names.len() > 10, "{names:?}");
    names
}

/// A folder or file of this repository.
pub(crate) fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The README and all pages under `docs/`, sorted.
pub(crate) fn pages() -> Vec<PathBuf> {
    let files = repository("docs").read_dir().expect("the folder of pages").map(|file| file.expect("an entry").path());
    let pages = files.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let mut pages: Vec<PathBuf> = pages.chain([repository("README.md")]).collect();
    pages.sort();
    pages
}

/// A driver and a validation layer of this machine.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vulkan {
    driver: Driver,
    layer: Option<Layer>,
}

/// A validation layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Layer {
    Current,
    Distribution,
}

impl Vulkan {
    /// Lavapipe alone.
    pub(crate) const LAVAPIPE: Vulkan = Vulkan { driver: Driver::Lavapipe, layer: None };
    /// Lavapipe under the current layer.
    pub(crate) const LAVAPIPE_CURRENT: Vulkan = Vulkan { driver: Driver::Lavapipe, layer: Some(Layer::Current) };
    /// Lavapipe under the distribution's layer.
    pub(crate) const LAVAPIPE_OLD: Vulkan = Vulkan { driver: Driver::Lavapipe, layer: Some(Layer::Distribution) };
    /// SwiftShader alone.
    pub(crate) const SWIFTSHADER: Vulkan = Vulkan { driver: Driver::SwiftShader, layer: None };
    /// SwiftShader under the current layer.
    pub(crate) const SWIFTSHADER_CURRENT: Vulkan = Vulkan { driver: Driver::SwiftShader, layer: Some(Layer::Current) };

    /// Whether it is lavapipe.
    pub(crate) fn is_lavapipe(self) -> bool {
        self.driver == Driver::Lavapipe
    }

    /// Whether its layer sees hazards of dynamic rendering: one that takes settings does.
    pub(crate) fn layer_sees_attachments(self) -> bool {
        let manifest = || std::fs::read_to_string(format!("{DISTRIBUTION_LAYERS}/VkLayer_khronos_validation.json"));
        match self.layer {
            None => false,
            Some(Layer::Current) => true,
            Some(Layer::Distribution) => manifest().is_ok_and(|text| text.contains("VK_EXT_layer_settings")),
        }
    }

    /// The variables that lead to it; `None`, with a word on why, if tests shall not run on it or it isn't installed. In CI
    /// a driver or layer that isn't installed is a failure.
    pub(crate) fn variables(self) -> Option<Vec<(&'static str, &'static str)>> {
        let name = self.driver.name();
        if !self.driver.is_tested() {
            eprintln!("skipped: FRAMEWRIGHT_TEST_DEVICE asks for another driver than {name}");
            return None;
        }
        let layer = match self.layer {
            None => "/",
            Some(Layer::Current) => CURRENT_LAYER,
            Some(Layer::Distribution) => DISTRIBUTION_LAYERS,
        };
        let Some(driver) = self.driver.manifest().filter(|_| Path::new(layer).exists()) else {
            assert!(std::env::var_os("CI").is_none(), "{name} or {layer} is missing, and CI must have it: run ./test");
            eprintln!("skipped: {name} or {layer} is missing");
            return None;
        };
        let mut variables = vec![("VK_DRIVER_FILES", driver), ("VK_ICD_FILENAMES", driver)];
        if self.layer == Some(Layer::Distribution) {
            variables.push(("VK_LAYER_PATH", DISTRIBUTION_LAYERS));
        }
        Some(variables)
    }
}
