//! Curves of two runs: how far apart they are.

use serde::Serialize;

use crate::page::channel;
use crate::results::{contents::Results, table::Table};

/// How far two curves are apart, in the unit of their column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CurveDifference {
    /// Name of the column of `kinematics.csv`.
    pub column: &'static str,
    /// What people call it.
    pub title: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Which cycle: "first" or "last".
    pub cycle: &'static str,
    /// Root of the mean square of second less first, at the instants of the first.
    pub rms: f64,
    /// The difference that is largest in size, with its sign.
    pub largest: f64,
    /// Where it is, percent of the cycle.
    pub largest_at_percent: f64,
    /// The root of the mean square in percent of the first curve's range; none where that is flat.
    pub rms_percent_of_range: Option<f64>,
}

/// Points (percent, value) of a curve.
type Points = Vec<(f64, f64)>;

/// Every motion and load of the first and last cycle that both runs have and that differs, the largest by its range first.
pub(super) fn curves(first: &Results, second: &Results) -> Vec<CurveDifference> {
    let (Some(one), Some(two)) = (&first.kinematics, &second.kinematics) else {
        return Vec::new();
    };
    let mut curves: Vec<_> = ["first", "last"]
        .into_iter()
        .flat_map(|cycle| one.names().iter().map(move |name| (cycle, name)))
        .filter_map(|(cycle, name)| curve(one, two, cycle, name))
        .collect();
    let rank = |curve: &CurveDifference| curve.rms_percent_of_range.unwrap_or(0.0);
    curves.sort_by(|one, two| rank(two).total_cmp(&rank(one)));
    curves
}

fn curve(one: &Table, two: &Table, cycle: &'static str, name: &str) -> Option<CurveDifference> {
    let channel = channel(name)?;
    let [here, there] = [points(one, cycle, name)?, points(two, cycle, name)?];
    let apart: Points = here
        .iter()
        .filter_map(|&(percent, value)| Some((percent, at(&there, percent)? - value)))
        .collect();
    let largest = apart
        .iter()
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let rms = (apart.iter().map(|(_, off)| off * off).sum::<f64>() / apart.len() as f64).sqrt();
    let values = || here.iter().map(|point| point.1);
    let range = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
    (rms > 0.0).then(|| CurveDifference {
        column: channel.column,
        title: channel.title,
        unit: channel.unit,
        cycle,
        rms,
        largest: largest.1,
        largest_at_percent: largest.0,
        rms_percent_of_range: (range > 0.0).then(|| 100.0 * rms / range),
    })
}

/// The points of a cycle; of a table with one cycle that one, whichever is asked for.
fn points(table: &Table, cycle: &str, name: &str) -> Option<Points> {
    let (cycles, percents) = (table.column("cycles")?, table.column("percent")?);
    let chosen = match cycle {
        "first" => cycles.iter().copied().fold(f64::INFINITY, f64::min),
        _ => cycles.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    };
    let values = table.column(name)?;
    let rows = (0..table.rows()).filter(|&row| cycles[row] == chosen && values[row].is_finite());
    let points: Points = rows.map(|row| (percents[row], values[row])).collect();
    (!points.is_empty()).then_some(points)
}

/// The value of a curve at an instant, linear between its own; none before its first or after its last.
fn at(points: &Points, percent: f64) -> Option<f64> {
    let after = points.partition_point(|point| point.0 < percent);
    let &(x, y) = points.get(after)?;
    if x == percent {
        return Some(y);
    }
    let &(x0, y0) = points.get(after.checked_sub(1)?)?;
    Some(y0 + (percent - x0) / (x - x0) * (y - y0))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn results(rows: &str) -> Results {
        let text = format!("cycles,percent,ap_mm\n{rows}");
        Results {
            kinematics: Some(Table::parse(&text, Path::new("k.csv")).expect("is a table")),
            ..Results::default()
        }
    }

    #[test]
    fn curves_of_other_instants_are_held_against_each_other_between_them() {
        let coarse = results("0,50,1\n0,100,3\n");
        let fine = results("0,50,1\n0,75,2\n0,100,5\n");
        let told = curves(&coarse, &fine);
        // The one cycle is the first and the last.
        assert_eq!(told.len(), 2);
        assert_eq!((told[0].largest, told[0].largest_at_percent), (2.0, 100.0));
        assert!((told[0].rms - 2.0_f64.sqrt()).abs() < 1e-12);
        let back = curves(&fine, &coarse);
        assert_eq!(back[0].largest, -2.0);
        assert!(curves(&coarse, &coarse).is_empty());
    }
}
