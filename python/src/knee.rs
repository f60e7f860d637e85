//! What lies below a run: the bodies of a case, how they press, and one cycle.

use condyle::contact::{ContactMemory, ContactModel, ContactResult, NotBorne, Settled};
use condyle::evolve::{March, SolvedCycle};
use condyle::spatial::{Pose, RelativeMotion};
use condyle::{Mat3, Vec3};
use condyle_case::cache::Cache;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::case::RawCase;
use crate::errors;

/// How often a contact is asked anew whose own state goes with the load: ten times what was seen.
const MAX_TURNS: usize = 300;

/// The bodies of a case with the femur settled on the insert, as the solver has them: a right knee.
#[pyclass(frozen, module = "condyle._condyle")]
pub struct RawKnee {
    march: March,
}

#[pymethods]
impl RawKnee {
    #[new]
    fn new(py: Python<'_>, case: &RawCase, threads: usize) -> PyResult<Self> {
        let march = py.detach(|| condyle_lab::settled(&case.case, threads, &Cache::of_user()));
        let march = march.map_err(|error| errors::of_run(&error))?;
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
            let sample = self.march.femur().sample(&point, 0.0);
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
        let translation = array(py, numbers(&pose.translation).to_vec(), [3])?;
        Ok((
            array(py, rows(&pose.rotation).to_vec(), [3, 3])?,
            translation,
        ))
    }

    /// Places of the nodes of the articulating surface.
    fn surface_points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let places = self.march.insert().surface().positions;
        let values: Vec<f64> = places.iter().flat_map(numbers).collect();
        array(py, values, [places.len(), 3])
    }

    /// How the femur presses, standing still at a pose.
    fn contact<'py>(
        &self,
        py: Python<'py>,
        rotation: [[f64; 3]; 3],
        translation: [f64; 3],
    ) -> PyResult<Bound<'py, PyDict>> {
        let rotation = Mat3::from_row_slice(rotation.as_flattened());
        let motion = RelativeMotion::at_rest(Pose::new(rotation, Vec3::from(translation)));
        let surface = self.march.insert().surface();
        let memory = ContactMemory::default();
        let law = &self.march.test().contact;
        let mut contact = law.contact(self.march.bodies(&surface), memory);
        come_to_rest(contact.as_mut(), &motion)?;
        let response = contact.respond(&motion);
        let (wrench, tangent) = (response.wrench, response.tangent().by_pose.matrix);
        let landing = contact.evaluate(&motion);
        let told = pressed(py, &landing, surface.positions.len())?;
        told.set_item("force_n", array(py, numbers(&wrench.force).to_vec(), [3])?)?;
        told.set_item(
            "moment_nmm",
            array(py, numbers(&wrench.moment).to_vec(), [3])?,
        )?;
        let tangent: Vec<f64> = tangent.transpose().iter().copied().collect();
        told.set_item("tangent", array(py, tangent, [6, 6])?)?;
        Ok(told)
    }

    /// The first cycle of the first activity.
    fn first_cycle<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (test, state) = (self.march.test().clone(), self.march.state().clone());
        let mut march = March::resume(test, state);
        let solved = py.detach(|| {
            let mut go_on = |_| std::ops::ControlFlow::Continue(());
            march.update(&mut go_on).map(|_| ())
        });
        solved.map_err(|error| errors::not_solved(&error))?;
        let cycle = march.last_cycle().expect("an update was made");
        in_arrays(py, &cycle)
    }
}

/// Lets an insert flow, or come to rest on its tray, under what presses it at a motion.
fn come_to_rest(contact: &mut dyn ContactModel, motion: &RelativeMotion) -> PyResult<()> {
    for _ in 0..MAX_TURNS {
        contact.respond(motion);
        let settled = contact.settle(motion);
        if settled.map_err(|why| errors::not_solved(&said(why)))? == Settled::Yes {
            return Ok(());
        }
    }
    Err(errors::not_solved(&format!(
        "load and insert did not settle together in {MAX_TURNS} turns at this pose; lift the femur"
    )))
}

fn said(why: NotBorne) -> String {
    match why {
        NotBorne::Flattened(flat) => format!(
            "the femur presses the insert flat at this pose: a plastic strain of {:.2} was reached; lift the femur, or see \
             yield_stress_mpa and hardening",
            flat.plastic_strain
        ),
        NotBorne::Tipped(tipped) => format!(
            "the femur tips the insert off its tray at this pose: its backside finds no rest, and had moved by {:.2} mm; lift \
             the femur, or take [contact] backside = \"bonded\"",
            tipped.moved_mm
        ),
    }
}

fn pressed<'py>(
    py: Python<'py>,
    landing: &ContactResult,
    nodes: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let mut pressures = vec![0.0; nodes];
    for touched in &landing.touched {
        pressures[touched.node as usize] = touched.pressure_mpa;
    }
    let told = PyDict::new(py);
    told.set_item("pressure_mpa", array(py, pressures, [nodes])?)?;
    told.set_item("peak_pressure_mpa", landing.peak_pressure_mpa)?;
    let area = landing.touched.iter().map(|touched| touched.covered_mm2);
    told.set_item("area_mm2", area.sum::<f64>())?;
    Ok(told)
}

fn in_arrays<'py>(py: Python<'py>, cycle: &SolvedCycle<'_>) -> PyResult<Bound<'py, PyDict>> {
    let (increments, nodes) = (cycle.rows.len(), cycle.surface.positions.len());
    let (mut pressures, mut slips) = (Vec::new(), vec![0.0; 2 * increments * nodes]);
    let (mut rotations, mut translations) = (Vec::new(), Vec::new());
    for increment in 0..increments {
        let pressed = cycle.pressures_mpa(increment);
        let touched = pressed
            .iter()
            .enumerate()
            .filter(|(_, pressure)| **pressure > 0.0);
        for (node, _) in touched {
            if let Some(moment) = cycle.moment(increment, node) {
                let place = 2 * (increment * nodes + node);
                slips[place..place + 2].copy_from_slice(&moment.slip_mm);
            }
        }
        pressures.extend(pressed);
        let pose = cycle.pose(increment);
        rotations.extend(rows(&pose.rotation));
        translations.extend(numbers(&pose.translation));
    }
    let told = PyDict::new(py);
    let percents: Vec<f64> = cycle.rows.iter().map(|row| row.percent).collect();
    told.set_item("percent", array(py, percents, [increments])?)?;
    told.set_item("pressure_mpa", array(py, pressures, [increments, nodes])?)?;
    told.set_item("slip_mm", array(py, slips, [increments, nodes, 2])?)?;
    told.set_item("rotation", array(py, rotations, [increments, 3, 3])?)?;
    told.set_item("translation_mm", array(py, translations, [increments, 3])?)?;
    Ok(told)
}

fn numbers(vector: &Vec3) -> [f64; 3] {
    [vector.x, vector.y, vector.z]
}

fn rows(matrix: &Mat3) -> [f64; 9] {
    std::array::from_fn(|place| matrix[(place / 3, place % 3)])
}
