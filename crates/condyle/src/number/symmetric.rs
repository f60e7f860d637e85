//! A symmetric matrix, for products with vectors.

use std::array::from_fn;

use nalgebra::DMatrix;

use super::{F64x4, LANES, Number};

/// A dense symmetric matrix, of which only the lower triangle is kept.
///
/// A product reads every number once and uses it twice, which matters for a matrix that is larger than a cache: half of
/// it may fit.
pub(crate) struct Symmetric {
    /// Blocks of four by four, row after row up to that on the diagonal, which is whole; each holds its rows. A size that is
    /// no multiple of four is padded with zeros.
    blocks: Vec<[F64x4; LANES]>,
}

impl Symmetric {
    /// Keeps the lower triangle of a square matrix.
    pub fn from_lower(matrix: &DMatrix<f64>) -> Self {
        let at = |row: usize, column: usize| {
            let place = (row.max(column), row.min(column));
            matrix.get(place).copied().unwrap_or_default()
        };
        let block = |i: usize, j: usize| {
            from_fn(|row| F64x4::from_lanes(|lane| at(LANES * i + row, LANES * j + lane)))
        };
        let rows = 0..matrix.nrows().div_ceil(LANES);
        Self {
            blocks: rows
                .flat_map(|i| (0..=i).map(move |j| block(i, j)))
                .collect(),
        }
    }

    /// Returns the product with a vector.
    pub fn times(&self, vector: &[f64]) -> Vec<f64> {
        let four = |numbers: &[f64]| {
            F64x4::from_lanes(|lane| numbers.get(lane).copied().unwrap_or_default())
        };
        let vector_fours: Vec<F64x4> = vector.chunks(LANES).map(four).collect();
        let mut product = vec![F64x4::splat(0.0); vector_fours.len()];
        let mut left = &self.blocks[..];
        for (i, own) in vector_fours.iter().enumerate() {
            let (blocks, others) = left.split_at(i + 1);
            left = others;
            let across: [F64x4; LANES] = from_fn(|row| F64x4::splat(own.lane(row)));
            let mut sums = [F64x4::splat(0.0); LANES];
            for ((block, four), product) in blocks[..i].iter().zip(&vector_fours).zip(&mut product)
            {
                for row in 0..LANES {
                    sums[row] = block[row].mul_add(*four, sums[row]);
                    *product = block[row].mul_add(across[row], *product);
                }
            }
            let of_row = |row: usize| blocks[i][row].mul_add(*own, sums[row]).sum();
            product[i] += F64x4::from_lanes(of_row);
        }
        let numbers = product.iter().flat_map(|four| four.to_array());
        numbers.take(vector.len()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    #[test]
    fn verify_products_of_every_size() {
        for size in 1..23 {
            let number = |i: usize, j: usize| ((i * 37 + j * 101) as f64).sin();
            let full = DMatrix::from_fn(size, size, |i, j| number(i, j) + number(j, i));
            let vector = DVector::from_fn(size, |i, _| number(i, 3));
            let product = Symmetric::from_lower(&full).times(vector.as_slice());
            assert_eq!(product.len(), size);
            assert!((DVector::from(product) - &full * &vector).amax() < 1e-13);
        }
    }
}
