//! Mesh files: triangle surfaces in and out, hexahedral meshes in and out.
//!
//! Every reader gives the file's own unit and axes; the case file says what those are. Vertices
//! and nodes are numbered from 0 in the order of the file, whatever numbers the file uses.

mod error;
#[cfg(test)]
mod fixtures;
mod obj;
mod ply;
mod stl;
mod surface;
mod surface_draft;
mod text;
mod vtk_xml;
mod vtp;

pub use error::{MeshFileError, Place};
pub use stl::write_stl;
pub use surface::read_surface;
