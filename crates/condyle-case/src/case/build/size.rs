//! Sizes of bodies, and pieces that lie far from them: memory grows with the size.

use std::path::Path;

use condyle::Vec3;
use condyle::geometry::TriangleMesh;

use super::super::frame::LengthUnit;
use super::error::{BuildError, MeshFault, StrayPiece};

/// Smallest and largest length of a part of a knee, mm.
const MIN_MM: f64 = 5.0;
const MAX_MM: f64 = 500.0;
/// Lengths of femoral components and inserts, mm. Another unit is the right one if it gives such a length; no two
/// units do.
const USUAL_MM: std::ops::RangeInclusive<f64> = 20.0..=200.0;

/// Rejects triangles whose size does not fit a part of a knee.
pub(super) fn check_triangles(
    file: &Path,
    mesh: &TriangleMesh,
    unit: LengthUnit,
) -> Result<(), BuildError> {
    check_points(file, &mesh.vertices, unit).map_err(|error| match stray_piece(mesh) {
        Some(piece) if is_possible(piece.body_mm) => {
            BuildError::mesh(file, MeshFault::StrayPiece(piece))
        }
        _ => error,
    })
}

pub(super) fn check_points(
    file: &Path,
    points: &[Vec3],
    unit: LengthUnit,
) -> Result<(), BuildError> {
    let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let (low, high) = points
        .iter()
        .fold(none, |(low, high), point| (low.inf(point), high.sup(point)));
    let size_mm = (high - low).max();
    // A body without points has no size; other checks reject it.
    if points.is_empty() || is_possible(size_mm) {
        return Ok(());
    }
    let in_unit = |other: LengthUnit| size_mm / unit.in_mm() * other.in_mm();
    let mut units = LengthUnit::ALL.iter().copied();
    let better = units.find(|&other| USUAL_MM.contains(&in_unit(other)));
    let better = better.map(|unit| (unit, in_unit(unit)));
    Err(BuildError::mesh(file, MeshFault::Size { size_mm, better }))
}

fn is_possible(size_mm: f64) -> bool {
    (MIN_MM..=MAX_MM).contains(&size_mm)
}

/// A connected set of triangles.
struct Piece {
    triangles: usize,
    low: Vec3,
    high: Vec3,
}

impl Piece {
    fn none() -> Self {
        Self {
            triangles: 0,
            low: Vec3::repeat(f64::INFINITY),
            high: Vec3::repeat(f64::NEG_INFINITY),
        }
    }

    fn add(&mut self, corners: &[Vec3; 3]) {
        self.triangles += 1;
        for corner in corners {
            (self.low, self.high) = (self.low.inf(corner), self.high.sup(corner));
        }
    }

    fn diagonal_mm(&self) -> f64 {
        (self.high - self.low).norm()
    }

    fn distance_mm(&self, other: &Self) -> f64 {
        let apart = (self.low - other.high).sup(&(other.low - self.high));
        apart.sup(&Vec3::zeros()).norm()
    }
}

/// Returns the piece farthest from the largest one, if its distance exceeds half of the size of the largest: the two
/// condyles or plateaus of a knee in two parts are nearer to each other.
pub(super) fn stray_piece(mesh: &TriangleMesh) -> Option<StrayPiece> {
    let pieces = pieces(mesh);
    let larger = |a: &&Piece, b: &&Piece| a.diagonal_mm().total_cmp(&b.diagonal_mm());
    let body = pieces.iter().max_by(larger)?;
    let away_mm = |piece: &Piece| piece.distance_mm(body);
    let farther = |a: &&Piece, b: &&Piece| away_mm(a).total_cmp(&away_mm(b));
    let farthest = pieces.iter().max_by(farther)?;
    (away_mm(farthest) > body.diagonal_mm() / 2.0).then(|| StrayPiece {
        triangles: farthest.triangles,
        at_mm: (farthest.low + farthest.high) / 2.0,
        away_mm: away_mm(farthest),
        body_mm: (body.high - body.low).max(),
    })
}

fn pieces(mesh: &TriangleMesh) -> Vec<Piece> {
    let mut parents: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    for &[a, b, c] in &mesh.triangles {
        for other in [b, c] {
            let (from, to) = (root(&mut parents, a), root(&mut parents, other));
            parents[from as usize] = to;
        }
    }
    let mut of_root: Vec<Option<usize>> = vec![None; mesh.vertices.len()];
    let mut pieces = Vec::new();
    for (triangle, &[vertex, ..]) in mesh.triangles.iter().enumerate() {
        let place = &mut of_root[root(&mut parents, vertex) as usize];
        let piece = *place.get_or_insert_with(|| {
            pieces.push(Piece::none());
            pieces.len() - 1
        });
        pieces[piece].add(&mesh.corners(triangle));
    }
    pieces
}

/// Returns the representative of the vertices connected with this one, and shortens the path to it.
fn root(parents: &mut [u32], mut vertex: u32) -> u32 {
    while parents[vertex as usize] != vertex {
        let parent = parents[vertex as usize];
        parents[vertex as usize] = parents[parent as usize];
        vertex = parent;
    }
    vertex
}
