//! Some columns of numbers, side by side.

use wide::f64x4;

/// `4 W` columns of forces or displacements, a row for every freedom in the order of elimination.
pub(crate) struct Rhs<const W: usize> {
    pub(crate) rows: Vec<[f64x4; W]>,
}

impl<const W: usize> Rhs<W> {
    /// How many columns go side by side.
    pub(crate) const COLUMNS: usize = 4 * W;

    /// Of zeros.
    pub(crate) fn new(freedoms: usize) -> Self {
        Self {
            rows: vec![[f64x4::ZERO; W]; freedoms],
        }
    }

    /// The number at a row and a column.
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.rows[row][column / 4].as_array()[column % 4]
    }

    /// The number at a row and a column.
    pub(crate) fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.rows[row][column / 4].as_mut_array()[column % 4]
    }
}
