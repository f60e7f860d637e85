//! Sobol indices and probabilities of limits from emulators of the outputs.

use std::{num::NonZero, sync::Mutex, thread};

use condyle_case::study::{Bound, Design};
use condyle_results::catalogue::Scalar;
use serde::Serialize;

use crate::{
    answers::{
        data::{Data, Distribution, OutputOfDesign},
        indices::Indices,
    },
    design::sobol::MAX_AXES,
    distribution::number_at_share,
    emulator::{Emulator, Model},
    population::{Axis, Population},
    search::Estimate,
    statistics::{NORMAL_95, extent, mean, standard_deviation},
};

/// Smallest Q2 of an emulator from which answers are computed: a tenth of the variance remains
/// unexplained, and indices may be wrong by that much.
pub(crate) const MIN_Q2: f64 = 0.9;
/// Largest share of failed tests, about which an emulator knows nothing, up to which answers are computed from it.
const MAX_FAILED: f64 = 0.01;
/// Largest number of tests that condition an emulator.
const MAX_TESTS: usize = 256;
/// Values of an input in integrals over its distribution, each equally likely.
const NODES: usize = 128;
/// Groups of tests of which each is omitted once.
const GROUPS: usize = 10;

/// Returns the smallest number of tests from whose emulator answers are computed: ten for each input (Loeppky et al. 2009), at most 30
/// for up to ten inputs; three for each of more than ten inputs, of which few matter.
///
/// The Q2 of fewer tests exceeds [`MIN_Q2`] by chance: of a peak pressure with a kink, three inputs and 12 tests, Q2 was 0.97 where
/// other tests had 0.26.
pub(crate) fn min_tests(inputs: usize) -> usize {
    (10 * inputs).min(30).max(3 * inputs)
}

/// An emulator of an output and what follows from it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Emulated {
    pub output: &'static str,
    pub title: &'static str,
    pub unit: &'static str,
    /// The name of the design, if the study compares designs.
    pub design: Option<String>,
    /// Tests that condition the emulator.
    pub tests: usize,
    pub q2: f64,
    /// The share of the tests that failed.
    pub failed: f64,
    /// True if the tests are a sample of the inputs' distributions, or chosen for an emulator over them.
    pub is_sample: bool,
    /// The distribution of the predictions over the distributions of the inputs; none if the emulator is not used.
    pub distribution: Option<Distribution>,
    /// Probabilities of being beyond each limit; none if the emulator is not used.
    pub beyond: Vec<Chance>,
    /// The output of each test, and its prediction from all others.
    #[serde(skip)]
    pub tested_and_predicted: Vec<(f64, f64)>,
    /// For each input, its values and the mean of the predictions at each over the distributions of all others; none if the
    /// emulator is not used, or the inputs are correlated.
    #[serde(skip)]
    pub main_effects: Vec<MainEffect>,
    #[serde(skip)]
    pub exported: Exported,
}

/// The mean of an emulator's predictions over an input.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MainEffect {
    /// Values of the input, each equally likely, and the mean at each.
    pub means: Vec<(f64, f64)>,
    /// Largest standard deviation of these means that may be an error of the emulator, that of a first index as large as half of its
    /// interval, relative to theirs; finite for equal means.
    pub error: f64,
}

/// An emulator as written to a file: coordinates of its points range from 0 at the low end of an
/// input to 1 at the high end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Exported {
    output: &'static str,
    design: Option<String>,
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
    /// Its 95 % interval.
    pub interval: [f64; 2],
}

/// Returns the emulators of all outputs, of each design by itself, and the Sobol indices from them; empty for inputs without
/// numbers, for a search, which has its own, and for tests that change one input at a time.
pub(crate) fn emulated(data: &Data<'_>) -> (Vec<Emulated>, Vec<Indices>) {
    let study = data.plan.study();
    let has_none = matches!(study.design, Design::Optimise(_) | Design::OneAtATime(_));
    let has_words = data.inputs.iter().any(|column| !column.words.is_empty());
    if has_none || has_words || study.inputs.is_empty() {
        return Default::default();
    }
    let inputs = study.inputs.iter().zip(&data.inputs);
    let axes = inputs.map(|(input, column)| {
        let values = column.values.iter().copied();
        let ends = extent(values.filter(|value| value.is_finite()));
        Axis::new(input, ends)
    });
    let axes: Vec<Axis<'_>> = axes.collect();
    // The points of an output take seconds, and the outputs' times differ. Their order does not depend on the threads.
    let left = Mutex::new(data.outputs_of_designs().enumerate());
    let work = || {
        let mut found = Vec::new();
        loop {
            let next = left.lock().expect("no thread panics with it").next();
            let Some((place, one)) = next else {
                return found;
            };
            found.extend(emulated_output(data, &axes, one).map(|own| (place, own)));
        }
    };
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let mut found: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let ended = threads.into_iter();
        ended
            .flat_map(|one| one.join().expect("no emulator panics"))
            .collect()
    });
    found.sort_by_key(|(place, _)| *place);
    let (all, indices): (Vec<_>, Vec<_>) = found.into_iter().map(|(_, own)| own).unzip();
    (all, indices.concat())
}

/// Returns the emulator of an output of a design, and the Sobol indices from it; none for too few tests.
fn emulated_output(
    data: &Data<'_>,
    axes: &[Axis<'_>],
    own: OutputOfDesign<'_>,
) -> Option<(Emulated, Vec<Indices>)> {
    let ((output, _, design), study) = (own, data.plan.study());
    let emulator = emulator(data, axes, own)?;
    let mut emulated = Emulated::new(output, data.name_of(design), axes, &emulator);
    emulated.failed = failed(&data.kept_values(own));
    emulated.is_sample = data.is_sample() || matches!(study.design, Design::Adaptive(_));
    let mut indices = Vec::new();
    if emulated.why_not_used().is_none() {
        let population = Population::new(data.plan, &emulator, axes);
        emulated.distribution = Some(Distribution::new(&population.sorted()));
        let own = study.answers.bounds_of(output);
        let chance = |bound| Chance::new(bound, &population, emulated.failed);
        emulated.beyond = own.map(chance).collect();
        // Interactions are averaged over Sobol points, which have no more axes.
        if study.correlations.is_empty() && axes.len() <= MAX_AXES {
            (indices, emulated.main_effects) = of_output(axes, &emulator, &emulated);
        }
    }
    Some((emulated, indices))
}

/// Returns the share of values of tests that failed.
fn failed(values: &[f64]) -> f64 {
    let failed = values.iter().map(|value| f64::from(!value.is_finite()));
    mean(&failed.collect::<Vec<f64>>())
}

/// Returns an emulator of an output of a design from its first tests that are done.
fn emulator(
    data: &Data<'_>,
    axes: &[Axis<'_>],
    (_, values, design): OutputOfDesign<'_>,
) -> Option<Emulator> {
    let done = data.tests_of(design).filter(|row| values[*row].is_finite());
    let places = done.take(MAX_TESTS).map(|row| {
        let columns = axes.iter().zip(&data.inputs);
        let point = columns.map(|(axis, column)| axis.place(column.values[row]));
        (point.collect::<Vec<f64>>(), values[row])
    });
    let (points, values): (Vec<_>, Vec<_>) = places.unzip();
    let [low, high] = extent(values.iter().copied());
    // With fewer tests than lengths, the likeliest lengths mean little.
    if points.len() <= axes.len() + 2 || low == high {
        return None;
    }
    Emulator::fit(&points, &values).map(Emulator::calibrated)
}

impl Emulated {
    fn new(
        output: &Scalar,
        design: Option<String>,
        axes: &[Axis<'_>],
        emulator: &Emulator,
    ) -> Self {
        let range = |axis: &Axis<'_>| Range {
            key: axis.input.key.clone(),
            low: axis.ends[0],
            high: axis.ends[1],
        };
        let exported = Exported {
            output: output.key,
            design: design.clone(),
            q2: emulator.q2(),
            inputs: axes.iter().map(range).collect(),
            model: emulator.model(),
        };
        let tested_and_predicted = emulator.tested_and_predicted();
        Self {
            output: output.key,
            title: output.label,
            unit: output.unit(),
            design,
            tests: tested_and_predicted.len(),
            q2: exported.q2,
            failed: 0.0,
            is_sample: true,
            distribution: None,
            beyond: Vec::new(),
            tested_and_predicted,
            main_effects: Vec::new(),
            exported,
        }
    }

    /// Returns why no answers are computed from it; none if they are.
    pub fn why_not_used(&self) -> Option<String> {
        if !self.is_sample {
            return Some("the tests are not a random sample".to_owned());
        }
        let least = min_tests(self.exported.inputs.len());
        if self.tests < least {
            return Some(format!("fewer than {least} tests"));
        }
        if self.q2 < MIN_Q2 {
            return Some(format!("Q2 is below {MIN_Q2}"));
        }
        let percent = 100.0 * self.failed;
        (self.failed > MAX_FAILED).then(|| format!("{percent:.1} % of the tests failed"))
    }
}

/// Returns the indices and the main effects of the emulator's mean. The intervals of the indices are 1.96 standard errors by the
/// jackknife over groups of tests (Efron 1982) and the part of the variance that the emulator does not explain, to either side.
fn of_output(
    axes: &[Axis<'_>],
    emulator: &Emulator,
    emulated: &Emulated,
) -> (Vec<Indices>, Vec<MainEffect>) {
    let share = |node: usize| (node as f64 + 0.5) / NODES as f64;
    let nodes = |axis: &Axis<'_>| (0..NODES).map(|node| axis.at_share(share(node))).collect();
    let nodes: Vec<Vec<f64>> = axes.iter().map(nodes).collect();
    let (all, effects) = emulator.indices(&nodes);
    let groups = (0..GROUPS).filter_map(|group| emulator.without(|test| test % GROUPS == group));
    let without: Vec<Vec<[f64; 2]>> = groups.map(|one| one.indices(&nodes).0).collect();
    let half_interval = |place: usize, kind: usize| {
        let own: Vec<f64> = without.iter().map(|one| one[place][kind]).collect();
        NORMAL_95 * jackknife_error(&own) + (1.0 - emulated.q2)
    };
    let deviation = emulated.distribution.as_ref();
    let deviation = deviation.map_or(0.0, |own| own.standard_deviation);
    let effects = axes.iter().zip(effects).enumerate();
    let effects = effects.map(|(place, (axis, effect))| {
        let values = (0..NODES).map(|node| number_at_share(axis.input, share(node)));
        let error = half_interval(place, 0).sqrt() * deviation;
        MainEffect {
            error: (error / standard_deviation(&effect)).min(f64::MAX),
            means: values.zip(effect).collect(),
        }
    });
    let effects = effects.collect();
    let index = |(place, axis): (usize, &Axis<'_>)| {
        let interval = |kind: usize| {
            let half = half_interval(place, kind);
            [-half, half].map(|by| (all[place][kind] + by).clamp(0.0, 1.0))
        };
        Indices {
            output: emulated.output,
            design: emulated.design.clone(),
            input: axis.input.key.clone(),
            // Rounding may leave the index of an inactive input below 0.
            first: all[place][0].max(0.0),
            first_interval: interval(0),
            total: all[place][1].max(0.0),
            total_interval: interval(1),
            bases: emulated.tests,
        }
    };
    let indices = axes.iter().enumerate().map(index).collect();
    (indices, effects)
}

fn jackknife_error(without: &[f64]) -> f64 {
    let (mean, count) = (mean(without), without.len() as f64);
    let squares: f64 = without.iter().map(|one| (one - mean).powi(2)).sum();
    ((count - 1.0) / count * squares).sqrt()
}

impl Chance {
    /// Of the share of tests that `failed`, all may be beyond the limit.
    fn new(bound: &Bound, population: &Population<'_>, failed: f64) -> Self {
        let excess = |value: f64| bound.distance(value);
        let points = population.points(&excess);
        let found = population.beyond(&points, &excess).with_failed(failed);
        let Estimate { value, interval } = found;
        Self {
            least: bound.least,
            most: bound.most,
            probability: value,
            interval,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_case::study::{Input, UniformKeys, Variation};
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
        let axis = || Axis::new(&input, [0.0, 1.0]);
        let axes: Vec<Axis<'_>> = exact.iter().map(|_| axis()).collect();
        let mut inside = Vec::new();
        for seed in 1..=10 {
            let tests = points(count, exact.len(), seed);
            let emulator = Emulator::fit(&tests, &values(&tests, of)).unwrap();
            let emulated = Emulated::new(&MASS_LOSS_MG, None, &axes, &emulator);
            if emulated.q2 < MIN_Q2 {
                continue;
            }
            for (found, exact) in of_output(&axes, &emulator, &emulated).0.iter().zip(exact) {
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
