//! Checks, repairs and orients triangle meshes: one surface, consistently turned, that does not cross itself.
//!
//! ```
//! use condyle_mesh::{TriangleMesh, Vec3, repair::checked_mesh};
//!
//! let mut block = TriangleMesh::block(Vec3::zeros(), Vec3::repeat(1.0));
//! block.triangles[3].swap(0, 1);
//! let checked = checked_mesh(block)?;
//! assert_eq!(checked.made_consistent, 1);
//! assert!(checked.closed && checked.mesh.signed_volume() > 0.0);
//! # Ok::<(), condyle_mesh::repair::RepairError>(())
//! ```

mod box_tree;
mod checked;
mod clip;
mod crossing;
mod defect;
mod edges;
mod holes;
mod parts;
#[cfg(test)]
mod tests;
mod touching;
mod weld;

pub use self::defect::RepairError;
pub use checked::{CheckedMesh, Checks, checked_mesh};
pub use defect::{Defect, DefectKind};
pub use edges::{EdgeReport, border_sides, edge_report};
pub(crate) use edges::{EdgeUse, by_edge, edge_uses};
pub use parts::{LeftOut, Parts, WhyLeftOut};
pub use touching::Touching;
pub(crate) use weld::drop_unused;
