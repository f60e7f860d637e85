//! Studies: many tests of one case, in this process or row by row on the workers of an executor.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Mutex;

use condyle_case::case::Assignment;
use condyle_case::study::Study;
use condyle_results::catalogue;
use condyle_study::{
    Plan, Shard, Store, StudyError, StudyEvent, StudyOptions, TestBench, TestOutputs, TestResult,
    merge, run_study, write_answers,
};
use pyo3::prelude::*;

use crate::case::CaseFiles;
use crate::errors;
use crate::listener::Callback;

/// The outputs of a test, or the reason of its failure.
#[derive(FromPyObject, IntoPyObject)]
pub enum Found {
    Reason(String),
    Outputs(Vec<f64>, String),
}

impl Found {
    fn result(self, study: &Study) -> PyResult<TestResult> {
        match self {
            Self::Outputs(values, doubts) if values.len() == study.outputs.all().count() => {
                Ok(Ok(TestOutputs { values, doubts }))
            }
            Self::Outputs(..) => Err(errors::bad_input(
                "a worker returned another number of outputs than a test has",
            )),
            Self::Reason(reason) => Ok(Err(reason)),
        }
    }
}

/// A checked study, and the bodies and caches that its tests share.
#[pyclass(frozen, module = "condyle._condyle")]
pub struct RawStudy {
    plan: Plan,
    bench: TestBench,
    /// The number of tests; for a search the maximum.
    #[pyo3(get)]
    tests: u64,
    /// The name of the design.
    #[pyo3(get)]
    design: &'static str,
    /// The dotted keys of the inputs.
    #[pyo3(get)]
    inputs: Vec<String>,
    #[pyo3(get)]
    case_path: PathBuf,
    /// The hash of all inputs of the tests, in hexadecimal.
    #[pyo3(get)]
    inputs_blake3: String,
}

#[pymethods]
impl RawStudy {
    /// The keys of the outputs of every test.
    #[getter]
    fn outputs(&self) -> Vec<&'static str> {
        let outputs = self.plan.study().outputs.all();
        outputs.map(|output| output.key).collect()
    }

    /// The keys of the results from which outputs follow, and of the outputs.
    #[getter]
    fn results(&self) -> Vec<&'static str> {
        let results = catalogue::results().map(|one| one.key);
        results.chain(self.outputs()).collect()
    }

    /// The values of the outputs of a test with these results; NaN for those that do not follow from them.
    fn output_values(&self, results: BTreeMap<String, f64>) -> Vec<f64> {
        let number = |key: &str| results.get(key).copied().unwrap_or(f64::NAN);
        self.plan.study().outputs.values(&number)
    }

    /// Reads a study from `text` as if it stood in the file `path`. Files that it names are looked up in `files` first,
    /// then from the folder `base`.
    #[new]
    fn new(
        path: PathBuf,
        text: &str,
        base: PathBuf,
        files: BTreeMap<PathBuf, Vec<u8>>,
    ) -> PyResult<Self> {
        let study = Study::read_in(CaseFiles::new(&path, text, base, files), &path);
        let plan = Plan::of(study.map_err(errors::of_problems)?).map_err(errors::of_study)?;
        let study = plan.study();
        Ok(Self {
            tests: plan.tests(),
            design: study.design.word(),
            inputs: study.inputs.iter().map(|input| input.key.clone()).collect(),
            case_path: study.case_path.clone(),
            inputs_blake3: plan.inputs_blake3().to_owned(),
            plan,
            bench: TestBench::default(),
        })
    }

    /// Runs every test that the folder `out` does not hold; `progress` is called with a `condyle.StudyProgress`.
    #[pyo3(signature = (out, threads, progress=None))]
    fn run(
        &self,
        py: Python<'_>,
        out: PathBuf,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let options = StudyOptions {
            out,
            threads,
            shard: Shard::WHOLE,
        };
        let mut callback = Callback {
            function: progress,
            raised: None,
        };
        let mut last = (0, 0);
        let ended = py.detach(|| {
            run_study(&self.plan, &options, &mut |event| {
                // Other events come with every increment, too often for a call into Python.
                let StudyEvent::Progress(now) = event else {
                    return ControlFlow::Continue(());
                };
                last = (now.kept, now.tests);
                callback.call("StudyProgress", last)
            })
        });
        if let Some(raised) = callback.raised {
            return Err(raised);
        }
        ended.map_err(|error| match error {
            StudyError::Interrupted => errors::exception("StudyInterrupted", last),
            error => errors::of_study(error),
        })
    }

    /// Runs the tests of these rows one after the other, and returns their results without storing them.
    fn run_rows(&self, py: Python<'_>, rows: Vec<u64>) -> PyResult<Vec<(u64, Found)>> {
        let found = rows.into_iter().map(|row| {
            py.check_signals()?;
            let test = self.plan.row(row, None).map_err(errors::of_study)?;
            let found = py.detach(|| self.bench.run(&self.plan, &test));
            Ok((
                row,
                found.map_or_else(Found::Reason, |outputs| {
                    Found::Outputs(outputs.values, outputs.doubts)
                }),
            ))
        });
        found.collect()
    }

    /// Locks the folder `out`, to store in it the results of tests that run elsewhere.
    fn hold(&self, out: PathBuf) -> PyResult<RawHeldStudy> {
        let held = Store::take(&self.plan, &out).map_err(errors::of_study)?;
        Ok(RawHeldStudy {
            held: Mutex::new(Some(held)),
        })
    }

    /// Merges the tests of `shards` into the folder `out`; returns how many it then holds.
    fn merge(&self, shards: Vec<PathBuf>, out: PathBuf) -> PyResult<u64> {
        merge(&self.plan, &shards, &out).map_err(errors::of_study)
    }

    /// Writes tables, pictures and page of the study in `out`, and returns its answers as JSON.
    fn answers(&self, py: Python<'_>, out: PathBuf) -> PyResult<String> {
        let answers = py.detach(|| write_answers(&self.plan, &out));
        let answers = answers.map_err(errors::of_study)?;
        Ok(serde_json::to_string(&answers).expect("numbers and text always serialise"))
    }

    /// The changes of the case in the test of a row, as `key=value`; those of a search are read from the folder `out`.
    fn changes(&self, row: u64, out: Option<PathBuf>) -> PyResult<Vec<String>> {
        let test = self
            .plan
            .row(row, out.as_deref())
            .map_err(errors::of_study)?;
        let changes = self.plan.assignments(&test);
        Ok(changes.iter().map(Assignment::to_string).collect())
    }

    /// The changes of the case in a test of a search with these values of the inputs.
    fn changes_with(&self, values: Vec<f64>) -> PyResult<Vec<String>> {
        let test = self.plan.test_with(0, &values);
        let changes = self.plan.assignments(&test.map_err(errors::of_study)?);
        Ok(changes.iter().map(Assignment::to_string).collect())
    }
}

/// The locked folder of a study whose tests run elsewhere.
#[pyclass(frozen, module = "condyle._condyle")]
pub struct RawHeldStudy {
    held: Mutex<Option<Store>>,
}

#[pymethods]
impl RawHeldStudy {
    /// Rows of the tests that the folder does not hold.
    fn missing(&self, study: &RawStudy) -> PyResult<Vec<u64>> {
        self.with(|held| held.missing(&study.plan))
    }

    /// The number of stored tests.
    fn count(&self) -> PyResult<u64> {
        self.with(Store::count)
    }

    /// Stores results of tests in one transaction.
    fn keep(&self, study: &RawStudy, found: Vec<(u64, Found)>) -> PyResult<()> {
        let tested = |(row, found): (u64, Found)| {
            let test = study.plan.row(row, None).map_err(errors::of_study)?;
            Ok((test, found.result(study.plan.study())?))
        };
        let found: Vec<_> = found.into_iter().map(tested).collect::<PyResult<_>>()?;
        self.with(|held| held.keep(&study.plan, &found))
    }

    /// The values of the inputs of the next tests of a search, while the `pending` ones are under way; none at its end.
    fn ask(
        &self,
        py: Python<'_>,
        study: &RawStudy,
        pending: Vec<Vec<f64>>,
        count: usize,
    ) -> PyResult<Vec<Vec<f64>>> {
        py.detach(|| self.with(|held| held.ask(&study.plan, &pending, count)))
    }

    /// Stores results of tests of a search by the values of their inputs.
    fn tell(&self, study: &RawStudy, found: Vec<(Vec<f64>, Found)>) -> PyResult<()> {
        let told = found.into_iter();
        let told = told.map(|(values, found)| Ok((values, found.result(study.plan.study())?)));
        let told = told.collect::<PyResult<Vec<_>>>()?;
        self.with(|held| held.tell(&study.plan, told))
    }

    /// Unlocks the folder.
    fn close(&self) {
        self.held.lock().expect("no thread panics with it").take();
    }
}

impl RawHeldStudy {
    fn with<T>(&self, work: impl FnOnce(&Store) -> Result<T, StudyError>) -> PyResult<T> {
        let held = self.held.lock().expect("no thread panics with it");
        let held = held.as_ref();
        let held = held.ok_or_else(|| errors::bad_input("the study's folder was closed"))?;
        work(held).map_err(errors::of_study)
    }
}
