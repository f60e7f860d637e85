//! A whole wear test, as the solver sees it.

use std::sync::Arc;

use super::Schedule;
use crate::{
    contact::FoundationSettings,
    geometry::{FemoralSurface, Insert},
    machine::{Machine, TimeSettings},
    wear::WearLaw,
};

/// Bodies, machine and laws of a wear test; a right knee, mm N s MPa tonne rad.
pub struct WearTest {
    /// The femoral component.
    pub femur: FemoralSurface,
    /// Axis about which the femur flexes, (x, y) in the femoral frame, mm.
    pub flexion_axis_mm: (f64, f64),
    /// Where the flexion axis starts over the insert before it settles, (x, z), mm.
    pub start_mm: (f64, f64),
    /// The unworn insert.
    pub insert: Insert,
    /// The simulator.
    pub machine: Machine,
    /// Contact between femur and insert.
    pub contact: FoundationSettings,
    /// The law of wear.
    pub wear: Arc<dyn WearLaw>,
    /// Density of the insert, mg/mm3.
    pub density_mg_per_mm3: f64,
    /// How finely and exactly a cycle is solved.
    pub time: TimeSettings,
    /// How the cycles are shared out.
    pub schedule: Schedule,
}
