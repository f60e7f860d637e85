//! Where vertical lines go through a shell.

use std::ops::RangeInclusive;

use crate::geometry::{
    columns::{Column, ColumnGrid},
    curved_mesh::CurvedMesh,
    triangle_mesh::TriangleMesh,
};

/// Lowest and highest crossing of the vertical line through every grid point.
pub fn columns_through(shell: &TriangleMesh, grid: &ColumnGrid) -> Vec<Column> {
    let curved = CurvedMesh::new(shell);
    let mut columns: Vec<Column> = vec![None; grid.point_count()];
    for triangle in 0..shell.triangles.len() {
        let [a, b, c] = shell.corners(triangle);
        let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        let (along_x, along_z) = points_between(grid, (low.x, low.z), (high.x, high.z));
        for i in along_x {
            for k in along_z.clone() {
                if let Some(height) = curved.height_over(triangle, grid.place_mm(i, k)) {
                    let column = &mut columns[grid.number(i, k)];
                    let (bottom, top) = column.unwrap_or((height, height));
                    *column = Some((bottom.min(height), top.max(height)));
                }
            }
        }
    }
    columns
}

/// Numbers along x and z of the grid points in the rectangle from `low` to `high`, (x, z).
fn points_between(
    grid: &ColumnGrid,
    low: (f64, f64),
    high: (f64, f64),
) -> (RangeInclusive<usize>, RangeInclusive<usize>) {
    // A grid point on the very edge of the shell counts as inside, whatever way it is rounded.
    const ON_EDGE: f64 = 1e-9;
    let range = |low: f64, high: f64, origin: f64, step: f64, cells: usize| {
        let first = ((low - origin) / step - ON_EDGE).ceil().max(0.0);
        let last = ((high - origin) / step + ON_EDGE).floor().max(0.0);
        first as usize..=(last as usize).min(cells)
    };
    let (origin, step, cells) = (grid.origin_mm, grid.step_mm, grid.cells);
    (
        range(low.0, high.0, origin.0, step.0, cells.0),
        range(low.1, high.1, origin.1, step.1, cells.1),
    )
}
