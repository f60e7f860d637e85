//! Predicted against measured kinematics.

use condyle_io::measured::{AlignWord, CycleWord, Kinematics, MeasuredCurve, Phase};
use condyle_report::Table;
use serde::Serialize;

use super::CompareError;
use super::curve::value_at;
use super::line::mean;

/// How far a predicted cycle is from a measured one. Errors are predicted minus measured, in the
/// unit of their column.
#[derive(Clone, Debug, Serialize)]
pub struct KinematicsComparison {
    /// Which cycle of the run: "first" or "last".
    pub cycle: &'static str,
    /// Cycles done before it.
    pub cycles_before: f64,
    /// Whether the mean difference was taken out before the errors: "mean" or "none".
    pub align: &'static str,
    /// A row for each measured column.
    pub columns: Vec<ColumnComparison>,
}

/// One motion or load.
#[derive(Clone, Debug, Serialize)]
pub struct ColumnComparison {
    /// Name of the column, which ends in the unit of everything here but percents.
    pub column: &'static str,
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
    /// (percent, predicted, measured less what alignment takes out) at the instants compared.
    #[serde(skip)]
    pub points: Vec<[f64; 3]>,
}

/// How large errors are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Mean of the absolute errors.
    pub mean_absolute: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// The error that is largest in absolute value, with its sign.
    pub largest: f64,
    /// Where it is, percent of the cycle.
    pub largest_at_percent: f64,
}

/// Errors within one phase of gait.
#[derive(Clone, Debug, Serialize)]
pub struct PhaseErrors {
    /// Its name.
    pub phase: String,
    /// Where it starts, percent of the cycle.
    pub start_percent: f64,
    /// Where it ends.
    pub end_percent: f64,
    /// None where nothing was measured in it.
    pub errors: Option<Errors>,
}

/// Compares every measured column with the run's table, at the run's own instants.
pub(super) fn compare(
    measured: &Kinematics,
    run: &Table,
) -> Result<KinematicsComparison, CompareError> {
    let (cycles_before, rows) = rows_of(run, measured.keys.cycle)?;
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

/// Cycles done before the chosen cycle, and its rows.
fn rows_of(run: &Table, cycle: CycleWord) -> Result<(f64, Vec<usize>), CompareError> {
    let cycles = column_of(run, "cycles")?;
    let counts = cycles.iter().copied();
    let chosen = match cycle {
        CycleWord::First => counts.fold(f64::INFINITY, f64::min),
        CycleWord::Last => counts.fold(f64::NEG_INFINITY, f64::max),
    };
    let rows: Vec<usize> = (0..cycles.len())
        .filter(|&row| cycles[row] == chosen)
        .collect();
    if rows.is_empty() {
        return Err(CompareError::NoColumn { column: "cycles" });
    }
    Ok((chosen, rows))
}

fn column_of<'a>(run: &'a Table, column: &'static str) -> Result<&'a [f64], CompareError> {
    run.column(column).ok_or(CompareError::NoColumn { column })
}

fn column(
    measured: &Kinematics,
    curve: &MeasuredCurve,
    run: &Table,
    rows: &[usize],
) -> Result<ColumnComparison, CompareError> {
    let (percents, values) = (column_of(run, "percent")?, column_of(run, curve.column)?);
    let mut points: Vec<[f64; 3]> = rows
        .iter()
        .filter_map(|&row| {
            let percent = percents[row];
            let gap = measured.keys.largest_gap_percent;
            Some([
                percent,
                values[row],
                value_at(&curve.samples, percent, gap)?,
            ])
        })
        .collect();
    if points.is_empty() {
        return Err(CompareError::NothingMeasured {
            column: curve.column,
            gap: measured.keys.largest_gap_percent,
        });
    }
    let mean_difference = mean(&points.iter().map(|[_, p, m]| p - m).collect::<Vec<_>>());
    if measured.keys.align == AlignWord::Mean {
        points
            .iter_mut()
            .for_each(|point| point[2] += mean_difference);
    }
    let phases = measured.phases.iter().map(|phase| in_phase(phase, &points));
    Ok(ColumnComparison {
        column: curve.column,
        mean_difference,
        errors: errors(&points).ok_or(CompareError::NoColumn { column: "percent" })?,
        phases: phases.collect(),
        predicted_range: range(rows.iter().map(|&row| values[row])),
        measured_range: range(curve.samples.iter().map(|sample| sample.value)),
        compared: points.len(),
        instants: rows.len(),
        points,
    })
}

fn range(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
}

fn in_phase(phase: &Phase, points: &[[f64; 3]]) -> PhaseErrors {
    // The end of the cycle is the start of the next.
    let inside = |point: &&[f64; 3]| phase.holds(point[0] % 100.0);
    let inside: Vec<[f64; 3]> = points.iter().filter(inside).copied().collect();
    PhaseErrors {
        phase: phase.name.clone(),
        start_percent: phase.start_percent,
        end_percent: phase.end_percent,
        errors: errors(&inside),
    }
}

fn errors(points: &[[f64; 3]]) -> Option<Errors> {
    let error = |[_, predicted, measured]: &[f64; 3]| predicted - measured;
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
