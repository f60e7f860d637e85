//! Checks, mends and orients triangle meshes: one surface, consistently turned, that does not cross itself.

mod box_tree;
mod checked;
mod clip;
mod crossing;
mod defect;
mod edges;
#[cfg(test)]
pub(crate) mod fixtures;
mod holes;
mod parts;
mod touching;
mod weld;

pub use self::defect::RepairError;
pub use checked::{CheckedMesh, Checks, checked_mesh};
pub use crossing::{Crossing, Crossings, crossings};
pub use defect::{Defect, DefectKind};
pub use edges::{EdgeReport, edge_report};
pub use parts::{LeftOut, Parts, WhyLeftOut};
pub use touching::Touching;
