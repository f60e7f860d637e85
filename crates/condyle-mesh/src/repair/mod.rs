//! Is a triangle mesh a shell: one surface, consistently turned, that does not cross itself?

mod box_tree;
mod checked;
mod clip;
mod crossing;
mod defect;
mod degenerate;
mod doubled;
mod edges;
mod error;
mod fill;
#[cfg(test)]
pub(crate) mod fixtures;
mod holes;
mod joints;
mod judge;
mod mend;
mod orientation;
mod parts;
mod separation;
mod slivers;
mod touching;
mod weld;

pub use checked::{CheckedMesh, Checks, checked_mesh};
pub use crossing::{Crossing, Crossings, crossings};
pub use defect::{Defect, DefectKind};
pub use edges::{EdgeReport, edge_report};
pub use error::RepairError;
pub use parts::{LeftOut, Parts, WhyLeftOut};
pub use touching::Touching;
