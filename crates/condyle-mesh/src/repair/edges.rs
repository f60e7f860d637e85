//! The triangles at each edge, and the orientation of triangles in agreement with their neighbours.

use std::collections::BTreeMap;

use crate::{
    Vec3,
    triangle_mesh::{TriangleMesh, bounds},
};

#[derive(Clone, Copy)]
pub(crate) struct EdgeUse {
    /// Vertices of the edge, the lower number first.
    pub(crate) ends: [u32; 2],
    pub(crate) triangle: u32,
    /// Number of the side of the triangle, which begins at the corner of the same number.
    pub(crate) side: u8,
    /// The triangle runs from the lower vertex to the higher.
    pub(crate) rises: bool,
}

/// Returns all sides of all triangles, those of one edge together.
pub(crate) fn edge_uses(mesh: &TriangleMesh) -> Vec<EdgeUse> {
    let mut uses = Vec::with_capacity(3 * mesh.triangles.len());
    for (triangle, &[a, b, c]) in (0..).zip(&mesh.triangles) {
        let sides = [(0, a, b), (1, b, c), (2, c, a)];
        uses.extend(sides.map(|(side, from, to)| EdgeUse {
            ends: [from.min(to), from.max(to)],
            triangle,
            side,
            rises: from < to,
        }));
    }
    uses.sort_unstable_by_key(|edge| {
        // One number for both ends: it is compared in one step.
        let ends = u64::from(edge.ends[0]) << 32 | u64::from(edge.ends[1]);
        (ends, edge.triangle, edge.side)
    });
    uses
}

pub(crate) fn by_edge(uses: &[EdgeUse]) -> impl Iterator<Item = &[EdgeUse]> {
    uses.chunk_by(|one, other| one.ends == other.ends)
}

/// Returns the sides that belong to one face only, in the order of their ends: these with the lower number first, the number
/// of the face, and that of the corner at which the side begins.
pub fn border_sides<const N: usize>(faces: &[[u32; N]]) -> Vec<([u32; 2], usize, usize)> {
    let sides_of = |(face, corners): (usize, &[u32; N])| {
        let corners = *corners;
        (0..N).map(move |side| {
            let (from, to) = (corners[side], corners[(side + 1) % N]);
            ([from.min(to), from.max(to)], face, side)
        })
    };
    let mut sides: Vec<_> = faces.iter().enumerate().flat_map(sides_of).collect();
    sides.sort_unstable();
    let alike = sides.chunk_by(|one, other| one.0 == other.0);
    alike
        .filter(|same| same.len() == 1)
        .flatten()
        .copied()
        .collect()
}

/// Connections of the triangles of a mesh, without any repair.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EdgeReport {
    /// Number of edges with one triangle only.
    pub open_edges: usize,
    /// Vertices round each hole or along each rim, in the sense of the triangles.
    pub boundary_loops: Vec<Vec<u32>>,
    /// Edges with three triangles or more.
    pub non_manifold_edges: Vec<[u32; 2]>,
    /// Number of edges whose two triangles have opposite orientations.
    pub inconsistent_edges: usize,
}

impl EdgeReport {
    /// Returns true if every edge has exactly two triangles.
    pub fn is_closed(&self) -> bool {
        self.open_edges == 0 && self.non_manifold_edges.is_empty()
    }
}

/// Reports open, non-manifold and inconsistent edges of a triangle mesh as it is.
pub fn edge_report(mesh: &TriangleMesh) -> EdgeReport {
    let uses = edge_uses(mesh);
    let mut report = EdgeReport::default();
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for edge in by_edge(&uses) {
        match edge {
            [only] => {
                let [low, high] = only.ends;
                let (from, to) = if only.rises { (low, high) } else { (high, low) };
                next.entry(from).or_default().push(to);
                report.open_edges += 1;
            }
            [one, other] => report.inconsistent_edges += usize::from(one.rises == other.rises),
            several => report.non_manifold_edges.push(several[0].ends),
        }
    }
    // Every rim is followed from vertex to vertex until it ends or returns to its start.
    while let Some((&start, _)) = next.first_key_value() {
        let mut around = vec![start];
        let mut at = start;
        while let Some(ends) = next.get_mut(&at) {
            let to = ends.pop();
            if ends.is_empty() {
                next.remove(&at);
            }
            let Some(to) = to.filter(|&to| to != start) else {
                break;
            };
            around.push(to);
            at = to;
        }
        report.boundary_loops.push(around);
    }
    report
}

pub(super) struct Piece {
    pub(super) triangles: Vec<u32>,
    /// The triangles among them that must be reversed for all to agree; never more than half.
    turned: Vec<u32>,
    pub(super) is_open: bool,
}

impl Piece {
    /// Returns the vertices of all corners, repeated as the triangles share them.
    pub(super) fn vertices(&self, mesh: &TriangleMesh) -> impl Iterator<Item = u32> {
        self.triangles
            .iter()
            .flat_map(|&triangle| mesh.triangles[triangle as usize])
    }

    pub(super) fn bounds(&self, mesh: &TriangleMesh) -> (Vec3, Vec3) {
        bounds(self.vertices(mesh).map(|v| &mesh.vertices[v as usize]))
    }
}

pub(super) struct Oriented {
    pub(super) pieces: Vec<Piece>,
    /// Some closed piece was inside-out.
    pub(super) turned_round: bool,
    pub(super) made_consistent: usize,
    /// Middles of edges whose triangles cannot agree.
    pub(super) one_sided: Vec<Vec3>,
}

/// Turns triangles in place so that neighbours agree and closed pieces face outwards.
pub(super) fn orient(mesh: &mut TriangleMesh, uses: &[EdgeUse]) -> Oriented {
    let (pieces, one_sided) = agreeing_pieces(mesh, uses);
    let turned = || pieces.iter().flat_map(|piece| &piece.turned);
    for &triangle in turned() {
        mesh.triangles[triangle as usize].swap(1, 2);
    }
    let closed = pieces.iter().filter(|piece| !piece.is_open);
    let boxes: Vec<(&Piece, (Vec3, Vec3))> =
        closed.map(|piece| (piece, piece.bounds(mesh))).collect();
    // A closed piece that faces inwards is inside-out, unless it is the wall of a hollow within another one.
    let is_within_another = |(low, high): &(Vec3, Vec3)| {
        let mut others = boxes.iter().map(|(_, bounds)| bounds);
        others.any(|(l, h)| (0..3).all(|i| l[i] < low[i] && h[i] > high[i]))
    };
    let inside_out = boxes.iter().filter(|(piece, bounds)| {
        let triangles = piece.triangles.iter().map(|&triangle| triangle as usize);
        mesh.volume_of(triangles) < 0.0 && !is_within_another(bounds)
    });
    let inside_out: Vec<&Piece> = inside_out.map(|(piece, _)| *piece).collect();
    for &triangle in inside_out.iter().flat_map(|piece| &piece.triangles) {
        mesh.triangles[triangle as usize].swap(1, 2);
    }
    Oriented {
        turned_round: !inside_out.is_empty(),
        made_consistent: turned().count(),
        one_sided,
        pieces,
    }
}

/// The triangle across each side, and whether the two have opposite orientations.
type Neighbours = Vec<Vec<(u32, bool)>>;

/// Returns the pieces, and the middles of edges where triangles cannot agree.
fn agreeing_pieces(mesh: &TriangleMesh, uses: &[EdgeUse]) -> (Vec<Piece>, Vec<Vec3>) {
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
            several => {
                let pairs = outer_pairs(mesh, several);
                pairs.iter().for_each(|[one, other]| join(one, other));
            }
        }
    }
    let mut is_turned = vec![None; count];
    let (mut pieces, mut one_sided) = (Vec::new(), Vec::new());
    for seed in 0..count as u32 {
        if is_turned[seed as usize].is_none() {
            let mut clash = |[one, other]: [u32; 2]| {
                let [one, other] = [one, other].map(|t| mesh.triangles[t as usize]);
                let shared = one.into_iter().filter(|vertex| other.contains(vertex));
                let ends: Vec<Vec3> = shared.map(|v| mesh.vertices[v as usize]).collect();
                one_sided.push(ends.iter().sum::<Vec3>() / ends.len() as f64);
            };
            pieces.push(flood(seed, &neighbours, &mut is_turned, &mut clash));
        }
    }
    (pieces, one_sided)
}

/// Returns those of three or more triangles round an edge that bound the space outside together: turning from the
/// front of one, the other is met first, and from its front.
fn outer_pairs(mesh: &TriangleMesh, round: &[EdgeUse]) -> Vec<[EdgeUse; 2]> {
    let [low, high] = round[0].ends.map(|end| mesh.vertices[end as usize]);
    let axis = (high - low).try_normalize(0.0).unwrap_or_default();
    let aside = axis.cross(&Vec3::ith(axis.iamin(), 1.0));
    let angle = |edge: &EdgeUse| {
        let corners = mesh.triangles[edge.triangle as usize].into_iter();
        let tip = corners.clone().find(|corner| !edge.ends.contains(corner));
        let way = tip.map(|tip| mesh.vertices[tip as usize] - low);
        let way = way.unwrap_or_default();
        way.dot(&axis.cross(&aside)).atan2(way.dot(&aside))
    };
    let mut sorted: Vec<(f64, EdgeUse)> = round.iter().map(|edge| (angle(edge), *edge)).collect();
    sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
    let next = sorted.iter().cycle().skip(1);
    let pairs = sorted
        .iter()
        .zip(next)
        .map(|((_, one), (_, other))| [*one, *other]);
    pairs
        .filter(|[one, other]| one.rises && !other.rises)
        .collect()
}

/// Spreads the orientation from one triangle; calls `clash` with pairs that cannot agree.
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
            let required = own != against;
            match is_turned[neighbour as usize] {
                // The pair is met from its other side as well: one report is enough.
                Some(found) if found != required && triangle < neighbour => {
                    clash([triangle, neighbour]);
                }
                Some(_) => {}
                None => {
                    is_turned[neighbour as usize] = Some(required);
                    triangles.push(neighbour);
                }
            }
        }
    }
    let is_turned = |triangle: &&u32| is_turned[**triangle as usize] == Some(true);
    let (mut turned, kept): (Vec<u32>, Vec<u32>) = triangles.iter().partition(is_turned);
    if turned.len() > kept.len() {
        turned = kept;
    }
    let mut sides = triangles.iter().map(|&t| neighbours[t as usize].len());
    Piece {
        is_open: sides.any(|sides| sides < 3),
        turned,
        triangles,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::tests::unit_block;

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
