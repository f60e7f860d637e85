//! A search whose tests run elsewhere: it proposes designs and takes their results, in any order.

use condyle_case::{
    config::Level,
    study::{Design, Input, OptimiseKeys},
};

use super::{
    Known, along_all, first_places, first_tests, is_new, observed, places::along, point, tests_at,
};
use crate::{
    error::StudyError,
    plan::{Plan, Test, TestOutputs, TestResult},
    store::Store,
};

/// Part of a range by which a value may exceed it as a rounding error.
const ROUNDING: f64 = 1e-9;

impl Store {
    /// Returns the values of the inputs of up to `count` tests for a search: of its first tests, those that are neither
    /// stored nor `pending`; afterwards what the emulators propose from all stored tests, as if the pending ones had the results
    /// that they predict. None at the end of the search.
    ///
    /// # Errors
    /// A study that is not a search, values that are not a test of it, and a database that cannot be read.
    pub fn ask(
        &self,
        plan: &Plan,
        pending: &[Vec<f64>],
        count: usize,
    ) -> Result<Vec<Vec<f64>>, StudyError> {
        let (study, keys) = (plan.study(), plan.search()?);
        let known = self.known(plan, 0)?;
        let pending = pending.iter().map(|values| plan.test_with(0, values));
        let pending: Vec<Test> = pending.collect::<Result<_, _>>()?;
        let of_pending = pending.iter().map(|test| point(study, test));
        let of_pending: Vec<Vec<f64>> = of_pending.collect();
        let taken = known.len() + pending.len();
        let count = count.min((keys.size as usize).saturating_sub(taken));
        let mut tests = Vec::new();
        if taken < first_tests(study.inputs.len()) {
            tests = first_left(plan, keys.seed, &known, &of_pending);
            tests.truncate(count);
        }
        if tests.is_empty() && count > 0 {
            let observed = observed(plan, &known);
            let points = observed.proposals(&of_pending, count, keys.seed);
            let places = along_all(study, &points.unwrap_or_default());
            tests = tests_at(plan, 0, places);
        }
        Ok(tests.iter().map(|test| plan.numbers(test)).collect())
    }

    /// Stores the results of tests that were run elsewhere, given by the values of their inputs: those that [`Self::ask`]
    /// returned, or others within the ranges.
    ///
    /// # Errors
    /// Values beyond their ranges, results without the minimised or a limited output, more tests than the study allows, and a
    /// database that cannot be written; nothing is stored then.
    pub fn tell(
        &self,
        plan: &Plan,
        results: Vec<(Vec<f64>, TestResult)>,
    ) -> Result<(), StudyError> {
        plan.search()?;
        let (study, wanted) = (plan.study(), results.len());
        let needed = study.answers.bounds.iter().map(|bound| bound.output);
        let needed: Vec<_> = study.objectives().into_iter().chain(needed).collect();
        let free = (0..).zip(self.kept(plan)?).filter(|(_, is_kept)| !is_kept);
        let told = free.zip(results).map(|((row, _), (values, result))| {
            let test = plan.test_with(row, &values)?;
            let lacks = |outputs: &TestOutputs| {
                let mut needed = needed.iter();
                needed.find(|output| !study.outputs.value(&outputs.values, output).is_finite())
            };
            if let Some(output) = result.as_ref().ok().and_then(lacks) {
                return Err(StudyError::Plan(format!(
                    "the results of a test lack `{}`, or it is not finite, and the search minimises or limits it; add it, or give the reason of a failure as text",
                    output.key
                )));
            }
            Ok((test, result))
        });
        let told: Vec<Known> = told.collect::<Result<_, _>>()?;
        if told.len() < wanted {
            return Err(StudyError::Plan(format!(
                "the study allows at most {} tests, and these would be more; raise `size`",
                plan.tests()
            )));
        }
        self.keep(plan, &told)
    }
}

/// Returns the first tests that are neither known nor pending.
fn first_left(plan: &Plan, seed: u64, known: &[Known], pending: &[Vec<f64>]) -> Vec<Test> {
    let known = known.iter().map(|(test, _)| point(plan.study(), test));
    let mut taken: Vec<Vec<f64>> = known.chain(pending.iter().cloned()).collect();
    let mut tests = tests_at(plan, 0, first_places(plan.study(), seed));
    tests.retain_mut(|test| {
        *test = plan.in_numbers(test);
        let point = point(plan.study(), test);
        let is_left = is_new(&point, &taken);
        taken.push(point);
        is_left
    });
    tests
}

/// Returns the place of the test that a search starts from: the first proposed one, wherever results that ended in another
/// order put it, or the first result if that one is not known.
pub(crate) fn starting_test(plan: &Plan, known: &[Known]) -> usize {
    let Design::Optimise(keys) = &plan.study().design else {
        return 0;
    };
    let mut places = first_places(plan.study(), keys.seed);
    places.truncate(1);
    // Programs may have rounded the values of a design.
    let at = |test: &Test| point(plan.study(), &plan.in_numbers(test));
    let start: Vec<_> = tests_at(plan, 0, places).iter().map(at).collect();
    let mut known = known.iter();
    let place = known.position(|(test, _)| !is_new(&at(test), &start));
    place.unwrap_or(0)
}

fn level(value: f64) -> Option<Level> {
    Some(Level::Number(value))
}

impl Plan {
    fn search(&self) -> Result<&OptimiseKeys, StudyError> {
        match &self.study().design {
            Design::Optimise(keys) => Ok(keys),
            other => Err(StudyError::Plan(format!(
                "a design of the kind `{}` proposes no tests from results; give the study `kind = \"optimise\"`",
                other.word()
            ))),
        }
    }

    /// Returns the values of the inputs in a test of a search, all of them numbers.
    fn numbers(&self, test: &Test) -> Vec<f64> {
        let inputs = self.study().inputs.iter().zip(&test.values);
        let number = |(input, value): (&Input, &Option<Level>)| {
            let value = value.clone().or_else(|| self.study().value_of_case(input));
            value.as_ref().and_then(Level::number).unwrap_or(f64::NAN)
        };
        inputs.map(number).collect()
    }

    /// Returns a test with the numbers of the case where it has no values of its own.
    fn in_numbers(&self, test: &Test) -> Test {
        let values = self.numbers(test).into_iter().map(level).collect();
        Test { values, ..*test }
    }

    /// Returns test `row` with these values of its inputs.
    ///
    /// # Errors
    /// Another number of values than the study has inputs, or a value of a chosen input beyond its range.
    pub fn test_with(&self, row: u64, values: &[f64]) -> Result<Test, StudyError> {
        let study = self.study();
        if values.len() != study.inputs.len() {
            return Err(StudyError::Plan(format!(
                "a test of this study has {} inputs, not {}",
                study.inputs.len(),
                values.len()
            )));
        }
        for (input, value) in study.inputs.iter().zip(values) {
            let place = along(input, level(*value).as_ref()).unwrap_or(f64::NAN);
            let is_inside = (-ROUNDING..=1.0 + ROUNDING).contains(&place);
            if !(is_inside || input.is_disturbance && place.is_finite()) {
                return Err(StudyError::Plan(format!(
                    "`{} = {value}` is not within the range of the study",
                    input.key
                )));
            }
        }
        Ok(Test {
            row,
            alternative: 0,
            values: values.iter().copied().map(level).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use condyle_results::catalogue::{self, Scalar};

    use super::*;
    use crate::search::next_tests;

    const STUDY: &str = "case = \"case.toml\"\n[design]\nkind = \"optimise\"\nsize = 24\n\
        [[vary]]\nkey = \"contact.friction\"\nlow = 0.02\nhigh = 0.12\n\
        [[vary]]\nkey = \"insert.thickness_mm\"\nlevels = [8, 9, 12]\n\
        [[limit]]\noutput = \"peak_pressure_mpa\"\nmost = 40.0\n";

    fn begun(study: &str) -> (tempfile::TempDir, Plan, Store) {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("case.toml"), "").unwrap();
        fs::write(folder.path().join("study.toml"), study).unwrap();
        let plan = Plan::read(&folder.path().join("study.toml")).unwrap();
        let store = Store::take(&plan, &folder.path().join("out")).unwrap();
        (folder, plan, store)
    }

    /// Mass and peak pressure of a test: the bowl without a limit is least at 0.05 and 9 mm, within the limit at 0.08.
    fn outputs(values: &[f64]) -> TestResult {
        let [friction, thickness_mm] = values else {
            panic!("{values:?}");
        };
        let output = |output: &Scalar| match output.key {
            "mass_loss_mg" => (20.0 * (friction - 0.05)).powi(2) + (thickness_mm - 9.4).powi(2),
            "peak_pressure_mpa" => 48.0 - 100.0 * friction,
            _ => f64::NAN,
        };
        Ok(TestOutputs {
            values: catalogue::outputs().map(output).collect(),
            doubts: String::new(),
        })
    }

    #[test]
    fn verify_an_optimum_by_results_in_any_order() {
        let (_folder, plan, store) = begun(STUDY);
        let mut pending: Vec<Vec<f64>> = Vec::new();
        let mut all: Vec<Vec<f64>> = Vec::new();
        loop {
            let asked = store.ask(&plan, &pending, 4 - pending.len()).unwrap();
            assert_eq!(
                asked,
                store.ask(&plan, &pending, 4 - pending.len()).unwrap()
            );
            assert!(asked.iter().all(|one| [8.0, 9.0, 12.0].contains(&one[1])));
            assert!(asked.iter().all(|one| !all.contains(one)), "{asked:?}");
            all.extend(asked.iter().cloned());
            pending.extend(asked);
            // The last one arrives first, and one is always under way.
            let Some(done) = pending.pop() else { break };
            store
                .tell(&plan, vec![(done.clone(), outputs(&done))])
                .unwrap();
        }
        assert_eq!(store.count().unwrap(), 24);
        let known = store.known(&plan, 0).unwrap();
        let observed = observed(&plan, &known);
        let start = plan.numbers(&known[starting_test(&plan, &known)].0);
        assert_eq!(start, *all.first().unwrap());
        assert_ne!(start, plan.numbers(&known[0].0));
        let best = plan.numbers(&known[observed.best()[0]].0);
        assert!((best[0] - 0.08).abs() < 1e-4 && best[1] == 9.0, "{best:?}");
        assert!(next_tests(&plan, &known).is_none());
    }

    #[test]
    fn results_that_do_not_fit_are_errors_and_nothing_is_stored() {
        let (_folder, plan, store) = begun(STUDY);
        let good = |friction: f64| (vec![friction, 9.0], outputs(&[friction, 9.0]));
        let said = |results| store.tell(&plan, results).unwrap_err().to_string();
        let mut lacking = outputs(&[0.05, 9.0]);
        lacking.as_mut().unwrap().values[0] = f64::NAN;
        for (results, expected) in [
            (
                vec![good(0.05), good(0.2)],
                "`contact.friction = 0.2` is not within the range",
            ),
            (
                vec![good(f64::NAN)],
                "`contact.friction = NaN` is not within",
            ),
            (vec![(vec![0.05, 9.0], lacking)], "lack `mass_loss_mg`"),
            (
                vec![(vec![0.05], outputs(&[0.05, 9.0]))],
                "has 2 inputs, not 1",
            ),
            (vec![good(0.05); 25], "at most 24 tests"),
        ] {
            let said = said(results);
            assert!(said.contains(expected), "{said}");
        }
        assert_eq!(store.count().unwrap(), 0);
        store
            .tell(&plan, vec![(vec![0.05, 8.0], Err("broken".to_owned()))])
            .unwrap();
        assert_eq!(
            store.known(&plan, 0).unwrap()[0].1,
            Err("broken".to_owned())
        );
        let (_folder, plan, store) = begun(&STUDY.replace("optimise", "sobol"));
        let said = store.ask(&plan, &[], 1).unwrap_err().to_string();
        assert!(
            said.contains("a design of the kind `sobol` proposes no tests"),
            "{said}"
        );
    }
}
