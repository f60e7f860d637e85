//! Modules of the physics know only those that they may.

use crate::repository::{TextFile, text_files_ending};

const MODULES: &[&str] = &[
    "number",
    "parameter",
    "geometry",
    "contact",
    "machine",
    "wear",
    "evolve",
];

/// Each module of `condyle`, and the others that it may use.
const MAY_USE: &[(&str, &[&str])] = &[
    ("number", &[]),
    ("parameter", &[]),
    ("geometry", &["number"]),
    ("contact", &["number", "geometry"]),
    // The contact interface, never a mesh.
    ("machine", &["contact"]),
    // Histories, never a solver.
    ("wear", &["parameter", "contact"]),
    ("evolve", &["geometry", "contact", "machine", "wear"]),
];

/// Names of `contact` that are a model rather than its interface or its history.
const MODELS_OF_CONTACT: &[&str] = &["Foundation", "FoundationSettings", "PressureLaw"];

/// Names of `contact` that are its interface and not a history.
const SOLVERS_OF_CONTACT: &[&str] = &["ContactModel", "ContactResponse", "RelativeMotion"];

/// A source file without comments and without its tests, cut into words and `::`.
fn words(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let lines = code
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default());
    let spaced = lines.collect::<Vec<_>>().join("\n").replace("::", " :: ");
    let is_apart = |c: char| !(c.is_alphanumeric() || c == '_' || c == ':' || c == ';');
    let apart = spaced.replace(';', " ; ").replace(is_apart, " ");
    apart.split_whitespace().map(str::to_owned).collect()
}

/// Words that name an item of another module: those of `use` statements and those beside a `::`.
fn imported(text: &str) -> Vec<String> {
    let words = words(text);
    let mut is_use = false;
    let mut found = Vec::new();
    for (i, word) in words.iter().enumerate() {
        is_use = word == "use" || (is_use && word != ";");
        let beside = |other: Option<&String>| other.is_some_and(|other| other == "::");
        if is_use || beside(words.get(i + 1)) || i > 0 && beside(words.get(i - 1)) {
            found.push(word.clone());
        }
    }
    found
}

fn files_of(module: &str) -> Vec<TextFile> {
    let mut files = text_files_ending(".rs");
    let folder = format!("crates/condyle/src/{module}/");
    let alone = format!("crates/condyle/src/{module}.rs");
    files.retain(|file| file.path.starts_with(&folder) || file.path == alone);
    files
}

fn assert_does_not_import(module: &str, banned: &[&str]) {
    for file in files_of(module) {
        let found = imported(&file.text);
        let wrong = found.iter().find(|word| banned.contains(&word.as_str()));
        assert!(wrong.is_none(), "{} may not use {wrong:?}", file.path);
    }
}

#[test]
fn modules_use_only_what_they_may() {
    for (module, allowed) in MAY_USE {
        let others = MODULES.iter().filter(|other| *other != module);
        let banned: Vec<&str> = others
            .filter(|other| !allowed.contains(other))
            .copied()
            .collect();
        assert_does_not_import(module, &banned);
    }
}

#[test]
fn machine_sees_a_contact_interface_and_wear_sees_histories() {
    assert_does_not_import("machine", MODELS_OF_CONTACT);
    assert_does_not_import("wear", MODELS_OF_CONTACT);
    assert_does_not_import("wear", SOLVERS_OF_CONTACT);
}

#[test]
fn every_module_has_files_to_look_at() {
    for (module, _) in MAY_USE {
        assert!(!files_of(module).is_empty(), "{module}");
    }
}

#[test]
fn every_module_of_the_physics_has_its_rule() {
    let library = crate::repository::read("crates/condyle/src/lib.rs");
    let public = library
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'));
    for module in public {
        assert!(MAY_USE.iter().any(|(name, _)| *name == module), "{module}");
    }
}

#[test]
fn an_import_is_seen_wherever_it_stands() {
    let sees = |text: &str| imported(text).iter().any(|word| word == "geometry");
    assert!(sees("use crate::{\n    Vec3,\n    geometry::Insert,\n};"));
    assert!(sees("use crate::{Vec3, geometry};"));
    assert!(sees("fn f(insert: &crate::geometry::Insert) {}"));
    assert!(sees("fn f() { super::super::geometry::g() }"));
    assert!(!sees("// crate::geometry is not for us\nlet geometry = 1;"));
    assert!(!sees(
        "#[cfg(test)]\nmod tests {\n    use crate::geometry::Insert;\n}"
    ));
}
