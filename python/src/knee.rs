//! The parts of a run: the bodies of a case, their contact at a pose, and one cycle.

use condyle::contact::{ContactMemory, ContactModel, Settled};
use condyle::evolve::{March, SolvedCycle};
use condyle::spatial::{Pose, RelativeMotion};
use condyle::{Mat3, Vec3};
use condyle_case::cache::Cache;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::case::RawCase;
use crate::errors;
use crate::record::array;

/// Evaluations of a contact whose state follows its load (creep, yield, a resting backside) until both agree; ten times
/// the largest number seen.
const MAX_TURNS: usize = 300;

/// The bodies of a case with the femur settled on the insert, in the frame of the solver: a right knee.
#[pyclass(frozen, module = "condyle._condyle")]
pub struct RawKnee {
    march: March,
}

#[pymethods]
impl RawKnee {
    #[new]
    fn new(py: Python<'_>, case: &RawCase, threads: usize) -> PyResult<Self> {
        let march = py.detach(|| condyle_lab::settled(&case.case, threads, &Cache::of_user()));
        let march = march.map_err(errors::of_run)?;
        Ok(Self { march })
    }

    /// Gap and normal of the femur at points of the femoral frame.
    fn gap<'py>(
        &self,
        py: Python<'py>,
        points_mm: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let points = points_mm.as_array();
        let (mut gaps, mut normals) = (Vec::new(), Vec::new());
        for point in points.rows() {
            let point = Vec3::new(point[0], point[1], point[2]);
            let sample = self.march.counterface().sample(&point, 0.0);
            gaps.push(sample.gap_mm);
            normals.extend([sample.normal.x, sample.normal.y, sample.normal.z]);
        }
        let count = gaps.len();
        Ok((array(py, gaps, [count])?, array(py, normals, [count, 3])?))
    }

    /// Rotation and translation of the settled femur.
    fn neutral_pose<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let pose = self.march.neutral_pose();
        let rotation = array(py, row_major(&pose.rotation), [3, 3])?;
        Ok((
            rotation,
            array(py, pose.translation.as_slice().to_vec(), [3])?,
        ))
    }

    /// Positions of the nodes of the articulating surface.
    fn surface_points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let positions = self.march.surface().positions;
        let values: Vec<f64> = positions.iter().flatten().copied().collect();
        array(py, values, [positions.len(), 3])
    }

    /// The contact of the femur at rest at a pose.
    fn contact<'py>(
        &self,
        py: Python<'py>,
        rotation: [[f64; 3]; 3],
        translation: [f64; 3],
    ) -> PyResult<Bound<'py, PyDict>> {
        let rotation = Mat3::from_row_slice(rotation.as_flattened());
        let motion = RelativeMotion::at_rest(Pose::new(rotation, Vec3::from(translation)));
        let surface = self.march.surface();
        let law = &self.march.test().contact;
        let mut contact = law.contact(self.march.bodies(&surface), ContactMemory::default());
        settle(contact.as_mut(), &motion)?;
        let response = contact.respond(&motion);
        let (wrench, tangent) = (response.wrench, contact.tangent().by_pose.matrix);
        let result = contact.evaluate(&motion);
        let nodes = surface.positions.len();
        let mut pressures = vec![0.0; nodes];
        for node in &result.touched {
            pressures[node.node as usize] = node.pressure_mpa;
        }
        let area_mm2: f64 = result.touched.iter().map(|node| node.covered_mm2).sum();
        let peak_mpa = result.peak_pressure_mpa;
        let entries = [
            ("force_n", array(py, wrench.force.as_slice().to_vec(), [3])?),
            (
                "moment_nmm",
                array(py, wrench.moment.as_slice().to_vec(), [3])?,
            ),
            (
                "tangent",
                array(py, tangent.transpose().as_slice().to_vec(), [6, 6])?,
            ),
            ("pressure_mpa", array(py, pressures, [nodes])?),
            ("peak_pressure_mpa", peak_mpa.into_pyobject(py)?.into_any()),
            ("area_mm2", area_mm2.into_pyobject(py)?.into_any()),
        ];
        entries.into_py_dict(py)
    }

    /// The first cycle of the first activity, increment by increment.
    fn first_cycle<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (test, state) = (self.march.test().clone(), self.march.state().clone());
        let mut march = March::resume(test, state);
        let solved = py.detach(|| {
            march
                .update(&mut |_| std::ops::ControlFlow::Continue(()))
                .map(|_| ())
        });
        solved.map_err(errors::not_solved)?;
        let cycle = march.last_cycle().expect("an update was made");
        cycle_arrays(py, &cycle)
    }
}

/// Repeats the evaluation at a motion until load and state of the insert agree.
fn settle(contact: &mut dyn ContactModel, motion: &RelativeMotion) -> PyResult<()> {
    for _ in 0..MAX_TURNS {
        contact.respond(motion);
        let settled = contact.settle(motion);
        let not_borne = |why| format!("at this pose the femur {why}, or lift the femur");
        if settled.map_err(|why| errors::not_solved(not_borne(why)))? == Settled::Yes {
            return Ok(());
        }
    }
    Err(errors::not_solved(format!(
        "load and insert did not settle together in {MAX_TURNS} turns at this pose; lift the femur"
    )))
}

fn cycle_arrays<'py>(py: Python<'py>, cycle: &SolvedCycle<'_>) -> PyResult<Bound<'py, PyDict>> {
    let (increments, nodes) = (cycle.rows.len(), cycle.surface.positions.len());
    let (mut pressures, mut slips) = (Vec::new(), vec![0.0; 2 * increments * nodes]);
    let (mut rotations, mut translations) = (Vec::new(), Vec::new());
    for increment in 0..increments {
        let pressures_mpa = cycle.pressures_mpa(increment);
        for (node, &pressure_mpa) in pressures_mpa.iter().enumerate() {
            if pressure_mpa > 0.0
                && let Some(moment) = cycle.moment(increment, node)
            {
                let place = 2 * (increment * nodes + node);
                slips[place..place + 2].copy_from_slice(&moment.slip_mm);
            }
        }
        pressures.extend(pressures_mpa);
        let pose = cycle.pose(increment);
        rotations.extend(row_major(&pose.rotation));
        translations.extend_from_slice(pose.translation.as_slice());
    }
    let percents = cycle.rows.iter().map(|row| row.percent).collect();
    let entries = [
        ("percent", array(py, percents, [increments])?),
        ("pressure_mpa", array(py, pressures, [increments, nodes])?),
        ("slip_mm", array(py, slips, [increments, nodes, 2])?),
        ("rotation", array(py, rotations, [increments, 3, 3])?),
        ("translation_mm", array(py, translations, [increments, 3])?),
    ];
    entries.into_py_dict(py)
}

fn row_major(matrix: &Mat3) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}
