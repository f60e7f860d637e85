//! The cases that are measured.

use std::{
    ops::ControlFlow,
    path::{Path, PathBuf},
};

use condyle::evolve::{March, MarchState, WearTest};
use condyle_case::case::{Assignment, Case};

/// The generic implant: no file is needed.
pub const GENERIC: &str = "knight-2007";
/// A real implant, whose meshes may not be there.
pub const REAL: &str = "dm-knee";

pub fn path(name: &str) -> PathBuf {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    cases.join(name).with_extension("toml")
}

/// The models that are counted on a small test, and the changes of the generic case that make it one of each.
pub const SMALL: [(&str, &[&str]); 4] = [
    ("deformable", &["contact.model=deformable"]),
    (
        "plastic",
        // Polyethylene hardly yields on coarse edges: a lower yield stress makes it flow in every cycle.
        &[
            "contact.model=deformable",
            "contact.deformable.plasticity=j2",
            "contact.deformable.yield_stress_mpa=9",
            // The most expensive model: smaller than the others.
            "insert.edge_mm=4",
            "insert.layers=3",
            "march.updates=1",
        ],
    ),
    (
        "resting",
        &[
            "contact.model=deformable",
            "contact.deformable.backside=resting",
            "contact.deformable.backside_spacing_mm=8",
        ],
    ),
    ("creep", &["creep.law=lee-pienkowski"]),
];

/// Coarse edges, few increments and few updates: seconds under callgrind.
const SMALLER: [&str; 3] = ["insert.edge_mm=3", "time.increments=40", "march.updates=2"];

/// The case of that name; none, and a word on why, where its data are not there.
pub fn read(name: &str) -> Option<Case> {
    if let Some((_, changes)) = SMALL.iter().find(|(small, _)| *small == name) {
        return Some(generic_with(SMALLER.iter().chain(*changes).copied()));
    }
    match Case::read(&path(name)) {
        Ok(case) => Some(case),
        Err(error) => {
            eprintln!("skipped: {name}: {error}");
            None
        }
    }
}

/// The generic case with changes such as `march.updates=2`.
pub fn generic_with<'a>(changes: impl IntoIterator<Item = &'a str>) -> Case {
    let changes = changes.into_iter().map(Assignment::parse);
    let changes: Result<Vec<_>, _> = changes.collect();
    let changes = changes.expect("keys and values");
    Case::read_changed(&path(GENERIC), &changes).expect("a shipped case is read")
}

pub fn built(case: &Case) -> WearTest {
    case.build(1).expect("a shipped case builds").test
}

/// All updates of a test, from its bodies.
pub fn marched(test: WearTest) -> MarchState {
    updated(test, usize::MAX).state().clone()
}

/// Solves the first `updates` of a test, or all if there are fewer.
pub fn updated(test: WearTest, updates: usize) -> March {
    let mut march = March::start(test).expect("a shipped case settles");
    while !march.is_done() && march.state().updates.len() < updates {
        let update = march.update(&mut |_| ControlFlow::Continue(()));
        assert!(update.expect("a shipped case is solved").is_continue());
    }
    march
}
