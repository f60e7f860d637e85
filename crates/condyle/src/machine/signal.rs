//! Measured samples made fit for a waveform.

use std::f64::consts::TAU;

use super::{Knot, Waveform};

/// Samples whose difference between 0 and 100 % is spread evenly over the cycle, so that they
/// repeat without a step; the mean stays.
///
/// Measured cycles seldom end quite where they began.
pub fn without_drift(samples: &[Knot]) -> Vec<Knot> {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
        return Vec::new();
    };
    if last.percent - first.percent < 100.0 {
        return samples.to_vec();
    }
    let drift = last.value - first.value;
    let level = |knot: &Knot| Knot {
        percent: knot.percent,
        value: knot.value - drift * (knot.percent / 100.0 - 0.5),
    };
    let mut levelled: Vec<Knot> = samples.iter().map(level).collect();
    let seam = levelled[0].value;
    if let Some(end) = levelled.last_mut() {
        end.value = seam;
    }
    levelled
}

/// The mean and the first `harmonics` Fourier terms of a periodic waveform, sampled every percent.
pub fn low_passed(waveform: &Waveform, harmonics: usize) -> Vec<Knot> {
    const SAMPLES: usize = 1000;
    let sample = |k: usize| waveform.at(k as f64 / SAMPLES as f64).0;
    let values: Vec<f64> = (0..SAMPLES).map(sample).collect();
    let project = |order: usize, wave: fn(f64) -> f64| {
        let weighted = |(k, y): (usize, &f64)| y * wave(TAU * (order * k) as f64 / SAMPLES as f64);
        values.iter().enumerate().map(weighted).sum::<f64>() / SAMPLES as f64
    };
    let terms: Vec<(f64, f64)> = (0..=harmonics)
        .map(|order| (project(order, f64::cos), project(order, f64::sin)))
        .collect();
    let value = |percent: f64| {
        let term = |(order, (c, s)): (usize, &(f64, f64))| {
            let (sine, cosine) = (TAU * order as f64 * percent / 100.0).sin_cos();
            (c * cosine + s * sine) * if order == 0 { 1.0 } else { 2.0 }
        };
        terms.iter().enumerate().map(term).sum()
    };
    (0..100)
        .map(f64::from)
        .map(|percent| Knot {
            percent,
            value: value(percent),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Interpolation;

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
    fn drift_is_spread_over_the_cycle() {
        let level = without_drift(&knots(&[(0.0, 1.0), (50.0, 4.0), (100.0, 3.0)]));
        assert_eq!(
            level.iter().map(|k| k.value).collect::<Vec<_>>(),
            [2.0, 4.0, 2.0]
        );
    }
}
