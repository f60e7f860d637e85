//! Cholesky's factor of a small dense matrix, eight rows side by side.

use crate::number::{F64x4, LANES, Number};

pub(crate) const ROWS: usize = 2 * LANES;

/// Number of panels that are eliminated together: earlier panels are then read from memory once for all of them.
const TOGETHER: usize = 4;

/// One number for each of the rows that go side by side, or for each right-hand side.
pub(crate) type Eight = [F64x4; 2];

/// The factor L of a symmetric positive definite matrix A = L L'.
///
/// It is stored in panels of eight rows, the rows of each column side by side, so that all of the work is products of
/// vectors. A matrix whose order is no multiple of eight is padded with the identity. The same matrix gives the same bytes
/// on any machine with fused products.
///
/// It is not taken from a library, since small matrices are factored and solved about a thousand times a second,
/// right-hand sides come in groups of eight (a load and its six derivatives), and the order of all operations is
/// fixed.
#[derive(Default)]
pub(crate) struct Cholesky {
    order: usize,
    /// Columns of the panels, one panel after the other.
    columns: Vec<Eight>,
    per_diagonal: Vec<f64>,
}

fn start(panel: usize) -> usize {
    ROWS * panel * (panel + 1) / 2
}

pub(crate) fn zero() -> Eight {
    [F64x4::splat(0.0); 2]
}

/// Subtracts b f from a.
#[inline(always)]
pub(crate) fn subtract(a: &mut Eight, b: &Eight, f: f64) {
    let f = F64x4::splat(-f);
    a[0] = b[0].mul_add(f, a[0]);
    a[1] = b[1].mul_add(f, a[1]);
}

/// Returns the number of a row, or of a right-hand side.
pub(crate) fn get(numbers: &Eight, side: usize) -> f64 {
    numbers[side / LANES].lane(side % LANES)
}

pub(crate) fn set(numbers: &mut Eight, side: usize, value: f64) {
    let half = &mut numbers[side / LANES];
    let mut lanes = half.to_array();
    lanes[side % LANES] = value;
    *half = F64x4::new(lanes);
}

/// Returns the product of two vectors, summed in four lanes.
pub(crate) fn product(a: &[f64], b: &[f64]) -> f64 {
    let (fours, others) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest = fours.remainder().iter().zip(others.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    let vector = |four: &[f64]| F64x4::from_lanes(|lane| four[lane]);
    let add = |sum: F64x4, (a, b): (&[f64], &[f64])| vector(a).mul_add(vector(b), sum);
    fours.zip(others).fold(F64x4::splat(0.0), add).sum() + rest
}

impl Cholesky {
    /// Factors a matrix of the given order; `entry` returns the number in a row and a column up to the diagonal.
    pub fn factor(&mut self, order: usize, entry: impl Fn(usize, usize) -> f64) {
        let panels = order.div_ceil(ROWS);
        self.order = order;
        self.columns.clear();
        self.per_diagonal.clear();
        for first in (0..panels).step_by(TOGETHER) {
            let some = first..panels.min(first + TOGETHER);
            some.clone().for_each(|panel| self.add_rows(panel, &entry));
            for block in 0..2 * first {
                some.clone().for_each(|panel| self.eliminate(panel, block));
            }
            for panel in some {
                for block in 2 * first..2 * panel {
                    self.eliminate(panel, block);
                }
                self.factor_diagonal(panel);
            }
        }
    }

    fn add_rows(&mut self, panel: usize, entry: &impl Fn(usize, usize) -> f64) {
        let order = self.order;
        let at = |row: usize, column: usize| {
            if row < column {
                0.0
            } else if row < order {
                entry(row, column)
            } else {
                f64::from(u8::from(row == column))
            }
        };
        for column in 0..ROWS * (panel + 1) {
            let half = |half: usize| {
                let first = ROWS * panel + LANES * half;
                F64x4::from_lanes(|lane| at(first + lane, column))
            };
            self.columns.push([half(0), half(1)]);
        }
    }

    /// Computes four columns of a panel left of its diagonal, from number 4 `block` on.
    fn eliminate(&mut self, panel: usize, block: usize) {
        let first = LANES * block;
        let (done, own) = self.columns.split_at_mut(start(panel));
        let other = &done[start(block / 2)..];
        let half = block % 2;
        // Four columns at a time stay in registers, and every column before is read once for all four.
        let mut four = [own[first], own[first + 1], own[first + 2], own[first + 3]];
        for (column, across) in own[..first].iter().zip(other) {
            let across = across[half];
            for (lane, sum) in four.iter_mut().enumerate() {
                subtract(sum, column, across.lane(lane));
            }
        }
        for j in 0..LANES {
            for m in 0..j {
                let across = other[first + m][half].lane(j);
                let column = four[m];
                subtract(&mut four[j], &column, across);
            }
            let scale = F64x4::splat(self.per_diagonal[first + j]);
            four[j] = four[j].map(|rows| rows * scale);
        }
        own[first..first + LANES].copy_from_slice(&four);
    }

    /// Computes the columns of a panel at its diagonal.
    fn factor_diagonal(&mut self, panel: usize) {
        let first = ROWS * panel;
        let own = &mut self.columns[start(panel)..start(panel + 1)];
        for j in 0..ROWS {
            let mut column = own[first + j];
            for before in &own[..first + j] {
                let across = before[j / LANES].lane(j % LANES);
                subtract(&mut column, before, across);
            }
            // A compliance is positive definite; the bound only keeps round-off from a division by zero.
            let pivot = column[j / LANES].lane(j % LANES).max(f64::MIN_POSITIVE);
            let per_diagonal = 1.0 / pivot.sqrt();
            self.per_diagonal.push(per_diagonal);
            own[first + j] = column.map(|rows| rows * F64x4::splat(per_diagonal));
        }
    }

    /// Returns the number of rows of right-hand sides: the order, rounded up.
    pub fn rows(&self) -> usize {
        self.per_diagonal.len()
    }

    /// Solves L x = b for eight right-hand sides at once, in place.
    pub fn forward(&self, sides: &mut [Eight]) {
        for four in 0..self.rows() / LANES {
            self.forward_four(four, sides);
        }
    }

    /// Does the same for several groups of eight: rows of the factor are then read from memory once for all of them.
    pub fn forward_groups(&self, groups: &mut [Vec<Eight>]) {
        for four in 0..self.rows() / LANES {
            groups
                .iter_mut()
                .for_each(|sides| self.forward_four(four, sides));
        }
    }

    fn forward_four(&self, four: usize, sides: &mut [Eight]) {
        let (first, half) = (LANES * four, four % 2);
        let own = &self.columns[start(four / 2)..];
        let (known, here) = sides.split_at_mut(first);
        let mut sums = [here[0], here[1], here[2], here[3]];
        for (known, column) in known.iter().zip(own) {
            for (lane, sum) in sums.iter_mut().enumerate() {
                subtract(sum, known, column[half].lane(lane));
            }
        }
        for j in 0..LANES {
            sums[j] = self.scaled(first + j, sums[j]);
            let solved = sums[j];
            for (lane, sum) in sums.iter_mut().enumerate().skip(j + 1) {
                subtract(sum, &solved, own[first + j][half].lane(lane));
            }
        }
        here[..LANES].copy_from_slice(&sums);
    }

    /// Solves L' x = b for eight right-hand sides at once, in place.
    pub fn backward(&self, sides: &mut [Eight]) {
        for four in (0..self.rows() / LANES).rev() {
            let (first, half) = (LANES * four, four % 2);
            let own = &self.columns[start(four / 2)..];
            let (before, here) = sides.split_at_mut(first);
            let mut solved = [here[0], here[1], here[2], here[3]];
            for j in (0..LANES).rev() {
                solved[j] = self.scaled(first + j, solved[j]);
                let known = solved[j];
                for (m, sum) in solved.iter_mut().enumerate().take(j) {
                    subtract(sum, &known, own[first + m][half].lane(j));
                }
            }
            here[..LANES].copy_from_slice(&solved);
            for (sum, column) in before.iter_mut().zip(own) {
                for (lane, known) in solved.iter().enumerate() {
                    subtract(sum, known, column[half].lane(lane));
                }
            }
        }
    }

    /// Solves L' x = b for one right-hand side, in place.
    pub fn backward_one(&self, side: &mut [f64]) {
        // A single right-hand side does not fill the lanes; they hold partial sums over the rows below instead.
        let mut taken = vec![zero(); side.len()];
        for panel in (0..side.len() / ROWS).rev() {
            let first = ROWS * panel;
            let own = &self.columns[start(panel)..];
            let here = &mut side[first..first + ROWS];
            for j in (0..ROWS).rev() {
                let column = own[first + j];
                let below = j + 1..ROWS;
                let of_panel = below.map(|m| column[m / LANES].lane(m % LANES) * here[m]);
                let taken = (taken[first + j][0] + taken[first + j][1]).sum();
                here[j] = (here[j] - taken - of_panel.sum::<f64>()) * self.per_diagonal[first + j];
            }
            let solved = [0, LANES].map(|half| F64x4::from_lanes(|lane| here[half + lane]));
            for (taken, column) in taken[..first].iter_mut().zip(own) {
                taken[0] = column[0].mul_add(solved[0], taken[0]);
                taken[1] = column[1].mul_add(solved[1], taken[1]);
            }
        }
    }

    fn scaled(&self, row: usize, sides: Eight) -> Eight {
        let scale = F64x4::splat(self.per_diagonal[row]);
        sides.map(|side| side * scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_solutions_of_every_order() {
        for order in 1..40_usize {
            let entry = |i: usize, j: usize| {
                let apart = i.abs_diff(j) as f64;
                (-0.2 * apart).exp() + if i == j { 0.1 } else { 0.0 }
            };
            let mut factor = Cholesky::default();
            factor.factor(order, entry);
            let right = |row: usize, side: usize| ((row * 7 + side * 3) % 11) as f64 - 4.0;
            let half =
                |row: usize, half: usize| F64x4::from_lanes(|lane| right(row, 4 * half + lane));
            let mut sides: Vec<Eight> =
                (0..order).map(|row| [half(row, 0), half(row, 1)]).collect();
            sides.resize(factor.rows(), zero());
            let mut groups = [0, 1].map(|group| {
                let scale = F64x4::splat(f64::from(group));
                let scaled = sides.iter().map(|sides| sides.map(|half| half * scale));
                scaled.collect::<Vec<Eight>>()
            });
            factor.forward_groups(&mut groups);
            factor.forward(&mut sides);
            assert_eq!(groups[1], sides, "{order}");
            assert!(groups[0].iter().all(|sides| *sides == zero()));
            let mut one: Vec<f64> = sides.iter().map(|sides| sides[1].lane(2)).collect();
            factor.backward_one(&mut one);
            factor.backward(&mut sides);
            for (one, sides) in one.iter().zip(&sides) {
                assert!((one - sides[1].lane(2)).abs() < 1e-12);
            }
            for row in 0..order {
                for side in 0..8 {
                    let part =
                        |column: usize| entry(row, column) * sides[column][side / 4].lane(side % 4);
                    let sum: f64 = (0..order).map(part).sum();
                    assert!(
                        (sum - right(row, side)).abs() < 1e-11,
                        "{order} {row} {side} {sum}"
                    );
                }
            }
        }
    }
}
