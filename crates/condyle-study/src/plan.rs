//! The plan of a study: its tests, each defined by its number alone.

use std::{fmt, path::Path, str::FromStr};

use condyle_case::{
    case::{Assignment, Case},
    config::Level,
    study::{Design, Input, Study, Variation},
};
use condyle_lab::RunError;

use crate::{
    design::{
        Copula, Saltelli, factorial_places, latin_places, morris_places, one_at_a_time_places,
        sobol::{MAX_AXES, sobol_places},
    },
    distribution::{Place, level_along, level_at_share},
    error::StudyError,
};

const MAX_TESTS: f64 = 1e9;

/// A checked study, ready to run.
pub struct Plan {
    study: Study,
    copula: Copula,
    /// Tests of one of the designs that are compared.
    tests: u64,
    inputs_blake3: String,
}

/// One test of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Test {
    /// The number of the test.
    pub row: u64,
    /// The place of its design among those that are compared.
    pub alternative: usize,
    /// The value of every input; none if the input keeps the value of the case.
    pub values: Vec<Option<Level>>,
}

/// The outputs of a test that was done.
#[derive(Clone, Debug, PartialEq)]
pub struct TestOutputs {
    /// Values in the order of the outputs of the study.
    pub values: Vec<f64>,
    /// Names of the plausibility checks that the test fails, separated by spaces.
    pub doubts: String,
}

/// The outputs of a test, or the reason why it failed.
pub type TestResult = Result<TestOutputs, String>;

impl Plan {
    /// Reads the study at `path` and checks that its tests can be chosen.
    ///
    /// # Errors
    /// Everything that is wrong with the study.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        Self::of(Study::read(path)?)
    }

    /// Plans the tests of a study.
    ///
    /// # Errors
    /// Too many tests or inputs, or correlations that contradict each other.
    pub fn of(study: Study) -> Result<Self, StudyError> {
        let inputs_blake3 = study.inputs_blake3().map_err(RunError::Inputs)?;
        // As a real number, since a factorial design may exceed any integer.
        let tests = tests(&study);
        if tests * designs(&study) as f64 > MAX_TESTS {
            return Err(StudyError::Plan(format!(
                "the study has {tests:.3e} tests; at most {MAX_TESTS:.0e} are allowed; take fewer levels, points or inputs"
            )));
        }
        let inputs = study.inputs.len();
        let most = match &study.design {
            Design::Sobol(_) | Design::Optimise(_) | Design::Adaptive(_) => MAX_AXES,
            // A Saltelli design takes two independent values of each input from one point.
            Design::Saltelli(_) => MAX_AXES / 2,
            _ => usize::MAX,
        };
        if inputs > most {
            let design = study.design.word();
            return Err(StudyError::Plan(format!(
                "a design of the kind `{design}` takes at most {most} inputs, and the study has {inputs}; let fewer inputs vary, or use \
                 kind = \"latin-hypercube\""
            )));
        }
        let copula = Copula::new(inputs, &study.correlations).ok_or_else(|| {
            let problem = "the correlations contradict each other; make them weaker, or omit one";
            StudyError::Plan(problem.to_owned())
        });
        Ok(Self {
            copula: copula?,
            tests: tests as u64,
            inputs_blake3,
            study,
        })
    }

    /// Returns the study as its file describes it.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Returns the hash of everything on which the tests depend, in hexadecimal.
    pub fn inputs_blake3(&self) -> &str {
        &self.inputs_blake3
    }

    /// Returns the number of all tests; for a sequential design, the largest number allowed.
    pub fn tests(&self) -> u64 {
        self.tests * designs(&self.study) as u64
    }

    /// Returns whether tests depend on the results of earlier ones.
    pub fn is_sequential(&self) -> bool {
        matches!(self.study.design, Design::Optimise(_) | Design::Adaptive(_))
    }

    /// Returns test `row`; none beyond the last test, and none for a sequential design, whose tests depend on the
    /// results of earlier ones.
    pub(crate) fn test(&self, row: u64) -> Option<Test> {
        if row >= self.tests() {
            return None;
        }
        let designs = designs(&self.study) as u64;
        let (of_design, alternative) = (row / designs, (row % designs) as usize);
        let values = match &self.study.design {
            Design::Optimise(_) | Design::Adaptive(_) => return None,
            Design::Rows(_) => {
                let row = &self.study.rows[of_design as usize];
                row.iter().cloned().map(Some).collect()
            }
            _ => self.values_at(&self.places(of_design)),
        };
        Some(Test {
            row,
            alternative,
            values,
        })
    }

    pub(crate) fn values_at(&self, places: &[Place]) -> Vec<Option<Level>> {
        let inputs = self.study.inputs.iter().zip(places);
        let value = |(input, place): (&Input, &Place)| match *place {
            Place::OfCase => None,
            Place::Share(share) => Some(level_at_share(input, share)),
            Place::Along(part) => Some(level_along(input, part)),
        };
        inputs.map(value).collect()
    }

    fn places(&self, row: u64) -> Vec<Place> {
        let inputs = self.study.inputs.len();
        let counts = |points| counts(&self.study, points);
        let places = match &self.study.design {
            Design::LatinHypercube(keys) => latin_places(row, self.tests, inputs, keys.seed),
            Design::Sobol(keys) => sobol_places(row, inputs, keys.seed),
            Design::Saltelli(keys) => Saltelli::places(row, inputs, keys.seed),
            Design::Morris(keys) => morris_places(row, inputs, keys.levels, keys.seed),
            Design::FullFactorial(keys) => factorial_places(row, &counts(keys.points)),
            Design::OneAtATime(keys) => one_at_a_time_places(row, &counts(keys.points)),
            Design::Rows(_) | Design::Optimise(_) | Design::Adaptive(_) => Vec::new(),
        };
        self.correlated(places)
    }

    /// Returns places with the correlations of the study.
    pub(crate) fn correlated(&self, mut places: Vec<Place>) -> Vec<Place> {
        self.copula.apply(&mut places);
        places
    }

    /// Returns the case of a test.
    ///
    /// # Errors
    /// A combination of values that the case does not accept.
    pub fn case_of(&self, test: &Test) -> Result<Case, RunError> {
        Ok(self.study.changed_case(&self.assignments(test))?)
    }

    /// Returns the changes of the case in a test.
    pub fn assignments(&self, test: &Test) -> Vec<Assignment> {
        self.study.assignments(test.alternative, &test.values)
    }

    /// Returns the columns of the table for the inputs and the outputs.
    pub(crate) fn columns(&self) -> (Vec<&str>, Vec<&'static str>) {
        let inputs = self.study.inputs.iter().map(|input| input.key.as_str());
        let outputs = self.study.outputs.all().map(|output| output.key);
        (inputs.collect(), outputs.collect())
    }
}

/// Returns the number of designs that are compared, one for the case alone.
pub(crate) fn designs(study: &Study) -> usize {
    study.alternatives.len().max(1)
}

fn counts(study: &Study, points: u64) -> Vec<u64> {
    let count = |input: &Input| match &input.variation {
        Variation::Levels(keys) => keys.levels.0.len() as u64,
        _ => points,
    };
    study.inputs.iter().map(count).collect()
}

/// Returns the number of tests of one design.
fn tests(study: &Study) -> f64 {
    let inputs = study.inputs.len() as f64;
    let numbers = |points| counts(study, points).into_iter().map(|count| count as f64);
    match &study.design {
        // Designs without disturbances are each tried once.
        _ if study.inputs.is_empty() => 1.0,
        Design::LatinHypercube(keys) | Design::Sobol(keys) => keys.size as f64,
        Design::Saltelli(keys) => keys.size as f64 * (inputs + 2.0),
        Design::Morris(keys) => keys.walks as f64 * (inputs + 1.0),
        Design::FullFactorial(keys) => numbers(keys.points).product(),
        Design::OneAtATime(keys) => 1.0 + numbers(keys.points).sum::<f64>(),
        Design::Rows(_) => study.rows.len() as f64,
        Design::Optimise(keys) => keys.size as f64,
        Design::Adaptive(keys) => keys.size as f64,
    }
}

/// Every `of`-th test of a study, from the `number`-th on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u64,
    of: u64,
}

impl Shard {
    /// The whole study.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Returns whether it is the whole study.
    pub fn is_whole(&self) -> bool {
        self.of == 1
    }

    pub(crate) fn has(&self, row: u64) -> bool {
        row % self.of == self.number - 1
    }

    pub(crate) fn count(&self, tests: u64) -> u64 {
        (tests + self.of - self.number) / self.of
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(written: &str) -> Result<Self, String> {
        let parts = written.split_once('/');
        let numbers = parts.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if 1 <= number && number <= of => Ok(Self { number, of }),
            _ => Err(format!(
                "`{written}` is not a shard; write the second of four as 2/4"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use condyle_results::catalogue;

    use super::*;

    #[test]
    fn regress_the_columns_of_stored_studies_are_outputs() {
        let keys: Vec<&str> = catalogue::outputs().map(|output| output.key).collect();
        assert_eq!(
            keys,
            [
                "mass_loss_mg",
                "volume_loss_mm3",
                "max_depth_mm",
                "peak_pressure_mpa",
                "first_cycle_peak_pressure_mpa",
                "last_cycle_peak_pressure_mpa",
                "peak_contact_area_mm2",
                "ap_range_mm",
                "ie_range_deg",
                "medial_load_share",
            ]
        );
    }

    #[test]
    fn every_test_belongs_to_one_shard() {
        let shards: Vec<Shard> = ["1/3", "2/3", "3/3"]
            .iter()
            .map(|shard| shard.parse().unwrap())
            .collect();
        for row in 0..10 {
            assert_eq!(shards.iter().filter(|shard| shard.has(row)).count(), 1);
        }
        let counts: Vec<u64> = shards.iter().map(|shard| shard.count(10)).collect();
        assert_eq!(counts, [4, 3, 3]);
        for wrong in ["", "0/3", "4/3", "1", "a/b", "1/0"] {
            assert!(wrong.parse::<Shard>().unwrap_err().contains("2/4"));
        }
    }
}
