//! The Rust of the book, as examples that are compiled.

#[doc = include_str!("../../docs/src/developers.md")]
mod developers {}
