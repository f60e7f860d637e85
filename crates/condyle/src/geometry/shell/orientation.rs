//! Which side is out: neighbours are made to agree, closed bodies to face outwards.

use super::edges::{EdgeUse, by_edge};
use super::error::ShellError;
use crate::Vec3;
use crate::geometry::triangle_mesh::TriangleMesh;

/// What was found and done.
pub(super) struct Oriented {
    pub(super) closed: bool,
    pub(super) turned_round: bool,
    pub(super) made_consistent: usize,
}

/// Turns triangles in place; edges have two triangles at most.
pub(super) fn orient(mesh: &mut TriangleMesh, uses: &[EdgeUse]) -> Result<Oriented, ShellError> {
    let pieces = agreeing_pieces(mesh, uses)?;
    let made_consistent = pieces.iter().map(|piece| piece.turned.len()).sum();
    for &triangle in pieces.iter().flat_map(|piece| &piece.turned) {
        turn(mesh, triangle);
    }
    let bodies: Vec<Body> = pieces
        .iter()
        .filter(|piece| !piece.is_open)
        .map(|piece| Body::new(mesh, piece))
        .collect();
    let inside_out: Vec<&Body> = bodies
        .iter()
        .filter(|body| body.is_inside_out(&bodies))
        .collect();
    for &triangle in inside_out.iter().flat_map(|body| &body.piece.triangles) {
        turn(mesh, triangle);
    }
    Ok(Oriented {
        closed: pieces.iter().all(|piece| !piece.is_open),
        turned_round: !inside_out.is_empty(),
        made_consistent,
    })
}

fn turn(mesh: &mut TriangleMesh, triangle: u32) {
    mesh.triangles[triangle as usize].swap(1, 2);
}

/// Triangles that hang together by edges.
struct Piece {
    triangles: Vec<u32>,
    /// Those of them to be turned for all to agree; never more than half.
    turned: Vec<u32>,
    is_open: bool,
}

/// The triangle across each side, and whether the two are turned against one another.
type Neighbours = Vec<Vec<(u32, bool)>>;

fn agreeing_pieces(mesh: &TriangleMesh, uses: &[EdgeUse]) -> Result<Vec<Piece>, ShellError> {
    let count = mesh.triangles.len();
    let mut neighbours: Neighbours = (0..count).map(|_| Vec::with_capacity(3)).collect();
    for edge in by_edge(uses) {
        if let [one, other] = edge {
            let against = one.rises == other.rises;
            neighbours[one.triangle as usize].push((other.triangle, against));
            neighbours[other.triangle as usize].push((one.triangle, against));
        }
    }
    let mut is_turned = vec![None; count];
    let mut pieces = Vec::new();
    for seed in 0..count as u32 {
        if is_turned[seed as usize].is_none() {
            let piece = flood(seed, &neighbours, &mut is_turned);
            pieces.push(piece.map_err(|pair| not_orientable(mesh, pair))?);
        }
    }
    Ok(pieces)
}

/// Spreads the sense of turning from one triangle; the error is a pair that cannot agree.
fn flood(
    seed: u32,
    neighbours: &Neighbours,
    is_turned: &mut [Option<bool>],
) -> Result<Piece, [u32; 2]> {
    is_turned[seed as usize] = Some(false);
    let mut triangles = vec![seed];
    let mut reached = 0;
    while let Some(&triangle) = triangles.get(reached) {
        reached += 1;
        let own = is_turned[triangle as usize] == Some(true);
        for &(neighbour, against) in &neighbours[triangle as usize] {
            let wanted = own != against;
            match is_turned[neighbour as usize] {
                Some(found) if found != wanted => return Err([triangle, neighbour]),
                Some(_) => {}
                None => {
                    is_turned[neighbour as usize] = Some(wanted);
                    triangles.push(neighbour);
                }
            }
        }
    }
    let (turned, kept): (Vec<u32>, Vec<u32>) = triangles
        .iter()
        .partition(|&&triangle| is_turned[triangle as usize] == Some(true));
    let is_open = triangles
        .iter()
        .any(|&triangle| neighbours[triangle as usize].len() < 3);
    let turned = if turned.len() > kept.len() {
        kept
    } else {
        turned
    };
    Ok(Piece {
        triangles,
        turned,
        is_open,
    })
}

/// The middle of the edge that the two triangles share.
fn not_orientable(mesh: &TriangleMesh, [one, other]: [u32; 2]) -> ShellError {
    let other = mesh.triangles[other as usize];
    let shared = mesh.triangles[one as usize]
        .into_iter()
        .filter(|vertex| other.contains(vertex));
    let ends: Vec<Vec3> = shared
        .map(|vertex| mesh.vertices[vertex as usize])
        .collect();
    let at_mm = ends.iter().sum::<Vec3>() / ends.len() as f64;
    ShellError::NotOrientable { at_mm }
}

/// A closed piece with its box.
struct Body<'p> {
    piece: &'p Piece,
    volume: f64,
    low: Vec3,
    high: Vec3,
}

impl<'p> Body<'p> {
    fn new(mesh: &TriangleMesh, piece: &'p Piece) -> Self {
        let triangles = piece
            .triangles
            .iter()
            .map(|&t| mesh.triangles[t as usize])
            .collect();
        let corners = piece
            .triangles
            .iter()
            .flat_map(|&t| mesh.corners(t as usize));
        let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        let (low, high) = corners.fold(none, |(low, high), at| (low.inf(&at), high.sup(&at)));
        let vertices = mesh.vertices.clone();
        let volume = TriangleMesh {
            vertices,
            triangles,
        }
        .signed_volume();
        Self {
            piece,
            volume,
            low,
            high,
        }
    }

    /// Facing inwards, and not as the wall of a hollow within another body would.
    fn is_inside_out(&self, bodies: &[Self]) -> bool {
        self.volume < 0.0 && !bodies.iter().any(|other| other.encloses(self))
    }

    fn encloses(&self, inner: &Self) -> bool {
        (0..3).all(|i| self.low[i] < inner.low[i] && self.high[i] > inner.high[i])
    }
}
