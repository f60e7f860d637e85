//! VTK polygonal data (`.vtp`) and unstructured grids (`.vtu`), in.

use std::path::Path;

use condyle_fem::HexMesh;

use super::{
    error::MeshFileError,
    hex_draft::{HexDraft, HexFile, not_hexahedron},
    surface_draft::SurfaceDraft,
    text::At,
    vtk_xml::{Cells, DataArray, Piece},
};
use crate::{TriangleMesh, Vec3};

const HEXAHEDRON: i64 = 12;
const QUAD: i64 = 9;
/// VTK's numbers of other kinds of cells.
const KINDS: [(i64, &str); 9] = [
    (5, "triangle"),
    (7, "polygon"),
    (10, "tetrahedron"),
    (11, "voxel"),
    (13, "wedge"),
    (14, "pyramid"),
    (24, "quadratic tetrahedron"),
    (25, "quadratic hexahedron"),
    (29, "triquadratic hexahedron"),
];
/// Cells of points and lines have neither volume nor faces.
const PASSED_OVER: [i64; 4] = [1, 2, 3, 4];

/// Reads polygons and triangle strips; vertices and lines are passed over.
pub(super) fn parse_vtp(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    let piece = Piece::read(path, bytes, "PolyData", &["Points", "Polys", "Strips"])?;
    let mut draft = SurfaceDraft::new(path, 0);
    for point in piece.points()? {
        draft.point(At::file(path), point)?;
    }
    let polygons = piece.cells("Polys")?;
    for polygon in polygons.iter() {
        draft.polygon(At::line(path, polygons.line), polygon)?;
    }
    let strips = piece.cells("Strips")?;
    for strip in strips.iter() {
        for (index, corners) in strip.windows(3).enumerate() {
            // Every second triangle of a strip runs the other way round.
            let turn = index % 2;
            let triangle = [corners[0], corners[1 + turn], corners[2 - turn]];
            draft.polygon(At::line(path, strips.line), &triangle)?;
        }
    }
    draft.finish()
}

/// A hexahedral mesh with its scalars and vectors at the nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct VtuFile {
    /// The hexahedra and all nodes, as in the file.
    pub mesh: HexMesh,
    /// Name and one value per node, in the order of the file.
    pub point_data: Vec<(String, Vec<f64>)>,
    /// Name and one vector per node, in the order of the file.
    pub point_vectors: Vec<(String, Vec<[f64; 3]>)>,
}

impl VtuFile {
    /// Returns the scalars of that name, one per node.
    pub fn values(&self, name: &str) -> Option<&[f64]> {
        let found = self.point_data.iter().find(|(found, _)| found == name);
        found.map(|(_, values)| values.as_slice())
    }
}

/// Reads a `.vtu` of hexahedra with its point data from the bytes of the file at `path`.
///
/// Nodes are numbered as in the file. Arrays of neither one nor three components are left out. The shape of the
/// elements is not checked, so that a failed run can be looked at.
///
/// # Errors
/// Content that does not follow the format, and other cells than hexahedra, as for
/// [`read_hexahedra`](super::read_hexahedra).
pub fn parse_vtu_points(path: &Path, bytes: &[u8]) -> Result<VtuFile, MeshFileError> {
    let grid = Grid::read(path, bytes)?;
    let mut hexes = Vec::with_capacity(grid.kinds.len());
    for cell in grid.hexahedra() {
        let corners: [u64; 8] = grid.corners(cell)?;
        let missing = corners
            .iter()
            .find(|&&node| node >= grid.points.len() as u64);
        if let Some(&node) = missing {
            let numbering = format!("from 0 to {}", grid.points.len() as i64 - 1);
            let at = At::line(path, grid.cells.line);
            let cell = format_args!("cell {cell}");
            return Err(at.no_such_vertex(cell, node.cast_signed(), numbering));
        }
        hexes.push(corners.map(|node| node as u32));
    }
    let (mut point_data, mut point_vectors) = (Vec::new(), Vec::new());
    for array in grid.piece.arrays("PointData") {
        let name = array.name.clone();
        match array.components {
            1 => point_data.push((name, array.values.clone())),
            3 => point_vectors.push((name, array.vectors().collect())),
            _ => {}
        }
    }
    Ok(VtuFile {
        mesh: HexMesh {
            nodes: grid.points.iter().copied().map(Vec3::from).collect(),
            hexes: hexes.into(),
        },
        point_data,
        point_vectors,
    })
}

/// Reads a `.vtu` of triangles, such as the `femur.vtu` of a run, from the bytes of the file at `path`.
///
/// # Errors
/// Content that does not follow the format, and other cells than triangles.
pub fn parse_vtu_triangles(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    let piece = Piece::read(path, bytes, "UnstructuredGrid", &["Points", "Cells"])?;
    let vertices: Vec<Vec3> = piece.points()?.into_iter().map(Vec3::from).collect();
    let cells = piece.cells("Cells")?;
    let triangle = |corners: &[i64]| {
        let number = |&corner: &i64| {
            let number = u32::try_from(corner).ok();
            number.filter(|&number| (number as usize) < vertices.len())
        };
        let numbers: Option<Vec<u32>> = corners.iter().map(number).collect();
        let triangle = numbers.and_then(|numbers| <[u32; 3]>::try_from(numbers).ok());
        let problem = "a cell is not a triangle of points of the file";
        triangle.ok_or_else(|| At::line(path, cells.line).error(problem))
    };
    let triangles = cells.iter().map(triangle).collect::<Result<_, _>>()?;
    Ok(TriangleMesh {
        triangles,
        vertices,
    })
}

/// Reads hexahedra, with arrays of 0 and 1 as surfaces.
pub(super) fn parse_vtu(path: &Path, bytes: &[u8]) -> Result<HexFile, MeshFileError> {
    let grid = Grid::read(path, bytes)?;
    let mut draft = HexDraft::new(path);
    for (label, &point) in (0..).zip(&grid.points) {
        draft.node(At::file(path), label, point)?;
    }
    for cell in grid.hexahedra() {
        draft.hex(At::file(path), cell as u64, grid.corners(cell)?)?;
    }
    let marks = |group| {
        grid.piece
            .arrays(group)
            .iter()
            .filter(|array| is_mark(array))
    };
    for mark in marks("CellData") {
        let quads = (0..grid.kinds.len()).filter(|&cell| grid.kinds[cell] == QUAD);
        for cell in quads.filter(|&cell| mark.values[cell] == 1.0) {
            draft.quad(&mark.name, At::file(path), grid.corners(cell)?);
        }
    }
    // The outer faces with four marked corners are a surface.
    for mark in marks("PointData") {
        let is_marked = |node: u64| mark.values.get(node as usize) == Some(&1.0);
        for quad in draft.free_quads(&draft.hexes) {
            if quad.iter().all(|&node| is_marked(node)) {
                draft.quad(&mark.name, At::file(path), quad);
            }
        }
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
    piece: Piece<'a>,
    points: Vec<[f64; 3]>,
    cells: Cells,
    kinds: Vec<i64>,
}

impl<'a> Grid<'a> {
    /// Reads a grid and checks the kinds of its cells and the lengths of its arrays.
    fn read(path: &'a Path, bytes: &[u8]) -> Result<Self, MeshFileError> {
        let groups = ["Cells", "Points", "PointData", "CellData"];
        let piece = Piece::read(path, bytes, "UnstructuredGrid", &groups)?;
        let kinds = piece
            .arrays("Cells")
            .iter()
            .find(|array| array.name == "types");
        let grid = Self {
            points: piece.points()?,
            cells: piece.cells("Cells")?,
            kinds: kinds.map_or_else(Vec::new, |array| array.indices().collect()),
            piece,
        };
        let (cells, kinds) = (grid.cells.iter().len(), grid.kinds.len());
        if kinds != cells {
            return Err(At::file(path).error(format!("has {cells} cells but {kinds} types")));
        }
        let is_known = |kind| kind == HEXAHEDRON || kind == QUAD || PASSED_OVER.contains(&kind);
        if let Some(cell) = grid.kinds.iter().position(|&kind| !is_known(kind)) {
            let kind = grid.kinds[cell];
            return Err(not_hexahedron(At::file(path), cell as u64, kind, &KINDS));
        }
        for (group, rows, of) in [
            ("PointData", grid.points.len(), "points"),
            ("CellData", cells, "cells"),
        ] {
            let arrays = grid.piece.arrays(group).iter();
            let mut wrong = arrays.filter(|array| array.values.len() != rows * array.components);
            if let Some(array) = wrong.next() {
                let (name, values) = (&array.name, array.values.len());
                let problem = format!("array {name:?} has {values} values for {rows} {of}");
                return Err(At::line(path, array.line).error(problem));
            }
        }
        Ok(grid)
    }

    fn hexahedra(&self) -> impl Iterator<Item = usize> {
        (0..self.kinds.len()).filter(|&cell| self.kinds[cell] == HEXAHEDRON)
    }

    fn corners<const N: usize>(&self, cell: usize) -> Result<[u64; N], MeshFileError> {
        let at = At::line(self.piece.path, self.cells.line);
        at.corners(format_args!("cell {cell}"), self.cells.get(cell))
    }
}
