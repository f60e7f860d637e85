//! The wear by every law of powers in one pass, for the uncertainty of its constants.
//!
//! The depth by the law [`power-law`](super::WEAR_LAWS) with a cross-shear exponent of 1 is
//!
//! depth = k p0^m / g(0.5) (f W(m) + (1 - f) W(m) CS / (CS + c)), with W(m) = sum over the cycle of p^(1-m) |ds|.
//!
//! W(m) is smooth in m, and CS / (CS + c) in ln c. Both are interpolated by polynomials between fixed points, so that
//! the depth by any constants is a sum of columns that do not depend on them. Sums over nodes and over intervals of
//! cycles are then sums of the columns.

use super::{MM_PER_M, MeanCycle};

/// Exponents of pressure of the columns. They are evenly spaced, so that one power serves them all.
const EXPONENTS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
const EXPONENT_STEP: f64 = 0.2;
/// Saturations of cross-shear of the columns: Chebyshev points in the logarithm from 0.002 to 0.5.
const SATURATIONS: [f64; 7] = [
    0.002143, 0.003653, 0.009545, 0.03162, 0.1048, 0.2738, 0.4666,
];
/// Pressure that scales the columns, MPa: pressures between a tenth and ten times this are interpolated to 0.1 %.
const SCALE_MPA: f64 = 10.0;
/// Columns of one exponent: that of a line, then those of every saturation.
const ROW: usize = 1 + SATURATIONS.len();
/// Number of columns.
pub(crate) const COLUMNS: usize = EXPONENTS.len() * ROW;

/// The wear by every law of the family: of a node in a cycle, or a sum of such, in mm or mm3 for a unit factor.
pub(crate) type FamilyColumns = [f64; COLUMNS];

/// Constants of a law of the family.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FamilyConstants {
    /// Wear factor on a circular path at the reference pressure, mm3/(N m).
    pub circle_factor_mm3_per_nm: f64,
    /// Pressure at which that factor applies, MPa.
    pub reference_pressure_mpa: f64,
    /// Power by which the factor falls with pressure, 0 to 1.
    pub pressure_exponent: f64,
    /// Cross-shear ratio above which more cross-shear adds little, 0.002 to 0.5.
    pub cross_shear_saturation: f64,
    /// Part of the wear at saturated cross-shear that remains on a line, 0 to 1.
    pub line_factor_ratio: f64,
}

impl FamilyConstants {
    /// Returns whether the wear by these constants is interpolated between the columns; beyond them polynomials fail.
    pub fn is_interpolated(&self) -> bool {
        (0.0..=1.0).contains(&self.pressure_exponent)
            && (0.002..=0.5).contains(&self.cross_shear_saturation)
    }

    /// Returns the weights of the columns whose sum is the wear by these constants.
    pub(crate) fn weights(&self) -> FamilyColumns {
        let (m, c, f) = (
            self.pressure_exponent,
            self.cross_shear_saturation,
            self.line_factor_ratio,
        );
        let on_circle = f + (1.0 - f) * 0.5 / (0.5 + c);
        let factor = self.circle_factor_mm3_per_nm / MM_PER_M / on_circle
            * (self.reference_pressure_mpa / SCALE_MPA).powf(m);
        let of_exponent = lagrange(&EXPONENTS, m);
        let of_saturation = lagrange(&SATURATIONS.map(f64::ln), c.ln());
        let mut weights = [0.0; COLUMNS];
        for (row, of_exponent) in weights.chunks_mut(ROW).zip(of_exponent) {
            row[0] = factor * of_exponent * f;
            for (weight, of_saturation) in row[1..].iter_mut().zip(of_saturation) {
                *weight = factor * of_exponent * (1.0 - f) * of_saturation;
            }
        }
        weights
    }
}

/// Returns the values at `x` of the polynomials that are 1 at one of the points and 0 at the others.
fn lagrange<const N: usize>(points: &[f64; N], x: f64) -> [f64; N] {
    std::array::from_fn(|own| {
        let others = points.iter().enumerate().filter(|(other, _)| *other != own);
        others
            .map(|(_, other)| (x - other) / (points[own] - other))
            .product()
    })
}

/// Returns the columns of a node in its mean cycle.
pub(crate) fn family_columns(cycle: &MeanCycle<'_>) -> FamilyColumns {
    let mut work = [0.0; EXPONENTS.len()];
    // `for_each` and not `for`: the chained iterators of all activities run faster from inside.
    cycle.moments().for_each(|(share, moment)| {
        if moment.pressure_mpa > 0.0 {
            let root = (moment.pressure_mpa / SCALE_MPA).powf(-0.5 * EXPONENT_STEP);
            let mut term = share * moment.pressure_mpa * moment.distance_mm() * root;
            for sum in &mut work {
                *sum += term;
                term *= root * root;
            }
        }
    });
    let cross_shear = cycle.slip_work.cross_shear();
    let mut columns = [0.0; COLUMNS];
    for (row, work) in columns.chunks_mut(ROW).zip(work) {
        row[0] = work;
        for (column, saturation) in row[1..].iter_mut().zip(SATURATIONS) {
            *column = work * cross_shear / (cross_shear + saturation);
        }
    }
    columns
}

/// Returns the sum of the columns by their weights.
pub(crate) fn weighted(columns: &[f64], weights: &FamilyColumns) -> f64 {
    columns
        .iter()
        .zip(weights)
        .map(|(column, weight)| column * weight)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::super::tests::{depth_mm, history, rectangle, straight};
    use super::*;
    use crate::wear::WEAR_LAWS;

    #[test]
    fn verify_interpolated_depths_are_those_of_the_law() {
        let kind = WEAR_LAWS.iter().find(|kind| kind.word == "power-law");
        let kind = kind.expect("it exists");
        let paths = [
            rectangle(1.5, [9.0, 1.0]),
            [rectangle(8.0, [3.0, 0.4]), rectangle(40.0, [2.0, 0.1])].concat(),
            straight(20.0, [20.0, 0.0]),
        ];
        for path in &paths {
            let history = history(path);
            let shared = [(1.0, &history)];
            let columns = family_columns(&MeanCycle::new(&shared, 0, 2.0));
            for m in [0.1, 0.2, 0.43, 0.65, 0.9] {
                for (c, f) in [
                    (0.003, 0.0),
                    (0.013, 0.1),
                    (0.036, 0.026),
                    (0.1, 0.0),
                    (0.4, 0.3),
                ] {
                    let law = kind.law(&[1.6e-6, 1.1, m, 1.0, c, f]);
                    let constants = FamilyConstants {
                        circle_factor_mm3_per_nm: 1.6e-6,
                        reference_pressure_mpa: 1.1,
                        pressure_exponent: m,
                        cross_shear_saturation: c,
                        line_factor_ratio: f,
                    };
                    let exact = depth_mm(law.as_ref(), path);
                    let interpolated = weighted(&columns, &constants.weights());
                    // Relative to the wear on a circle: on a line without a floor there is none.
                    let circle = depth_mm(law.as_ref(), &rectangle(10.0, [5.0, 5.0]));
                    let error = (interpolated - exact).abs() / exact.max(0.01 * circle);
                    assert!(error < 0.005, "{m} {c} {f}: {interpolated:e} {exact:e}");
                }
            }
        }
    }
}
