//! The tests of a study in one SQLite file, which Python's standard library reads.

mod columns;
mod csv;
mod database;

pub(super) use columns::Column;
pub(super) use database::Keeping;
pub use database::{DATABASE, Store};
