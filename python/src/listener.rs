//! Callbacks of Python during a run or a study, and how they stop it.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use condyle_lab::{Reached, RunEvent};
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

use crate::law::Raised;

/// Pause between two checks for Ctrl-C and calls of the callback: taking the interpreter's lock may wait for other threads.
const PAUSE: Duration = Duration::from_millis(50);

/// A callback of Python that is called with progress, and the first exception raised on the way.
pub struct Callback {
    pub function: Option<Py<PyAny>>,
    pub raised: Option<PyErr>,
}

impl Callback {
    /// Calls the function with an instance of `class` of `condyle.progress`. Stops on Ctrl-C, on an exception, and when
    /// the function returns `False` or another false value than `None`.
    pub fn call(&mut self, class: &str, fields: impl for<'py> PyCallArgs<'py>) -> ControlFlow<()> {
        let goes_on = Python::attach(|py| {
            py.check_signals()?;
            let Some(function) = &self.function else {
                return Ok(true);
            };
            let class = py.import("condyle.progress")?.getattr(class)?;
            let answer = function.bind(py).call1((class.call1(fields)?,))?;
            Ok(answer.is_none() || answer.is_truthy()?)
        });
        match goes_on {
            Ok(true) => ControlFlow::Continue(()),
            Ok(false) => ControlFlow::Break(()),
            Err(raised) => {
                self.raised = Some(raised);
                ControlFlow::Break(())
            }
        }
    }
}

/// Reports a run to a callback, and stops it when the callback or a wear law of Python asks for it.
pub struct Listener {
    callback: Callback,
    last: Instant,
    reached: Reached,
    raised_by_law: Option<Raised>,
}

impl Listener {
    pub fn new(function: Option<Py<PyAny>>, raised_by_law: Option<Raised>) -> Self {
        Self {
            callback: Callback {
                function,
                raised: None,
            },
            last: Instant::now(),
            reached: Reached {
                updates: 0,
                cycles: 0.0,
                of_cycles: 0.0,
            },
            raised_by_law,
        }
    }

    /// The exception that stopped the run.
    pub fn raised(self, py: Python<'_>) -> Option<PyErr> {
        let by_law = self.raised_by_law.as_ref().and_then(|raised| raised.get());
        by_law
            .map(|error| error.clone_ref(py))
            .or(self.callback.raised)
    }

    /// Notes an event of the run; calls the callback at once for a start or an update, and otherwise after the pause.
    pub fn hear(&mut self, event: &RunEvent<'_>) -> ControlFlow<()> {
        match event {
            RunEvent::Started(reached) => self.reached = *reached,
            RunEvent::Solved(progress) => self.reached.cycles = progress.cycles,
            RunEvent::Updated(update) => {
                self.reached.updates += 1;
                self.reached.cycles = update.cycles;
            }
            RunEvent::Warning(_) | RunEvent::Placed | RunEvent::Estimating => {}
        }
        let is_urgent = matches!(event, RunEvent::Started(_) | RunEvent::Updated(_));
        if !is_urgent && self.last.elapsed() < PAUSE {
            return ControlFlow::Continue(());
        }
        self.last = Instant::now();
        let has_law_raised = |raised: &Raised| raised.get().is_some();
        if self.raised_by_law.as_ref().is_some_and(has_law_raised) {
            return ControlFlow::Break(());
        }
        let reached = self.reached;
        let is_estimating = matches!(event, RunEvent::Estimating);
        let (cycles, of_cycles) = (reached.cycles, reached.of_cycles);
        let fields = (cycles, of_cycles, reached.updates, is_estimating);
        self.callback.call("Progress", fields)
    }
}
