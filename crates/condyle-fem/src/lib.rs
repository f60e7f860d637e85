//! Hexahedral meshes and elements; knows nothing of knees.
//!
//! Lengths are in whatever unit the mesh is in; condyle uses millimetres.

mod follow;
mod hex;
mod mesh;
mod quality;

pub use follow::InteriorFollower;
pub use hex::{HEX_FACES, trilinear_volume, volume_below};
pub use mesh::HexMesh;

/// A point or a vector in space.
pub type Vec3 = nalgebra::Vector3<f64>;
