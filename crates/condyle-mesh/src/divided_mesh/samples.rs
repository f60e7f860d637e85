//! The vertices of a mesh that sample its surface, in triangles of a good shape.

use crate::{
    Vec3,
    repair::{EdgeUse, by_edge, edge_uses},
    triangle_mesh::TriangleMesh,
};

/// Distance up to which a vertex lies on a flat facet or a straight edge, mm: above the rounding of files, and much less
/// than the chord error of any export.
const FLAT_MM: f64 = 1e-4;

/// Largest distance between the two diagonals of a quad that are exchanged, mm: both lie within the usual chord error of
/// the same surface.
const MAX_BETWEEN_DIAGONALS_MM: f64 = 0.03;

/// Smallest height of a triangle whose plane is known in spite of the rounding of single precision, mm.
pub(super) const MIN_HEIGHT_MM: f64 = 1e-3;

/// Largest number of rounds over a mesh: each removes about a fifth of the vertices of a flat facet.
const MAX_ROUNDS: usize = 60;

/// Returns `mesh` without the vertices that only subdivide its flat facets and straight edges, and with the better
/// diagonal of every nearly flat quad.
///
/// A vertex in the middle of a flat facet is not a sample of the curved surface: it is off by the chord error. A sliver has
/// no reliable plane. Both are artefacts of the program that triangulated the surface.
pub(super) fn samples_of(mesh: &TriangleMesh) -> TriangleMesh {
    let mut mesh = without_flat_vertices(mesh);
    let mut rounds = 0..MAX_ROUNDS;
    while rounds.next().is_some() && exchange_diagonals(&mut mesh) {}
    mesh
}

/// Returns `mesh` without the vertices that only subdivide its flat facets and straight edges.
pub(super) fn without_flat_vertices(mesh: &TriangleMesh) -> TriangleMesh {
    let mut mesh = mesh.clone();
    let mut vertices: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut rounds = 0..MAX_ROUNDS;
    while rounds.next().is_some() && !vertices.is_empty() {
        vertices = remove_flat_vertices(&mut mesh, &vertices);
    }
    mesh
}

/// Removes those of some vertices that are flat and not neighbours; returns the vertices around which triangles changed,
/// ascending: no other can have become flat.
fn remove_flat_vertices(mesh: &mut TriangleMesh, vertices: &[u32]) -> Vec<u32> {
    let around = mesh.triangles_around();
    let mut is_changed = vec![false; mesh.triangles.len()];
    let mut removed = Vec::new();
    for &vertex in vertices {
        let star = &around[vertex as usize];
        if star.iter().any(|&triangle| is_changed[triangle as usize]) {
            continue;
        }
        if let Some(onto) = best_collapse(mesh, vertex, star) {
            for &triangle in star {
                is_changed[triangle as usize] = true;
                let corners = &mut mesh.triangles[triangle as usize];
                if corners.contains(&onto) {
                    removed.push(triangle);
                }
                *corners = corners.map(|corner| if corner == vertex { onto } else { corner });
            }
        }
    }
    let triangles = mesh.triangles.iter().zip(&is_changed);
    let changed = triangles.filter_map(|(corners, &is_changed)| is_changed.then_some(corners));
    let mut next: Vec<u32> = changed.copied().flatten().collect();
    next.sort_unstable();
    next.dedup();
    removed.sort_unstable();
    let mut number = 0..;
    let is_kept = |_: &[u32; 3]| removed.binary_search(&number.next().unwrap_or(0)).is_err();
    mesh.triangles.retain(is_kept);
    next
}

/// Returns the neighbour onto which a vertex can be moved without any change of the surface.
fn best_collapse(mesh: &TriangleMesh, vertex: u32, star: &[u32]) -> Option<u32> {
    let at = mesh.vertices[vertex as usize];
    // The edge of every triangle that does not contain the vertex.
    let rim: Vec<[u32; 2]> = star
        .iter()
        .filter_map(|&triangle| {
            let [a, b, c] = mesh.triangles[triangle as usize];
            [[a, b, c], [b, c, a], [c, a, b]]
                .into_iter()
                .find(|turned| turned[0] == vertex)
        })
        .map(|[_, from, to]| [from, to])
        .collect();
    let corner = |vertex: u32| mesh.vertices[vertex as usize];
    let count = |one: u32, end: usize| rim.iter().filter(|edge| edge[end] == one).count();
    let is_branched = |&[from, to]: &[u32; 2]| count(from, 0) > 1 || count(to, 1) > 1;
    let ends: Vec<u32> = rim
        .iter()
        .flat_map(|&[from, to]| [(from, count(from, 1)), (to, count(to, 0))])
        .filter_map(|(end, others)| (others == 0).then_some(end))
        .collect();
    let candidates: Vec<u32> = match ends[..] {
        [] => rim.iter().map(|[from, _]| *from).collect(),
        // At the border of an open surface, a vertex of a straight edge.
        [one, other] => {
            let along = corner(other) - corner(one);
            let off = (at - corner(one)).cross(&along).norm();
            if off > FLAT_MM * along.norm() {
                return None;
            }
            vec![one, other]
        }
        _ => return None,
    };
    if rim.iter().any(is_branched) {
        return None;
    }
    let lowest_height = |onto: u32| {
        let mut lowest = f64::INFINITY;
        for &[from, to] in rim.iter().filter(|edge| !edge.contains(&onto)) {
            let [u, a, b] = [onto, from, to].map(corner);
            let (before, after) = ((a - at).cross(&(b - at)), (a - u).cross(&(b - u)));
            let height = height([u, a, b]);
            let is_same = after.dot(&before) > 0.0
                && height > MIN_HEIGHT_MM
                && (at - u).dot(&after).abs() <= FLAT_MM * after.norm();
            if !is_same {
                return None;
            }
            lowest = lowest.min(height);
        }
        Some((lowest, onto))
    };
    let found = candidates.into_iter().filter_map(lowest_height);
    let best = found.max_by(|one, other| one.0.total_cmp(&other.0));
    best.map(|(_, onto)| onto)
}

pub(super) fn facet_normals(mesh: &TriangleMesh) -> Vec<Vec3> {
    let normal = |triangle| {
        let [a, b, c] = mesh.corners(triangle);
        let across = (b - a).cross(&(c - a));
        across.try_normalize(0.0).unwrap_or_default()
    };
    (0..mesh.triangles.len()).map(normal).collect()
}

/// Returns the smallest height of a triangle, mm.
pub(super) fn height([a, b, c]: [Vec3; 3]) -> f64 {
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    (b - a).cross(&(c - a)).norm() / longest.max(f64::MIN_POSITIVE)
}

/// Exchanges the diagonals of quads that have no triangle in common; returns false if there are none.
fn exchange_diagonals(mesh: &mut TriangleMesh) -> bool {
    let uses = edge_uses(mesh);
    let is_edge = |ends: [u32; 2]| uses.binary_search_by_key(&ends, |edge| edge.ends).is_ok();
    let mut is_changed = vec![false; mesh.triangles.len()];
    for pair in by_edge(&uses) {
        let [first, second] = pair else {
            continue;
        };
        let [one, other] = [first.triangle as usize, second.triangle as usize];
        if is_changed[one] || is_changed[other] {
            continue;
        }
        let turned = |side: &EdgeUse| {
            let corners = mesh.triangles[side.triangle as usize];
            [0, 1, 2].map(|step| corners[(usize::from(side.side) + step) % 3])
        };
        let ([a, b, c], [from, to, d]) = (turned(first), turned(second));
        let new = [c.min(d), c.max(d)];
        if [from, to] == [b, a] && is_better(mesh, [a, b, c, d]) && !is_edge(new) {
            (mesh.triangles[one], mesh.triangles[other]) = ([a, d, c], [d, b, c]);
            is_changed[one] = true;
            is_changed[other] = true;
        }
    }
    is_changed.contains(&true)
}

/// Returns true if triangles adc and dbc are better than abc and bad, and as near to the surface.
fn is_better(mesh: &TriangleMesh, quad: [u32; 4]) -> bool {
    /// Sine by which the two angles opposite to the diagonal must exceed a half turn, so that rounding exchanges
    /// no diagonals of a rectangle for ever.
    const GAIN: f64 = 1e-3;
    let [a, b, c, d] = quad.map(|vertex| mesh.vertices[vertex as usize]);
    let (diagonal, new) = (b - a, d - c);
    let whole = diagonal.cross(&(c - a)) + (d - a).cross(&diagonal);
    let parts = [(d - a).cross(&(c - a)), (b - d).cross(&(c - d))];
    if parts.iter().any(|part| part.dot(&whole) <= 0.0) {
        return false;
    }
    let across = diagonal.cross(&new);
    let apart = (c - a).dot(&across).abs();
    // The angles at c and d are alpha and beta: sin(alpha + beta) is negative beyond a half turn (Delaunay).
    let angle = |at: Vec3| ((a - at).cross(&(b - at)).norm(), (a - at).dot(&(b - at)));
    let ((sine_c, cosine_c), (sine_d, cosine_d)) = (angle(c), angle(d));
    let size = sine_c.hypot(cosine_c) * sine_d.hypot(cosine_d);
    apart <= MAX_BETWEEN_DIAGONALS_MM * across.norm()
        && sine_c * cosine_d + cosine_c * sine_d < -GAIN * size
}
