//! Callbacks of Python during a run or a study, and how they stop it.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use condyle_lab::RunEvent;
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

use crate::law::{Raised, taken};

/// Pause between two checks for Ctrl-C and calls of the callback: taking the interpreter's lock may wait for other threads.
const PAUSE: Duration = Duration::from_millis(50);

/// A callback of Python that is called with progress, and the first exception raised on the way.
pub struct Callback {
    function: Option<Py<PyAny>>,
    raised: Option<PyErr>,
}

impl Callback {
    pub fn new(function: Option<Py<PyAny>>) -> Self {
        Self {
            function,
            raised: None,
        }
    }

    /// Calls the function with an instance of `class` of `condyle.progress`. Stops on Ctrl-C, on an exception, and when
    /// the function returns `False`.
    pub fn call(&mut self, class: &str, fields: impl for<'py> PyCallArgs<'py>) -> ControlFlow<()> {
        let goes_on = Python::attach(|py| {
            py.check_signals()?;
            let Some(function) = &self.function else {
                return Ok(true);
            };
            let class = py.import("condyle.progress")?.getattr(class)?;
            let answer = function.bind(py).call1((class.call1(fields)?,))?;
            Ok(!answer.is(pyo3::types::PyBool::new(py, false).as_any()))
        });
        match goes_on {
            Ok(true) => ControlFlow::Continue(()),
            Ok(false) => ControlFlow::Break(()),
            Err(raised) => self.stop(raised),
        }
    }

    fn stop(&mut self, raised: PyErr) -> ControlFlow<()> {
        self.raised = Some(raised);
        ControlFlow::Break(())
    }

    /// The exception that stopped the run or study.
    pub fn into_raised(self) -> Option<PyErr> {
        self.raised
    }
}

/// Reports a run to a callback, and stops it when the callback or a wear law of Python asks for it.
pub struct Listener {
    callback: Callback,
    last: Instant,
    of_cycles: f64,
    cycles: f64,
    updates: usize,
    raised_by_law: Option<Raised>,
}

impl Listener {
    pub fn new(function: Option<Py<PyAny>>, raised_by_law: Option<Raised>) -> Self {
        Self {
            callback: Callback::new(function),
            last: Instant::now(),
            of_cycles: 0.0,
            cycles: 0.0,
            updates: 0,
            raised_by_law,
        }
    }

    /// The exception that stopped the run.
    pub fn into_raised(self) -> Option<PyErr> {
        let by_law = self.raised_by_law.as_ref().and_then(taken);
        by_law.or(self.callback.into_raised())
    }

    /// Notes an event of the run; calls the callback at once for a start or an update, and otherwise after the pause.
    pub fn hear(&mut self, event: &RunEvent<'_>) -> ControlFlow<()> {
        let mut is_urgent = false;
        match event {
            RunEvent::Started(reached) => {
                is_urgent = true;
                (self.updates, self.cycles) = (reached.updates, reached.cycles);
                self.of_cycles = reached.of_cycles;
            }
            RunEvent::Solved(progress) => self.cycles = progress.cycles,
            RunEvent::Updated(update) => {
                is_urgent = true;
                (self.updates, self.cycles) = (self.updates + 1, update.cycles);
            }
            RunEvent::Warning(_) | RunEvent::Estimating => {}
        }
        if !is_urgent && self.last.elapsed() < PAUSE {
            return ControlFlow::Continue(());
        }
        self.last = Instant::now();
        if let Some(raised) = self.raised_by_law.as_ref().and_then(taken) {
            return self.callback.stop(raised);
        }
        let is_estimating = matches!(event, RunEvent::Estimating);
        self.callback.call(
            "Progress",
            (self.cycles, self.of_cycles, self.updates, is_estimating),
        )
    }
}
