//! Comparison of predicted with measured kinematics.

use condyle::machine::extremes;
use condyle_case::measured::{AlignWord, CycleWord, Kinematics, MeasuredCurve, Sample};
use condyle_report::Table;
use condyle_results::statistics::mean;
use serde::Serialize;

use crate::measured::{
    CompareError,
    gravimetric::{OTHER_UNIT, is_alike},
};

/// A predicted and a measured cycle. Errors are predicted minus measured, in the unit of their column.
#[derive(Clone, Debug, Serialize)]
pub struct KinematicsComparison {
    /// The cycle of the run: "first" or "last".
    pub cycle: &'static str,
    /// Cycles done before it.
    pub cycles_before: f64,
    /// The alignment before the errors: "mean" subtracts the mean difference, "none" nothing.
    pub align: &'static str,
    /// A row for each measured column.
    pub columns: Vec<ColumnComparison>,
}

/// One motion or load.
#[derive(Clone, Debug, Serialize)]
pub struct ColumnComparison {
    /// Name of the column, which ends in the unit of everything here but percents.
    pub column: String,
    /// Mean of predicted minus measured, before any alignment.
    pub mean_difference: f64,
    /// Over the whole cycle.
    pub errors: Errors,
    /// By phase of gait.
    pub phases: Vec<PhaseErrors>,
    /// Largest less smallest predicted value.
    pub predicted_range: f64,
    /// Largest less smallest measured value.
    pub measured_range: f64,
    /// Instants compared, of those of the run.
    pub compared: usize,
    /// Instants of the run's cycle.
    pub instants: usize,
    /// (percent, predicted, aligned measured) at the instants compared.
    #[serde(skip)]
    pub points: Vec<[f64; 3]>,
}

/// The size of errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Mean of the absolute errors.
    pub mean_absolute: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// The error with the largest absolute value.
    pub largest: f64,
    /// Its instant, percent of the cycle.
    pub largest_at_percent: f64,
}

/// Errors within one phase of gait.
#[derive(Clone, Debug, Serialize)]
pub struct PhaseErrors {
    /// Its name.
    pub phase: String,
    /// Its start, percent of the cycle.
    pub start_percent: f64,
    /// Its end, percent of the cycle.
    pub end_percent: f64,
    /// The errors; none if the phase has no measurements.
    pub errors: Option<Errors>,
}

/// Correlation of measured and predicted values below which the sign is likely to be reversed. Our choice.
const REVERSED: f64 = -0.8;
/// Smallest range of a motion or load that is not round-off.
const MIN_RANGE: f64 = 1e-6;

impl KinematicsComparison {
    /// Returns remarks on columns that seem to have another unit or sign.
    pub(crate) fn remarks(&self) -> impl Iterator<Item = String> {
        self.columns.iter().flat_map(ColumnComparison::remarks)
    }
}

impl ColumnComparison {
    fn remarks(&self) -> Vec<String> {
        let name = &self.column;
        let (measured, predicted) = (self.measured_range, self.predicted_range);
        let mut remarks = Vec::new();
        if measured.min(predicted) <= MIN_RANGE {
            return remarks;
        }
        if !is_alike(measured, predicted) {
            remarks.push(format!(
                "the range of the measured `{name}` is {measured:.3}, and that of the prediction {predicted:.3}: they differ by more than a \
                 factor of {OTHER_UNIT}; check that the measured values have the unit of the column's name"
            ));
        }
        let correlation = self.correlation();
        if correlation < REVERSED {
            remarks.push(format!(
                "the measured `{name}` goes down where the predicted goes up (correlation {correlation:.2}): check its sign, and the side of \
                 the joint"
            ));
        }
        remarks
    }

    fn correlation(&self) -> f64 {
        let middle = |i: usize| mean(&self.points.iter().map(|point| point[i]).collect::<Vec<_>>());
        let (predicted, measured) = (middle(1), middle(2));
        let sum = |of: fn(f64, f64) -> f64| -> f64 {
            let product = |point: &[f64; 3]| of(point[1] - predicted, point[2] - measured);
            self.points.iter().map(product).sum()
        };
        sum(|p, m| p * m) / (sum(|p, _| p * p) * sum(|_, m| m * m)).sqrt()
    }
}

/// Compares every measured column with the run's table, at the run's own instants.
pub(crate) fn compare(
    measured: &Kinematics,
    run: &Table,
) -> Result<KinematicsComparison, CompareError> {
    let cycles = column_of(run, "cycles")?;
    let cycles_before = match measured.keys.cycle {
        CycleWord::First => cycles.iter().copied().fold(f64::INFINITY, f64::min),
        CycleWord::Last => cycles.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    };
    let rows: Vec<usize> = (0..cycles.len())
        .filter(|&row| cycles[row] == cycles_before)
        .collect();
    if rows.is_empty() {
        return Err(CompareError::no_column("cycles"));
    }
    let columns = measured
        .curves
        .iter()
        .map(|curve| column(measured, curve, run, &rows))
        .collect::<Result<_, _>>()?;
    Ok(KinematicsComparison {
        cycle: measured.keys.cycle.word(),
        cycles_before,
        align: measured.keys.align.word(),
        columns,
    })
}

fn column_of<'a>(run: &'a Table, column: &str) -> Result<&'a [f64], CompareError> {
    run.column(column)
        .ok_or_else(|| CompareError::no_column(column))
}

/// Returns the error for a measured column that the run does not have.
fn unknown(column: &str, run: &Table) -> CompareError {
    let is_motion = |name: &&String| !["cycles", "percent"].contains(&name.as_str());
    let names: Vec<&str> = run
        .names()
        .iter()
        .filter(is_motion)
        .map(String::as_str)
        .collect();
    CompareError::NotComparable(format!(
        "the run has no column `{column}` to compare with; remove it, or name it one of {}",
        names.join(", ")
    ))
}

fn column(
    measured: &Kinematics,
    curve: &MeasuredCurve,
    run: &Table,
    rows: &[usize],
) -> Result<ColumnComparison, CompareError> {
    let (percents, values) = (column_of(run, "percent")?, run.column(&curve.column));
    let values = values.ok_or_else(|| unknown(&curve.column, run))?;
    let gap = measured.keys.largest_gap_percent;
    let point = |&row: &usize| {
        let measured = value_at(&curve.samples, percents[row], gap)?;
        Some([percents[row], values[row], measured])
    };
    let mut points: Vec<[f64; 3]> = rows.iter().filter_map(point).collect();
    if points.is_empty() {
        let column = &curve.column;
        return Err(CompareError::NotComparable(format!(
            "the measured points of `{column}` are all more than {gap} % of the cycle apart, so nothing is compared; raise \
             largest_gap_percent in [kinematics], or leave the column out"
        )));
    }
    let mean_difference = mean(&points.iter().map(|[_, p, m]| p - m).collect::<Vec<_>>());
    if measured.keys.align == AlignWord::Mean {
        points
            .iter_mut()
            .for_each(|point| point[2] += mean_difference);
    }
    let phases = measured.phases.iter().map(|phase| {
        // The end of the cycle is the start of the next.
        let inside = points.iter().filter(|point| phase.holds(point[0] % 100.0));
        PhaseErrors {
            phase: phase.name.clone(),
            start_percent: phase.start_percent,
            end_percent: phase.end_percent,
            errors: errors(&inside.copied().collect::<Vec<_>>()),
        }
    });
    Ok(ColumnComparison {
        column: curve.column.clone(),
        mean_difference,
        errors: errors(&points).ok_or_else(|| CompareError::no_column("percent"))?,
        phases: phases.collect(),
        predicted_range: range(rows.iter().map(|&row| values[row])),
        measured_range: range(curve.samples.iter().map(|sample| sample.value)),
        compared: points.len(),
        instants: rows.len(),
        points,
    })
}

fn range(values: impl Iterator<Item = f64>) -> f64 {
    let [low, high] = extremes(values);
    high - low
}

fn errors(points: &[[f64; 3]]) -> Option<Errors> {
    let error = |[_, predicted, measured]: &[f64; 3]| predicted - measured;
    // Over equal instants of the run, so that a dense measurement of one phase does not outweigh the others.
    let largest = points
        .iter()
        .max_by(|a, b| error(a).abs().total_cmp(&error(b).abs()))?;
    let count = points.len() as f64;
    Some(Errors {
        mean_absolute: points.iter().map(|point| error(point).abs()).sum::<f64>() / count,
        rms: (points.iter().map(|point| error(point).powi(2)).sum::<f64>() / count).sqrt(),
        largest: error(largest),
        largest_at_percent: largest[0],
    })
}

/// A cycle, percent.
const CYCLE: f64 = 100.0;
/// Closer instants are the same, percent.
const SAME: f64 = 1e-9;

/// Returns the value at an instant, linear between the neighbouring points, across the end of the cycle if the ends
/// have no points; none if the neighbours are more than `largest_gap` apart.
pub(crate) fn value_at(samples: &[Sample], percent: f64, largest_gap: f64) -> Option<f64> {
    if let Some(sample) = samples.iter().find(|s| (s.percent - percent).abs() < SAME) {
        return Some(sample.value);
    }
    // Neighbours beyond an end of the cycle are those of the cycle before or after.
    let moved = |sample: &Sample, by: f64| Sample {
        percent: sample.percent + by,
        value: sample.value,
    };
    let place = samples.partition_point(|sample| sample.percent < percent);
    let before = match place {
        0 => moved(samples.last()?, -CYCLE),
        place => samples[place - 1],
    };
    let after = match samples.get(place) {
        Some(sample) => *sample,
        None => moved(samples.first()?, CYCLE),
    };
    let gap = after.percent - before.percent;
    // A single sample is its own neighbour, a cycle away.
    if gap <= 0.0 {
        return None;
    }
    let share = (percent - before.percent) / gap;
    (gap <= largest_gap + SAME).then_some(before.value + share * (after.value - before.value))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(points: &[(f64, f64)]) -> Vec<Sample> {
        let sample = |&(percent, value): &(f64, f64)| Sample { percent, value };
        points.iter().map(sample).collect()
    }

    #[test]
    fn verify_between_points_the_value_is_on_the_straight_line() {
        let curve = samples(&[(0.0, 1.0), (4.0, 5.0), (100.0, 1.0)]);
        assert_eq!(value_at(&curve, 1.0, 10.0), Some(2.0));
        assert_eq!(value_at(&curve, 4.0, 10.0), Some(5.0));
    }

    #[test]
    fn verify_the_seam_is_crossed_in_both_directions() {
        let curve = samples(&[(2.0, 3.0), (50.0, 0.0), (98.0, 1.0)]);
        assert_eq!(value_at(&curve, 99.0, 10.0), Some(1.5));
        assert_eq!(value_at(&curve, 100.0, 10.0), Some(2.0));
        assert_eq!(value_at(&curve, 1.0, 10.0), Some(2.5));
    }

    #[test]
    fn nothing_is_made_up_in_a_wide_gap() {
        let curve = samples(&[(0.0, 1.0), (60.0, 1.0)]);
        assert_eq!(value_at(&curve, 30.0, 10.0), None);
        assert_eq!(value_at(&curve, 80.0, 10.0), None);
        assert_eq!(value_at(&curve, 60.0, 10.0), Some(1.0));
        assert_eq!(value_at(&curve, 30.0, 60.0), Some(1.0));
    }
}
