//! Modules know only those that they may, private ones too.

use std::collections::BTreeMap;

use crate::repository::{TextFile, text_files_ending};
use crate::source::{Edge, Sources, made_up};

/// Each module, and what it may name outside of itself: modules with all that is in them, or single
/// items. The row of the longest path speaks for a module; a crate that has a row here needs one for
/// each of its outermost modules.
const MAY_USE: &[(&str, &[&str])] = &[
    ("condyle_fem::mesh", &[]),
    ("condyle_fem::elastic", &[]),
    ("condyle_fem::plastic", &["condyle_fem::elastic"]),
    ("condyle_fem::element", &["condyle_fem::elastic"]),
    (
        "condyle_fem::sparse",
        &["condyle_fem::element", "condyle_fem::mesh"],
    ),
    (
        "condyle_fem::solid",
        &[
            "condyle_fem::elastic",
            "condyle_fem::element",
            "condyle_fem::mesh",
            "condyle_fem::sparse",
        ],
    ),
    (
        "condyle_fem::compliance",
        &["condyle_fem::solid", "condyle_fem::sparse"],
    ),
    (
        "condyle_fem::support",
        &["condyle_fem::compliance", "condyle_fem::solid"],
    ),
    (
        "condyle_fem::eigenstrain",
        &[
            "condyle_fem::elastic",
            "condyle_fem::element",
            "condyle_fem::plastic",
            "condyle_fem::solid",
        ],
    ),
    ("condyle_mesh::triangle_mesh", &[]),
    (
        "condyle_mesh::curved_mesh",
        &["condyle_mesh::triangle_mesh"],
    ),
    (
        "condyle_mesh::divided_mesh",
        &[
            "condyle_mesh::curved_mesh",
            "condyle_mesh::repair",
            "condyle_mesh::triangle_mesh",
        ],
    ),
    (
        "condyle_mesh::columns",
        &[
            "condyle_fem",
            "condyle_mesh::curved_mesh",
            "condyle_mesh::divided_mesh",
            "condyle_mesh::triangle_mesh",
        ],
    ),
    (
        "condyle_mesh::fitted_sphere",
        &["condyle_mesh::triangle_mesh"],
    ),
    ("condyle_mesh::repair", &["condyle_mesh::triangle_mesh"]),
    (
        "condyle_mesh::coarse",
        &[
            "condyle_mesh::curved_mesh",
            "condyle_mesh::repair",
            "condyle_mesh::triangle_mesh",
        ],
    ),
    ("condyle_mesh::roughness", &["condyle_mesh::triangle_mesh"]),
    ("condyle_mesh::files", &[]),
    (
        "condyle_mesh::formats",
        &[
            "condyle_fem",
            "condyle_mesh::files",
            "condyle_mesh::triangle_mesh",
        ],
    ),
    ("condyle::number", &[]),
    ("condyle::parameter", &[]),
    ("condyle::spatial", &["condyle::number"]),
    (
        "condyle::geometry",
        &["condyle::number", "condyle_fem", "condyle_mesh"],
    ),
    ("condyle::anatomy", &["condyle::geometry", "condyle_mesh"]),
    (
        "condyle::contact",
        &[
            "condyle::number",
            "condyle::spatial",
            "condyle::geometry",
            "condyle_fem",
            "condyle_mesh::triangle_mesh::bounds",
        ],
    ),
    // What may touch knows shares of a surface, never a law.
    (
        "condyle::contact::broad_phase",
        &[
            "condyle::contact::model",
            "condyle::number",
            "condyle::spatial",
            "condyle::geometry",
        ],
    ),
    // The contact interface, never a law or a mesh.
    (
        "condyle::machine",
        &[
            "condyle::contact::model",
            "condyle::contact::history",
            "condyle::spatial",
        ],
    ),
    // Histories, never a solver.
    ("condyle::creep", &["condyle::parameter"]),
    (
        "condyle::wear",
        &["condyle::contact::history", "condyle::parameter"],
    ),
    // Contact by its law alone.
    (
        "condyle::evolve",
        &[
            "condyle::geometry",
            "condyle::contact::history",
            "condyle::contact::law",
            "condyle::contact::model",
            "condyle::creep",
            "condyle::machine",
            "condyle::number",
            "condyle::spatial",
            "condyle::wear",
            "condyle_fem",
        ],
    ),
    // The names of all of them that a wear test is put together from.
    (
        "condyle::prelude",
        &[
            "condyle::contact",
            "condyle::evolve",
            "condyle::geometry",
            "condyle::machine",
            "condyle::spatial",
            "condyle::wear",
        ],
    ),
    (
        "condyle_report::error",
        &["condyle_results", "condyle_mesh"],
    ),
    ("condyle_report::number", &["condyle::parameter"]),
    (
        "condyle_report::results",
        &[
            "condyle_report::error",
            "condyle_results",
            // The joint of a body.
            "condyle::machine::mechanism",
            "condyle_mesh",
            "condyle_fem",
        ],
    ),
    (
        "condyle_report::figure",
        &[
            "condyle_results::side",
            "condyle_report::number",
            "condyle_report::results",
            // The border of a surface.
            "condyle_mesh::repair",
            // The joint of a body.
            "condyle::machine::mechanism",
        ],
    ),
    (
        "condyle_report::charts",
        &[
            "condyle_results",
            "condyle_report::figure",
            "condyle_report::number",
            "condyle_report::results",
            // The table of joints that the columns of kinematics.csv are made by, and the units in their names.
            "condyle::machine::knee",
            "condyle::machine::mechanism",
            "condyle::parameter",
        ],
    ),
    (
        "condyle_report::maps",
        &[
            "condyle_results",
            "condyle_report::figure",
            "condyle_report::results",
        ],
    ),
    (
        "condyle_report::plots",
        &["condyle_report::figure", "condyle_report::number"],
    ),
    ("condyle_report::png", &["condyle_report::figure"]),
    ("condyle_report::program", &["condyle_report::scene"]),
    (
        "condyle_report::sheets",
        &[
            "condyle_report::program",
            "condyle_results::files",
            "condyle_report::error",
            "condyle_report::figure",
            "condyle_report::number",
        ],
    ),
    (
        "condyle_report::runs",
        &[
            "condyle_results",
            "condyle_report::charts",
            "condyle_report::error",
            "condyle_report::figure",
            "condyle_report::maps",
            "condyle_report::number",
            "condyle_report::page",
            "condyle_report::program",
            "condyle_report::results",
            "condyle_report::scene",
            "condyle_report::sheets",
        ],
    ),
    (
        "condyle_report::study",
        &[
            "condyle_report::error",
            "condyle_report::figure",
            "condyle_report::number",
            "condyle_report::sheets",
        ],
    ),
    (
        "condyle_report::bodies",
        &[
            "condyle_results::side",
            "condyle_report::figure",
            "condyle_report::number",
            "condyle_report::results",
            "condyle_fem",
            "condyle_mesh",
        ],
    ),
    (
        "condyle_report::scene",
        &[
            "condyle_report::charts",
            "condyle_report::error",
            "condyle_report::figure",
            "condyle_report::maps",
            "condyle_report::results",
            "condyle_results",
            "condyle_mesh",
            "condyle_fem",
            "condyle_report::number",
        ],
    ),
    (
        "condyle_report::page",
        &[
            "condyle_results",
            "condyle_report::charts",
            "condyle_report::figure",
            "condyle_report::maps",
            "condyle_report::number",
            "condyle_report::program",
            "condyle_report::results",
            "condyle_report::scene",
            // The table of units, and the joint of a body.
            "condyle::parameter",
            "condyle::machine::mechanism",
            "condyle_report::sheets",
        ],
    ),
    (
        "condyle_report::measured",
        &[
            "condyle_results::parts",
            "condyle_results::side",
            "condyle_report::charts",
            "condyle_report::figure",
            "condyle_report::results",
        ],
    ),
    (
        "condyle_report::pictures",
        &[
            "condyle_results::added",
            "condyle_report::charts",
            "condyle_report::error",
            "condyle_report::figure",
            "condyle_report::maps",
            "condyle_report::results",
            "condyle_report::sheets",
        ],
    ),
    (
        "condyle_lab::accuracy",
        &["condyle", "condyle_case", "condyle_results", "condyle_mesh"],
    ),
    (
        "condyle_lab::at_rest",
        &["condyle", "condyle_case", "condyle_results", "condyle_mesh"],
    ),
    (
        "condyle_lab::plausibility",
        &["condyle", "condyle_case", "condyle_results", "condyle_mesh"],
    ),
    (
        "condyle_lab::run",
        &[
            "condyle_lab::accuracy",
            "condyle_lab::at_rest",
            "condyle_lab::plausibility",
            "condyle",
            "condyle_case",
            "condyle_results",
            "condyle_mesh",
            "condyle_report",
        ],
    ),
    (
        "condyle_lab::preview",
        &[
            "condyle",
            "condyle_case",
            "condyle_results",
            "condyle_mesh",
            "condyle_report",
            "condyle_lab::at_rest",
            "condyle_lab::plausibility",
            "condyle_lab::run",
        ],
    ),
    ("condyle_lab::markdown", &[]),
    (
        "condyle_lab::pressure_law",
        &[
            "condyle_lab::markdown",
            "condyle_lab::run",
            "condyle",
            "condyle_case",
            "condyle_results",
            "condyle_mesh",
        ],
    ),
    (
        "condyle_lab::measured",
        &[
            "condyle_lab::run",
            "condyle",
            "condyle_case",
            "condyle_results",
            "condyle_mesh",
            "condyle_report",
        ],
    ),
];

/// What everyone may name.
const KNOWN_TO_ALL: &[&str] = &[
    "condyle_fem::Vec3",
    "condyle::Vec3",
    "condyle::Vector",
    "condyle::Mat3",
];

/// Whether `path` is `whole` or lies within it.
fn lies_in(path: &str, whole: &str) -> bool {
    let rest = path.strip_prefix(whole);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

/// The row that speaks for a module.
fn row<'a>(rows: &'a [(&str, &[&str])], module: &str) -> Option<&'a (&'a str, &'a [&'a str])> {
    let of_module = rows.iter().filter(|(name, _)| lies_in(module, name));
    of_module.max_by_key(|(name, _)| name.len())
}

/// What an edge names, as `condyle::contact::law::Linear`.
fn named(sources: &Sources, edge: &Edge) -> String {
    format!("{}::{}", sources.modules[edge.to].path, edge.item)
}

/// Everything that a module names and no row allows, told once with its first place.
fn forbidden(sources: &Sources, rows: &[(&str, &[&str])], known_to_all: &[&str]) -> Vec<String> {
    let is_forbidden = |from: &str, to: &str| {
        row(rows, from).is_some_and(|(module, allowed)| {
            let mut all = allowed.iter().chain(known_to_all).chain([module]);
            !all.any(|whole| lies_in(to, whole))
        })
    };
    let mut told = BTreeMap::new();
    for edge in sources.edges() {
        let (from, to) = (&sources.modules[edge.from], named(sources, &edge));
        if is_forbidden(&from.path, &to) {
            let words = format!("{} may not use {to}", from.path);
            told.entry(words)
                .or_insert(format!("{}:{}", from.file, edge.line));
        }
    }
    let lines = told
        .iter()
        .map(|(words, place)| format!("{place}: {words}"));
    lines.collect()
}

/// The outermost modules without a row, in crates that have one.
fn without_row(sources: &Sources, rows: &[(&str, &[&str])]) -> Vec<String> {
    let has_rows = |name: &str| rows.iter().any(|(module, _)| lies_in(module, name));
    let outermost = sources.modules.iter().filter(|module| {
        let parent = module.path.rsplit_once("::");
        parent.is_some_and(|(parent, _)| !parent.contains("::") && has_rows(parent))
    });
    let missing = outermost.filter(|module| row(rows, &module.path).is_none());
    missing.map(|module| module.path.clone()).collect()
}

#[test]
fn modules_use_only_what_they_may() {
    let wrong = forbidden(Sources::of_workspace(), MAY_USE, KNOWN_TO_ALL);
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn every_outermost_module_has_its_rule() {
    let missing = without_row(Sources::of_workspace(), MAY_USE);
    assert!(missing.is_empty(), "no row in MAY_USE: {missing:?}");
}

#[test]
fn every_rule_is_about_something_that_there_is() {
    let sources = Sources::of_workspace();
    let rows = MAY_USE
        .iter()
        .flat_map(|(module, allowed)| [module].into_iter().chain(*allowed));
    let gone: Vec<_> = rows
        .chain(KNOWN_TO_ALL)
        .filter(|path| !sources.has(path))
        .collect();
    assert!(gone.is_empty(), "there is no {gone:?}");
}

#[test]
fn what_no_row_allows_is_told_with_its_place() {
    let sources = made_up(&[
        ("lib.rs", "mod low; mod high; pub struct Everyone;"),
        (
            "low.rs",
            "use crate::{Everyone, high::inner::Secret};\npub struct Low;",
        ),
        ("high/mod.rs", "mod inner; use crate::low::Low;"),
        ("high/inner.rs", "pub struct Secret;"),
    ]);
    let rows: &[(&str, &[&str])] = &[("made::low", &[]), ("made::high", &["made::low"])];
    let told = ["src/low.rs:1: made::low may not use made::high::inner::Secret"];
    assert_eq!(forbidden(&sources, rows, &["made::Everyone"]), told);
    assert_eq!(forbidden(&sources, rows, &[]).len(), 2);
    let item: &[(&str, &[&str])] = &[(
        "made::low",
        &["made::high::inner::Secret", "made::Everyone"],
    )];
    assert!(forbidden(&sources, item, &[]).is_empty());
    let of_inner: &[(&str, &[&str])] = &[("made::high", &[]), ("made::high::inner", &[])];
    assert_eq!(without_row(&sources, of_inner), ["made::low"]);
}

/// Whether a file declares a module, by `mod name;` or on a line of a macro's list.
fn declares(file: &TextFile, name: &str) -> bool {
    let ends = [format!("mod {name};"), format!("mod {name} {{")];
    file.text.lines().any(|line| {
        let line = line.trim();
        ends.iter().any(|end| line.ends_with(end)) || line == format!("{name},")
    })
}

/// The files that may declare a module that is in `path`, and its name.
fn parents(path: &str) -> Option<([String; 4], &str)> {
    let path = path.strip_suffix("/mod").unwrap_or(path);
    let (folder, name) = path.rsplit_once('/')?;
    let outermost = folder.ends_with("/src") && ["lib", "main"].contains(&name);
    let within = ["mod", "lib", "main"].map(|file| format!("{folder}/{file}.rs"));
    let [a, b, c] = within;
    (!outermost).then(|| ([a, b, c, format!("{folder}.rs")], name))
}

/// A file that nobody declares is not compiled, and nobody misses it.
#[test]
fn every_file_is_a_module() {
    let files = text_files_ending(".rs");
    let of_src = files.iter().filter(|file| file.path.contains("/src/"));
    let left_out = of_src.filter(|file| {
        let Some((parents, name)) = parents(file.path.trim_end_matches(".rs")) else {
            return false;
        };
        let mut parents = files.iter().filter(|file| parents.contains(&file.path));
        !parents.any(|parent| declares(parent, name))
    });
    let left_out: Vec<&str> = left_out.map(|file| file.path.as_str()).collect();
    assert!(left_out.is_empty(), "not compiled: {left_out:?}");
}
