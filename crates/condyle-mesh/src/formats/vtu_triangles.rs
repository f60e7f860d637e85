//! VTK unstructured grids (`.vtu`) of triangles, in.

use std::path::Path;

use crate::{TriangleMesh, Vec3};

use super::error::{FileLine, MeshFileError};
use super::vtk_xml::{VtkDocument, VtkSource};
use super::vtp::cells;

/// A `.vtu` of triangles, such as the `femur.vtu` of a run, from the bytes of the file called `path`.
///
/// # Errors
/// Those of the format, and other cells than triangles.
pub fn parse_vtu_triangles(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    let source = VtkSource::new(bytes);
    let document = VtkDocument::open(path, &source, "UnstructuredGrid")?;
    let piece = document.piece()?;
    let points = document.point_array(piece)?;
    let vertices: Vec<Vec3> = points.points().map(Vec3::from).collect();
    let cells = cells(path, &document.group(piece, "Cells")?)?;
    let triangle = |(line, corners): &(usize, Vec<i64>)| {
        triangle_of(corners, vertices.len()).ok_or_else(|| {
            let what = "a cell is no triangle of points of the file".to_owned();
            FileLine::line(path, *line).error(what)
        })
    };
    let triangles: Result<_, _> = cells.iter().map(triangle).collect();
    Ok(TriangleMesh {
        triangles: triangles?,
        vertices,
    })
}

fn triangle_of(corners: &[i64], vertices: usize) -> Option<[u32; 3]> {
    let number = |&corner: &i64| {
        let number = u32::try_from(corner).ok();
        number.filter(|&number| (number as usize) < vertices)
    };
    let numbers: Option<Vec<u32>> = corners.iter().map(number).collect();
    numbers?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{Grid, compact_vtu_bytes, fixtures::message};

    #[test]
    fn triangles_come_back() {
        let nodes = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5]].map(Vec3::from);
        let triangles = [[0, 2, 1], [0, 1, 3]];
        let bytes = compact_vtu_bytes(&Grid::triangles(&nodes, &triangles), &[]).unwrap();
        let mesh = parse_vtu_triangles(Path::new("a.vtu"), &bytes).unwrap();
        assert_eq!(
            (mesh.vertices, mesh.triangles),
            (nodes.into(), triangles.into())
        );
        let quads = compact_vtu_bytes(&Grid::quads(&nodes, &[[0, 1, 2, 3]]), &[]).unwrap();
        let said = message(parse_vtu_triangles(Path::new("a.vtu"), &quads));
        assert!(said.contains("a cell is no triangle"), "{said}");
    }
}
