//! A triangle surface from any of the formats, by the ending of its name.

use std::path::Path;

use crate::TriangleMesh;

use super::error::MeshFileError;
use super::text::{Parser, parser, read_bytes};
use crate::files::Files;

/// Every format by the ending of its name.
const FORMATS: &[(&str, Parser<TriangleMesh>)] = &[
    ("stl", super::stl::parse),
    ("obj", super::obj::parse),
    ("ply", super::ply::parse),
    ("vtp", super::vtp::parse),
];

/// Reads a triangle surface from `.stl`, `.obj`, `.ply` or `.vtp`.
///
/// Polygons of more than three corners become a fan of triangles, points of exactly equal
/// coordinates become one vertex, and points that no triangle uses are left out. Lengths and
/// axes are the file's own. The shell is not judged here: see `condyle_mesh::repair::checked_mesh`.
///
/// # Errors
/// Names the file, and the line where the format is text: missing or unreadable file, unknown
/// ending, content that does not follow the format, no triangles, a coordinate that is not
/// finite, a polygon that names a vertex that is not there.
pub fn read_surface(
    files: &dyn Files,
    path: impl AsRef<Path>,
) -> Result<TriangleMesh, MeshFileError> {
    let path = path.as_ref();
    parse_surface(path, &surface_bytes(files, path)?)
}

/// The bytes of a surface's file, of one of the formats by its name.
pub fn surface_bytes(files: &dyn Files, path: &Path) -> Result<Vec<u8>, MeshFileError> {
    parser(path, FORMATS)?;
    read_bytes(files, path)
}

/// As [`read_surface`], from the bytes of the file.
///
/// # Errors
/// As [`read_surface`], but for a file that cannot be read.
pub fn parse_surface(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    parser(path, FORMATS)?(path, bytes)
}

#[cfg(test)]
mod tests {
    use crate::repair::checked_mesh;

    use super::*;
    use crate::files::Disk;
    use crate::formats::fixtures::{corners, message, tetrahedron};
    use crate::formats::stl::write_stl;

    #[test]
    fn the_ending_chooses_the_format_whatever_its_case() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("Femur.STL");
        write_stl(std::fs::File::create(&path).unwrap(), &tetrahedron()).unwrap();
        let mesh = read_surface(&Disk, &path).unwrap();
        assert_eq!(corners(&mesh), corners(&tetrahedron()));
        assert_eq!(mesh.vertices.len(), 4);
    }

    #[test]
    fn a_missing_file_and_an_unknown_ending_say_so() {
        let said = message(read_surface(&Disk, "nowhere/femur.stl"));
        assert_eq!(
            said,
            "nowhere/femur.stl: there is no such file; check the path"
        );
        let said = message(read_surface(&Disk, "femur.step"));
        let expected = "femur.step: the ending \"step\" is not a known format; use one of .stl, .obj, .ply, .vtp";
        assert_eq!(said, expected);
    }

    #[test]
    fn a_folder_is_not_readable_as_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("femur.stl");
        std::fs::create_dir(&path).unwrap();
        assert!(message(read_surface(&Disk, &path)).contains("cannot be read"));
    }

    /// The real implant is data beside the repository, not in it.
    fn dm_knee(file: &str) -> Option<TriangleMesh> {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/dm-knee");
        let path = Path::new(folder).join(file);
        if !path.exists() {
            eprintln!("skipped: dm_knee: shared/data/dm-knee/{file} is not there");
            return None;
        }
        Some(read_surface(&Disk, path).unwrap())
    }

    #[test]
    fn the_dm_femur_is_welded_to_a_closed_shell() {
        let Some(femur) = dm_knee("femoral-component.stl") else {
            return;
        };
        assert_eq!(
            (femur.triangles.len(), femur.vertices.len()),
            (24_442, 12_223)
        );
        let volume_mm3 = femur.signed_volume() * 1e9;
        assert!((volume_mm3 - 38_087.331).abs() < 0.001, "{volume_mm3}");
    }

    #[test]
    fn the_dm_insert_is_welded_to_a_closed_shell() {
        let Some(insert) = dm_knee("tibial-insert.stl") else {
            return;
        };
        assert_eq!(
            (insert.triangles.len(), insert.vertices.len()),
            (52_918, 26_459)
        );
        let volume_mm3 = insert.signed_volume() * 1e9;
        assert!((volume_mm3 - 24_796.159).abs() < 0.001, "{volume_mm3}");
    }

    #[test]
    fn both_dm_shells_pass_every_check_unchanged() {
        for (file, wrinkles) in [("femoral-component.stl", 0), ("tibial-insert.stl", 43)] {
            let Some(mesh) = dm_knee(file) else { return };
            let shell = checked_mesh(mesh.clone()).unwrap();
            assert!(shell.closed && !shell.turned_round, "{file}");
            assert_eq!(
                (shell.made_consistent, shell.removed_degenerate),
                (0, 0),
                "{file}"
            );
            assert_eq!(shell.wrinkles, wrinkles, "{file}");
            assert_eq!(shell.mesh, mesh, "{file}");
        }
    }
}
