//! Wear tests run to their end.

use std::path::Path;

use condyle::{
    contact::{Bodies, Foundation},
    evolve::{March, WearTest},
    geometry::ArticulatingSurface,
};
use condyle_case::case::Case;

/// The wear test that a case file describes.
pub(crate) fn test_of(case: &str) -> WearTest {
    built(&case_in(case, Path::new("")))
}

/// The case of a case file whose paths count from `folder`.
pub(crate) fn case_in(text: &str, folder: &Path) -> Case {
    Case::parse(text, "case.toml", folder).expect("a good case")
}

/// The wear test of a case.
pub(crate) fn built(case: &Case) -> WearTest {
    case.build(1).expect("bodies").test
}

/// A march that has not gone yet, and the foundation that its test is made with.
pub(crate) fn started(case: &Case) -> (March, Foundation) {
    let march = March::start(built(case)).expect("a knee");
    let foundation = case.foundation(march.insert());
    (march, foundation)
}

/// The bodies of a march as worn so far, `surface` that of its insert.
pub(crate) fn bodies_of<'a>(march: &'a March, surface: &'a ArticulatingSurface) -> Bodies<'a> {
    Bodies {
        counterface: march.counterface(),
        insert: march.insert(),
        surface,
    }
}

/// A test with all its updates done.
pub(crate) fn marched(test: WearTest) -> March {
    run_on(March::start(test).expect("a knee"))
}

/// A march run to its end.
pub(crate) fn run_on(mut march: March) -> March {
    march.run().expect("solved updates");
    march
}
