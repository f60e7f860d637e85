//! Mesh files: triangle surfaces in and out, hexahedral meshes in and out.
//!
//! Every reader gives the file's own unit and axes; the case file says what those are. Vertices
//! and nodes are numbered from 0 in the order of the file, whatever numbers the file uses.

mod error;
#[cfg(test)]
mod fixtures;
mod hex_draft;
mod hexahedra;
mod inp;
mod inp_writer;
mod msh;
mod obj;
#[cfg(feature = "file-system")]
mod on_disk;
mod ply;
mod pvd;
mod stl;
mod surface;
mod surface_draft;
mod text;
mod vtk_xml;
mod vtp;
mod vtu;
mod vtu_write;

pub use self::hex_draft::{HexFile, NamedNodes, NamedSurface};
pub use self::vtu::parse_vtu_triangles;
pub use error::{FileLine, MeshFileError};
pub use hexahedra::read_hexahedra;
pub use inp_writer::{
    AnalysisStep, Application, InpWriter, PressureOverclosure, Procedure, RigidTriangle,
    element_faces,
};
#[cfg(feature = "file-system")]
pub use on_disk::{read_pvd, read_vtu_points, write_pvd, write_vtu};
pub use pvd::{parse_pvd, pvd_text, pvd_text_of_parts};
pub use stl::write_stl;
pub use surface::{parse_surface, read_surface};
pub use vtu::{VtuFile, parse_vtu_points};
pub use vtu_write::{Grid, PointArray, PointValues, compact_vtu_bytes, vtu_bytes};

pub use surface::surface_bytes;
