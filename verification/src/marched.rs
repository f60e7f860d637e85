//! Wear tests run to their end.

use std::{ops::ControlFlow, path::Path};

use condyle::evolve::{March, WearTest};
use condyle_io::case::Case;

/// The wear test that a case file describes.
pub(crate) fn test_of(case: &str) -> WearTest {
    test_in(case, Path::new(""))
}

/// The wear test that a case file describes, whose paths count from `folder`.
pub(crate) fn test_in(case: &str, folder: &Path) -> WearTest {
    let case = Case::parse(case, "case.toml", folder).expect("a good case");
    case.build(1).expect("bodies").test
}

/// A test with all its updates done.
pub(crate) fn marched(test: WearTest) -> March {
    going_on(March::start(test).expect("a knee"))
}

/// A march gone on to its end.
pub(crate) fn going_on(mut march: March) -> March {
    while !march.is_done() {
        let mut watch = |_| ControlFlow::Continue(());
        let update = march.update(&mut watch).expect("a solved update");
        assert!(update.is_continue(), "nobody stops it");
    }
    march
}
