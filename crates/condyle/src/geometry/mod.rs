//! Shapes, meshes, and the distance to a surface.

mod articulating_surface;
mod columns;
mod curvature_grid;
mod curved_mesh;
mod cylinder;
mod faces_around;
mod femoral_surface;
mod generic_femur;
mod generic_insert;
mod insert;
mod node_blocks;
mod share;
mod shell;
mod shell_insert;
mod smooth_field;
mod spline;
mod thickness;
mod torus;
mod triangle_mesh;

pub use articulating_surface::ArticulatingSurface;
pub use columns::{Column, ColumnGrid, ColumnMesh};
pub use curved_mesh::{CurvedMesh, Foot};
pub use cylinder::Cylinder;
pub use faces_around::FacesAround;
pub use femoral_surface::{Curvature, CurvatureBounds, FemoralSurface, SurfaceSample};
pub use generic_femur::{GenericFemur, GenericFemurShape};
pub use generic_insert::{GenericInsertShape, Meshing, flat_insert};
pub use insert::{Insert, InsertError};
pub use node_blocks::NodeBlock;
pub use share::Share;
pub use shell::{
    CheckedShell, Crossing, Crossings, ShellError, ShellReport, checked_shell, crossings,
    shell_report,
};
pub use shell_insert::{ShellInsertError, insert_from_shell};
pub use smooth_field::SmoothField;
pub use torus::Torus;
pub use triangle_mesh::TriangleMesh;
