//! A straight line by least squares, and how sure its slope is.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// A line y = slope x + intercept through points, by least squares.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Rise of y for each unit of x.
    pub slope: f64,
    /// y at x = 0.
    pub intercept: f64,
    /// Standard error of the slope; none for two points.
    pub slope_standard_error: Option<f64>,
    /// Part of the variance of y that the line explains, 0 to 1.
    pub r_squared: f64,
    /// Points.
    pub points: usize,
}

/// An interval that holds a quantity with some confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether `value` lies inside, the ends included.
    pub fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// `middle` and as much on either side.
    pub(super) fn around(middle: f64, half: f64) -> Self {
        Self {
            low: middle - half,
            high: middle + half,
        }
    }
}

impl Line {
    /// The line of least squares in y; none for fewer than two points, or all at one x.
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let mean = |of: fn(&(f64, f64)) -> f64| mean(&points.iter().map(of).collect::<Vec<_>>());
        let (x, y) = (mean(|point| point.0), mean(|point| point.1));
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            points
                .iter()
                .map(|point| of(point.0 - x, point.1 - y))
                .sum()
        };
        let (xx, xy, yy) = (sum(&|u, _| u * u), sum(&|u, v| u * v), sum(&|_, v| v * v));
        if points.len() < 2 || xx <= 0.0 {
            return None;
        }
        let slope = xy / xx;
        let left = sum(&|u, v| (v - slope * u).powi(2));
        let freedom = points.len() - 2;
        let variance = (freedom > 0).then(|| left / freedom as f64);
        Some(Self {
            slope,
            intercept: y - slope * x,
            slope_standard_error: variance.map(|variance| (variance / xx).sqrt()),
            r_squared: if yy > 0.0 { 1.0 - left / yy } else { 1.0 },
            points: points.len(),
        })
    }

    /// y on the line.
    pub fn at(&self, x: f64) -> f64 {
        self.slope * x + self.intercept
    }

    /// Interval of the slope by Student's t with two degrees of freedom fewer than points.
    pub fn slope_interval(&self, confidence: f64) -> Option<Interval> {
        let half = student(confidence, self.points.checked_sub(2)?)? * self.slope_standard_error?;
        Some(Interval::around(self.slope, half))
    }
}

/// Interval of the mean of independent values by Student's t; none for fewer than two.
pub(super) fn mean_interval(values: &[f64], confidence: f64) -> Option<Interval> {
    let freedom = values.len().checked_sub(1)?;
    let quantile = student(confidence, freedom)?;
    let middle = mean(values);
    let squares: f64 = values.iter().map(|value| (value - middle).powi(2)).sum();
    let standard_error = (squares / freedom as f64 / values.len() as f64).sqrt();
    Some(Interval::around(middle, quantile * standard_error))
}

/// Mean of values; NaN for none.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// How many standard errors a two-sided interval reaches to either side.
pub(super) fn student(confidence: f64, freedom: usize) -> Option<f64> {
    let distribution = StudentsT::new(0.0, 1.0, freedom as f64).ok()?;
    Some(distribution.inverse_cdf(f64::midpoint(1.0, confidence)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Norris, a linear regression of NIST's reference datasets with certified results: (x, y).
    const NORRIS: [(f64, f64); 36] = [
        (0.2, 0.1),
        (337.4, 338.8),
        (118.2, 118.1),
        (884.6, 888.0),
        (10.1, 9.2),
        (226.5, 228.1),
        (666.3, 668.5),
        (996.3, 998.5),
        (448.6, 449.1),
        (777.0, 778.9),
        (558.2, 559.2),
        (0.4, 0.3),
        (0.6, 0.1),
        (775.5, 778.1),
        (666.9, 668.8),
        (338.0, 339.3),
        (447.5, 448.9),
        (11.6, 10.8),
        (556.0, 557.7),
        (228.1, 228.3),
        (995.8, 998.0),
        (887.6, 888.8),
        (120.2, 119.6),
        (0.3, 0.3),
        (0.3, 0.6),
        (556.8, 557.6),
        (339.1, 339.3),
        (887.2, 888.0),
        (999.0, 998.5),
        (779.0, 778.9),
        (11.1, 10.2),
        (118.3, 117.6),
        (229.2, 228.9),
        (669.1, 668.4),
        (448.9, 449.2),
        (0.5, 0.2),
    ];

    #[track_caller]
    fn close(found: f64, expected: f64, relative: f64) {
        assert!(
            ((found - expected) / expected).abs() < relative,
            "{found} {expected}"
        );
    }

    #[test]
    fn verify_line_and_its_error_are_those_that_nist_certifies() {
        let line = Line::through(&NORRIS).unwrap();
        close(line.slope, 1.002_116_818_020_45, 1e-12);
        close(line.intercept, -0.262_323_073_774_029, 1e-10);
        close(
            line.slope_standard_error.unwrap(),
            0.429_796_848_199_937e-3,
            1e-10,
        );
        close(line.r_squared, 0.999_993_745_883_712, 1e-12);
    }

    #[test]
    fn verify_interval_is_the_textbook_quantile_times_the_error() {
        let line = Line::through(&NORRIS).unwrap();
        let interval = line.slope_interval(0.95).unwrap();
        // t of 34 degrees of freedom at 97.5 %.
        let half = 2.032_244_509 * 0.429_796_848_199_937e-3;
        close(interval.high - line.slope, half, 1e-8);
        close(line.slope - interval.low, half, 1e-8);
        assert!(interval.holds(line.slope) && !interval.holds(1.0));
    }

    #[test]
    fn verify_mean_of_three_has_the_interval_of_two_degrees_of_freedom() {
        // t of 2 degrees of freedom at 97.5 % is 4.302653; the standard error of 1, 2, 3 is 1/sqrt 3.
        let interval = mean_interval(&[1.0, 2.0, 3.0], 0.95).unwrap();
        close(interval.high, 2.0 + 4.302_652_73 / 3f64.sqrt(), 1e-8);
        assert!(mean_interval(&[1.0], 0.95).is_none());
    }

    #[test]
    fn a_line_needs_two_places_and_its_interval_a_third_point() {
        assert!(Line::through(&[(1.0, 2.0)]).is_none());
        assert!(Line::through(&[(1.0, 2.0), (1.0, 3.0)]).is_none());
        let line = Line::through(&[(1.0, 2.0), (3.0, 3.0)]).unwrap();
        assert_eq!((line.slope, line.intercept, line.at(5.0)), (0.5, 1.5, 4.0));
        assert!(line.slope_interval(0.95).is_none());
    }
}
