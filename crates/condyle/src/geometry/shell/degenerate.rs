//! Triangles without area, taken out so that no gap is left.

use crate::geometry::TriangleMesh;

/// Height over longest edge below which a triangle has no area: rounding of double precision.
const FLAT: f64 = 1e-12;

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
pub(super) fn without_degenerate(mut mesh: TriangleMesh) -> Cleaned {
    let before = mesh.triangles.len();
    let mut came_from: Vec<usize> = (0..before).collect();
    drop_marked(&mut mesh, &mut came_from, |_, [a, b, c]| a == b || b == c || c == a);
    let flat: Vec<usize> = (0..mesh.triangles.len()).filter(|&t| is_flat(&mesh, t)).collect();
    let mut spent = vec![false; mesh.triangles.len()];
    for triangle in flat {
        spent[triangle] = !is_flat(&mesh, triangle) || split_neighbour(&mut mesh, triangle, &mut came_from, &spent);
    }
    drop_marked(&mut mesh, &mut came_from, |index, _| spent.get(index) == Some(&true));
    let removed = before - came_from.len();
    Cleaned { mesh, came_from, removed }
}

fn drop_marked(
    mesh: &mut TriangleMesh,
    came_from: &mut Vec<usize>,
    is_marked: impl Fn(usize, [u32; 3]) -> bool,
) {
    let kept: Vec<bool> =
        mesh.triangles.iter().enumerate().map(|(index, &t)| !is_marked(index, t)).collect();
    let mut keep = kept.iter();
    mesh.triangles.retain(|_| keep.next() == Some(&true));
    let mut keep = kept.iter();
    came_from.retain(|_| keep.next() == Some(&true));
}
