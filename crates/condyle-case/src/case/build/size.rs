//! Sizes of bodies, and pieces that lie far from them: memory grows with the size.

use std::path::Path;

use condyle::Vec3;
use condyle::geometry::TriangleMesh;
use condyle_mesh::bounds;

use super::error::BuildError;
use crate::case::frame::LengthUnit;

/// Smallest and largest length of a part of a knee, mm.
const POSSIBLE_MM: std::ops::RangeInclusive<f64> = 5.0..=500.0;
/// Lengths of femoral components and inserts, mm. Another unit is the right one if it gives such a length; no two
/// units do.
const USUAL_MM: std::ops::RangeInclusive<f64> = 20.0..=200.0;

/// Rejects triangles whose size does not fit a part of a knee: memory grows with the size.
pub(super) fn check_triangles(
    file: &Path,
    mesh: &TriangleMesh,
    unit: LengthUnit,
) -> Result<(), BuildError> {
    check_points(file, &mesh.vertices, unit).map_err(|error| match stray_piece(mesh) {
        Some(piece) if POSSIBLE_MM.contains(&piece.body_mm) => {
            let message = format!("{}, too far to be part of a knee; delete it", piece.text);
            BuildError::mesh(file, &["file"], message)
        }
        _ => error,
    })
}

pub(super) fn check_points(
    file: &Path,
    points: &[Vec3],
    unit: LengthUnit,
) -> Result<(), BuildError> {
    let (low, high) = bounds(points);
    let size_mm = (high - low).max();
    // A body without points has no size; other checks reject it.
    if points.is_empty() || POSSIBLE_MM.contains(&size_mm) {
        return Ok(());
    }
    let in_unit = |other: LengthUnit| (other, size_mm / unit.in_mm() * other.in_mm());
    let mut better = LengthUnit::ALL.iter().copied().map(in_unit);
    let remedy = match better.find(|(_, size_mm)| USUAL_MM.contains(size_mm)) {
        Some(better) => in_better_unit(better),
        None => "check length_unit and the mesh".to_owned(),
    };
    let size = rounded(size_mm);
    let message =
        format!("the body is {size} mm long, and an implant's is 5 mm to 500 mm; {remedy}");
    Err(BuildError::mesh(file, &["length_unit", "file"], message))
}

/// Formats sizes from nanometres to kilometres with three digits.
pub(super) fn rounded(size_mm: f64) -> String {
    if (0.1..1e5).contains(&size_mm) {
        format!("{size_mm:.1}")
    } else {
        format!("{size_mm:.2e}")
    }
}

pub(super) fn in_better_unit((unit, size_mm): (LengthUnit, f64)) -> String {
    let unit = unit.word();
    format!("write length_unit = \"{unit}\", with which it is {size_mm:.1} mm long")
}

/// A piece of a mesh that lies far from the largest one, the body.
pub(super) struct StrayPiece {
    pub text: String,
    /// Longest edge of the body's box, mm.
    body_mm: f64,
}

/// A connected set of triangles in its box.
struct Piece {
    triangles: usize,
    low: Vec3,
    high: Vec3,
}

impl Piece {
    fn diagonal_mm(&self) -> f64 {
        (self.high - self.low).norm()
    }
}

/// Returns the piece farthest from the largest one, if its distance exceeds half of the size of the largest: the two
/// condyles or plateaus of a knee in two parts are nearer to each other.
pub(super) fn stray_piece(mesh: &TriangleMesh) -> Option<StrayPiece> {
    let pieces = pieces(mesh);
    let larger = |a: &&Piece, b: &&Piece| a.diagonal_mm().total_cmp(&b.diagonal_mm());
    let body = pieces.iter().max_by(larger)?;
    let away_mm = |piece: &Piece| {
        // Along an axis on which the boxes overlap, both differences are negative.
        let apart = (piece.low - body.high).sup(&(body.low - piece.high));
        apart.sup(&Vec3::zeros()).norm()
    };
    let farther = |a: &&Piece, b: &&Piece| away_mm(a).total_cmp(&away_mm(b));
    let farthest = pieces.iter().max_by(farther)?;
    let (at, away) = ((farthest.low + farthest.high) / 2.0, away_mm(farthest));
    (away > body.diagonal_mm() / 2.0).then(|| StrayPiece {
        text: format!(
            "a piece of {} triangles at ({:.0}, {:.0}, {:.0}) mm lies {away:.0} mm from the body",
            farthest.triangles, at.x, at.y, at.z
        ),
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
        let index = *place.get_or_insert_with(|| {
            pieces.push(Piece {
                triangles: 0,
                low: Vec3::repeat(f64::INFINITY),
                high: Vec3::repeat(f64::NEG_INFINITY),
            });
            pieces.len() - 1
        });
        let piece = &mut pieces[index];
        piece.triangles += 1;
        for corner in mesh.corners(triangle) {
            (piece.low, piece.high) = (piece.low.inf(&corner), piece.high.sup(&corner));
        }
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
