//! The gap at the nodes of a grid near a mesh.

use super::node_grid::{BAND_MM, NodeGrid};
use condyle_mesh::CurvedMesh;

/// What stands at the nodes beyond the band until a bound is found, mm: no gap is as large.
pub const BEYOND_BAND_MM: f64 = 1e3;

/// The gap at every node of a grid within the band, [`BEYOND_BAND_MM`] elsewhere.
///
/// Each of `threads` fills its own layers, and no number depends on which thread found it. One
/// thread is the caller's: none is started.
pub fn gaps_at_nodes(grid: &NodeGrid, mesh: &CurvedMesh<'_>, threads: usize) -> Vec<f64> {
    let mut gaps = vec![BEYOND_BAND_MM; grid.node_count()];
    if threads <= 1 {
        fill_layers(grid, mesh, 0, &mut gaps);
        return gaps;
    }
    let [_, _, layer] = grid.strides();
    let layers = grid.counts[2].div_ceil(threads);
    std::thread::scope(|scope| {
        for (index, part) in gaps.chunks_mut(layer * layers).enumerate() {
            scope.spawn(move || fill_layers(grid, mesh, index * layers, part));
        }
    });
    gaps
}

/// Fills the layers of nodes from `first_layer` with their gaps to the nearest triangle.
fn fill_layers(grid: &NodeGrid, mesh: &CurvedMesh<'_>, first_layer: usize, gaps: &mut [f64]) {
    let nearest = nearest_triangles(grid, mesh, first_layer, gaps.len());
    let [_, row, layer] = grid.strides();
    for (here, (gap, triangle)) in gaps.iter_mut().zip(nearest).enumerate() {
        if let Some(triangle) = triangle {
            let (i, j, k) = (here % row, here % layer / row, here / layer);
            let node = grid.position(i, j, k + first_layer);
            *gap = mesh.curved_gap_mm(triangle, &node);
        }
    }
}

/// The triangle nearest to each of `count` nodes from `first_layer` on; none beyond the band.
fn nearest_triangles(
    grid: &NodeGrid,
    mesh: &CurvedMesh<'_>,
    first_layer: usize,
    count: usize,
) -> impl Iterator<Item = Option<usize>> {
    const NONE: u32 = u32::MAX;
    let [_, row, layer] = grid.strides();
    let last_layer = first_layer + count / layer;
    let mut nearest2 = vec![BAND_MM * BAND_MM; count];
    let mut nearest = vec![NONE; count];
    for triangle in 0..mesh.triangle_count() {
        let [low, high] = grid.band_around(mesh.corners(triangle));
        for k in low[2].max(first_layer)..high[2].min(last_layer) {
            for j in low[1]..high[1] {
                for i in low[0]..high[0] {
                    let here = i + row * j + layer * (k - first_layer);
                    let node = grid.position(i, j, k);
                    // The plane is never farther than the triangle, and quicker to ask.
                    if mesh.plane_distance2(triangle, &node) >= nearest2[here] {
                        continue;
                    }
                    let distance2 = mesh.distance2(triangle, &node);
                    if distance2 < nearest2[here] {
                        (nearest2[here], nearest[here]) = (distance2, triangle as u32);
                    }
                }
            }
        }
    }
    let found = nearest.into_iter();
    found.map(|triangle| (triangle != NONE).then_some(triangle as usize))
}
