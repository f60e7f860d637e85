//! Small meshes for the tests of the formats.

use crate::TriangleMesh;
use crate::Vec3;
use condyle_fem::HexMesh;

use super::error::MeshFileError;

/// A corner of the unit cube, closed, facing outwards.
pub(crate) fn tetrahedron() -> TriangleMesh {
    TriangleMesh {
        vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()],
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    }
}

/// What the error of a reading says.
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
