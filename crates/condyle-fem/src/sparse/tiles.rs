//! Dense triangular matrices in tiles of four by four, and the operations on them.
//!
//! Row `t` of tiles holds the columns from 0 on, each as the vector of its four rows. So a product of two
//! rows of tiles runs through both in order, and nothing is repacked.

use std::ops::Range;

use wide::f64x4;

/// Rows and columns of a tile.
pub(crate) const TILE: usize = 4;

/// Rows of tiles that go together through a product: with them twelve sums stay in registers.
const TOGETHER: usize = 3;

/// Columns that are eliminated before the rest is updated by all of them: they stay in the cache.
const PANEL: usize = 64;

/// The lower triangle of a symmetric matrix, whole tiles on the diagonal.
pub(crate) struct Triangle {
    /// Rows, a multiple of [`TILE`].
    size: usize,
    vectors: Vec<f64x4>,
}

/// Returns the first vector of row `t` of tiles.
#[inline]
fn start_of_row(t: usize) -> usize {
    TILE * (t * (t + 1) / 2)
}

impl Triangle {
    /// Creates a triangle of zeros in reused memory.
    pub(crate) fn zeros(size: usize, mut memory: Vec<f64x4>) -> Self {
        memory.clear();
        memory.resize(start_of_row(size / TILE), f64x4::ZERO);
        Self {
            size,
            vectors: memory,
        }
    }

    pub(crate) fn into_memory(self) -> Vec<f64x4> {
        self.vectors
    }

    pub(crate) fn row(&self, t: usize) -> &[f64x4] {
        &self.vectors[start_of_row(t)..start_of_row(t + 1)]
    }

    pub(crate) fn row_mut(&mut self, t: usize) -> &mut [f64x4] {
        &mut self.vectors[start_of_row(t)..start_of_row(t + 1)]
    }

    /// Returns the number at a row and a column, which must not exceed the row.
    #[inline(always)]
    pub(crate) fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        let vector = &mut self.vectors[start_of_row(row / TILE) + column];
        &mut vector.as_mut_array()[row % TILE]
    }

    /// Returns the number at a row and a column, which must not exceed the row.
    #[inline(always)]
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.vectors[start_of_row(row / TILE) + column].as_array()[row % TILE]
    }

    /// Eliminates the first `columns`, a multiple of [`TILE`]: they then hold the Cholesky factor, with the inverses
    /// on its diagonal, and the rest holds the remainder of the elimination.
    ///
    /// `least`: pivots that are too small for each column.
    ///
    /// # Errors
    /// The first column whose pivot is too small.
    pub(crate) fn eliminate(&mut self, columns: usize, least: &[f64]) -> Result<(), usize> {
        let rows = self.size / TILE;
        // Right-looking by panels, left-looking within one: each number is loaded once per panel.
        for start in (0..columns).step_by(PANEL) {
            let end = (start + PANEL).min(columns);
            for column in (start..end).step_by(TILE) {
                let tile = column / TILE;
                self.update_column(tile, tile..rows, start..column);
                self.factor_tile(tile, &least[column..column + TILE])?;
                self.solve_tiles(tile);
            }
            // The products over the panel are subtracted from the tiles of all later rows and columns.
            let first = end / TILE;
            for t in (first..rows).step_by(TOGETHER) {
                let together = t..(t + TOGETHER).min(rows);
                for column in first..together.end {
                    self.update_column(column, column.max(t)..together.end, start..end);
                }
            }
        }
        Ok(())
    }

    /// Updates the tiles of one column with the products of earlier columns.
    #[inline]
    fn update_column(&mut self, column: usize, rows: Range<usize>, over: Range<usize>) {
        if over.is_empty() {
            return;
        }
        let mut t = rows.start;
        while t < rows.end {
            if t + TOGETHER <= rows.end {
                self.update::<TOGETHER>(t, column, &over);
                t += TOGETHER;
            } else {
                self.update::<1>(t, column, &over);
                t += 1;
            }
        }
    }

    #[inline]
    fn update<const N: usize>(&mut self, t: usize, column: usize, over: &Range<usize>) {
        let strip = |t: usize| &self.vectors[start_of_row(t)..][over.clone()];
        let strips: [&[f64x4]; N] = std::array::from_fn(|i| strip(t + i));
        let sums = products(strips, strip(column));
        for (i, sums) in sums.iter().enumerate() {
            let at = start_of_row(t + i) + TILE * column;
            for (vector, sum) in self.vectors[at..at + TILE].iter_mut().zip(sums) {
                *vector -= *sum;
            }
        }
    }

    fn factor_tile(&mut self, tile: usize, least: &[f64]) -> Result<(), usize> {
        let start = TILE * tile;
        for j in start..start + TILE {
            let pivot = self.at(j, j);
            if pivot.is_nan() || pivot <= least[j - start] {
                return Err(j);
            }
            // The inverse is stored, so that all solves multiply instead of dividing.
            let inverse = 1.0 / pivot.sqrt();
            *self.at_mut(j, j) = inverse;
            for i in j + 1..start + TILE {
                *self.at_mut(i, j) *= inverse;
            }
            for k in j + 1..start + TILE {
                for i in k..start + TILE {
                    let product = self.at(i, j) * self.at(k, j);
                    *self.at_mut(i, k) -= product;
                }
            }
        }
        Ok(())
    }

    /// Divides the tiles below one on the diagonal by its factor.
    fn solve_tiles(&mut self, tile: usize) {
        let start = TILE * tile;
        let factor: [[f64; TILE]; TILE] = std::array::from_fn(|i| {
            let at = |j: usize| self.at(start + i, start + j);
            std::array::from_fn(|j| if j <= i { at(j) } else { 0.0 })
        });
        for t in tile + 1..self.size / TILE {
            let at = start_of_row(t) + start;
            let columns = &mut self.vectors[at..at + TILE];
            for j in 0..TILE {
                let mut sum = columns[j];
                for k in 0..j {
                    sum -= columns[k] * f64x4::splat(factor[j][k]);
                }
                columns[j] = sum * f64x4::splat(factor[j][j]);
            }
        }
    }
}

/// Products of some rows of tiles with another, over as many columns as both have.
#[inline(always)]
fn products<const N: usize>(strips: [&[f64x4]; N], other: &[f64x4]) -> [[f64x4; TILE]; N] {
    let mut sums = [[f64x4::ZERO; TILE]; N];
    let strips = strips.map(|strip| &strip[..other.len()]);
    for (k, other) in other.iter().enumerate() {
        let vectors: [f64x4; N] = std::array::from_fn(|i| strips[i][k]);
        // One number at a time: with three rows of tiles every register is taken.
        for (j, &number) in other.as_array().iter().enumerate() {
            let number = f64x4::splat(number);
            for (sums, vector) in sums.iter_mut().zip(vectors) {
                sums[j] = vector.mul_add(number, sums[j]);
            }
        }
    }
    sums
}

/// Columns of the factor that a group eliminates, in rows of tiles as in a [`Triangle`].
///
/// The rows are the freedoms of the group's own nodes, padded to whole tiles by uncoupled freedoms, and then those of
/// its boundary, also padded.
pub(crate) struct Front {
    /// Freedoms eliminated, a multiple of [`TILE`].
    pub(crate) columns: usize,
    /// The first vector of every row of tiles, and the end of the last.
    starts: Vec<usize>,
    vectors: Vec<f64x4>,
}

impl Front {
    pub(crate) fn from_triangle(triangle: &Triangle, columns: usize, rows: usize) -> Self {
        let (mut starts, mut vectors) = (vec![0], Vec::with_capacity(columns * rows / TILE));
        for t in 0..rows / TILE {
            let row = triangle.row(t);
            vectors.extend_from_slice(&row[..row.len().min(columns)]);
            starts.push(vectors.len());
        }
        Self {
            columns,
            starts,
            vectors,
        }
    }

    #[inline]
    pub(crate) fn row(&self, t: usize) -> &[f64x4] {
        &self.vectors[self.starts[t]..self.starts[t + 1]]
    }

    /// Rows of tiles of all freedoms.
    pub(crate) fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    pub(crate) fn len(&self) -> usize {
        TILE * self.vectors.len()
    }
}

/// The rows of a front that the freedoms of its nodes occupy.
pub(crate) struct Layout {
    /// Rows of the own freedoms, whole tiles.
    pub(crate) columns: usize,
    /// All rows, whole tiles.
    pub(crate) rows: usize,
}

impl Layout {
    /// Creates the layout for given numbers of own nodes and of nodes on the boundary.
    pub(crate) fn new(own: usize, boundary: usize) -> Self {
        let columns = (3 * own).next_multiple_of(TILE);
        Self {
            columns,
            rows: columns + (3 * boundary).next_multiple_of(TILE),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    #[test]
    fn verify_partial_elimination_against_the_schur_complement() {
        let (size, columns) = (152, 84);
        let random = |i: usize, j: usize| ((i * 37 + j * 101) as f64).sin();
        let half = DMatrix::from_fn(size, size, random);
        let full = &half * half.transpose() + DMatrix::identity(size, size);
        let mut triangle = Triangle::zeros(size, Vec::new());
        for j in 0..size {
            for i in j..size {
                *triangle.at_mut(i, j) = full[(i, j)];
            }
        }
        assert!(triangle.eliminate(columns, &vec![0.0; columns]).is_ok());
        let rest = size - columns;
        let first = full.view((0, 0), (columns, columns)).into_owned();
        let lower = first.clone().cholesky().unwrap().l();
        let below = full.view((columns, 0), (rest, columns));
        let last = full.view((columns, columns), (rest, rest));
        let schur = last - below * first.cholesky().unwrap().solve(&below.transpose());
        for j in 0..rest {
            for i in j..rest {
                let found = triangle.at(columns + i, columns + j);
                assert!((found - schur[(i, j)]).abs() < 1e-9);
            }
        }
        for j in 0..columns {
            assert!((1.0 / triangle.at(j, j) - lower[(j, j)]).abs() < 1e-11);
            for i in j + 1..columns {
                assert!((triangle.at(i, j) - lower[(i, j)]).abs() < 1e-11);
            }
        }
    }
}
