//! Runs of a case, in memory or into a folder.

use std::path::PathBuf;

use condyle_case::cache::Cache;
use condyle_lab::{InMemory, Outcome, RunError, RunOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::case::RawCase;
use crate::law::law_of;
use crate::listener::Listener;
use crate::record::Recorder;
use crate::{errors, folder};

/// Runs a case in memory; `progress` is called with a `condyle.Progress`, and `wear_law` with a `condyle.NodeCycle`.
#[pyfunction]
#[pyo3(signature = (case, threads, keeps_fields, progress=None, wear_law=None))]
pub fn run_in_memory<'py>(
    py: Python<'py>,
    case: &RawCase,
    threads: usize,
    keeps_fields: bool,
    progress: Option<Py<PyAny>>,
    wear_law: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let case = &case.case;
    let (wear_law, raised) = wear_law.map(law_of).unzip();
    let options = InMemory {
        threads,
        cache: Cache::of_user(),
        wear_law,
    };
    let mut listener = Listener::new(progress, raised);
    let mut recorder = Recorder::new(case, keeps_fields);
    let outcome = py.detach(|| {
        condyle_lab::run_in_memory(case, &options, &mut recorder, &mut |event| {
            listener.hear(&event)
        })
    });
    match finished(outcome, listener)? {
        Outcome::Done(summary) | Outcome::DoneBefore(summary) => {
            recorder.finish(&summary).into_python(py)
        }
        Outcome::Interrupted(reached) => Err(errors::interrupted(&reached)),
    }
}

/// Runs a case into the folder `out`, and reads the folder.
#[pyfunction]
#[pyo3(signature = (case, threads, out, resume, force, progress=None))]
pub fn run_into_folder<'py>(
    py: Python<'py>,
    case: &RawCase,
    threads: usize,
    out: PathBuf,
    resume: bool,
    force: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let options = RunOptions {
        out,
        resume,
        force,
        threads,
        cache: Cache::of_user(),
    };
    let mut listener = Listener::new(progress, None);
    let outcome = py
        .detach(|| condyle_lab::run_case(&case.case, &options, &mut |event| listener.hear(&event)));
    match finished(outcome, listener)? {
        Outcome::Interrupted(reached) => Err(errors::interrupted(&reached)),
        _ => py.detach(|| folder::read(&options.out))?.into_python(py),
    }
}

/// The outcome of a run, or the exception that stopped it.
fn finished(outcome: Result<Outcome, RunError>, listener: Listener) -> PyResult<Outcome> {
    let outcome = outcome.map_err(errors::of_run);
    listener.into_raised().map_or(outcome, Err)
}
