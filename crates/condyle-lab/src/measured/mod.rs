//! Comparison of runs with measurements of a laboratory.
//!
//! [`compare`] reads a results folder and a file of measured data, and compares motions over the cycle, wear by weighing,
//! and the worn surface.

pub(crate) mod calibrate;
mod error;
pub(crate) mod gravimetric;
pub(crate) mod kinematics;
pub(crate) mod surface;
pub(crate) mod write;

use std::path::Path;

use condyle_case::measured::Measured;
use condyle_report::Results;
use condyle_results::{Directions, MotionColumn};
use serde::Serialize;

pub use error::{CalibrateError, CompareError};

pub use crate::measured::{
    calibrate::{
        CalibratedConstant, CalibratedTest, Calibration, Estimate, Prediction, Trial, calibrate,
    },
    gravimetric::{GravimetricComparison, Interval, Rate, Weighing, student},
    kinematics::{ColumnComparison, Errors, KinematicsComparison, PhaseErrors},
    surface::{NodeDepths, SurfaceComparison, SurfaceErrors, register::Registration},
};

/// A comparison of a run with measured data; parts that were not measured are `None`.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Motions and loads.
    pub kinematics: Option<KinematicsComparison>,
    /// Wear by weighing.
    pub gravimetric: Option<GravimetricComparison>,
    /// Wear by scanning.
    pub surface: Option<SurfaceComparison>,
    /// Doubts about the run, and remarks on the measured data.
    pub remarks: Vec<String>,
    /// The joint and its side.
    #[serde(skip)]
    pub directions: Directions,
    /// The joints of the machine.
    #[serde(skip)]
    pub motions: Vec<MotionColumn>,
}

/// Compares the run in `results` with the measured data of the file `measured`.
///
/// # Errors
/// Either cannot be read, or they have nothing in common.
pub fn compare(results: &Path, measured: &Path) -> Result<Comparison, CompareError> {
    let run = Results::read(results)?;
    let measured = Measured::read(measured, run.side)?;
    let table = |table: &Option<condyle_report::Table>, file: &str, key| {
        let path = results.join(file);
        table
            .clone()
            .ok_or_else(|| CompareError::missing_file(&path, key))
    };
    let kinematics = measured.kinematics.as_ref().map(|measured| {
        let run = table(&run.kinematics, "kinematics.csv", "kinematics")?;
        kinematics::compare(measured, &run)
    });
    let gravimetric = measured.gravimetric.as_ref().map(|measured| {
        let run = table(&run.wear, "wear.csv", "gravimetric")?;
        gravimetric::compare(measured, &run)
    });
    let surface = measured
        .scan
        .as_ref()
        .map(|scan| surface::compare(scan, results, run.surface.clone()));
    let (kinematics, gravimetric) = (kinematics.transpose()?, gravimetric.transpose()?);
    let doubts = run.summary.iter().flat_map(|summary| &summary.plausibility);
    let doubts = doubts.map(|doubt| format!("the run is doubtful: {}", doubt.message));
    let weighed = gravimetric.iter().flat_map(GravimetricComparison::remarks);
    let moved = kinematics.iter().flat_map(KinematicsComparison::remarks);
    Ok(Comparison {
        remarks: doubts.chain(weighed).chain(moved).collect(),
        kinematics,
        gravimetric,
        surface: surface.transpose()?,
        directions: run.directions(),
        motions: run.motions().to_vec(),
    })
}
