//! A wear law that is a function of Python. It is slow: every sliding node is one call.

use std::sync::{Arc, OnceLock};

use condyle::wear::{MeanCycle, NamedLaw, NodeWear, WearLaw};
use pyo3::prelude::*;

use crate::record::array;

/// The name of such a law in results.
const WORD: &str = "python";

/// The first exception of a law, for the caller of the run: a wear law itself cannot fail.
pub type Raised = Arc<OnceLock<PyErr>>;

/// A wear law that is a function of Python.
#[derive(Debug)]
struct LawOfPython {
    function: Py<PyAny>,
    raised: Raised,
}

/// The law that calls `function` with a `condyle.NodeCycle`, and a handle to its first exception.
pub fn law_of(function: Py<PyAny>) -> (NamedLaw, Raised) {
    let raised = Raised::default();
    let law = Arc::new(LawOfPython {
        function,
        raised: Arc::clone(&raised),
    });
    (NamedLaw { word: WORD, law }, raised)
}

impl WearLaw for LawOfPython {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        if cycle.pressure_slip_mpa_mm == 0.0 {
            return NodeWear::of_depth(0.0);
        }
        let depth_mm = Python::attach(|py| self.depth_mm(py, cycle));
        NodeWear::of_depth(depth_mm.unwrap_or_else(|error| {
            // The first exception stays; the listener stops the run at its next event.
            self.raised.get_or_init(|| error);
            0.0
        }))
    }
}

impl LawOfPython {
    fn depth_mm(&self, py: Python<'_>, cycle: &MeanCycle<'_>) -> PyResult<f64> {
        let answer = self.function.bind(py).call1((node_cycle(py, cycle)?,))?;
        let depth_mm: f64 = answer.extract()?;
        if depth_mm.is_finite() && depth_mm >= 0.0 {
            return Ok(depth_mm);
        }
        let said =
            format!("a wear law gave {depth_mm} as the depth of a cycle; give mm, 0 or more");
        Err(pyo3::exceptions::PyValueError::new_err(said))
    }
}

fn node_cycle<'py>(py: Python<'py>, cycle: &MeanCycle<'_>) -> PyResult<Bound<'py, PyAny>> {
    let (mut shares, mut pressures, mut slips) = (Vec::new(), Vec::new(), Vec::new());
    for (share, moment) in cycle.moments() {
        shares.push(share);
        pressures.push(moment.pressure_mpa);
        slips.extend(moment.slip_mm);
    }
    let instants = shares.len();
    py.import("condyle.laws")?.getattr("NodeCycle")?.call1((
        array(py, pressures, [instants])?,
        array(py, slips, [instants, 2])?,
        array(py, shares, [instants])?,
        cycle.peak_pressure_mpa,
        cycle.pressed_distance_mm,
        cycle.pressure_slip_mpa_mm,
        cycle.slip_work.cross_shear(),
    ))
}
