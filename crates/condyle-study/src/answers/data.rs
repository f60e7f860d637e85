//! The stored tests in columns, and the distribution of each output.

use condyle_case::study::{Bound, Design};
use condyle_results::catalogue::Scalar;
use serde::Serialize;

use crate::{
    answers::words::within_design,
    design::Saltelli,
    error::StudyError,
    plan::{Plan, designs},
    statistics::{mean, quantile, standard_deviation, wilson_interval},
    store::{Column, Store},
};

/// The table of a study that answers are computed from.
pub(crate) struct Data<'a> {
    pub plan: &'a Plan,
    pub inputs: Vec<Column>,
    /// The outputs of the study, with a value for each test.
    pub outputs: Vec<(&'static Scalar, Vec<f64>)>,
    /// True for each test that is done and within every limit.
    pub within: Vec<bool>,
    /// True for each test that is done or could not be solved.
    pub kept: Vec<bool>,
    /// The plausibility checks that each test does not pass, as words.
    pub doubts: Column,
}

/// A test that does not pass plausibility checks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Doubtful {
    pub row: u64,
    /// Their names, separated by spaces.
    pub checks: String,
}

impl<'a> Data<'a> {
    pub fn read(plan: &'a Plan, store: &Store) -> Result<Self, StudyError> {
        let study = plan.study();
        let values = |output: &Scalar| -> Result<Vec<f64>, StudyError> {
            Ok(store.column(plan, output.key)?.values)
        };
        let mut within = vec![true; plan.tests() as usize];
        for bound in &study.answers.bounds {
            for (within, value) in within.iter_mut().zip(values(bound.output)?) {
                *within &= bound.excess(value) == 0.0 && value.is_finite();
            }
        }
        let inputs = study.inputs.iter();
        let inputs = inputs.map(|input| store.column(plan, &input.key));
        let outputs = study.answers.outputs.iter();
        let outputs = outputs.map(|output| values(output).map(|values| (*output, values)));
        Ok(Self {
            plan,
            inputs: inputs.collect::<Result<_, _>>()?,
            outputs: outputs.collect::<Result<_, _>>()?,
            within,
            kept: store.kept(plan)?,
            doubts: store.column(plan, "reason")?,
        })
    }

    /// Returns the values of an output of the study's answers.
    pub fn of(&self, output: &Scalar) -> &[f64] {
        let mut outputs = self.outputs.iter();
        let own = outputs.find(|(one, _)| one.key == output.key);
        own.map_or(&[], |(_, values)| values)
    }

    /// Returns the plausibility checks that a test does not pass; none if it is sound.
    pub fn doubts(&self, test: usize) -> Option<&String> {
        let place = self.doubts.values[test];
        self.doubts
            .words
            .get(place as usize)
            .filter(|_| place.is_finite())
    }

    /// Returns the doubtful ones of some tests.
    pub fn doubtful(&self, rows: impl Iterator<Item = u64>) -> Vec<Doubtful> {
        let doubtful = rows.filter_map(|row| {
            let checks = self.doubts(row as usize)?.clone();
            Some(Doubtful { row, checks })
        });
        doubtful.collect()
    }

    /// Returns the tests of a design that belong to the sample, in their order; of a design without a sample, all.
    pub fn tests_of(&self, design: usize) -> impl Iterator<Item = usize> {
        let count = designs(self.plan.study());
        let is_sample = self.is_sample();
        let points = 0..self.kept.len() / count;
        let points = points.filter(move |point| !is_sample || is_sampled(self.plan, *point));
        points.map(move |point| point * count + design)
    }

    /// Returns whether the tests contain a random sample.
    pub fn is_sample(&self) -> bool {
        is_sampled(self.plan, 0)
    }

    /// Returns every output with its values, for one design after another.
    pub fn outputs_of_designs(&self) -> impl Iterator<Item = OutputOfDesign<'_>> {
        let count = designs(self.plan.study());
        let outputs = self.outputs.iter();
        outputs.flat_map(move |(output, values)| {
            (0..count).map(move |design| (*output, values.as_slice(), design))
        })
    }

    /// Returns the name of a design; none if the study compares no designs.
    pub fn name_of(&self, design: usize) -> Option<String> {
        let alternatives = &self.plan.study().alternatives;
        alternatives.get(design).map(|one| one.name.clone())
    }

    /// Returns the values of an output in the tests of a design that are done or could not be solved.
    pub fn kept_values(&self, (_, values, design): OutputOfDesign<'_>) -> Vec<f64> {
        let kept = self.tests_of(design).filter(|test| self.kept[*test]);
        kept.map(|test| values[test]).collect()
    }
}

/// An output with its value in each test, and the number of a design.
pub(crate) type OutputOfDesign<'a> = (&'static Scalar, &'a [f64], usize);

const PERCENTILES: [f64; 7] = [2.5, 5.0, 25.0, 50.0, 75.0, 95.0, 97.5];

/// The distribution of an output, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Distribution {
    pub mean: f64,
    pub standard_deviation: f64,
    pub percentiles: [f64; 7],
}

impl Distribution {
    pub fn new(sorted: &[f64]) -> Self {
        Self {
            mean: mean(sorted),
            standard_deviation: standard_deviation(sorted),
            percentiles: PERCENTILES.map(|percent| quantile(sorted, percent / 100.0)),
        }
    }
}

/// The distribution of an output of one design over its tests, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Spread {
    pub output: &'static str,
    pub title: &'static str,
    pub unit: &'static str,
    /// The name of the design, if the study compares designs.
    pub design: Option<String>,
    /// Tests that are solved.
    pub tests: usize,
    /// Tests that could not be solved, whose output is unknown.
    pub unsolved: usize,
    /// True if the tests are a random sample, so that shares of them are probabilities.
    pub is_sample: bool,
    pub least: f64,
    pub most: f64,
    #[serde(flatten)]
    pub distribution: Distribution,
    pub beyond: Vec<Beyond>,
    #[serde(skip)]
    pub sorted: Vec<f64>,
}

/// The share of tests beyond a limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Beyond {
    pub least: Option<f64>,
    pub most: Option<f64>,
    /// The share if every unsolved test kept the limit, and if none did.
    pub share: [f64; 2],
    /// The 95 % interval of the probability, if the tests are a sample; wherever the unsolved tests would lie.
    pub interval: [f64; 2],
}

impl Spread {
    pub fn new(data: &Data<'_>, own: OutputOfDesign<'_>) -> Self {
        let (output, _, design) = own;
        let mut sorted = data.kept_values(own);
        let kept = sorted.len();
        sorted.retain(|value| value.is_finite());
        sorted.sort_by(f64::total_cmp);
        let unsolved = kept - sorted.len();
        let own = data.plan.study().answers.bounds_of(output);
        Self {
            output: output.key,
            title: output.label,
            unit: output.unit(),
            design: data.name_of(design),
            tests: sorted.len(),
            unsolved,
            is_sample: data.is_sample(),
            least: quantile(&sorted, 0.0),
            most: quantile(&sorted, 1.0),
            distribution: Distribution::new(&sorted),
            beyond: own
                .map(|bound| Beyond::new(bound, &sorted, unsolved))
                .collect(),
            sorted,
        }
    }

    /// Returns the title of the output, with the design if there are several.
    pub fn name(&self) -> String {
        of_design(self.title, self.design.as_deref())
    }

    /// Returns the same as it stands within a sentence.
    pub fn in_words(&self) -> String {
        within_design(self.title, self.design.as_deref())
    }
}

/// Returns the title of an output, with its design if there are several.
pub(crate) fn of_design(title: &str, design: Option<&str>) -> String {
    design.map_or_else(|| title.to_owned(), |design| format!("{title}, {design}"))
}

impl Beyond {
    fn new(bound: &Bound, values: &[f64], unsolved: usize) -> Self {
        let beyond = values.iter().filter(|value| bound.excess(**value) > 0.0);
        let (hits, tests) = (beyond.count() as f64, (values.len() + unsolved) as f64);
        // A test that could not be solved may be one that a loose or overloaded implant would fail: it counts both ways.
        let either = [hits, hits + unsolved as f64];
        let [low, high] = either.map(|hits| wilson_interval(hits, tests));
        Self {
            least: bound.least,
            most: bound.most,
            share: either.map(|hits| hits / tests.max(1.0)),
            interval: [low[0], high[1]],
        }
    }
}

/// Returns whether a point of a design, which all alternatives share, belongs to a random sample. In a Saltelli design
/// the points A and B do; their mixtures depend on them.
pub(crate) fn is_sampled(plan: &Plan, point: usize) -> bool {
    let study = plan.study();
    match &study.design {
        Design::LatinHypercube(_) | Design::Sobol(_) => true,
        Design::Saltelli(_) => {
            let (_, test) = Saltelli::of(point as u64, study.inputs.len());
            !matches!(test, Saltelli::Changed(_))
        }
        Design::Morris(_)
        | Design::FullFactorial(_)
        | Design::OneAtATime(_)
        | Design::Rows(_)
        | Design::Optimise(_)
        | Design::Adaptive(_) => false,
    }
}
