//! Runs of a case, in memory or into a folder.

use std::path::PathBuf;

use condyle_case::cache::Cache;
use condyle_lab::{InMemory, Outcome, RunOptions, run_case, run_in_memory};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::case::RawCase;
use crate::law::law_of;
use crate::listener::Listener;
use crate::record::{Record, Recorder};
use crate::{errors, folder};

/// Runs a case in memory, or into the folder `out` and reads the folder. `progress` is called with a
/// `condyle.Progress`, and `wear_law`, in memory only, with a `condyle.NodeCycle`.
#[pyfunction]
#[pyo3(signature = (case, threads, *, keeps_fields, out, resume, force, progress, wear_law))]
#[expect(
    clippy::too_many_arguments,
    reason = "they are keywords, as in the function that users call"
)]
pub fn run<'py>(
    py: Python<'py>,
    case: &RawCase,
    threads: usize,
    keeps_fields: bool,
    out: Option<PathBuf>,
    resume: bool,
    force: bool,
    progress: Option<Py<PyAny>>,
    wear_law: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (case, cache) = (&case.case, Cache::of_user());
    let (wear_law, raised) = wear_law.map(law_of).unzip();
    let mut listener = Listener::new(progress, raised);
    let mut recorder = Recorder {
        side: case.side_in_frame(),
        keeps_fields,
        record: Record {
            case: case.to_toml(),
            ..Record::default()
        },
    };
    let outcome = py.detach(|| match &out {
        Some(out) => {
            let out = out.clone();
            let options = RunOptions {
                out,
                resume,
                force,
                threads,
                cache,
                report: true,
            };
            run_case(case, &options, &mut |event| listener.hear(&event))
        }
        None => {
            let options = InMemory {
                threads,
                cache,
                wear_law,
            };
            run_in_memory(case, &options, &mut recorder, &mut |event| {
                listener.hear(&event)
            })
        }
    });
    if let Some(raised) = listener.raised(py) {
        return Err(raised);
    }
    let record = match (outcome.map_err(errors::of_run)?, out) {
        (Outcome::Interrupted(reached), _) => {
            let fields = (reached.updates, reached.cycles, reached.of_cycles);
            return Err(errors::exception("Interrupted", fields));
        }
        (_, Some(out)) => py.detach(|| folder::read(&out, keeps_fields))?,
        (Outcome::Done(summary) | Outcome::DoneBefore(summary), None) => {
            let text = serde_json::to_string(&summary).expect("numbers and text serialise");
            recorder.record.summary = Some(text);
            recorder.record
        }
    };
    record.into_python(py)
}
