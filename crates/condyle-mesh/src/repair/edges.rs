//! The triangles at each edge, and triangles turned to agree with their neighbours.

use std::collections::BTreeMap;

use crate::{Vec3, triangle_mesh::TriangleMesh};

/// One side of one triangle.
#[derive(Clone, Copy)]
pub(super) struct EdgeUse {
    /// Vertices of the edge, the lower number first.
    pub(super) ends: [u32; 2],
    pub(super) triangle: u32,
    /// The triangle runs from the lower vertex to the higher.
    pub(super) rises: bool,
}

/// All sides of all triangles, those of one edge together.
pub(super) fn edge_uses(mesh: &TriangleMesh) -> Vec<EdgeUse> {
    let mut uses = Vec::with_capacity(3 * mesh.triangles.len());
    for (triangle, &[a, b, c]) in (0..).zip(&mesh.triangles) {
        uses.extend([[a, b], [b, c], [c, a]].map(|[from, to]| EdgeUse {
            ends: [from.min(to), from.max(to)],
            triangle,
            rises: from < to,
        }));
    }
    uses.sort_unstable_by_key(|edge| (edge.ends, edge.triangle));
    uses
}

/// The uses, edge by edge.
pub(super) fn by_edge(uses: &[EdgeUse]) -> impl Iterator<Item = &[EdgeUse]> {
    uses.chunk_by(|one, other| one.ends == other.ends)
}

/// How the triangles of a mesh hang together, without any repair.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EdgeReport {
    /// Edges with one triangle only.
    pub open_edges: usize,
    /// Vertices round each hole or along each rim, in the sense of the triangles.
    pub boundary_loops: Vec<Vec<u32>>,
    /// Edges with three triangles or more.
    pub non_manifold_edges: Vec<[u32; 2]>,
    /// Edges whose two triangles are turned against one another.
    pub inconsistent_edges: usize,
}

impl EdgeReport {
    /// Every edge has exactly two triangles.
    pub fn is_closed(&self) -> bool {
        self.open_edges == 0 && self.non_manifold_edges.is_empty()
    }
}

/// Reports open, non-manifold and inconsistent edges of a triangle mesh as it is.
pub fn edge_report(mesh: &TriangleMesh) -> EdgeReport {
    let uses = edge_uses(mesh);
    let mut report = EdgeReport::default();
    let mut next = BTreeMap::new();
    for edge in by_edge(&uses) {
        match edge {
            [only] => {
                let [low, high] = only.ends;
                let (from, to) = if only.rises { (low, high) } else { (high, low) };
                next.entry(from).or_insert_with(Vec::new).push(to);
                report.open_edges += 1;
            }
            [one, other] => report.inconsistent_edges += usize::from(one.rises == other.rises),
            several => report.non_manifold_edges.push(several[0].ends),
        }
    }
    report.boundary_loops = loops(next);
    report
}

/// Follows the rim from vertex to vertex until it ends or comes back.
fn loops(mut next: BTreeMap<u32, Vec<u32>>) -> Vec<Vec<u32>> {
    let mut loops = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut around = vec![start];
        let mut at = start;
        while let Some(to) = step(&mut next, at).filter(|&to| to != start) {
            around.push(to);
            at = to;
        }
        loops.push(around);
    }
    loops
}

fn step(next: &mut BTreeMap<u32, Vec<u32>>, from: u32) -> Option<u32> {
    let ends = next.get_mut(&from)?;
    let to = ends.pop();
    if ends.is_empty() {
        next.remove(&from);
    }
    to
}

/// What was found and done.
pub(super) struct Oriented {
    pub(super) pieces: Vec<Piece>,
    pub(super) turned_round: bool,
    pub(super) made_consistent: usize,
    /// The middles of edges whose triangles cannot agree.
    pub(super) one_sided: Vec<Vec3>,
}

/// Turns triangles in place.
pub(super) fn orient(mesh: &mut TriangleMesh, uses: &[EdgeUse]) -> Oriented {
    let Agreement { pieces, one_sided } = agreeing_pieces(mesh, uses);
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
    Oriented {
        turned_round: !inside_out.is_empty(),
        made_consistent,
        one_sided,
        pieces,
    }
}

fn turn(mesh: &mut TriangleMesh, triangle: u32) {
    mesh.triangles[triangle as usize].swap(1, 2);
}

/// Triangles that hang together by edges.
pub(super) struct Piece {
    pub(super) triangles: Vec<u32>,
    /// Those of them to be turned for all to agree; never more than half.
    turned: Vec<u32>,
    pub(super) is_open: bool,
}

/// The pieces, and the middles of edges where triangles cannot agree.
struct Agreement {
    pieces: Vec<Piece>,
    one_sided: Vec<Vec3>,
}

/// The triangle across each side, and whether the two are turned against one another.
type Neighbours = Vec<Vec<(u32, bool)>>;

fn agreeing_pieces(mesh: &TriangleMesh, uses: &[EdgeUse]) -> Agreement {
    let count = mesh.triangles.len();
    let mut neighbours: Neighbours = (0..count).map(|_| Vec::with_capacity(3)).collect();
    let mut join = |one: &EdgeUse, other: &EdgeUse| {
        let against = one.rises == other.rises;
        neighbours[one.triangle as usize].push((other.triangle, against));
        neighbours[other.triangle as usize].push((one.triangle, against));
    };
    for edge in by_edge(uses) {
        match edge {
            [one, other] => join(one, other),
            [_] => {}
            several => outer_pairs(mesh, several)
                .iter()
                .for_each(|[one, other]| join(one, other)),
        }
    }
    let mut is_turned = vec![None; count];
    let mut one_sided = Vec::new();
    let mut pieces = Vec::new();
    for seed in 0..count as u32 {
        if is_turned[seed as usize].is_none() {
            let mut clash = |pair| one_sided.push(middle_of_shared_edge(mesh, pair));
            pieces.push(flood(seed, &neighbours, &mut is_turned, &mut clash));
        }
    }
    Agreement { pieces, one_sided }
}

/// Of three triangles or more round an edge those that bound the space outside together: turning from the front of
/// one, the other is met first, and from its front.
fn outer_pairs(mesh: &TriangleMesh, round: &[EdgeUse]) -> Vec<[EdgeUse; 2]> {
    let [low, high] = round[0].ends.map(|end| mesh.vertices[end as usize]);
    let axis = (high - low).try_normalize(0.0).unwrap_or_default();
    let aside = axis.cross(&Vec3::ith(axis.iamin(), 1.0));
    let angle = |edge: &EdgeUse| {
        let corners = mesh.triangles[edge.triangle as usize];
        let tip = corners
            .into_iter()
            .find(|corner| !edge.ends.contains(corner));
        let way = tip
            .map(|tip| mesh.vertices[tip as usize] - low)
            .unwrap_or_default();
        way.dot(&axis.cross(&aside)).atan2(way.dot(&aside))
    };
    let mut sorted: Vec<(f64, EdgeUse)> = round.iter().map(|edge| (angle(edge), *edge)).collect();
    sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
    let next = sorted.iter().cycle().skip(1);
    sorted
        .iter()
        .zip(next)
        .filter(|((_, one), (_, other))| one.rises && !other.rises)
        .map(|((_, one), (_, other))| [*one, *other])
        .collect()
}

/// Spreads the sense of turning from one triangle; `clash` hears of pairs that cannot agree.
fn flood(
    seed: u32,
    neighbours: &Neighbours,
    is_turned: &mut [Option<bool>],
    clash: &mut impl FnMut([u32; 2]),
) -> Piece {
    is_turned[seed as usize] = Some(false);
    let mut triangles = vec![seed];
    let mut reached = 0;
    while let Some(&triangle) = triangles.get(reached) {
        reached += 1;
        let own = is_turned[triangle as usize] == Some(true);
        for &(neighbour, against) in &neighbours[triangle as usize] {
            let wanted = own != against;
            match is_turned[neighbour as usize] {
                // Seen from the other side as well: one of the two says so.
                Some(found) if found != wanted && triangle < neighbour => {
                    clash([triangle, neighbour]);
                }
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
    Piece {
        triangles,
        turned,
        is_open,
    }
}

/// The middle of the edge that the two triangles share.
fn middle_of_shared_edge(mesh: &TriangleMesh, [one, other]: [u32; 2]) -> Vec3 {
    let other = mesh.triangles[other as usize];
    let shared = mesh.triangles[one as usize]
        .into_iter()
        .filter(|vertex| other.contains(vertex));
    let ends: Vec<Vec3> = shared
        .map(|vertex| mesh.vertices[vertex as usize])
        .collect();
    ends.iter().sum::<Vec3>() / ends.len() as f64
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
        let corners = piece
            .triangles
            .iter()
            .flat_map(|&t| mesh.corners(t as usize));
        let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        let (low, high) = corners.fold(none, |(low, high), at| (low.inf(&at), high.sup(&at)));
        let volume = mesh.volume_of(piece.triangles.iter().map(|&t| t as usize));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::fixtures::unit_block;

    #[test]
    fn a_closed_block_has_nothing_to_report() {
        let report = edge_report(&unit_block());
        assert_eq!(report, EdgeReport::default());
        assert!(report.is_closed());
    }

    #[test]
    fn an_open_block_has_a_loop_round_each_hole() {
        let mut mesh = unit_block();
        mesh.triangles.drain(..4);
        let report = edge_report(&mesh);
        assert_eq!(report.open_edges, 8);
        assert_eq!(report.boundary_loops, [vec![0, 1, 3, 2], vec![4, 6, 7, 5]]);
        assert!(!report.is_closed());
    }

    #[test]
    fn walls_and_turned_triangles_are_counted() {
        let mut mesh = unit_block();
        mesh.triangles[0].swap(0, 1);
        assert_eq!(edge_report(&mesh).inconsistent_edges, 3);
        mesh.triangles.push([0, 4, 3]);
        assert_eq!(edge_report(&mesh).non_manifold_edges, [[0, 3], [0, 4]]);
    }
}
