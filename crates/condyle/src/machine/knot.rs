//! Values at places in the gait cycle.

use super::WaveformError;

/// Samples of a spline may be this far apart, % of the cycle: beyond it a gap is likelier than a
/// coarse recording.
const LONGEST_SAMPLE_GAP_PERCENT: f64 = 10.0;

/// A value at a place in the cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Place in the cycle, 0 to 100 %.
    pub percent: f64,
    /// Value there, in the unit of the quantity.
    pub value: f64,
}

/// Length of the piece that starts at knot `a`, round the seam for the last.
pub(super) fn span_percent(knots: &[Knot], a: usize) -> f64 {
    if a + 1 < knots.len() {
        knots[a + 1].percent - knots[a].percent
    } else {
        knots[0].percent + 100.0 - knots[a].percent
    }
}

/// The knots, if they are finite and each comes after the one before, within the cycle.
pub(super) fn checked(knots: Vec<Knot>) -> Result<Vec<Knot>, WaveformError> {
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
    Ok(knots)
}

/// Refuses knots too far apart to be samples.
pub(super) fn check_no_gap(knots: &[Knot]) -> Result<(), WaveformError> {
    let limit = LONGEST_SAMPLE_GAP_PERCENT;
    for (a, knot) in knots.iter().enumerate() {
        let span = span_percent(knots, a);
        if span > limit && knots.len() > 1 {
            let from = knot.percent;
            return Err(WaveformError::Gap {
                from,
                to: from + span,
                limit,
            });
        }
    }
    Ok(())
}
