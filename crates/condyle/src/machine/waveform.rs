//! A quantity over the gait cycle.

use std::f64::consts::{PI, TAU};

use thiserror::Error;

/// Largest distance between the samples of a spline, % of the cycle: a longer one is rather a gap than a
/// coarse recording.
const LONGEST_SAMPLE_GAP_PERCENT: f64 = 10.0;

/// A value at a place in the cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Place in the cycle, %, 0 to 100.
    pub percent: f64,
    /// Value, in the unit of the quantity.
    pub value: f64,
}

/// Returns the length of the piece that starts at knot `a`, across the seam for the last.
fn span_percent(knots: &[Knot], a: usize) -> f64 {
    if a + 1 < knots.len() {
        knots[a + 1].percent - knots[a].percent
    } else {
        knots[0].percent + 100.0 - knots[a].percent
    }
}

/// Interpolation between the knots of a waveform.
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
    /// Advance of a constant during a cycle: whole turns of a rotation.
    turn: f64,
    /// The lowest and the highest value; a spline that leaves this range is cut off.
    limits: [f64; 2],
}

const NO_LIMITS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Number of samples from which their slopes show whether the seam is a jump; our choice.
const MIN_SAMPLES: usize = 20;
/// Largest slope from the last sample to the first, relative to the steepest between others; our choice.
const MAX_SEAM_SLOPE: f64 = 3.0;
/// Smallest jump from the last sample to the first, relative to the range of all; smaller ones are noise. Our choice.
const MIN_JUMP: f64 = 0.03;
/// Longest gap between the last sample and the end of the cycle across which drift is known, relative to the gap before.
const MAX_END_GAP: f64 = 2.0;

/// Difference of values that is round-off, relative to the largest one.
const ROUNDING: f64 = 1e-12;

impl Waveform {
    /// Creates a constant waveform.
    pub fn constant(value: f64) -> Self {
        Self {
            knots: vec![Knot {
                percent: 0.0,
                value,
            }],
            interpolation: Interpolation::HalfCosine,
            bends: Vec::new(),
            turn: 0.0,
            limits: NO_LIMITS,
        }
    }

    /// Creates an even rotation from `start` that advances by `turn` in every cycle.
    ///
    /// At the end of a cycle the value steps back by `turn`: only for whole turns of a rotation is that the same pose.
    pub fn turning(start: f64, turn: f64) -> Self {
        Self {
            turn,
            ..Self::constant(start)
        }
    }

    /// Creates a waveform through `knots`, sorted by place; the last connects to the first.
    ///
    /// # Errors
    /// No knots; knots that are not finite, outside 0 to 100 %, not increasing, or that step at the seam;
    /// for a spline, knots that are too far apart to be samples.
    pub fn new(mut knots: Vec<Knot>, interpolation: Interpolation) -> Result<Self, WaveformError> {
        if knots.is_empty() {
            return Err(WaveformError::Empty);
        }
        for (index, knot) in knots.iter().enumerate() {
            let percent = knot.percent;
            if !(percent.is_finite() && knot.value.is_finite()) {
                return Err(WaveformError::NotFinite { index });
            }
            if !(0.0..=100.0).contains(&percent) {
                return Err(WaveformError::OutsideCycle { index, percent });
            }
            if index > 0 && percent <= knots[index - 1].percent {
                let before = knots[index - 1].percent;
                return Err(WaveformError::NotIncreasing {
                    index,
                    percent,
                    before,
                });
            }
        }
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        if last.percent - first.percent == 100.0 {
            let sizes = knots.iter().map(|knot| knot.value.abs());
            // A sum or a sine ends at its first value but for round-off.
            if (last.value - first.value).abs() > ROUNDING * sizes.fold(0.0, f64::max) {
                return Err(WaveformError::seam(first, last));
            }
            knots.pop();
        } else if interpolation == Interpolation::Spline {
            steady_at_seam(&knots)?;
        }
        let bends = match interpolation {
            Interpolation::HalfCosine => Vec::new(),
            Interpolation::Spline => {
                let limit = LONGEST_SAMPLE_GAP_PERCENT;
                let mut spans =
                    (0..knots.len()).map(|a| (knots[a].percent, span_percent(&knots, a)));
                let is_gap = |(_, span): &(f64, f64)| *span > limit && knots.len() > 1;
                if let Some((from, span)) = spans.find(is_gap) {
                    let to = from + span;
                    return Err(WaveformError::Gap { from, to, limit });
                }
                spline_bends(&knots)
            }
        };
        Ok(Self {
            knots,
            interpolation,
            bends,
            turn: 0.0,
            limits: NO_LIMITS,
        })
    }

    /// Returns the knots, without the one that closes the cycle.
    pub fn knots(&self) -> &[Knot] {
        &self.knots
    }

    /// Returns the interpolation between knots.
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// Multiplies the waveform by `factor`.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.knots.iter_mut().for_each(|knot| knot.value *= factor);
        self.bends.iter_mut().for_each(|bend| *bend *= factor);
        self.turn *= factor;
        let [low, high] = self.limits;
        // A negative factor reverses their order; one of 0 would make infinite limits NaN.
        if factor != 0.0 {
            self.limits = extremes([low * factor, high * factor]);
        }
        self
    }

    /// Cuts the waveform off at the lowest and the highest value.
    pub fn limited(mut self, limits: [f64; 2]) -> Self {
        self.limits = limits;
        self
    }

    /// Adds `offset` to the waveform.
    pub fn shifted(mut self, offset: f64) -> Self {
        self.knots.iter_mut().for_each(|knot| knot.value += offset);
        self.limits = self.limits.map(|limit| limit + offset);
        self
    }

    /// Returns the value and its derivative by the phase at `phase`, in cycles; integers may be added to the phase.
    pub fn at(&self, phase: f64) -> (f64, f64) {
        let percent = 100.0 * (phase - phase.floor());
        let n = self.knots.len();
        if n == 1 {
            let turned = self.turn * (phase - phase.floor());
            return (self.knots[0].value + turned, self.turn);
        }
        let after = self.knots.partition_point(|knot| knot.percent <= percent);
        let (a, b) = ((after + n - 1) % n, after % n);
        let span = span_percent(&self.knots, a);
        // In the piece across the seam the place may lie before its first knot.
        let along = (percent - self.knots[a].percent).rem_euclid(100.0) / span;
        let (ya, yb) = (self.knots[a].value, self.knots[b].value);
        let (value, slope) = match self.interpolation {
            Interpolation::HalfCosine => {
                let (sine, cosine) = (PI * along).sin_cos();
                let rise = yb - ya;
                (ya + rise * (1.0 - cosine) / 2.0, rise * PI * sine / 2.0)
            }
            Interpolation::Spline => {
                let [bend_a, bend_b] = [a, b].map(|i| self.bends[i] * span * span / 6.0);
                let (u, v) = (along, 1.0 - along);
                let value = v * ya + u * yb + (v * v * v - v) * bend_a + (u * u * u - u) * bend_b;
                let slope = yb - ya - (3.0 * v * v - 1.0) * bend_a + (3.0 * u * u - 1.0) * bend_b;
                (value, slope)
            }
        };
        let [low, high] = self.limits;
        if value < low || value > high {
            return (value.clamp(low, high), 0.0);
        }
        (value, slope * 100.0 / span)
    }

    /// Returns the lowest and the highest of the values at the knots and at a thousand instants; a spline can leave the range of its knots.
    pub fn range(&self) -> [f64; 2] {
        let between = (0..1000).map(|place| self.at(f64::from(place) / 1000.0).0);
        let [low, high] = self.limits;
        let at_knots = self.knots.iter().map(|knot| knot.value.clamp(low, high));
        extremes(at_knots.chain(between))
    }
}

/// Returns the lowest and the highest of some values; infinite and reversed if there are none.
pub fn extremes(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let nothing = [f64::INFINITY, f64::NEG_INFINITY];
    let wider = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
    values.into_iter().fold(nothing, wider)
}

/// Rejects samples that end before 100 % and jump from there to the first one: far, and steeper than anywhere else.
fn steady_at_seam(knots: &[Knot]) -> Result<(), WaveformError> {
    let slopes = knots.windows(2).map(|pair| {
        let [from, to] = [pair[0], pair[1]];
        ((to.value - from.value) / (to.percent - from.percent)).abs()
    });
    let steepest = slopes.fold(0.0, f64::max);
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let values = || knots.iter().map(|knot| knot.value);
    let range = values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min);
    let jump = (first.value - last.value).abs();
    let slope = jump / span_percent(knots, knots.len() - 1);
    let is_jump = jump > MIN_JUMP * range && slope > MAX_SEAM_SLOPE * steepest;
    if knots.len() >= MIN_SAMPLES && is_jump {
        return Err(WaveformError::seam(first, last));
    }
    Ok(())
}

/// Second derivatives at the knots of the periodic cubic spline.
///
/// The system is cyclic, diagonally dominant and small; each Gauss-Seidel sweep at least halves the error, so it is
/// solved to round-off in a few dozen sweeps.
fn spline_bends(knots: &[Knot]) -> Vec<f64> {
    // More than enough: 0.5^100 is far below rounding.
    const SWEEPS: usize = 100;
    let n = knots.len();
    let mut bends = vec![0.0; n];
    // One or two knots give a constant or straight lines, without bends.
    if n < 3 {
        return bends;
    }
    let slope = |a: usize| (knots[(a + 1) % n].value - knots[a].value) / span_percent(knots, a);
    for _ in 0..SWEEPS {
        for i in 0..n {
            let (before, after) = ((i + n - 1) % n, (i + 1) % n);
            let (left, right) = (span_percent(knots, before), span_percent(knots, i));
            let load = 6.0 * (slope(i) - slope(before));
            bends[i] =
                (load - left * bends[before] - right * bends[after]) / (2.0 * (left + right));
        }
    }
    bends
}

/// Spreads the difference of samples between the start and the end of the cycle evenly over it, so that they
/// repeat without a step; the mean is unchanged. None if the samples end earlier.
///
/// Measured cycles seldom end exactly where they began. One of samples that end a sample before 100 % is continued with the mean
/// slope of its two ends.
pub fn without_drift(samples: &[Knot]) -> Option<Vec<Knot>> {
    let (first, last) = (samples.first()?, samples.last()?);
    let gap = first.percent + 100.0 - last.percent;
    let slope = |from: &Knot, to: &Knot| (to.value - from.value) / (to.percent - from.percent);
    // A waveform of samples out of order reports them.
    if samples
        .windows(2)
        .any(|pair| pair[1].percent <= pair[0].percent)
    {
        return Some(samples.to_vec());
    }
    let end = match samples {
        _ if gap == 0.0 => last.value,
        [_, second, .., before, _] if gap <= MAX_END_GAP * (last.percent - before.percent) => {
            last.value + gap * f64::midpoint(slope(first, second), slope(before, last))
        }
        _ => return None,
    };
    let drift = end - first.value;
    let level = |knot: &Knot| Knot {
        percent: knot.percent,
        // About the middle of the cycle, so that the mean stays.
        value: knot.value - drift * ((knot.percent - first.percent) / 100.0 - 0.5),
    };
    let mut levelled: Vec<Knot> = samples.iter().map(level).collect();
    if gap == 0.0 {
        // By rounding both ends may differ, which a waveform rejects as a step at the seam.
        let seam = levelled[0].value;
        levelled.last_mut()?.value = seam;
    }
    Some(levelled)
}

/// Samples the mean and the first `harmonics` Fourier terms of a waveform, at every percent of the cycle or closer.
pub fn low_passed(waveform: &Waveform, harmonics: usize) -> Vec<Knot> {
    // Even samples project low harmonics exactly, unless the curve has harmonics near the number of samples: noise has up to half
    // as many harmonics as knots, and its spline hardly more.
    let samples = (4 * waveform.knots().len()).max(1000);
    let sample = |k: usize| waveform.at(k as f64 / samples as f64).0;
    let values: Vec<f64> = (0..samples).map(sample).collect();
    let project = |order: usize, wave: fn(f64) -> f64| {
        let weighted = |(k, y): (usize, &f64)| y * wave(TAU * (order * k) as f64 / samples as f64);
        values.iter().enumerate().map(weighted).sum::<f64>() / samples as f64
    };
    let terms: Vec<(f64, f64)> = (0..=harmonics)
        .map(|order| (project(order, f64::cos), project(order, f64::sin)))
        .collect();
    let value = |percent: f64| {
        let term = |(order, (c, s)): (usize, &(f64, f64))| {
            let (sine, cosine) = (TAU * order as f64 * percent / 100.0).sin_cos();
            // A harmonic stands for its positive and its negative frequency; the mean occurs once.
            (c * cosine + s * sine) * if order == 0 { 1.0 } else { 2.0 }
        };
        terms.iter().enumerate().map(term).sum()
    };
    // Through six points a wave or more, a spline follows every harmonic within 1 %.
    let count = (6 * harmonics).max(100);
    let knot = |place| {
        let percent = 100.0 * place as f64 / count as f64;
        Knot {
            percent,
            value: value(percent),
        }
    };
    (0..count).map(knot).collect()
}

/// The reason why knots do not define a waveform.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WaveformError {
    /// No knot at all.
    #[error("the waveform has no points; give at least one")]
    Empty,
    /// A value or a place that is NaN or infinite.
    #[error("point {index} of the waveform is not a finite number; correct or remove it")]
    NotFinite { index: usize },
    /// A place outside the cycle.
    #[error("point {index} of the waveform is at {percent} % of the cycle; use 0 to 100")]
    OutsideCycle { index: usize, percent: f64 },
    /// A place not after the one before.
    #[error(
        "point {index} of the waveform, at {percent} %, is not after the previous point at {before} %; sort the points and keep one per percentage"
    )]
    NotIncreasing {
        index: usize,
        percent: f64,
        before: f64,
    },
    /// Samples too far apart.
    #[error(
        "the waveform has a gap from {from} % to {to} % of the cycle; add points, at most {limit} % apart"
    )]
    Gap { from: f64, to: f64, limit: f64 },
    /// A jump from the last value to the first.
    #[error(
        "the waveform jumps at the end of the cycle: {first} at {from} % but {last} at {to} %; let the end lead to the start"
    )]
    Seam {
        first: f64,
        from: f64,
        last: f64,
        to: f64,
    },
}

impl WaveformError {
    fn seam(first: Knot, last: Knot) -> Self {
        Self::Seam {
            first: first.value,
            from: first.percent,
            last: last.value,
            to: last.percent,
        }
    }
}

#[cfg(test)]
mod tests {
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
    fn a_sine_that_ends_at_its_first_value_but_for_round_off_is_one() {
        let mut whole = sine(100);
        let value = TAU.sin();
        assert!(value != 0.0);
        whole.push(Knot {
            percent: 100.0,
            value,
        });
        assert!(Waveform::new(whole.clone(), Interpolation::Spline).is_ok());
        whole[100].value = 1e-9;
        let stepping = Waveform::new(whole, Interpolation::Spline);
        assert!(matches!(stepping, Err(WaveformError::Seam { .. })));
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
    fn every_error_states_the_remedy() {
        let spline = |points: &[(f64, f64)]| {
            Waveform::new(knots(points), Interpolation::Spline)
                .unwrap_err()
                .to_string()
        };
        assert!(spline(&[]).contains("at least one"));
        assert!(spline(&[(0.0, f64::NAN)]).contains("point 0"));
        assert!(spline(&[(0.0, 1.0), (120.0, 1.0)]).contains("120 %"));
        assert!(
            spline(&[(5.0, 1.0), (5.0, 2.0)]).contains("is not after the previous point at 5 %")
        );
        assert!(spline(&[(0.0, 1.0), (40.0, 1.0), (100.0, 1.0)]).contains("gap from 0 % to 40 %"));
        assert!(spline(&[(0.0, 1.0), (100.0, 2.0)]).contains("jumps at the end of the cycle"));
    }

    #[test]
    fn low_pass_keeps_a_low_harmonic_and_drops_a_high_one() {
        let noisy = |knot: Knot| Knot {
            value: knot.value + (TAU * 20.0 * knot.percent / 100.0).sin(),
            ..knot
        };
        let samples = sine(200).into_iter().map(noisy).collect();
        let wave = Waveform::new(samples, Interpolation::Spline).unwrap();
        for knot in low_passed(&wave, 8) {
            assert!((knot.value - (TAU * knot.percent / 100.0).sin()).abs() < 1e-3);
        }
    }

    #[test]
    fn verify_a_low_pass_of_many_samples_and_harmonics() {
        // Noise at harmonic 990 of 5000 samples, which 1000 samples would take for harmonic 10.
        let noisy = |knot: Knot| Knot {
            value: knot.value + 2.0 * (TAU * 990.0 * knot.percent / 100.0).sin(),
            ..knot
        };
        let samples = sine(5000).into_iter().map(noisy).collect();
        let wave = Waveform::new(samples, Interpolation::Spline).unwrap();
        for knot in low_passed(&wave, 15) {
            assert!((knot.value - (TAU * knot.percent / 100.0).sin()).abs() < 2e-3);
        }
        // A harmonic near the largest one that a case may keep.
        let high = |percent: f64| 3.0 * (TAU * 45.0 * percent / 100.0).sin();
        let sample = |place: u32| {
            let percent = f64::from(place) / 10.0;
            let value = high(percent);
            Knot { percent, value }
        };
        let wave = Waveform::new((0..1000).map(sample).collect(), Interpolation::Spline).unwrap();
        let wave = Waveform::new(low_passed(&wave, 50), Interpolation::Spline).unwrap();
        let missed = (0..997).map(|place| {
            let phase = f64::from(place) / 997.0;
            (wave.at(phase).0 - high(100.0 * phase)).abs()
        });
        assert!(missed.fold(0.0, f64::max) < 0.03);
    }

    #[test]
    fn drift_is_spread_over_the_cycle() {
        let level = without_drift(&knots(&[(0.0, 1.0), (50.0, 4.0), (100.0, 3.0)])).unwrap();
        assert_eq!(
            level.iter().map(|k| k.value).collect::<Vec<_>>(),
            [2.0, 4.0, 2.0]
        );
    }

    #[test]
    fn verify_samples_that_end_before_the_cycle_lose_the_same_drift() {
        let sample = |i: u32| Knot {
            percent: 0.1 * f64::from(i),
            value: (TAU * f64::from(i) / 1000.0).sin() + 0.001 * f64::from(i),
        };
        let all: Vec<Knot> = (0..=1000).map(sample).collect();
        let (whole, open) = (
            without_drift(&all).unwrap(),
            without_drift(&all[..1000]).unwrap(),
        );
        for (whole, open) in whole.iter().zip(&open) {
            // The end of the open cycle is extrapolated by a third-order formula over a step of 0.1 %.
            assert!(
                (whole.value - open.value).abs() < 1e-6,
                "{whole:?} {open:?}"
            );
        }
        assert_eq!(without_drift(&all[..900]), None);
        let jump = Waveform::new(all[..1000].to_vec(), Interpolation::Spline).unwrap_err();
        assert!(matches!(jump, WaveformError::Seam { .. }), "{jump}");
        assert!(Waveform::new(open, Interpolation::Spline).is_ok());
    }
}
