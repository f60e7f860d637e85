//! Mesh files: triangle surfaces and hexahedral meshes, in and out.
//!
//! Every reader returns the file's own unit and axes. Vertices and nodes are numbered from 0 in the order of the file,
//! whatever numbers the file uses.
//!
//! ```
//! use std::path::Path;
//! use condyle_mesh::formats::parse_surface;
//!
//! let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
//! let square = parse_surface(Path::new("square.obj"), obj.as_bytes())?;
//! assert_eq!(square.triangles, [[0, 1, 2], [0, 2, 3]]);
//!
//! let error = parse_surface(Path::new("square.obj"), b"v 0 0\n").unwrap_err();
//! assert_eq!(error.to_string(), "square.obj:1: a point needs three coordinates");
//! # Ok::<(), condyle_mesh::formats::MeshFileError>(())
//! ```

mod error;
mod hex_draft;
mod inp;
mod inp_writer;
mod msh;
mod obj;
mod ply;
mod pvd;
mod stl;
mod surface_draft;
#[cfg(test)]
mod tests;
mod text;
mod vtk;
mod vtk_arrays;
mod vtk_xml;
mod vtu_write;

use std::{io::ErrorKind, path::Path};

pub use error::MeshFileError;
pub use hex_draft::{HexFile, NamedSurface};
pub use inp_writer::{InpWriter, element_faces};
pub use pvd::{parse_pvd, pvd_text};
pub use stl::write_stl;
pub use vtk::{VtuFile, parse_vtu_points, parse_vtu_triangles};
pub use vtu_write::{Grid, PointArray, PointValues, compact_vtu_bytes, vtu_bytes};

#[cfg(feature = "file-system")]
use crate::files::Disk;
use crate::{TriangleMesh, files::Files};

/// Converts the bytes of a file to a mesh; the path is for messages.
type Parser<M> = fn(&Path, &[u8]) -> Result<M, MeshFileError>;

/// Formats of triangle surfaces by extension.
const SURFACES: &[(&str, Parser<TriangleMesh>)] = &[
    ("stl", stl::parse),
    ("obj", obj::parse),
    ("ply", ply::parse),
    ("vtp", vtk::parse_vtp),
];

/// Formats of hexahedral meshes by extension.
const HEXAHEDRA: &[(&str, Parser<HexFile>)] = &[
    ("inp", inp::parse),
    ("msh", msh::parse),
    ("vtu", vtk::parse_vtu),
];

/// Returns the parser in `formats` for the extension of a path, in any case.
fn parser<M>(path: &Path, formats: &[(&str, Parser<M>)]) -> Result<Parser<M>, MeshFileError> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let ending = ending.to_ascii_lowercase();
    let found = formats.iter().find(|(known, _)| *known == ending);
    found.map(|(_, parse)| *parse).ok_or_else(|| {
        let known: Vec<String> = formats.iter().map(|(e, _)| format!(".{e}")).collect();
        MeshFileError::UnknownExtension {
            path: path.to_path_buf(),
            ending,
            known: known.join(", "),
        }
    })
}

fn read_bytes(files: &dyn Files, path: &Path) -> Result<Vec<u8>, MeshFileError> {
    files.read(path).map_err(|source| {
        let path = path.to_path_buf();
        if source.kind() == ErrorKind::NotFound {
            return MeshFileError::Missing { path };
        }
        MeshFileError::Inaccessible { path, source }
    })
}

/// Reads a triangle surface from `.stl`, `.obj`, `.ply` or `.vtp`.
///
/// Polygons of more than three corners become a fan of triangles, points of exactly equal
/// coordinates become one vertex, and points that no triangle uses are left out.
/// [`crate::repair::checked_mesh`] checks the surface.
///
/// # Errors
/// Names the file, and the line where the format is text: missing or unreadable file, unknown
/// extension, content that does not follow the format, no triangles, a coordinate that is not
/// finite, a polygon that names a missing vertex.
pub fn read_surface(
    files: &dyn Files,
    path: impl AsRef<Path>,
) -> Result<TriangleMesh, MeshFileError> {
    let path = path.as_ref();
    parse_surface(path, &surface_bytes(files, path)?)
}

/// Reads the bytes of a surface file with a known extension.
///
/// # Errors
/// A missing or unreadable file, or an unknown extension.
pub fn surface_bytes(files: &dyn Files, path: &Path) -> Result<Vec<u8>, MeshFileError> {
    parser(path, SURFACES)?;
    read_bytes(files, path)
}

/// Converts the bytes of a surface file as [`read_surface`] does.
///
/// # Errors
/// As [`read_surface`], except for a file that cannot be read.
pub fn parse_surface(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    parser(path, SURFACES)?(path, bytes)
}

/// Reads a mesh of 8-node hexahedra from Abaqus `.inp`, Gmsh `.msh` (2.2 and 4.1, text) or `.vtu`.
///
/// Named surfaces come from `*SURFACE`, from physical groups of quads, and from arrays of 0 and 1
/// over points or cells; their quads are turned to face outwards.
///
/// # Errors
/// Names the file, and the line where the format is text: missing or unreadable file, unknown
/// extension, content that does not follow the format or is not understood, several parts or
/// instances, an element that is not a hexahedron, or is inverted or flat, a missing or infinite
/// node, a surface that is not on the boundary.
pub fn read_hexahedra(files: &dyn Files, path: impl AsRef<Path>) -> Result<HexFile, MeshFileError> {
    let path = path.as_ref();
    parser(path, HEXAHEDRA)?(path, &read_bytes(files, path)?)
}

/// Reads a `.vtu` of hexahedra with its point data from the disk.
///
/// # Errors
/// A missing or unreadable file, and those of [`parse_vtu_points`].
#[cfg(feature = "file-system")]
pub fn read_vtu_points(path: impl AsRef<Path>) -> Result<VtuFile, MeshFileError> {
    let path = path.as_ref();
    parse_vtu_points(path, &read_bytes(&Disk, path)?)
}

/// Reads a `.pvd` file from the disk: the time and the path of each data set.
///
/// # Errors
/// A missing or unreadable file, and those of [`parse_pvd`].
#[cfg(feature = "file-system")]
pub fn read_pvd(path: impl AsRef<Path>) -> Result<Vec<(f64, std::path::PathBuf)>, MeshFileError> {
    let path = path.as_ref();
    parse_pvd(path, &read_bytes(&Disk, path)?)
}
