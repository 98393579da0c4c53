//! Scripts and recipes of this repository, run as schedulers and CI systems run them.

use super::{Outcome, Place, Vulkan, outcome};
use saphyr::{LoadableYamlNode, Yaml};
use std::path::Path;
use std::process::{Command, Stdio};

/// Variables of an environment.
pub(crate) type Variables<'v> = [(&'v str, &'v str)];

/// A shell of a machine with lavapipe and the command. Nothing that the caller's machine says of drivers or jobs is there.
pub(crate) fn shell(place: &Place, program: &str, arguments: &[&str], variables: &Variables<'_>) -> Outcome {
    let command = Path::new(env!("CARGO_BIN_EXE_framewright")).parent().expect("its folder");
    let path = format!("{}:{}", command.display(), std::env::var("PATH").expect("PATH"));
    let mut shell = Command::new(program);
    shell.args(arguments).current_dir(place.path("")).stdin(Stdio::null()).env("PATH", path);
    for (name, _) in std::env::vars_os() {
        if ["VK_", "SLURM_", "JOB_"].iter().any(|begin| name.to_string_lossy().starts_with(begin)) {
            shell.env_remove(name);
        }
    }
    shell.envs(Vulkan::LAVAPIPE.variables().expect("lavapipe")).envs(variables.iter().copied());
    outcome(&mut shell)
}

/// The documents of a YAML file.
pub(crate) fn documents(file: &Path) -> Vec<Yaml<'static>> {
    // Parsed texts live as long as the test.
    let file = std::fs::read_to_string(file).expect("a file");
    Yaml::load_from_str(file.leak()).expect("YAML")
}

/// The text that a node of YAML is.
#[track_caller]
pub(crate) fn text<'y>(yaml: &'y Yaml<'_>) -> &'y str {
    yaml.as_str().unwrap_or_else(|| panic!("{yaml:?} is no text"))
}

/// The step of a job of GitHub Actions that has this name.
#[track_caller]
pub(crate) fn step(workflow: &Yaml<'static>, job: &str, name: &str) -> Yaml<'static> {
    let mut steps = workflow["jobs"][job]["steps"].as_sequence().expect("steps").iter();
    let found = steps.find(|step| step.as_mapping_get("name").is_some_and(|own| text(own) == name));
    found.unwrap_or_else(|| panic!("no step `{name}`")).clone()
}
