//! Abaqus input files, out: a writer of keywords, from which a whole case is put together.
//!
//! Syntax after the Abaqus Keywords Reference. Labels count from 1; a block of nodes or elements
//! says with which label it begins, and items of it are `first + index`.

mod contact;
mod mesh;
mod springs;
mod step;
mod writer;

pub use contact::PressureOverclosure;
pub use mesh::{RigidTriangle, element_faces};
pub use step::{AnalysisStep, Application, Procedure};
pub use writer::InpWriter;
