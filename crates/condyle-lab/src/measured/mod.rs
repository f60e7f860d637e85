//! A run held against what a laboratory measured.
//!
//! [`compare`] reads a results folder and a file of measured data, and says how far apart they are:
//! motions over the cycle, wear by weighing, and the worn surface.

pub(crate) mod calibrate;
mod error;
pub(crate) mod gravimetric;
pub(crate) mod kinematics;
pub(crate) mod surface;
pub(crate) mod write;

use std::path::Path;

use condyle_case::{case::Side, measured::Measured};
use condyle_report::Results;
use serde::Serialize;

pub use error::CompareError;

pub use crate::measured::{
    calibrate::{
        CalibrateError, CalibratedConstant, CalibratedTest, Calibration, CalibrationRequest, Found,
        OneTest, Prediction, Trial, WearFactor, calibrate,
    },
    gravimetric::{GravimetricComparison, Interval, Line, Rate, Weighing},
    kinematics::{ColumnComparison, Errors, KinematicsComparison, PhaseErrors},
    surface::{NodeDepths, SurfaceComparison, SurfaceErrors, register::Registration},
};

/// A run against measured data; a part that was not measured is `None`.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Motions and loads.
    pub kinematics: Option<KinematicsComparison>,
    /// Wear by weighing.
    pub gravimetric: Option<GravimetricComparison>,
    /// Wear by scanning.
    pub surface: Option<SurfaceComparison>,
    /// Which knee it is.
    #[serde(skip)]
    pub side: Side,
}

/// Holds the run in `results` against the measured data that the file `measured` names.
///
/// # Errors
/// Either cannot be read, or they have nothing to be compared by.
pub fn compare(results: &Path, measured: &Path) -> Result<Comparison, CompareError> {
    let run = Results::read(results)?;
    let measured = Measured::read(measured, run.side)?;
    let table = |table: &Option<condyle_report::Table>, file: &str, key| {
        let path = results.join(file);
        table
            .clone()
            .ok_or(CompareError::MissingFile { path, table: key })
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
        .map(|scan| surface::compare(scan, results));
    Ok(Comparison {
        kinematics: kinematics.transpose()?,
        gravimetric: gravimetric.transpose()?,
        surface: surface.transpose()?,
        side: run.side,
    })
}
