//! VTK unstructured grids (`.vtu`), in: hexahedra, with arrays of 0 and 1 as sets.

use std::path::Path;

use condyle_fem::HexMesh;

use super::{
    error::{FileLine, MeshFileError},
    hex_draft::{DraftHex, HexDraft, HexFile},
    vtk_xml::{DataArray, VtkDocument, VtkSource},
    vtp::cells,
};
use crate::{TriangleMesh, Vec3};

const HEXAHEDRON: i64 = 12;
const QUAD: i64 = 9;
/// Cells of points and lines carry no volume and no face.
const PASSED_OVER: [i64; 4] = [1, 2, 3, 4];

/// A hexahedral mesh with its scalars and vectors at the nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct VtuFile {
    /// The hexahedra and all nodes, as in the file.
    pub mesh: HexMesh,
    /// Name and one value a node, in the order of the file.
    pub point_data: Vec<(String, Vec<f64>)>,
    /// Name and one vector a node, in the order of the file.
    pub point_vectors: Vec<(String, Vec<[f64; 3]>)>,
}

impl VtuFile {
    /// Values of the array of that name, one a node.
    pub fn values(&self, name: &str) -> Option<&[f64]> {
        let found = self.point_data.iter().find(|(found, _)| found == name);
        found.map(|(_, values)| values.as_slice())
    }
}

/// A `.vtu` of hexahedra with its point data, from the bytes of the file called `path`; nodes are
/// numbered as in the file.
///
/// Arrays of neither one nor three components are left out. The shape of the elements is not judged, so
/// that a result can be looked at whatever became of it.
///
/// # Errors
/// Those of the format, and other cells than hexahedra, as for [`read_hexahedra`](super::read_hexahedra).
pub fn parse_vtu_points(path: &Path, bytes: &[u8]) -> Result<VtuFile, MeshFileError> {
    let grid = Grid::read(path, bytes)?;
    let nodes: Vec<Vec3> = grid.points.points().map(Vec3::from).collect();
    let mut hexes = Vec::with_capacity(grid.cells.len());
    for (index, cell) in grid.cells.iter().enumerate() {
        if grid.kinds[index] == HEXAHEDRON {
            let corners: [u64; 8] = grid.corners(index)?;
            if let Some(&node) = corners.iter().find(|&&node| node >= nodes.len() as u64) {
                return Err(grid.no_such_point(cell.0, index, node, nodes.len()));
            }
            hexes.push(corners.map(|node| node as u32));
        }
    }
    let (mut point_data, mut point_vectors) = (Vec::new(), Vec::new());
    for array in grid.point_data {
        match array.components {
            1 => point_data.push((array.name, array.values)),
            3 => {
                let vectors = array.points().collect();
                point_vectors.push((array.name, vectors));
            }
            _ => {}
        }
    }
    let hexes = hexes.into();
    let mesh = HexMesh { nodes, hexes };
    Ok(VtuFile {
        mesh,
        point_data,
        point_vectors,
    })
}

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<HexFile, MeshFileError> {
    let grid = Grid::read(path, bytes)?;
    let mut draft = HexDraft::new(path);
    for (label, point) in (0..).zip(grid.points.points()) {
        draft.node(None, label, point)?;
    }
    for (index, &kind) in grid.kinds.iter().enumerate() {
        if kind == HEXAHEDRON {
            let nodes = grid.corners(index)?;
            draft.hex(DraftHex {
                label: index as u64,
                line: None,
                nodes,
            })?;
        }
    }
    for mark in grid.cell_data.iter().filter(|array| is_mark(array)) {
        grid.mark_cells(mark, &mut draft)?;
    }
    for mark in grid.point_data.iter().filter(|array| is_mark(array)) {
        grid.mark_points(mark, &mut draft)?;
    }
    draft.finish()
}

/// Whole numbers of 0 and 1 with at least one 1 mark a set; anything else is a result.
fn is_mark(array: &DataArray) -> bool {
    let is_flag = |&value: &f64| value == 0.0 || value == 1.0;
    array.is_integer
        && array.components == 1
        && array.values.iter().all(is_flag)
        && array.values.contains(&1.0)
}

struct Grid<'a> {
    path: &'a Path,
    points: DataArray,
    /// Line of the connectivity and points, one entry a cell.
    cells: Vec<(usize, Vec<i64>)>,
    kinds: Vec<i64>,
    point_data: Vec<DataArray>,
    cell_data: Vec<DataArray>,
}

impl<'a> Grid<'a> {
    fn read(path: &'a Path, bytes: &[u8]) -> Result<Self, MeshFileError> {
        let source = VtkSource::new(bytes);
        let document = VtkDocument::open(path, &source, "UnstructuredGrid")?;
        let piece = document.piece()?;
        let arrays = document.group(piece, "Cells")?;
        let kinds = arrays.iter().find(|array| array.name == "types");
        let grid = Self {
            path,
            points: document.point_array(piece)?,
            cells: cells(path, &arrays)?,
            kinds: kinds
                .map(|array| array.indices().collect())
                .unwrap_or_default(),
            point_data: document.group(piece, "PointData")?,
            cell_data: document.group(piece, "CellData")?,
        };
        grid.check()?;
        Ok(grid)
    }

    fn check(&self) -> Result<(), MeshFileError> {
        self.check_kinds()?;
        let points = self.points.values.len() / 3;
        self.check_lengths(&self.point_data, points, "points")?;
        self.check_lengths(&self.cell_data, self.cells.len(), "cells")
    }

    fn check_kinds(&self) -> Result<(), MeshFileError> {
        if self.kinds.len() != self.cells.len() {
            let what = format!(
                "has {} cells but {} types",
                self.cells.len(),
                self.kinds.len()
            );
            return Err(FileLine::file(self.path).error(what));
        }
        let known = |kind| kind == HEXAHEDRON || kind == QUAD || PASSED_OVER.contains(&kind);
        match self.kinds.iter().position(|&kind| !known(kind)) {
            None => Ok(()),
            Some(index) => Err(MeshFileError::NotHexahedron {
                at: FileLine::file(self.path),
                element: index as u64,
                kind: kind_in_words(self.kinds[index]),
            }),
        }
    }

    fn check_lengths(
        &self,
        arrays: &[DataArray],
        rows: usize,
        of: &str,
    ) -> Result<(), MeshFileError> {
        match arrays
            .iter()
            .find(|array| array.values.len() != rows * array.components)
        {
            None => Ok(()),
            Some(array) => {
                let (name, values) = (&array.name, array.values.len());
                let what = format!("array {name:?} has {values} values for {rows} {of}");
                Err(FileLine::line(self.path, array.line).error(what))
            }
        }
    }

    fn corners<const N: usize>(&self, cell: usize) -> Result<[u64; N], MeshFileError> {
        let (line, points) = &self.cells[cell];
        let corners = <[i64; N]>::try_from(points.as_slice()).map_err(|_| {
            let what = format!("cell {cell} has {} points; its type has {N}", points.len());
            FileLine::line(self.path, *line).error(what)
        })?;
        Ok(corners.map(i64::cast_unsigned))
    }

    fn no_such_point(&self, line: usize, cell: usize, point: u64, points: usize) -> MeshFileError {
        MeshFileError::IndexOutOfRange {
            at: FileLine::line(self.path, line),
            what: format!("cell {cell}"),
            index: point.cast_signed(),
            numbering: format!("from 0 to {}", points as i64 - 1),
        }
    }

    /// Marked quads make a surface; marked hexahedra a node set.
    fn mark_cells(&self, mark: &DataArray, draft: &mut HexDraft) -> Result<(), MeshFileError> {
        for (cell, _) in mark
            .values
            .iter()
            .enumerate()
            .filter(|&(_, &value)| value == 1.0)
        {
            match self.kinds[cell] {
                QUAD => draft.quad(&mark.name, None, self.corners(cell)?),
                HEXAHEDRON => draft.set_nodes(&mark.name, self.corners::<8>(cell)?),
                _ => {}
            }
        }
        Ok(())
    }

    /// Marked points make a node set, and the outer faces with four marked corners a surface.
    fn mark_points(&self, mark: &DataArray, draft: &mut HexDraft) -> Result<(), MeshFileError> {
        let marked = |node: u64| mark.values.get(node as usize) == Some(&1.0);
        let nodes = (0..mark.values.len() as u64).filter(|&node| marked(node));
        draft.set_nodes(&mark.name, nodes);
        for quad in draft.free_quads(draft.hexes()) {
            if quad.iter().all(|&node| marked(node)) {
                draft.quad(&mark.name, None, quad);
            }
        }
        Ok(())
    }
}

fn kind_in_words(kind: i64) -> String {
    let name = match kind {
        5 => "triangle",
        7 => "polygon",
        10 => "tetrahedron",
        11 => "voxel",
        13 => "wedge",
        14 => "pyramid",
        24 => "quadratic tetrahedron",
        25 => "quadratic hexahedron",
        29 => "triquadratic hexahedron",
        _ => return kind.to_string(),
    };
    format!("{kind} ({name})")
}

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
    use crate::formats::{
        Grid, compact_vtu_bytes,
        fixtures::{message, two_cubes},
        vtu_write::{PointArray, PointValues, vtu_bytes},
    };

    const TEXT: &str = r#"<VTKFile type="UnstructuredGrid" version="0.1">
<UnstructuredGrid><Piece NumberOfPoints="13" NumberOfCells="4">
<PointData><DataArray type="Int64" Name="fixed" format="ascii">1 1 0 1 1 0 1 1 0 1 1 0 0</DataArray>
<DataArray type="Float64" Name="depth" format="ascii">1 1 1 1 1 1 1 1 1 1 1 1 1</DataArray></PointData>
<CellData><DataArray type="Int8" Name="top" format="ascii">0 1 1 0</DataArray>
<DataArray type="Int8" Name="second" format="ascii">0 0 0 1</DataArray></CellData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0
0 0 1 1 0 1 2 0 1 0 1 1 1 1 1 2 1 1 9 9 9
</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 4 3 6 7 10 9
6 9 10 7 7 8 11 10
1 2 5 4 7 8 11 10</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">8 12 16 24</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">12 9 9 12</DataArray>
</Cells></Piece></UnstructuredGrid></VTKFile>
"#;

    fn read(bytes: &[u8]) -> Result<HexFile, MeshFileError> {
        parse(Path::new("a.vtu"), bytes)
    }

    #[test]
    fn hexahedra_quads_and_marks_are_read() {
        let file = read(TEXT.as_bytes()).unwrap();
        assert_eq!(file.mesh, two_cubes());
        assert_eq!(
            file.surface("top").unwrap().quads,
            [[6, 7, 10, 9], [7, 8, 11, 10]]
        );
        assert_eq!(
            file.node_set("second").unwrap().nodes,
            [1, 2, 4, 5, 7, 8, 10, 11]
        );
        assert_eq!(
            file.node_set("fixed").unwrap().nodes,
            [0, 1, 3, 4, 6, 7, 9, 10]
        );
        assert_eq!(file.surface("fixed").unwrap().quads.len(), 5);
        assert!(file.surface("depth").is_none() && file.node_set("depth").is_none());
    }

    #[test]
    fn what_was_written_comes_back() {
        let mesh = two_cubes();
        let depth: Vec<f64> = (0..12).map(|node| f64::from(node) / 7.0).collect();
        let flags = [0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1];
        let along: Vec<[f64; 3]> = depth.iter().map(|&depth| [depth, 0.0, -depth]).collect();
        let arrays = [
            PointArray {
                name: "direction",
                values: PointValues::Vectors(&along),
            },
            PointArray {
                name: "depth_mm",
                values: PointValues::Float64(&depth),
            },
            PointArray {
                name: "articulating",
                values: PointValues::UInt8(&flags),
            },
        ];
        let bytes = vtu_bytes(&mesh, &arrays).unwrap();
        assert_eq!(bytes, vtu_bytes(&mesh, &arrays).unwrap());
        let points = parse_vtu_points(Path::new("a.vtu"), &bytes).unwrap();
        assert_eq!(points.mesh, mesh);
        assert_eq!(points.values("depth_mm").unwrap(), depth);
        assert_eq!(points.point_vectors, [("direction".to_owned(), along)]);
        assert_eq!(points.values("articulating").unwrap(), flags.map(f64::from));
        let file = read(&bytes).unwrap();
        assert_eq!(file.mesh, mesh);
        let surface = file.surface("articulating").unwrap();
        assert_eq!(surface.quads, [[6, 7, 10, 9], [7, 8, 11, 10]]);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let said = |from, to| message(read(TEXT.replace(from, to).as_bytes()));
        let kind = said("12 9 9 12<", "12 9 9 10<");
        assert!(
            kind.starts_with("a.vtu: element 3 is of type 10 (tetrahedron)"),
            "{kind}"
        );
        assert!(said("12 9 9 12<", "12 9 9<").contains("has 4 cells but 3 types"));
        assert!(said("8 12 16 24", "7 12 16 24").contains("cell 0 has 7 points"));
        assert!(said("1 2 5 4 7", "7 8 11 10 1").contains("hexahedron 3 is inverted"));
        assert!(said("1 2 5 4 7", "1 2 5 4 77").contains("element 3 names vertex 77"));
        assert!(said("6 9 10 7 7", "1 4 10 7 7").contains("face of surface \"top\" is not"));
        assert!(said("0 1 1 0<", "0 1 1<").contains("array \"top\" has 3 values for 4 cells"));
        assert!(said("2 1 1 9 9 9", "2 1 1 9 9 inf").contains("node 12 has a coordinate"));
        assert!(said("UnstructuredGrid\"", "PolyData\"").contains("of type UnstructuredGrid"));
    }

    #[test]
    fn a_result_with_a_point_out_of_range_is_an_error() {
        let text = TEXT.replace("1 2 5 4 7", "1 2 5 4 77");
        let said = message(parse_vtu_points(Path::new("a.vtu"), text.as_bytes()));
        let expected =
            "a.vtu:12: cell 3 names vertex 77, but the file numbers its vertices from 0 to 12";
        assert_eq!(said, expected);
    }

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
