//! The tests of a study, each by its number.

use std::{fmt, path::Path, str::FromStr};

use condyle_case::{
    case::{Assignment, Case},
    config::Level,
    study::{Design, Input, Study, Variation},
};
use condyle_lab::RunError;
use condyle_results::catalogue;

use crate::{
    design::{
        Correlated, Saltelli, factorial_places, latin_places, morris_places, one_at_a_time_places,
        sobol::{MAX_AXES, sobol_places},
    },
    distribution::{Place, along, at_share},
    error::StudyError,
};

/// Tests of a study, at most.
const MAX_TESTS: f64 = 1e9;

/// A study that is ready to be done.
pub struct Plan {
    study: Study,
    correlated: Option<Correlated>,
    /// Tests of one design.
    tests: u64,
    inputs_blake3: String,
}

/// One test of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Test {
    /// Its number.
    pub row: u64,
    /// Which of the designs that are compared it is of.
    pub alternative: usize,
    /// The value of every input; none where it is as the case has it.
    pub values: Vec<Option<Level>>,
}

/// What a test found: its outputs in the order of [`catalogue::outputs`], or why it found nothing.
pub type TestResult = Result<Vec<f64>, String>;

impl Plan {
    /// Reads the study at `path` and checks that its tests can be chosen.
    ///
    /// # Errors
    /// Everything that is wrong with the study.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        Self::of(Study::read(path)?)
    }

    /// The tests of a study, if they can be chosen.
    ///
    /// # Errors
    /// More of them than anybody waits for, or more inputs than the design takes.
    pub fn of(study: Study) -> Result<Self, StudyError> {
        let inputs_blake3 = study.inputs_blake3().map_err(RunError::Inputs)?;
        let tests = tests(&study);
        if tests * designs(&study) as f64 > MAX_TESTS {
            let most = MAX_TESTS;
            return Err(StudyError::TooManyTests { tests, most });
        }
        check_axes(&study)?;
        let correlated = if study.correlations.is_empty() {
            None
        } else {
            let correlated = Correlated::new(study.inputs.len(), &study.correlations);
            Some(correlated.ok_or(StudyError::Contradiction)?)
        };
        Ok(Self {
            correlated,
            tests: tests as u64,
            inputs_blake3,
            study,
        })
    }

    /// What the file says.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Hash of all that the tests follow from, in hexadecimal.
    pub fn inputs_blake3(&self) -> &str {
        &self.inputs_blake3
    }

    /// Tests in all; of a search, at most.
    pub fn tests(&self) -> u64 {
        self.tests * designs(&self.study) as u64
    }

    /// Whether a test follows from those before it.
    pub fn is_search(&self) -> bool {
        matches!(self.study.design, Design::Optimise(_))
    }

    /// Test `row`; none of a search, which knows a test only after those before it.
    pub fn test(&self, row: u64) -> Option<Test> {
        let designs = designs(&self.study) as u64;
        let (of_design, alternative) = (row / designs, (row % designs) as usize);
        let values = match &self.study.design {
            Design::Optimise(_) => return None,
            Design::Rows(_) => {
                let row = &self.study.rows[of_design as usize];
                row.iter().cloned().map(Some).collect()
            }
            _ => self.at(&self.places(of_design)),
        };
        Some(Test {
            row,
            alternative,
            values,
        })
    }

    /// The values of inputs at these places.
    pub(crate) fn at(&self, places: &[Place]) -> Vec<Option<Level>> {
        let inputs = self.study.inputs.iter().zip(places);
        let value = |(input, place): (&Input, &Place)| match *place {
            Place::AsItIs => None,
            Place::Share(share) => Some(at_share(input, share)),
            Place::Along(part) => Some(along(input, part)),
        };
        inputs.map(value).collect()
    }

    fn places(&self, row: u64) -> Vec<Place> {
        let inputs = self.study.inputs.len();
        let mut places = match &self.study.design {
            Design::LatinHypercube(keys) => latin_places(row, self.tests, inputs, keys.seed),
            Design::Sobol(keys) => sobol_places(row, inputs, keys.seed),
            Design::Saltelli(keys) => Saltelli::places(row, inputs, keys.seed),
            Design::Morris(keys) => morris_places(row, inputs, keys.levels, keys.seed),
            Design::FullFactorial(keys) => factorial_places(row, &counts(&self.study, keys.points)),
            Design::OneAtATime(keys) => {
                one_at_a_time_places(row, &counts(&self.study, keys.points))
            }
            Design::Rows(_) | Design::Optimise(_) => Vec::new(),
        };
        if let Some(correlated) = &self.correlated {
            correlated.apply(&mut places);
        }
        places
    }

    /// The case of a test.
    ///
    /// # Errors
    /// Values that do not go together.
    pub fn case_of(&self, test: &Test) -> Result<Case, RunError> {
        Ok(self.study.changed_case(&self.assignments(test))?)
    }

    /// What a test sets of the case.
    pub fn assignments(&self, test: &Test) -> Vec<Assignment> {
        self.study.assignments(test.alternative, &test.values)
    }

    /// The values of a test as the table has them: those of the case where it sets none.
    pub(crate) fn written_values(&self, test: &Test) -> Vec<Option<Level>> {
        let inputs = self.study.inputs.iter().zip(&test.values);
        let value = |(input, value): (&Input, &Option<Level>)| {
            value.clone().or_else(|| self.study.value_of_case(input))
        };
        inputs.map(value).collect()
    }

    /// The design that a test is of; none where there is but one.
    pub(crate) fn design_of(&self, test: &Test) -> Option<&str> {
        let design = self.study.alternatives.get(test.alternative)?;
        Some(&design.name)
    }

    /// Columns of the table for the inputs and the outputs.
    pub(crate) fn columns(&self) -> (Vec<&str>, Vec<&'static str>) {
        let inputs = self.study.inputs.iter().map(|input| input.key.as_str());
        (
            inputs.collect(),
            catalogue::outputs().map(|output| output.key).collect(),
        )
    }
}

/// Designs that are compared, at least the case itself.
pub(crate) fn designs(study: &Study) -> usize {
    study.alternatives.len().max(1)
}

/// How many values each input has.
fn counts(study: &Study, points: u64) -> Vec<u64> {
    let count = |input: &Input| match &input.variation {
        Variation::Levels(keys) => keys.levels.0.len() as u64,
        _ => points,
    };
    study.inputs.iter().map(count).collect()
}

/// Tests of one design, as a number that may be too large for any.
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
    }
}

/// Refuses more inputs than points of Sobol have axes.
fn check_axes(study: &Study) -> Result<(), StudyError> {
    let inputs = study.inputs.len();
    let most = match &study.design {
        Design::Sobol(_) => MAX_AXES,
        Design::Saltelli(_) => MAX_AXES / 2,
        _ => usize::MAX,
    };
    if inputs <= most {
        return Ok(());
    }
    let design = study.design.word();
    Err(StudyError::TooManyInputs {
        design,
        most,
        inputs,
    })
}

/// Every `of`-th test, from one of the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u64,
    of: u64,
}

impl Shard {
    /// The whole study.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether it is the whole study.
    pub fn is_whole(&self) -> bool {
        self.of == 1
    }

    /// Whether a row is one of its tests.
    pub fn has(&self, row: u64) -> bool {
        row % self.of == self.number - 1
    }

    /// How many of so many tests are its own.
    pub fn count(&self, tests: u64) -> u64 {
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
                "`{written}` is no shard; write the second of four as 2/4"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
