//! Triangle and hexahedral meshes: file formats, repair, and hexahedra in columns below a surface.
//!
//! The crate is independent of joints, cases and wear. Lengths are in mm.
//!
//! 1. **A file becomes a mesh.** [`formats`] reads and writes triangle surfaces ([`TriangleMesh`]) and hexahedra,
//!    from a disk or from memory ([`files`]).
//! 2. **A triangle mesh becomes a surface.** [`repair`] welds, closes and orients it, and lists the defects that it
//!    cannot repair. [`CurvedMesh`] takes its facets as samples of a curved surface, and
//!    [`DividedMesh`] divides those that are long. [`FittedSphere`] finds its ball or socket.
//! 3. **A surface becomes hexahedra.** [`columns`] fills the space below it with columns along y.
//!
//! ```
//! use std::path::Path;
//! use condyle_mesh::{TriangleMesh, Vec3, columns, formats, repair};
//!
//! let block = TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
//! let mut stl = Vec::new();
//! formats::write_stl(&mut stl, &block)?;
//!
//! let surface = formats::parse_surface(Path::new("block.stl"), &stl)?;
//! let body = repair::checked_mesh(surface)?;
//! let meshing = columns::Meshing { edge_mm: 2.0, layers: 3 };
//! let (insert, _) = columns::column_mesh(&body.mesh, body.closed, None, meshing)?;
//! let vtu = formats::vtu_bytes(&insert.mesh, &[])?;
//! assert!(vtu.starts_with(b"<?xml"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod coarse;
pub mod columns;
mod curved_mesh;
mod divided_mesh;
pub mod files;
mod fitted_sphere;
pub mod formats;
pub mod repair;
mod roughness;
mod triangle_mesh;

pub use coarse::{PICTURE_DEVIATION_MM, coarser};
pub use condyle_fem::Vec3;
pub use curved_mesh::{CurvedMesh, Foot};
pub use divided_mesh::{Cluster, DividedMesh, split_at_creases};
pub use fitted_sphere::{FittedSphere, Roundness};
pub use triangle_mesh::{TriangleMesh, bounds, hit};
