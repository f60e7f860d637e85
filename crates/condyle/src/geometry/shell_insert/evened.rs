//! An outline without chips, slits and teeth narrower than a hexahedron.

use crate::geometry::columns::ColumnGrid;

/// Takes away what of some samples is narrower than `2 reach + 1` of them, and fills what is narrower
/// between them: an opening and a closing by a square.
pub fn without_details(samples: &ColumnGrid, holds: &[bool], reach: usize) -> Vec<bool> {
    let grown = |of: &[bool]| spread(samples, of, reach, true);
    let shrunk = |of: &[bool]| spread(samples, of, reach, false);
    let opened = grown(&shrunk(holds));
    shrunk(&grown(&opened))
}

/// Lets samples that are `value` spread by `reach` samples along both axes.
fn spread(samples: &ColumnGrid, of: &[bool], reach: usize, value: bool) -> Vec<bool> {
    let along_z = samples.cells.1 + 1;
    let along = |of: &[bool], stride: usize, place: &dyn Fn(usize) -> (usize, usize)| {
        let mut spread = of.to_vec();
        for (n, spread) in spread.iter_mut().enumerate() {
            let (at, count) = place(n);
            let first = n - stride * at.min(reach);
            let steps = at.min(reach) + (count - 1 - at).min(reach);
            if (0..=steps).any(|step| of[first + stride * step] == value) {
                *spread = value;
            }
        }
        spread
    };
    let along_x = samples.cells.0 + 1;
    let rows = along(of, 1, &|n| (n % along_z, along_z));
    along(&rows, along_z, &|n| (n / along_z, along_x))
}
