//! Crates know only those below them.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::repository::cargo_metadata;

/// Each crate, and the crates of this workspace that it may use. A new crate needs a line here.
const MAY_USE: &[(&str, &[&str])] = &[
    ("condyle-fem", &[]),
    ("condyle-mesh", &["condyle-fem"]),
    ("condyle", &["condyle-fem", "condyle-mesh"]),
    (
        "condyle-results",
        &["condyle", "condyle-fem", "condyle-mesh"],
    ),
    (
        "condyle-case",
        &["condyle", "condyle-fem", "condyle-mesh", "condyle-results"],
    ),
    // No solver: it reads a results folder.
    (
        "condyle-report",
        &["condyle-fem", "condyle-mesh", "condyle-results"],
    ),
    (
        "condyle-lab",
        &[
            "condyle",
            "condyle-case",
            "condyle-fem",
            "condyle-mesh",
            "condyle-report",
            "condyle-results",
        ],
    ),
    (
        "condyle-study",
        &[
            "condyle",
            "condyle-case",
            "condyle-lab",
            "condyle-report",
            "condyle-results",
        ],
    ),
    (
        "condyle-cli",
        &[
            "condyle",
            "condyle-fem",
            "condyle-case",
            "condyle-results",
            "condyle-lab",
            "condyle-report",
            "condyle-study",
        ],
    ),
    // What Python calls: the same calls, arrays in and out.
    (
        "condyle-python",
        &[
            "condyle",
            "condyle-fem",
            "condyle-case",
            "condyle-mesh",
            "condyle-results",
            "condyle-lab",
            "condyle-study",
        ],
    ),
    // What the web page calls: runs in memory, their scenes, and the results folder.
    (
        "condyle-web",
        &[
            "condyle",
            "condyle-case",
            "condyle-lab",
            "condyle-report",
            "condyle-results",
        ],
    ),
    // Cases with known answers: nobody uses it.
    (
        "condyle-verification",
        &[
            "condyle",
            "condyle-fem",
            "condyle-case",
            "condyle-lab",
            "condyle-mesh",
        ],
    ),
    // One paper's table: nobody uses it.
    (
        "condyle-knight-2007",
        &[
            "condyle-case",
            "condyle-report",
            "condyle-results",
            "condyle-study",
        ],
    ),
];

/// Crates that reach a terminal, which only the command may.
const TERMINAL: &[&str] = &["clap", "indicatif", "ctrlc"];

/// Every crate with its dependencies, those of tests and builds left out.
fn dependencies() -> BTreeMap<String, Vec<String>> {
    let metadata = cargo_metadata();
    let packages = metadata["packages"]
        .as_array()
        .expect("packages are listed");
    let name = |value: &Value| value["name"].as_str().expect("has a name").to_owned();
    let used = |package: &Value| {
        let all = package["dependencies"].as_array().expect("are listed");
        let normal = all.iter().filter(|dependency| dependency["kind"].is_null());
        normal.map(name).collect()
    };
    packages
        .iter()
        .map(|package| (name(package), used(package)))
        .collect()
}

#[test]
fn crates_use_only_what_lies_below_them() {
    let dependencies = dependencies();
    for (package, used) in &dependencies {
        let allowed = MAY_USE.iter().find(|(name, _)| name == package);
        let (_, allowed) = allowed.unwrap_or_else(|| panic!("{package} has no line in MAY_USE"));
        for other in used
            .iter()
            .filter(|other| dependencies.contains_key(*other))
        {
            assert!(
                allowed.contains(&other.as_str()),
                "{package} may not use {other}"
            );
        }
    }
    assert_eq!(
        dependencies.len(),
        MAY_USE.len(),
        "{:?}",
        dependencies.keys()
    );
}

#[test]
fn only_the_command_reaches_the_terminal() {
    for (package, used) in dependencies() {
        let reaches = used.iter().find(|other| TERMINAL.contains(&other.as_str()));
        assert!(
            package == "condyle-cli" || reaches.is_none(),
            "{package} uses {reaches:?}; leave that to condyle-cli"
        );
    }
}

#[test]
fn every_crate_takes_the_lints_of_the_workspace() {
    for package in cargo_metadata()["packages"].as_array().expect("are listed") {
        let path = package["manifest_path"].as_str().expect("has a manifest");
        let manifest = std::fs::read_to_string(path).expect("can be read");
        assert!(manifest.contains("[lints]\nworkspace = true"), "{path}");
    }
}
