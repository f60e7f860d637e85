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

/// The case of that name; none, and a word on why, where its data are not there.
pub fn read(name: &str) -> Option<Case> {
    match Case::read(&path(name)) {
        Ok(case) => Some(case),
        Err(error) => {
            eprintln!("skipped: {name}: {error}");
            None
        }
    }
}

/// The generic case with one number changed.
pub fn generic_with(key: &str, value: f64) -> Case {
    let change = Assignment::number(key, &format!("{value:?}")).expect("a number");
    Case::read_changed(&path(GENERIC), &[change]).expect("a shipped case is read")
}

pub fn built(case: &Case) -> WearTest {
    case.build(1).expect("a shipped case builds").test
}

/// All updates of a test, from its bodies.
pub fn marched(test: WearTest) -> MarchState {
    updated(test, usize::MAX).state().clone()
}

/// Its first `updates`, or all if there are fewer.
pub fn updated(test: WearTest, updates: usize) -> March {
    let mut march = March::start(test).expect("a shipped case settles");
    while !march.is_done() && march.state().updates.len() < updates {
        let update = march.update(&mut |_| ControlFlow::Continue(()));
        assert!(update.expect("a shipped case is solved").is_continue());
    }
    march
}
