//! What Python hears of a run, and how it stops one.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use condyle_lab::{Reached, RunEvent};
use pyo3::prelude::*;

use crate::law::{Raised, taken};

/// Between two looks at Ctrl-C and two calls of a callback: taking the interpreter's lock may wait for other threads.
const PAUSE: Duration = Duration::from_millis(50);

/// Tells a callback how far a run has come, and stops the run on Ctrl-C, on an exception of the callback's, and where
/// it answers `False`.
pub struct Listener {
    callback: Option<Py<PyAny>>,
    last: Instant,
    of_cycles: f64,
    cycles: f64,
    updates: usize,
    /// What the callback or Ctrl-C raised.
    raised: Option<PyErr>,
    /// What a wear law raised.
    raised_by_law: Option<Raised>,
}

impl Listener {
    pub fn new(callback: Option<Py<PyAny>>, raised_by_law: Option<Raised>) -> Self {
        Self {
            callback,
            last: Instant::now(),
            of_cycles: 0.0,
            cycles: 0.0,
            updates: 0,
            raised: None,
            raised_by_law,
        }
    }

    /// What stopped the run, if anything was raised.
    pub fn raised(self) -> Option<PyErr> {
        let by_law = self.raised_by_law.as_ref().and_then(taken);
        by_law.or(self.raised)
    }

    /// Hears of an event of a run.
    pub fn hear(&mut self, event: &RunEvent<'_>) -> ControlFlow<()> {
        if !self.note(event) && self.last.elapsed() < PAUSE {
            return ControlFlow::Continue(());
        }
        self.last = Instant::now();
        match Python::attach(|py| self.tell(py, event)) {
            Ok(true) => ControlFlow::Continue(()),
            Ok(false) => ControlFlow::Break(()),
            Err(raised) => {
                self.raised = Some(raised);
                ControlFlow::Break(())
            }
        }
    }

    /// Remembers how far the run is; whether that is to be told at once.
    fn note(&mut self, event: &RunEvent<'_>) -> bool {
        match event {
            RunEvent::Started(Reached {
                updates,
                cycles,
                of_cycles,
            }) => {
                (self.updates, self.cycles, self.of_cycles) = (*updates, *cycles, *of_cycles);
                true
            }
            RunEvent::Solved(progress) => {
                self.cycles = progress.cycles;
                false
            }
            RunEvent::Updated(update) => {
                (self.updates, self.cycles) = (self.updates + 1, update.cycles);
                true
            }
            RunEvent::Warning(_) | RunEvent::Estimating => false,
        }
    }

    /// Tells the callback; whether the run is to go on.
    fn tell(&self, py: Python<'_>, event: &RunEvent<'_>) -> PyResult<bool> {
        py.check_signals()?;
        if let Some(raised) = self.raised_by_law.as_ref().and_then(taken) {
            return Err(raised);
        }
        let Some(callback) = &self.callback else {
            return Ok(true);
        };
        let is_estimating = matches!(event, RunEvent::Estimating);
        let class = py.import("condyle.progress")?.getattr("Progress")?;
        let progress = class.call1((self.cycles, self.of_cycles, self.updates, is_estimating))?;
        let answer = callback.bind(py).call1((progress,))?;
        Ok(!answer.is(pyo3::types::PyBool::new(py, false).as_any()))
    }
}
