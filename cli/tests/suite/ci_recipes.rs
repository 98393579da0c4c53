//! The recipes that check pipelines in CI: their steps are run in a plain shell, in a repository that is right and with planted
//! mistakes (IN-10).
#![cfg(unix)]

use crate::testing::shell::{Variables, documents, shell, step, text};
use crate::testing::{Outcome, Place, Vulkan, repository};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

const RESULTS: &str = "framewright-results";
/// Small pictures, in a test that draws many.
const SMALL: (&str, &str) = ("SIZE", "48x27");

fn recipe(name: &str) -> PathBuf {
    repository("examples/ci").join(name)
}

/// A user's repository with a pipeline, its right picture, a budget that it keeps, and the scripts; `None` without lavapipe.
fn user_repository() -> Option<Place> {
    Vulkan::LAVAPIPE.variables()?;
    let place = Place::new();
    for folder in ["ci", "pipelines", "budgets"] {
        std::fs::create_dir(place.path(folder)).expect("made");
    }
    for script in ["check.sh", "install.sh"] {
        std::fs::copy(recipe(script), place.path("ci").join(script)).expect("copied");
    }
    place.run(&["new", "pipelines/first"]).exits(0);
    place.file(
        "budgets/first.ron",
        "Budget(version: 1, limits: [(resolves: 1), (settings: {\"msaa\": 1}, resolves: 0)])",
    );
    let accepted = check(&place, &["--accept", "pipelines/first.ron"], &[]).exits(0).out;
    assert!(accepted.contains("written: goldens/first.png"), "{accepted}");
    Some(place)
}

fn check(place: &Place, arguments: &[&str], variables: &Variables<'_>) -> Outcome {
    shell(place, "ci/check.sh", arguments, &[&[SMALL], variables].concat())
}

/// The text of a file of the results.
#[track_caller]
fn result(place: &Place, name: &str) -> String {
    let path = place.path(RESULTS).join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn has(place: &Place, name: &str) -> bool {
    place.path(RESULTS).join(name).metadata().is_ok_and(|file| file.len() > 0)
}

/// The rules of the findings in the SARIF file.
fn rules(place: &Place) -> Vec<String> {
    let sarif: Value = serde_json::from_str(&result(place, "sarif/first.sarif")).expect("JSON");
    let results = sarif["runs"][0]["results"].as_array().expect("results");
    results.iter().map(|result| result["ruleId"].as_str().expect("a rule").to_owned()).collect()
}

/// Puts one text for another in a file of the repository.
fn edit(place: &Place, file: &str, old: &str, new: &str) {
    let text = std::fs::read_to_string(place.path(file)).expect("a file");
    assert!(text.contains(old), "{file} has no {old}");
    place.file(file, text.replace(old, new));
}

#[test]
fn the_steps_of_both_recipes_pass_in_a_right_repository_and_fail_with_a_mistake() {
    let Some(place) = user_repository() else { return };
    let workflow = documents(&recipe("github_actions.yml")).remove(0);
    let github = step(&workflow, "check", "check");
    let gitlab = &documents(&recipe("gitlab.yml"))[0]["pipelines"];
    let script = gitlab["script"].as_sequence().expect("lines");
    let [_, line] = &script[..] else { panic!("{script:?}") };
    let run = || {
        let variables = [SMALL, ("REPORTS", text(&github["env"]["REPORTS"]))];
        let first = shell(&place, "sh", &["-e", "-c", text(&github["run"])], &variables);
        let sarif = has(&place, "sarif/first.sarif");
        let variables = [SMALL, ("REPORTS", text(&gitlab["variables"]["REPORTS"]))];
        let second = shell(&place, "bash", &["-e", "-o", "pipefail", "-c", text(line)], &variables);
        assert!(sarif && has(&place, "junit/first.xml") && has(&place, "reports/first.json"));
        assert!(has(&place, "pictures/first.png") && has(&place, "pages/first.html"));
        let page = std::fs::read_to_string(place.path(RESULTS).join("pages/first.html")).expect("written");
        assert!(page.contains("\"numbers\":\"srgb\",\"data\":\""), "the page holds its pictures");
        [first, second]
    };
    for outcome in run() {
        let out = outcome.exits(0).out;
        assert_eq!(out.matches("fine: first: ").count(), 4, "{out}");
    }
    assert!(
        !place.path(RESULTS).join("sarif").exists(),
        "the second recipe asks for no SARIF, and the first's is gone"
    );
    assert!(result(&place, "junit/first.xml").contains("failures=\"0\""));
    edit(&place, "budgets/first.ron", "resolves: 1)", "resolves: 0)");
    for outcome in run() {
        let out = outcome.exits(1).out;
        assert!(out.contains("the budget is exceeded: resolves 1, and at most 0 are allowed"), "{out}");
    }
    assert!(result(&place, "junit/first.xml").contains("failures=\"1\""));
}

#[test]
fn the_recipes_keep_what_the_script_leaves_also_of_a_failure() {
    let workflow = documents(&recipe("github_actions.yml")).remove(0);
    let steps = workflow["jobs"]["check"]["steps"].as_sequence().expect("steps");
    let of = |action: &str| {
        let mut steps = steps.iter().filter(|step| step.as_mapping_get("uses").is_some());
        let found = steps.find(|step| text(&step["uses"]).starts_with(&format!("{action}@v")));
        found.unwrap_or_else(|| panic!("no step uses {action}"))
    };
    for upload in ["github/codeql-action/upload-sarif", "actions/upload-artifact"] {
        assert!(text(&of(upload)["if"]).contains("!cancelled()"), "{upload} is skipped where a step before failed");
    }
    assert_eq!(text(&of("github/codeql-action/upload-sarif")["with"]["sarif_file"]), format!("{RESULTS}/sarif"));
    assert_eq!(text(&of("actions/upload-artifact")["with"]["path"]), RESULTS);
    assert_eq!(text(&workflow["permissions"]["security-events"]), "write");
    let gitlab = &documents(&recipe("gitlab.yml"))[0]["pipelines"];
    let artifacts = &gitlab["artifacts"];
    assert_eq!(text(&artifacts["when"]), "always");
    assert_eq!(text(&artifacts["paths"][0]), format!("{RESULTS}/"));
    assert_eq!(text(&artifacts["reports"]["junit"]), format!("{RESULTS}/junit/*.xml"));
    // Both build in the container that Containerfile builds in.
    let containerfile = std::fs::read_to_string(recipe("Containerfile")).expect("a file");
    for image in [text(&workflow["jobs"]["check"]["container"]), text(&gitlab["image"])] {
        assert!(containerfile.contains(&format!("FROM {image} AS build")), "{image}");
    }
}

#[test]
fn each_planted_mistake_fails_and_leaves_what_shows_it() {
    let Some(place) = user_repository() else { return };
    let pipeline = "pipelines/first.ron";
    let right = std::fs::read_to_string(place.path(pipeline)).expect("written");

    // A variant that is broken. The default one is not, and is drawn.
    edit(&place, pipeline, "samples: Like(\"color\")", "samples: 4");
    let said = check(&place, &[pipeline], &[]).exits(1);
    assert!(said.out.contains("breaks with --set msaa=1"), "{}", said.out);
    assert!(said.out.contains("FAILED (exit code 1): first: variants and budget\n"), "{}", said.out);
    assert_eq!(said.out.matches("FAILED").count(), 1, "{}", said.out);
    assert_eq!(rules(&place), ["E0707", "E0707"]);
    assert!(result(&place, "junit/first.xml").contains("sample counts"));
    assert!(has(&place, "pictures/first.png") && has(&place, "pages/first.html"));

    // A pipeline that is no pipeline leaves its reports.
    place.file(pipeline, "Pipeline(version: 1");
    check(&place, &[pipeline], &[]).exits(1).mentions("pipelines/first.ron:1:");
    assert_eq!(rules(&place), ["E0104"]);
    assert!(!has(&place, "pictures/first.png"));

    // A picture that is off: without a tone curve.
    place.file(pipeline, right.replace("\"reinhard\"", "\"downsample\""));
    let said = check(&place, &[pipeline], &[]).exits(1);
    assert!(
        said.out.contains("exceeded)") && said.out.contains("FAILED (exit code 1): first: picture\n"),
        "{}",
        said.out
    );
    assert!(has(&place, "pictures/first.difference.png"), "the map of the difference");
    check(&place, &[pipeline], &[("MAX_FLIP", "1")]).exits(0);
    assert!(!has(&place, "pictures/first.difference.png"));
    place.file(pipeline, &right);

    // The layer says something of the use of Vulkan: best practices are taken for mistakes here.
    let said = check(&place, &[pipeline], &[("VK_LAYER_VALIDATE_BEST_PRACTICES", "1")]);
    if Vulkan::LAVAPIPE_CURRENT.variables().is_some() {
        let said = said.exits(1);
        let line = "FAILED (exit code 1): first: drawn, and nothing said by the validation layer\n";
        assert!(said.out.contains(line), "{}", said.out);
        let report: Value = serde_json::from_str(&result(&place, "reports/first.json")).expect("JSON");
        assert!(report["validation"]["findings"].as_u64() > Some(0), "{report}");
    }

    // No right picture.
    std::fs::rename(place.path("goldens/first.png"), place.path("kept.png")).expect("moved");
    let said = check(&place, &[pipeline], &[]).exits(1);
    assert!(said.out.contains("`check.sh --accept pipelines/first.ron` makes it"), "{}", said.out);
    std::fs::rename(place.path("kept.png"), place.path("goldens/first.png")).expect("moved");
    check(&place, &[pipeline], &[]).exits(0);
}

#[test]
fn what_the_machine_or_the_command_line_lacks_is_said() {
    let Some(place) = user_repository() else { return };
    check(&place, &[], &[]).exits(2).mentions("usage: check.sh PIPELINE.ron…");
    check(&place, &["pipelines/gone.ron"], &[]).exits(1).mentions("there is no pipeline `pipelines/gone.ron`");
    assert!(!has(&place, "sarif/gone.sarif"), "an answer that is empty is no report");
    check(&place, &["pipelines/first.ron"], &[("VARIANTS", "--no-such-option")]).exits(2);
    std::fs::create_dir(place.path("more")).expect("made");
    std::fs::copy(place.path("pipelines/first.ron"), place.path("more/first.ron")).expect("copied");
    check(&place, &["pipelines/first.ron", "more/first.ron"], &[]).exits(2).mentions("have the same name");
    // Only the results of an earlier run are removed.
    std::fs::create_dir(place.path("-kept")).expect("made");
    place.file("-kept/notes.txt", "mine");
    check(&place, &["pipelines/first.ron"], &[("RESULTS", "-kept")]).exits(0);
    assert!(place.path("-kept/notes.txt").exists() && place.path("-kept/pictures/first.png").exists());
    // Defaults that are wrong, where the variants that are asked for are right.
    let text = std::fs::read_to_string(place.path("pipelines/first.ron")).expect("a file");
    let off = "passes: [\n(name: \"late\", when: \"msaa == 4\", draw: FullScreen(\"gone\"), color: [\"screen\"]),";
    place.file("pipelines/four.ron", text.replacen("passes: [", off, 1));
    let said = check(&place, &["pipelines/four.ron"], &[("VARIANTS", "--set msaa=1")]).exits(1).out;
    assert!(said.contains("fine: four: variants") && said.contains("FAILED (exit code 1): four: not drawn"), "{said}");
    // Options for every command.
    let low = [("VARIANTS", "--set msaa=1"), ("OPTIONS", "--set msaa=1"), ("MAX_FLIP", "1"), ("GOLDENS", "more")];
    check(&place, &["--accept", "pipelines/four.ron"], &low).exits(0);
    // A pipeline for the draws of an engine: it is checked and shown, and not drawn.
    for file in ["engine.ron", "gust.comp", "grass.frag", "grass.vert", "terrain.frag", "terrain.vert"] {
        std::fs::copy(repository("examples/custom_pass").join(file), place.path("pipelines").join(file))
            .expect("copied");
    }
    check(&place, &["pipelines/engine.ron"], &[]).exits(1);
    std::fs::create_dir(place.path("interfaces")).expect("made");
    std::fs::copy(repository("examples/custom_pass/interface.ron"), place.path("interfaces/engine.ron"))
        .expect("copied");
    let said = check(&place, &["pipelines/engine.ron"], &[]).exits(0).out;
    assert!(said.contains("fine: engine: page, without pictures"), "{said}");
    assert!(has(&place, "pages/engine.html") && !has(&place, "pictures/engine.png"));
    // A driver that isn't there.
    let no_driver = [("VK_DRIVER_FILES", "/none"), ("VK_ICD_FILENAMES", "/none")];
    let said = check(&place, &["pipelines/first.ron"], &no_driver).exits(3);
    assert!(said.out.contains("fine: first: variants and budget"), "what needs no driver is checked: {}", said.out);
    // No command.
    let mut bare = Command::new("bash");
    bare.args(["ci/check.sh", "pipelines/first.ron"]).current_dir(place.path("")).env("PATH", "/usr/bin:/bin");
    crate::testing::outcome(&mut bare).exits(3).mentions("there is no command framewright");
    // A name with everything that a shell could take for something else.
    let name = "-a b$(touch hacked)'\"*;.ron";
    std::fs::copy(place.path("pipelines/first.ron"), place.path(name)).expect("copied");
    check(&place, &["--accept", name], &[]).exits(0);
    check(&place, &[name], &[]).exits(0);
    assert!(!place.path("hacked").exists());
}

/// Programs that stand in for others: each writes its arguments to a log, a line each.
fn stand_ins(place: &Place, programs: &[&str]) -> String {
    std::fs::create_dir(place.path("bin")).expect("made");
    for program in programs {
        let path = place.file(format!("bin/{program}"), format!("#!/bin/sh\necho {program} \"$@\" >>\"$LOG\"\n"));
        let executable = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        std::fs::set_permissions(path, executable).expect("set");
    }
    format!("{}:/usr/bin:/bin", place.path("bin").display())
}

#[test]
fn installing_takes_debians_packages_and_builds_the_commit_that_the_recipe_names() {
    let workflow = documents(&recipe("github_actions.yml")).remove(0);
    let gitlab = &documents(&recipe("gitlab.yml"))[0]["pipelines"];
    let install = step(&workflow, "check", "install");
    let both = [
        (text(&install["run"]), text(&workflow["env"]["FRAMEWRIGHT"])),
        (text(&gitlab["script"][0]), text(&gitlab["variables"]["FRAMEWRIGHT"])),
    ];
    for (line, from) in both {
        let place = Place::new();
        let path = stand_ins(&place, &["apt-get", "cargo", "sudo"]);
        std::fs::create_dir(place.path("ci")).expect("made");
        std::fs::copy(recipe("install.sh"), place.path("ci/install.sh")).expect("copied");
        let run = |line: &str, path: &str| {
            let mut shell = Command::new("bash");
            shell.args(["-e", "-o", "pipefail", "-c", line]).current_dir(place.path("")).env("PATH", path);
            crate::testing::outcome(shell.env("LOG", place.path("log")).env("FRAMEWRIGHT", from))
        };
        run("ci/install.sh", &path).exits(2).mentions("usage: install.sh FOLDER");
        if !Path::new("/usr/bin/cargo").exists() {
            run("ci/install.sh .", "/usr/bin:/bin").exits(3).mentions("there is no cargo");
        }
        assert!(!place.path("log").exists());
        run(line, &path).exits(0);
        run("ci/install.sh checkout", &path).exits(0);
        let log = std::fs::read_to_string(place.path("log")).expect("a log");
        let (address, commit) = from.split_once(' ').expect("an address and a commit");
        assert!(
            log.contains(&format!("cargo install --locked --git {address} --rev {commit} framewright-cli\n")),
            "{log}"
        );
        assert!(log.contains("cargo install --locked --path checkout/cli\n"), "{log}");
        assert!(log.contains("libvulkan1 mesa-vulkan-drivers vulkan-validationlayers"), "{log}");
    }
}

/// Instructions of a Containerfile: lines that are continued are one.
fn instructions() -> Vec<(String, String)> {
    let text = std::fs::read_to_string(recipe("Containerfile")).expect("a file").replace("\\\n", " ");
    let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    let split = |line: &str| line.split_once(' ').map(|(word, rest)| (word.to_owned(), rest.to_owned()));
    lines.map(|line| split(line).expect("an instruction")).collect()
}

/// The packages that a file names behind `apt-get install`.
fn packages(command: &str) -> Vec<&str> {
    let installs = command.split("&&").filter_map(|part| part.trim().strip_prefix("apt-get install"));
    installs.flat_map(str::split_whitespace).filter(|word| !word.starts_with('-')).collect()
}

#[test]
fn the_container_is_a_debian_12_with_the_command_a_driver_and_layers() {
    let instructions = instructions();
    let of = |word: &str| {
        let found = instructions.iter().filter(|(own, _)| own == word);
        found.map(|(_, rest)| rest.as_str()).collect::<Vec<&str>>()
    };
    let known = ["FROM", "RUN", "WORKDIR", "COPY"];
    assert!(instructions.iter().all(|(word, _)| known.contains(&&**word)), "{instructions:?}");
    let workspace = std::fs::read_to_string(repository("Cargo.toml")).expect("a file");
    let rust =
        workspace.split_once("rust-version = \"").and_then(|(_, rest)| rest.split_once('"')).expect("a version").0;
    // Debian 12 is bookworm.
    let build = format!("docker.io/library/rust:{rust}-bookworm AS build");
    assert_eq!(of("FROM"), [&*build, "docker.io/library/debian:12-slim"]);
    let [build, run] = [of("RUN")[0], of("RUN")[2]].map(packages);
    assert_eq!(build, ["g++", "libshaderc-dev"]);
    for package in ["libvulkan1", "mesa-vulkan-drivers", "vulkan-validationlayers", "chromium-common"] {
        assert!(run.contains(&package), "{package} is missing: {run:?}");
    }
    for command in of("RUN") {
        let mut shell = Command::new("sh");
        crate::testing::outcome(shell.args(["-n", "-c", command])).exits(0);
    }
    if Path::new("/etc/debian_version").exists() {
        for package in build.iter().chain(&run) {
            let found = crate::testing::outcome(Command::new("apt-cache").args(["show", package])).exits(0);
            assert!(found.out.contains(&format!("Package: {package}\n")), "{}", found.out);
        }
    }
}

/// All code of a folder.
fn texts(folder: &Path) -> String {
    let entries = folder.read_dir().expect("a folder").map(|entry| entry.expect("an entry").path());
    let text = |path: PathBuf| match path.is_dir() {
        true => texts(&path),
        false if path.extension().is_some_and(|it| it == "rs") => std::fs::read_to_string(path).expect("code"),
        false => String::new(),
    };
    entries.map(text).collect()
}

/// What is copied before the command is built is a whole workspace: every crate, and every file that code includes.
#[test]
fn the_container_is_built_from_all_that_the_command_needs() {
    let instructions = instructions();
    let built = instructions.iter().position(|(_, rest)| rest.starts_with("cargo install")).expect("it is built");
    let copied: Vec<&str> = instructions[..built]
        .iter()
        .filter(|(word, _)| word == "COPY")
        .flat_map(|(_, rest)| {
            let paths: Vec<&str> = rest.split(' ').collect();
            let (to, from) = paths.split_last().expect("a destination");
            assert!(*to == "./" || [*to] == *from, "{rest}: each folder keeps its place");
            from.to_vec()
        })
        .collect();
    let place = Place::new();
    for path in &copied {
        std::os::unix::fs::symlink(repository(path).canonicalize().expect("it is there"), place.path(path))
            .expect("linked");
    }
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["metadata", "--locked", "--offline", "--no-deps", "--format-version", "1"]).current_dir(place.path(""));
    crate::testing::outcome(&mut cargo).exits(0);
    // Crates include files of other folders by links in their own. Only tests include others: a page of the book, and files of
    // the crate's own tests.
    let beside =
        std::fs::read_dir(repository("passes")).expect("a folder").map(|entry| entry.expect("an entry").path());
    let links = beside.filter(|path| path.is_dir()).filter_map(|path| std::fs::read_link(path).ok());
    let linked = |link: PathBuf| Some(link.strip_prefix("..").ok()?.iter().next()?.to_str()?.to_owned());
    let outside: BTreeSet<String> = links.filter_map(linked).collect();
    assert_eq!(outside.iter().collect::<Vec<_>>(), ["examples", "shaders"]);
    let missing: Vec<_> = outside.iter().filter(|folder| !copied.contains(&&***folder)).collect();
    assert!(missing.is_empty(), "{missing:?}");
    let crates = copied.iter().map(|path| place.path(path).join("src")).filter(|path| path.is_dir());
    let code: String = crates.map(|path| texts(&path)).collect();
    let elsewhere = code.split("(\"../").skip(1).filter_map(|path| path.trim_start_matches("../").split('/').next());
    let elsewhere: BTreeSet<&str> = elsewhere.filter(|folder| repository(folder).is_dir()).collect();
    assert!(elsewhere.iter().all(|folder| ["docs", "shaders", "tests"].contains(folder)), "{elsewhere:?}");
    // The other files that the container takes are there too.
    for (_, rest) in instructions[built..].iter().filter(|(word, rest)| word == "COPY" && !rest.starts_with("--from="))
    {
        assert!(repository(rest.split(' ').next().expect("a file")).is_file(), "{rest}");
    }
}
