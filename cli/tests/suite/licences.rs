//! Dependencies under licences that `deny.toml` allows, told without any further tool.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

#[test]
fn every_dependency_has_a_licence_that_deny_toml_allows() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let rules = std::fs::read_to_string(root.join("deny.toml")).expect("deny.toml is there");
    let allowed = allowed(&rules);
    assert!(allowed.contains("MIT"), "{allowed:?}");

    let metadata = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--offline", "--filter-platform", &host()])
        .current_dir(&root)
        .output()
        .expect("cargo runs");
    assert!(metadata.status.success(), "{}", String::from_utf8_lossy(&metadata.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&metadata.stdout).expect("JSON");
    let packages = metadata["packages"].as_array().expect("a list of packages");
    assert!(packages.len() > 20);

    let refused: Vec<String> = packages
        .iter()
        .filter_map(|package| {
            let licence = package["license"].as_str().unwrap_or("none stated");
            (!permits(licence, &allowed)).then(|| format!("{} {}: {licence}", package["name"], package["version"]))
        })
        .collect();
    assert!(refused.is_empty(), "not allowed by deny.toml: {refused:#?}");
}

#[test]
fn a_choice_of_licences_needs_one_that_is_allowed_and_a_sum_needs_all() {
    let allowed = BTreeSet::from(["MIT", "Zlib", "Apache-2.0 WITH LLVM-exception"]);
    for fine in ["MIT", "GPL-3.0 OR MIT", "GPL-3.0/MIT", "(GPL-3.0 OR MIT) AND Zlib", "Apache-2.0 WITH LLVM-exception"]
    {
        assert!(permits(fine, &allowed), "{fine}");
    }
    for refused in ["GPL-3.0", "MIT AND GPL-3.0", "(MIT OR GPL-3.0) AND GPL-2.0", "none stated", ""] {
        assert!(!permits(refused, &allowed), "{refused}");
    }
}

/// The platform that this was built on: dependencies of others aren't on this disk.
fn host() -> String {
    let version = Command::new("rustc").arg("-vV").output().expect("rustc runs").stdout;
    let version = String::from_utf8(version).expect("text");
    version.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host").to_owned()
}

/// The entries of `allow` under `[licenses]`.
fn allowed(rules: &str) -> BTreeSet<&str> {
    let list = rules.split_once("[licenses]").and_then(|(_, rest)| rest.split_once("allow = [")).expect("a list").1;
    list.split(']').next().expect("its end").split('"').skip(1).step_by(2).collect()
}

/// Whether an SPDX expression can be met with the allowed licences: `OR` (formerly `/`) binds weaker than `AND`.
fn permits(expression: &str, allowed: &BTreeSet<&str>) -> bool {
    let expression = expression.replace('/', " OR ");
    let meets = |operator: &str| outside_brackets(&expression, operator);
    let (any, all) = (meets(" OR "), meets(" AND "));
    if any.len() > 1 {
        any.iter().any(|part| permits(part, allowed))
    } else if all.len() > 1 {
        all.iter().all(|part| permits(part, allowed))
    } else {
        let plain = expression.trim();
        match plain.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
            Some(inner) => permits(inner, allowed),
            None => allowed.contains(plain),
        }
    }
}

fn outside_brackets<'a>(expression: &'a str, operator: &str) -> Vec<&'a str> {
    let (mut parts, mut depth, mut start) = (Vec::new(), 0_i32, 0);
    for (at, byte) in expression.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            _ if depth == 0 && expression[at..].starts_with(operator) => {
                parts.push(&expression[start..at]);
                start = at + operator.len();
            }
            _ => {}
        }
    }
    parts.push(&expression[start..]);
    parts
}
