//! Small meshes for the tests of the formats, and the tests of reading by extension.

mod vtp;
mod vtu;

use std::path::Path;

use condyle_fem::HexMesh;

use super::{MeshFileError, read_hexahedra, read_surface, write_stl};
use crate::{TriangleMesh, Vec3, files::Disk, repair::checked_mesh};

/// A corner of the unit cube, closed, facing outwards.
pub(crate) fn tetrahedron() -> TriangleMesh {
    TriangleMesh {
        vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    }
}

/// The message of a failed reading.
pub(crate) fn message<T>(result: Result<T, MeshFileError>) -> String {
    result
        .err()
        .expect("the fixture is wrong on purpose")
        .to_string()
}

/// The corners of all triangles, whatever the numbers of the vertices.
pub(crate) fn corners(mesh: &TriangleMesh) -> Vec<[Vec3; 3]> {
    (0..mesh.triangles.len())
        .map(|triangle| mesh.corners(triangle))
        .collect()
}

/// Two unit cubes in a row along x, nodes numbered x fastest, then y, then z.
pub(crate) fn two_cubes() -> HexMesh {
    let place = |node: u32| {
        let (x, y, z) = (node % 3, node / 3 % 2, node / 6);
        Vec3::new(f64::from(x), f64::from(y), f64::from(z))
    };
    HexMesh {
        nodes: (0..12).map(place).collect(),
        hexes: [[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]].into(),
    }
}

#[test]
fn the_extension_in_any_case_chooses_the_format() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Femur.STL");
    write_stl(std::fs::File::create(&path).unwrap(), &tetrahedron()).unwrap();
    let mesh = read_surface(&Disk, &path).unwrap();
    assert_eq!(corners(&mesh), corners(&tetrahedron()));
    assert_eq!(mesh.vertices.len(), 4);
}

#[test]
fn a_missing_file_and_an_unknown_extension_are_errors() {
    let reported = message(read_surface(&Disk, "nowhere/femur.stl"));
    assert_eq!(
        reported,
        "nowhere/femur.stl: there is no such file; check the path"
    );
    let reported = message(read_surface(&Disk, "femur.step"));
    let expected = "femur.step: the extension \"step\" is not a known format; use one of .stl, .obj, .ply, .vtp";
    assert_eq!(reported, expected);
}

#[test]
fn a_folder_is_not_readable_as_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("femur.stl");
    std::fs::create_dir(&path).unwrap();
    assert!(message(read_surface(&Disk, &path)).contains("cannot be read"));
}

/// The real implant is data next to the repository, not in it.
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

#[test]
fn a_missing_volume_file_and_an_unknown_extension_are_errors() {
    let reported = message(read_hexahedra(&Disk, "nowhere/insert.inp"));
    assert!(reported.contains("there is no such file"), "{reported}");
    let reported = message(read_hexahedra(&Disk, "insert.k"));
    assert!(
        reported.contains("\"k\" is not a known format; use one of .inp, .msh, .vtu"),
        "{reported}"
    );
}
