//! A quantity over the gait cycle.

use std::f64::consts::PI;

use super::{
    Knot, WaveformError,
    knot::{check_no_gap, checked, span_percent},
    spline::{cubic, spline_bends},
};

/// How a waveform goes from knot to knot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// $y = y_a + \tfrac{1}{2} (y_b - y_a) \left(1 - \cos \frac{\pi (t - t_a)}{t_b - t_a}\right)$: flat at every knot.
    HalfCosine,
    /// The periodic cubic spline: two continuous derivatives, for measured samples.
    Spline,
}

/// A periodic quantity over the gait cycle, without a step at the seam.
///
/// An axial force of two peaks, in newtons:
///
/// ```
/// use condyle::machine::{Interpolation, Knot, Waveform};
///
/// let knot = |(percent, value)| Knot { percent, value };
/// let points = [(0.0, 170.0), (13.0, 2600.0), (25.0, 850.0), (45.0, 2450.0), (65.0, 170.0)];
/// let force = Waveform::new(points.map(knot).to_vec(), Interpolation::HalfCosine)?;
/// let (value_n, slope_n_per_cycle) = force.at(0.13);
/// assert!((value_n - 2600.0).abs() < 1e-9 && slope_n_per_cycle.abs() < 1e-9);
/// assert_eq!(force.at(0.9), force.at(1.9));
/// # Ok::<(), condyle::machine::WaveformError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Waveform {
    knots: Vec<Knot>,
    interpolation: Interpolation,
    /// Second derivatives at the knots, per %^2, for a spline.
    bends: Vec<f64>,
}

impl Waveform {
    /// The same value all through the cycle.
    pub fn constant(value: f64) -> Self {
        Self {
            knots: vec![Knot {
                percent: 0.0,
                value,
            }],
            interpolation: Interpolation::HalfCosine,
            bends: Vec::new(),
        }
    }

    /// A waveform through `knots`, sorted by place; the last goes round to the first.
    ///
    /// # Errors
    /// Knots that are none, not finite, outside 0 to 100 %, not increasing, that step at the seam,
    /// or, for a spline, that lie further apart than samples do.
    pub fn new(knots: Vec<Knot>, interpolation: Interpolation) -> Result<Self, WaveformError> {
        let mut knots = checked(knots)?;
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        if last.percent - first.percent == 100.0 {
            if last.value != first.value {
                let (first, last) = (first.value, last.value);
                return Err(WaveformError::Seam { first, last });
            }
            knots.pop();
        }
        let bends = match interpolation {
            Interpolation::HalfCosine => Vec::new(),
            Interpolation::Spline => {
                check_no_gap(&knots)?;
                spline_bends(&knots)
            }
        };
        Ok(Self {
            knots,
            interpolation,
            bends,
        })
    }

    /// The knots, without the one that closes the cycle.
    pub fn knots(&self) -> &[Knot] {
        &self.knots
    }

    /// How it goes from knot to knot.
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// The waveform `factor` times as large.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.knots.iter_mut().for_each(|knot| knot.value *= factor);
        self.bends.iter_mut().for_each(|bend| *bend *= factor);
        self
    }

    /// The waveform raised by `offset`.
    pub fn shifted(mut self, offset: f64) -> Self {
        self.knots.iter_mut().for_each(|knot| knot.value += offset);
        self
    }

    /// Value and its derivative by the phase, at `phase` in cycles (0.25 is 25 %; any integer
    /// may be added).
    pub fn at(&self, phase: f64) -> (f64, f64) {
        let percent = 100.0 * (phase - phase.floor());
        let n = self.knots.len();
        if n == 1 {
            return (self.knots[0].value, 0.0);
        }
        let after = self.knots.partition_point(|knot| knot.percent <= percent);
        let (a, b) = ((after + n - 1) % n, after % n);
        let span = span_percent(&self.knots, a);
        let along = (percent - self.knots[a].percent).rem_euclid(100.0) / span;
        let (ya, yb) = (self.knots[a].value, self.knots[b].value);
        let (value, slope) = match self.interpolation {
            Interpolation::HalfCosine => half_cosine(ya, yb, along),
            Interpolation::Spline => {
                let bend = |i: usize| self.bends[i] * span * span / 6.0;
                cubic(ya, yb, bend(a), bend(b), along)
            }
        };
        (value, slope * 100.0 / span)
    }
}

fn half_cosine(ya: f64, yb: f64, along: f64) -> (f64, f64) {
    let (sine, cosine) = (PI * along).sin_cos();
    let rise = yb - ya;
    (ya + rise * (1.0 - cosine) / 2.0, rise * PI * sine / 2.0)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn knots(points: &[(f64, f64)]) -> Vec<Knot> {
        let knot = |&(percent, value)| Knot { percent, value };
        points.iter().map(knot).collect()
    }

    fn sine(count: u32) -> Vec<Knot> {
        let knot = |i: u32| {
            let percent = 100.0 * f64::from(i) / f64::from(count);
            Knot {
                percent,
                value: (TAU * percent / 100.0).sin(),
            }
        };
        (0..count).map(knot).collect()
    }

    #[test]
    fn verify_half_cosine_against_iso_axial_force() {
        let axial = Waveform::new(
            knots(&[(0.0, 167.6), (3.0, 1887.3), (7.0, 1174.6), (100.0, 167.6)]),
            Interpolation::HalfCosine,
        )
        .unwrap();
        assert_eq!(axial.at(0.03).0, 1887.3);
        let third = 167.6 + (1887.3 - 167.6) * (1.0 - (PI / 3.0).cos()) / 2.0;
        assert!((axial.at(0.01).0 - third).abs() < 1e-9);
        assert!((axial.at(1.01).0 - third).abs() < 1e-9);
    }

    #[test]
    fn slope_is_the_derivative_of_the_value() {
        let waves = [
            Waveform::new(
                knots(&[(5.0, 1.0), (40.0, -2.0), (70.0, 3.0)]),
                Interpolation::HalfCosine,
            ),
            Waveform::new(sine(20), Interpolation::Spline),
        ];
        for wave in waves.map(Result::unwrap) {
            for i in 0..97 {
                let (phase, step) = (f64::from(i) / 97.0 + 0.003, 1e-6);
                let difference = (wave.at(phase + step).0 - wave.at(phase - step).0) / (2.0 * step);
                assert!((wave.at(phase).1 - difference).abs() < 1e-5 * (1.0 + difference.abs()));
            }
        }
    }

    #[test]
    fn verify_spline_of_a_sine_to_fourth_order() {
        let worst = |count: u32| {
            let wave = Waveform::new(sine(count), Interpolation::Spline).unwrap();
            let error = |i: i32| {
                let phase = f64::from(i) / 1000.0;
                (wave.at(phase).0 - (TAU * phase).sin()).abs()
            };
            (0..1000).map(error).fold(0.0, f64::max)
        };
        let order = (worst(20) / worst(40)).log2();
        assert!((order - 4.0).abs() < 0.1, "{order}");
    }

    #[test]
    fn every_error_says_what_to_do() {
        let spline = |points: &[(f64, f64)]| {
            Waveform::new(knots(points), Interpolation::Spline)
                .unwrap_err()
                .to_string()
        };
        assert!(spline(&[]).contains("at least one"));
        assert!(spline(&[(0.0, f64::NAN)]).contains("point 0"));
        assert!(spline(&[(0.0, 1.0), (120.0, 1.0)]).contains("120 %"));
        assert!(spline(&[(5.0, 1.0), (5.0, 2.0)]).contains("does not come after 5 %"));
        assert!(spline(&[(0.0, 1.0), (40.0, 1.0), (100.0, 1.0)]).contains("gap from 0 % to 40 %"));
        assert!(spline(&[(0.0, 1.0), (100.0, 2.0)]).contains("steps at the seam"));
    }
}
