//! Triangle and hexahedral meshes: file formats, repair, and hexahedra in columns below a surface.
//!
//! Knows no joint, no case and no wear. Lengths are in mm.
//!
//! 1. **A file becomes a mesh.** [`formats`] reads and writes triangle surfaces ([`TriangleMesh`]) and hexahedra,
//!    from a disk or from memory ([`files`]).
//! 2. **A triangle mesh becomes a surface.** [`repair`] welds, closes and orients it, and lists what it cannot mend.
//!    [`CurvedMesh`] reads its facets as samples of a curved surface.
//! 3. **A surface becomes hexahedra.** [`columns`] fills the space below it with columns along y.

pub mod columns;
mod curved_mesh;
pub mod files;
pub mod formats;
mod height_map;
pub mod repair;
pub mod triangle;
mod triangle_mesh;

pub use crate::triangle_mesh::bounds;
pub use condyle_fem::Vec3;
pub use curved_mesh::{CurvedMesh, Foot};
pub use height_map::height_over;
pub use triangle_mesh::TriangleMesh;
