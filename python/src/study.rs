//! Studies: many tests of one case, here, on all threads, or row by row wherever Python sends them.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Mutex;

use condyle_case::case::Assignment;
use condyle_case::study::Study;
use condyle_results::catalogue;
use condyle_study::{
    HeldFolder, Plan, Shard, Store, StudyEnd, StudyError, StudyOptions, Test, TestBench,
    TestResult, merge, run_study, write_answers,
};
use pyo3::prelude::*;

use crate::errors;
use crate::files::FilesOfCase;

/// What a test found: its outputs, or why it found nothing.
#[derive(FromPyObject, IntoPyObject)]
pub enum Found {
    Reason(String),
    Outputs(Vec<f64>),
}

/// A study, checked, and what its tests are run with.
#[pyclass(frozen, module = "condyle._condyle")]
pub struct RawStudy {
    plan: Plan,
    bench: TestBench,
}

#[pymethods]
impl RawStudy {
    /// Reads a study from `text`, as if it stood in the file `path`; what that names is looked for in `files` first,
    /// and from the folder `base` on.
    #[new]
    fn new(
        path: PathBuf,
        text: &str,
        base: PathBuf,
        files: BTreeMap<PathBuf, Vec<u8>>,
    ) -> PyResult<Self> {
        let files = FilesOfCase::new(&path, text, base, files);
        let study = Study::read_in(files, &path);
        let study = study.map_err(|problems| errors::of_problems(&problems))?;
        Ok(Self {
            plan: Plan::of(study).map_err(|error| errors::of_study(&error))?,
            bench: TestBench::default(),
        })
    }

    /// Tests in all; of a search, at most.
    #[getter]
    fn tests(&self) -> u64 {
        self.plan.tests()
    }

    /// Word of the design.
    #[getter]
    fn design(&self) -> &'static str {
        use condyle_case::config::Variants;
        self.plan.study().design.word()
    }

    /// Keys of the inputs.
    #[getter]
    fn inputs(&self) -> Vec<String> {
        let inputs = self.plan.study().inputs.iter();
        inputs.map(|input| input.key.clone()).collect()
    }

    /// Where the case is.
    #[getter]
    fn case_path(&self) -> PathBuf {
        self.plan.study().case_path.clone()
    }

    /// Hash of all that the tests follow from, in hexadecimal.
    #[getter]
    fn inputs_blake3(&self) -> String {
        self.plan.inputs_blake3().to_owned()
    }

    /// Runs every test that the folder `out` does not keep; `progress` is called with a `condyle.StudyProgress`.
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
        let mut raised = None;
        let mut last = (0, 0);
        let ended = py.detach(|| {
            run_study(&self.plan, &options, &mut |now| {
                last = (now.kept, now.tests);
                match told(progress.as_ref(), now.kept, now.tests) {
                    Ok(true) => ControlFlow::Continue(()),
                    Ok(false) => ControlFlow::Break(()),
                    Err(error) => {
                        raised = Some(error);
                        ControlFlow::Break(())
                    }
                }
            })
        });
        if let Some(raised) = raised {
            return Err(raised);
        }
        match ended.map_err(|error| errors::of_study(&error))? {
            StudyEnd::Done => Ok(()),
            StudyEnd::Interrupted => Err(errors::study_interrupted(last.0, last.1)),
        }
    }

    /// What the tests of these rows find, one after the other; they are not kept.
    fn run_rows(&self, py: Python<'_>, rows: Vec<u64>) -> PyResult<Vec<(u64, Found)>> {
        let found = rows.into_iter().map(|row| {
            py.check_signals()?;
            let test = self.test(row)?;
            let found = py.detach(|| self.bench.run(&self.plan, &test));
            Ok((row, found.map_or_else(Found::Reason, Found::Outputs)))
        });
        found.collect()
    }

    /// Takes the folder `out`, so that what tests find elsewhere can be kept in it.
    fn hold(&self, out: PathBuf) -> PyResult<RawHeldStudy> {
        let held = HeldFolder::take(&self.plan, &out);
        let held = held.map_err(|error| errors::of_study(&error))?;
        Ok(RawHeldStudy {
            held: Mutex::new(Some(held)),
        })
    }

    /// Puts the tests of `shards` into the folder `out`; how many it then keeps.
    fn merge(&self, shards: Vec<PathBuf>, out: PathBuf) -> PyResult<u64> {
        let done = merge(&self.plan, &shards, &out);
        Ok(done.map_err(|error| errors::of_study(&error))?.kept)
    }

    /// Writes tables, pictures and page of the study in `out`; its answers as JSON.
    fn answers(&self, py: Python<'_>, out: PathBuf) -> PyResult<String> {
        let answers = py.detach(|| write_answers(&self.plan, &out));
        let answers = answers.map_err(|error| errors::of_study(&error))?;
        Ok(serde_json::to_string(&answers).expect("numbers and text always serialise"))
    }

    /// What the test of a row sets of the case, as `key=value`; of a search it is looked up in the folder `out`.
    fn changes(&self, row: u64, out: Option<PathBuf>) -> PyResult<Vec<String>> {
        let test = match out.filter(|_| self.plan.is_search()) {
            None => self.test(row)?,
            Some(out) => Store::existing(&out, &self.plan)
                .and_then(|store| store.test(row, &self.plan))
                .map_err(|error| errors::of_study(&error))?,
        };
        let changes = self.plan.assignments(&test);
        Ok(changes.iter().map(Assignment::to_string).collect())
    }
}

impl RawStudy {
    fn test(&self, row: u64) -> PyResult<Test> {
        let tests = self.plan.tests();
        let error = if row >= tests {
            StudyError::NoRow { row, tests }
        } else {
            StudyError::NotYet { row }
        };
        let test = Some(row).filter(|row| *row < tests);
        test.and_then(|row| self.plan.test(row))
            .ok_or_else(|| errors::of_study(&error))
    }
}

/// The folder of a study while tests run elsewhere.
#[pyclass(frozen, module = "condyle._condyle")]
pub struct RawHeldStudy {
    held: Mutex<Option<HeldFolder>>,
}

#[pymethods]
impl RawHeldStudy {
    /// Numbers of the tests that are not kept.
    fn missing(&self, study: &RawStudy) -> PyResult<Vec<u64>> {
        self.with(|held| held.missing(&study.plan))
    }

    /// Keeps what tests found, all in one step.
    fn keep(&self, study: &RawStudy, found: Vec<(u64, Found)>) -> PyResult<()> {
        let tested = |(row, found): (u64, Found)| {
            let found: TestResult = match found {
                Found::Outputs(outputs) if outputs.len() == catalogue::outputs().count() => {
                    Ok(outputs)
                }
                Found::Outputs(_) => {
                    return Err(errors::bad_input(
                        &"a worker found other numbers than a test has",
                    ));
                }
                Found::Reason(reason) => Err(reason),
            };
            Ok((study.test(row)?, found))
        };
        let found: PyResult<Vec<(Test, TestResult)>> = found.into_iter().map(tested).collect();
        let found = found?;
        self.with(|held| held.keep(&study.plan, &found))
    }

    /// Gives the folder back.
    fn close(&self) {
        self.held.lock().expect("no thread panics with it").take();
    }
}

impl RawHeldStudy {
    fn with<T>(&self, work: impl FnOnce(&HeldFolder) -> Result<T, StudyError>) -> PyResult<T> {
        let held = self.held.lock().expect("no thread panics with it");
        let held = held
            .as_ref()
            .ok_or_else(|| errors::bad_input(&"the study's folder was given back"))?;
        work(held).map_err(|error| errors::of_study(&error))
    }
}

/// Tells a callback how far a study is; whether it is to go on.
fn told(callback: Option<&Py<PyAny>>, kept: u64, tests: u64) -> PyResult<bool> {
    Python::attach(|py| {
        py.check_signals()?;
        let Some(callback) = callback else {
            return Ok(true);
        };
        let class = py.import("condyle.progress")?.getattr("StudyProgress")?;
        let progress = class.call1((kept, tests))?;
        let answer = callback.bind(py).call1((progress,))?;
        Ok(!answer.is(pyo3::types::PyBool::new(py, false).as_any()))
    })
}
