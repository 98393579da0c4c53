//! What the command writes for other programs, given to those programs or to the published schemas: Graphviz, Mermaid, SARIF and JUnit
//! (IN-9, IN-10).

mod findings;
mod graphs;
mod mermaid;

use std::path::PathBuf;
use std::process::Command;

/// The folder of a package of `tests/judges`, where Cargo keeps it. `None` where it wasn't fetched, which CI doesn't allow.
fn judge(package: &str) -> Option<PathBuf> {
    let manifest = crate::testing::repository("tests/judges/Cargo.toml");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["metadata", "--offline", "--locked", "--format-version", "1", "--manifest-path"]).arg(manifest);
    let told = crate::testing::outcome(&mut cargo);
    let fetch = "cargo fetch --locked --manifest-path tests/judges/Cargo.toml";
    if told.code != Some(0) {
        assert!(std::env::var_os("CI").is_none(), "{package} was not fetched ({fetch}): {}", told.err);
        println!("skipped: {package} was not fetched: {fetch}");
        return None;
    }
    let told: serde_json::Value = serde_json::from_str(&told.out).expect("JSON");
    let mut packages = told["packages"].as_array().expect("packages").iter();
    let found = packages.find(|found| found["name"] == package).expect("tests/judges names it");
    let manifest = PathBuf::from(found["manifest_path"].as_str().expect("a path"));
    Some(manifest.parent().expect("a folder").to_owned())
}
