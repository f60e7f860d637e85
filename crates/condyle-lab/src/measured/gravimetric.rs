//! Predicted against weighed wear.

use condyle_io::measured::{Gravimetric, IntervalWord, Specimen};
use condyle_report::Table;
use serde::Serialize;

use super::CompareError;
use super::line::{Interval, Line, mean, mean_interval};
use super::observation::Observation;

/// Wear rates are per this many cycles.
const MILLION: f64 = 1e6;

/// Wear by weighing, corrected by soak controls, against the predicted one. Rates are in mg per
/// million cycles.
#[derive(Clone, Debug, Serialize)]
pub struct GravimetricComparison {
    /// Confidence of every interval, percent.
    pub confidence_percent: f64,
    /// Weighings before this many cycles are not in the lines.
    pub fit_from_cycles: f64,
    /// Soak controls; 0 means that nothing was corrected.
    pub soak_controls: usize,
    /// A row for each weighing, the first included.
    pub weighings: Vec<Weighing>,
    /// A line for each specimen.
    pub specimens: Vec<Rate>,
    /// One line through the weighings of all specimens.
    pub all: Rate,
    /// Mean of the specimens' rates, and its interval with each specimen as one observation.
    pub mean_of_specimens: Rate,
    /// From the specimen that wears least to the one that wears most.
    pub range_of_specimens_mg_per_million_cycles: Interval,
    /// The same regression through the predicted loss at the same cycles.
    pub predicted: Rate,
    /// Predicted over measured rate, of the line through all, less one, percent.
    pub predicted_above_measured_percent: f64,
    /// Whether the predicted rate lies within the range of the specimens.
    pub inside_range_of_specimens: bool,
    /// Whether it lies within the interval of the line through all weighings.
    pub inside_interval_of_weighings: bool,
    /// Whether it lies within the interval of the mean of the specimens; none for one specimen.
    pub inside_interval_of_specimens: Option<bool>,
    /// What calibration aims at.
    #[serde(skip)]
    pub aim: IntervalWord,
}

/// Masses at one stop of the simulator.
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
    /// Whether it is in the lines.
    pub in_line: bool,
}

/// A wear rate.
#[derive(Clone, Debug, Serialize)]
pub struct Rate {
    /// What it is of.
    pub name: String,
    /// Slope of the line.
    pub mg_per_million_cycles: f64,
    /// Where the line is at the start of the test, mg; none for a mean of rates.
    pub intercept_mg: Option<f64>,
    /// Its interval, where there are enough points.
    pub interval_mg_per_million_cycles: Option<Interval>,
    /// Part of the variance that the line explains.
    pub r_squared: Option<f64>,
}

/// Compares weighed specimens with the run's `wear.csv`.
pub(super) fn compare(
    measured: &Gravimetric,
    run: &Table,
) -> Result<GravimetricComparison, CompareError> {
    let predicted = predicted_curve(run)?;
    let weighings = weighings(measured, &predicted);
    let confidence = measured.keys.confidence_percent / 100.0;
    let specimens = each_specimen(measured, &weighings, confidence);
    let all = pooled(&weighings, confidence)?;
    let mean_of_specimens = mean_rate(&specimens, confidence);
    let predicted = predicted_rate(&weighings, confidence)?;
    let rate = predicted.mg_per_million_cycles;
    let range = range(&specimens);
    let inside = |of: &Rate| of.interval_mg_per_million_cycles.map(|i| i.holds(rate));
    Ok(GravimetricComparison {
        confidence_percent: measured.keys.confidence_percent,
        fit_from_cycles: measured.keys.fit_from_cycles,
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
        aim: measured.keys.interval,
    })
}

impl GravimetricComparison {
    /// The measured rate that calibration aims at, with its interval.
    pub fn aim(&self) -> &Rate {
        match self.aim {
            IntervalWord::Weighings => &self.all,
            IntervalWord::Specimens => &self.mean_of_specimens,
        }
    }

    /// The measured rate that calibration aims at, with what its scatter tells: the mean of the specimens' rates, or the
    /// line through all weighings.
    pub(super) fn observation(&self) -> Observation {
        let rate = self.aim().mg_per_million_cycles;
        let (weight, squares, points, used) = match self.aim {
            IntervalWord::Specimens => {
                let off = self
                    .specimens
                    .iter()
                    .map(|one| (one.mg_per_million_cycles - rate).powi(2));
                (
                    self.specimens.len() as f64,
                    off.sum(),
                    self.specimens.len(),
                    1,
                )
            }
            IntervalWord::Weighings => self.observed_line(),
        };
        Observation {
            rate,
            weight,
            squares,
            freedom: points.saturating_sub(used),
        }
    }

    /// Spread in time, squares off the line as those of its slope, points, and what the line takes of them.
    fn observed_line(&self) -> (f64, f64, usize, usize) {
        const OF_A_LINE: usize = 2;
        let points = in_millions(&all_losses(&self.weighings));
        let middle = mean(&points.iter().map(|point| point.0).collect::<Vec<_>>());
        let spread: f64 = points.iter().map(|point| (point.0 - middle).powi(2)).sum();
        let error = Line::through(&points).and_then(|line| line.slope_standard_error);
        let freedom = points.len().saturating_sub(OF_A_LINE) as f64;
        let squares = error.map_or(0.0, |error| error * error * freedom * spread);
        (spread, squares, points.len(), OF_A_LINE)
    }

    /// Whether it is specimens that intervals count, and not weighings.
    pub(super) fn counts_specimens(&self) -> bool {
        self.aim == IntervalWord::Specimens
    }

    /// Whether both give intervals of one kind.
    pub(super) fn has_intervals_like(&self, other: &Self) -> bool {
        self.aim == other.aim && self.confidence_percent == other.confidence_percent
    }

    /// Rate of a predicted loss given as (cycles, mg), by the same regression at the same cycles.
    pub(super) fn rate_of(&self, predicted: &[(f64, f64)]) -> Option<f64> {
        let counted = self.weighings.iter().filter(|weighing| weighing.in_line);
        let points: Vec<(f64, f64)> = counted
            .filter_map(|weighing| Some((weighing.cycles, at(predicted, weighing.cycles)?)))
            .collect();
        Line::through(&points).map(|line| line.slope * MILLION)
    }
}

/// Predicted loss as (cycles, mg), from nothing at the start.
fn predicted_curve(run: &Table) -> Result<Vec<(f64, f64)>, CompareError> {
    let column = |column| run.column(column).ok_or(CompareError::NoColumn { column });
    let (cycles, masses) = (column("cycles")?, column("mass_loss_mg")?);
    let points = cycles.iter().copied().zip(masses.iter().copied());
    Ok(std::iter::once((0.0, 0.0)).chain(points).collect())
}

/// The loss at a number of cycles, linear between updates; none after the last.
fn at(curve: &[(f64, f64)], cycles: f64) -> Option<f64> {
    let after = curve.partition_point(|point| point.0 < cycles);
    let &(x, y) = curve.get(after)?;
    if after == 0 {
        return Some(y);
    }
    let (x0, y0) = curve[after - 1];
    Some(y0 + (cycles - x0) / (x - x0) * (y - y0))
}

fn weighings(measured: &Gravimetric, predicted: &[(f64, f64)]) -> Vec<Weighing> {
    let start = measured.cycles.first().copied().unwrap_or_default();
    let gain = |specimen: &Specimen, row: usize| specimen.masses_mg[row] - specimen.masses_mg[0];
    let weighing = |(row, &cycles): (usize, &f64)| {
        let gains: Vec<f64> = measured.soaks.iter().map(|soak| gain(soak, row)).collect();
        let soak_gain_mg = if gains.is_empty() { 0.0 } else { mean(&gains) };
        let loss = |specimen: &Specimen| soak_gain_mg - gain(specimen, row);
        Weighing {
            cycles,
            soak_gain_mg,
            loss_mg: measured.specimens.iter().map(loss).collect(),
            predicted_loss_mg: since(predicted, start, cycles),
            in_line: row > 0 && cycles >= measured.keys.fit_from_cycles,
        }
    };
    measured.cycles.iter().enumerate().map(weighing).collect()
}

/// Predicted loss between two numbers of cycles.
fn since(predicted: &[(f64, f64)], start: f64, cycles: f64) -> Option<f64> {
    Some(at(predicted, cycles)? - at(predicted, start)?)
}

fn each_specimen(measured: &Gravimetric, weighings: &[Weighing], confidence: f64) -> Vec<Rate> {
    let rate = |(index, specimen): (usize, &Specimen)| {
        let points: Vec<(f64, f64)> = counted(weighings)
            .map(|weighing| (weighing.cycles, weighing.loss_mg[index]))
            .collect();
        Rate::of_line(&specimen.name, &points, confidence)
    };
    let all = measured.specimens.iter().enumerate();
    all.filter_map(rate).collect()
}

fn counted(weighings: &[Weighing]) -> impl Iterator<Item = &Weighing> {
    weighings.iter().filter(|weighing| weighing.in_line)
}

impl Rate {
    /// Slope of the line through points (cycles, mg).
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

fn pooled(weighings: &[Weighing], confidence: f64) -> Result<Rate, CompareError> {
    let rate = Rate::of_line("all weighings", &all_losses(weighings), confidence);
    rate.ok_or(CompareError::NoColumn { column: "cycles" })
}

/// Losses of all specimens at all weighings that count, as (cycles, mg).
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

fn mean_rate(specimens: &[Rate], confidence: f64) -> Rate {
    let rates: Vec<f64> = specimens
        .iter()
        .map(|rate| rate.mg_per_million_cycles)
        .collect();
    Rate {
        name: "mean of the specimens".to_owned(),
        mg_per_million_cycles: mean(&rates),
        intercept_mg: None,
        interval_mg_per_million_cycles: mean_interval(&rates, confidence),
        r_squared: None,
    }
}

fn range(specimens: &[Rate]) -> Interval {
    let rates = || specimens.iter().map(|rate| rate.mg_per_million_cycles);
    Interval {
        low: rates().fold(f64::INFINITY, f64::min),
        high: rates().fold(f64::NEG_INFINITY, f64::max),
    }
}

fn predicted_rate(weighings: &[Weighing], confidence: f64) -> Result<Rate, CompareError> {
    let points: Vec<(f64, f64)> = counted(weighings)
        .filter_map(|weighing| Some((weighing.cycles, weighing.predicted_loss_mg?)))
        .collect();
    Rate::of_line("predicted", &points, confidence).ok_or(CompareError::RunTooShort {
        weighings: points.len(),
    })
}
