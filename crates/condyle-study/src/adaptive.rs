//! Adaptive designs: tests are added where the emulator of an output is least certain, until the output, or its probability
//! of being beyond a limit, is known to the given accuracy.

use std::iter;

use condyle_case::study::Design;
use condyle_results::split_unit;
use nalgebra::DMatrix;
use serde::Serialize;

use crate::{
    answers::{
        emulated::{MIN_Q2, min_tests},
        words::{chance_in_words, shown},
    },
    design::sobol::sobol_places,
    emulator::Emulator,
    error::StudyError,
    plan::{Plan, Test},
    population::{Axis, Point, Population},
    search::{Estimate, Known, ends, first_tests, is_new, point, tests_at, value},
    statistics::quantile,
    store::Store,
};

/// Fraction of the errors that are at most as large as the stated error.
const SHARE: f64 = 0.9;
/// The quantile of the standard normal distribution that this share of the magnitudes stays below.
const NORMAL_90: f64 = 1.644_854;
/// Points of the inputs' distributions at which tests are added, and over which errors are counted.
const POOL: usize = 512;

/// The state of an adaptive study after its tests.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Aim {
    pub output: &'static str,
    pub title: &'static str,
    /// The limit, with the sign of the side beyond it, if its probability is to be known.
    pub limit: Option<(f64, f64)>,
    /// The part of the output that its errors may reach; of a probability, the factor less 1.
    pub part: f64,
    /// The part of the output that 90 % of the emulator's errors stay below, by the tests and by the predicted standard
    /// deviations; of a probability, the largest factor, less 1, between it and an end of its interval. None while too few tests
    /// are done for an emulator.
    pub error: Option<f64>,
    /// The probability of being beyond the limit.
    pub probability: Option<Estimate>,
    /// True if there are enough tests, and the error was within the part before the last batch as well: with few tests it may be by
    /// chance.
    pub is_known: bool,
    pub tests: usize,
    /// The smallest number of tests after which the output may be known.
    pub least_tests: usize,
}

/// Returns the next tests of an adaptive study after the `known` ones, which are rows 0, 1, 2 and so on; none at its end.
/// They depend on `known` and the seed alone, so that a resumed study continues as if it had not stopped.
pub(crate) fn next_tests(plan: &Plan, known: &[Known]) -> Option<Vec<Test>> {
    let Design::Adaptive(keys) = &plan.study().design else {
        return None;
    };
    let (axes, size) = (plan.study().inputs.len(), keys.size as usize);
    let first = first_tests(axes).min(size);
    if known.len() < first {
        return Some(sobol_tests(plan, keys.seed, 0, first));
    }
    // A batch that was interrupted is proposed again from the tests before it.
    let whole = batches(axes).take_while(|tests| *tests <= known.len());
    let whole = whole.last().unwrap_or(first);
    let (aim, seen) = standing(plan, &known[..whole])?;
    if known.len() >= size || aim.is_known {
        return None;
    }
    let next = batches(axes).find(|tests| *tests > whole)?.min(size);
    let tests = match seen {
        Some(seen) => seen.least_certain(next - whole),
        None => sobol_tests(plan, keys.seed, whole, next),
    };
    Some(tests).filter(|tests| !tests.is_empty())
}

/// Returns the state of an adaptive study and the emulator of its output, if there are enough tests
/// for one; `None` for other studies.
fn standing(plan: &Plan, known: &[Known]) -> Option<(Aim, Option<Seen>)> {
    let goal = plan.study().aim()?;
    let before = batches(plan.study().inputs.len());
    let before = before.take_while(|tests| *tests < known.len()).last();
    let seen = |tests: usize| Seen::new(plan, &known[..tests]);
    // The errors of an output are those of its tests, and too few may be good by chance; a probability is counted over predictions,
    // which must be good.
    let least = min_tests(plan.study().inputs.len());
    let is_good = |seen: &Seen| {
        let is_exact = goal.limit.is_none() || seen.emulator.q2() >= MIN_Q2;
        is_exact && seen.tests() >= least
    };
    let is_within = |seen: &Option<Seen>| {
        seen.as_ref()
            .is_some_and(|seen| seen.error <= goal.part && is_good(seen))
    };
    let last = seen(known.len());
    let aim = Aim {
        output: goal.output.key,
        title: goal.output.label,
        limit: goal.limit,
        part: goal.part,
        error: last.as_ref().map(|seen| seen.error),
        probability: last.as_ref().and_then(|seen| seen.probability),
        is_known: is_within(&last) && before.is_some_and(|tests| is_within(&seen(tests))),
        tests: known.len(),
        least_tests: least,
    };
    Some((aim, last))
}

/// Returns the numbers of tests after each batch. A batch has a quarter of the tests before it: enough to keep many workers
/// busy, whose number it must not depend on.
fn batches(axes: usize) -> impl Iterator<Item = usize> {
    let next = |tests: &usize| Some(tests + (tests / 4).max(2));
    iter::successors(Some(first_tests(axes)), next)
}

/// Returns tests at scrambled Sobol points of the inputs' distributions, from row `first` on.
fn sobol_tests(plan: &Plan, seed: u64, first: usize, end: usize) -> Vec<Test> {
    let axes = plan.study().inputs.len();
    let places = |row| plan.correlated(sobol_places(row, axes, seed));
    let places = (first as u64..end as u64).map(places);
    tests_at(plan, first, places.collect())
}

/// The tests of an adaptive study in the unit cube, and the emulator of its output.
struct Seen {
    points: Vec<Vec<f64>>,
    emulator: Emulator,
    /// The part of the output, or of its probability, that is not known.
    error: f64,
    probability: Option<Estimate>,
    /// Points at which tests may be added, and over which the variance is to become small.
    pool: Vec<Test>,
    /// The same in the unit cube.
    places: Vec<Vec<f64>>,
    /// Tests that failed, in the unit cube.
    failed: Vec<Vec<f64>>,
}

impl Seen {
    /// Returns the number of tests that are done.
    fn tests(&self) -> usize {
        self.points.len() - self.failed.len()
    }

    /// Fits the emulator; none while fewer tests are done than it has lengths.
    fn new(plan: &Plan, known: &[Known]) -> Option<Self> {
        let study = plan.study();
        let (Design::Adaptive(keys), Some(goal)) = (&study.design, study.aim()) else {
            return None;
        };
        let points: Vec<Vec<f64>> = known.iter().map(|(test, _)| point(study, test)).collect();
        let values: Vec<f64> = known
            .iter()
            .map(|one| value(study, one, goal.output))
            .collect();
        let tests = points.iter().cloned().zip(values);
        let (done, failed): (Vec<_>, Vec<_>) = tests.partition(|(_, value)| value.is_finite());
        let (at, of): (Vec<Vec<f64>>, Vec<f64>) = done.into_iter().unzip();
        if at.len() <= study.inputs.len() + 2 {
            return None;
        }
        let emulator = Emulator::fit(&at, &of)?.calibrated();
        let (pool, probability) = match goal.limit {
            Some(limit) => {
                let (pool, found) = near_limit(plan, &emulator, limit);
                let share = failed.len() as f64 / known.len() as f64;
                (pool, found.map(|found| found.with_failed(share)))
            }
            // Another scrambling than that of the first tests.
            None => (sobol_tests(plan, !keys.seed, 0, POOL), None),
        };
        let places: Vec<Vec<f64>> = pool.iter().map(|test| point(study, test)).collect();
        let error = match &probability {
            // The largest factor, less 1, between the probability and an end of its interval.
            Some(Estimate { value, interval }) => {
                (value / interval[0]).max(interval[1] / value) - 1.0
            }
            None => error_of_output(&emulator, &of, &places),
        };
        Some(Self {
            points,
            emulator,
            error,
            probability,
            places,
            pool,
            failed: failed.into_iter().map(|(point, _)| point).collect(),
        })
    }

    /// Returns `count` tests of the pool, each of which lowers the variance summed over the pool most (Cohn 1996): that of the
    /// process conditioned on all tests, on those that failed as if they had been done, and on those added before.
    fn least_certain(&self, count: usize) -> Vec<Test> {
        let mut all = self.places.clone();
        all.extend(self.failed.iter().cloned());
        let (_, mut covariance) = self.emulator.joint(&all);
        let nugget = self.emulator.joint_nugget();
        let condition = |covariance: &mut DMatrix<f64>, place: usize| {
            let column = covariance.column(place).into_owned();
            covariance.ger(-1.0 / (column[place] + nugget), &column, &column, 1.0);
        };
        (POOL..all.len()).for_each(|place| condition(&mut covariance, place));
        let mut left: Vec<usize> = (0..POOL).collect();
        left.retain(|place| is_new(&all[*place], &self.points));
        let first = self.points.len() as u64;
        let next = |row| {
            let gain = |place: &usize| {
                let column = covariance.column(*place);
                column.rows(0, POOL).norm_squared() / (column[*place] + nugget)
            };
            let gains = left.iter().map(|place| (gain(place), *place));
            let (_, best) = gains.max_by(|one, other| one.0.total_cmp(&other.0))?;
            condition(&mut covariance, best);
            // Inputs with few levels have the same point more than once.
            left.retain(|place| is_new(&all[*place], std::slice::from_ref(&all[best])));
            Some(Test {
                row,
                ..self.pool[best].clone()
            })
        };
        (first..first + count as u64).map_while(next).collect()
    }
}

/// Returns the part of an output that 90 % of the emulator's errors stay below: the larger of that of tests predicted from all
/// others, whose outputs are `done`, and that of predictions at `places` by their standard deviations.
fn error_of_output(emulator: &Emulator, done: &[f64], places: &[Vec<f64>]) -> f64 {
    let part = |error: f64, value: f64| error / value.abs().max(f64::MIN_POSITIVE);
    let left_out = emulator.left_out().into_iter().zip(done);
    let left_out = left_out.map(|(one, value)| part(one.mean.abs(), *value));
    let noise = emulator.noise();
    let predicted = places.iter().map(|place| {
        let found = emulator.predict(place);
        let deviation = found.standard_deviation.hypot(noise);
        part(NORMAL_90 * deviation, found.mean)
    });
    let all: [Vec<f64>; 2] = [left_out.collect(), predicted.collect()];
    let percentiles = all.map(|mut parts| {
        parts.sort_by(f64::total_cmp);
        quantile(&parts, SHARE)
    });
    percentiles.into_iter().fold(0.0, f64::max)
}

/// Returns tests at points whose side of a limit is least certain, and the probability of being beyond it.
fn near_limit(
    plan: &Plan,
    emulator: &Emulator,
    (sign, limit): (f64, f64),
) -> (Vec<Test>, Option<Estimate>) {
    let inputs = plan.study().inputs.iter();
    let axes: Vec<Axis<'_>> = inputs.map(|input| Axis::new(input, ends(input))).collect();
    let population = Population::new(plan, emulator, &axes);
    let excess = |value: f64| sign * (value - limit);
    let mut points = population.points(&excess);
    let probability = population.beyond(&points, &excess);
    let certainty = |point: &Point| point.deviations().abs();
    points.sort_by(|one, other| certainty(one).total_cmp(&certainty(other)));
    let places = points[..POOL]
        .iter()
        .map(|point| population.places(point.row));
    (tests_at(plan, 0, places.collect()), Some(probability))
}

impl Aim {
    pub fn read(plan: &Plan, store: &Store) -> Result<Option<Self>, StudyError> {
        // Other studies may have many tests.
        if plan.study().aim().is_none() {
            return Ok(None);
        }
        let standing = standing(plan, &store.known(plan, 0)?);
        Ok(standing.map(|(aim, _)| aim))
    }

    /// Returns the state in a sentence.
    pub fn sentence(&self) -> String {
        // Without the rounding error of the division by 100.
        let rounded = |value: f64| (1e4 * value).round() / 1e4;
        let (title, tests) = (self.title, self.tests);
        let what = self.limit.map_or_else(
            || title.to_owned(),
            |(sign, limit)| {
                let side = if sign > 0.0 { "above" } else { "below" };
                let unit = split_unit(self.output).1.unwrap_or_default();
                format!("probability of a {title} {side} {limit} {unit}")
                    .trim_end()
                    .to_owned()
            },
        );
        let accuracy = match self.limit {
            None => format!("{} %", rounded(100.0 * self.part)),
            Some(_) => format!("a factor of {}", rounded(1.0 + self.part)),
        };
        let error = match (self.error, &self.probability) {
            (Some(_), Some(found)) => {
                format!("it is {}", chance_in_words(found.value, found.interval))
            }
            (Some(error), None) => {
                let percent = shown(100.0 * error);
                format!("90 % of the errors of its emulator are at most {percent} % of it")
            }
            (None, _) => "too few of them are done for an emulator".to_owned(),
        };
        let (not, advice) = match self.is_known {
            true => ("", ""),
            false => ("not ", " Allow more tests by `size`."),
        };
        let least = match tests < self.least_tests && self.error.is_some() {
            true => format!("; at least {} are needed", self.least_tests),
            false => String::new(),
        };
        format!(
            "The {what} is {not}known to {accuracy} after {tests} tests: {error}{least}.{advice}"
        )
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use condyle_results::catalogue::{self, Scalar};

    use super::*;
    use crate::{
        emulator::tests::{ishigami, points},
        plan::TestOutputs,
    };

    /// Returns the plan of a study of three inputs with uniform distributions.
    fn plan(percent: f64, size: usize, seed: u64) -> Plan {
        plan_until(&format!("known to {percent} %"), size, seed)
    }

    fn plan_until(until: &str, size: usize, seed: u64) -> Plan {
        let mut study = format!(
            "case = \"case.toml\"\n[design]\nkind = \"adaptive\"\nuntil = \"mass_loss_mg {until}\"\nsize = {size}\n\
             seed = {seed}\n"
        );
        for (key, low, high) in [
            ("contact.friction", 0.02, 0.12),
            ("insert.thickness_mm", 8.0, 12.0),
            ("femur.distal_radius_mm", 34.0, 40.0),
        ] {
            study += &format!("[[vary]]\nkey = \"{key}\"\nlow = {low}\nhigh = {high}\n");
        }
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("case.toml"), "").unwrap();
        fs::write(folder.path().join("study.toml"), study).unwrap();
        Plan::read(&folder.path().join("study.toml")).unwrap()
    }

    /// A mass by the place of a test in the unit cube; NaN for one that fails.
    type Mass = fn(&[f64]) -> f64;

    /// Appends tests to the `known` ones until the study ends.
    fn run(plan: &Plan, mass: Mass, known: &mut Vec<Known>) {
        while let Some(tests) = next_tests(plan, known) {
            // Of a batch that was interrupted, the first tests are known.
            let left = tests
                .into_iter()
                .skip_while(|test| test.row < known.len() as u64);
            let done: Vec<Known> = left
                .map(|test| {
                    let mass = mass(&point(plan.study(), &test));
                    let value = |output: &Scalar| {
                        if output.key == "mass_loss_mg" {
                            mass
                        } else {
                            0.0
                        }
                    };
                    let outputs = TestOutputs {
                        values: catalogue::outputs().map(value).collect(),
                        doubts: String::new(),
                    };
                    (
                        test,
                        if mass.is_nan() {
                            Err("broken".to_owned())
                        } else {
                            Ok(outputs)
                        },
                    )
                })
                .collect();
            known.extend(done);
        }
    }

    /// A kink along a curve, and waves.
    fn kinked(x: &[f64]) -> f64 {
        1.0 + (x[0] - 0.3).powi(2) + 2.0 * (x[1] * x[2]).sqrt() + (3.0 * x[0] * x[2]).sin()
    }

    /// A peak of six times its foot, and a third input without influence.
    fn peak(x: &[f64]) -> f64 {
        let squares = (x[0] - 0.7).powi(2) + (x[1] - 0.4).powi(2);
        1.0 + 5.0 * (-20.0 * squares).exp() + x[0]
    }

    fn waves(x: &[f64]) -> f64 {
        20.0 + ishigami(x)
    }

    /// A bowl that cannot be computed in a corner.
    fn broken(x: &[f64]) -> f64 {
        if x[0] + x[1] > 1.5 {
            return f64::NAN;
        }
        2.0 + (x[0] - 0.2).powi(2) + x[1] * x[2]
    }

    /// Returns the 90th percentile of the errors at 2000 unseen points, as parts of the mass, by the emulator of all tests.
    fn unseen_part(plan: &Plan, mass: Mass, known: &[Known], seed: u64) -> f64 {
        let emulator = Seen::new(plan, known).unwrap().emulator;
        let others = points(2000, 3, 1000 + seed);
        let solved = others
            .iter()
            .map(|one| (one, mass(one)))
            .filter(|(_, exact)| !exact.is_nan());
        let parts = solved.map(|(one, exact)| (emulator.predict(one).mean / exact - 1.0).abs());
        let mut parts: Vec<f64> = parts.collect();
        parts.sort_by(f64::total_cmp);
        quantile(&parts, SHARE)
    }

    #[test]
    fn verify_unseen_errors_are_within_the_stated_part() {
        for (name, mass, percent, most) in [
            ("kinked", kinked as Mass, 2.0, 200),
            ("waves", waves, 10.0, 180),
            ("broken", broken, 1.0, 80),
        ] {
            let mut within = 0;
            for seed in 1..=10 {
                let plan = plan(percent, 250, seed);
                let mut known = Vec::new();
                run(&plan, mass, &mut known);
                let aim = standing(&plan, &known).unwrap().0;
                let part = unseen_part(&plan, mass, &known, seed);
                println!(
                    "{name} {percent} % seed {seed}: {:.4} unseen, {:?} stated, {} tests",
                    part,
                    aim.error,
                    known.len()
                );
                assert!(
                    aim.is_known && known.len() <= most,
                    "{name}: {} tests",
                    known.len()
                );
                within += usize::from(part <= percent / 100.0);
            }
            assert!(within >= 9, "{name}: {within} of 10");
        }
    }

    /// Returns the part of a fine grid over the unit cube where the mass is above a limit.
    fn part_above(mass: Mass, limit: f64) -> f64 {
        const SIDE: usize = 128;
        let at = |place: usize| (place as f64 + 0.5) / SIDE as f64;
        let above = |cell: &usize| {
            let (x, y, z) = (cell % SIDE, cell / SIDE % SIDE, cell / SIDE / SIDE);
            mass(&[at(x), at(y), at(z)]) > limit
        };
        let cells = SIDE.pow(3);
        (0..cells).filter(above).count() as f64 / cells as f64
    }

    #[test]
    fn verify_a_rare_probability_is_within_the_stated_factor() {
        for (name, mass, limit, most) in [
            ("kinked", kinked as Mass, 3.98, 120),
            ("waves", waves, 36.0, 250),
            ("peak", peak, 6.67, 120),
        ] {
            let exact = part_above(mass, limit);
            let mut within = 0;
            for seed in 1..=3 {
                let until = format!("above {limit} known to a factor of 1.5");
                let plan = plan_until(&until, 256, seed);
                let mut known = Vec::new();
                run(&plan, mass, &mut known);
                let aim = standing(&plan, &known).unwrap().0;
                println!("{name} seed {seed}: exact {exact:.3e}; {}", aim.sentence());
                assert!(
                    aim.is_known && known.len() <= most,
                    "{name}: {} tests",
                    known.len()
                );
                let [low, high] = aim.probability.unwrap().interval;
                within += usize::from(low <= exact && exact <= high);
            }
            assert!(within >= 2, "{name}: {within} of 3");
        }
    }

    #[test]
    fn verify_fewer_tests_than_at_sobol_points() {
        // With as many tests, errors at Sobol points are larger.
        let plan = plan(0.01, 74, 1);
        for mass in [kinked as Mass, peak] {
            let mut added = Vec::new();
            run(&plan, mass, &mut added);
            let sobol = sobol_tests(&plan, 1, 0, added.len());
            let sobol: Vec<Known> = sobol
                .into_iter()
                .zip(&added)
                .map(|(test, _)| {
                    let values = catalogue::outputs()
                        .map(|_| mass(&point(plan.study(), &test)))
                        .collect();
                    (
                        test,
                        Ok(TestOutputs {
                            values,
                            doubts: String::new(),
                        }),
                    )
                })
                .collect();
            let [added, sobol] = [&added, &sobol].map(|known| unseen_part(&plan, mass, known, 1));
            println!("{added:.4} added, {sobol:.4} Sobol");
            assert!(added < sobol, "{added} {sobol}");
        }
    }

    #[test]
    fn a_study_that_was_interrupted_or_extended_has_the_same_tests() {
        let mut whole = Vec::new();
        run(&plan(2.0, 60, 3), kinked, &mut whole);
        for (percent, size, tests) in [(2.0, 30, 30), (30.0, 60, 60), (2.0, 60, 5), (2.0, 60, 25)] {
            let mut known = Vec::new();
            run(&plan(percent, size, 3), kinked, &mut known);
            known.truncate(tests);
            assert!(known.len() < whole.len(), "{}", known.len());
            run(&plan(2.0, 60, 3), kinked, &mut known);
            assert_eq!(known, whole);
        }
        let hash = |percent, size, seed| plan(percent, size, seed).inputs_blake3().to_owned();
        assert_eq!(hash(1.0, 60, 1), hash(2.0, 70, 1));
        assert_ne!(hash(1.0, 60, 1), hash(1.0, 60, 2));
    }

    #[test]
    fn an_aim_out_of_reach_ends_at_the_largest_number_of_tests_and_states_it() {
        let mut known = Vec::new();
        let plan = plan(0.01, 40, 1);
        run(&plan, waves, &mut known);
        let aim = standing(&plan, &known).unwrap().0;
        assert!(known.len() == 40 && !aim.is_known);
        let said = aim.sentence();
        assert!(
            said.contains("not known to 0.01 % after 40 tests"),
            "{said}"
        );
        // A constant is known as soon as there are enough tests, twice.
        let mut known = Vec::new();
        run(&plan, |_| 3.0, &mut known);
        assert!(known.len() == 38 && standing(&plan, &known).unwrap().0.is_known);
        // Without a solved test, Sobol points follow to the end.
        let mut known = Vec::new();
        run(&plan, |_| f64::NAN, &mut known);
        assert_eq!(known.len(), 40);
        assert!(
            standing(&plan, &known)
                .unwrap()
                .0
                .sentence()
                .contains("too few of them")
        );
    }
}
