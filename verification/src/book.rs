//! The Rust of the book, as examples that are compiled.

#[doc = include_str!("../../docs/src/developers.md")]
mod developers {}

#[doc = include_str!("../../crates/condyle/README.md")]
mod readme_of_the_library {}

#[doc = include_str!("../../crates/condyle-case/README.md")]
mod readme_of_case {}

#[doc = include_str!("../../crates/condyle-fem/README.md")]
mod readme_of_fem {}

#[doc = include_str!("../../crates/condyle-lab/README.md")]
mod readme_of_lab {}

#[doc = include_str!("../../crates/condyle-mesh/README.md")]
mod readme_of_mesh {}

#[doc = include_str!("../../crates/condyle-report/README.md")]
mod readme_of_report {}

#[doc = include_str!("../../crates/condyle-results/README.md")]
mod readme_of_results {}

#[doc = include_str!("../../crates/condyle-study/README.md")]
mod readme_of_study {}
