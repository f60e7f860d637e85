//! Shapes, meshes, and the distance to a surface.

mod triangle_mesh;

pub use triangle_mesh::TriangleMesh;
