//! Shapes, meshes, and the distance to a surface.

mod curved_mesh;
mod femoral_surface;
mod generic_femur;
mod smooth_field;
mod torus;
mod triangle_mesh;

pub use femoral_surface::{FemoralSurface, SurfaceSample};
pub use generic_femur::{GenericFemur, GenericFemurShape};
pub use smooth_field::SmoothField;
pub use torus::Torus;
pub use triangle_mesh::TriangleMesh;
