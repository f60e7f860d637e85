//! Triangles without area, taken out so that no gap is left.

use std::collections::HashMap;

use crate::triangle_mesh::TriangleMesh;

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

#[cfg(test)]
mod tests {
    use crate::Vec3;
    use crate::repair::{checked_mesh, fixtures::unit_block};

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
