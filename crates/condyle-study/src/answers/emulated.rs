//! Sobol indices and probabilities of limits from emulators of the outputs.

use condyle_case::{
    config::Level,
    study::{Bound, Design, Input},
};
use condyle_results::catalogue::Scalar;
use serde::Serialize;

use crate::{
    answers::{
        data::{Data, is_sampled},
        indices::Indices,
    },
    design::latin_places,
    distribution::{level_at_share, normal_share},
    emulator::{Emulator, Model},
    plan::designs,
    statistics::{NORMAL_95, extent, mean, wilson_interval},
};

/// Smallest Q2 of an emulator from which answers are computed: a tenth of the variance remains
/// unexplained, and indices may be wrong by that much.
pub(crate) const MIN_Q2: f64 = 0.9;
/// Largest number of tests that condition an emulator.
const MAX_TESTS: usize = 256;
/// Values of an input in integrals over its distribution, each equally likely.
const NODES: usize = 128;
/// Groups of tests of which each is omitted once.
const GROUPS: usize = 10;
/// Points at which an emulator is compared with a limit.
const POINTS: u64 = 20_000;
const SEED: u64 = 20_220_101;

/// An emulator of an output and what follows from it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Emulated {
    pub output: &'static str,
    pub title: &'static str,
    pub unit: &'static str,
    /// Tests that condition the emulator.
    pub tests: usize,
    pub q2: f64,
    /// Probabilities of being beyond each limit; none if Q2 is too small.
    pub beyond: Vec<Chance>,
    #[serde(skip)]
    pub exported: Exported,
}

/// An emulator as written to a file: coordinates of its points range from 0 at the low end of an
/// input to 1 at the high end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Exported {
    output: &'static str,
    q2: f64,
    inputs: Vec<Range>,
    #[serde(flatten)]
    model: Model,
}

/// The values of an input in the tests.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Range {
    key: String,
    low: f64,
    high: f64,
}

/// The probability that an output is beyond a limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Chance {
    pub least: Option<f64>,
    pub most: Option<f64>,
    pub probability: f64,
    /// The probability if all predictions are off by 1.96 standard deviations to either side, with the interval of the
    /// points.
    pub interval: [f64; 2],
}

/// The scale of an input: its coordinates in the tests span 1.
struct Axis<'a> {
    input: &'a Input,
    low: f64,
    high: f64,
}

impl Axis<'_> {
    fn place(&self, value: f64) -> f64 {
        let width = self.high - self.low;
        (value - self.low) / if width > 0.0 { width } else { 1.0 }
    }

    fn range(&self) -> Range {
        Range {
            key: self.input.key.clone(),
            low: self.low,
            high: self.high,
        }
    }

    /// Returns the place of the value at this share of the distribution.
    fn at_share(&self, share: f64) -> f64 {
        match level_at_share(self.input, share) {
            Level::Number(value) => self.place(value),
            Level::Word(_) => f64::NAN,
        }
    }

    fn nodes(&self) -> Vec<f64> {
        let share = |node: usize| (node as f64 + 0.5) / NODES as f64;
        (0..NODES).map(|node| self.at_share(share(node))).collect()
    }
}

/// Returns the emulators of all outputs and the Sobol indices from them; empty for studies without a random sample of
/// numbers of one design.
pub(crate) fn emulated(data: &Data<'_>) -> (Vec<Emulated>, Vec<Indices>) {
    let study = data.plan.study();
    let is_sample = matches!(
        study.design,
        Design::LatinHypercube(_) | Design::Sobol(_) | Design::Saltelli(_) | Design::Adaptive(_)
    );
    let has_words = data.inputs.iter().any(|column| !column.words.is_empty());
    if !is_sample || has_words || designs(study) > 1 || study.inputs.is_empty() {
        return Default::default();
    }
    let inputs = study.inputs.iter().zip(&data.inputs);
    let axes = inputs.map(|(input, column)| {
        let [low, high] = extent(
            column
                .values
                .iter()
                .copied()
                .filter(|value| value.is_finite()),
        );
        Axis { input, low, high }
    });
    let axes: Vec<Axis<'_>> = axes.collect();
    let (mut all, mut indices) = (Vec::new(), Vec::new());
    for (output, values) in &data.outputs {
        let Some(emulator) = emulator(data, &axes, values) else {
            continue;
        };
        let mut emulated = Emulated::new(output, &axes, &emulator);
        if emulated.q2 >= MIN_Q2 {
            let own = study.answers.bounds_of(output);
            emulated.beyond = own
                .map(|bound| chance(data, &axes, &emulator, bound))
                .collect();
            if study.correlations.is_empty() {
                indices.extend(of_output(&axes, &emulator, &emulated));
            }
        }
        all.push(emulated);
    }
    (all, indices)
}

/// Returns an emulator of an output from the first tests that are done; of a Saltelli design, of those of the sample.
fn emulator(data: &Data<'_>, axes: &[Axis<'_>], values: &[f64]) -> Option<Emulator> {
    let rows = values.iter().enumerate();
    let is_used = |row| !data.is_sample() || is_sampled(data.plan, row);
    let done = rows.filter(|(row, value)| value.is_finite() && is_used(*row));
    let places = done.take(MAX_TESTS).map(|(row, value)| {
        let columns = axes.iter().zip(&data.inputs);
        let point = columns.map(|(axis, column)| axis.place(column.values[row]));
        (point.collect::<Vec<f64>>(), *value)
    });
    let (points, values): (Vec<_>, Vec<_>) = places.unzip();
    // With fewer tests than lengths, the likeliest lengths mean little.
    if points.len() <= axes.len() + 2
        || extent(values.iter().copied())
            .windows(2)
            .any(|ends| ends[0] == ends[1])
    {
        return None;
    }
    Emulator::fit(&points, &values).map(Emulator::calibrated)
}

impl Emulated {
    fn new(output: &Scalar, axes: &[Axis<'_>], emulator: &Emulator) -> Self {
        let exported = Exported {
            output: output.key,
            q2: emulator.q2(),
            inputs: axes.iter().map(Axis::range).collect(),
            model: emulator.model(),
        };
        Self {
            output: output.key,
            title: output.label,
            unit: output.unit(),
            tests: emulator.left_out().len(),
            q2: exported.q2,
            beyond: Vec::new(),
            exported,
        }
    }
}

/// Returns the indices of the emulator's mean. Their intervals are 1.96 standard errors by the jackknife over groups of
/// tests (Efron 1982) and the part of the variance that the emulator does not explain, to either side.
fn of_output(axes: &[Axis<'_>], emulator: &Emulator, emulated: &Emulated) -> Vec<Indices> {
    let nodes: Vec<Vec<f64>> = axes.iter().map(Axis::nodes).collect();
    let all = emulator.indices(&nodes);
    let groups = (0..GROUPS).filter_map(|group| emulator.without(|test| test % GROUPS == group));
    let without: Vec<Vec<[f64; 2]>> = groups.map(|one| one.indices(&nodes)).collect();
    let index = |(place, axis): (usize, &Axis<'_>)| {
        let interval = |kind: usize| {
            let own: Vec<f64> = without.iter().map(|one| one[place][kind]).collect();
            let half = NORMAL_95 * jackknife_error(&own) + (1.0 - emulated.q2);
            [-half, half].map(|by| (all[place][kind] + by).clamp(0.0, 1.0))
        };
        Indices {
            output: emulated.output,
            input: axis.input.key.clone(),
            // Rounding may leave the index of an inactive input below 0.
            first: all[place][0].max(0.0),
            first_interval: interval(0),
            total: all[place][1].max(0.0),
            total_interval: interval(1),
            bases: emulated.tests,
        }
    };
    axes.iter().enumerate().map(index).collect()
}

fn jackknife_error(without: &[f64]) -> f64 {
    let (mean, count) = (mean(without), without.len() as f64);
    let squares: f64 = without.iter().map(|one| (one - mean).powi(2)).sum();
    ((count - 1.0) / count * squares).sqrt()
}

/// Returns the probability that predictions at points of the inputs' distributions are beyond a bound.
fn chance(data: &Data<'_>, axes: &[Axis<'_>], emulator: &Emulator, bound: &Bound) -> Chance {
    let noise = emulator.noise();
    let [mut middle, mut low, mut high] = [0.0; 3];
    for row in 0..POINTS {
        let places = data
            .plan
            .correlated(latin_places(row, POINTS, axes.len(), SEED));
        let values = data.plan.values_at(&places);
        let point = axes.iter().zip(&values);
        let point = point.map(|(axis, value)| match value {
            Some(Level::Number(value)) => axis.place(*value),
            _ => f64::NAN,
        });
        let found = emulator.predict(&point.collect::<Vec<f64>>());
        let deviation = found.standard_deviation.hypot(noise);
        let deviation = deviation.max(f64::MIN_POSITIVE);
        let sides = bound.sides();
        let excess = sides.map(|(sign, limit)| sign * (found.mean - limit));
        // At most one of two limits is likely to be exceeded.
        let excess = excess.fold(f64::NEG_INFINITY, f64::max) / deviation;
        middle += normal_share(excess);
        low += f64::from(excess > NORMAL_95);
        high += f64::from(excess > -NORMAL_95);
    }
    let points = POINTS as f64;
    Chance {
        least: bound.least,
        most: bound.most,
        probability: middle / points,
        interval: [
            wilson_interval(low, points)[0],
            wilson_interval(high, points)[1],
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_case::study::{UniformKeys, Variation};
    use condyle_results::catalogue::MASS_LOSS_MG;

    use crate::emulator::tests::{
        exact_g_function, exact_ishigami, g_function, ishigami, points, values,
    };

    /// Returns the share of 95 % intervals that contain the exact indices, of emulators that answers are computed from.
    fn coverage(of: fn(&[f64]) -> f64, exact: &[[f64; 2]], count: u64) -> f64 {
        let keys = UniformKeys {
            low: 0.0,
            high: 1.0,
        };
        let input = Input::new("x", Variation::Uniform(keys));
        let axis = || Axis {
            input: &input,
            low: 0.0,
            high: 1.0,
        };
        let axes: Vec<Axis<'_>> = exact.iter().map(|_| axis()).collect();
        let mut inside = Vec::new();
        for seed in 1..=10 {
            let tests = points(count, exact.len(), seed);
            let emulator = Emulator::fit(&tests, &values(&tests, of)).unwrap();
            let emulated = Emulated::new(&MASS_LOSS_MG, &axes, &emulator);
            if emulated.q2 < MIN_Q2 {
                continue;
            }
            for (found, exact) in of_output(&axes, &emulator, &emulated).iter().zip(exact) {
                let intervals = [found.first_interval, found.total_interval];
                let both = intervals.iter().zip(exact);
                inside.extend(
                    both.map(|([low, high], exact)| f64::from(low <= exact && exact <= high)),
                );
            }
        }
        mean(&inside)
    }

    #[test]
    fn verify_intervals_of_indices_contain_the_exact_ones() {
        for (of, exact, count) in [
            (ishigami as fn(&[f64]) -> f64, exact_ishigami(), 96),
            (ishigami, exact_ishigami(), 160),
            (g_function, exact_g_function(), 60),
            (g_function, exact_g_function(), 120),
        ] {
            let share = coverage(of, &exact, count);
            println!("{count} tests: {share:.3}");
            assert!(share >= 0.9, "{count} tests: {share}");
        }
    }
}
