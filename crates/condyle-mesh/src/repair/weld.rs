//! Cleans a mesh: welds open edges, and removes doubled faces, triangles without area and slivers.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::edges::{EdgeUse, by_edge};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Whether each vertex ends an edge that has one triangle only.
pub(super) fn on_open_edges(mesh: &TriangleMesh, uses: &[EdgeUse]) -> Vec<bool> {
    let mut is_open = vec![false; mesh.vertices.len()];
    for edge in by_edge(uses).filter(|edge| edge.len() == 1) {
        edge[0]
            .ends
            .iter()
            .for_each(|&end| is_open[end as usize] = true);
    }
    is_open
}

/// Makes vertices of open edges one that are no farther apart than `within`; gives where they were.
///
/// Only open edges: where a surface hangs together there is nothing to weld.
pub(super) fn weld(mesh: &mut TriangleMesh, uses: &[EdgeUse], within: f64) -> Vec<Vec3> {
    let mut kept: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut stands_for: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut places = Vec::new();
    let is_open = on_open_edges(mesh, uses);
    for vertex in (0..mesh.vertices.len()).filter(|&vertex| is_open[vertex]) {
        let at = mesh.vertices[vertex];
        let cell = [at.x, at.y, at.z].map(|coordinate| (coordinate / within).floor() as i64);
        let near = around(cell).filter_map(|cell| kept.get(&cell)).flatten();
        let is_near = |other: &&u32| (mesh.vertices[**other as usize] - at).norm() <= within;
        if let Some(&other) = near.copied().collect::<Vec<_>>().iter().find(is_near) {
            stands_for[vertex] = other;
            places.push(at);
        } else {
            kept.entry(cell).or_default().push(vertex as u32);
        }
    }
    rename(mesh, &stands_for);
    places
}

fn around([x, y, z]: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    let steps = (0..27).map(|n: i64| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]);
    steps.map(move |[i, j, k]| {
        [
            x.saturating_add(i),
            y.saturating_add(j),
            z.saturating_add(k),
        ]
    })
}

/// Lets every triangle name the vertex that stands for its own.
pub(super) fn rename(mesh: &mut TriangleMesh, stands_for: &[u32]) {
    for triangle in &mut mesh.triangles {
        *triangle = triangle.map(|vertex| stands_for[vertex as usize]);
    }
}

/// Drops the vertices that no triangle names.
pub(super) fn drop_unused(mesh: &mut TriangleMesh) {
    let mut new_number = vec![u32::MAX; mesh.vertices.len()];
    for &vertex in mesh.triangles.iter().flatten() {
        new_number[vertex as usize] = 0;
    }
    let mut vertices = Vec::new();
    for (old, number) in new_number.iter_mut().enumerate().filter(|(_, n)| **n == 0) {
        *number = vertices.len() as u32;
        vertices.push(mesh.vertices[old]);
    }
    mesh.vertices = vertices;
    rename(mesh, &new_number);
}

/// Keeps one triangle of each three corners; gives where the others were.
pub(super) fn make_single(mesh: &mut TriangleMesh) -> Vec<Vec3> {
    let mut seen = HashSet::with_capacity(mesh.triangles.len());
    let mut places = Vec::new();
    let vertices = &mesh.vertices;
    mesh.triangles.retain(|triangle| {
        let mut sorted = *triangle;
        sorted.sort_unstable();
        let is_first = seen.insert(sorted);
        if !is_first {
            places.push(triangle.iter().map(|&v| vertices[v as usize]).sum::<Vec3>() / 3.0);
        }
        is_first
    });
    places
}

/// Height over longest edge below which a triangle has no area: rounding of double precision.
const FLAT: f64 = 1e-12;
/// Splitting a neighbour may leave it flat in turn; more rounds than this help nobody.
const ROUNDS: usize = 8;

/// A mesh without degenerate triangles.
pub(super) struct Cleaned {
    pub(super) mesh: TriangleMesh,
    pub(super) removed: usize,
}

/// Takes out triangles of two equal corners, and those of three corners in a line; the neighbour
/// along the longest edge of the latter is split at the middle corner, so that the shell stays
/// as closed as it was.
pub(super) fn without_degenerate(mesh: TriangleMesh) -> Cleaned {
    let mut cleaned = Cleaned { mesh, removed: 0 };
    cleaned.drop_where(|mesh, index| {
        let [a, b, c] = mesh.triangles[index];
        a == b || b == c || c == a
    });
    let mut on_edge = None;
    for _ in 0..ROUNDS {
        let flat: Vec<usize> = (0..cleaned.mesh.triangles.len())
            .filter(|&index| is_flat(&cleaned.mesh, index))
            .collect();
        if flat.is_empty() {
            break;
        }
        let on_edge = on_edge.get_or_insert_with(|| TrianglesOnEdges::new(&cleaned.mesh));
        let merged = cleaned.merge(&flat, on_edge);
        cleaned.removed += merged;
        if merged == 0 {
            break;
        }
    }
    cleaned.drop_where(is_flat);
    cleaned
}

impl Cleaned {
    fn drop_where(&mut self, is_bad: impl Fn(&TriangleMesh, usize) -> bool) {
        let kept: Vec<[u32; 3]> = (0..self.mesh.triangles.len())
            .filter(|&index| !is_bad(&self.mesh, index))
            .map(|index| self.mesh.triangles[index])
            .collect();
        self.removed += self.mesh.triangles.len() - kept.len();
        self.mesh.triangles = kept;
    }

    /// Merges flat triangles into their neighbours; gives how many.
    fn merge(&mut self, flat: &[usize], on_edge: &mut TrianglesOnEdges) -> usize {
        flat.iter()
            .filter(|&&index| self.merge_one(index, on_edge))
            .count()
    }

    /// Gives a flat triangle the half of its neighbour beyond its middle corner.
    fn merge_one(&mut self, index: usize, on_edge: &mut TrianglesOnEdges) -> bool {
        if !is_flat(&self.mesh, index) {
            return false;
        }
        let [end, middle, other_end] = longest_edge_last(&self.mesh, index);
        let Some(neighbour) = on_edge.first_other(&self.mesh, index, [end, other_end]) else {
            return false;
        };
        let whole = self.mesh.triangles[neighbour];
        if whole.contains(&middle) {
            return false;
        }
        let with_middle_for = |old: u32| whole.map(|v| if v == old { middle } else { v });
        self.mesh.triangles[neighbour] = with_middle_for(end);
        self.mesh.triangles[index] = with_middle_for(other_end);
        on_edge.add(&self.mesh, neighbour);
        on_edge.add(&self.mesh, index);
        true
    }
}

/// The triangles that have, or had before they were split, an edge.
struct TrianglesOnEdges(HashMap<[u32; 2], Vec<usize>>);

impl TrianglesOnEdges {
    fn new(mesh: &TriangleMesh) -> Self {
        let mut on_edge = Self(HashMap::with_capacity(2 * mesh.triangles.len()));
        (0..mesh.triangles.len()).for_each(|index| on_edge.add(mesh, index));
        on_edge
    }

    fn add(&mut self, mesh: &TriangleMesh, index: usize) {
        let [a, b, c] = mesh.triangles[index];
        for ends in [[a, b], [b, c], [c, a]] {
            self.0.entry(sorted(ends)).or_default().push(index);
        }
    }

    /// The triangle of the lowest number that has an edge, but for one.
    fn first_other(&self, mesh: &TriangleMesh, index: usize, ends: [u32; 2]) -> Option<usize> {
        // An edge of more triangles is no surface's; they are not searched for a neighbour again and again.
        const MOST: usize = 16;
        let round = self
            .0
            .get(&sorted(ends))
            .filter(|round| round.len() <= MOST)?;
        let has_both = |t: &[u32; 3]| ends.iter().all(|end| t.contains(end));
        let others = round.iter().copied().filter(|&other| other != index);
        others
            .filter(|&other| has_both(&mesh.triangles[other]))
            .min()
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Twice the area against the longest edge squared is the height over the longest edge.
fn is_flat(mesh: &TriangleMesh, triangle: usize) -> bool {
    let [a, b, c] = mesh.corners(triangle);
    let longest = (b - a)
        .norm_squared()
        .max((c - b).norm_squared())
        .max((a - c).norm_squared());
    (b - a).cross(&(c - a)).norm() <= FLAT * longest
}

/// The corners turned so that the longest edge runs from the last to the first.
fn longest_edge_last(mesh: &TriangleMesh, triangle: usize) -> [u32; 3] {
    let [a, b, c] = mesh.triangles[triangle];
    let length = |[from, _, to]: &[u32; 3]| {
        (mesh.vertices[*from as usize] - mesh.vertices[*to as usize]).norm_squared()
    };
    let turned = [[a, b, c], [b, c, a], [c, a, b]];
    turned
        .into_iter()
        .max_by(|one, other| length(one).total_cmp(&length(other)))
        .unwrap_or([a, b, c])
}

/// Vertices with more triangles around than this are left alone: the tip of a fan.
const MAX_AROUND: usize = 64;
/// A collapsed edge keeps those beside it from collapsing in the same round; more rounds help nobody.
const COLLAPSE_ROUNDS: usize = 8;

/// Collapses edges shorter than `thinnest`, where the surface stays what it is; gives where triangles went.
pub(super) fn collapse_slivers(mesh: &mut TriangleMesh, thinnest: f64) -> Vec<Vec3> {
    let mut places = Vec::new();
    for _ in 0..COLLAPSE_ROUNDS {
        let collapsed = collapse_some(mesh, thinnest);
        if collapsed.is_empty() {
            break;
        }
        places.extend(collapsed);
    }
    places
}

/// Collapses short edges that are not beside one another; gives where triangles went.
fn collapse_some(mesh: &mut TriangleMesh, thinnest: f64) -> Vec<Vec3> {
    let mut places = Vec::new();
    let short = short_edges(mesh, thinnest);
    if short.is_empty() {
        return places;
    }
    let around = triangles_around(mesh);
    let mut stands_for: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut is_settled = vec![false; mesh.vertices.len()];
    for [a, b] in short {
        let stars = [a, b].map(|end| &around[end as usize]);
        if stars.iter().any(|star| star.len() > MAX_AROUND) {
            continue;
        }
        let [one, other] = stars.map(|star| neighbours(mesh, star));
        let mut beside = one.union(&other);
        let is_free = beside.all(|&vertex| !is_settled[vertex as usize]);
        if is_free && keeps_the_surface(mesh, stars, [&one, &other], [a, b]) {
            for &vertex in one.union(&other) {
                is_settled[vertex as usize] = true;
            }
            stands_for[b as usize] = a;
            places.extend(on_edge(mesh, stars[0], [a, b]).map(|_| mesh.vertices[a as usize]));
        }
    }
    rename(mesh, &stands_for);
    mesh.triangles
        .retain(|[a, b, c]| a != b && b != c && c != a);
    places
}

/// The lower number first, each once.
fn short_edges(mesh: &TriangleMesh, thinnest: f64) -> BTreeSet<[u32; 2]> {
    let sides = mesh
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let is_short = |[a, b]: &[u32; 2]| {
        let way = mesh.vertices[*b as usize] - mesh.vertices[*a as usize];
        way.norm_squared() < thinnest * thinnest
    };
    sides
        .filter(is_short)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect()
}

/// The triangles of a star that have both ends.
fn on_edge<'a>(
    mesh: &'a TriangleMesh,
    star: &'a [u32],
    ends: [u32; 2],
) -> impl Iterator<Item = [u32; 3]> + 'a {
    let corners = star
        .iter()
        .map(|&triangle| mesh.triangles[triangle as usize]);
    corners.filter(move |corners| ends.iter().all(|end| corners.contains(end)))
}

/// The vertices beside both ends are the tips of the triangles on the edge, and no others: then the surface
/// hangs together after the collapse as before.
fn keeps_the_surface(
    mesh: &TriangleMesh,
    [star, _]: [&Vec<u32>; 2],
    [one, other]: [&BTreeSet<u32>; 2],
    ends: [u32; 2],
) -> bool {
    let tips: BTreeSet<u32> = on_edge(mesh, star, ends)
        .flatten()
        .filter(|corner| !ends.contains(corner))
        .collect();
    let beside: BTreeSet<u32> = one
        .intersection(other)
        .copied()
        .filter(|v| !ends.contains(v))
        .collect();
    tips == beside
}

fn neighbours(mesh: &TriangleMesh, star: &[u32]) -> BTreeSet<u32> {
    star.iter()
        .flat_map(|&t| mesh.triangles[t as usize])
        .collect()
}

fn triangles_around(mesh: &TriangleMesh) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); mesh.vertices.len()];
    for (number, triangle) in (0..).zip(&mesh.triangles) {
        triangle
            .iter()
            .for_each(|&vertex| around[vertex as usize].push(number));
    }
    around
}

#[cfg(test)]
mod tests {
    use crate::{
        Vec3,
        repair::{checked_mesh, fixtures::unit_block},
    };

    #[test]
    fn a_triangle_of_two_equal_corners_goes_without_a_gap() {
        let mut mesh = unit_block();
        mesh.triangles.insert(5, [0, 1, 1]);
        let shell = checked_mesh(mesh).unwrap();
        assert_eq!(shell.removed_degenerate, 1);
        assert!(shell.closed);
        assert_eq!(shell.mesh, unit_block());
    }

    /// The first edge of the block gets a middle vertex that only one of its two triangles knows.
    #[test]
    fn three_corners_in_a_line_go_without_a_gap() {
        let mut mesh = unit_block();
        mesh.vertices.push(Vec3::new(0.5, 0.0, 0.0));
        // Triangle 4 is [0, 1, 5], on the other side of edge 0-1 is triangle 1, [0, 3, 1].
        mesh.triangles[4] = [0, 8, 5];
        mesh.triangles.push([8, 1, 5]);
        mesh.triangles.push([0, 1, 8]);
        let shell = checked_mesh(mesh).unwrap();
        assert_eq!(shell.removed_degenerate, 1);
        assert!(
            shell.closed,
            "the triangle across is split at the middle vertex"
        );
        assert_eq!(shell.mesh.triangles.len(), 14);
        assert!((shell.mesh.signed_volume() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_flat_triangle_on_the_rim_is_dropped() {
        let mut mesh = unit_block();
        mesh.triangles.truncate(2);
        mesh.vertices.push(Vec3::new(0.5, 0.0, 0.0));
        mesh.vertices.push(Vec3::new(-1.0, 0.0, 0.0));
        mesh.triangles.push([1, 8, 9]);
        let shell = checked_mesh(mesh).unwrap();
        assert_eq!(
            (shell.removed_degenerate, shell.mesh.triangles.len()),
            (1, 2)
        );
    }
}
