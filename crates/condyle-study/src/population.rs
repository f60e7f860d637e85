//! The distribution of an output over the distributions of the inputs, by its emulator.

use condyle_case::study::Input;
use statrs::distribution::{Beta, ContinuousCDF};

use crate::{
    design::latin_places,
    distribution::{Place, normal_share, number_at_share},
    emulator::{Emulator, Prediction},
    plan::Plan,
    random::Random,
    search::Estimate,
    statistics::{central_interval, mean},
};

/// Points that represent the distributions of the inputs.
const POINTS: usize = 20_000;
/// Points for a probability of at most [`RARE`]: of 1e-3, 100 are then beyond the limit, and their number scatters by 10 %.
const RARE_POINTS: usize = 100_000;
const RARE: f64 = 0.02;
/// Number of standard deviations between prediction and limit from which the side of a point is certain.
const CERTAIN: f64 = 4.0;
/// Largest number of points whose outputs are drawn together: the time grows with its cube.
const MAX_JOINT: usize = 256;
/// Draws of their outputs.
const DRAWS: usize = 400;
/// Seed of points and draws: answers are the same whenever they are computed.
const SEED: u64 = 20_220_101;

/// The scale of an input in an emulator: its coordinates between both ends span 1.
pub(crate) struct Axis<'a> {
    pub input: &'a Input,
    pub ends: [f64; 2],
}

impl<'a> Axis<'a> {
    pub fn new(input: &'a Input, ends: [f64; 2]) -> Self {
        Self { input, ends }
    }

    /// Returns the coordinate of a value.
    pub fn place(&self, value: f64) -> f64 {
        let [low, high] = self.ends;
        (value - low) / if high > low { high - low } else { 1.0 }
    }

    /// Returns the coordinate of the value at this share of the distribution.
    pub fn at_share(&self, share: f64) -> f64 {
        self.place(number_at_share(self.input, share))
    }
}

/// An output at random points of the inputs' distributions, predicted by an emulator.
pub(crate) struct Population<'a> {
    plan: &'a Plan,
    emulator: &'a Emulator,
    axes: &'a [Axis<'a>],
    predictions: Vec<Prediction>,
}

/// A point and its distance to a limit, in the unit of the output.
pub(crate) struct Point {
    pub row: u64,
    /// Of the prediction; negative within the limit.
    excess: f64,
    standard_deviation: f64,
}

impl Point {
    /// Returns the distance to the limit in standard deviations.
    pub fn deviations(&self) -> f64 {
        self.excess / self.standard_deviation
    }

    fn is_certain(&self) -> bool {
        self.deviations().abs() > CERTAIN
    }
}

impl<'a> Population<'a> {
    pub fn new(plan: &'a Plan, emulator: &'a Emulator, axes: &'a [Axis<'a>]) -> Self {
        let mut all = Self {
            plan,
            emulator,
            axes,
            predictions: Vec::new(),
        };
        let predictions = (0..POINTS as u64).map(|row| all.predicted(&all.point(row)));
        all.predictions = predictions.collect();
        all
    }

    fn point(&self, row: u64) -> Vec<f64> {
        let axes = self.axes.iter().zip(self.places(row));
        let coordinate = |(axis, place): (&Axis<'_>, Place)| match place {
            Place::Share(share) => axis.at_share(share),
            _ => f64::NAN,
        };
        axes.map(coordinate).collect()
    }

    /// Returns the places of a point in the inputs' distributions.
    pub fn places(&self, row: u64) -> Vec<Place> {
        // A part of the rows of a Latin hypercube is nearly a random sample.
        let places = latin_places(row, RARE_POINTS as u64, self.axes.len(), SEED);
        self.plan.correlated(places)
    }

    /// Predicts a test at a point: its standard deviation includes the scatter of tests around the process.
    fn predicted(&self, point: &[f64]) -> Prediction {
        let found = self.emulator.predict(point);
        let deviation = found.standard_deviation.hypot(self.emulator.noise());
        Prediction {
            standard_deviation: deviation.max(f64::MIN_POSITIVE),
            ..found
        }
    }

    /// Returns the predicted outputs, the smallest first.
    pub fn sorted(&self) -> Vec<f64> {
        let means = self.predictions.iter().map(|one| one.mean);
        let mut means: Vec<f64> = means.collect();
        means.sort_by(f64::total_cmp);
        means
    }

    /// Returns the probability that the output is beyond a limit, where its `excess` is positive, with its 95 % interval, from
    /// the [`points`](Self::points) at their distances to the limit.
    ///
    /// The interval is that of joint draws of the output at the points whose side of the limit is not certain. Each draw adds
    /// one of the probabilities that give as many points beyond the limit, of Jeffreys' beta distribution, as the number of
    /// points is finite.
    pub fn beyond(&self, points: &[Point], excess: &dyn Fn(f64) -> f64) -> Estimate {
        let shares: Vec<f64> = points
            .iter()
            .map(|one| normal_share(one.deviations()))
            .collect();
        let (certain, mut uncertain): (Vec<&Point>, Vec<&Point>) =
            points.iter().partition(|point| point.is_certain());
        let (count, open) = (points.len() as f64, uncertain.len() as f64);
        let certain = certain.iter().filter(|point| point.excess > 0.0).count() as f64;
        // Points at even distances in the order of their probabilities represent all.
        uncertain.sort_by(|one, other| one.deviations().total_cmp(&other.deviations()));
        let joint = uncertain.len().min(MAX_JOINT);
        let chosen =
            (0..joint).map(|place| uncertain[(2 * place + 1) * uncertain.len() / (2 * joint)]);
        let chosen: Vec<Vec<f64>> = chosen.map(|point| self.point(point.row)).collect();
        let mut numbers = Random::stream(SEED, 0);
        let drawn: Vec<f64> = match self.emulator.draws(&chosen, DRAWS, &mut numbers) {
            Some(draws) => {
                let beyond =
                    |draw: &[f64]| draw.iter().filter(|value| excess(**value) > 0.0).count();
                let share = |beyond: usize| beyond as f64 / joint.max(1) as f64;
                draws
                    .iter()
                    .map(|draw| share(beyond(draw.as_slice())))
                    .collect()
            }
            // Without a joint distribution all of them may be on either side.
            None => vec![0.0, 1.0],
        };
        let probability = |share: &f64| {
            let hits = certain + share * open;
            let beta = Beta::new(hits + 0.5, count - hits + 0.5);
            beta.map_or(f64::NAN, |beta| beta.inverse_cdf(numbers.share()))
        };
        Estimate {
            value: mean(&shares),
            interval: central_interval(drawn.iter().map(probability).collect()),
        }
    }

    /// Returns the points that represent the distributions, more of them if the limit is rarely exceeded.
    pub fn points(&self, excess: &dyn Fn(f64) -> f64) -> Vec<Point> {
        let point = |(row, found): (usize, &Prediction)| Point {
            row: row as u64,
            excess: excess(found.mean),
            standard_deviation: found.standard_deviation,
        };
        let mut points: Vec<Point> = self.predictions.iter().enumerate().map(point).collect();
        let beyond = points.iter().map(|one| normal_share(one.deviations()));
        if beyond.sum::<f64>() > RARE * POINTS as f64 {
            return points;
        }
        // A standard deviation takes most of the time of a prediction. Far from the limit, the largest one of the first points
        // is enough.
        let largest = points
            .iter()
            .map(|one| one.standard_deviation)
            .fold(0.0, f64::max);
        let more = (POINTS as u64..RARE_POINTS as u64).map(|row| {
            let point = self.point(row);
            let far = Point {
                row,
                excess: excess(self.emulator.mean(&point)),
                standard_deviation: largest,
            };
            match far.is_certain() {
                true => far,
                false => Point {
                    standard_deviation: self.predicted(&point).standard_deviation,
                    ..far
                },
            }
        });
        points.extend(more.collect::<Vec<_>>());
        points
    }
}
