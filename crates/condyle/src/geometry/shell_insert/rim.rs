//! Columns at the rim that make no good hexahedra.

use crate::geometry::columns::{Column, ColumnGrid};

/// Columns thinner than this share of the median are rim, and left out.
const THINNEST_SHARE: f64 = 0.4;
/// Cells whose surface rises by more than this many edges are side wall, and left out.
const STEEPEST_RISE: f64 = 1.5;

/// Leaves out the columns that are thin beside the median.
pub fn drop_thin(columns: &mut [Column]) {
    let mut thickness: Vec<f64> = columns
        .iter()
        .flatten()
        .map(|(bottom, top)| top - bottom)
        .collect();
    thickness.sort_unstable_by(f64::total_cmp);
    let Some(median) = thickness.get(thickness.len() / 2) else {
        return;
    };
    for column in columns {
        *column = column.filter(|(bottom, top)| top - bottom >= THINNEST_SHARE * median);
    }
}

/// Leaves out the lower end of every steep edge of the grid, edges being `edge_mm` long.
pub fn drop_steep(grid: &ColumnGrid, columns: &mut [Column], edge_mm: f64) {
    let most_rise_mm = STEEPEST_RISE * edge_mm;
    let before = columns.to_vec();
    let mut check = |here: usize, there: usize| {
        if let (Some((_, one)), Some((_, other))) = (before[here], before[there])
            && (one - other).abs() > most_rise_mm
        {
            columns[if one < other { here } else { there }] = None;
        }
    };
    for i in 0..=grid.cells.0 {
        for k in 0..=grid.cells.1 {
            if i < grid.cells.0 {
                check(grid.number(i, k), grid.number(i + 1, k));
            }
            if k < grid.cells.1 {
                check(grid.number(i, k), grid.number(i, k + 1));
            }
        }
    }
}
