//! Mean overclosure of a share of the surface that may press only in part.

use crate::number::Number;

/// Below this the rise of the overclosure along an edge counts as this much, mm: it keeps the
/// closed form away from 0/0 and widens the edge of contact by a thousandth of a millimetre.
const LEAST_RISE_MM: f64 = 1e-3;

/// Mean of the positive part of the overclosure over a share, and its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MeanOverclosure<T> {
    /// The mean, mm; 0 where nothing presses.
    pub mm: T,
    /// Overclosure that the share's most overclosed corner has above its middle, mm.
    pub reach_mm: T,
    /// Derivative by the overclosure of the share's middle: the part of the share that presses.
    pub by_middle: T,
    /// Derivative by the rise of the overclosure along each edge of the share.
    pub by_rise: [T; 2],
}

/// Mean of max(0, d) over a parallelogram where d is linear: `middle_mm` at its centre, rising by
/// `rise_mm` along each edge.
///
/// With r and s the two rises, the mean is (c1^3 - c2^3 - c3^3 + c4^3)/(6 r s) over the positive
/// parts of the four corners c = d +- r/2 +- s/2. It is twice continuously differentiable, so
/// force and tangent are smooth as nodes come into contact; where all corners press it is d.
#[inline(always)]
pub(super) fn mean_overclosure<T: Number>(middle_mm: T, rise_mm: [T; 2]) -> MeanOverclosure<T> {
    let (zero, one) = (T::zero(), T::one());
    let least2 = T::splat(LEAST_RISE_MM * LEAST_RISE_MM);
    let [r, s] = rise_mm.map(|rise| (rise * rise + least2).sqrt());
    let half = T::splat(0.5);
    let (sum, difference) = ((r + s) * half, (r - s) * half);
    let [c1, c2, c3, c4] =
        [sum, difference, -difference, -sum].map(|corner| Number::max(middle_mm + corner, zero));
    let [q1, q2, q3, q4] = [c1 * c1, c2 * c2, c3 * c3, c4 * c4];
    let (per_r, per_s) = (one / r, one / s);
    let per_area = per_r * per_s;
    let mm = (c1 * q1 - c2 * q2 - c3 * q3 + c4 * q4) * per_area * T::splat(1.0 / 6.0);
    let by_r = (q1 - q2 + q3 - q4) * per_area * T::splat(0.25) - mm * per_r;
    let by_s = (q1 + q2 - q3 - q4) * per_area * T::splat(0.25) - mm * per_s;
    // Where all corners press, the closed form is right but loses digits.
    let in_part = middle_mm - sum;
    MeanOverclosure {
        mm: in_part.below_zero(mm, middle_mm),
        reach_mm: sum,
        by_middle: in_part.below_zero((q1 - q2 - q3 + q4) * per_area * half, one),
        by_rise: [
            in_part.below_zero(by_r * rise_mm[0] * per_r, zero),
            in_part.below_zero(by_s * rise_mm[1] * per_s, zero),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(middle: f64, [r, s]: [f64; 2]) -> f64 {
        let n = 1000;
        let place = |i: i32| (f64::from(i) + 0.5) / f64::from(n) - 0.5;
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                sum += (middle + r * place(i) + s * place(j)).max(0.0);
            }
        }
        sum / f64::from(n * n)
    }

    #[test]
    fn verify_mean_against_sampling() {
        for rises in [[0.2, 0.1], [0.05, -0.2], [0.1, 0.1]] {
            for middle in [-0.12, -0.05, 0.0, 0.03, 0.1, 0.2] {
                let mean = mean_overclosure(middle, rises).mm;
                assert!(
                    (mean - sampled(middle, rises)).abs() < 2e-6,
                    "{middle} {rises:?} {mean}"
                );
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_mean() {
        let mean = |middle: f64, rises: [f64; 2]| mean_overclosure(middle, rises);
        let step = 1e-6;
        for rises in [[0.2, 0.1], [0.05, -0.2], [0.1, 0.1], [1e-4, 0.15]] {
            for middle in [-0.04, 0.0, 0.03, 0.07, 0.2] {
                let here = mean(middle, rises);
                let by_middle =
                    (mean(middle + step, rises).mm - mean(middle - step, rises).mm) / (2.0 * step);
                assert!((here.by_middle - by_middle).abs() < 1e-7);
                for edge in 0..2 {
                    let moved = |sign: f64| {
                        let mut other = rises;
                        other[edge] += sign * step;
                        mean(middle, other).mm
                    };
                    let by_rise = (moved(1.0) - moved(-1.0)) / (2.0 * step);
                    assert!(
                        (here.by_rise[edge] - by_rise).abs() < 1e-7,
                        "{middle} {rises:?}"
                    );
                }
            }
        }
    }
}
