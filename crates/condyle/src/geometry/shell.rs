//! Is a triangle mesh a shell: one surface, consistently turned, that does not cross itself?

mod box_tree;
mod checked;
mod crossing;
mod degenerate;
mod edges;
mod error;
#[cfg(test)]
pub(crate) mod fixtures;
mod orientation;
mod separation;

pub use checked::{CheckedShell, checked_shell};
pub use crossing::{Crossing, Crossings, crossings};
pub use edges::{ShellReport, shell_report};
pub use error::ShellError;
