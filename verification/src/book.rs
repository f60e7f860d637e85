//! The Rust of the book, as examples that are compiled.

#[doc = include_str!("../../docs/src/developers.md")]
mod developers {}

#[doc = include_str!("../../crates/condyle/README.md")]
mod readme_of_the_library {}
