//! Hexahedral meshes and elements; knows nothing of knees.
//!
//! Lengths are in whatever unit the mesh is in; condyle uses millimetres.

mod follow;
mod hex;
mod mesh;
mod neighbours;
mod quality;
mod vector;

pub use follow::InteriorFollower;
pub use hex::{HEX_FACES, trilinear_volume, volume_below};
pub use mesh::HexMesh;
pub use vector::Vec3;
