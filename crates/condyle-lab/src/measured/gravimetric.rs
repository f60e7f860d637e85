//! Comparison of predicted wear with weighed specimens.

use condyle_case::measured::{Gravimetric, IntervalWord, Specimen};
use condyle_report::Table;
use condyle_results::statistics::mean;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::measured::CompareError;

/// Wear rates are per this many cycles.
const MILLION: f64 = 1e6;

/// Weighed wear, corrected by soak controls, and predicted wear. Rates are in mg per million cycles.
#[derive(Clone, Debug, Serialize)]
pub struct GravimetricComparison {
    /// Confidence of every interval, percent.
    pub confidence_percent: f64,
    /// Weighings before this many cycles are excluded from the lines.
    pub fit_from_cycles: f64,
    /// Number of soak controls; without any, nothing is corrected.
    pub soak_controls: usize,
    /// All weighings, the first included.
    pub weighings: Vec<Weighing>,
    /// A line for each specimen.
    pub specimens: Vec<Rate>,
    /// One line through the weighings of all specimens.
    pub all: Rate,
    /// Mean of the specimens' rates, with each specimen as one observation.
    pub mean_of_specimens: Rate,
    /// From the specimen that wears least to the one that wears most.
    pub range_of_specimens_mg_per_million_cycles: Interval,
    /// The same regression through the predicted loss at the same cycles.
    pub predicted: Rate,
    /// Predicted over measured rate, of the line through all, less one, percent.
    pub predicted_above_measured_percent: f64,
    /// True if the predicted rate lies within the range of the specimens.
    pub inside_range_of_specimens: bool,
    /// True if it lies within the interval of the line through all weighings.
    pub inside_interval_of_weighings: bool,
    /// True if it lies within the interval of the mean of the specimens; none for one specimen.
    pub inside_interval_of_specimens: Option<bool>,
    /// The kind of rate that calibration fits.
    #[serde(skip)]
    aim: IntervalWord,
}

/// The losses at one stop of the simulator.
#[derive(Clone, Debug, Serialize)]
pub struct Weighing {
    /// Cycles done.
    pub cycles: f64,
    /// Mean gain of the soak controls since the start, mg.
    pub soak_gain_mg: f64,
    /// Loss of each specimen since the start, soak-corrected, mg, in the order of `specimens`.
    pub loss_mg: Vec<f64>,
    /// Predicted loss, mg; none after the run's end.
    pub predicted_loss_mg: Option<f64>,
    /// True if the weighing is used for the lines: the run reaches it, and it is not excluded as running-in.
    pub in_line: bool,
}

/// A wear rate.
#[derive(Clone, Debug, Serialize)]
pub struct Rate {
    /// The specimen, or the description of a mean.
    pub name: String,
    /// Slope of the line.
    pub mg_per_million_cycles: f64,
    /// Value of the line at the start of the test, mg; none for a mean of rates.
    pub intercept_mg: Option<f64>,
    /// The interval, where there are enough points.
    pub interval_mg_per_million_cycles: Option<Interval>,
    /// The part of the variance that the line explains.
    pub r_squared: Option<f64>,
}

/// Factor by which a measured and a predicted number differ only if their units do. Our choice: tests of one implant differ by less,
/// and units by a thousand, or 57 for degrees and radians.
pub(crate) const OTHER_UNIT: f64 = 30.0;

/// Returns whether two positive numbers may have the same unit.
pub(crate) fn is_alike(one: f64, other: f64) -> bool {
    (1.0 / OTHER_UNIT..OTHER_UNIT).contains(&(one / other))
}

/// Compares weighed specimens with the run's `wear.csv`.
pub(crate) fn compare(
    measured: &Gravimetric,
    run: &Table,
) -> Result<GravimetricComparison, CompareError> {
    let weighings = weighings(measured, run)?;
    let keys = &measured.keys;
    let confidence = keys.confidence_percent / 100.0;
    let predicted =
        counted(&weighings).filter_map(|one| Some((one.cycles, one.predicted_loss_mg?)));
    let predicted: Vec<(f64, f64)> = predicted.collect();
    let too_short = CompareError::run_too_short(predicted.len());
    let predicted = Rate::of_line("predicted", &predicted, confidence).ok_or(too_short)?;
    let specimens = measured.specimens.iter().enumerate();
    let specimens = specimens.filter_map(|(index, specimen)| {
        let losses = counted(&weighings).map(|one| (one.cycles, one.loss_mg[index]));
        Rate::of_line(&specimen.name, &losses.collect::<Vec<_>>(), confidence)
    });
    let specimens: Vec<Rate> = specimens.collect();
    let all = Rate::of_line("all weighings", &all_losses(&weighings), confidence);
    let all = all.ok_or_else(|| CompareError::no_column("cycles"))?;
    let rates: Vec<f64> = specimens
        .iter()
        .map(|one| one.mg_per_million_cycles)
        .collect();
    let range = Interval {
        low: rates.iter().copied().fold(f64::INFINITY, f64::min),
        high: rates.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    };
    let mean_of_specimens = Rate {
        name: "mean of the specimens".to_owned(),
        mg_per_million_cycles: mean(&rates),
        intercept_mg: None,
        interval_mg_per_million_cycles: mean_interval(&rates, confidence),
        r_squared: None,
    };
    // Compared with the interval of the measured mean, not with the scatter of single specimens.
    let rate = predicted.mg_per_million_cycles;
    let inside = |of: &Rate| of.interval_mg_per_million_cycles.map(|i| i.holds(rate));
    Ok(GravimetricComparison {
        confidence_percent: keys.confidence_percent,
        fit_from_cycles: keys.fit_from_cycles,
        soak_controls: measured.soaks.len(),
        predicted_above_measured_percent: 100.0 * (rate / all.mg_per_million_cycles - 1.0),
        inside_range_of_specimens: range.holds(rate),
        inside_interval_of_weighings: inside(&all).unwrap_or(false),
        inside_interval_of_specimens: inside(&mean_of_specimens),
        range_of_specimens_mg_per_million_cycles: range,
        weighings,
        specimens,
        all,
        mean_of_specimens,
        predicted,
        aim: keys.interval,
    })
}

impl GravimetricComparison {
    /// Returns remarks on weighings that the run does not reach, on specimens that gain mass, and on rates of another unit.
    pub(crate) fn remarks(&self) -> impl Iterator<Item = String> {
        let missed = self.weighings.iter();
        let missed = missed.filter(|weighing| weighing.predicted_loss_mg.is_none());
        let missed = Some(missed.count())
            .filter(|count| *count > 0)
            .map(|count| {
                format!("the run ends before {count} of the weighings, which the lines omit")
            });
        let gaining = self
            .specimens
            .iter()
            .filter(|one| one.mg_per_million_cycles < 0.0);
        let gaining = gaining.map(|Rate { name, .. }| {
            format!(
                "{name} gains mass: if it is a soak control, list its column in `soak_controls`"
            )
        });
        let [measured, predicted] =
            [&self.all, &self.predicted].map(|rate| rate.mg_per_million_cycles);
        let is_other = measured > 0.0 && predicted > 0.0 && !is_alike(measured, predicted);
        let other = is_other.then(|| {
            format!(
                "the measured rate, {measured:.3} mg/Mc, and the predicted, {predicted:.3} mg/Mc, differ by more than a factor of \
                 {OTHER_UNIT}: check that the masses are in mg, and that the cycles are whole cycles, not thousands"
            )
        });
        missed.into_iter().chain(gaining).chain(other)
    }

    /// Returns the measured rate that calibration fits, with its interval.
    pub(crate) fn aim(&self) -> &Rate {
        match self.aim {
            IntervalWord::Weighings => &self.all,
            IntervalWord::Specimens => &self.mean_of_specimens,
        }
    }

    /// Returns the measured rate that calibration fits, with its scatter.
    pub(crate) fn observation(&self) -> Observation {
        let rate = self.aim().mg_per_million_cycles;
        if self.counts_specimens() {
            let rates = self.specimens.iter().map(|one| one.mg_per_million_cycles);
            return Observation {
                rate,
                weight: self.specimens.len() as f64,
                squares: rates.map(|one| (one - rate).powi(2)).sum(),
                freedom: self.specimens.len().saturating_sub(1),
            };
        }
        // The line through all weighings: its slope is as good as the weighings are spread in time.
        let points = in_millions(&all_losses(&self.weighings));
        let middle = mean(&points.iter().map(|point| point.0).collect::<Vec<_>>());
        let spread: f64 = points.iter().map(|point| (point.0 - middle).powi(2)).sum();
        let error = Line::through(&points).and_then(|line| line.slope_standard_error);
        let freedom = points.len().saturating_sub(2);
        Observation {
            rate,
            weight: spread,
            squares: error.map_or(0.0, |error| error * error * freedom as f64 * spread),
            freedom,
        }
    }

    pub(crate) fn counts_specimens(&self) -> bool {
        self.aim == IntervalWord::Specimens
    }

    /// Returns whether both have intervals of one kind.
    pub(crate) fn has_intervals_like(&self, other: &Self) -> bool {
        self.aim == other.aim && self.confidence_percent == other.confidence_percent
    }

    /// Returns the rate of a predicted loss given as (cycles, mg), by the same regression at the same cycles.
    pub(crate) fn rate_of(&self, predicted: &[(f64, f64)]) -> Option<f64> {
        let points: Vec<(f64, f64)> = counted(&self.weighings)
            .filter_map(|weighing| Some((weighing.cycles, at(predicted, weighing.cycles)?)))
            .collect();
        Line::through(&points).map(|line| line.slope * MILLION)
    }
}

/// Returns the loss at a number of cycles, linear between updates; none after the last.
fn at(curve: &[(f64, f64)], cycles: f64) -> Option<f64> {
    let after = curve.partition_point(|point| point.0 < cycles);
    let &(x, y) = curve.get(after)?;
    if after == 0 {
        return Some(y);
    }
    let (x0, y0) = curve[after - 1];
    Some(y0 + (cycles - x0) / (x - x0) * (y - y0))
}

fn weighings(measured: &Gravimetric, run: &Table) -> Result<Vec<Weighing>, CompareError> {
    let column = |column| {
        let found = run.column(column);
        found.ok_or_else(|| CompareError::no_column(column))
    };
    let (cycles, masses) = (column("cycles")?, column("mass_loss_mg")?);
    let points = cycles.iter().copied().zip(masses.iter().copied());
    let predicted: Vec<(f64, f64)> = std::iter::once((0.0, 0.0)).chain(points).collect();
    let start = measured.cycles.first().copied().unwrap_or_default();
    let gain = |specimen: &Specimen, row: usize| specimen.masses_mg[row] - specimen.masses_mg[0];
    let weighing = |(row, &cycles): (usize, &f64)| {
        let gains: Vec<f64> = measured.soaks.iter().map(|soak| gain(soak, row)).collect();
        let soak_gain_mg = if gains.is_empty() { 0.0 } else { mean(&gains) };
        // Polyethylene absorbs fluid: a worn specimen gains as much as an unloaded control.
        let loss = |specimen: &Specimen| soak_gain_mg - gain(specimen, row);
        let predicted_loss_mg =
            at(&predicted, cycles).and_then(|loss| Some(loss - at(&predicted, start)?));
        let is_counted = row > 0 && cycles >= measured.keys.fit_from_cycles;
        Weighing {
            cycles,
            soak_gain_mg,
            loss_mg: measured.specimens.iter().map(loss).collect(),
            // Rates over different cycles would compare running-in with steady wear.
            in_line: is_counted && predicted_loss_mg.is_some(),
            predicted_loss_mg,
        }
    };
    Ok(measured.cycles.iter().enumerate().map(weighing).collect())
}

fn counted(weighings: &[Weighing]) -> impl Iterator<Item = &Weighing> {
    weighings.iter().filter(|weighing| weighing.in_line)
}

impl Rate {
    /// Creates the rate as the slope of the least-squares line through points (cycles, mg).
    fn of_line(name: &str, points: &[(f64, f64)], confidence: f64) -> Option<Self> {
        let line = Line::through(&in_millions(points))?;
        Some(Self {
            name: name.to_owned(),
            mg_per_million_cycles: line.slope,
            intercept_mg: Some(line.intercept),
            interval_mg_per_million_cycles: line.slope_interval(confidence),
            r_squared: Some(line.r_squared),
        })
    }
}

/// Returns the losses of all specimens at the weighings used for the lines, as (cycles, mg).
fn all_losses(weighings: &[Weighing]) -> Vec<(f64, f64)> {
    let each = |weighing: &Weighing| {
        let cycles = weighing.cycles;
        let losses = weighing.loss_mg.clone().into_iter();
        losses.map(move |loss| (cycles, loss))
    };
    counted(weighings).flat_map(each).collect()
}

fn in_millions(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    points.iter().map(|(x, y)| (x / MILLION, *y)).collect()
}

/// A line y = slope x + intercept through points, by least squares in y.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    slope: f64,
    intercept: f64,
    /// None for two points.
    slope_standard_error: Option<f64>,
    r_squared: f64,
    points: usize,
}

/// A confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Returns whether `value` lies inside or at an end.
    pub(crate) fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// Creates the interval that reaches `half` to either side of `middle`.
    pub(crate) fn around(middle: f64, half: f64) -> Self {
        Self {
            low: middle - half,
            high: middle + half,
        }
    }
}

impl Line {
    /// Fits the line; none for fewer than two points, or if all have the same x.
    fn through(points: &[(f64, f64)]) -> Option<Self> {
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

    /// Interval of the slope by Student's t with two degrees of freedom fewer than points.
    fn slope_interval(&self, confidence: f64) -> Option<Interval> {
        let half = student(confidence, self.points.checked_sub(2)?)? * self.slope_standard_error?;
        Some(Interval::around(self.slope, half))
    }
}

/// Interval of the mean of independent values by Student's t; none for fewer than two.
pub(crate) fn mean_interval(values: &[f64], confidence: f64) -> Option<Interval> {
    let freedom = values.len().checked_sub(1)?;
    let quantile = student(confidence, freedom)?;
    let middle = mean(values);
    let squares: f64 = values.iter().map(|value| (value - middle).powi(2)).sum();
    let standard_error = (squares / freedom as f64 / values.len() as f64).sqrt();
    Some(Interval::around(middle, quantile * standard_error))
}

/// Returns half the width of a two-sided Student interval, in standard errors; none without a degree of freedom.
pub fn student(confidence: f64, freedom: usize) -> Option<f64> {
    let distribution = StudentsT::new(0.0, 1.0, freedom as f64).ok()?;
    Some(distribution.inverse_cdf(f64::midpoint(1.0, confidence)))
}

/// A measured rate and its scatter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Observation {
    pub(crate) rate: f64,
    /// The number of specimens, or the spread of the weighings in time.
    pub(crate) weight: f64,
    /// Sum of the squared deviations from the mean or the line, in the square of the rate's unit.
    pub(crate) squares: f64,
    /// Degrees of freedom of that sum.
    pub(crate) freedom: usize,
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
        assert_eq!((line.slope, line.intercept), (0.5, 1.5));
        assert!(line.slope_interval(0.95).is_none());
    }
}
