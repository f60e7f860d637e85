//! An axis with round ticks.

use crate::number::fixed;

/// Labels with more decimals are written as powers of ten.
const MAX_DECIMALS: usize = 5;

/// A range with ticks at multiples of a round step; both ends are ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Axis {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) step: f64,
}

impl Axis {
    pub(crate) const PERCENT: Self = Self {
        low: 0.0,
        high: 100.0,
        step: 20.0,
    };

    /// Creates the tightest axis over `low..high` with at most `intervals` steps of 1, 2 or 5 times a power of ten.
    ///
    /// The axis spans at least `min_span`, so that noise does not fill the picture.
    pub(crate) fn covering(low: f64, high: f64, min_span: f64, intervals: usize) -> Self {
        // Ends that are multiples of the step but for rounding must not gain an interval.
        const SLACK: f64 = 1e-9;
        let missing = (min_span - (high - low)).max(0.0);
        let (low, high) = (low - missing / 2.0, high + missing / 2.0);
        let mut step = round_step((high - low) / intervals as f64);
        loop {
            let axis = Self {
                low: (low / step + SLACK).floor() * step,
                high: (high / step - SLACK).ceil() * step,
                step,
            };
            if axis.intervals() <= intervals {
                return axis;
            }
            // Rounding the ends outwards took one interval too many: the next coarser step.
            step = round_step(step * 1.01);
        }
    }

    /// [`Self::covering`] of all finite values; from 0 to 1 where there is none.
    pub(crate) fn over(values: impl Iterator<Item = f64>, min_span: f64, intervals: usize) -> Self {
        let (low, high) = finite_range(values).unwrap_or((0.0, 1.0));
        Self::covering(low, high, min_span, intervals)
    }

    /// Creates a range without round ticks: `share` of its width wider than the values at both ends.
    pub(crate) fn around(values: impl Iterator<Item = f64>, share: f64) -> Self {
        let (low, high) = finite_range(values).unwrap_or((0.0, 1.0));
        let room = share * (high - low).max(1e-6);
        Self {
            low: low - room,
            high: high + room,
            step: high - low + 2.0 * room,
        }
    }

    pub(crate) fn ticks(&self) -> impl Iterator<Item = f64> + '_ {
        (0..=self.intervals()).map(|tick| self.low + tick as f64 * self.step)
    }

    /// Returns the text of a tick, with the decimals of the step, or as a power of ten where these are too many.
    pub(crate) fn label(&self, tick: f64) -> String {
        let decimals = decimals(self.step);
        if decimals <= MAX_DECIMALS {
            return fixed(tick, decimals);
        }
        // Round-off keeps the tick at zero from being exactly zero.
        if tick.abs() < self.step / 2.0 {
            return fixed(0.0, 0);
        }
        let power = tick.abs().log10().floor();
        let digits = decimals.saturating_sub(-power as usize);
        format!("{}e{power}", fixed(tick / 10f64.powf(power), digits))
    }

    /// Returns the position of `value` on the axis: 0 at the low end, 1 at the high end.
    pub(crate) fn fraction(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    pub(crate) fn intervals(&self) -> usize {
        ((self.high - self.low) / self.step).round() as usize
    }
}

pub(crate) fn finite_range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.filter(|value| value.is_finite());
    let ends = finite.map(|value| (value, value));
    ends.reduce(|(low, high), (value, _)| (low.min(value), high.max(value)))
}

/// Returns the smallest of 1, 2, 5 times a power of ten that is at least `least`.
pub(crate) fn round_step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        // Round-off must not skip a step that fits exactly.
        .find(|step| *step >= least * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

fn decimals(step: f64) -> usize {
    // The logarithm of a power of ten may be a little below a whole number.
    (-(step.log10() + 1e-9).floor()).max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_cover_the_data() {
        let axis = Axis::covering(-4.3, 0.4, 0.0, 6);
        assert_eq!((axis.low, axis.high, axis.step), (-5.0, 1.0, 1.0));
        assert_eq!(axis.label(-5.0), "\u{2212}5");
        assert_eq!(axis.ticks().count(), 7);
    }

    #[test]
    fn a_flat_line_gets_the_smallest_span() {
        let axis = Axis::covering(0.0, 0.0, 0.2, 5);
        assert!(axis.low < 0.0 && axis.high > 0.0 && axis.high - axis.low < 0.3);
    }

    #[test]
    fn labels_have_the_decimals_of_the_step() {
        assert_eq!(
            Axis {
                low: 0.0,
                high: 0.3,
                step: 0.05
            }
            .label(0.1),
            "0.10"
        );
        assert_eq!(
            Axis {
                low: 0.0,
                high: 3e4,
                step: 1e4
            }
            .label(2e4),
            "20\u{202f}000"
        );
        let factors = Axis {
            low: 2e-7,
            high: 3e-7,
            step: 5e-8,
        };
        let labels: Vec<String> = factors.ticks().map(|tick| factors.label(tick)).collect();
        assert_eq!(labels, ["2.0e-7", "2.5e-7", "3.0e-7"]);
    }
}
