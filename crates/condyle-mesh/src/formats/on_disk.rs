//! The files of a run on the disk.

use std::path::{Path, PathBuf};

use condyle_fem::HexMesh;

use super::error::MeshFileError;
use super::pvd::{parse_pvd, pvd_text};
use super::text::read_bytes;
use super::vtu::{VtuFile, parse_vtu_points};
use super::vtu_write::{PointArray, vtu_bytes};
use crate::files::Disk;

/// Reads a `.vtu` of hexahedra with its point data, nodes numbered as in the file.
///
/// # Errors
/// A missing or unreadable file, and those of [`parse_vtu_points`].
pub fn read_vtu_points(path: impl AsRef<Path>) -> Result<VtuFile, MeshFileError> {
    let path = path.as_ref();
    parse_vtu_points(path, &read_bytes(&Disk, path)?)
}

/// Reads a `.pvd` file: each data set's time and its file, joined to the collection's folder.
///
/// # Errors
/// A missing or unreadable file, and those of [`parse_pvd`].
pub fn read_pvd(path: impl AsRef<Path>) -> Result<Vec<(f64, PathBuf)>, MeshFileError> {
    let path = path.as_ref();
    parse_pvd(path, &read_bytes(&Disk, path)?)
}

/// Writes a `.pvd` file.
///
/// # Errors
/// [`MeshFileError::Unwritable`] where the system refuses.
pub fn write_pvd<'a>(
    path: impl AsRef<Path>,
    series: impl IntoIterator<Item = (f64, &'a str)>,
) -> Result<(), MeshFileError> {
    write_bytes(path.as_ref(), pvd_text(series).as_bytes())
}

/// Writes a `.vtu` file of the mesh with its arrays.
///
/// # Errors
/// [`MeshFileError::ArrayLength`] as for [`vtu_bytes`]; [`MeshFileError::Unwritable`] where the
/// system refuses.
pub fn write_vtu(
    path: impl AsRef<Path>,
    mesh: &HexMesh,
    arrays: &[PointArray],
) -> Result<(), MeshFileError> {
    write_bytes(path.as_ref(), &vtu_bytes(mesh, arrays)?)
}

fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), MeshFileError> {
    std::fs::write(path, bytes).map_err(|source| {
        let path = path.to_path_buf();
        MeshFileError::Unwritable { path, source }
    })
}
