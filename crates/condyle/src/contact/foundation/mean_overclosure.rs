//! The mean overclosure of a share of the surface of which only a part may be in contact.

use crate::number::Number;

/// Smooth lower bound on edge slopes, mm. It keeps the closed form away from 0/0, and widens the edge of contact by a
/// thousandth of a millimetre. A flat share with less overclosure counts as partly in contact.
const MIN_SLOPE_MM: f64 = 1e-3;

/// The edge slopes of a share: the rise of the overclosure along each of its edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EdgeSlopes<T> {
    signed_mm: [T; 2],
    /// Magnitudes of the slopes, never zero.
    size_mm: [T; 2],
}

impl<T: Number> EdgeSlopes<T> {
    #[inline(always)]
    pub fn new(signed_mm: [T; 2]) -> Self {
        let least2 = T::splat(MIN_SLOPE_MM * MIN_SLOPE_MM);
        let size = |rise: T| rise.mul_add(rise, least2).sqrt();
        let [a, b] = signed_mm;
        Self {
            signed_mm,
            size_mm: [size(a), size(b)],
        }
    }

    /// Returns the overclosure of the share's most overclosed corner above that of its middle, mm.
    #[inline(always)]
    pub fn reach_mm(&self) -> T {
        (self.size_mm[0] + self.size_mm[1]) * T::splat(0.5)
    }
}

/// The mean of the positive part of the overclosure over a share, and its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeanOverclosure<T> {
    pub mm: T,
    /// Derivative by the overclosure of the share's middle: the part of the share in contact.
    pub by_middle: T,
    /// Derivatives by the edge slopes; none if all of the share is in contact in every lane.
    pub by_slope: Option<[T; 2]>,
}

/// Returns the mean of max(0, d) over a parallelogram on which d is linear: `middle_mm` at its centre, rising along each
/// edge.
///
/// With the edge slopes r and s it is (c1^3 - c2^3 - c3^3 + c4^3)/(6 r s) over the positive parts of the four corners
/// c = d +- r/2 +- s/2: twice continuously differentiable, so that force and tangent are smooth as nodes come into contact.
/// If all corners are in contact it is d.
#[inline(always)]
pub(crate) fn mean_overclosure<T: Number>(
    middle_mm: T,
    slopes: &EdgeSlopes<T>,
) -> MeanOverclosure<T> {
    let in_part = middle_mm - slopes.reach_mm();
    if in_part.least() >= 0.0 {
        return MeanOverclosure {
            mm: middle_mm,
            by_middle: T::one(),
            by_slope: None,
        };
    }
    let (zero, half) = (T::zero(), T::splat(0.5));
    let [r, s] = slopes.size_mm;
    let (sum, difference) = (slopes.reach_mm(), (r - s) * half);
    let corner = |rise: T| Number::max(middle_mm + rise, zero);
    let (c1, c2) = (corner(sum), corner(difference));
    let (c3, c4) = (corner(-difference), corner(-sum));
    let (q1, q2, q3, q4) = (c1 * c1, c2 * c2, c3 * c3, c4 * c4);
    let per_area = T::one() / (r * s);
    let (per_r, per_s) = (s * per_area, r * per_area);
    let mm = (c1 * q1 - c2 * q2 - c3 * q3 + c4 * q4) * per_area * T::splat(1.0 / 6.0);
    let by_middle = (q1 - q2 - q3 + q4) * per_area * half;
    let by_r = (q1 - q2 + q3 - q4) * per_area * T::splat(0.25) - mm * per_r;
    let by_s = (q1 + q2 - q3 - q4) * per_area * T::splat(0.25) - mm * per_s;
    let (sign_r, sign_s) = (slopes.signed_mm[0] * per_r, slopes.signed_mm[1] * per_s);
    // In lanes where all corners are in contact the closed form is right but loses digits.
    let in_part_or = |value: T, whole: T| in_part.below_zero(value, whole);
    MeanOverclosure {
        mm: in_part_or(mm, middle_mm),
        by_middle: in_part_or(by_middle, T::one()),
        by_slope: Some([by_r * sign_r, by_s * sign_s].map(|by| in_part_or(by, zero))),
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
        for slopes in [[0.2, 0.1], [0.05, -0.2], [0.1, 0.1]] {
            for middle in [-0.12, -0.05, 0.0, 0.03, 0.1, 0.2] {
                let mean = mean_overclosure(middle, &EdgeSlopes::new(slopes)).mm;
                assert!(
                    (mean - sampled(middle, slopes)).abs() < 2e-6,
                    "{middle} {slopes:?} {mean}"
                );
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_mean() {
        let mean =
            |middle: f64, slopes: [f64; 2]| mean_overclosure(middle, &EdgeSlopes::new(slopes));
        let step = 1e-6;
        for slopes in [[0.2, 0.1], [0.05, -0.2], [0.1, 0.1], [1e-4, 0.15]] {
            for middle in [-0.04, 0.0, 0.03, 0.07, 0.2] {
                let here = mean(middle, slopes);
                let by_middle = (mean(middle + step, slopes).mm - mean(middle - step, slopes).mm)
                    / (2.0 * step);
                assert!((here.by_middle - by_middle).abs() < 1e-7);
                for edge in 0..2 {
                    let moved = |sign: f64| {
                        let mut other = slopes;
                        other[edge] += sign * step;
                        mean(middle, other).mm
                    };
                    let by_slope = (moved(1.0) - moved(-1.0)) / (2.0 * step);
                    assert!(
                        (here.by_slope.unwrap_or_default()[edge] - by_slope).abs() < 1e-7,
                        "{middle} {slopes:?}"
                    );
                }
            }
        }
    }
}
