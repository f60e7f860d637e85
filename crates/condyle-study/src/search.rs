//! A search for the optimum within limits: emulators of the outputs propose the tests.

use std::f64::consts::PI;

use condyle_case::{
    config::Level,
    study::{Bound, Design, Input, OptimiseKeys, Study, Variation},
};
use condyle_results::catalogue;
use nalgebra::DVector;
use serde::Serialize;

use crate::{
    descent::minimum,
    design::sobol::sobol_places,
    distribution::{Place, normal_quantile, normal_share},
    emulator::Emulator,
    plan::{Plan, Test, TestResult, output_value},
    random::Random,
    statistics::extent,
};

/// Tests proposed together: they run at the same time, and the table must not depend on the number of threads.
const BATCH: usize = 2;
/// The first tests, a space-filling design, for each input.
const FIRST_TESTS_PER_INPUT: usize = 3;
/// A search ends once another test is expected to improve the optimum by less than this part of the range of the
/// minimised output within the limits.
const MIN_IMPROVEMENT: f64 = 1e-4;

/// A stored test.
type Known = (Test, TestResult);

/// Returns the next tests of a search after the `known` ones, which are rows 0, 1, 2 and so on; none at its end. They
/// depend on `known` and the seed alone, so that a resumed search continues as if it had not stopped.
pub(crate) fn next_tests(plan: &Plan, known: &[Known]) -> Option<Vec<Test>> {
    let Design::Optimise(keys) = &plan.study().design else {
        return None;
    };
    let (axes, size) = (plan.study().inputs.len(), keys.size as usize);
    if known.len() >= size {
        return None;
    }
    let first = first_tests(axes, size);
    if known.len() < first {
        let points = space_filling(0..first, axes, keys.seed);
        let mut places: Vec<Vec<Place>> = points.map(|point| along_all(&point)).collect();
        if is_case_inside(plan.study()) {
            places[0] = vec![Place::OfCase; axes];
        }
        return Some(tests_at(plan, 0, places));
    }
    // A batch that was interrupted is proposed again from the tests before it.
    let whole = known.len() - (known.len() - first) % BATCH;
    let observed = Observed::new(plan, keys, &known[..whole]);
    let points = observed.proposals(BATCH.min(size - whole), keys.seed)?;
    let places = points.iter().map(|point| along_all(point));
    Some(tests_at(plan, whole, places.collect()))
}

fn first_tests(axes: usize, size: usize) -> usize {
    (FIRST_TESTS_PER_INPUT * axes).max(6).min(size / 2)
}

fn along_all(point: &[f64]) -> Vec<Place> {
    point.iter().copied().map(Place::Along).collect()
}

/// Returns tests at places, from row `first` on.
fn tests_at(plan: &Plan, first: usize, places: Vec<Vec<Place>>) -> Vec<Test> {
    let test = |(row, places): (u64, Vec<Place>)| Test {
        row,
        alternative: 0,
        values: plan.values_at(&places),
    };
    (first as u64..).zip(places).map(test).collect()
}

/// Returns the place of a value in the range of its input, 0 to 1.
fn along(input: &Input, value: Option<&Level>) -> Option<f64> {
    match (&input.variation, value?) {
        (Variation::Uniform(keys), Level::Number(value)) => {
            Some((value - keys.low) / (keys.high - keys.low))
        }
        _ => None,
    }
}

/// Returns whether the case itself lies within the ranges.
fn is_case_inside(study: &Study) -> bool {
    let mut places = study
        .inputs
        .iter()
        .map(|input| along(input, study.value_of_case(input).as_ref()));
    places.all(|place| place.is_some_and(|place| (0.0..=1.0).contains(&place)))
}

/// Returns rows of scrambled Sobol points.
fn space_filling(
    rows: impl Iterator<Item = usize>,
    axes: usize,
    seed: u64,
) -> impl Iterator<Item = Vec<f64>> {
    let share = |place| match place {
        Place::Share(share) | Place::Along(share) => share,
        Place::OfCase => 0.5,
    };
    rows.map(move |row| {
        sobol_places(row as u64, axes, seed)
            .into_iter()
            .map(share)
            .collect()
    })
}

/// The state of a search after its tests.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Standing {
    /// The improvement expected from the most promising test, with doubled standard deviations.
    pub expected_improvement: f64,
    /// True if it is too small for another test.
    pub is_converged: bool,
    /// Q2 of the emulator of the minimised output.
    pub q2: f64,
    /// The best test less its prediction from the other tests.
    pub left_out_error: f64,
}

/// Returns the state of a search; none for other studies, and while no test is within the limits.
pub(crate) fn standing(plan: &Plan, known: &[Known]) -> Option<Standing> {
    let Design::Optimise(keys) = &plan.study().design else {
        return None;
    };
    let observed = Observed::new(plan, keys, known);
    let emulators = Emulators::new(&observed)?;
    let (best, _) = emulators.best?;
    let (_, worth) = emulators.most_promising(&observed, WIDE, keys.seed)?;
    Some(Standing {
        expected_improvement: worth.exp(),
        is_converged: observed.is_converged(worth),
        q2: emulators.minimised.q2(),
        left_out_error: emulators.minimised.left_out()[best].mean,
    })
}

/// Tests in the unit cube.
#[derive(Clone, Default)]
struct Observed {
    points: Vec<Vec<f64>>,
    /// The minimised output; NaN for a test that failed.
    minimised: Vec<f64>,
    /// For each limit, the amount by which a test exceeds it; negative within the limit.
    excess: Vec<Vec<f64>>,
}

impl Observed {
    fn new(plan: &Plan, keys: &OptimiseKeys, known: &[Known]) -> Self {
        let study = plan.study();
        let point = |(test, _): &Known| {
            let values = study.inputs.iter().zip(&test.values);
            let places = values.map(|(input, value)| along(input, value.as_ref()).unwrap_or(0.5));
            places.collect()
        };
        let values = |of: &dyn Fn(&[f64]) -> f64| {
            let values = known.iter();
            let values = values.map(|(_, result)| {
                result
                    .as_ref()
                    .map_or(f64::NAN, |outputs| of(&outputs.values))
            });
            values.collect::<Vec<f64>>()
        };
        let minimised = catalogue::output(&keys.minimise);
        let sides = |bound: &Bound| {
            let least = bound.least.map(|least| (bound.output, -1.0, least));
            let most = bound.most.map(|most| (bound.output, 1.0, most));
            [least, most].into_iter().flatten()
        };
        let sides = study.answers.bounds.iter().flat_map(sides);
        Self {
            points: known.iter().map(point).collect(),
            minimised: values(&|all| minimised.map_or(f64::NAN, |one| output_value(all, one))),
            excess: sides
                .map(|(output, sign, limit)| {
                    values(&|all| sign * (output_value(all, output) - limit))
                })
                .collect(),
        }
    }

    /// Returns whether a test is done and within all limits.
    fn is_within(&self, place: usize) -> bool {
        self.minimised[place].is_finite() && self.excess.iter().all(|excess| excess[place] <= 0.0)
    }

    /// Returns the test with the smallest output within all limits, and this output.
    fn best(&self) -> Option<(usize, f64)> {
        let all = self.minimised.iter().copied().enumerate();
        let within = all.filter(|(place, _)| self.is_within(*place));
        within.min_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Returns whether the logarithm of an expected improvement is too small for another test.
    fn is_converged(&self, worth: f64) -> bool {
        let tests = self.minimised.iter().enumerate();
        let within = tests.filter(|(place, _)| self.is_within(*place));
        let [low, high] = extent(within.map(|(_, value)| *value));
        worth < (MIN_IMPROVEMENT * (high - low)).ln()
    }

    /// Returns `count` points for the next tests: the optimum that the emulators predict, and the points at which an
    /// improvement is likeliest, each as if the emulators had predicted those before it exactly (Ginsbourger, Le Riche and
    /// Carraro 2010). None once the search has converged; without emulators, the next space-filling points.
    fn proposals(&self, count: usize, seed: u64) -> Option<Vec<Vec<f64>>> {
        let axes = self.points.first().map_or(0, Vec::len);
        let filling = |row: usize| space_filling(row..row + 1, axes, seed).next();
        let Some(mut emulators) = Emulators::new(self) else {
            return (self.points.len()..self.points.len() + count)
                .map(filling)
                .collect();
        };
        let (mut points, mut proposals) = (self.points.clone(), Vec::new());
        for number in 0..count {
            let explored = emulators.most_promising(self, WIDE, seed);
            let is_end =
                |(_, worth): &(_, f64)| emulators.best.is_some() && self.is_converged(*worth);
            if number == 0 && explored.as_ref().is_some_and(is_end) {
                return None;
            }
            let predicted = (number == 0).then(|| emulators.most_promising(self, SHARP, seed));
            let new = [predicted.flatten(), explored].into_iter().flatten();
            let new = new
                .map(|(point, _)| point)
                .find(|point| is_new(point, &points));
            let point = new.or_else(|| filling(points.len()))?;
            emulators = emulators.believing(&point)?;
            points.push(point.clone());
            proposals.push(point);
        }
        Some(proposals)
    }
}

/// Points closer than this along every axis are the same test.
const MIN_DISTANCE: f64 = 1e-5;

fn is_new(point: &[f64], points: &[Vec<f64>]) -> bool {
    let differs = |other: &Vec<f64>| {
        let mut axes = point.iter().zip(other);
        axes.any(|(one, other)| (one - other).abs() > MIN_DISTANCE)
    };
    points.iter().all(differs)
}

/// Factor of all standard deviations where the optimum that the emulators predict is tested: it then lies within the
/// predicted limits by about this part of them.
const SHARP: f64 = 0.1;
/// Factor of all standard deviations where the search explores: with few tests, those of the emulators are too small
/// far from all tests, and a search that trusts them ends too early.
const WIDE: f64 = 2.0;
/// Points of which the most promising are starts, for each input, and around the best test.
const CANDIDATES_PER_INPUT: usize = 64;
const CANDIDATES_AROUND: usize = 64;
const STARTS: usize = 6;
const MAX_STEPS: usize = 60;
/// Step of the differences that give the slope of the worth.
const DIFFERENCE: f64 = 1e-6;

/// Emulators of the minimised output and of the excess over each limit, and for tests that failed also of the failure.
struct Emulators {
    minimised: Emulator,
    limits: Vec<Emulator>,
    best: Option<(usize, f64)>,
    best_point: Option<Vec<f64>>,
}

impl Emulators {
    /// Fits the emulators; none while too few tests are done.
    fn new(observed: &Observed) -> Option<Self> {
        let is_done: Vec<bool> = observed
            .minimised
            .iter()
            .map(|value| value.is_finite())
            .collect();
        let of_done = |values: &[f64]| -> Vec<f64> {
            let both = values.iter().zip(&is_done);
            both.filter(|(_, is)| **is)
                .map(|(value, _)| *value)
                .collect()
        };
        let points = observed.points.iter().zip(&is_done);
        let points = points
            .filter(|(_, is)| **is)
            .map(|(point, _)| point.clone());
        let points: Vec<Vec<f64>> = points.collect();
        let excess = observed.excess.iter();
        let limits = excess.map(|excess| Emulator::fit(&points, &of_done(excess)));
        let mut limits: Vec<Emulator> = limits.collect::<Option<_>>()?;
        if is_done.contains(&false) {
            // Half way between a test that failed and one that was done lies the limit.
            let failure = is_done.iter().map(|is| if *is { -0.5 } else { 0.5 });
            limits.push(Emulator::fit(
                &observed.points,
                &failure.collect::<Vec<_>>(),
            )?);
        }
        let best = observed.best();
        Some(Self {
            minimised: Emulator::fit(&points, &of_done(&observed.minimised))?,
            limits,
            // Places count the tests that are done, as those of the emulator do.
            best: best
                .map(|(place, value)| (is_done[..place].iter().filter(|is| **is).count(), value)),
            best_point: best.map(|(place, _)| observed.points[place].clone()),
        })
    }

    /// Returns the logarithm of the worth of a test: its expected improvement of the best test (Jones, Schonlau and Welch
    /// 1998) times the probability that it keeps all limits (Schonlau, Welch and Jones 1998); without a best test, the
    /// probability alone. `share` multiplies the standard deviations of all predictions.
    fn worth(&self, point: &[f64], share: f64) -> f64 {
        let deviation = |deviation: f64| (share * deviation).max(f64::MIN_POSITIVE);
        let limits = self.limits.iter().map(|limit| {
            let excess = limit.predict(point);
            log_share(-excess.mean / deviation(excess.standard_deviation))
        });
        let limits: f64 = limits.sum();
        let Some((_, best)) = self.best else {
            return limits;
        };
        let found = self.minimised.predict(point);
        let scale = deviation(found.standard_deviation);
        limits + scale.ln() + log_improvement((best - found.mean) / scale)
    }

    /// Returns the point of the largest worth and the worth there: the best descent from the most promising of many
    /// points; none if no point has a finite worth.
    fn most_promising(
        &self,
        observed: &Observed,
        share: f64,
        seed: u64,
    ) -> Option<(Vec<f64>, f64)> {
        let candidates = self.candidates(observed, seed);
        let axes = observed.points[0].len();
        let mut starts: Vec<(f64, Vec<f64>)> = candidates
            .into_iter()
            .map(|point| (self.worth(&point, share), point))
            .filter(|(worth, _)| worth.is_finite())
            .collect();
        starts.sort_by(|one, other| other.0.total_cmp(&one.0));
        let worthless = |point: &DVector<f64>| {
            let worthless = |point: &DVector<f64>| -self.worth(point.as_slice(), share);
            Some((worthless(point), slope(&worthless, point)?))
        };
        let ends = [0.0, 1.0].map(|end| DVector::from_element(axes, end));
        let ascents = starts.into_iter().take(STARTS).filter_map(|(_, point)| {
            minimum(
                &worthless,
                DVector::from_vec(point),
                [&ends[0], &ends[1]],
                MAX_STEPS,
            )
        });
        let most = ascents.min_by(|one, other| one.1.total_cmp(&other.1))?;
        Some((most.0.as_slice().to_vec(), -most.1))
    }

    /// Returns space-filling points and points around the best test, others after every test.
    fn candidates(&self, observed: &Observed, seed: u64) -> Vec<Vec<f64>> {
        let (axes, row) = (observed.points[0].len(), observed.points.len());
        let count = CANDIDATES_PER_INPUT * axes;
        let filling = space_filling(row * count..(row + 1) * count, axes, seed);
        filling.chain(self.around_best(seed, row)).collect()
    }

    /// Returns points around the best test, at distances that decrease from a fifth of the ranges.
    fn around_best(&self, seed: u64, row: usize) -> Vec<Vec<f64>> {
        let mut numbers = Random::stream(seed, row as u64);
        let mut around = |number: usize| {
            let distance = 0.2 * 0.5_f64.powi((number % 8) as i32);
            let mut moved =
                |one: &f64| (one + distance * normal_quantile(numbers.share())).clamp(0.0, 1.0);
            let best = self.best_point.iter().flatten();
            best.map(&mut moved).collect::<Vec<f64>>()
        };
        let count = if self.best_point.is_some() {
            CANDIDATES_AROUND
        } else {
            0
        };
        (0..count).map(&mut around).collect()
    }

    /// Returns the emulators after a test with the results that they predict.
    fn believing(&self, point: &[f64]) -> Option<Self> {
        let believing = |one: &Emulator| one.with_test(point.to_vec(), one.predict(point).mean);
        Some(Self {
            minimised: believing(&self.minimised)?,
            limits: self.limits.iter().map(believing).collect::<Option<_>>()?,
            best: self.best,
            best_point: self.best_point.clone(),
        })
    }
}

/// Returns the slope of a function, by central differences; none if it is not finite.
fn slope(of: &dyn Fn(&DVector<f64>) -> f64, point: &DVector<f64>) -> Option<DVector<f64>> {
    let slope = DVector::from_fn(point.len(), |axis, _| {
        let moved = |by| of(&moved(point, axis, by));
        (moved(DIFFERENCE) - moved(-DIFFERENCE)) / (2.0 * DIFFERENCE)
    });
    slope.iter().all(|one| one.is_finite()).then_some(slope)
}

fn moved(point: &DVector<f64>, axis: usize, by: f64) -> DVector<f64> {
    let mut moved = point.clone();
    moved[axis] += by;
    moved
}

/// Below this, the tails of the normal distribution follow from their asymptotic series to seven digits.
const TAIL: f64 = -20.0;

/// Returns the logarithm of the standard normal density.
fn log_density(z: f64) -> f64 {
    -0.5 * (z * z + (2.0 * PI).ln())
}

/// Returns the logarithm of the share of the standard normal distribution below `z`.
fn log_share(z: f64) -> f64 {
    if z > TAIL {
        return normal_share(z).ln();
    }
    let square = 1.0 / (z * z);
    log_density(z) - (-z).ln() + (1.0 - square * (1.0 - square * (3.0 - 15.0 * square))).ln()
}

/// Returns the logarithm of the expectation of max(0, z - t) for a standard normal t: of density(z) + z share(z), which
/// underflows far from the best test (Ament et al. 2023).
fn log_improvement(z: f64) -> f64 {
    if z > TAIL {
        return (log_density(z).exp() + z * normal_share(z)).ln();
    }
    let square = 1.0 / (z * z);
    log_density(z) + square.ln() + (1.0 - square * (3.0 - square * (15.0 - 105.0 * square))).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An output to be minimised, and what must not be positive.
    type Problem = fn(&[f64]) -> (f64, Vec<f64>);

    /// Returns the best output within the limits, and the number of tests until the search ended.
    fn searched(problem: Problem, axes: usize, size: usize, seed: u64) -> (f64, usize) {
        let mut observed = Observed::default();
        let test = |observed: &mut Observed, point: Vec<f64>| {
            let (value, excess) = problem(&point);
            observed.excess.resize(excess.len(), Vec::new());
            observed.points.push(point);
            observed.minimised.push(value);
            for (all, one) in observed.excess.iter_mut().zip(excess) {
                all.push(one);
            }
        };
        for point in space_filling(0..first_tests(axes, size), axes, seed) {
            test(&mut observed, point);
        }
        while observed.points.len() < size {
            let left = BATCH.min(size - observed.points.len());
            let Some(points) = observed.proposals(left, seed) else {
                break;
            };
            points
                .into_iter()
                .for_each(|point| test(&mut observed, point));
        }
        (
            observed.best().map_or(f64::NAN, |best| best.1),
            observed.points.len(),
        )
    }

    /// Branin's function, with three optima.
    fn branin(x: &[f64]) -> (f64, Vec<f64>) {
        let (x, y) = (15.0 * x[0] - 5.0, 15.0 * x[1]);
        let b = y - 5.1 / (4.0 * PI * PI) * x * x + 5.0 / PI * x - 6.0;
        (
            b * b + 10.0 * (1.0 - 1.0 / (8.0 * PI)) * x.cos() + 10.0,
            Vec::new(),
        )
    }

    /// Hartmann's function of six inputs.
    fn hartmann(x: &[f64]) -> (f64, Vec<f64>) {
        const A: [[f64; 6]; 4] = [
            [10.0, 3.0, 17.0, 3.5, 1.7, 8.0],
            [0.05, 10.0, 17.0, 0.1, 8.0, 14.0],
            [3.0, 3.5, 1.7, 10.0, 17.0, 8.0],
            [17.0, 8.0, 0.05, 10.0, 0.1, 14.0],
        ];
        const P: [[f64; 6]; 4] = [
            [0.1312, 0.1696, 0.5569, 0.0124, 0.8283, 0.5886],
            [0.2329, 0.4135, 0.8307, 0.3736, 0.1004, 0.9991],
            [0.2348, 0.1451, 0.3522, 0.2883, 0.3047, 0.6650],
            [0.4047, 0.8828, 0.8732, 0.5743, 0.1091, 0.0381],
        ];
        let term = |place: usize| {
            let squares = (0..6).map(|axis| A[place][axis] * (x[axis] - P[place][axis]).powi(2));
            (-squares.sum::<f64>()).exp()
        };
        let weights = [1.0, 1.2, 3.0, 3.2].into_iter().enumerate();
        (
            -weights
                .map(|(place, weight)| weight * term(place))
                .sum::<f64>(),
            Vec::new(),
        )
    }

    /// G6: a narrow feasible crescent.
    fn g6(x: &[f64]) -> (f64, Vec<f64>) {
        let (x, y) = (13.0 + 87.0 * x[0], 100.0 * x[1]);
        let limits = vec![
            100.0 - (x - 5.0).powi(2) - (y - 5.0).powi(2),
            (x - 6.0).powi(2) + (y - 5.0).powi(2) - 82.81,
        ];
        ((x - 10.0).powi(3) + (y - 20.0).powi(3), limits)
    }

    /// G8: several optima within two limits.
    fn g8(x: &[f64]) -> (f64, Vec<f64>) {
        let (x, y) = (10.0 * x[0].max(1e-3), 10.0 * x[1]);
        let waves = (2.0 * PI * x).sin().powi(3) * (2.0 * PI * y).sin();
        let limits = vec![x * x - y + 1.0, 1.0 - x + (y - 4.0).powi(2)];
        (-waves / (x.powi(3) * (x + y)), limits)
    }

    /// G24: a feasible region of two parts.
    fn g24(x: &[f64]) -> (f64, Vec<f64>) {
        let (x, y) = (3.0 * x[0], 4.0 * x[1]);
        let limits = vec![
            -2.0 * x.powi(4) + 8.0 * x.powi(3) - 8.0 * x * x + y - 2.0,
            -4.0 * x.powi(4) + 32.0 * x.powi(3) - 88.0 * x * x + 96.0 * x + y - 36.0,
        ];
        (-x - y, limits)
    }

    /// G4: five inputs and six limits.
    fn g4(x: &[f64]) -> (f64, Vec<f64>) {
        let at = |axis: usize, low: f64, high: f64| low + x[axis] * (high - low);
        let [a, b] = [at(0, 78.0, 102.0), at(1, 33.0, 45.0)];
        let [c, d, e] = [2, 3, 4].map(|axis| at(axis, 27.0, 45.0));
        let u = 85.334407 + 0.0056858 * b * e + 0.0006262 * a * d - 0.0022053 * c * e;
        let v = 80.51249 + 0.0071317 * b * e + 0.0029955 * a * b + 0.0021813 * c * c;
        let w = 9.300961 + 0.0047026 * c * e + 0.0012547 * a * c + 0.0019085 * c * d;
        let limits = vec![u - 92.0, -u, v - 110.0, 90.0 - v, w - 25.0, 20.0 - w];
        (
            5.3578547 * c * c + 0.8356891 * a * e + 37.293239 * a - 40792.141,
            limits,
        )
    }

    /// A bowl that cannot be computed beyond a line through its bottom.
    fn broken_bowl(x: &[f64]) -> (f64, Vec<f64>) {
        let bowl = (x[0] - 0.7).powi(2) + (x[1] - 0.4).powi(2);
        let is_broken = x[0] + x[1] > 1.0;
        (if is_broken { f64::NAN } else { bowl }, Vec::new())
    }

    #[test]
    fn verify_global_optima() {
        // The optima are those of Surjanovic and Bingham (2013) and, of G problems, of Liang et al. (2006).
        let problems: [(Problem, usize, usize, f64, f64); 7] = [
            (branin, 2, 40, 0.397_887, 1e-3),
            (g4, 5, 40, -30_665.539, 1.0),
            (g6, 2, 60, -6961.814, 30.0),
            (g8, 2, 60, -0.095_825, 0.04),
            (g24, 2, 40, -5.508_013, 1e-3),
            (broken_bowl, 2, 40, 0.005, 0.005),
            // The second of its optima, which is 4 % higher, is the best of most searches with so few tests.
            (hartmann, 6, 80, -3.203_16, 0.02),
        ];
        for (problem, axes, size, optimum, within) in problems {
            for seed in 1..=3 {
                let (found, tests) = searched(problem, axes, size, seed);
                println!("seed {seed}: {found:.6} for {optimum} after {tests} tests");
                assert!(found < optimum + within, "{found} {optimum}, seed {seed}");
            }
        }
    }

    #[test]
    fn verify_logarithms_in_the_tails() {
        // Both formulas agree where they meet, and those of the centre with the definition.
        for of in [log_share, log_improvement] {
            let [below, above] = [TAIL - 1e-9, TAIL + 1e-9].map(of);
            assert!((below - above).abs() < 1e-6, "{below} {above}");
        }
        assert!((log_share(0.0) - 0.5_f64.ln()).abs() < 1e-15);
        assert!((log_improvement(0.0) + 0.5 * (2.0 * PI).ln()).abs() < 1e-14);
    }
}
