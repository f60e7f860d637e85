//! Why a case makes no Abaqus file.

use std::io;

use condyle::evolve::{MarchError, PlacementError};
use thiserror::Error;

use crate::case::BuildError;

/// Why a case makes no Abaqus file.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The case does not build.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The femur finds no place on the insert.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// A deformable insert, which the model that is written does not have.
    #[error(
        "the Abaqus model presses a rigid insert by a pressure law, and this case has a deformable one; write [contact] model = \"foundation\" for it, or ask for the bodies alone where the cycle is at so many percent (--pressed-at)"
    )]
    Deformable,
    /// A foundation, of which there are no hexahedra to press.
    #[error(
        "the femur is pressed on a deformable insert, and this case has a foundation; write [contact] model = \"deformable\" for it"
    )]
    Foundation,
    /// A backside that rests, which the file does not have.
    #[error(
        "the file has an insert that is bonded to its tray, and this case has backside = \"resting\"; write [contact] backside = \"bonded\" for it"
    )]
    Resting,
    /// Kinematic hardening, which the file does not have.
    #[error(
        "the file has isotropic hardening alone, and this case has kinematic_modulus_mpa = {modulus_mpa}; set it to 0"
    )]
    KinematicHardening {
        /// The modulus, MPa.
        modulus_mpa: f64,
    },
    /// A place in the cycle where the femur lies on the insert nowhere.
    #[error("nothing touches at {percent} % of the cycle; choose another place")]
    Apart {
        /// Place in the cycle, %.
        percent: f64,
    },
    /// The first cycle is not solved.
    #[error(transparent)]
    Cycle(Box<MarchError>),
    /// The file cannot be written.
    #[error("the Abaqus file cannot be written: {source}; check the disk and the folder")]
    Write {
        /// Why.
        source: io::Error,
    },
}
