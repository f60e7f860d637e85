//! Adaptive designs: tests are added where the emulator of an output is least certain, until the
//! output is known to the given accuracy.

use std::iter;

use condyle_case::study::Design;
use nalgebra::DMatrix;
use serde::Serialize;

use crate::{
    answers::words::shown,
    design::sobol::sobol_places,
    emulator::Emulator,
    error::StudyError,
    plan::{Plan, Test},
    search::{Known, first_tests, is_new, point, tests_at, value},
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
    /// The part of the output that its errors may reach.
    pub part: f64,
    /// The part of the output that 90 % of the emulator's errors stay below, by the tests and by the predicted standard
    /// deviations; none while too few tests are done for an emulator.
    pub error: Option<f64>,
    /// True if the error was within the part before the last batch as well: with few tests it may be by chance.
    pub is_known: bool,
    pub tests: usize,
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
    let (output, part) = plan.study().aim()?;
    let before = batches(plan.study().inputs.len());
    let before = before.take_while(|tests| *tests < known.len()).last();
    let seen = |tests: usize| Seen::new(plan, &known[..tests]);
    let error = |seen: &Option<Seen>| seen.as_ref().map(Seen::error);
    let is_within = |error: Option<f64>| error.is_some_and(|error| error <= part);
    let last = seen(known.len());
    let error_of_last = error(&last);
    let aim = Aim {
        output: output.key,
        title: output.label,
        part,
        error: error_of_last,
        is_known: is_within(error_of_last)
            && before.is_some_and(|tests| is_within(error(&seen(tests)))),
        tests: known.len(),
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
    /// NaN for a test that failed.
    values: Vec<f64>,
    emulator: Emulator,
    pool: Vec<Test>,
    /// The same in the unit cube.
    places: Vec<Vec<f64>>,
}

impl Seen {
    /// Fits the emulator; none while fewer tests are done than it has lengths.
    fn new(plan: &Plan, known: &[Known]) -> Option<Self> {
        let study = plan.study();
        let (Design::Adaptive(keys), Some((output, _))) = (&study.design, study.aim()) else {
            return None;
        };
        let points: Vec<Vec<f64>> = known.iter().map(|(test, _)| point(study, test)).collect();
        let values: Vec<f64> = known.iter().map(|one| value(one, output)).collect();
        let done = points.iter().cloned().zip(values.iter().copied());
        let done = done.filter(|(_, value)| value.is_finite());
        let (at, of): (Vec<Vec<f64>>, Vec<f64>) = done.unzip();
        if at.len() <= study.inputs.len() + 2 {
            return None;
        }
        // Another scrambling than that of the first tests.
        let pool = sobol_tests(plan, !keys.seed, 0, POOL);
        Some(Self {
            points,
            values,
            emulator: Emulator::fit(&at, &of)?.calibrated(),
            places: pool.iter().map(|test| point(study, test)).collect(),
            pool,
        })
    }

    /// Returns the part of the output that 90 % of the errors stay below: the larger of that of tests predicted from all others,
    /// and that of predictions at the points of the pool by their standard deviations.
    fn error(&self) -> f64 {
        let part = |error: f64, value: f64| error / value.abs().max(f64::MIN_POSITIVE);
        let done = self.values.iter().filter(|value| value.is_finite());
        let left_out = self.emulator.left_out().into_iter().zip(done);
        let left_out = left_out.map(|(one, value)| part(one.mean.abs(), *value));
        let noise = self.emulator.noise();
        let predicted = self.places.iter().map(|place| {
            let found = self.emulator.predict(place);
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

    /// Returns `count` tests of the pool, each of which lowers the variance summed over the pool most (Cohn 1996): that of the
    /// process conditioned on all tests, on those that failed as if they had been done, and on those added before.
    fn least_certain(&self, count: usize) -> Vec<Test> {
        let mut all = self.places.clone();
        let failed = self.points.iter().zip(&self.values);
        let failed = failed.filter(|(_, value)| value.is_nan());
        all.extend(failed.map(|(point, _)| point.clone()));
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
        let part = (1e6 * self.part).round() / 1e4;
        let (title, tests) = (self.title, self.tests);
        let error = match self.error {
            Some(error) => {
                let percent = shown(100.0 * error);
                format!("90 % of the errors of its emulator are at most {percent} % of it")
            }
            None => "too few of them are done for an emulator".to_owned(),
        };
        let (not, advice) = match self.is_known {
            true => ("", ""),
            false => ("not ", " Allow more tests by `size`."),
        };
        format!("The {title} is {not}known to {part} % after {tests} tests: {error}.{advice}")
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
        let mut study = format!(
            "case = \"case.toml\"\n[design]\nkind = \"adaptive\"\nuntil = \"mass_loss_mg known to {percent} %\"\n\
             size = {size}\nseed = {seed}\n"
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
        // A constant is known from the first tests on.
        let mut known = Vec::new();
        run(&plan, |_| 3.0, &mut known);
        assert!(known.len() == 11 && standing(&plan, &known).unwrap().0.is_known);
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
