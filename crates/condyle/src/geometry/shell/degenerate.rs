//! Triangles without area, taken out so that no gap is left.

use crate::geometry::triangle_mesh::TriangleMesh;

/// Height over longest edge below which a triangle has no area: rounding of double precision.
const FLAT: f64 = 1e-12;
/// Splitting a neighbour may leave it flat in turn; more rounds than this help nobody.
const ROUNDS: usize = 8;

/// A mesh without degenerate triangles.
pub(super) struct Cleaned {
    pub(super) mesh: TriangleMesh,
    /// For each triangle its number in the mesh that came in.
    pub(super) came_from: Vec<usize>,
    pub(super) removed: usize,
}

/// Takes out triangles of two equal corners, and those of three corners in a line; the neighbour
/// along the longest edge of the latter is split at the middle corner, so that the shell stays
/// as closed as it was.
pub(super) fn without_degenerate(mesh: TriangleMesh) -> Cleaned {
    let came_from = (0..mesh.triangles.len()).collect();
    let mut cleaned = Cleaned {
        mesh,
        came_from,
        removed: 0,
    };
    cleaned.drop_where(|mesh, index| {
        let [a, b, c] = mesh.triangles[index];
        a == b || b == c || c == a
    });
    for _ in 0..ROUNDS {
        let merged = (0..cleaned.mesh.triangles.len())
            .filter(|&index| cleaned.merge_if_flat(index))
            .count();
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
        let kept: Vec<usize> = (0..self.came_from.len())
            .filter(|&index| !is_bad(&self.mesh, index))
            .collect();
        self.removed += self.came_from.len() - kept.len();
        self.mesh.triangles = kept
            .iter()
            .map(|&index| self.mesh.triangles[index])
            .collect();
        self.came_from = kept.iter().map(|&index| self.came_from[index]).collect();
    }

    /// Gives a flat triangle the half of its neighbour beyond its middle corner.
    fn merge_if_flat(&mut self, index: usize) -> bool {
        if !is_flat(&self.mesh, index) {
            return false;
        }
        let [end, middle, other_end] = longest_edge_last(&self.mesh, index);
        let has_both = |t: &[u32; 3]| t.contains(&end) && t.contains(&other_end);
        let neighbour = (0..self.came_from.len())
            .find(|&other| other != index && has_both(&self.mesh.triangles[other]));
        let Some(neighbour) = neighbour else {
            return false;
        };
        let whole = self.mesh.triangles[neighbour];
        if whole.contains(&middle) {
            return false;
        }
        let with_middle_for = |old: u32| whole.map(|v| if v == old { middle } else { v });
        self.mesh.triangles[neighbour] = with_middle_for(end);
        self.mesh.triangles[index] = with_middle_for(other_end);
        self.came_from[index] = self.came_from[neighbour];
        true
    }
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
    use crate::geometry::shell::{checked_shell, fixtures::unit_block};

    #[test]
    fn a_triangle_of_two_equal_corners_goes_without_a_gap() {
        let mut mesh = unit_block();
        mesh.triangles.insert(5, [0, 1, 1]);
        let shell = checked_shell(mesh).unwrap();
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
        let shell = checked_shell(mesh).unwrap();
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
        let shell = checked_shell(mesh).unwrap();
        assert_eq!(
            (shell.removed_degenerate, shell.mesh.triangles.len()),
            (1, 2)
        );
    }
}
